/* SPDX-License-Identifier: Apache-2.0 */
#include "stm32f0_divide.h"

uint64_t stm32f0_divide(uint32_t n, uint32_t d)
{
    uint32_t quotient = 0, bit = d != 0u;
    /* d becomes its largest multiple by a power of two that n holds, first in large steps */
    while (d != 0u && d <= n >> 8) {
        d <<= 8;
        bit <<= 8;
    }
    while (d != 0u && d <= n >> 1) {
        d <<= 1;
        bit <<= 1;
    }
    for (; bit != 0u; bit >>= 1, d >>= 1) {
        if (n >= d) {
            n -= d;
            quotient |= bit;
        }
    }
    return (uint64_t)n << 32 | quotient;
}

static uint32_t magnitude(int32_t value)
{
    return value < 0 ? 0u - (uint32_t)value : (uint32_t)value;
}

uint64_t stm32f0_divide_signed(int32_t n, int32_t d)
{
    uint64_t both = stm32f0_divide(magnitude(n), magnitude(d));
    uint32_t quotient = (uint32_t)both, rest = (uint32_t)(both >> 32);
    if ((n < 0) != (d < 0)) {
        quotient = 0u - quotient;
    }
    if (n < 0) {
        rest = 0u - rest;
    }
    return (uint64_t)rest << 32 | quotient;
}

/* The run-time ABI for the Arm architecture wants the quotient in r0 and the remainder in r1, which is how a
 * number of 64 bits is returned; whoever asks for the quotient only does not look at r1. */
#ifdef __arm__
#define SAME(name, parameter, as) uint64_t name(parameter n, parameter d) __attribute__((used, alias(#as)))
SAME(__aeabi_uidiv, uint32_t, stm32f0_divide);
SAME(__aeabi_uidivmod, uint32_t, stm32f0_divide);
SAME(__aeabi_idiv, int32_t, stm32f0_divide_signed);
SAME(__aeabi_idivmod, int32_t, stm32f0_divide_signed);
#endif
