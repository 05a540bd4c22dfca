/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32_watchdog.h
 * The independent watchdog: nominally one second from its own oscillator. Once started nothing but a reset
 * stops it.
 */
#ifndef STM32_WATCHDOG_H
#define STM32_WATCHDOG_H

/** Starts it. Blocks for some periods of the internal oscillator, below 1 ms; bounded by a count to 10 ms. */
void stm32_watchdog_start(void);
void stm32_watchdog_feed(void);

#endif
