/* SPDX-License-Identifier: Apache-2.0 */
/* Trim and configuration: read, encoded, written, read back (X0-SEQ-11, X0-SEQ-13..19). */
#include "x0_internal.h"

/* One or two registers, twice the same running: for what is read once and used for ever (X0-SEQ-11). */
int x0_job_agree(bq769x0 *d, bq769x0_frame *f)
{
    const uint8_t *now = x0_data(d); /* of one register the byte behind it does not change */
    SEQ_BEGIN(f)
    for (f->tries = 0; f->tries < 4u; f->tries++) {
        f->i = now[0];
        f->x = now[1];
        SEQ_TRY(1, x0_fetch(d, f->reg, f->n));
        if (f->tries != 0u && f->i == now[0] && f->x == now[1]) {
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
    const bq769x0_config *c = &d->config;
    bq769x0_achieved *a = &d->achieved;
    int ov = bq769x0_trip(a->trim, c->ov_mv, false, &a->ov_uv),
        uv = bq769x0_trip(a->trim, c->uv_mv, true, &a->uv_uv);
    if ((ov | uv) < 0) { /* one of them is -1 */
        return BQ_E_NO_CODE;
    }
    a->ov_trip = d->want[BQ769X0_OV_TRIP] = (uint8_t)ov;
    a->uv_trip = d->want[BQ769X0_UV_TRIP] = (uint8_t)uv;
    a->protect3 = d->want[BQ769X0_PROTECT3] = (uint8_t)((a->protect3 & 0xf0u) | low);
    d->want[BQ769X0_PROTECT1] = a->current.protect1;
    d->want[BQ769X0_PROTECT2] = a->current.protect2;
    d->want[BQ769X0_CC_CFG] = BQ769X0_CC_CFG_VALUE;
    d->want[BQ769X0_SYS_CTRL1] =
        c->sensors != 0u ? BQ769X0_CTRL1_ADC_EN | BQ769X0_CTRL1_TEMP_SEL : BQ769X0_CTRL1_ADC_EN;
    return BQ_OK;
}

/* FETs as in d->want, balancing and delay bypass off; then the limits; then converter and counter. SYS_STAT
 * is left alone: what stands there is the business of whoever serves faults. */
int x0_job_configure(bq769x0 *d, bq769x0_frame *f)
{
    bq_status st;
    SEQ_BEGIN(f)
    SEQ_TRY(1, x0_push(d, x0_job_agree, BQ769X0_ADCGAIN2, 1));
    f->x = d->answer;
    SEQ_TRY(2, x0_push(d, x0_job_agree, BQ769X0_ADCGAIN1, 2));
    d->achieved.trim = bq769x0_trim_from(d->answer, x0_data(d)[1], f->x);
    SEQ_TRY(3, x0_push(d, x0_job_agree, BQ769X0_PROTECT3, 1));
    st = encode(d, d->answer & 0x0fu);
    if (st != BQ_OK) {
        return st;
    }
    x0_balance(d, 0);
    SEQ_TRY(4, x0_set_switches(d));
    SEQ_TRY(5, x0_set_ctrl2(d));
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
