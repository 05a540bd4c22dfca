/* SPDX-License-Identifier: Apache-2.0 */
#include "bqhost/crc8.h"

#ifndef BQHOST_CRC8
#define BQHOST_CRC8 table16
#endif
#define JOIN(form) bq_crc8_##form
#define FORM(form) JOIN(form)

uint8_t bq_crc8(uint8_t crc, const uint8_t *data, size_t n)
{
    return FORM(BQHOST_CRC8)(crc, data, n);
}
