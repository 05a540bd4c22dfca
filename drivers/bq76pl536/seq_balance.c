/* SPDX-License-Identifier: Apache-2.0 */
/* Balancing with measurement pauses: PL-SEQ-10. Outputs are off whenever a scan measures; only apply switches
 * them on. */
#include "pl536_internal.h"

bool pl_may_balance(const bq76pl536 *d, unsigned n)
{
    const bq76pl536_device *dev = &d->devices[n - 1u];
    const uint16_t against =
        BQ_F_DIE_TEMP | BQ_F_SUPPLY | BQ_F_MEMORY | BQ_F_DEFECTIVE | BQ_F_COMM | BQ_F_OPEN_WIRE | BQ_F_LOCKUP;
    return n <= d->found && pl_valid(d, n) && (dev->faults & against) == 0u && dev->fault == 0u;
}

/* True while the safety timer cannot have expired yet, tolerance included. */
static bool timer_runs(const bq76pl536 *d)
{
    return d->now_ms - d->cb_ms < d->config.balance_timer_s * 880ul;
}

/* Off for a measurement: one broadcast and the settling time; that it arrived shows in the CBT bits of the
 * bursts (10-04). */
bq_status pl_job_cb_pause(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    for (f->n = 1; f->n <= d->config.devices; f->n++) {
        pl_dev(d, f->n)->cb_seen = timer_runs(d) ? pl_dev(d, f->n)->cb_on : 0u; /* expired by itself: 10-06 */
        pl_dev(d, f->n)->cb_on = 0;
    }
    for (f->tries = 0; f->tries < PL_TRIES; f->tries++) {
        SEQ_SEND(f, pl_send_write(d, BQ76PL536_ADDR_BROADCAST, BQ76PL536_CB_CTRL, 0));
        if (d->transfer == BQ_OK) {
            break;
        }
    }
    d->active = d->transfer != BQ_OK; /* never sent: the next job has to try again */
    SEQ_WAIT(d, f, d->config.balance_settle_ms * 1000ul);
    return BQ_OK;
    SEQ_END;
}

/* Off for good, verified in every device (10-08). The status is that of the first device that could not be
 * verified. */
bq_status pl_job_cb_off(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    SEQ_SEND(f, pl_send_write(d, BQ76PL536_ADDR_BROADCAST, BQ76PL536_CB_CTRL, 0));
    for (f->n = 1; f->n <= d->found; f->n++) {
        SEQ_CALL(d, f, PL_JOB_READ, f->n, BQ76PL536_CB_CTRL, 1);
        if (d->result == BQ_OK && pl_data(d)[0] != 0u) {
            SEQ_CALL(d, f, PL_JOB_WRITE, f->n, BQ76PL536_CB_CTRL, 0);
        }
        if (d->result == BQ_OK) {
            pl_dev(d, f->n)->cb_on = 0;
            continue;
        }
        pl_dev(d, f->n)->faults |= BQ_F_BALANCE;
        f->x = 1;
    }
    d->active = f->x != 0u;
    return f->x != 0u ? BQ_E_VERIFY : BQ_OK;
    SEQ_END;
}

/* Outputs `val` of device `dev` on (10-02, 10-03): timer while they are off, 0, mask, then prove mask, period
 * and CBT. */
bq_status pl_job_cb_on(bq76pl536 *d, bq76pl536_frame *f)
{
    bq76pl536_device *dev = pl_dev(d, f->dev);
    SEQ_BEGIN(f)
    for (;;) {
        if (dev->cb_on != 0u || (dev->flags & PL_DEV_CB_TIME) == 0u) {
            SEQ_TRY(d, f, PL_JOB_WRITE, f->dev, BQ76PL536_CB_CTRL, 0);
        }
        if ((dev->flags & PL_DEV_CB_TIME) == 0u) {
            SEQ_TRY(d, f, PL_JOB_WRITE, f->dev, BQ76PL536_CB_TIME, d->config.balance_timer_s);
            dev->flags |= PL_DEV_CB_TIME;
        }
        d->active = true;
        dev->cb_on = f->val;
        SEQ_SEND(f, pl_send_write(d, f->dev, BQ76PL536_CB_CTRL, f->val));
        SEQ_CALL(d, f, PL_JOB_READ, f->dev, BQ76PL536_CB_CTRL, 2);
        f->x = d->result == BQ_OK && pl_data(d)[0] == f->val ? 1u : 0u;
        if (d->result == BQ_OK && pl_data(d)[1] != d->config.balance_timer_s) {
            f->x = 0;
            dev->flags &= (uint16_t)~PL_DEV_CB_TIME;
        }
        if (f->x != 0u) {
            SEQ_CALL(d, f, PL_JOB_READ, f->dev, BQ76PL536_DEVICE_STATUS, 1);
            if (d->result == BQ_OK && (pl_data(d)[0] & BQ76PL536_DS_CBT) != 0u) {
                return BQ_OK;
            }
        }
        if (++f->tries >= PL_TRIES) {
            break;
        }
    }
    SEQ_CALL(d, f, PL_JOB_WRITE, f->dev, BQ76PL536_CB_CTRL, 0);
    if (d->result == BQ_OK) {
        dev->cb_on = 0;
    }
    dev->faults |= BQ_F_BALANCE;
    return BQ_E_VERIFY;
    SEQ_END;
}

static bool wanted(bq76pl536 *d, unsigned n)
{
    bq76pl536_device *dev = pl_dev(d, n);
    dev->cb_want &= (uint8_t)((1u << pl_cells(d, n)) - 1u);
    return dev->cb_want != 0u && pl_may_balance(d, n);
}

/* The flags an application has acted on: the comparators' only (08-06), never faster than they could return.
 */
static bool clear_due(bq76pl536 *d)
{
    if (!d->clear_faults || d->now_ms - d->clear_ms < pl_longest_delay_us(d) / 1000u) {
        return false;
    }
    d->clear_ms = d->now_ms;
    return true;
}

bq_status pl_job_apply(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    if (clear_due(d)) {
        for (f->n = 1; f->n <= d->found; f->n++) {
            f->reg = pl_dev(d, f->n)->fault & (BQ76PL536_FAULT_COV | BQ76PL536_FAULT_CUV);
            if (f->reg != 0u) {
                SEQ_CALL(d, f, PL_JOB_CLEAR, f->n, BQ76PL536_FAULT_STATUS, f->reg);
            }
            f->reg = pl_dev(d, f->n)->alert & (BQ76PL536_ALERT_OT1 | BQ76PL536_ALERT_OT2);
            if (f->reg != 0u) {
                SEQ_CALL(d, f, PL_JOB_CLEAR, f->n, BQ76PL536_ALERT_STATUS, f->reg);
            }
        }
    }
    if (d->active) { /* every (re)start begins with 0: only that gives the full period (10-05) */
        SEQ_CALL(d, f, PL_JOB_CB_OFF, 0, 0, 0);
        f->x = d->result != BQ_OK ? 1u : 0u;
    }
    for (f->n = 1; f->n <= d->found; f->n++) {
        if (wanted(d, f->n)) {
            d->cb_ms = d->now_ms;
            SEQ_CALL(d, f, PL_JOB_CB_ON, f->n, 0, pl_dev(d, f->n)->cb_want);
            f->x |= d->result != BQ_OK ? 1u : 0u;
        }
    }
    return f->x != 0u ? BQ_E_VERIFY : BQ_OK;
    SEQ_END;
}
