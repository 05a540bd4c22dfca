/* SPDX-License-Identifier: Apache-2.0 */
/* Trim and configuration: read, encoded, written, read back (X0-SEQ-11, X0-SEQ-13..19). */
#include "x0_internal.h"
#include <string.h>

void bq769x0_init_known(bq769x0 *d, const bq769x0_known *known, const bq_i2c *i2c, const bq_clock *clock)
{
    memset(d, 0, sizeof *d);
    d->known = *known;
    d->i2c = *i2c;
    d->clock = *clock;
    d->segments[0].data = &d->bus[1];
    d->segments[1].data = &d->bus[2];
    d->segments[1].read = true;
    d->top = d->frames;
    d->top->next = X0_CATCH; /* no job: the end of every failure */
}

/* What depends on the trim: limits and the scale of the cells, mV = (code * scale + scale_zero) / 2^18, which
 * errs by 0.06 mV at most. The low nibble of PROTECT3 stays as found (X0-AMB-88). */
static bool encode(bq769x0 *d)
{
    uint8_t *want = d->known.registers;
    uint32_t gain_uv = BQ769X0_GAIN_UV(d->trim >> 16, d->trim >> 24);
    int32_t offset_mv = (int8_t)(d->trim >> 8);
    unsigned ov = bq769x0_trip(gain_uv, d->known.ov_mv - offset_mv, false);
    unsigned uv = bq769x0_trip(gain_uv, d->known.uv_mv - offset_mv, true);
    want[BQ769X0_OV_TRIP] = (uint8_t)ov;
    want[BQ769X0_UV_TRIP] = (uint8_t)uv;
    want[BQ769X0_PROTECT3] = (uint8_t)((want[BQ769X0_PROTECT3] & 0xf0u) | (d->trim & 0x0fu));
    d->scale = (gain_uv << 15) / 125u;
    d->scale_zero = (offset_mv * 2 + 1) * 0x20000;
    x0_balance(d, 0);
    return (ov | uv) <= 0xffu;
}

/* FETs as in d->known.registers, balancing and delay bypass off; then the limits; then converter and counter.
 * SYS_STAT is left alone: what stands there is the business of whoever serves faults. */
int x0_job_configure(bq769x0 *d, bq769x0_frame *f)
{
    uint32_t trim;
    SEQ_BEGIN(f)
    d->trim = 0; /* no device has this one */
    for (;;) {
        SEQ_TRY(1, X0_FETCH(BQ769X0_ADCGAIN2, 1));
        f->word = d->answer;
        SEQ_TRY(2, X0_FETCH(BQ769X0_ADCGAIN1, 2));
        f->word = f->word << 16 | (uint32_t)d->answer << 8 | x0_data(d)[1];
        SEQ_TRY(3, X0_FETCH(BQ769X0_PROTECT3, 1));
        trim = f->word << 8 | d->answer;
        if (d->trim == trim) {
            break;
        }
        d->trim = trim;
        if (++f->tries == 5u) {
            return BQ_E_IMPLAUSIBLE;
        }
    }
    if (!encode(d)) {
        return BQ_E_NO_CODE;
    }
    SEQ_TRY(4, X0_SET_SWITCHES(d));
    SEQ_TRY(5, X0_SET_CTRL2);
    SEQ_TRY(6, X0_SET(BQ769X0_PROTECT1, 6));
    d->known.registers[BQ769X0_SYS_CTRL2] |= d->known.counter;
    SEQ_TRY(7, X0_SET(BQ769X0_SYS_CTRL1, 2));
    d->cc_ms = d->temp_ms = d->now_ms;
    d->temp_settled = d->temp_held = d->suspect = false;
    d->temp_quality = BQ_Q_CHIP;
    d->state = X0_STATE_READY;
    return BQ_OK;
    SEQ_END;
}

bq_status bq769x0_begin_configure(bq769x0 *d)
{
    bq_status st;
    if ((d->known.registers[BQ769X0_SYS_CTRL1] & BQ769X0_CTRL1_ADC_EN) == 0u || d->known.shunt_uohm == 0u ||
        d->known.sensor == NULL) {
        return BQ_E_CONFIG;
    }
    st = x0_begin(d, X0_STATE_NONE, x0_job_configure);
    if (st == BQ_OK) {
        d->known.registers[BQ769X0_SYS_CTRL2] = 0;
    }
    return st;
}
