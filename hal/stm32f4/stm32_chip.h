/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32_chip.h
 * What hal/stm32 wants to know about the STM32F405 (RM0090). Every family has a file of this name with the
 * same names in it; those of this family alone come last.
 */
#ifndef STM32_CHIP_H
#define STM32_CHIP_H

#include "bqhost/hal.h"
#include "stm32_core.h"
#include "stm32_regs.h"

/* ---- clocks after stm32_clock_start(), by crystal or not -------------------------------------------------
 */

#define STM32_CORE_HZ 168000000u
#define STM32_APB1_HZ 42000000u
#define STM32_APB2_HZ                                                                                        \
    10500000u                   /* SPI1 divides it by up to 256, and a tall stack wants less than 62.5 kHz   \
                                 */
#define STM32_TIM2_HZ 84000000u /* twice APB1, whose prescaler is not 1 (RM0090 7.2) */
#define STM32_LSI_HZ 32000u

/* ---- where things are (RM0090 2.3) ------------------------------------------------------------------------
 */

#define STM32_GPIO_BASE 0x40020000u
#define STM32_EXTI ((stm32_exti_regs *)(uintptr_t)0x40013C00u)
#define STM32_SYSCFG_EXTICR(n) STM32_REG(0x40013808u + 4u * (n))

/* RCC (RM0090 7.3) */
#define STM32_RCC_GPIOENR STM32_REG(0x40023830u) /* AHB1ENR */
#define STM32_GPIOEN_SHIFT 0u                    /* bit of port A */
#define STM32_RCC_APB1ENR STM32_REG(0x40023840u)
#define STM32_RCC_APB2ENR STM32_REG(0x40023844u)
#define STM32_APB2_SYSCFG (1u << 14)
#define STM32_RCC_CSR STM32_REG(0x40023874u)
#define STM32_CSR_BROWN_OUT (1u << 25) /* BORRSTF */

/* Interrupts (RM0090 12.2) */
#define STM32_IRQ_EXTI1 7u
#define STM32_IRQ_EXTI4 10u
#define STM32_IRQ_CAN_TX 19u
#define STM32_IRQ_CAN_RX0 20u
#define STM32_IRQ_CAN_SCE 22u
#define STM32_IRQ_EXTI9_5 23u
#define STM32_IRQ_TIM2 28u
#define STM32_IRQ_I2C1_EV 31u
#define STM32_IRQ_I2C1_ER 32u
#define STM32_IRQ_SPI1 35u
#define STM32_IRQ_USART2 38u
#define STM32_IRQ_DMA2_S0 56u
#define STM32_IRQ_DMA2_S3 59u
#define STM32_IRQ_COUNT 82u

#define STM32_FLASH_UNIT 4u

/* bxCAN: 42 MHz / 6 = 7 MHz; 1 + 11 + 2 = 14 quanta a bit, sampled at 85.7 %; SJW 2. Fields hold value - 1.
 */
#define STM32_CAN_BTR_500K ((2u - 1u) << 24 | (2u - 1u) << 20 | (11u - 1u) << 16 | (6u - 1u))

/** Clocks a peripheral on APB1; it can be used on return. */
void stm32_apb1_enable(uint32_t mask);

/** Enables all interrupts of the CAN controller. */
static inline void stm32_can_irqs_enable(unsigned priority)
{
    stm32_irq_enable(STM32_IRQ_CAN_TX, priority);
    stm32_irq_enable(STM32_IRQ_CAN_RX0, priority);
    stm32_irq_enable(STM32_IRQ_CAN_SCE, priority);
}

/** Adds the fault status registers of the core (PM0214 4.4). */
static inline void stm32_fault_status(bq_crash *crash)
{
    crash->cfsr = STM32_REG(0xE000ED28u);
    crash->hfsr = STM32_REG(0xE000ED2Cu);
    if ((crash->cfsr & (1u << 15)) != 0u) { /* BFARVALID */
        crash->address = STM32_REG(0xE000ED38u);
    } else if ((crash->cfsr & (1u << 7)) != 0u) { /* MMARVALID */
        crash->address = STM32_REG(0xE000ED34u);
    }
}

/* ---- this family alone
 * -------------------------------------------------------------------------------------- */

/* RCC (RM0090 7.3) */
#define STM32_RCC_APB2RSTR STM32_REG(0x40023824u)
#define STM32_RCC_AHB1ENR STM32_REG(0x40023830u)
#define STM32_AHB1_DMA2 (1u << 22)
#define STM32_APB2_ADC1 (1u << 8)
#define STM32_APB2_SPI1 (1u << 12)

/* DMA2 (RM0090 10.5) */
typedef struct stm32_dma_stream {
    volatile uint32_t cr, ndtr, par, m0ar, m1ar, fcr;
} stm32_dma_stream;

typedef struct stm32_dma_regs {
    volatile uint32_t isr[2];  /* streams 0..3, 4..7 */
    volatile uint32_t ifcr[2]; /* write 1 to clear */
    stm32_dma_stream stream[8];
} stm32_dma_regs;

#define STM32_DMA2 ((stm32_dma_regs *)(uintptr_t)0x40026400u)
#define STM32_DMA_CR_EN (1u << 0)
#define STM32_DMA_CR_DMEIE (1u << 1)
#define STM32_DMA_CR_TEIE (1u << 2)
#define STM32_DMA_CR_TCIE (1u << 4)
#define STM32_DMA_CR_FROM_MEMORY (1u << 6)
#define STM32_DMA_CR_CIRC (1u << 8)
#define STM32_DMA_CR_MINC (1u << 10)
#define STM32_DMA_CR_PSIZE16 (1u << 11)
#define STM32_DMA_CR_MSIZE16 (1u << 13)
#define STM32_DMA_CR_PRIORITY(n) ((uint32_t)(n) << 16)
#define STM32_DMA_CR_CHANNEL(n) ((uint32_t)(n) << 25)
/* Flags of a stream after stm32_dma_flags() */
#define STM32_DMA_FEIF (1u << 0)
#define STM32_DMA_DMEIF (1u << 2)
#define STM32_DMA_TEIF (1u << 3)
#define STM32_DMA_HTIF (1u << 4)
#define STM32_DMA_TCIF (1u << 5)
#define STM32_DMA_ALL 0x3Du

/** Place of a stream's flags in its status register: 0, 6, 16, 22. */
static inline unsigned stm32_dma_shift(unsigned stream)
{
    return (stream & 1u) * 6u + (stream & 2u) * 8u;
}

/** Flags of stream 0..7. */
static inline uint32_t stm32_dma_flags(unsigned stream)
{
    return STM32_DMA2->isr[stream >> 2] >> stm32_dma_shift(stream) & STM32_DMA_ALL;
}

static inline void stm32_dma_clear(unsigned stream, uint32_t flags)
{
    STM32_DMA2->ifcr[stream >> 2] = flags << stm32_dma_shift(stream);
}

/** Stops a stream; true if it has stopped (a transfer of one item under way is finished first). */
bool stm32_dma_stop(unsigned stream);

#endif
