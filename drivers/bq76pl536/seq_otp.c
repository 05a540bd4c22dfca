/* SPDX-License-Identifier: Apache-2.0 */
/*
 * EPROM programming: PL-SEQ-12. Irreversible, once per part. Compiled only with BQHOST_OTP; without it the
 * call is refused and no byte of the procedure is in the image.
 */
#include "bqhost/bq76pl536_convert.h"
#include "pl536_internal.h"
#include <string.h>

#ifdef BQHOST_OTP

#define VBAT_MIN_MV 20000u /* PL-OTP-03 */
#define BURN_US 2500u      /* PL-SEQ-12-06: more than 1.5 ms, nominal 2..3 ms */
#define RISE_US 1000u      /* for the 7 V to stand */

static bool is(const bq76pl536 *d, const uint8_t *image)
{
    return memcmp(pl_data(d), image, BQ76PL536_GROUP3_COUNT) == 0;
}

static bool blank(const bq76pl536 *d)
{
    static const uint8_t zero[BQ76PL536_GROUP3_COUNT] = {0};
    return is(d, zero);
}

static bq_status check_delay(const bq76pl536 *d, uint8_t threshold, uint8_t delay)
{
    uint32_t us;
    bq_status st = bq76pl536_delay_us(delay, &us);
    if (st != BQ_OK) {
        return st;
    }
    return us == 0u && (threshold & 0x80u) == 0u && !d->config.allow_unlatched ? BQ_E_UNLATCHED : BQ_OK;
}

static bq_status check_image(const bq76pl536 *d, const uint8_t *image)
{
    uint16_t cov;
    uint16_t cuv;
    for (unsigned i = 0; i < BQ76PL536_GROUP3_COUNT; i++) {
        bq_status st = bq76pl536_write_check((uint8_t)(BQ76PL536_GROUP3_FIRST + i), image[i]);
        if (st != BQ_OK) {
            return BQ_E_RANGE;
        }
    }
    if (image[1] != 0u) {
        return BQ_E_UNSUPPORTED; /* a part without CRC for ever */
    }
    (void)bq76pl536_cov_mv(image[2], &cov);
    (void)bq76pl536_cuv_mv(image[4], &cuv);
    if (!bq76pl536_cov_cuv_legal(cov, cuv)) {
        return BQ_E_COV_CUV;
    }
    bq_status st = check_delay(d, image[2], image[3]);
    st = st != BQ_OK ? st : check_delay(d, image[4], image[5]);
    if (st == BQ_OK && image[6] != 0u && image[7] == 0u && !d->config.allow_unlatched) {
        st = BQ_E_UNLATCHED;
    }
    return st;
}

bq_status bq76pl536_program_otp(bq76pl536 *d, uint8_t device, const uint8_t *image, uint32_t guard)
{
    if (d == NULL || image == NULL || guard != BQ76PL536_OTP_GUARD) {
        return BQ_E_ARG;
    }
    if (device < 1u || device > d->found) {
        return BQ_E_ARG;
    }
    if (d->depth != 0u) {
        return BQ_E_BUSY;
    }
    if (d->state != PL_STATE_READY || d->gpai_pins) {
        return BQ_E_STATE;
    }
    bq_status st = check_image(d, image);
    if (st != BQ_OK) {
        return st;
    }
    if (d->gpio.ops == NULL || d->gpio.ops->write(d->gpio.ctx, BQ_LINE_VPP, false) != BQ_OK) {
        return BQ_E_UNSUPPORTED;
    }
    d->image = image;
    return pl_begin(d, PL_JOB_OTP, device);
}

/* 12-04 .. 12-06 and the refresh of 12-07. Between the command and the end nothing else is sent; 7 V goes on
 * every path. */
bq_status pl_job_otp_burn(bq76pl536 *d, bq76pl536_frame *f)
{
    size_t length = 0;
    SEQ_BEGIN(f)
    if (d->gpio.ops->write(d->gpio.ctx, BQ_LINE_VPP, true) != BQ_OK) {
        pl_drive(d, BQ_LINE_VPP, false);
        return BQ_E_VOLTAGE;
    }
    SEQ_WAIT(d, f, RISE_US);
    (void)bq76pl536_packet_program(d->tx, sizeof d->tx, f->dev, d->crc, &length);
    SEQ_SEND(f, pl_send_raw(d, length));
    SEQ_WAIT(d, f, BURN_US);
    pl_drive(d, BQ_LINE_VPP, false);
    SEQ_CALL(d, f, PL_JOB_COMMAND, f->dev, BQ76PL536_SHDW_CTRL,
             BQ76PL536_SHDW_REFRESH); /* clears a CRC flag */
    SEQ_TRY(d, f, PL_JOB_READ, f->dev, BQ76PL536_GROUP3_FIRST, BQ76PL536_GROUP3_COUNT);
    if (is(d, d->image)) {
        return BQ_OK;
    }
    return blank(d) ? BQ_E_VERIFY : BQ_E_DEFECTIVE;
    SEQ_END;
}

/* ECC and parity flags may glitch while programming: cleared once, they must stay clear (12-07). */
static uint8_t glitches(const bq76pl536 *d)
{
    return (uint8_t)((pl_data(d)[0] & (BQ76PL536_ALERT_ECC_ERR | BQ76PL536_ALERT_PARITY)) |
                     (pl_data(d)[1] & BQ76PL536_FAULT_I_FAULT) | pl_data(d)[4] | pl_data(d)[5]);
}

static bq_status finish(bq76pl536 *d, bq_status st)
{
    d->image = NULL;
    pl_drive(d, BQ_LINE_VPP, false);
    return st;
}

bq_status pl_job_otp(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    SEQ_CALL(d, f, PL_JOB_SCAN, 0, 0, 0);
    if (!pl_valid(d, f->dev) || pl_dev(d, f->dev)->gpai_mv < VBAT_MIN_MV) {
        return finish(d, BQ_E_VOLTAGE);
    }
    if (d->config.warm_start) { /* no mark: a next life that finds the procedure cut off resets the device */
        pl_dev(d, f->dev)->flags &= (uint16_t)~PL_DEV_CB_TIME;
        SEQ_CALL(d, f, PL_JOB_WRITE, f->dev, BQ76PL536_CB_TIME, 0);
        if (d->result != BQ_OK) {
            return finish(d, d->result);
        }
    }
    SEQ_CALL(d, f, PL_JOB_COMMAND, f->dev, BQ76PL536_SHDW_CTRL, BQ76PL536_SHDW_REFRESH); /* 12-02 */
    SEQ_CALL(d, f, PL_JOB_READ, f->dev, BQ76PL536_GROUP3_FIRST, BQ76PL536_GROUP3_COUNT);
    f->x = d->result == BQ_OK && blank(d) ? 1u : 0u;
    SEQ_CALL(d, f, PL_JOB_READ, f->dev, BQ76PL536_DEVICE_STATUS, 1);
    f->x &= d->result == BQ_OK && (pl_data(d)[0] & BQ76PL536_DS_ECC_COR) == 0u ? 1u : 0u;
    SEQ_CALL(d, f, PL_JOB_READ, f->dev, BQ76PL536_ALERT_STATUS, 6);
    f->x &= d->result == BQ_OK && glitches(d) == 0u ? 1u : 0u;
    if (f->x == 0u) {
        SEQ_CALL(d, f, PL_JOB_ESTABLISH, f->dev, 0, 0);
        return finish(d, BQ_E_NOT_BLANK);
    }
    for (f->tries = 0; f->tries < 2u; f->tries++) { /* one repetition, and only while proven blank (12-09) */
        for (f->i = 0; f->i < BQ76PL536_GROUP3_COUNT; f->i++) { /* 12-03 */
            SEQ_CALL(d, f, PL_JOB_SHADOW, f->dev, BQ76PL536_GROUP3_FIRST + f->i, d->image[f->i]);
            if (d->result != BQ_OK) {
                return finish(d, BQ_E_VERIFY);
            }
        }
        SEQ_CALL(d, f, PL_JOB_READ, f->dev, BQ76PL536_GROUP3_FIRST, BQ76PL536_GROUP3_COUNT);
        if (d->result != BQ_OK || !is(d, d->image)) {
            return finish(d, BQ_E_VERIFY);
        }
        SEQ_CALL(d, f, PL_JOB_READ, f->dev, BQ76PL536_PRESULT_A, 2);
        if (d->result != BQ_OK || pl_data(d)[0] != 0u || pl_data(d)[1] != 0u) {
            return finish(d, BQ_E_VERIFY);
        }
        f->n = d->stats.write_errors & 0xffu;
        SEQ_CALL(d, f, PL_JOB_OTP_BURN, f->dev, 0, 0);
        if (d->result != BQ_E_VERIFY || f->n == (d->stats.write_errors & 0xffu)) {
            break; /* programmed, spoilt, or blank without a damaged command */
        }
    }
    if (d->result != BQ_OK) {
        return finish(d, d->result == BQ_E_VERIFY ? BQ_E_VERIFY : BQ_E_DEFECTIVE);
    }
    for (f->tries = 0; f->tries < 2u; f->tries++) { /* 12-07 */
        SEQ_CALL(d, f, PL_JOB_READ, f->dev, BQ76PL536_ALERT_STATUS, 6);
        f->x = d->result == BQ_OK ? glitches(d) : 0xffu;
        if (f->x == 0u) {
            break;
        }
        SEQ_CALL(d, f, PL_JOB_ACKNOWLEDGE, f->dev, 0, 0);
        SEQ_CALL(d, f, PL_JOB_CLEAR, f->dev, BQ76PL536_ALERT_STATUS, BQ76PL536_ALERT_ECC_ERR);
        SEQ_CALL(d, f, PL_JOB_CLEAR, f->dev, BQ76PL536_FAULT_STATUS, BQ76PL536_FAULT_I_FAULT);
    }
    if (f->x != 0u) {
        return finish(d, BQ_E_DEFECTIVE);
    }
    SEQ_SEND(f, pl_send_write(d, f->dev, BQ76PL536_RESET, BQ76PL536_RESET_CODE)); /* 12-08 */
    SEQ_WAIT(d, f, PL_RESET_US);
    d->attempt = 1;
    SEQ_CALL(d, f, PL_JOB_ASSIGN, f->dev, 0, 0);
    if (d->result != BQ_OK) {
        return finish(d, d->result);
    }
    SEQ_CALL(d, f, PL_JOB_READ, f->dev, BQ76PL536_GROUP3_FIRST, BQ76PL536_GROUP3_COUNT);
    f->x = d->result == BQ_OK && is(d, d->image) ? 1u : 0u;
    SEQ_CALL(d, f, PL_JOB_READ, f->dev, BQ76PL536_DEVICE_STATUS, 1);
    f->x &= d->result == BQ_OK && (pl_data(d)[0] & BQ76PL536_DS_ECC_COR) == 0u ? 1u : 0u;
    SEQ_CALL(d, f, PL_JOB_ADOPT, f->dev, 0, 1);
    return finish(d, f->x != 0u ? BQ_OK : BQ_E_DEFECTIVE);
    SEQ_END;
}

#else

bq_status bq76pl536_program_otp(bq76pl536 *d, uint8_t device, const uint8_t *image, uint32_t guard)
{
    (void)d;
    (void)device;
    (void)image;
    (void)guard;
    return BQ_E_UNSUPPORTED;
}

bq_status pl_job_otp_burn(bq76pl536 *d, bq76pl536_frame *f)
{
    (void)d;
    (void)f;
    return BQ_E_UNSUPPORTED;
}

bq_status pl_job_otp(bq76pl536 *d, bq76pl536_frame *f)
{
    (void)d;
    (void)f;
    return BQ_E_UNSUPPORTED;
}

#endif
