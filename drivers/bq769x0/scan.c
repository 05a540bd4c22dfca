/* SPDX-License-Identifier: Apache-2.0 */
/* The measurement cycle and the current in one shot (X0-SEQ-21..27, X0-SEQ-46). */
#include "x0_internal.h"
#include <string.h>

/* All measurements: one block on the largest part; on smaller ones cells and the rest apart, which costs
 * fewer bytes. */
bq_status x0_job_picture(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    for (f->tries = 0; f->tries < 2u; f->tries++) {
        if (d->config.inputs == BQ769X0_INPUTS) {
            SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_VC1_HI, 40);
        } else {
            SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_BAT_HI, 10);
            memcpy(d->data + 30, d->data, 10);
            SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_VC1_HI, 2u * d->config.inputs);
            memmove(d->data + 2u * d->config.inputs, d->data + 30, 10);
        }
        x0_take_picture(d, d->data);
        if (d->valid) {
            break;
        }
    }
    if ((d->stat & BQ769X0_STAT_CC_READY) != 0u) {
        x0_take_current(d, d->data + 2u * d->config.inputs + 8u);
    }
    return BQ_OK;
    SEQ_END;
}

/* No result for 600 ms, or a picture that never changes: the converter stands (X0-SEQ-25). */
static bool stopped(const bq769x0 *d)
{
    bool counter = (d->shadow2 & BQ769X0_CTRL2_CC_EN) != 0u && (d->stat & BQ769X0_STAT_CC_READY) == 0u &&
                   d->now_ms - d->cc_ms > 600u;
    return counter || (d->config.frozen_scans != 0u && d->same >= d->config.frozen_scans);
}

/* SYS_STAT first and its clearing last, so that a result that arrives in between is not cleared unseen
 * (X0-SEQ-21). */
static bool timer_over(const bq769x0 *d)
{
    uint32_t limit_s = d->config.balance_timer_s != 0u ? d->config.balance_timer_s : 4u;
    return d->balance != 0u && d->now_ms - d->served_ms >= limit_s * 1000u;
}

bq_status x0_job_scan(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    d->faults = 0;
    SEQ_CALL(d, f, X0_JOB_READ, BQ769X0_SYS_STAT, 1);
    if (d->result == BQ_OK) {
        d->stat = d->data[0] & BQ769X0_STAT_CLEAR;
        if ((int32_t)(d->data_ms - d->now_ms) <= 0) {
            SEQ_CALL(d, f, X0_JOB_PICTURE, 0, 0);
        }
    }
    if (d->result != BQ_OK) {
        x0_invalidate(d, BQ_F_COMM);
        d->scrub_ms = d->now_ms - X0_SCRUB_MS; /* X0-SEQ-53: look at the configuration once the bus is back */
        return d->result;
    }
    if ((d->stat & BQ769X0_STAT_CC_READY) != 0u) {
        d->cc_ms = d->now_ms; /* also a result that came while no picture counts */
        SEQ_TRY(d, f, X0_JOB_CLEAR, BQ769X0_STAT_CC_READY, 0);
    }
    if (d->valid) {
        x0_bump(&d->stats.scans);
    }
    if (stopped(d)) {
        SEQ_TRY(d, f, X0_JOB_SCRUB, 0, 0); /* after a reset it stands too, and that has its own name */
    }
    if (stopped(d)) {
        x0_invalidate(d, BQ_F_LOCKUP);
        d->same = 0;
        d->shadow2 = 0; /* never the converter off with a FET on (X0-AMB-15) */
        d->balance = 0;
        SEQ_TRY(d, f, X0_JOB_OFF, 0, 0);
        d->data[0] = 0;
        SEQ_TRY(d, f, X0_JOB_SET, BQ769X0_SYS_CTRL1, 1);
        SEQ_TRY(d, f, X0_JOB_RELOAD, 0, 0);
        return BQ_OK;
    }
    if ((d->stat & BQ769X0_STAT_FAULTS) != 0u || d->held != 0u) {
        SEQ_TRY(d, f, X0_JOB_SERVICE, 0, 0);
    }
    if (timer_over(d)) {
        d->balance = 0;
        d->faults |= BQ_F_BALANCE;
        SEQ_TRY(d, f, X0_JOB_OFF, 0, 0);
    }
    if (d->now_ms - d->scrub_ms >= X0_SCRUB_MS) {
        SEQ_TRY(d, f, X0_JOB_SCRUB, 0, 0);
    }
    return BQ_OK;
    SEQ_END;
}

/* A window that runs while the counter is switched off may still end with a result (X0-AMB-26): that one is
 * dropped. Afterwards the counter is as configured. */
bq_status x0_job_oneshot(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    for (f->tries = 0; f->tries < 3u; f->tries++) {
        d->data[0] = d->shadow2 & (uint8_t)~BQ769X0_CTRL2_CC_EN;
        SEQ_TRY(d, f, X0_JOB_SET, BQ769X0_SYS_CTRL2, 1);
        if ((d->shadow2 & BQ769X0_CTRL2_CC_EN) != 0u) {
            d->shadow2 &= (uint8_t)~BQ769X0_CTRL2_CC_EN;
            SEQ_WAIT(d, f, 260000u);
        }
        SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_SYS_STAT, 1);
        if ((d->data[0] & BQ769X0_STAT_CC_READY) != 0u) {
            SEQ_TRY(d, f, X0_JOB_CLEAR, BQ769X0_STAT_CC_READY, 0);
        }
        d->cc_ms = d->now_ms;
        d->data[0] = (uint8_t)(d->shadow2 | BQ769X0_CTRL2_CC_ONESHOT);
        SEQ_SEND(f, x0_send_write(d, BQ769X0_SYS_CTRL2, 1)); /* a lost answer shows as no result */
        for (f->i = 0; f->i < 4u; f->i++) {                  /* 260, 375, 490, 605 ms */
            SEQ_WAIT(d, f, f->i == 0u ? 260000u : 115000u);
            SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_SYS_STAT, 1);
            if ((d->data[0] & BQ769X0_STAT_CC_READY) != 0u) {
                SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_CC_HI, 2);
                x0_take_current(d, d->data);
                SEQ_TRY(d, f, X0_JOB_CLEAR, BQ769X0_STAT_CC_READY, 0);
                d->shadow2 |= d->config.counter_off ? 0u : BQ769X0_CTRL2_CC_EN;
                d->data[0] = d->shadow2;
                SEQ_TRY(d, f, X0_JOB_SET, BQ769X0_SYS_CTRL2, 1);
                return BQ_OK;
            }
        }
    }
    return BQ_E_TIMEOUT;
    SEQ_END;
}
