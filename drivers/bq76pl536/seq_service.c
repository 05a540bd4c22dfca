/* SPDX-License-Identifier: Apache-2.0 */
/* FAULT and ALERT service of one device: PL-SEQ-08 and PL-SEQ-15. */
#include "pl536_internal.h"

/* Comparator flags are reported, and cleared only when the application has acted (08-06). */
static void note_protection(bq76pl536_device *dev)
{
    dev->faults |= (dev->fault & BQ76PL536_FAULT_COV) != 0u ? BQ_F_CELL_OV : 0u;
    dev->faults |= (dev->fault & BQ76PL536_FAULT_CUV) != 0u ? BQ_F_CELL_UV : 0u;
    dev->faults |= (dev->alert & (BQ76PL536_ALERT_OT1 | BQ76PL536_ALERT_OT2)) != 0u ? BQ_F_OVERTEMP : 0u;
}

static bool memory_doubt(const bq76pl536_device *dev)
{
    return (dev->fault & BQ76PL536_FAULT_I_FAULT) != 0u ||
           (dev->alert & (BQ76PL536_ALERT_ECC_ERR | BQ76PL536_ALERT_PARITY)) != 0u;
}

/* Order of 08-03: CRC, memory, heat, reset, comparators, SLEEP, FORCE. `val` = 1: a hot device may be tried
 * again. */
bq_status pl_job_service(bq76pl536 *d, bq76pl536_frame *f)
{
    bq76pl536_device *dev = pl_dev(d, f->dev);
    SEQ_BEGIN(f)
    SEQ_CALL(d, f, PL_JOB_READ, f->dev, BQ76PL536_ALERT_STATUS, 6);
    if (d->result != BQ_OK) {
        pl_invalidate(dev, BQ_Q_COMM, BQ_F_COMM); /* nothing may be decided on unread flags (06-08) */
        return d->result;
    }
    dev->flags &= (uint16_t)~PL_DEV_SERVICE;
    dev->alert = pl_data(d)[0];
    dev->fault = pl_data(d)[1];
    dev->cov = pl_data(d)[2];
    dev->cuv = pl_data(d)[3];
    if ((dev->fault & BQ76PL536_FAULT_CRC) != 0u) {
        d->stats.write_errors += d->stats.write_errors != UINT32_MAX ? 1u : 0u;
        pl_invalidate(dev, BQ_Q_COMM, 0); /* it may have missed the start */
        SEQ_TRY(d, f, PL_JOB_CLEAR, f->dev, BQ76PL536_FAULT_STATUS, BQ76PL536_FAULT_CRC);
        dev->fault &= (uint8_t)~BQ76PL536_FAULT_CRC;
        f->x = 1;
    }
    if (memory_doubt(dev)) {
        SEQ_TRY(d, f, PL_JOB_MEMORY, f->dev, 0, 0);
        note_protection(dev);
        return BQ_OK;
    }
    if ((dev->alert & BQ76PL536_ALERT_TSD) != 0u || (dev->flags & PL_DEV_TSD) != 0u) {
        dev->flags |= PL_DEV_TSD;
        dev->cb_on = 0;
        pl_invalidate(dev, BQ_Q_CHIP, BQ_F_DIE_TEMP);
        SEQ_SEND(f, pl_send_write(d, BQ76PL536_ADDR_BROADCAST, BQ76PL536_CB_CTRL, 0));
        if (f->val != 0u) {
            SEQ_CALL(d, f, PL_JOB_COOLED, f->dev, 0, 0);
        }
        return BQ_OK;
    }
    if ((dev->fault & BQ76PL536_FAULT_POR) != 0u || (dev->alert & BQ76PL536_ALERT_AR) != 0u) {
        pl_invalidate(dev, BQ_Q_COMM, BQ_F_RESET);
        SEQ_TRY(d, f, PL_JOB_ADOPT, f->dev, 0, 1);
        return BQ_OK;
    }
    note_protection(dev);
    if ((dev->alert & BQ76PL536_ALERT_SLEEP) != 0u) { /* nobody asked for it: its results are old (08-07) */
        pl_invalidate(dev, BQ_Q_CHIP, BQ_F_CONFIG);
        SEQ_TRY(d, f, PL_JOB_ESTABLISH, f->dev, 0, 0);
        SEQ_WAIT(d, f, PL_WAKE_US);
        SEQ_TRY(d, f, PL_JOB_CLEAR, f->dev, BQ76PL536_ALERT_STATUS, BQ76PL536_ALERT_SLEEP);
        f->x = 1;
    }
    if ((dev->fault & BQ76PL536_FAULT_FORCE) != 0u) { /* 08-08 */
        dev->faults |= BQ_F_CONFIG;
        SEQ_TRY(d, f, PL_JOB_CLEAR, f->dev, BQ76PL536_FAULT_STATUS, 0);
    }
    if ((dev->alert & BQ76PL536_ALERT_FORCE) != 0u) {
        dev->faults |= BQ_F_CONFIG;
        SEQ_TRY(d, f, PL_JOB_CLEAR, f->dev, BQ76PL536_ALERT_STATUS, 0);
    }
    if (f->x != 0u) { /* 08-04: the start is the write that was lost */
        SEQ_TRY(d, f, PL_JOB_REMEASURE, f->dev, 0, 0);
        note_protection(dev);
    }
    return BQ_OK;
    SEQ_END;
}

/* Parity, ECC, internal consistency of device `dev` (15-01, 15-02). */
bq_status pl_job_memory(bq76pl536 *d, bq76pl536_frame *f)
{
    bq76pl536_device *dev = pl_dev(d, f->dev);
    SEQ_BEGIN(f)
    pl_invalidate(dev, BQ_Q_CHIP, BQ_F_MEMORY);
    if ((dev->flags & PL_DEV_DEFECTIVE) != 0u) {
        return BQ_OK; /* a link and nothing else */
    }
    if ((dev->fault & BQ76PL536_FAULT_I_FAULT) == 0u && (dev->alert & BQ76PL536_ALERT_ECC_ERR) == 0u) {
        SEQ_TRY(d, f, PL_JOB_COMMAND, f->dev, BQ76PL536_SHDW_CTRL, BQ76PL536_SHDW_REFRESH);
        SEQ_CALL(d, f, PL_JOB_ESTABLISH, f->dev, 0, 0);
        if (d->result == BQ_OK) {
            SEQ_CALL(d, f, PL_JOB_CLEAR, f->dev, BQ76PL536_ALERT_STATUS, BQ76PL536_ALERT_PARITY);
        }
        if (d->result == BQ_OK) {
            dev->alert &= (uint8_t)~BQ76PL536_ALERT_PARITY;
            SEQ_TRY(d, f, PL_JOB_REMEASURE, f->dev, 0, 0);
            dev->faults |= BQ_F_CONFIG; /* what was found and repaired */
            return BQ_OK;
        }
    }
    if (dev->resets == 0u) {
        dev->resets = 1;
        SEQ_TRY(d, f, PL_JOB_RESET_DEVICE, f->dev, 0, 0);
        SEQ_TRY(d, f, PL_JOB_READ, f->dev, BQ76PL536_ALERT_STATUS, 2);
        dev->alert = pl_data(d)[0];
        dev->fault = pl_data(d)[1];
    }
    if (memory_doubt(dev)) {
        dev->flags |= PL_DEV_DEFECTIVE;
        pl_invalidate(dev, BQ_Q_CHIP, BQ_F_DEFECTIVE);
    }
    return BQ_OK;
    SEQ_END;
}

/* Device `dev` was shut down by heat: out of SLEEP again once the flag stays clear (15-03). */
bq_status pl_job_cooled(bq76pl536 *d, bq76pl536_frame *f)
{
    bq76pl536_device *dev = pl_dev(d, f->dev);
    SEQ_BEGIN(f)
    SEQ_TRY(d, f, PL_JOB_CLEAR, f->dev, BQ76PL536_ALERT_STATUS, BQ76PL536_ALERT_TSD);
    SEQ_TRY(d, f, PL_JOB_WRITE, f->dev, BQ76PL536_IO_CONTROL, pl_io_control(d));
    SEQ_WAIT(d, f, PL_WAKE_US);
    SEQ_TRY(d, f, PL_JOB_ESTABLISH, f->dev, 0, 0);
    SEQ_TRY(d, f, PL_JOB_CLEAR, f->dev, BQ76PL536_ALERT_STATUS, BQ76PL536_ALERT_TSD | BQ76PL536_ALERT_SLEEP);
    dev->flags = (uint16_t)((dev->flags & ~(PL_DEV_TSD | PL_DEV_CB_TIME)) | PL_DEV_WARMING);
    dev->faults &= (uint16_t)~BQ_F_DIE_TEMP;
    dev->ready_ms = d->now_ms + pl_settle_us(d) / 1000u + 1u;
    return BQ_OK;
    SEQ_END;
}
