/* SPDX-License-Identifier: Apache-2.0 */
/* Charge counting (X0-SEQ-26) and calibration against the stack (X0-SEQ-45). */
#include "x0_internal.h"
#include <string.h>

/* One result that was just fetched. d->counting.ms is where its window began at the latest: a window is
 * counted as what it is long, not as what passed between two looks. Windows that the clock says were lost are
 * filled with the mean of their neighbours (X0-AMB-99). */
void x0_count_charge(bq769x0 *d)
{
    bq769x0_counting *t = &d->counting;
    uint32_t ms = d->now_ms - t->ms, windows = ms / X0_SCAN_MS;
    int32_t ma = bq769x0_current_ma(d->cc_code, d->config.shunt_uohm);
    int32_t before = bq769x0_current_ma(t->code, d->config.shunt_uohm);
    if (windows == 0u) { /* earlier than thought: so are all that follow */
        windows = 1;
        t->ms = d->now_ms;
    } else {
        t->ms += windows * X0_SCAN_MS;
    }
    if (windows > 1u && t->charge.results != 0u) {
        t->charge.missed += windows - 1u;
        t->charge.uas += (int64_t)((before + ma) / 2) * (int32_t)((windows - 1u) * X0_SCAN_MS);
    }
    t->charge.uas += (int64_t)ma * (int32_t)X0_SCAN_MS;
    x0_bump(&t->charge.results);
    t->code = d->cc_code;
}

/* After each look at the counter: without a result the window that runs began less than its length ago. */
void x0_look_for_charge(bq769x0 *d)
{
    bq769x0_counting *t = &d->counting;
    if ((d->stat & BQ769X0_STAT_CC_READY) != 0u) {
        x0_count_charge(d);
    } else if (d->now_ms - t->ms > X0_SCAN_MS) {
        t->ms = d->now_ms - X0_SCAN_MS;
    }
}

const bq769x0_charge *bq769x0_get_charge(const bq769x0 *d)
{
    return &d->counting.charge;
}

void bq769x0_charge_reset(bq769x0 *d)
{
    bq769x0_counting *t = &d->counting;
    memset(&t->charge, 0, sizeof t->charge);
}

/* What configuration set for GAIN2 = 1, scaled. */
void x0_rescale(bq769x0 *d)
{
    uint32_t gain2 = d->gain2_q15;
    bq769x0_trim trim = x0_trim(d);
    d->scale = gain2 * trim.gain_uv / 125u;
    d->scale_zero = (int32_t)(gain2 * 8u) * trim.offset_mv + 0x20000;
}

static void rescale(bq769x0 *d, uint16_t gain2_q15)
{
    d->gain2_q15 = gain2_q15;
    x0_rescale(d);
}

bq_status bq769x0_calibrate(bq769x0 *d, uint32_t stack_mv)
{
    uint32_t sum = 0;
    uint16_t gain2 = d->gain2_q15;
    if (!x0_valid(d)) {
        return BQ_E_STALE;
    }
    rescale(d, 32768u);
    for (unsigned i = 0; i < d->known.cells; i++) {
        sum += x0_cell_mv(d, i);
    }
    rescale(d, gain2);
    if (sum == 0u || stack_mv > 110000u || stack_mv * 100u < sum * 97u || stack_mv * 100u > sum * 103u) {
        return BQ_E_RANGE; /* X0-AMB-20 */
    }
    rescale(d, (uint16_t)((stack_mv * 32768u + sum / 2u) / sum));
    for (unsigned i = 0; i < d->known.cells; i++) {
        d->calibrated_mv[i] = (uint16_t)x0_cell_mv(d, i);
    }
    return BQ_OK;
}

bool bq769x0_calibration_due(const bq769x0 *d)
{
    for (unsigned i = 0; i < d->known.cells; i++) {
        int32_t moved = (int32_t)x0_cell_mv(d, i) - (int32_t)d->calibrated_mv[i];
        if (moved > 100 || moved < -100) {
            return true;
        }
    }
    return false;
}
