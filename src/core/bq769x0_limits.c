/* SPDX-License-Identifier: Apache-2.0 */
/* One limit of the bq769x0 at a time. */
#include "bqhost/bq769x0_convert.h"

/* OV: the largest trip with 0x2008 + 16 trip not above the request. UV: the smallest with 0x1000 + 16 trip
 * not below it: one above the largest that is below. */
unsigned bq769x0_trip(uint32_t gain_uv, int32_t above_mv, bool under)
{
    uint32_t uv = (uint32_t)above_mv * 1000u, first = 0x2008; /* below 0: above every limit */
    if (under) {
        uv--;
        first = 0x1000 - 16;
    }
    return (uv / gain_uv - first) >> 4;
}

/* Delays double from code 1 on; code 0 has one of its own. */
int bq769x0_delay_code(bq769x0_delay kind, unsigned limit, uint16_t *achieved)
{
    static const struct {
        uint8_t of_code_0, of_code_1, codes;
    } row[] = {{8, 20, 8}, {70, 100, 4}, {1, 2, 4}, {1, 4, 4}};
    unsigned value = row[kind].of_code_0, next = row[kind].of_code_1;
    int code = 0;
    if (limit < value) {
        return -1;
    }
    while (++code < row[kind].codes && next <= limit) {
        value = next;
        next *= 2u;
    }
    *achieved = (uint16_t)value;
    return code - 1;
}

uint32_t bq769x0_shunt_uv(uint32_t ma, uint32_t shunt_uohm)
{
    uint32_t amp = ma / 1000u, rest = ma % 1000u; /* the product is in nV: too long for 32 bits */
    return amp > 4000u ? UINT32_MAX : amp * shunt_uohm + rest * shunt_uohm / 1000u;
}
