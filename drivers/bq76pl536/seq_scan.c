/* SPDX-License-Identifier: Apache-2.0 */
/* Measurement: PL-SEQ-06 and PL-SEQ-07. When nothing is wrong a scan is one broadcast and one burst per
 * device. */
#include "pl536_internal.h"

static bool raise_conv(const bq76pl536 *d)
{
    return d->config.use_conv_pin && d->gpio.ops != NULL &&
           d->gpio.ops->write(d->gpio.ctx, BQ_LINE_CONV, true) == BQ_OK;
}

/* Only a hint (PL-AMB-79): a line that is missing or high says nothing. */
static bool drdy_low(const bq76pl536 *d)
{
    bool high;
    return pl_line(d, BQ_LINE_DRDY, &high) && !high;
}

/* Starts one conversion in all devices and waits until the slowest must have ended. */
bq_status pl_job_convert(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    d->start_ms = d->now_ms;
    d->convert_us = d->now_us;
    if (raise_conv(d)) {
        SEQ_WAIT(d, f, pl_conversion_us(d));
        if (drdy_low(d)) { /* time-out at twice the computed time; the bursts tell who hangs */
            SEQ_WAIT(d, f, pl_conversion_us(d));
        }
        pl_drive(d, BQ_LINE_CONV, false);
        return BQ_OK;
    }
    for (;;) {
        SEQ_SEND(f,
                 pl_send_write(d, BQ76PL536_ADDR_BROADCAST, BQ76PL536_ADC_CONVERT, BQ76PL536_CONVERT_START));
        if (d->transfer == BQ_OK) {
            break;
        }
        if (++f->tries >= PL_TRIES) {
            return d->transfer;
        }
        SEQ_WAIT(d, f, pl_conversion_us(d)); /* it may have arrived all the same (PL-SEQ-00-03) */
    }
    SEQ_WAIT(d, f, pl_conversion_us(d));
    return BQ_OK;
    SEQ_END;
}

static void give_up(bq76pl536 *d, unsigned n, bq_status st)
{
    if (st == BQ_E_LOCKED_UP) {
        pl_dev(d, n)->flags |= PL_DEV_LOCKED;
        pl_invalidate(pl_dev(d, n), BQ_Q_CHIP, BQ_F_LOCKUP);
    } else {
        pl_invalidate(pl_dev(d, n), BQ_Q_COMM, BQ_F_COMM);
    }
}

/* Reads every device. f->x = a device that does not answer at all, 0 = none: those above it get one try each
 * until one of them answers, because a device without an address hides them all. The lowest one that stayed
 * silent is left in f->dev and reported through d->failed_at. */
bq_status pl_job_read_in(bq76pl536 *d, bq76pl536_frame *f)
{
    bq_status st;
    SEQ_BEGIN(f)
    d->failed_at = 0;
    for (f->n = 1; f->n <= d->found; f->n++) {
        f->i = 0;
        for (f->tries = 0;;) {
            SEQ_SEND(f, pl_send_read(d, f->n, BQ76PL536_BURST_FIRST, BQ76PL536_BURST_COUNT));
            st = pl_take_burst(d, f->n, d->start_ms);
            if (st == BQ_OK) {
                f->x = 0;
                break;
            }
            if (st == BQ_E_LOCKED_UP && f->i == 0u) {
                f->i = 1;
                SEQ_WAIT(d, f, pl_conversion_us(d));
                continue;
            }
            if (st == BQ_E_LOCKED_UP || ++f->tries >= PL_TRIES || f->x != 0u) {
                give_up(d, f->n, st);
                if (st == BQ_E_NO_ANSWER) {
                    f->x = f->n;
                    d->failed_at = d->failed_at != 0u ? d->failed_at : f->n;
                }
                break;
            }
            d->stats.retries += d->stats.retries != UINT32_MAX ? 1u : 0u;
        }
    }
    return BQ_OK;
    SEQ_END;
}

/* Device `dev` alone again: its start was damaged on the way (06-08). */
bq_status pl_job_remeasure(bq76pl536 *d, bq76pl536_frame *f)
{
    bq_status st;
    SEQ_BEGIN(f)
    pl_invalidate(pl_dev(d, f->dev), BQ_Q_COMM, 0);
    SEQ_TRY(d, f, PL_JOB_COMMAND, f->dev, BQ76PL536_ADC_CONVERT, BQ76PL536_CONVERT_START);
    SEQ_WAIT(d, f, pl_conversion_us(d));
    for (;;) {
        SEQ_SEND(f, pl_send_read(d, f->dev, BQ76PL536_BURST_FIRST, BQ76PL536_BURST_COUNT));
        st = pl_take_burst(d, f->dev, d->now_ms - 1u);
        if (st == BQ_OK) {
            return BQ_OK;
        }
        if (++f->tries >= PL_TRIES) {
            give_up(d, f->dev, st);
            return st;
        }
    }
    SEQ_END;
}

/* Before a CONV edge, which would lock up a programmed device that was reset unnoticed (07-05): look at all
 * when a line is high. */
bq_status pl_job_sweep(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    for (f->n = 1; f->n <= d->found; f->n++) {
        SEQ_CALL(d, f, PL_JOB_READ, f->n, BQ76PL536_ALERT_STATUS, 2);
        if (d->result == BQ_E_NO_ANSWER) {
            SEQ_TRY(d, f, PL_JOB_RELOCATE, f->n, 0, 0);
            return BQ_OK;
        }
        if (d->result == BQ_OK &&
            ((pl_data(d)[1] & BQ76PL536_FAULT_POR) != 0u || (pl_data(d)[0] & BQ76PL536_ALERT_AR) != 0u)) {
            SEQ_TRY(d, f, PL_JOB_SERVICE, f->n, 0, 0);
        }
    }
    return BQ_OK;
    SEQ_END;
}

static bool scrub_due(bq76pl536 *d)
{
    if (d->found == 0u || d->now_ms - d->scrub_ms < d->config.scrub_period_ms) {
        return false;
    }
    d->scrub_ms = d->now_ms;
    d->scrub_next = d->scrub_next < d->found ? (uint8_t)(d->scrub_next + 1u) : 1u;
    return (pl_dev(d, d->scrub_next)->flags & (PL_DEV_DEFECTIVE | PL_DEV_TSD)) == 0u;
}

static unsigned count_locked(const bq76pl536 *d)
{
    unsigned count = 0;
    for (unsigned n = 1; n <= d->found; n++) {
        count += (d->devices[n - 1u].flags & PL_DEV_LOCKED) != 0u ? 1u : 0u;
    }
    return count;
}

static bool any_line_high(const bq76pl536 *d)
{
    bool high;
    if (pl_line(d, BQ_LINE_FAULT, &high) && high) {
        return true;
    }
    return pl_line(d, BQ_LINE_ALERT, &high) && high;
}

/* A line high that no device explains, seen in two scans so that a flag raised in between is not taken for it
 * (08-09). */
static bool line_unexplained(bq76pl536 *d)
{
    bool explained = d->found < d->config.devices || !any_line_high(d);
    for (unsigned n = 1; n <= d->found && !explained; n++) {
        explained = (d->devices[n - 1u].status & (BQ76PL536_DS_FAULT | BQ76PL536_DS_ALERT)) != 0u;
    }
    if (explained) {
        d->unexplained = 0;
        return false;
    }
    d->unexplained = (uint8_t)(d->unexplained < 3u ? d->unexplained + 1u : 3u);
    return d->unexplained == 2u;
}

/* What the bursts asked for: service, lock-up recovery, lost devices, the scrub. f->x = 1: hot devices may be
 * tried again. */
bq_status pl_job_aftercare(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    f->reg = d->failed_at;
    f->x = d->now_ms - d->tsd_ms >= PL_TSD_MS ? 1u : 0u;
    for (f->n = 1; f->n <= d->found; f->n++) {
        if ((pl_dev(d, f->n)->flags & PL_DEV_SERVICE) != 0u) {
            SEQ_CALL(d, f, PL_JOB_SERVICE, f->n, 0, f->x);
            if (d->result == BQ_E_NO_ANSWER) {
                pl_invalidate(pl_dev(d, f->n), BQ_Q_COMM, BQ_F_COMM);
                f->reg = f->reg != 0u ? f->reg : f->n;
            }
        }
    }
    if (f->x != 0u) {
        d->tsd_ms = d->now_ms;
    }
    if (count_locked(d) > 1u) { /* PL-SEQ-05-03 */
        SEQ_TRY(d, f, PL_JOB_BRINGUP, 0, 0, 0);
    }
    for (f->n = 1; f->n <= d->found; f->n++) {
        if ((pl_dev(d, f->n)->flags & PL_DEV_LOCKED) != 0u) { /* PL-SEQ-05-02 */
            SEQ_CALL(d, f, PL_JOB_RESET_DEVICE, f->n, 0, 0);
        }
    }
    if (f->reg != 0u && f->reg <= d->found) {
        d->probes = 0;
        SEQ_TRY(d, f, PL_JOB_RELOCATE, f->reg, 0, 0);
    } else if (d->found < d->height && d->now_ms - d->probe_ms >= PL_PROBE_MS) {
        SEQ_TRY(d, f, PL_JOB_RELOCATE, d->found + 1u, 0, 0);
    }
    if (d->found == 0u && d->probes > PL_TRIES) {
        SEQ_TRY(d, f, PL_JOB_BRINGUP, 0, 0, 0);
    }
    if (line_unexplained(d)) {
        SEQ_CALL(d, f, PL_JOB_LINES, 0, 0, 0);
    }
    if (scrub_due(d)) {
        SEQ_CALL(d, f, PL_JOB_ESTABLISH, d->scrub_next, 0, 1);
        if (d->result == BQ_E_VERIFY || d->result == BQ_E_DEFECTIVE) {
            pl_dev(d, d->scrub_next)->faults |= BQ_F_CONFIG;
        }
    }
    return BQ_OK;
    SEQ_END;
}

static void begin_picture(bq76pl536 *d)
{
    for (unsigned n = 1; n <= d->config.devices; n++) {
        bq76pl536_device *dev = pl_dev(d, n);
        dev->faults &= (uint16_t)~PL_EVENTS;
        dev->cb_seen = 0;
        if ((dev->flags & PL_DEV_VALID) == 0u && d->now_ms - dev->t_ms > UINT32_MAX / 2u) {
            dev->flags &= (uint16_t)~PL_DEV_MEASURED; /* so old that its age no longer fits */
        }
    }
}

static bool outputs_wrong(const bq76pl536 *d)
{
    for (unsigned n = 1; n <= d->found; n++) {
        if ((d->devices[n - 1u].flags & PL_DEV_CB_WRONG) != 0u) {
            return true;
        }
    }
    return false;
}

static bool any_fresh(const bq76pl536 *d)
{
    for (unsigned n = 1; n <= d->found; n++) {
        if (pl_valid(d, n)) {
            return true;
        }
    }
    return false;
}

/* Ends a picture: BQ_OK when at least one device is fresh. */
static bq_status end_picture(bq76pl536 *d)
{
    unsigned fresh = 0;
    d->start_us = d->convert_us;
    for (unsigned n = 1; n <= d->config.devices; n++) {
        fresh += pl_valid(d, n) ? 1u : 0u;
    }
    d->sequence++;
    if (fresh == d->config.devices && d->stats.scans != UINT32_MAX) {
        d->stats.scans++;
    }
    return fresh != 0u ? BQ_OK : BQ_E_NO_ANSWER;
}

bq_status pl_job_scan(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    d->reading = true;
    begin_picture(d);
    if (d->config.use_conv_pin && any_line_high(d)) {
        SEQ_CALL(d, f, PL_JOB_SWEEP, 0, 0, 0);
    }
    if (d->active) {
        SEQ_CALL(d, f, PL_JOB_CB_PAUSE, 0, 0, 0);
    }
    for (f->tries = 0; f->tries < 2u; f->tries++) {
        SEQ_CALL(d, f, PL_JOB_CONVERT, 0, 0, 0);
        if (d->result != BQ_OK) {
            d->reading = false;
            return d->result; /* nothing was measured: the picture stays and grows older */
        }
        SEQ_CALL(d, f, PL_JOB_READ_IN, 0, 0, 0);
        SEQ_CALL(d, f, PL_JOB_AFTERCARE, 0, 0, 0);
        if (outputs_wrong(d)) {
            SEQ_CALL(d, f, PL_JOB_CB_OFF, 0, 0, 0);
            SEQ_WAIT(d, f, d->config.balance_settle_ms * 1000ul);
        } else if (d->found == 0u || any_fresh(d)) {
            break;
        }
    }
    d->reading = false;
    return end_picture(d);
    SEQ_END;
}
