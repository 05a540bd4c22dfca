/* SPDX-License-Identifier: Apache-2.0 */
/* Fault service and recovery (X0-SEQ-28..37), outputs (X0-FET-13, X0-SEQ-38..41). */
#include "x0_internal.h"

#define OVERCURRENT (BQ769X0_STAT_SCD | BQ769X0_STAT_OCD)
#define STRIKES_MAX 5u
#define EDGE_MS 2u /* which scan meets a time of whole scans is no matter of microseconds */

/* The bits whose release is under way: XREADY comes first and alone. */
static uint8_t judged(const bq769x0 *d)
{
    return (d->held & BQ769X0_STAT_XREADY) != 0u ? BQ769X0_STAT_XREADY : d->held;
}

/* Whether every cell in use is back inside, with the hysteresis the user asked for (X0-SEQ-30, X0-SEQ-31). */
static bool cells_cured(const bq769x0 *d)
{
    for (unsigned i = 0; i < d->known.cells; i++) {
        uint32_t mv = x0_cell_mv(d, i);
        if (((d->held & BQ769X0_STAT_OV) != 0u && mv >= d->config.ov_recover_mv) ||
            ((d->held & BQ769X0_STAT_UV) != 0u &&
             (mv <= d->config.uv_recover_mv || d->code[i] < BQ769X0_UV_MINQUAL))) {
            return false;
        }
    }
    return x0_valid(d);
}

/* Whether the cause is gone by the driver's own readings. XREADY comes first and alone: while it stands there
 * are no readings (X0-XRDY-04). */
static bool cured(const bq769x0 *d)
{
    const bq769x0_trouble *t = &d->trouble;
    if ((d->held & BQ769X0_STAT_XREADY) != 0u) {
        return true;
    }
    return !t->locked && ((d->held & OVERCURRENT) == 0u || t->loads >= 4u) &&
           ((d->held & (BQ769X0_STAT_OV | BQ769X0_STAT_UV)) == 0u || cells_cured(d));
}

static uint32_t longer(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/* For how long it must have been gone: the longest of all that are held (X0-SEQ-36). */
static uint32_t quiet_ms(const bq769x0 *d)
{
    const bq769x0_trouble *t = &d->trouble;
    uint32_t ms = (d->held & (BQ769X0_STAT_OV | BQ769X0_STAT_UV)) != 0u ? 2000u : 0u;
    if ((d->held & BQ769X0_STAT_XREADY) != 0u) {
        return 3000u << (t->breakdowns - 1u);
    }
    if ((d->held & OVERCURRENT) != 0u) {
        ms = longer(ms, 250u << t->strikes);
    }
    if ((d->held & BQ769X0_STAT_OVRD_ALERT) != 0u) {
        ms = longer(ms, t->again ? 5000u : 1000u);
    }
    return ms;
}

/* How long the bits must stay clear: the longest delay that could bring them back, and 500 ms. */
static uint32_t probation_ms(const bq769x0 *d)
{
    unsigned protect3 = d->known.registers[BQ769X0_PROTECT3];
    uint32_t ov = 1000u << (protect3 >> 4 & 3u), uv = 1000u << (protect3 >> 6);
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
    bq769x0_trouble *t = &d->trouble;
    t->again = back || (d->held == 0u && t->released && d->now_ms - t->event_ms < 10000u);
    if (!t->again && d->held == 0u) {
        t->strikes = t->breakdowns = 0;
    } else if (t->again && t->strikes < STRIKES_MAX && (set & OVERCURRENT) != 0u) {
        t->strikes++;
    }
    if ((set & BQ769X0_STAT_XREADY) != 0u) {
        t->breakdowns++; /* the fourth ends in SHIP */
    }
    t->locked = t->locked || ((set & BQ769X0_STAT_SCD) != 0u && t->strikes >= STRIKES_MAX);
    t->event_ms = t->held_ms = d->now_ms;
    d->held |= set;
    t->probation = false;
    t->loads = 0;
    x0_balance(d, 0);
}

/* Looks for a load every 250 ms once the CHG pin had time to fall (X0-SEQ-32, X0-LOAD-05). */
static bool load_due(const bq769x0 *d)
{
    const bq769x0_trouble *t = &d->trouble;
    uint32_t settle_ms = d->config.load_settle_ms != 0u ? d->config.load_settle_ms : 100u;
    return (d->held & OVERCURRENT) != 0u && d->now_ms - t->event_ms >= settle_ms &&
           (t->loads == 0u || d->now_ms - t->load_ms >= X0_SCAN_MS - 10u);
}

/* The bits stayed clear long enough. True for XREADY, which is released alone and before everything else. */
static bool release(bq769x0 *d)
{
    bq769x0_trouble *t = &d->trouble;
    uint8_t gone = judged(d);
    d->held &= (uint8_t)~gone;
    t->probation = false;
    t->released = true;
    t->event_ms = t->held_ms = d->now_ms;
    return gone == BQ769X0_STAT_XREADY;
}

/* Runs once per scan while a fault bit is set or not yet released. d->stat was read at its beginning. */
int x0_job_service(bq769x0 *d, bq769x0_frame *f)
{
    bq769x0_trouble *t = &d->trouble;
    SEQ_BEGIN(f)
    if ((d->stat & BQ769X0_STAT_FAULTS & (t->probation ? 0xffu : ~(unsigned)d->held)) != 0u) {
        /* the register byte of a read carries no CRC (X0-I2C-16): a new bit counts when it is read twice */
        SEQ_TRY(1, X0_FETCH_STAT);
        d->stat &= d->answer;
    }
    f->i = d->stat & BQ769X0_STAT_FAULTS;
    f->x = t->probation && (f->i & judged(d)) != 0u;
    if ((f->i & ~d->held) != 0u || f->x != 0u) {
        take_event(d, f->i, f->x != 0u);
        SEQ_RUN(2, x0_job_off);
    }
    if ((d->held & BQ769X0_STAT_XREADY) != 0u) {
        x0_invalidate(d, BQ_Q_CHIP); /* X0-XRDY-04 */
        if (t->breakdowns > 3u) {
            d->faults |= BQ_F_DEFECTIVE;
            SEQ_RUN(3, x0_job_ship);
            return BQ_E_DEFECTIVE; /* another start boots it again */
        }
    }
    if (t->probation) {
        if (d->now_ms - t->held_ms > probation_ms(d) + EDGE_MS) {
            if (release(d)) {
                SEQ_RUN(4, x0_job_reload);
                d->data_ms = d->now_ms + 2000u + X0_SCAN_MS; /* X0-AMB-66 */
            }
        }
        return BQ_OK;
    }
    if (load_due(d)) {
        SEQ_TRY(5, X0_FETCH(BQ769X0_SYS_CTRL1, 1));
        t->load_ms = d->now_ms;
        t->loads = (d->answer & BQ769X0_CTRL1_LOAD_PRESENT) != 0u ? 0u
                   : t->loads < 4u                                ? (uint8_t)(t->loads + 1u)
                                                                  : t->loads;
    }
    if (!cured(d)) {
        t->held_ms = d->now_ms;
        return BQ_OK;
    }
    if (d->now_ms - t->held_ms > quiet_ms(d) + EDGE_MS) {
        d->known.registers[0] = d->stat & judged(d); /* exactly what was read as set (X0-BIT-09) */
        if (d->known.registers[0] != 0u) {
            SEQ_TRY(6, X0_PUT(BQ769X0_SYS_STAT, 1));
        }
        t->probation = true;
        t->held_ms = d->now_ms;
    }
    return BQ_OK;
    SEQ_END;
}

void bq769x0_unlock(bq769x0 *d)
{
    bq769x0_trouble *t = &d->trouble;
    t->locked = false;
    t->strikes = 0; /* the release conditions still have to hold */
}

/* SYS_CTRL2 as wanted but without FETs that are not allowed now, and the switches of d->balance, verified.
 * The switches follow even when the FETs did not. */
int x0_job_off(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    d->known.registers[BQ769X0_SYS_CTRL2] &= (uint8_t)(x0_allowed(x0_events(d)) | ~BQ769X0_CTRL2_FETS);
    SEQ_CALL(1, X0_SET_CTRL2);
    f->x = d->result != BQ_OK;
    SEQ_TRY(2, X0_SET_SWITCHES(d));
    return f->x == 0u ? BQ_OK : BQ_E_VERIFY;
    SEQ_END;
}
