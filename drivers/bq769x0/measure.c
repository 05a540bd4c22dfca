/* SPDX-License-Identifier: Apache-2.0 */
/* The measurement cycle: status, all measurements, clearing of the fetched result (X0-SEQ-21..23). */
#include "x0_internal.h"
#include <string.h>

static uint16_t pair(const uint8_t *p)
{
    return (uint16_t)((unsigned)p[0] << 8 | p[1]);
}

void x0_invalidate(bq769x0 *d, uint16_t fault)
{
    d->valid = d->temp_valid = false;
    d->faults |= fault;
}

/* BAT is a quarter of the sum of all codes of the same scan, within 1 (X0-BAT-05). A block read across a
 * publication fails this too: it is then read again. */
static bool plausible(uint32_t sum, uint32_t bat)
{
    return sum != 0u && bat + 1u - sum / 4u <= 2u;
}

/* d->data holds the cells, and from X0_TAIL on BAT and the temperatures. */
static void take_picture(bq769x0 *d)
{
    unsigned registers = d->temp_held ? X0_TS : X0_TS + 3u;
    uint32_t sum = 0;
    for (unsigned i = 0; i < registers; i++) {
        unsigned code = pair(d->data + 2u * i);
        if (i != X0_BAT) {
            code &= 0x3fffu; /* X0-BIT-16 */
        }
        if (i < d->config.inputs) {
            sum += code;
        }
        d->code[i] = (uint16_t)code;
    }
    d->valid = plausible(sum, d->code[X0_BAT]);
    if (!d->valid) {
        x0_bump(&d->stats.implausible);
    }
    if ((d->stat & BQ769X0_STAT_XREADY) != 0u) {
        d->valid = false;
    }
    d->measured |= d->valid;
    d->temp_settled |= d->now_ms - d->temp_ms >= X0_TEMP_MS;
    d->temp_valid = d->valid && d->temp_settled;
    d->balanced = d->balance;
    d->picture_ms = d->now_ms;
    d->picture_us = d->now_us;
    d->sequence++;
}

/* One fetched result of the coulomb counter. */
void x0_take_current(bq769x0 *d, const uint8_t *cc)
{
    int code = (int16_t)pair(cc);
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
        f->n = 40;
        if (d->config.inputs != BQ769X0_INPUTS) {
            SEQ_TRY(1, x0_fetch(d, BQ769X0_BAT_HI, 10));
            memcpy(d->data + X0_TAIL, d->data, 10);
            f->n = (uint8_t)(2u * d->config.inputs);
        }
        SEQ_TRY(2, x0_fetch(d, BQ769X0_VC1_HI, f->n));
        take_picture(d);
        if (d->valid) {
            break;
        }
    }
    if ((d->stat & BQ769X0_STAT_CC_READY) != 0u) {
        x0_take_current(d, d->data + X0_CC);
    }
    return BQ_OK;
    SEQ_END;
}

/* SYS_STAT first and its clearing last, so that a result that arrives in between is not cleared unseen. */
int x0_job_measure(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    d->faults = 0;
    SEQ_CALL(1, x0_fetch(d, BQ769X0_SYS_STAT, 1));
    if (d->result == BQ_OK) {
        d->stat = d->data[0] & BQ769X0_STAT_CLEAR;
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
        d->frames[0].n = 1; /* of register SYS_STAT */
    }
    return st;
}
