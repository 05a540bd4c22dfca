/* SPDX-License-Identifier: Apache-2.0 */
/* Charge counting (X0-SEQ-26) and calibration against the stack (X0-SEQ-45). */
#include "x0_internal.h"
#include <string.h>

/* One result that was just fetched. Its time is measured by the host's clock (X0-AMB-99); windows that the
 * clock says were lost are filled with the mean of their neighbours. */
void x0_count_charge(bq769x0 *d)
{
    uint32_t ms = d->cc_ms - d->charge_ms, windows = (ms + X0_SCAN_MS / 2u) / X0_SCAN_MS, own = ms;
    int32_t ma = bq769x0_current_ma(d->cc_code, d->config.shunt_uohm);
    int32_t before = bq769x0_current_ma(d->charge_code, d->config.shunt_uohm);
    if (windows > 1u) {
        own = ms / windows;
        if (d->charge.results != 0u) {
            d->charge.missed += windows - 1u;
            d->charge.uas += (int64_t)((before + ma) / 2) * (int32_t)(ms - own);
        }
    }
    d->charge.uas += (int64_t)ma * (int32_t)own;
    x0_bump(&d->charge.results);
    d->charge_code = d->cc_code;
}

const bq769x0_charge *bq769x0_get_charge(const bq769x0 *d)
{
    return &d->charge;
}

void bq769x0_charge_reset(bq769x0 *d)
{
    memset(&d->charge, 0, sizeof d->charge);
}

bq_status bq769x0_calibrate(bq769x0 *d, uint32_t stack_mv)
{
    uint32_t sum = 0;
    uint16_t gain2 = d->gain2_q15;
    if (!d->valid) {
        return BQ_E_STALE;
    }
    d->gain2_q15 = 32768u;
    for (unsigned i = 0; i < d->inputs; i++) {
        sum += (d->in_use >> i & 1u) != 0u ? x0_cell_mv(d, i) : 0u;
    }
    d->gain2_q15 = gain2;
    if (sum == 0u || stack_mv > 110000u || stack_mv * 100u < sum * 97u || stack_mv * 100u > sum * 103u) {
        return BQ_E_RANGE; /* X0-AMB-20 */
    }
    d->gain2_q15 = (uint16_t)((stack_mv * 32768u + sum / 2u) / sum);
    for (unsigned i = 0; i < d->inputs; i++) {
        d->calibrated_mv[i] = (uint16_t)x0_cell_mv(d, i);
    }
    return BQ_OK;
}

bool bq769x0_calibration_due(const bq769x0 *d)
{
    for (unsigned i = 0; i < d->inputs; i++) {
        int32_t moved = (int32_t)x0_cell_mv(d, i) - (int32_t)d->calibrated_mv[i];
        if ((d->in_use >> i & 1u) != 0u && (moved > 100 || moved < -100)) {
            return true;
        }
    }
    return false;
}
