/* SPDX-License-Identifier: Apache-2.0 */
/* Fault service and recovery (X0-SEQ-28..37), outputs (X0-FET-13, X0-SEQ-38..41). */
#include "x0_internal.h"
#include <string.h>

#define OVERCURRENT (BQ769X0_STAT_SCD | BQ769X0_STAT_OCD)
#define STRIKES_MAX 5u

static uint16_t flags_of(uint8_t stat)
{
    static const uint16_t flag[6] = {BQ_F_OVERCURRENT, BQ_F_SHORT, BQ_F_CELL_OV,
                                     BQ_F_CELL_UV,     BQ_F_CHAIN, BQ_F_MEMORY};
    uint16_t flags = 0;
    for (unsigned i = 0; i < 6u; i++) {
        if (((unsigned)stat >> i & 1u) != 0u) {
            flags |= flag[i];
        }
    }
    return flags;
}

/* FETs that must stay off while these bits are not released. Overcurrent also needs CHG off to see the load
 * (X0-LOAD-03). */
static uint8_t forbidden(uint8_t held)
{
    uint8_t fets = 0;
    if ((held & ~(unsigned)BQ769X0_STAT_UV) != 0u) {
        fets |= BQ769X0_CTRL2_CHG_ON;
    }
    if ((held & ~(unsigned)BQ769X0_STAT_OV) != 0u) {
        fets |= BQ769X0_CTRL2_DSG_ON;
    }
    return fets;
}

/* Whether the cause is gone by the driver's own readings. */
static bool cured(const bq769x0 *d)
{
    uint8_t held = d->held;
    bool cells = (held & (BQ769X0_STAT_OV | BQ769X0_STAT_UV)) != 0u;
    if (d->locked || (cells && !d->valid) || ((held & OVERCURRENT) != 0u && d->loads < 4u)) {
        return false;
    }
    for (unsigned i = 0; cells && i < d->config.inputs; i++) {
        if ((d->in_use >> i & 1u) != 0u) {
            int32_t mv = x0_cell_mv(d, i);
            if (((held & BQ769X0_STAT_OV) != 0u && mv >= (int32_t)d->config.ov_recover_mv) ||
                ((held & BQ769X0_STAT_UV) != 0u &&
                 (mv <= (int32_t)d->config.uv_recover_mv || d->code[i] < BQ769X0_UV_MINQUAL))) {
                return false;
            }
        }
    }
    return true;
}

/* For how long it must have been gone. */
static uint32_t quiet_ms(const bq769x0 *d)
{
    uint32_t ms = (d->held & OVERCURRENT) != 0u ? 250u : 2000u;
    if ((d->held & BQ769X0_STAT_OVRD_ALERT) != 0u) {
        ms = d->strikes != 0u ? 5000u : 1000u;
    }
    if ((d->held & BQ769X0_STAT_XREADY) != 0u) {
        ms = 3000u;
    }
    return ms << (d->strikes < STRIKES_MAX ? d->strikes : STRIKES_MAX);
}

/* How long the bits must stay clear: the longest delay that could bring them back, and 500 ms. */
static uint32_t probation_ms(const bq769x0 *d)
{
    uint32_t ms = (d->held & OVERCURRENT) != 0u ? d->achieved.current.ocd_delay_ms : 1000u;
    if ((d->held & BQ769X0_STAT_OV) != 0u) {
        ms = 1000u << (d->achieved.protect3 >> 4 & 3u);
    }
    if ((d->held & BQ769X0_STAT_UV) != 0u && ms < (1000u << (d->achieved.protect3 >> 6)) * 2u) {
        ms = d->achieved.protect3 >> 6 == 0u ? 1000u : 2000u << (d->achieved.protect3 >> 6);
    }
    return ms + 500u;
}

static void take_event(bq769x0 *d, uint8_t fresh)
{
    bool again = d->now_ms - d->event_ms < 10000u && d->event_ms != 0u;
    if (!again) {
        d->strikes = 0;
    } else if (d->strikes < STRIKES_MAX) {
        d->strikes++;
    }
    d->locked = d->locked || ((fresh & BQ769X0_STAT_SCD) != 0u && d->strikes >= STRIKES_MAX);
    d->event_ms = d->now_ms | 1u;
    d->held |= fresh;
    d->probation = false;
    d->loads = 0;
    d->held_ms = d->now_ms;
    d->balance = 0;
}

/* Runs once per scan while a fault bit is set or not yet released. d->stat was read at its beginning. */
bq_status x0_job_service(bq769x0 *d, bq769x0_frame *f)
{
    uint8_t set;
    SEQ_BEGIN(f)
    set = d->stat & BQ769X0_STAT_FAULTS;
    if ((set & ~d->held) != 0u || (d->probation && set != 0u)) {
        take_event(d, set);
        SEQ_TRY(d, f, X0_JOB_OFF, 0, 0);
    }
    d->faults |= flags_of(d->held);
    if ((d->held & BQ769X0_STAT_XREADY) != 0u) {
        x0_invalidate(d, 0); /* X0-XRDY-04 */
    }
    if (d->probation) {
        if (d->now_ms - d->held_ms < probation_ms(d)) {
            return BQ_OK;
        }
        if ((d->held & BQ769X0_STAT_XREADY) != 0u) {
            SEQ_TRY(d, f, X0_JOB_CONFIGURE, 0, 0);
        }
        d->held = 0;
        d->probation = false;
        return BQ_OK;
    }
    if ((d->held & OVERCURRENT) != 0u &&
        d->now_ms - d->event_ms >= (d->config.load_settle_ms != 0u ? d->config.load_settle_ms : 100u)) {
        SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_SYS_CTRL1, 1);
        d->loads = (d->data[0] & BQ769X0_CTRL1_LOAD_PRESENT) != 0u ? 0u
                   : d->loads < 4u                                 ? (uint8_t)(d->loads + 1u)
                                                                   : d->loads;
    }
    if (!cured(d)) {
        d->held_ms = d->now_ms;
        return BQ_OK;
    }
    if (d->now_ms - d->held_ms >= quiet_ms(d)) {
        d->data[0] = d->stat & d->held; /* exactly what was read as set (X0-BIT-09) */
        SEQ_TRY(d, f, X0_JOB_WRITE, BQ769X0_SYS_STAT, 1);
        d->probation = true;
        d->held_ms = d->now_ms;
    }
    return BQ_OK;
    SEQ_END;
}

void bq769x0_unlock(bq769x0 *d)
{
    d->locked = false;
    d->strikes = 0;
}

/* FETs forbidden now off, all balancing switches off, verified. */
bq_status x0_job_off(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    d->shadow2 =
        (uint8_t)((d->shadow2 & ~(unsigned)forbidden(d->held)) & ~(unsigned)BQ769X0_CTRL2_CC_ONESHOT);
    d->data[0] = d->shadow2;
    SEQ_CALL(d, f, X0_JOB_SET, BQ769X0_SYS_CTRL2, 1);
    f->x = (uint8_t)(d->result != BQ_OK);
    memset(d->data, 0, 3);
    SEQ_TRY(d, f, X0_JOB_SET, BQ769X0_CELLBAL1, x0_groups(d));
    return f->x == 0u ? BQ_OK : BQ_E_VERIFY;
    SEQ_END;
}

/* Of what was asked, the cells that may be bled together: alternately one and the other of two neighbours
 * (X0-SEQ-39). */
static uint16_t choose(bq769x0 *d)
{
    uint16_t chosen = 0, asked = d->balance & d->in_use;
    d->phase ^= 1u;
    for (unsigned pass = 0; pass < 2u; pass++) {
        unsigned rank = 0;
        for (unsigned i = 0; i < d->config.inputs; i++) {
            uint16_t bit = (uint16_t)(1u << i);
            if ((d->in_use & bit) == 0u) {
                continue;
            }
            if ((rank++ + d->phase + pass) % 2u == 0u && (asked & bit) != 0u &&
                bq769x0_balance_legal(d->in_use, (uint16_t)(chosen | bit),
                                      !d->config.balance_across_groups)) {
                chosen |= bit;
            }
        }
    }
    return chosen;
}

/* X0-SEQ-05: no FET without a valid picture, a known temperature and a clean SYS_STAT. */
bq_status x0_job_apply(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    if (!d->valid || d->held != 0u) {
        d->balance = 0;
    }
    d->balance = choose(d);
    for (unsigned g = 0; g < 3u; g++) {
        d->data[g] = (uint8_t)((unsigned)d->balance >> (5u * g) & 0x1fu);
    }
    SEQ_TRY(d, f, X0_JOB_SET, BQ769X0_CELLBAL1, x0_groups(d));
    f->x = d->valid && d->temp_valid ? (uint8_t)(d->want_fets & ~forbidden(d->held)) : 0u;
    if (((d->shadow2 ^ f->x) & BQ769X0_CTRL2_FETS) == 0u) {
        return BQ_OK;
    }
    d->shadow2 = (uint8_t)((d->shadow2 & BQ769X0_CTRL2_CC_EN) | f->x);
    d->data[0] = d->shadow2;
    SEQ_CALL(d, f, X0_JOB_SET, BQ769X0_SYS_CTRL2, 1);
    if (d->result ==
        BQ_E_VERIFY) { /* a fault came in between and holds the FETs off: the next scan serves it */
        SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_SYS_STAT, 1);
        if ((d->data[0] & BQ769X0_STAT_FAULTS) == 0u) {
            return BQ_E_VERIFY;
        }
        d->shadow2 &= (uint8_t)~BQ769X0_CTRL2_FETS;
        return BQ_OK;
    }
    return d->result;
    SEQ_END;
}
