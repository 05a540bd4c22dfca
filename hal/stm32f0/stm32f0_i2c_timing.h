/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32f0_i2c_timing.h
 * I2C_TIMINGR for 100 kHz (RM0091 26.4.9), as numbers that a test compares with the I2C standard. The kernel
 * clock is HSI, 8 MHz: it does not change when the crystal fails.
 *
 *     field    counts  time                        standard mode wants
 *     PRESC    / 2     quantum of 250 ns
 *     SCLL     22      5.50 us low                 4.7 us or more
 *     SCLH     16      4.00 us high                4.0 us or more
 *     SDADEL   2       0.50 us data after SCL low  0 .. 3.45 us
 *     SCLDEL   5       1.25 us data before SCL high, as long as the rise (1.0 us) and set-up (0.25 us) take
 *
 * The peripheral adds the filter and the synchronisation of each edge, 0.6 us in all at least: 99 kHz or less.
 */
#ifndef STM32F0_I2C_TIMING_H
#define STM32F0_I2C_TIMING_H

#define STM32_I2C_KERNEL_HZ 8000000u
#define STM32_I2C_PRESC 2u
#define STM32_I2C_SCLL 22u
#define STM32_I2C_SCLH 16u
#define STM32_I2C_SDADEL 2u
#define STM32_I2C_SCLDEL 5u

/* SDADEL alone holds the count itself; the others hold count - 1. */
#define STM32_I2C_TIMINGR                                                                                    \
    ((STM32_I2C_PRESC - 1u) << 28 | (STM32_I2C_SCLDEL - 1u) << 20 | STM32_I2C_SDADEL << 16 |                 \
     (STM32_I2C_SCLH - 1u) << 8 | (STM32_I2C_SCLL - 1u))

#endif
