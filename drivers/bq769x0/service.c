/* SPDX-License-Identifier: Apache-2.0 */
/* Fault service and recovery (X0-SEQ-28..37), outputs (X0-FET-13, X0-SEQ-38..41). */
#include "x0_internal.h"

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

/* The bits whose release is under way: XREADY comes first and alone. */
static uint8_t judged(const bq769x0 *d)
{
    return (d->held & BQ769X0_STAT_XREADY) != 0u ? BQ769X0_STAT_XREADY : d->held;
}

/* Whether every cell in use is back inside, with the hysteresis the user asked for (X0-SEQ-30, X0-SEQ-31). */
static bool cells_cured(const bq769x0 *d)
{
    for (unsigned i = 0; i < d->config.inputs; i++) {
        if ((d->in_use >> i & 1u) != 0u) {
            int32_t mv = x0_cell_mv(d, i);
            if (((d->held & BQ769X0_STAT_OV) != 0u && mv >= (int32_t)d->config.ov_recover_mv) ||
                ((d->held & BQ769X0_STAT_UV) != 0u &&
                 (mv <= (int32_t)d->config.uv_recover_mv || d->code[i] < BQ769X0_UV_MINQUAL))) {
                return false;
            }
        }
    }
    return d->valid;
}

/* Whether the cause is gone by the driver's own readings. XREADY comes first and alone: while it stands there
 * are no readings (X0-XRDY-04). */
static bool cured(const bq769x0 *d)
{
    if ((d->held & BQ769X0_STAT_XREADY) != 0u) {
        return true;
    }
    return !d->locked && ((d->held & OVERCURRENT) == 0u || d->loads >= 4u) &&
           ((d->held & (BQ769X0_STAT_OV | BQ769X0_STAT_UV)) == 0u || cells_cured(d));
}

static uint32_t longer(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/* For how long it must have been gone: the longest of all that are held (X0-SEQ-36). */
static uint32_t quiet_ms(const bq769x0 *d)
{
    uint32_t ms = (d->held & (BQ769X0_STAT_OV | BQ769X0_STAT_UV)) != 0u ? 2000u : 0u;
    if ((d->held & BQ769X0_STAT_XREADY) != 0u) {
        return 3000u << d->strikes;
    }
    if ((d->held & OVERCURRENT) != 0u) {
        ms = longer(ms, 250u << d->strikes);
    }
    if ((d->held & BQ769X0_STAT_OVRD_ALERT) != 0u) {
        ms = longer(ms, d->again ? 5000u : 1000u);
    }
    return ms;
}

/* How long the bits must stay clear: the longest delay that could bring them back, and 500 ms. */
static uint32_t probation_ms(const bq769x0 *d)
{
    uint32_t ov = 1000u << (d->achieved.protect3 >> 4 & 3u), uv = 1000u << (d->achieved.protect3 >> 6);
    uint32_t ms = (d->held & OVERCURRENT) != 0u ? d->achieved.current.ocd_delay_ms : 500u;
    if ((d->held & BQ769X0_STAT_OVRD_ALERT) != 0u) {
        ms = longer(ms, 1500u);
    }
    if ((d->held & BQ769X0_STAT_OV) != 0u) {
        ms = longer(ms, ov);
    }
    if ((d->held & BQ769X0_STAT_UV) != 0u) {
        ms = longer(ms, uv == 1000u ? uv : 2u * uv);
    }
    return ms + 500u;
}

/* A new fault. One that comes back within 10 s of the release, or while it is on probation, is the same
 * again: waits grow, five short circuits lock (X0-SEQ-32), and XREADY is a defect after 3, 6 and 12 s
 * (X0-SEQ-35). */
static void take_event(bq769x0 *d, uint8_t set, bool back)
{
    d->again = back || (d->held == 0u && d->released && d->now_ms - d->event_ms < 10000u);
    if (!d->again && d->held == 0u) {
        d->strikes = 0;
    } else if (d->again && d->strikes < STRIKES_MAX && (set & (OVERCURRENT | BQ769X0_STAT_XREADY)) != 0u) {
        d->strikes++;
    }
    d->locked = d->locked || ((set & BQ769X0_STAT_SCD) != 0u && d->strikes >= STRIKES_MAX);
    d->event_ms = d->held_ms = d->now_ms;
    d->held |= set;
    d->probation = false;
    d->loads = 0;
    d->balance = 0;
}

/* Looks for a load every 250 ms once the CHG pin had time to fall (X0-SEQ-32, X0-LOAD-05). */
static bool load_due(const bq769x0 *d)
{
    uint32_t settle_ms = d->config.load_settle_ms != 0u ? d->config.load_settle_ms : 100u;
    return (d->held & OVERCURRENT) != 0u && d->now_ms - d->event_ms >= settle_ms &&
           (d->loads == 0u || d->now_ms - d->load_ms >= X0_SCAN_MS - 10u);
}

/* The bits stayed clear long enough. True for XREADY, which is released alone and before everything else. */
static bool release(bq769x0 *d)
{
    uint8_t gone = judged(d);
    d->held &= (uint8_t)~gone;
    d->probation = false;
    d->released = true;
    d->event_ms = d->held_ms = d->now_ms;
    return gone == BQ769X0_STAT_XREADY;
}

/* Runs once per scan while a fault bit is set or not yet released. d->stat was read at its beginning. */
bq_status x0_job_service(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    if ((d->stat & BQ769X0_STAT_FAULTS & (d->probation ? 0xffu : ~(unsigned)d->held)) != 0u) {
        /* the register byte of a read carries no CRC (X0-I2C-16): a new bit counts when it is read twice */
        SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_SYS_STAT, 1);
        d->stat &= d->data[0];
    }
    f->i = d->stat & BQ769X0_STAT_FAULTS;
    f->x = d->probation && (f->i & judged(d)) != 0u;
    if ((f->i & ~d->held) != 0u || f->x != 0u) {
        take_event(d, f->i, f->x != 0u);
        SEQ_TRY(d, f, X0_JOB_OFF, 0, 0);
    }
    d->faults |= flags_of(d->held);
    if ((d->held & BQ769X0_STAT_XREADY) != 0u) {
        x0_invalidate(d, 0); /* X0-XRDY-04 */
        if (d->strikes > 2u) {
            d->faults |= BQ_F_DEFECTIVE;
            SEQ_TRY(d, f, X0_JOB_SHIP, 0, 0);
            return BQ_E_DEFECTIVE; /* another start boots it again */
        }
    }
    if (d->probation) {
        if (d->now_ms - d->held_ms >= probation_ms(d)) {
            if (release(d)) {
                SEQ_TRY(d, f, X0_JOB_RELOAD, 0, 0);
                d->data_ms = d->now_ms + 2000u + X0_SCAN_MS; /* X0-AMB-66 */
            }
        }
        return BQ_OK;
    }
    if (load_due(d)) {
        SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_SYS_CTRL1, 1);
        d->load_ms = d->now_ms;
        d->loads = (d->data[0] & BQ769X0_CTRL1_LOAD_PRESENT) != 0u ? 0u
                   : d->loads < 4u                                 ? (uint8_t)(d->loads + 1u)
                                                                   : d->loads;
    }
    if (!cured(d)) {
        d->held_ms = d->now_ms;
        return BQ_OK;
    }
    if (d->now_ms - d->held_ms >= quiet_ms(d)) {
        f->x = d->stat & judged(d); /* exactly what was read as set (X0-BIT-09) */
        if (f->x != 0u) {
            SEQ_TRY(d, f, X0_JOB_CLEAR, f->x, 0);
        }
        d->probation = true;
        d->held_ms = d->now_ms;
    }
    return BQ_OK;
    SEQ_END;
}

void bq769x0_unlock(bq769x0 *d)
{
    d->locked = false;
    d->strikes = 0; /* the release conditions still have to hold */
}

/* SYS_CTRL2 as in the shadow but without FETs that are forbidden now, and the switches of d->balance,
 * verified. */
bq_status x0_job_off(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    d->shadow2 &= (uint8_t)~forbidden(d->held);
    d->data[0] = d->shadow2;
    SEQ_CALL(d, f, X0_JOB_SET, BQ769X0_SYS_CTRL2, 1);
    f->x = (uint8_t)(d->result != BQ_OK);
    SEQ_TRY(d, f, X0_JOB_SWITCHES, 0, 0);
    return f->x == 0u ? BQ_OK : BQ_E_VERIFY;
    SEQ_END;
}

bq_status x0_job_switches(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    for (unsigned g = 0; g < 3u; g++) {
        d->data[g] = (uint8_t)((unsigned)d->balance >> (5u * g) & 0x1fu);
    }
    SEQ_TRY(d, f, X0_JOB_SET, BQ769X0_CELLBAL1, x0_groups(d));
    return BQ_OK;
    SEQ_END;
}

/* Of what was asked, the cells that may be bled together: alternately one and the other of two neighbours
 * (X0-SEQ-39), no more than the package may dissipate (X0-SEQ-42). Neighbours are so by input, whatever was
 * shorted between them (X0-CB-06). */
static uint16_t choose(const bq769x0 *d, uint16_t asked)
{
    uint16_t chosen = 0;
    unsigned phase = (d->now_ms >> 12) & 1u, left = d->config.balance_max != 0u ? d->config.balance_max : 15u;
    for (unsigned pass = 0; pass < 2u; pass++) {
        unsigned rank = 0;
        for (unsigned i = 0; i < d->config.inputs; i++) {
            uint16_t bit = (uint16_t)(1u << i);
            if ((d->in_use & bit) != 0u && (rank++ + phase + pass) % 2u == 0u && (asked & bit) != 0u &&
                left != 0u &&
                bq769x0_balance_legal(d->in_use, (uint16_t)(chosen | bit),
                                      !d->config.balance_across_groups)) {
                chosen |= bit;
                left--;
            }
        }
    }
    return chosen;
}

/* X0-SEQ-05: no FET without a valid picture, a known temperature and a clean SYS_STAT. */
bq_status x0_job_apply(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    d->balance = d->valid && d->held == 0u ? choose(d, d->want_balance) : 0u;
    SEQ_TRY(d, f, X0_JOB_SWITCHES, 0, 0);
    f->x = d->valid && d->temp_valid ? (uint8_t)(d->want_fets & ~forbidden(d->held)) : 0u;
    if (((d->shadow2 ^ f->x) & BQ769X0_CTRL2_FETS) == 0u) {
        return BQ_OK;
    }
    d->shadow2 = (uint8_t)((d->shadow2 & BQ769X0_CTRL2_CC_EN) | f->x);
    d->data[0] = d->shadow2;
    SEQ_TRY(d, f, X0_JOB_SET, BQ769X0_SYS_CTRL2, 1);
    if ((d->data[0] & f->x) != f->x) { /* X0-FET-13: a fault took it back; the next scan serves it */
        d->shadow2 &= (uint8_t)(d->data[0] | ~BQ769X0_CTRL2_FETS);
        SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_SYS_STAT, 1);
        return (d->data[0] & BQ769X0_STAT_FAULTS) == 0u ? BQ_E_VERIFY : BQ_OK;
    }
    return BQ_OK;
    SEQ_END;
}
