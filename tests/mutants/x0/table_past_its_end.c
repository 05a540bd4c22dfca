/* SPDX-License-Identifier: Apache-2.0 */
/* A table scanned past its end (its size in bytes taken for the number of entries). */
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
    /* the 8 entries, and what the linker put behind them */
    static const uint16_t ms[16] = {8, 20, 40, 80, 160, 320, 640, 1280, 70, 100, 200, 400, 1, 2, 4, 8};
    unsigned i = 15;
    while (i > 0 && ms[i] > ocd_delay_ms) {
        i--;
    }
    if (st == BQ_OK) {
        out->protect2 = (uint8_t)((out->protect2 & 0x0fu) | i << 4);
        mutant_acted();
    }
    return st;
}
