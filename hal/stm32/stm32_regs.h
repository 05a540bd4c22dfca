/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32_regs.h
 * Registers that are the same in both families, only those in use, each block with its section in the
 * reference manuals (F0: RM0091, F4: RM0090) or the core's programming manual (PM0215, PM0214). Where a block
 * stands in the memory of a family says stm32_chip.h in the folder of that family.
 */
#ifndef STM32_REGS_H
#define STM32_REGS_H

#include <stdint.h>

#define STM32_REG(address) (*(volatile uint32_t *)(uintptr_t)(address))

/* ---- core: NVIC and system control (PM0215 4.2, 4.3; PM0214 4.3, 4.4) -----------------------------------
 */

#define STM32_NVIC_ISER(n) STM32_REG(0xE000E100u + 4u * (n)) /* set enable, 32 interrupts a word */
#define STM32_NVIC_ICER(n) STM32_REG(0xE000E180u + 4u * (n))
#define STM32_NVIC_ICPR(n) STM32_REG(0xE000E280u + 4u * (n)) /* clear pending */
#define STM32_NVIC_IPR(n) STM32_REG(0xE000E400u + 4u * (n))  /* priorities, 4 interrupts a word */
#define STM32_SCB_AIRCR STM32_REG(0xE000ED0Cu)
#define STM32_AIRCR_KEY (0x05FAu << 16)
#define STM32_AIRCR_SYSRESETREQ (1u << 2)

/* ---- GPIO (RM0091 8.4, RM0090 8.4) ------------------------------------------------------------------------
 */

typedef struct stm32_gpio_regs {
    volatile uint32_t moder;   /* 2 bits a pin: 0 input, 1 output, 2 alternate function, 3 analog */
    volatile uint32_t otyper;  /* 1 bit a pin: 0 push-pull, 1 open drain */
    volatile uint32_t ospeedr; /* 2 bits a pin: 0 slow */
    volatile uint32_t pupdr;   /* 2 bits a pin: 0 none, 1 up, 2 down */
    volatile uint32_t idr;
    volatile uint32_t odr;
    volatile uint32_t bsrr; /* low half sets, high half resets */
    volatile uint32_t lckr;
    volatile uint32_t afr[2]; /* 4 bits a pin */
} stm32_gpio_regs;

/* ---- EXTI (RM0091 11.3, RM0090 12.3) ----------------------------------------------------------------------
 */

typedef struct stm32_exti_regs {
    volatile uint32_t imr, emr, rtsr, ftsr, swier;
    volatile uint32_t pr; /* write 1 to clear */
} stm32_exti_regs;

/* ---- TIM2 (RM0091 18.4, RM0090 18.4) ----------------------------------------------------------------------
 */

typedef struct stm32_tim_regs {
    volatile uint32_t cr1, cr2, smcr, dier, sr, egr, ccmr1, ccmr2, ccer, cnt, psc, arr, rcr, ccr1;
} stm32_tim_regs;

#define STM32_TIM2 ((stm32_tim_regs *)(uintptr_t)0x40000000u)
#define STM32_TIM_CR1_CEN (1u << 0)
#define STM32_TIM_DIER_CC1IE (1u << 1)
#define STM32_TIM_SR_UIF (1u << 0)
#define STM32_TIM_SR_CC1IF (1u << 1) /* write 0 to clear */
#define STM32_TIM_EGR_UG (1u << 0)

/* ---- IWDG (RM0091 23.4, RM0090 21.4) ----------------------------------------------------------------------
 */

typedef struct stm32_iwdg_regs {
    volatile uint32_t kr, pr, rlr, sr;
} stm32_iwdg_regs;

#define STM32_IWDG ((stm32_iwdg_regs *)(uintptr_t)0x40003000u)
#define STM32_IWDG_KR_START 0xCCCCu
#define STM32_IWDG_KR_UNLOCK 0x5555u
#define STM32_IWDG_KR_RELOAD 0xAAAAu
#define STM32_IWDG_SR_PVU (1u << 0)
#define STM32_IWDG_SR_RVU (1u << 1)

/* ---- PWR: the programmable voltage detector (RM0091 6.4, RM0090 5.4) --------------------------------------
 */

#define STM32_PWR_CR STM32_REG(0x40007000u)
#define STM32_PWR_CR_PVDE (1u << 4)
#define STM32_PWR_CR_PLS_SHIFT 5
#define STM32_PWR_CSR STM32_REG(0x40007004u)
#define STM32_PWR_CSR_PVDO (1u << 2) /* 1 = supply below the level */

/* ---- RCC: bits at the same place in both families (RM0091 6.4, RM0090 7.3) --------------------------------
 */

#define STM32_APB1_TIM2 (1u << 0)
#define STM32_APB1_USART2 (1u << 17)
#define STM32_APB1_I2C1 (1u << 21)
#define STM32_APB1_CAN1 (1u << 25)
#define STM32_APB1_PWR (1u << 28)

#define STM32_CSR_RMVF (1u << 24)
#define STM32_CSR_PINRSTF (1u << 26)
#define STM32_CSR_PORRSTF (1u << 27)
#define STM32_CSR_SFTRSTF (1u << 28)
#define STM32_CSR_IWDGRSTF (1u << 29)
#define STM32_CSR_WWDGRSTF (1u << 30)
#define STM32_CSR_LPWRRSTF (1u << 31)

/* ---- bxCAN (RM0091 29.9, RM0090 32.9) ---------------------------------------------------------------------
 */

typedef struct stm32_can_mailbox {
    volatile uint32_t ir;  /* identifier, IDE, RTR; bit 0 of a transmit mailbox: TXRQ */
    volatile uint32_t dtr; /* length in bits 3:0 */
    volatile uint32_t dlr, dhr;
} stm32_can_mailbox;

typedef struct stm32_can_regs {
    volatile uint32_t mcr, msr, tsr, rf0r, rf1r, ier, esr, btr;
    uint32_t unused1[88];
    stm32_can_mailbox tx[3]; /* 0x180 */
    stm32_can_mailbox rx[2]; /* 0x1B0 */
    uint32_t unused2[12];
    volatile uint32_t fmr, fm1r; /* 0x200 */
    uint32_t unused3;
    volatile uint32_t fs1r; /* 0x20C */
    uint32_t unused4;
    volatile uint32_t ffa1r; /* 0x214 */
    uint32_t unused5;
    volatile uint32_t fa1r; /* 0x21C */
    uint32_t unused6[8];
    struct {
        volatile uint32_t fr1, fr2;
    } filter[14]; /* 0x240 */
} stm32_can_regs;

#define STM32_CAN1 ((stm32_can_regs *)(uintptr_t)0x40006400u)
#define STM32_CAN_MCR_INRQ (1u << 0)
#define STM32_CAN_MCR_SLEEP (1u << 1)
#define STM32_CAN_MCR_TXFP (1u << 2)
#define STM32_CAN_MCR_ABOM (1u << 6)
#define STM32_CAN_MSR_INAK (1u << 0)
#define STM32_CAN_MSR_SLAK (1u << 1)
#define STM32_CAN_MSR_ERRI (1u << 2)             /* write 1 to clear */
#define STM32_CAN_TSR_RQCP(n) (1u << (8u * (n))) /* write 1 to clear, with it TXOK, ALST, TERR */
#define STM32_CAN_TSR_ABRQ(n) (1u << (8u * (n) + 7u))
#define STM32_CAN_TSR_TME(n) (1u << (26u + (n)))
#define STM32_CAN_TSR_CODE_SHIFT 24 /* number of the mailbox that is filled next, while one is empty */
#define STM32_CAN_RF0R_FMP 3u
#define STM32_CAN_RF0R_FULL (1u << 3) /* write 1 to clear */
#define STM32_CAN_RF0R_FOVR (1u << 4) /* write 1 to clear */
#define STM32_CAN_RF0R_RFOM (1u << 5)
#define STM32_CAN_IER_TMEIE (1u << 0)
#define STM32_CAN_IER_FMPIE0 (1u << 1)
#define STM32_CAN_IER_BOFIE (1u << 10)
#define STM32_CAN_IER_ERRIE (1u << 15)
#define STM32_CAN_ESR_EPVF (1u << 1)
#define STM32_CAN_ESR_BOFF (1u << 2)
#define STM32_CAN_FMR_FINIT (1u << 0)
#define STM32_CAN_IR_TXRQ (1u << 0)
#define STM32_CAN_IR_RTR (1u << 1)
#define STM32_CAN_IR_IDE (1u << 2)
#define STM32_CAN_IR_EXID_SHIFT 3
#define STM32_CAN_IR_STID_SHIFT 21

#endif
