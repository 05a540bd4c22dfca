/* SPDX-License-Identifier: Apache-2.0 */
#include "bqhost/crc8.h"

uint8_t bq_crc8_bitwise(uint8_t crc, const uint8_t *data, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        crc ^= data[i];
        for (unsigned bit = 0; bit < 8u; bit++) {
            crc = (uint8_t)((unsigned)crc << 1 ^ ((crc & 0x80u) != 0u ? 0x07u : 0u));
        }
    }
    return crc;
}
