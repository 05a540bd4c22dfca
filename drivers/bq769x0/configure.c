/* SPDX-License-Identifier: Apache-2.0 */
/* Trim and configuration: read, encoded, written, read back (X0-SEQ-11, X0-SEQ-13..19). */
#include "x0_internal.h"
#include <string.h>

/* The same registers twice running, for what is read once and used for ever (X0-SEQ-11). */
int x0_job_agree(bq769x0 *d, bq769x0_frame *f)
{
    uint8_t *before = d->data + 20;
    SEQ_BEGIN(f)
    for (f->tries = 0; f->tries < 4u; f->tries++) {
        memcpy(before, d->data, f->n);
        SEQ_TRY(1, x0_fetch(d, f->reg, f->n));
        if (f->tries != 0u && memcmp(d->data, before, f->n) == 0) {
            return BQ_OK;
        }
    }
    return BQ_E_IMPLAUSIBLE;
    SEQ_END;
}

/* The limits as this device holds them, and all of the configuration but SYS_CTRL2. The low nibble of
 * PROTECT3 stays as found (X0-AMB-88). */
static bq_status encode(bq769x0 *d, unsigned low)
{
    bq769x0_achieved *a = &d->achieved;
    bq_status st = bq769x0_ov_trip(a->trim, d->config.ov_mv, &a->ov_trip, &a->ov_uv);
    if (st == BQ_OK) {
        st = bq769x0_uv_trip(a->trim, d->config.uv_mv, &a->uv_trip, &a->uv_uv);
    }
    a->protect3 = (uint8_t)((a->protect3 & 0xf0u) | low);
    d->want[BQ769X0_SYS_CTRL1] =
        (uint8_t)(BQ769X0_CTRL1_ADC_EN | (d->config.sensors != 0u ? BQ769X0_CTRL1_TEMP_SEL : 0u));
    d->want[BQ769X0_PROTECT1] = a->current.protect1;
    d->want[BQ769X0_PROTECT2] = a->current.protect2;
    d->want[BQ769X0_PROTECT3] = a->protect3;
    d->want[BQ769X0_OV_TRIP] = a->ov_trip;
    d->want[BQ769X0_UV_TRIP] = a->uv_trip;
    d->want[BQ769X0_CC_CFG] = BQ769X0_CC_CFG_VALUE;
    return st;
}

/* FETs as in d->want, balancing and delay bypass off; then the limits; then converter and counter. SYS_STAT
 * is left alone: what stands there is the business of whoever serves faults. */
int x0_job_configure(bq769x0 *d, bq769x0_frame *f)
{
    bq_status st;
    SEQ_BEGIN(f)
    SEQ_TRY(1, x0_push(d, x0_job_agree, BQ769X0_ADCGAIN1, 2));
    f->x = d->data[0];
    f->i = d->data[1];
    SEQ_TRY(2, x0_push(d, x0_job_agree, BQ769X0_ADCGAIN2, 1));
    d->achieved.trim = bq769x0_trim_from(f->x, f->i, d->data[0]);
    SEQ_TRY(3, x0_push(d, x0_job_agree, BQ769X0_PROTECT3, 1));
    st = encode(d, d->data[0] & 0x0fu);
    if (st != BQ_OK) {
        return st;
    }
    x0_balance(d, 0);
    SEQ_TRY(4, x0_set(d, BQ769X0_CELLBAL1, d->groups));
    SEQ_TRY(5, x0_set(d, BQ769X0_SYS_CTRL2, 1));
    SEQ_TRY(6, x0_set(d, BQ769X0_PROTECT1, 6));
    d->want[BQ769X0_SYS_CTRL2] |= d->config.counter_off ? 0u : BQ769X0_CTRL2_CC_EN;
    SEQ_TRY(7, x0_set(d, BQ769X0_SYS_CTRL1, 2));
    d->cc_ms = d->scrub_ms = d->temp_ms = d->now_ms;
    d->temp_settled = d->temp_valid = d->temp_held = false;
    d->state = X0_STATE_READY;
    return BQ_OK;
    SEQ_END;
}

bq_status bq769x0_begin_configure(bq769x0 *d)
{
    bq_status st = x0_begin(d, X0_STATE_NONE, x0_job_configure);
    if (st == BQ_OK) {
        d->want[BQ769X0_SYS_CTRL2] = 0;
    }
    return st;
}
