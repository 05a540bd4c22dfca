/* SPDX-License-Identifier: Apache-2.0 */
/* Bits 7 and 6 of the high byte of a cell taken for data. */
#include "x0_wrong.h"

const x0_wrong wrong = {0};

bq_status __real_bq769x0_sample(bq769x0 *d, bq_sample *s);
bq_status __wrap_bq769x0_sample(bq769x0 *d, bq_sample *s);

bq_status __wrap_bq769x0_sample(bq769x0 *d, bq_sample *s)
{
    bq_status st = __real_bq769x0_sample(d, s);
    uint16_t in_use = bq769x0_wiring(x0_wrong_config()->inputs, x0_wrong_config()->cells);
    for (unsigned i = 0, cell = 0; st == BQ_OK && cell < s->cell_count; i++) {
        unsigned extra = (x0_wrong_seen((uint8_t)(BQ769X0_VC1_HI + 2u * i)) & 0xc0u) << 8;
        if ((in_use >> i & 1) == 0) {
            continue;
        }
        if (extra != 0) {
            mutant_acted();
        }
        s->cells[cell].mv =
            (uint16_t)(s->cells[cell].mv + extra * bq769x0_get_achieved(d)->trim.gain_uv / 1000u);
        cell++;
    }
    return st;
}
