/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32_core.h
 * The Cortex-M core: interrupt mask, barriers, sleep, NVIC. Everything returns at once.
 */
#ifndef STM32_CORE_H
#define STM32_CORE_H

#include "stm32_regs.h"

/** Masks interrupts and returns the mask as it was, for stm32_unlock(). NMI and HardFault still come. */
static inline uint32_t stm32_lock(void)
{
    uint32_t mask;
    __asm volatile("mrs %0, primask\n\tcpsid i" : "=r"(mask)::"memory");
    return mask;
}

static inline void stm32_unlock(uint32_t mask)
{
    __asm volatile("msr primask, %0" ::"r"(mask) : "memory");
}

/** The same, and what was pending meanwhile has been served on return: without the barrier a following
 * stm32_lock() may come first. */
static inline void stm32_unlock_and_serve(uint32_t mask)
{
    __asm volatile("msr primask, %0\n\tisb" ::"r"(mask) : "memory");
}

static inline void stm32_dsb(void)
{
    __asm volatile("dsb" ::: "memory");
}

/** Sleeps until an interrupt is pending, also while interrupts are masked. */
static inline void stm32_wfi(void)
{
    __asm volatile("dsb\n\twfi" ::: "memory");
}

/** Clears a stale request of interrupt `irq`, gives it `priority` 0 (highest) .. 3 and enables it. */
void stm32_irq_enable(unsigned irq, unsigned priority);

#endif
