/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32_usart.h
 * USART2 of this generation (RM0091 27.8), for hal/stm32/stm32_uart.c. Every family has a file of this name.
 */
#ifndef STM32_USART_H
#define STM32_USART_H

#include "stm32_regs.h"
#include <stdbool.h>

typedef struct stm32_usart_regs {
    volatile uint32_t cr1, cr2, cr3, brr, gtpr, rtor, rqr, isr, icr, rdr, tdr;
} stm32_usart_regs;

#define STM32_USART2 ((stm32_usart_regs *)(uintptr_t)0x40004400u)
#define STM32_USART_CR1_UE (1u << 0)
#define STM32_USART_CR1_RE (1u << 2)
#define STM32_USART_CR1_TE (1u << 3)
#define STM32_USART_CR1_RXNEIE (1u << 5)
#define STM32_USART_CR1_TXEIE (1u << 7)
#define STM32_USART_ISR_FE (1u << 1)
#define STM32_USART_ISR_NF (1u << 2)
#define STM32_USART_ISR_ORE (1u << 3)
#define STM32_USART_ISR_RXNE (1u << 5)
#define STM32_USART_ISR_TXE (1u << 7)

/** 8N1 with 16 samples a bit; `divider` = clock / baud. */
static inline void stm32_usart_start(uint32_t divider)
{
    STM32_USART2->cr1 = 0; /* BRR is written while the USART is off */
    STM32_USART2->brr = divider;
    STM32_USART2->cr1 = STM32_USART_CR1_UE | STM32_USART_CR1_RE | STM32_USART_CR1_TE | STM32_USART_CR1_RXNEIE;
}

/** Takes a received byte, `*damaged` for one with an error; or reports an overrun as one damaged byte. False:
 * nothing there. */
static inline bool stm32_usart_take(uint8_t *byte, bool *damaged)
{
    uint32_t isr = STM32_USART2->isr;
    uint32_t errors = isr & (STM32_USART_ISR_FE | STM32_USART_ISR_NF);
    *damaged = false;
    if ((isr & STM32_USART_ISR_RXNE) != 0u) {
        *byte = (uint8_t)STM32_USART2->rdr;
        *damaged = errors != 0u;
        STM32_USART2->icr = errors; /* the clear bits stand where the flags do */
        return true;
    }
    if ((isr & STM32_USART_ISR_ORE) != 0u) {
        STM32_USART2->icr = STM32_USART_ISR_ORE;
        *damaged = true;
        return true;
    }
    return false;
}

/** Whether the transmit interrupt is on and the data register has room. */
static inline bool stm32_usart_tx_due(void)
{
    return (STM32_USART2->cr1 & STM32_USART_CR1_TXEIE) != 0u &&
           (STM32_USART2->isr & STM32_USART_ISR_TXE) != 0u;
}

static inline void stm32_usart_put(uint8_t byte)
{
    STM32_USART2->tdr = byte;
}

static inline void stm32_usart_tx_irq(bool on)
{
    uint32_t cr1 = STM32_USART2->cr1 & ~STM32_USART_CR1_TXEIE;
    STM32_USART2->cr1 = on ? cr1 | STM32_USART_CR1_TXEIE : cr1;
}

#endif
