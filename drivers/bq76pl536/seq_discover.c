/* SPDX-License-Identifier: Apache-2.0 */
/* Address discovery and assignment: PL-SEQ-02, Figure 12 with retries, and the search for the largest stack
 * that works. */
#include "pl536_internal.h"

static void set_clock(bq76pl536 *d, uint32_t hz)
{
    if (d->spi.ops->set_clock != NULL && d->spi.ops->set_clock(d->spi.ctx, hz) == BQ_OK) {
        d->spi_hz = hz;
        d->diagnosis.spi_hz = hz;
    }
}

/* One assignment, `dev` = n. Only the read-back is repeated: a second assignment would go to the next device
 * (02-05). */
bq_status pl_job_assign(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    f->val = d->attempt == 2u ? f->dev : (uint8_t)(BQ76PL536_ADDRESS_AR | f->dev);
    SEQ_SEND(f, pl_send_write(d, BQ76PL536_ADDR_NONE, BQ76PL536_ADDRESS_CONTROL, f->val));
    SEQ_TRY(d, f, PL_JOB_READ, f->dev, BQ76PL536_ADDRESS_CONTROL, 1);
    return pl_data(d)[0] == (BQ76PL536_ADDRESS_AR | f->dev) ? BQ_OK : BQ_E_NOT_FOUND;
    SEQ_END;
}

/* AR = 1 in devices 1..dev (02-09). */
bq_status pl_job_validate(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    for (f->n = 1; f->n <= f->dev; f->n++) {
        SEQ_TRY(d, f, PL_JOB_READ, f->n, BQ76PL536_DEVICE_STATUS, 1);
        if ((pl_data(d)[0] & (BQ76PL536_DS_AR | BQ76PL536_DS_ZERO)) != BQ76PL536_DS_AR) {
            return BQ_E_NOT_FOUND;
        }
    }
    return BQ_OK;
    SEQ_END;
}

/* Right after a reset every device asserts ALERT; a low line means that the chain is suspect (PL-SEQ-01-03).
 */
static void watch_alert(bq76pl536 *d)
{
    bool high;
    if (pl_line(d, BQ_LINE_ALERT, &high) && !high) {
        d->diagnosis.alert_silent = true;
    }
}

/* The growing loop for a stack of `dev` devices: each pass resets one device more than the one before
 * (PL-ADR-11). */
bq_status pl_job_height(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    for (f->n = 1; f->n <= f->dev; f->n++) {
        if (d->config.crc_off && d->crc) { /* an earlier life of the host may have left them without CRC */
            d->crc = false;
            SEQ_SEND(f, pl_send_write(d, BQ76PL536_ADDR_BROADCAST, BQ76PL536_RESET, BQ76PL536_RESET_CODE));
            d->crc = true;
            SEQ_WAIT(d, f, PL_RESET_US);
        }
        for (f->tries = 0; f->tries < PL_TRIES;
             f->tries++) { /* unsent, the first assignment would go to the next device */
            SEQ_SEND(f, pl_send_write(d, BQ76PL536_ADDR_BROADCAST, BQ76PL536_RESET, BQ76PL536_RESET_CODE));
            if (d->transfer == BQ_OK) {
                break;
            }
        }
        SEQ_WAIT(d, f, PL_RESET_US);
        watch_alert(d);
        for (f->i = 1; f->i <= f->n; f->i++) {
            d->failed_at = f->i;
            SEQ_TRY(d, f, PL_JOB_ASSIGN, f->i, 0, 0);
        }
    }
    d->failed_at = f->dev;
    SEQ_TRY(d, f, PL_JOB_VALIDATE, f->dev, 0, 0);
    return BQ_OK;
    SEQ_END;
}

/* Nothing answers with CRC: devices whose EPROM switches it off answer without (02-11). */
bq_status pl_job_crc_off_pass(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    d->crc = false;
    SEQ_CALL(d, f, PL_JOB_HEIGHT, 1, 0, 0);
    if (d->result != BQ_OK) {
        d->crc = true;
        return BQ_E_NOT_FOUND;
    }
    if (!d->config.crc_off) {
        d->crc = true;
        return BQ_E_CRC_OFF;
    }
    SEQ_TRY(d, f, PL_JOB_HEIGHT, d->config.devices, 0, 0);
    d->found = d->config.devices;
    return BQ_OK;
    SEQ_END;
}

/* Clears AR and POR everywhere and looks that they are gone (02-10). */
bq_status pl_job_arrival(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    SEQ_SEND(f, pl_send_write(d, BQ76PL536_ADDR_BROADCAST, BQ76PL536_ALERT_STATUS, BQ76PL536_ALERT_AR));
    SEQ_SEND(f, pl_send_write(d, BQ76PL536_ADDR_BROADCAST, BQ76PL536_ALERT_STATUS, 0));
    SEQ_SEND(f, pl_send_write(d, BQ76PL536_ADDR_BROADCAST, BQ76PL536_FAULT_STATUS, BQ76PL536_FAULT_POR));
    SEQ_SEND(f, pl_send_write(d, BQ76PL536_ADDR_BROADCAST, BQ76PL536_FAULT_STATUS, 0));
    for (f->n = 1; f->n <= d->found; f->n++) {
        SEQ_TRY(d, f, PL_JOB_READ, f->n, BQ76PL536_ALERT_STATUS, 2);
        f->x = pl_data(d)[1] & BQ76PL536_FAULT_POR;
        if ((pl_data(d)[0] & BQ76PL536_ALERT_AR) != 0u) {
            SEQ_TRY(d, f, PL_JOB_CLEAR, f->n, BQ76PL536_ALERT_STATUS, BQ76PL536_ALERT_AR);
        }
        if (f->x != 0u) {
            SEQ_TRY(d, f, PL_JOB_CLEAR, f->n, BQ76PL536_FAULT_STATUS, BQ76PL536_FAULT_POR);
        }
    }
    return BQ_OK;
    SEQ_END;
}

/* What a device without an address would say to a read of DEVICE_STATUS at 0x00: anything but a dead bus. */
static bool somebody_at_zero(bq76pl536 *d)
{
    return pl_answer(d) == BQ_OK && pl_data(d)[0] != 0x00u && pl_data(d)[0] != 0xffu;
}

/*
 * The whole of PL-SEQ-02. Three attempts (the second assigns bare numbers, the third at half the clock). When
 * they fail, the largest height that works is sought: first just below the break, then by halving, because a
 * device with a wiring fault can disturb those below it. f->n = lowest height known not to work, f->i =
 * highest known to work, f->x = tried.
 */
bq_status pl_job_discover(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    d->found = 0;
    d->crc = true;
    d->height = d->config.devices;
    d->diagnosis.broken_hop = 0;
    d->diagnosis.extra_device = false;
    d->diagnosis.alert_silent = false;
    for (d->attempt = 1; d->attempt <= PL_TRIES; d->attempt++) {
        set_clock(d, d->attempt == PL_TRIES ? d->config.spi_hz / 2u : d->config.spi_hz);
        SEQ_CALL(d, f, PL_JOB_HEIGHT, d->config.devices, 0, 0);
        if (d->result == BQ_OK) {
            break;
        }
        f->n = d->failed_at > f->n ? d->failed_at : f->n;
    }
    if (d->attempt <= PL_TRIES) {
        d->found = d->config.devices;
    } else {
        set_clock(d, d->config.spi_hz);
        d->attempt = 1;
        f->x = f->n;
        f->tries = (uint8_t)(f->n - 1u);
        while (f->n - f->i > 1) {
            f->x = f->tries;
            SEQ_CALL(d, f, PL_JOB_HEIGHT, f->x, 0, 0);
            if (d->result == BQ_OK) {
                f->i = f->x;
            } else {
                f->n = f->x;
            }
            f->tries = (uint8_t)((f->n + f->i) / 2u);
        }
        if (f->i == 0u) {
            d->diagnosis.broken_hop = 1;
            SEQ_TRY(d, f, PL_JOB_CRC_OFF_PASS, 0, 0, 0);
            d->diagnosis.broken_hop = 0;
        } else {
            d->diagnosis.broken_hop = (uint8_t)(f->i + 1u);
            if (f->x != f->i) {
                SEQ_TRY(d, f, PL_JOB_HEIGHT, f->i, 0, 0);
            }
            d->found = f->i;
            d->height = f->i; /* what lies above may disturb those below */
        }
    }
    for (f->tries = 0; f->tries < PL_TRIES && d->found == d->config.devices; f->tries++) { /* 02-08 */
        SEQ_SEND(f, pl_send_read(d, BQ76PL536_ADDR_NONE, BQ76PL536_DEVICE_STATUS, 1));
        if (somebody_at_zero(d)) {
            d->diagnosis.extra_device = true;
            return BQ_E_EXTRA_DEVICE;
        }
        if (d->transfer == BQ_OK && pl_answer(d) != BQ_E_CRC) {
            break;
        }
    }
    SEQ_TRY(d, f, PL_JOB_ARRIVAL, 0, 0, 0);
    return d->found == d->config.devices || d->config.allow_partial || d->state == PL_STATE_READY
               ? BQ_OK
               : BQ_E_NOT_FOUND;
    SEQ_END;
}

static void forget(bq76pl536 *d)
{
    pl_invalidate_from(d, 1u, BQ_Q_COMM, 0);
    for (unsigned n = 1; n <= d->config.devices; n++) {
        pl_dev(d, n)->flags &= PL_DEV_MEASURED | PL_DEV_DEFECTIVE;
        pl_dev(d, n)->cb_on = 0;
    }
    d->active = false;
}

/* Discovery and configuration together: the second half of bring-up, and the last resort in service. */
bq_status pl_job_bringup(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    forget(d);
    SEQ_TRY(d, f, PL_JOB_DISCOVER, 0, 0, 0);
    pl_invalidate_from(d, d->found + 1u, BQ_Q_COMM, BQ_F_COMM);
    SEQ_TRY(d, f, PL_JOB_CONFIGURE, 0, 0, 0);
    return BQ_OK;
    SEQ_END;
}

/* From a stack in an unknown state to a configured one: power-up, discovery, configuration, self-test. */
bq_status pl_job_cold(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    d->power_ms = d->now_ms;
    SEQ_WAIT(d, f, PL_POWER_UP_MS * 1000u);
    SEQ_CALL(d, f, PL_JOB_BRINGUP, 0, 0, 0);
    if (d->result != BQ_OK && d->found == 0u && d->gpio.ops != NULL &&
        d->gpio.ops->write(d->gpio.ctx, BQ_LINE_AFE_POWER, false) == BQ_OK) { /* PL-SEQ-05-04 */
        SEQ_WAIT(d, f, PL_POWER_OFF_US);
        pl_drive(d, BQ_LINE_AFE_POWER, true);
        d->power_ms = d->now_ms;
        SEQ_WAIT(d, f, PL_POWER_UP_MS * 1000u);
        SEQ_CALL(d, f, PL_JOB_BRINGUP, 0, 0, 0);
    }
    if (d->result != BQ_OK) {
        return d->result;
    }
    if (d->now_ms - d->power_ms < PL_FIRST_CONVERSION_MS) {
        SEQ_WAIT(d, f, (PL_FIRST_CONVERSION_MS - (d->now_ms - d->power_ms)) * 1000u);
    }
    SEQ_CALL(d, f, PL_JOB_SELF_TEST, 0, 0,
             0); /* what it finds is reported; measuring is possible all the same */
    if (d->config.warm_start && !d->config.crc_off && d->found == d->config.devices) {
        /* the mark that the next life looks for */
        SEQ_SEND(f, pl_send_write(d, BQ76PL536_ADDR_BROADCAST, BQ76PL536_CB_TIME, d->config.balance_timer_s));
    }
    return BQ_OK;
    SEQ_END;
}

static void forget_findings(bq76pl536 *d)
{
    d->state = PL_STATE_NONE;
    for (unsigned n = 1; n <= d->config.devices; n++) {
        pl_dev(d, n)->faults = 0;
        pl_dev(d, n)->flags &= PL_DEV_MEASURED;
        pl_dev(d, n)->resets = 0;
        pl_dev(d, n)->open_wire = 0;
        pl_dev(d, n)->wire_count = 0;
    }
    pl_drive(d, BQ_LINE_VPP, false);
    pl_drive(d, BQ_LINE_CONV, false);
    pl_drive(d, BQ_LINE_AFE_POWER, true);
}

/* Only the first start may find a running stack: a later one has a reason that a reset has to cure. */
static bool may_be_running(bq76pl536 *d)
{
    const bool first = !d->started;

    d->started = true;
    return first && d->config.warm_start && !d->config.crc_off;
}

/* PL-SEQ-01. */
bq_status pl_job_start(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    forget_findings(d);
    if (d->spi.ops->set_clock != NULL && d->spi.ops->set_clock(d->spi.ctx, d->config.spi_hz) != BQ_OK) {
        return BQ_E_CLOCK;
    }
    d->result = BQ_E_STATE;
    if (may_be_running(d)) {
        SEQ_CALL(d, f, PL_JOB_WARM, 0, 0, 0);
    }
    if (d->result != BQ_OK) {
        SEQ_TRY(d, f, PL_JOB_COLD, 0, 0, 0);
    }
    d->state = PL_STATE_READY;
    d->scrub_next = 1;
    d->scrub_ms = d->now_ms;
    return BQ_OK;
    SEQ_END;
}
