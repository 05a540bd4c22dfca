/* SPDX-License-Identifier: Apache-2.0 */
/* A device lost in the middle of the stack: PL-SEQ-13, and the unicast reset that ends the same way
 * (PL-SEQ-05-02). */
#include "pl536_internal.h"

/* Device `dev` answers at its address; makes it a working member again. `val` = 1: it was just addressed. */
bq_status pl_job_adopt(bq76pl536 *d, bq76pl536_frame *f)
{
    bq76pl536_device *dev = pl_dev(d, f->dev);
    SEQ_BEGIN(f)
    if (f->val == 0u) {
        SEQ_TRY(d, f, PL_JOB_READ, f->dev, BQ76PL536_ALERT_STATUS, 2);
        if ((pl_data(d)[0] & BQ76PL536_ALERT_AR) != 0u || (pl_data(d)[1] & BQ76PL536_FAULT_POR) != 0u) {
            f->val = 1;
        }
    }
    if (f->val != 0u) {
        pl_invalidate(dev, BQ_Q_COMM, 0);
        dev->faults |= BQ_F_RESET;
        dev->flags &= (uint16_t)~(PL_DEV_CB_TIME | PL_DEV_TSD);
        dev->faults &= (uint16_t)~BQ_F_DIE_TEMP;
    }
    SEQ_TRY(d, f, PL_JOB_ESTABLISH, f->dev, 0, 0);
    SEQ_TRY(d, f, PL_JOB_WRITE, f->dev, BQ76PL536_CB_CTRL, 0);
    dev->cb_on = 0;
    if (f->val != 0u) {
        SEQ_TRY(d, f, PL_JOB_ACKNOWLEDGE, f->dev, 0, 0);
        dev->flags |= PL_DEV_WARMING;
        dev->ready_ms =
            d->now_ms + (pl_settle_us(d) > PL_WARM_UP_MS * 1000u ? pl_settle_us(d) / 1000u : PL_WARM_UP_MS);
    }
    if (f->dev > d->found) {
        d->found = f->dev;
    }
    if (d->config.crc_off) {
        SEQ_TRY(d, f, PL_JOB_FRAMING, 0, 0, 0);
    }
    dev->flags &= (uint16_t)~PL_DEV_LOCKED;
    d->stats.recoveries += d->stats.recoveries != UINT32_MAX ? 1u : 0u;
    return BQ_OK;
    SEQ_END;
}

static void end_stack(bq76pl536 *d, unsigned n)
{
    pl_invalidate_from(d, n, BQ_Q_COMM, BQ_F_COMM);
    d->found = (uint8_t)(n - 1u);
    d->diagnosis.broken_hop = (uint8_t)n;
    d->probe_ms = d->now_ms;
    d->probes = (uint8_t)(d->probes < UINT8_MAX ? d->probes + 1u : UINT8_MAX);
}

/*
 * From device `dev` upward: whoever answers at its address is checked, whoever answers at 0x00 is addressed
 * and configured; where nobody answers the stack ends for now, and the next scans look again. All below stay
 * in use all the time.
 */
bq_status pl_job_relocate(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    for (f->n = f->dev; f->n <= d->height; f->n++) {
        SEQ_CALL(d, f, PL_JOB_READ, f->n, BQ76PL536_ADDRESS_CONTROL, 1);
        if (d->result == BQ_OK && pl_data(d)[0] == (BQ76PL536_ADDRESS_AR | f->n)) {
            SEQ_TRY(d, f, PL_JOB_ADOPT, f->n, 0, 0);
            continue;
        }
        pl_invalidate(pl_dev(d, f->n), BQ_Q_COMM, BQ_F_COMM);
        if (d->config.crc_off) {
            d->crc = true; /* a device that was reset is back at its EPROM setting (13-09) */
        }
        SEQ_CALL(d, f, PL_JOB_READ, BQ76PL536_ADDR_NONE, BQ76PL536_DEVICE_STATUS, 1);
        if (d->result != BQ_OK) {
            d->crc = !d->config.crc_off;
            end_stack(d, f->n);
            return BQ_OK;
        }
        d->attempt = 1;
        SEQ_CALL(d, f, PL_JOB_ASSIGN, f->n, 0, 0);
        if (d->result != BQ_OK) { /* unclear who has the address now (13-04) */
            SEQ_TRY(d, f, PL_JOB_BRINGUP, 0, 0, 0);
            return BQ_OK;
        }
        SEQ_TRY(d, f, PL_JOB_ADOPT, f->n, 0, 1);
    }
    d->found = d->height;
    d->probes = 0;
    if (d->height < d->config.devices) {
        d->diagnosis.broken_hop = (uint8_t)(d->height + 1u);
        return BQ_OK;
    }
    d->diagnosis.broken_hop = 0;
    SEQ_SEND(f, pl_send_read(d, BQ76PL536_ADDR_NONE, BQ76PL536_DEVICE_STATUS, 1)); /* 13-07 */
    if (pl_answer(d) == BQ_OK && pl_data(d)[0] != 0u) {
        SEQ_TRY(d, f, PL_JOB_BRINGUP, 0, 0, 0);
    }
    return BQ_OK;
    SEQ_END;
}

/* Resets device `dev` alone and takes it back in. */
bq_status pl_job_reset_device(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    pl_invalidate(pl_dev(d, f->dev), BQ_Q_CHIP, 0);
    SEQ_SEND(f, pl_send_write(d, f->dev, BQ76PL536_RESET, BQ76PL536_RESET_CODE));
    SEQ_WAIT(d, f, PL_RESET_US);
    SEQ_CALL(d, f, PL_JOB_RELOCATE, f->dev, 0, 0);
    return d->result;
    SEQ_END;
}
