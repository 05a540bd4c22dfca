/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32f0_divide.h
 * Division for a core that has none. The compiler's own takes 740 bytes of flash to be fast; these take 90
 * and up to 400 cycles, which the firmware can afford. On the target they stand under the names by which the
 * compiler calls them.
 */
#ifndef STM32F0_DIVIDE_H
#define STM32F0_DIVIDE_H

#include <stdint.h>

/** Quotient in the lower, remainder in the upper half. A divisor of 0: quotient 0, remainder `n`. */
uint64_t stm32f0_divide(uint32_t n, uint32_t d);

/** The same for signed numbers, towards 0; the remainder has the sign of `n`. */
uint64_t stm32f0_divide_signed(int32_t n, int32_t d);

#endif
