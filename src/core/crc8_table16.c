/* SPDX-License-Identifier: Apache-2.0 */
#include "bqhost/crc8.h"

/* CRC of each value of one nibble shifted in alone. */
static const uint8_t nibble_crc[16] = {
    0x00, 0x07, 0x0e, 0x09, 0x1c, 0x1b, 0x12, 0x15, 0x38, 0x3f, 0x36, 0x31, 0x24, 0x23, 0x2a, 0x2d,
};

uint8_t bq_crc8_table16(uint8_t crc, const uint8_t *data, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        crc ^= data[i];
        crc = (uint8_t)((unsigned)crc << 4 ^ nibble_crc[crc >> 4]);
        crc = (uint8_t)((unsigned)crc << 4 ^ nibble_crc[crc >> 4]);
    }
    return crc;
}
