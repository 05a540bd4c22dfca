/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file crc8.h
 * CRC-8, polynomial x^8 + x^2 + x + 1 (0x07), initial value 0, no reflection, no final XOR (PL-CRC-01).
 *
 * Three forms with the same result; each is an object of its own, so that a linker keeps only what is used.
 * All are pure functions: no state, no blocking, no failure.
 *
 * `crc` is 0 for the first piece of a message, or the result for the pieces before (a message may be fed in
 * pieces).
 * `data` points to `n` bytes; NULL is legal when n is 0. The result is the CRC of everything fed so far.
 */
#ifndef BQHOST_CRC8_H
#define BQHOST_CRC8_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** No table: smallest and slowest. */
uint8_t bq_crc8_bitwise(uint8_t crc, const uint8_t *data, size_t n);

/** 16 bytes of constant table, two look-ups per byte. */
uint8_t bq_crc8_table16(uint8_t crc, const uint8_t *data, size_t n);

/** 256 bytes of constant table, one look-up per byte. */
uint8_t bq_crc8_table256(uint8_t crc, const uint8_t *data, size_t n);

/** The form chosen when the library was built (CMake variable BQHOST_CRC8; table16 unless told otherwise). */
uint8_t bq_crc8(uint8_t crc, const uint8_t *data, size_t n);

#ifdef __cplusplus
}
#endif
#endif
