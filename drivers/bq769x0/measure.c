/* SPDX-License-Identifier: Apache-2.0 */
/* The measurement cycle: status, all measurements, clearing of the fetched result (X0-SEQ-21..23). */
#include "x0_internal.h"
#include <string.h>

/* A transfer of `n` codes. */
static int fetch_codes(unsigned first, unsigned n)
{
    return X0_FETCH(BQ769X0_VC1_HI, 0) + (int)(first << 17) + (int)(n << 25);
}

/* `n` codes from x0_data() to d->fresh; the sum of those that are inputs, whose upper bits are no data
 * (X0-BIT-16). */
static uint32_t take_codes(bq769x0 *d, unsigned first, unsigned n)
{
    const uint8_t *p = x0_data(d);
    uint32_t sum = 0;
    for (uint16_t *to = &d->fresh[first]; n != 0u; n--, p += 2) {
        unsigned code = p[0] * 256u + p[1];
        if (to < &d->fresh[X0_BAT]) {
            code &= 0x3fffu;
            sum += code;
        }
        *to++ = (uint16_t)code;
    }
    return sum;
}

/* Cells close up, whatever inputs carry them, and temperatures follow; another source of these leaves them
 * alone. */
static void keep_codes(bq769x0 *d)
{
    const uint16_t *from = d->fresh;
    uint16_t *to = d->code;
    unsigned kept = d->known.in_use;
    if (!d->temp_held) {
        kept |= 7u << X0_TS;
    }
    for (; kept != 0u; kept >>= 1) {
        *to = *from++;
        to += kept & 1u;
    }
}

/* BAT is a quarter of the sum of all inputs of the same scan, within 1 (X0-BAT-05). A block read across a
 * publication fails this too: it is then read again. What is refused leaves the codes of the last good
 * picture alone. */
static void take_picture(bq769x0 *d, uint32_t sum)
{
    unsigned quality = BQ_Q_CHIP;
    if (sum == 0u || d->fresh[X0_BAT] + 1u - sum / 4u > 2u) {
        x0_bump(&d->stats.implausible);
    } else if ((d->stat & BQ769X0_STAT_XREADY) == 0u) {
        quality = BQ_Q_VALID;
        keep_codes(d);
    }
    d->quality = (uint8_t)quality;
    if (d->temp_settled || d->now_ms - d->temp_ms >= X0_TEMP_MS) {
        d->temp_settled = true;
        d->temp_quality = (uint8_t)quality;
    } else {
        d->temp_quality = BQ_Q_CHIP;
    }
    d->balanced = d->balance;
    d->picture_ms = d->now_ms;
}

/* One fetched result of the coulomb counter. */
void x0_take_current(bq769x0 *d, uint16_t raw)
{
    int code = (int16_t)raw;
    d->cc_code = d->known.invert_current ? -code : code;
    d->cc_ms = d->now_ms;
    d->current_seen = true;
}

/* All measurements: one block on the largest part; on smaller ones the cells come after the rest, which costs
 * fewer bytes. f->i, f->x: first and number of the codes. */
int x0_job_picture(bq769x0 *d, bq769x0_frame *f)
{
    uint32_t sum;
    SEQ_BEGIN(f)
    for (;;) {
        f->i = d->known.first;
        for (;;) {
            SEQ_TRY(1, fetch_codes(f->i, f->i != 0u ? 5u : d->known.codes));
            sum = take_codes(d, f->i, (unsigned)f->next >> 25);
            if (f->i == 0u) {
                break;
            }
            f->i = 0;
        }
        take_picture(d, sum);
        if (x0_valid(d) || f->tries != 0u) {
            break;
        }
        f->tries = 1;
        SEQ_TRY(2, x0_wait(d, 0)); /* work enough for one poll */
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
    SEQ_CALL(1, X0_FETCH_STAT);
    if (d->result == BQ_OK) {
        d->stat = d->answer & BQ769X0_STAT_CLEAR;
        if (!d->no_data) {
            SEQ_RUN_CALL(2, x0_job_picture);
        }
    }
    if (d->result != BQ_OK) {
        x0_invalidate(d, BQ_Q_COMM);
        d->suspect = true; /* look at the configuration once the bus is back */
        return d->result;
    }
    if ((d->stat & BQ769X0_STAT_CC_READY) != 0u) {
        d->cc_ms = d->now_ms; /* also a result that came while no picture counts */
        d->known.registers[0] = BQ769X0_STAT_CC_READY;
        SEQ_TRY(3, X0_PUT(BQ769X0_SYS_STAT, 1));
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
        d->known.registers[0] = d->stat & BQ769X0_STAT_FAULTS;
        d->top->op = X0_PUT(BQ769X0_SYS_STAT, 1);
    }
    return st;
}
