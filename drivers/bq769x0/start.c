/* SPDX-License-Identifier: Apache-2.0 */
/* Bring-up: boot, address, CRC option, trim (X0-SEQ-01..12). */
#include "bqhost/crc8.h"
#include "x0_internal.h"

static void drive(const bq769x0 *d, bq_line line, bool level)
{
    if (d->gpio.ops != NULL) {
        (void)d->gpio.ops->write(d->gpio.ctx, line,
                                 level); /* without the line the board boots the part itself */
    }
}

/* A rising edge on TS1 of 2.5 ms, then 12 ms before the first write (X0-SEQ-01, X0-SEQ-02). */
bq_status x0_job_boot(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    drive(d, BQ_LINE_AFE_BOOT, false);
    SEQ_WAIT(d, f, 1000u);
    drive(d, BQ_LINE_AFE_BOOT, true);
    d->boot_ms = d->now_ms;
    d->fresh_boot = true;
    SEQ_WAIT(d, f, 2500u);
    drive(d, BQ_LINE_AFE_BOOT, false);
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
    for (f->tries = 0; f->tries < X0_TRIES; f->tries++) {
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
        if (d->transfer != BQ_E_NACK && d->i2c.ops->recover != NULL) {
            (void)d->i2c.ops->recover(d->i2c.ctx);
        }
        SEQ_WAIT(d, f, 1000u);
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

/* X0-SEQ-08 by reading; if the two reads disagree X0-SEQ-09 by writing CC_CFG, which must really change. */
bq_status x0_job_probe_crc(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_OV_TRIP, 4);
    f->x = looks_like_crc(d, d->data[0]) ? 1u : 0u;
    SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_ADCGAIN1, 4);
    f->x = (uint8_t)(f->x * 2u + (looks_like_crc(d, d->data[0]) ? 1u : 0u));
    d->achieved.crc = f->x == 3u;
    if (f->x != 0u && f->x != 3u) {
        d->achieved.crc = true;
        for (f->i = 0; f->i < 2u; f->i++) { /* left-over content cannot answer both values */
            d->data[0] = f->i == 0u ? 0x00u : BQ769X0_CC_CFG_VALUE;
            SEQ_CALL(d, f, X0_JOB_SET, BQ769X0_CC_CFG, 1);
            d->achieved.crc = d->achieved.crc && d->result == BQ_OK;
        }
    }
    if ((d->config.crc == BQ769X0_CRC_ON && !d->achieved.crc) ||
        (d->config.crc == BQ769X0_CRC_OFF && d->achieved.crc)) {
        return BQ_E_CONFIG; /* X0-SEQ-10 */
    }
    return BQ_OK;
    SEQ_END;
}

/* Gain and offset, read twice and compared (X0-SEQ-11). i counts equal reads, n holds the checksum of the
 * last one. */
bq_status x0_job_trim(bq769x0 *d, bq769x0_frame *f)
{
    bq769x0_trim trim;
    SEQ_BEGIN(f)
    for (f->tries = 0; f->tries < 4u; f->tries++) {
        SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_ADCGAIN1, 2);
        f->x = d->data[0];
        f->reg = d->data[1];
        SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_ADCGAIN2, 1);
        f->n = (uint8_t)(f->x | f->reg | d->data[0]);
        trim = bq769x0_trim_from(f->x, f->reg, d->data[0]);
        if (f->i != 0u && trim.gain_uv == d->achieved.trim.gain_uv &&
            trim.offset_mv == d->achieved.trim.offset_mv) {
            return f->n == 0u ? BQ_E_IMPLAUSIBLE : BQ_OK; /* all zero: the field's bad boot */
        }
        d->achieved.trim = trim;
        f->i = 1;
    }
    return BQ_E_IMPLAUSIBLE;
    SEQ_END;
}

/* The whole bring-up. A running part is taken over; a bad boot is answered by SHIP and another boot, three
 * times. */
bq_status x0_job_start(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    d->state = X0_STATE_NONE;
    d->valid = d->measured = d->temp_valid = d->fresh_boot = d->probation = d->locked = false;
    d->held = d->strikes = 0;
    d->balance = 0;
    d->boot_ms = d->now_ms - 1000u; /* a running part has converted long ago; x0_job_first finds out */
    for (f->i = 0; f->i <= X0_TRIES; f->i++) {
        SEQ_CALL(d, f, X0_JOB_IDENTIFY, 0, 0);
        if (d->result == BQ_E_NOT_FOUND && f->i < X0_TRIES) {
            SEQ_CALL(d, f, X0_JOB_BOOT, 0, 0);
            continue;
        }
        if (d->result != BQ_OK) {
            return d->result;
        }
        SEQ_CALL(d, f, X0_JOB_TRIM, 0, 0);
        if (d->result == BQ_OK) {
            break;
        }
        if (d->result != BQ_E_IMPLAUSIBLE || f->i == X0_TRIES) {
            return d->result;
        }
        SEQ_CALL(d, f, X0_JOB_SHIP, 0, 0);
    }
    SEQ_TRY(d, f, X0_JOB_CONFIGURE, 0, 0);
    SEQ_TRY(d, f, X0_JOB_FIRST, 0, 0);
    d->state = X0_STATE_READY;
    return BQ_OK;
    SEQ_END;
}

/* The first picture, and whether the inputs are wired as configured (X0-SEQ-04, X0-SEQ-12). */
bq_status x0_job_first(bq769x0 *d, bq769x0_frame *f)
{
    static const uint16_t first_ms[3] = {290, 455, 895};
    SEQ_BEGIN(f)
    while (d->now_ms - d->boot_ms < first_ms[x0_groups(d) - 1u]) {
        SEQ_WAIT(d, f, 5000u);
    }
    if (d->fresh_boot) {
        d->temp_ms = d->now_ms - 2250u; /* temperatures come with the first scan (X0-AMB-17, X0-AMB-29) */
        d->fresh_boot = false;
    }
    d->stat = 0;
    for (f->tries = 0; f->tries < 5u; f->tries++) {
        SEQ_TRY(d, f, X0_JOB_PICTURE, 0, 0);
        f->x = 0;
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
