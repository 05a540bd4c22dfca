/* SPDX-License-Identifier: Apache-2.0 */
/* Bring-up: boot, address, CRC option, trim (X0-SEQ-01..12). */
#include "bqhost/crc8.h"
#include "x0_internal.h"

void x0_drive(const bq769x0 *d, bq_line line, bool level)
{
    if (d->gpio.ops != NULL) {
        (void)d->gpio.ops->write(d->gpio.ctx, line, level); /* a board without it boots the part itself */
    }
}

/* First results after the converter was started: 250, 400, 800 ms and a tenth (X0-SEQ-04, X0-ADC-14). */
uint32_t x0_first_ms(const bq769x0 *d)
{
    static const uint16_t first_ms[3] = {280, 445, 885};
    return first_ms[x0_groups(d) - 1u];
}

/* A rising edge on TS1 of 2.5 ms, then 12 ms before the first write (X0-SEQ-01, X0-SEQ-02). */
bq_status x0_job_boot(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    x0_drive(d, BQ_LINE_AFE_BOOT, false);
    SEQ_WAIT(d, f, 1000u);
    x0_drive(d, BQ_LINE_AFE_BOOT, true);
    d->data_ms = d->now_ms + 11u + x0_first_ms(d); /* the clock drops fractions */
    d->fresh_boot = true;
    SEQ_WAIT(d, f, 2500u);
    x0_drive(d, BQ_LINE_AFE_BOOT, false);
    SEQ_WAIT(d, f, 12000u);
    return BQ_OK;
    SEQ_END;
}

/* Who answers at 0x08 or 0x18, asked with a plain read that disturbs nothing (X0-SEQ-07). */
static bq_status ask(bq769x0 *d, uint8_t address)
{
    d->achieved.address7 = address;
    d->achieved.crc = false;
    return x0_send_read(d, BQ769X0_SYS_STAT, 1);
}

bq_status x0_job_identify(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    for (f->tries = 0; f->tries < (d->fresh_boot ? 10u : X0_TRIES); f->tries++) {
        for (f->i = 0; f->i < 2u; f->i++) {
            f->x = f->i == 0u ? 0x08u : 0x18u;
            if (d->config.address7 != 0u && d->config.address7 != f->x) {
                continue;
            }
            SEQ_SEND(f, ask(d, f->x));
            if (x0_reply(d) == BQ_OK) {
                SEQ_TRY(d, f, X0_JOB_PROBE_CRC, 0, 0);
                return BQ_OK;
            }
        }
        if (d->transfer != BQ_E_NACK || f->tries == 1u) {
            x0_recover(d);
        }
        SEQ_WAIT(d, f, d->fresh_boot ? 5000u : 1000u); /* 50 ms after a boot (X0-SEQ-03) */
    }
    return BQ_E_NOT_FOUND;
    SEQ_END;
}

/* Four bytes as they are; a CRC part sends data, crc, data, crc. */
static bool looks_like_crc(const bq769x0 *d, uint8_t first)
{
    uint8_t head[2] = {(uint8_t)(d->achieved.address7 * 2u + 1u), first};
    return bq_crc8(0, head, 2) == d->data[1] && bq_crc8(0, &d->data[2], 1) == d->data[3];
}

/* X0-SEQ-08 by reading; if the two reads disagree X0-SEQ-09 by writing CC_CFG, twice, so that content left
 * over from before cannot answer. Written without CRC: a part with CRC stores nothing then. */
bq_status x0_job_probe_crc(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_OV_TRIP, 4);
    f->x = looks_like_crc(d, d->data[0]) ? 1u : 0u;
    SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_ADCGAIN1, 4);
    if (f->x != (looks_like_crc(d, d->data[0]) ? 1u : 0u)) {
        d->data[0] = 0x00;
        SEQ_CALL(d, f, X0_JOB_SET, BQ769X0_CC_CFG, 1);
        f->x = d->result != BQ_OK;
        d->data[0] = BQ769X0_CC_CFG_VALUE;
        SEQ_CALL(d, f, X0_JOB_SET, BQ769X0_CC_CFG, 1);
        f->x |= (uint8_t)(d->result != BQ_OK);
    }
    d->achieved.crc = f->x != 0u;
    if ((d->config.crc == BQ769X0_CRC_ON && !d->achieved.crc) ||
        (d->config.crc == BQ769X0_CRC_OFF && d->achieved.crc)) {
        return BQ_E_CONFIG; /* X0-SEQ-10 */
    }
    return BQ_OK;
    SEQ_END;
}

/* Gain and offset (X0-SEQ-11). */
bq_status x0_job_trim(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    SEQ_TRY(d, f, X0_JOB_AGREE, BQ769X0_ADCGAIN1, 2);
    f->x = d->data[0];
    f->i = d->data[1];
    SEQ_TRY(d, f, X0_JOB_AGREE, BQ769X0_ADCGAIN2, 1);
    d->achieved.trim = bq769x0_trim_from(f->x, f->i, d->data[0]);
    return BQ_OK;
    SEQ_END;
}

/* What 0x04..0x0b tell of the past: nothing at all is the field's bad boot; reset values are a boot that may
 * be a moment old, when nothing may be written yet and nothing is measured (X0-SEQ-02, X0-ADC-14). */
bq_status x0_job_past(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_SYS_CTRL1, 8);
    f->x = 0;
    f->i = 0xff;
    for (unsigned i = 0; i < 8u; i++) {
        f->x |= d->data[i];
        f->i &= d->data[i];
    }
    if (f->x == 0u || f->i == 0xffu) {
        return BQ_E_IMPLAUSIBLE;
    }
    f->x = d->data[5] == 0xacu && d->data[6] == 0x97u && d->data[7] == 0u;
    if (!d->fresh_boot && (f->x != 0u || (d->data[0] & BQ769X0_CTRL1_ADC_EN) == 0u)) {
        d->data_ms = d->now_ms + 12u + x0_first_ms(d) + X0_SCAN_MS;
        SEQ_WAIT(d, f, 12000u);
    }
    return BQ_OK;
    SEQ_END;
}

/* Finds the part and makes sure that it answers with more than zeros. A running part is taken over; a bad
 * boot is answered by SHIP and another boot, three times. */
bq_status x0_job_find(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    for (f->i = 0;; f->i++) {
        SEQ_CALL(d, f, X0_JOB_IDENTIFY, 0, 0);
        f->x = d->result == BQ_E_NOT_FOUND;
        if (d->result == BQ_OK) {
            SEQ_CALL(d, f, X0_JOB_PAST, 0, 0);
        }
        if ((d->result != BQ_E_NOT_FOUND && d->result != BQ_E_IMPLAUSIBLE) || f->i == X0_TRIES) {
            return d->result;
        }
        if (f->x == 0u) {
            SEQ_CALL(d, f, X0_JOB_SHIP, 0, 0);
        }
        SEQ_CALL(d, f, X0_JOB_BOOT, 0, 0);
    }
    SEQ_END;
}

/* The whole bring-up; whatever fails after the part was found leaves its FETs and balancing off. */
bq_status x0_job_start(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    d->state = X0_STATE_NONE;
    d->valid = d->measured = d->temp_valid = d->fresh_boot = d->probation = d->locked = false;
    d->held = d->strikes = d->shadow1 = 0;
    d->faults = 0;
    d->balance = 0;
    d->data_ms = d->now_ms;
    SEQ_TRY(d, f, X0_JOB_FIND, 0, 0);
    SEQ_CALL(d, f, X0_JOB_TRIM, 0, 0);
    if (d->result == BQ_OK) {
        SEQ_CALL(d, f, X0_JOB_CONFIGURE, 0, 0);
    }
    if (d->result == BQ_OK) {
        SEQ_CALL(d, f, X0_JOB_FIRST, 0, 0);
    }
    if (d->result == BQ_OK) {
        d->state = X0_STATE_READY;
        return BQ_OK;
    }
    d->last = d->result;
    d->shadow2 = 0;
    SEQ_CALL(d, f, X0_JOB_OFF, 0, 0);
    return d->last;
    SEQ_END;
}

/* The first picture, and whether the inputs are wired as configured (X0-SEQ-04, X0-SEQ-12). */
bq_status x0_job_first(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    while ((int32_t)(d->data_ms - d->now_ms) > 0) {
        SEQ_WAIT(d, f, 5000u);
    }
    if (d->fresh_boot) {
        d->temp_ms =
            d->now_ms - X0_TEMP_MS; /* temperatures come with the first scan (X0-AMB-17, X0-AMB-29) */
    }
    d->stat = 0;
    for (f->tries = 0; f->tries < 5u; f->tries++) {
        SEQ_TRY(d, f, X0_JOB_PICTURE, 0, 0);
        f->x = (uint8_t)!d->valid;
        for (unsigned i = 0; i < d->config.inputs; i++) {
            bool carries = d->code[i] >= BQ769X0_UV_MINQUAL, should = ((unsigned)d->in_use >> i & 1u) != 0u;
            f->x |= (uint8_t)(carries != should);
        }
        if (f->x == 0u) {
            return BQ_OK;
        }
        SEQ_WAIT(d, f, 260000u);
    }
    d->valid = false;
    return d->bat_code == 0u ? BQ_E_STALE : BQ_E_CELLS;
    SEQ_END;
}
