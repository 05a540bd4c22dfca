/* SPDX-License-Identifier: Apache-2.0 */
/* The measurement cycle: status, all measurements, clearing of the fetched result (X0-SEQ-21..23). */
#include "x0_internal.h"
#include <string.h>

void x0_invalidate(bq769x0 *d, uint16_t fault)
{
    d->valid = d->temp_valid = false;
    d->faults |= fault;
}

/* `n` codes from x0_data() to d->fresh. Upper bits of cells and temperatures are no data (X0-BIT-16). */
static void take_codes(bq769x0 *d, unsigned first, unsigned n)
{
    const uint8_t *p = x0_data(d);
    for (n += first; first < n; first++, p += 2) {
        unsigned code = (unsigned)p[0] << 8 | p[1];
        if (first != X0_BAT && first != X0_CC) {
            code &= 0x3fffu;
        }
        d->fresh[first] = (uint16_t)code;
    }
}

/* BAT is a quarter of the sum of all codes of the same scan, within 1 (X0-BAT-05). A block read across a
 * publication fails this too: it is then read again. */
static bool plausible(const bq769x0 *d)
{
    uint32_t sum = 0;
    for (unsigned i = 0; i < X0_BAT; i++) {
        sum += d->fresh[i];
    }
    return sum != 0u && d->fresh[X0_BAT] + 1u - sum / 4u <= 2u;
}

/* What is refused leaves the codes of the last good picture alone, and so does another source of the
 * temperatures. */
static void take_picture(bq769x0 *d)
{
    bool good = plausible(d);
    if (!good) {
        x0_bump(&d->stats.implausible);
    }
    d->valid = good && (d->stat & BQ769X0_STAT_XREADY) == 0u;
    if (d->valid) {
        d->measured = true;
        memcpy(d->code, d->fresh, (d->temp_held ? X0_TS : X0_CC) * sizeof d->code[0]);
    }
    if (d->now_ms - d->temp_ms >= X0_TEMP_MS) {
        d->temp_settled = true;
    }
    d->temp_valid = d->valid && d->temp_settled;
    d->balanced = d->balance;
    d->picture_ms = d->now_ms;
    d->picture_us = d->now_us;
    d->sequence++;
}

/* One fetched result of the coulomb counter. */
void x0_take_current(bq769x0 *d, uint16_t raw)
{
    int code = (int16_t)raw;
    if (d->config.invert_current) {
        code = code == INT16_MIN ? INT16_MAX : -code;
    }
    d->cc_code = (int16_t)code;
    d->cc_ms = d->now_ms;
    d->current_seen = true;
}

/* All measurements: one block on the largest part; on smaller ones cells and the rest apart, which costs
 * fewer bytes. */
int x0_job_picture(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    for (f->tries = 0; f->tries < 2u; f->tries++) {
        f->n = 20;
        if (d->inputs != BQ769X0_INPUTS) {
            SEQ_TRY(1, x0_fetch(d, BQ769X0_BAT_HI, 10));
            take_codes(d, X0_BAT, 5);
            f->n = d->inputs;
        }
        SEQ_TRY(2, x0_fetch(d, BQ769X0_VC1_HI, 2u * f->n));
        take_codes(d, 0, f->n);
        take_picture(d);
        if (d->valid) {
            break;
        }
        SEQ_YIELD(3, x0_wait(d, 0)); /* work enough for one poll */
    }
    if ((d->stat & BQ769X0_STAT_CC_READY) != 0u) {
        x0_take_current(d, d->fresh[X0_CC]);
    }
    return BQ_OK;
    SEQ_END;
}

/* SYS_STAT first and its clearing last, so that a result that arrives in between is not cleared unseen. */
int x0_job_measure(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    d->faults = 0;
    SEQ_CALL(1, x0_fetch_stat(d));
    if (d->result == BQ_OK) {
        d->stat = d->answer & BQ769X0_STAT_CLEAR;
        if (x0_reached(d, d->data_ms)) {
            d->data_ms = d->now_ms; /* for ever reached */
            SEQ_CALL(2, x0_run(d, x0_job_picture));
        }
    }
    if (d->result != BQ_OK) {
        x0_invalidate(d, BQ_F_COMM);
        d->scrub_ms = d->now_ms - X0_SCRUB_MS; /* look at the configuration once the bus is back */
        return d->result;
    }
    if ((d->stat & BQ769X0_STAT_CC_READY) != 0u) {
        d->cc_ms = d->now_ms; /* also a result that came while no picture counts */
        d->want[0] = BQ769X0_STAT_CC_READY;
        SEQ_TRY(3, x0_put(d, BQ769X0_SYS_STAT, 1));
    }
    if (d->valid) {
        x0_bump(&d->stats.scans);
    }
    return BQ_OK;
    SEQ_END;
}

bq_status bq769x0_begin_measure(bq769x0 *d)
{
    return x0_begin(d, X0_STATE_READY, x0_job_measure);
}

bq_status bq769x0_begin_clear(bq769x0 *d)
{
    bq_status st = x0_begin(d, X0_STATE_READY, x0_job_transfer);
    if (st == BQ_OK) {
        d->want[0] = d->stat & BQ769X0_STAT_FAULTS;
        d->top->n = 1; /* of register SYS_STAT */
    }
    return st;
}
