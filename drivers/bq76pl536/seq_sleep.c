/* SPDX-License-Identifier: Apache-2.0 */
/* SLEEP entry and exit of the whole stack: PL-SEQ-11. */
#include "pl536_internal.h"

bq_status pl_job_sleep(bq76pl536 *d, bq76pl536_frame *f)
{
    bool high;
    SEQ_BEGIN(f)
    SEQ_TRY(d, f, PL_JOB_CB_OFF, 0, 0, 0); /* 11-01 */
    d->reading = true;
    SEQ_CALL(d, f, PL_JOB_READ_IN, 0, 0,
             0); /* the last results, so that DRDY costs no current (PL-DRDY-05) */
    d->reading = false;
    for (f->n = 1; f->n <= d->found; f->n++) {
        SEQ_TRY(d, f, PL_JOB_WRITE, f->n, BQ76PL536_ADC_CONTROL,
                pl_adc_control(d, f->n) & (uint8_t)~BQ76PL536_ADC_ON);
        SEQ_TRY(d, f, PL_JOB_WRITE, f->n, BQ76PL536_CB_TIME, 0); /* PL-SLEEP-11 */
        pl_dev(d, f->n)->flags &= (uint16_t)~PL_DEV_CB_TIME;
    }
    d->state = PL_STATE_ASLEEP;
    pl_invalidate_from(d, 1u, 0, 0);
    SEQ_SEND(f, pl_send_write(d, BQ76PL536_ADDR_BROADCAST, BQ76PL536_IO_CONTROL, BQ76PL536_IO_SLEEP));
    for (f->n = 1; f->n <= d->found; f->n++) { /* 11-02, 11-03 */
        SEQ_TRY(d, f, PL_JOB_READ, f->n, BQ76PL536_IO_CONTROL, 1);
        if ((pl_data(d)[0] & bq76pl536_readback_mask(BQ76PL536_IO_CONTROL)) != BQ76PL536_IO_SLEEP) {
            SEQ_TRY(d, f, PL_JOB_WRITE, f->n, BQ76PL536_IO_CONTROL, BQ76PL536_IO_SLEEP);
        }
    }
    SEQ_SEND(f, pl_send_write(d, BQ76PL536_ADDR_BROADCAST, BQ76PL536_ALERT_STATUS, BQ76PL536_ALERT_SLEEP));
    SEQ_SEND(f, pl_send_write(d, BQ76PL536_ADDR_BROADCAST, BQ76PL536_ALERT_STATUS, 0));
    for (f->n = 1; f->n <= d->found; f->n++) {
        SEQ_TRY(d, f, PL_JOB_READ, f->n, BQ76PL536_ALERT_STATUS, 2);
        pl_dev(d, f->n)->alert = pl_data(d)[0];
        pl_dev(d, f->n)->fault = pl_data(d)[1];
        if ((pl_data(d)[0] & BQ76PL536_ALERT_SLEEP) != 0u) {
            SEQ_TRY(d, f, PL_JOB_CLEAR, f->n, BQ76PL536_ALERT_STATUS, BQ76PL536_ALERT_SLEEP);
        }
    }
    if (d->found == d->config.devices && pl_line(d, BQ_LINE_ALERT, &high) && high) {
        d->diagnosis.alert_line_stuck = true;
        return BQ_E_LINE_STUCK;
    }
    return BQ_OK;
    SEQ_END;
}

/* Out of SLEEP, the ADC on, sensors settled, what changed meanwhile found out. */
bq_status pl_job_wake(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    SEQ_SEND(f,
             pl_send_write(d, BQ76PL536_ADDR_BROADCAST, BQ76PL536_IO_CONTROL, pl_io_control(d))); /* 11-05 */
    SEQ_WAIT(d, f, PL_WAKE_US);
    for (f->n = 1; f->n <= d->found;
         f->n++) { /* 11-05 .. 11-07: every device anew, also one that was reset in SLEEP */
        SEQ_CALL(d, f, PL_JOB_READ, f->n, BQ76PL536_ALERT_STATUS, 2);
        if (d->result == BQ_E_NO_ANSWER) {
            SEQ_TRY(d, f, PL_JOB_RELOCATE, f->n, 0, 0);
            break;
        }
        if (d->result != BQ_OK) {
            return d->result;
        }
        f->x = pl_data(d)[0];
        f->i = pl_data(d)[1];
        if ((f->i & BQ76PL536_FAULT_POR) != 0u) {
            SEQ_TRY(d, f, PL_JOB_ADOPT, f->n, 0, 1);
            continue;
        }
        SEQ_TRY(d, f, PL_JOB_ESTABLISH, f->n, 0, 0);
        if ((f->x & BQ76PL536_ALERT_SLEEP) != 0u) {
            SEQ_TRY(d, f, PL_JOB_CLEAR, f->n, BQ76PL536_ALERT_STATUS, BQ76PL536_ALERT_SLEEP);
        }
        /* a comparator flag that rose while the reference settled is cleared once; an older one stays
         * (PL-AMB-89) */
        f->i &= (uint8_t)(~pl_dev(d, f->n)->fault & (BQ76PL536_FAULT_COV | BQ76PL536_FAULT_CUV));
        if (f->i != 0u) {
            SEQ_CALL(d, f, PL_JOB_CLEAR, f->n, BQ76PL536_FAULT_STATUS, f->i);
        }
    }
    SEQ_WAIT(d, f, pl_settle_us(d) > PL_ADC_ON_US ? pl_settle_us(d) : PL_ADC_ON_US);
    d->state = PL_STATE_READY;
    d->scrub_ms = d->now_ms;
    return BQ_OK;
    SEQ_END;
}
