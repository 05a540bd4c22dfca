/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32_time.h
 * TIM2 as free-running 32-bit counter of microseconds, and sleep. TIM2 runs while the core sleeps (WFI
 * without SLEEPDEEP). The prescaler is of the nominal clock, STM32_TIM2_HZ; after a fall-back the same
 * frequency stands there with the accuracy of the internal oscillator.
 */
#ifndef STM32_TIME_H
#define STM32_TIME_H

#include "bqhost/hal.h"
#include "stm32_regs.h"

/** One time base; the board owns it. */
typedef struct stm32_time {
    volatile bool event; /* something has happened that the main loop should see */
} stm32_time;

/** Starts the counter at 0 and enables its interrupt. Call after the clock tree is up. */
void stm32_time_init(stm32_time *time);

static inline uint32_t stm32_now_us(void)
{
    return STM32_TIM2->cnt;
}

/** Waits `us` microseconds by looking at the counter, at most 1 us longer (and interrupts that come). */
void stm32_wait_us(uint32_t us);

/** From an interrupt handler: the next (or the running) stm32_time_sleep() returns at once. */
static inline void stm32_time_event(stm32_time *time)
{
    time->event = true;
}

/**
 * Sleeps until `us` microseconds from now have passed or an interrupt reported an event, whatever is first.
 * An event that was reported since the last sleep ended makes it return at once. `us` 0 returns at once; more
 * than 2^31 - 1 counts as that. Free of the race between looking and sleeping.
 */
void stm32_time_sleep(stm32_time *time, uint32_t us);

/** For the board's TIM2 handler. */
void stm32_time_irq(stm32_time *time);

bq_clock stm32_clock(void);

#endif
