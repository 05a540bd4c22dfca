/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32_clock.h
 * The clock tree: written by each family.
 */
#ifndef STM32_CLOCK_H
#define STM32_CLOCK_H

#include <stdbool.h>

/** From the internal oscillator after reset to the full speed, STM32_CORE_HZ: by the crystal (with its
 * security system on), or, if that does not start within its bound, from the internal oscillator. Every wait
 * is bounded. True: the crystal. */
bool stm32_clock_start(void);

/** For the NMI handler: the crystal stopped. The hardware has gone to the internal oscillator; goes back to
 * full speed with that. Returns true if the NMI was this. Everything derived from the clock keeps its
 * frequency; about 100 us of time are lost. */
bool stm32_clock_failed(void);

#endif
