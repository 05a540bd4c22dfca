/* SPDX-License-Identifier: Apache-2.0 */
/* One update of the whole driver: the measurement and everything that has to follow from it (X0-SEQ-21..27),
 * and the current in one shot (X0-SEQ-46). */
#include "x0_internal.h"

#define BLIND_MS 1000u

/* Number that differs when any code of the picture does. */
static uint32_t print_of(const bq769x0 *d)
{
    uint32_t print = 0;
    for (unsigned i = 0; i < sizeof d->code / sizeof d->code[0]; i++) {
        print = (print ^ d->code[i]) * 16777619u; /* FNV-1a */
    }
    return print;
}

/* Counts pictures that did not change: once per scan of the part, however often the host looks. */
static void compare_pictures(bq769x0 *d)
{
    bq769x0_watch *t = &d->watch;
    uint32_t print = print_of(d);
    if (print != t->print) {
        t->print = print;
        t->same = 0;
    } else if (d->now_ms - t->same_ms >= X0_SCAN_MS && t->same != UINT16_MAX) {
        t->same++;
        t->same_ms = d->now_ms;
    }
}

/* No result for 600 ms, or a picture that never changes: the converter stands (X0-SEQ-25). */
static bool stopped(const bq769x0 *d)
{
    bool counter = (d->known.registers[BQ769X0_SYS_CTRL2] & BQ769X0_CTRL2_CC_EN) != 0u &&
                   (d->stat & BQ769X0_STAT_CC_READY) == 0u && d->now_ms - d->cc_ms > 600u;
    return counter || (d->config.frozen_scans != 0u && d->watch.same >= d->config.frozen_scans);
}

static bool timer_over(const bq769x0 *d)
{
    uint32_t limit_s = d->config.balance_timer_s != 0u ? d->config.balance_timer_s : 4u;
    return d->balance != 0u && d->now_ms - d->served_ms >= limit_s * 1000u;
}

/* Off and on again, with the whole configuration. */
static int job_restart(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    x0_invalidate(d, BQ_Q_CHIP);
    d->faults |= BQ_F_LOCKUP;
    d->watch.same = 0;
    d->known.registers[BQ769X0_SYS_CTRL2] = 0; /* never the converter off with a FET on (X0-AMB-15) */
    x0_balance(d, 0);
    SEQ_RUN(1, x0_job_off);
    d->known.registers[BQ769X0_SYS_CTRL1] = 0;
    SEQ_TRY(2, X0_SET(BQ769X0_SYS_CTRL1, 1));
    SEQ_RUN(3, x0_job_reload);
    return BQ_OK;
    SEQ_END;
}

/* For a second nothing that could be believed, though the part should have had something to say (X0-SEQ-25).
 */
static bool blind(const bq769x0 *d)
{
    return !x0_valid(d) && x0_reached(d, d->data_ms) && d->now_ms - d->watch.good_ms > BLIND_MS &&
           (x0_events(d) & BQ769X0_STAT_XREADY) == 0u;
}

/* A picture was read. */
void x0_count_picture(bq769x0 *d)
{
    d->sequence++;
    if (x0_valid(d)) {
        d->measured = true;
        d->watch.good_ms = d->now_ms;
    }
}

/* What follows from a picture that was read. */
static void judge_picture(bq769x0 *d)
{
    x0_count_picture(d);
    if (x0_valid(d)) {
        compare_pictures(d);
    }
    x0_look_for_charge(d);
    x0_die_after_picture(d);
}

int x0_job_scan(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    x0_die_before_picture(d);
    d->no_data = !x0_reached(d, d->data_ms);
    if (!d->no_data) {
        d->data_ms = d->now_ms; /* for ever reached */
    }
    d->faults = 0;
    SEQ_RUN_CALL(1, x0_job_measure);
    f->x = (uint8_t)-d->result;
    if (f->x != 0u) {
        d->faults =
            d->quality == BQ_Q_COMM ? BQ_F_COMM : 0u; /* not for a picture that only was not acknowledged */
    } else {
        if (!d->no_data) {
            judge_picture(d);
        }
        if (x0_valid(d)) {
            x0_bump(&d->stats.scans);
        }
    }
    if (blind(d)) {
        d->faults |= f->x == 0u ? BQ_F_LOCKUP : 0u;
        if ((d->known.registers[BQ769X0_SYS_CTRL2] & BQ769X0_CTRL2_FETS) != 0u || d->balance != 0u) {
            f->i = d->known.registers[BQ769X0_SYS_CTRL2] & BQ769X0_CTRL2_FETS;
            d->known.registers[BQ769X0_SYS_CTRL2] &= (uint8_t)~BQ769X0_CTRL2_FETS;
            x0_balance(d, 0);
            SEQ_RUN_CALL(2, x0_job_off);
            if (d->result != BQ_OK) { /* still on, as far as is known: tried again with the next scan */
                d->known.registers[BQ769X0_SYS_CTRL2] |= f->i;
            }
        }
    }
    if (f->x != 0u) {
        return -(int)f->x;
    }
    if (stopped(d)) {
        SEQ_RUN(3, x0_job_scrub); /* after a reset it stands too, and that has its own name */
    }
    if (stopped(d)) {
        SEQ_RUN(4, job_restart);
        return BQ_OK;
    }
    if (x0_events(d) != 0u) {
        SEQ_RUN(5, x0_job_service);
    }
    if (timer_over(d)) {
        d->asked = 0;
        x0_balance(d, 0);
        d->faults |= BQ_F_BALANCE;
        SEQ_RUN(6, x0_job_off);
    }
    /* while the part reports a fault of its own nothing is written to it; what follows is the whole
     * configuration (X0-SEQ-35) */
    if ((d->suspect || d->now_ms - d->scrub_ms >= X0_SCRUB_MS) && (d->held & BQ769X0_STAT_XREADY) == 0u) {
        SEQ_RUN(7, x0_job_scrub);
    }
    SEQ_RUN(8, x0_job_die);
    return BQ_OK;
    SEQ_END;
}

/* A window that runs while the counter is switched off may still end with a result (X0-AMB-26): that one is
 * dropped. */
static int job_convert(bq769x0 *d, bq769x0_frame *f)
{
    uint8_t *ctrl2 = &d->known.registers[BQ769X0_SYS_CTRL2];
    SEQ_BEGIN(f)
    for (f->tries = 0; f->tries < 3u; f->tries++) {
        f->x = *ctrl2 & BQ769X0_CTRL2_CC_EN;
        *ctrl2 &= (uint8_t)~BQ769X0_CTRL2_CC_EN;
        SEQ_TRY(1, X0_SET_CTRL2);
        if (f->x != 0u) {
            SEQ_TRY(2, x0_wait(d, 260000u));
        }
        SEQ_TRY(3, X0_FETCH_STAT);
        d->known.registers[0] = d->answer & BQ769X0_STAT_CC_READY;
        if (d->known.registers[0] != 0u) {
            SEQ_TRY(4, X0_PUT(BQ769X0_SYS_STAT, 1));
        }
        *ctrl2 |= BQ769X0_CTRL2_CC_ONESHOT;
        SEQ_CALL(5, X0_PUT(BQ769X0_SYS_CTRL2, 1) | X0_ONCE); /* a lost answer shows as no result */
        *ctrl2 &= (uint8_t)~BQ769X0_CTRL2_CC_ONESHOT;
        for (f->i = 0; f->i < 4u; f->i++) { /* 260, 375, 490, 605 ms */
            SEQ_TRY(6, x0_wait(d, f->i == 0u ? 260000u : 115000u));
            SEQ_TRY(7, X0_FETCH_STAT);
            if ((d->answer & BQ769X0_STAT_CC_READY) != 0u) {
                SEQ_TRY(8, X0_FETCH(BQ769X0_CC_HI, 2));
                x0_take_current(d, (uint16_t)((unsigned)d->answer << 8 | x0_data(d)[1]));
                d->counting.ms = d->now_ms - X0_SCAN_MS;
                x0_count_charge(d);
                d->known.registers[0] = BQ769X0_STAT_CC_READY;
                SEQ_TRY(9, X0_PUT(BQ769X0_SYS_STAT, 1));
                return BQ_OK;
            }
        }
    }
    return BQ_E_TIMEOUT;
    SEQ_END;
}

/* Afterwards the counter is as configured, whatever came of the conversion. */
int x0_job_oneshot(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    SEQ_RUN_CALL(1, job_convert);
    f->x = (uint8_t)-d->result;
    d->known.registers[BQ769X0_SYS_CTRL2] |= d->config.counter_off ? 0u : BQ769X0_CTRL2_CC_EN;
    SEQ_TRY(2, X0_SET_CTRL2);
    d->cc_ms = d->counting.ms = d->now_ms;
    return -(int)f->x;
    SEQ_END;
}
