/* SPDX-License-Identifier: Apache-2.0 */
/* Bring-up: boot, address, CRC option, trim (X0-SEQ-01..12). */
#include "bqhost/crc8.h"
#include "x0_internal.h"

void x0_drive(const bq769x0 *d, bool level)
{
    if (d->gpio.ops != NULL) {
        (void)d->gpio.ops->write(d->gpio.ctx, BQ_LINE_AFE_BOOT,
                                 level); /* a board without it boots the part itself */
    }
}

/* First results after the converter was started: 250, 400, 800 ms and a tenth (X0-SEQ-04, X0-ADC-14). */
uint32_t x0_first_ms(const bq769x0 *d)
{
    static const uint16_t first_ms[3] = {280, 445, 885};
    return first_ms[d->known.groups - 1u];
}

/* A rising edge on TS1 of 2.5 ms, then 12 ms before the first write (X0-SEQ-01, X0-SEQ-02). */
int x0_job_boot(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    x0_drive(d, false);
    SEQ_TRY(1, x0_wait(d, 1000u));
    x0_drive(d, true);
    d->data_ms = d->now_ms + 11u + x0_first_ms(d); /* the clock drops fractions */
    d->watch.fresh_boot = true;
    SEQ_TRY(2, x0_wait(d, 2500u));
    x0_drive(d, false);
    SEQ_TRY(3, x0_wait(d, 12000u));
    return BQ_OK;
    SEQ_END;
}

/* Four bytes as they are; a CRC part sends data, crc, data, crc. */
static unsigned looks_like_crc(const bq769x0 *d)
{
    const uint8_t *bus = d->bus;
    return bq_crc8(bq_crc8(0, bus, 1), bus + 2, 1) == bus[3] && bq_crc8(0, bus + 4, 1) == bus[5];
}

/* X0-SEQ-08 by reading; if the two reads disagree X0-SEQ-09 by writing CC_CFG, twice, so that content left
 * over from before cannot answer. Written without CRC: a part with CRC stores nothing then. */
static int job_probe_crc(bq769x0 *d, bq769x0_frame *f)
{
    uint8_t *cc_cfg = &d->known.registers[BQ769X0_CC_CFG];
    SEQ_BEGIN(f)
    SEQ_TRY(1, X0_FETCH(BQ769X0_OV_TRIP, 4));
    f->x = (uint8_t)looks_like_crc(d);
    SEQ_TRY(2, X0_FETCH(BQ769X0_ADCGAIN1, 4));
    if (f->x != looks_like_crc(d)) {
        *cc_cfg = 0x00;
        SEQ_CALL(3, X0_SET(BQ769X0_CC_CFG, 1));
        f->x = d->result != BQ_OK;
        *cc_cfg = BQ769X0_CC_CFG_VALUE;
        SEQ_CALL(4, X0_SET(BQ769X0_CC_CFG, 1));
        f->x |= (uint8_t)(d->result != BQ_OK);
    }
    d->known.crc = f->x != 0u;
    return d->config.crc == BQ769X0_CRC_PROBE || d->config.crc == BQ769X0_CRC_OFF + f->x
               ? BQ_OK
               : BQ_E_CONFIG; /* X0-SEQ-10 */
    SEQ_END;
}

/* Asks at 0x08 or 0x18 with a plain read that disturbs nothing (X0-SEQ-07). */
static int job_identify(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    for (;;) {
        for (f->i = 0x08; f->i <= 0x18u; f->i += 0x10u) {
            if (d->config.address7 == 0u || d->config.address7 == f->i) {
                d->known.address7 = f->i;
                d->known.crc = false;
                SEQ_CALL(1, X0_FETCH_STAT | X0_ONCE);
                if (d->result == BQ_OK) {
                    SEQ_RUN(2, job_probe_crc);
                    return BQ_OK;
                }
            }
        }
        if (d->result != BQ_E_NACK || f->tries == 1u) {
            x0_recover(d);
        }
        SEQ_TRY(3, x0_wait(d, d->watch.fresh_boot ? 5000u : 1000u)); /* 50 ms after a boot (X0-SEQ-03) */
        if (++f->tries == (d->watch.fresh_boot ? 10u : X0_TRIES)) {
            return BQ_E_NOT_FOUND;
        }
    }
    SEQ_END;
}

/* What 0x04..0x0b tell of the past: nothing at all is the field's bad boot; reset values are a boot that may
 * be a moment old, when nothing may be written yet and nothing is measured (X0-SEQ-02, X0-ADC-14). */
static int job_past(bq769x0 *d, bq769x0_frame *f)
{
    const uint8_t *read = x0_data(d);
    unsigned any = 0, all = 0xff;
    SEQ_BEGIN(f)
    SEQ_TRY(1, X0_FETCH(BQ769X0_SYS_CTRL1, 8));
    for (unsigned i = 0; i < 8u; i++) {
        any |= read[i];
        all &= read[i];
    }
    if (any == 0u || all == 0xffu) {
        return BQ_E_IMPLAUSIBLE;
    }
    if (!d->watch.fresh_boot && (x0_like_new(read) || (read[0] & BQ769X0_CTRL1_ADC_EN) == 0u)) {
        d->data_ms = d->now_ms + 12u + x0_first_ms(d) + X0_SCAN_MS;
        SEQ_TRY(2, x0_wait(d, 12000u));
    }
    return BQ_OK;
    SEQ_END;
}

/* Finds the part and makes sure that it answers with more than zeros. A running part is taken over; a bad
 * boot is answered by SHIP and another boot, three times. */
static int job_find(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    for (f->i = 0;; f->i++) {
        SEQ_RUN_CALL(1, job_identify);
        f->x = d->result == BQ_E_NOT_FOUND;
        if (d->result == BQ_OK) {
            SEQ_RUN_CALL(2, job_past);
        }
        if ((d->result != BQ_E_NOT_FOUND && d->result != BQ_E_IMPLAUSIBLE) || f->i == X0_TRIES) {
            return d->result;
        }
        if (f->x == 0u) {
            SEQ_RUN_CALL(3, x0_job_ship);
        }
        SEQ_RUN_CALL(4, x0_job_boot);
    }
    SEQ_END;
}

/* Inputs that read as a cell. */
static unsigned carrying(const bq769x0 *d)
{
    unsigned inputs = 0;
    for (unsigned i = 0; i < BQ769X0_INPUTS; i++) {
        inputs |= (d->fresh[i] >= BQ769X0_UV_MINQUAL ? 1u : 0u) << i;
    }
    return inputs;
}

/* The first picture, and whether the inputs are wired as configured (X0-SEQ-04, X0-SEQ-12). */
static int job_first(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    while (!x0_reached(d, d->data_ms)) {
        SEQ_TRY(1, x0_wait(d, 5000u));
    }
    d->temp_settled = d->watch.fresh_boot; /* temperatures come with the first scan (X0-AMB-17, X0-AMB-29) */
    for (f->tries = 0; f->tries < 5u; f->tries++) {
        SEQ_RUN(2, x0_job_picture);
        x0_count_picture(d);
        if (x0_valid(d) && carrying(d) == d->known.in_use) {
            return BQ_OK;
        }
        SEQ_TRY(3, x0_wait(d, 260000u));
    }
    d->quality = BQ_Q_CHIP;
    return d->measured ? BQ_E_CELLS : BQ_E_STALE;
    SEQ_END;
}

/* A part that was found: FETs on only if they are to be kept, configuration, SYS_STAT cleared (X0-SEQ-18),
 * first picture. What a running part had flagged is left to the fault service, so that a reset of the host
 * releases nothing; so is XREADY, which takes seconds. */
static int job_take_over(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    SEQ_TRY(1, X0_FETCH(BQ769X0_SYS_CTRL2, 1));
    d->known.registers[BQ769X0_SYS_CTRL2] = d->config.keep_fets ? d->answer & BQ769X0_CTRL2_FETS : 0u;
    SEQ_RUN(2, x0_job_configure);
    x0_configured(d);
    d->state = X0_STATE_NONE; /* not before the first picture */
    SEQ_TRY(3, X0_FETCH_STAT);
    d->known.registers[0] =
        d->answer &
        (d->watch.fresh_boot ? BQ769X0_STAT_CLEAR & ~(unsigned)BQ769X0_STAT_XREADY : BQ769X0_STAT_CC_READY);
    if (d->known.registers[0] != 0u) {
        SEQ_TRY(4, X0_PUT(BQ769X0_SYS_STAT, 1));
    }
    SEQ_RUN(5, job_first);
    d->state = X0_STATE_READY;
    return BQ_OK;
    SEQ_END;
}

/* The whole bring-up; whatever fails after the part was found leaves its FETs and balancing off. */
int x0_job_start(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    d->state = X0_STATE_NONE;
    x0_invalidate(d, BQ_Q_CHIP);
    d->measured = d->watch.fresh_boot = d->trouble.probation = false;
    d->stat = d->trouble.strikes = d->trouble.breakdowns = 0;
    d->held =
        d->trouble.locked ? BQ769X0_STAT_SCD : 0u; /* another start is nobody's intervention (X0-SEQ-32) */
    d->faults = 0;
    x0_balance(d, 0);
    x0_die_reset(d);
    d->data_ms = d->now_ms;
    SEQ_RUN(1, job_find);
    SEQ_RUN_CALL(2, job_take_over);
    if (d->result == BQ_OK) {
        return BQ_OK;
    }
    f->x = (uint8_t)-d->result;
    d->known.registers[BQ769X0_SYS_CTRL2] = 0;
    SEQ_RUN_CALL(3, x0_job_off);
    return -(int)f->x;
    SEQ_END;
}
