/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32_chip.h
 * What hal/stm32 wants to know about the STM32F072 (RM0091). Every family has a file of this name with the
 * same names in it.
 */
#ifndef STM32_CHIP_H
#define STM32_CHIP_H

#include "bqhost/hal.h"
#include "stm32_core.h"
#include "stm32_regs.h"

/* ---- clocks after stm32_clock_start(), by crystal or not
 * --------------------------------------------------- */

#define STM32_CORE_HZ 48000000u
#define STM32_APB1_HZ 48000000u
#define STM32_TIM2_HZ 48000000u
#define STM32_LSI_HZ 40000u

/* ---- where things are (RM0091 2.2.2)
 * ----------------------------------------------------------------------- */

#define STM32_GPIO_BASE 0x48000000u
#define STM32_EXTI ((stm32_exti_regs *)(uintptr_t)0x40010400u)
#define STM32_SYSCFG_EXTICR(n) STM32_REG(0x40010008u + 4u * (n))

/* RCC (RM0091 6.4) */
#define STM32_RCC_GPIOENR STM32_REG(0x40021014u) /* AHBENR */
#define STM32_GPIOEN_SHIFT 17u                   /* bit of port A */
#define STM32_RCC_APB2ENR STM32_REG(0x40021018u)
#define STM32_APB2_SYSCFG (1u << 0)
#define STM32_RCC_APB1ENR STM32_REG(0x4002101Cu)
#define STM32_RCC_CSR STM32_REG(0x40021024u)
#define STM32_CSR_BROWN_OUT 0u /* no flag of its own: a power-on reset with intact RAM */

/* Interrupts (RM0091 11.1.3) */
#define STM32_IRQ_EXTI0_1 5u
#define STM32_IRQ_TIM2 15u
#define STM32_IRQ_I2C1 23u
#define STM32_IRQ_USART2 28u
#define STM32_IRQ_CAN 30u
#define STM32_IRQ_COUNT 32u

#define STM32_FLASH_UNIT 2u

/* bxCAN: 48 MHz / 6 = 8 MHz; 1 + 13 + 2 = 16 quanta a bit, sampled at 87.5 %; SJW 2. Fields hold value - 1.
 */
#define STM32_CAN_BTR_500K ((2u - 1u) << 24 | (2u - 1u) << 20 | (13u - 1u) << 16 | (6u - 1u))

/** Clocks a peripheral on APB1; it can be used on return. */
void stm32_apb1_enable(uint32_t mask);

/** Enables all interrupts of the CAN controller. */
static inline void stm32_can_irqs_enable(unsigned priority)
{
    stm32_irq_enable(STM32_IRQ_CAN, priority);
}

/** Adds the fault status registers of the core; the Cortex-M0 has none. */
static inline void stm32_fault_status(bq_crash *crash)
{
    (void)crash;
}

#endif
