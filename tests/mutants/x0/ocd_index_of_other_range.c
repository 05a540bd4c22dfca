/* SPDX-License-Identifier: Apache-2.0 */
/* The OCD index looked up in the table of RSNS = 0 although RSNS = 1 is set. */
#include "x0_wrong.h"

const x0_wrong wrong = {0};

bq_status __real_bq769x0_current_codes(uint32_t ocd_uv, uint16_t ocd_delay_ms, uint32_t scd_uv,
                                       uint16_t scd_delay_us, bq769x0_current_limits *out);
bq_status __wrap_bq769x0_current_codes(uint32_t ocd_uv, uint16_t ocd_delay_ms, uint32_t scd_uv,
                                       uint16_t scd_delay_us, bq769x0_current_limits *out);

bq_status __wrap_bq769x0_current_codes(uint32_t ocd_uv, uint16_t ocd_delay_ms, uint32_t scd_uv,
                                       uint16_t scd_delay_us, bq769x0_current_limits *out)
{
    bq_status st = __real_bq769x0_current_codes(ocd_uv, ocd_delay_ms, scd_uv, scd_delay_us, out);
    static const uint8_t fine_mv[16] = {8, 11, 14, 17, 19, 22, 25, 28, 31, 33, 36, 39, 42, 44, 47, 50};
    unsigned i = 15;
    while (i > 0 && fine_mv[i] > ocd_uv / 1000u) {
        i--;
    }
    if (st == BQ_OK && (out->protect1 & 0x80u) != 0) {
        out->protect2 = (uint8_t)((out->protect2 & 0xf0u) | i);
        mutant_acted();
    }
    return st;
}
