/* SPDX-License-Identifier: Apache-2.0 */
/* Configuration, its comparison in service, and SHIP (X0-SEQ-13..20, X0-SEQ-47). */
#include "x0_internal.h"

void x0_image(const bq769x0 *d, uint8_t image[6])
{
    image[0] = d->achieved.current.protect1;
    image[1] = d->achieved.current.protect2;
    image[2] = d->achieved.protect3;
    image[3] = d->achieved.ov_trip;
    image[4] = d->achieved.uv_trip;
    image[5] = BQ769X0_CC_CFG_VALUE;
}

static bq_status encode(bq769x0 *d)
{
    bq769x0_achieved *a = &d->achieved;
    bq_status st = bq769x0_ov_trip(a->trim, d->config.ov_mv, &a->ov_trip, &a->ov_uv);
    if (st == BQ_OK) {
        st = bq769x0_uv_trip(a->trim, d->config.uv_mv, &a->uv_trip, &a->uv_uv);
    }
    d->shadow1 = (uint8_t)(BQ769X0_CTRL1_ADC_EN | (d->config.sensors != 0u ? BQ769X0_CTRL1_TEMP_SEL : 0u));
    return st;
}

/* FETs (unless they are to be kept), balancing and delay bypass off; then the limits; then the converter. In
 * service SYS_STAT is left alone: a fault that came meanwhile belongs to the fault service. */
bq_status x0_job_configure(bq769x0 *d, bq769x0_frame *f)
{
    bq_status st;
    SEQ_BEGIN(f)
    st = encode(d);
    if (st != BQ_OK) {
        return st;
    }
    SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_SYS_CTRL2, 1);
    d->want_fets =
        d->config.keep_fets && d->state == X0_STATE_NONE ? (uint8_t)(d->data[0] & BQ769X0_CTRL2_FETS) : 0u;
    d->shadow2 = d->want_fets;
    d->balance = 0;
    SEQ_TRY(d, f, X0_JOB_OFF, 0, 0);
    SEQ_TRY(d, f, X0_JOB_AGREE, BQ769X0_PROTECT3, 1); /* its low nibble stays as found (X0-AMB-88) */
    d->achieved.protect3 = (uint8_t)((d->achieved.protect3 & 0xf0u) | (d->data[0] & 0x0fu));
    x0_image(d, d->data);
    SEQ_TRY(d, f, X0_JOB_SET, BQ769X0_PROTECT1, 6);
    d->data[0] = d->shadow1;
    SEQ_TRY(d, f, X0_JOB_SET, BQ769X0_SYS_CTRL1, 1);
    if (d->state == X0_STATE_NONE) {
        SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_SYS_STAT, 1);
        /* XREADY takes seconds, in the fault service */
        f->x = d->data[0] & BQ769X0_STAT_CLEAR & (uint8_t)~BQ769X0_STAT_XREADY;
        if (f->x != 0u) {
            SEQ_TRY(d, f, X0_JOB_CLEAR, f->x, 0);
        }
    }
    d->shadow2 |= d->config.counter_off ? 0u : BQ769X0_CTRL2_CC_EN;
    d->data[0] = d->shadow2;
    SEQ_TRY(d, f, X0_JOB_SET, BQ769X0_SYS_CTRL2, 1);
    d->cc_ms = d->scrub_ms = d->temp_ms = d->now_ms;
    d->temp_valid = false;
    return BQ_OK;
    SEQ_END;
}

/* Whether 0x01..0x0b as read are not as they should be. */
static bool differs(const bq769x0 *d)
{
    uint8_t want[11];
    bool any = false;
    for (unsigned g = 0; g < 3u; g++) {
        want[g] = (uint8_t)((unsigned)d->balance >> (5u * g) & 0x1fu);
    }
    want[3] = d->shadow1;
    want[4] = d->shadow2;
    x0_image(d, want + 5);
    for (unsigned i = 0; i < sizeof want; i++) {
        any = any || !x0_same(i + 1u, d->data[i], want[i]);
    }
    return any;
}

/* Twice different before it counts: one look may be damaged, or fall between a fault and its service. */
bq_status x0_job_compare(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    for (f->tries = 0; f->tries < 2u; f->tries++) {
        SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_CELLBAL1, 11);
        if (!differs(d)) {
            d->shadow2 &=
                (uint8_t)(d->data[4] | ~BQ769X0_CTRL2_FETS); /* the next apply turns them on again */
            return BQ_OK;
        }
    }
    return BQ_E_VERIFY;
    SEQ_END;
}

/* Reads, configures and waits for data as after a boot (X0-SEQ-20, X0-AMB-16). */
bq_status x0_job_reload(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    x0_bump(&d->stats.recoveries);
    x0_invalidate(d, 0);
    SEQ_TRY(d, f, X0_JOB_TRIM, 0, 0);
    SEQ_TRY(d, f, X0_JOB_CONFIGURE, 0, 0);
    d->data_ms = d->now_ms + x0_first_ms(d) + X0_SCAN_MS;
    return BQ_OK;
    SEQ_END;
}

/* Once a second: what differs is written again, FETs off first (X0-SEQ-20). */
bq_status x0_job_scrub(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    SEQ_CALL(d, f, X0_JOB_COMPARE, 0, 0);
    if (d->result == BQ_E_VERIFY) {
        bool reset = d->data[3] == BQ769X0_CTRL1_ADC_EN && d->data[8] == 0xacu && d->data[9] == 0x97u &&
                     d->data[10] == 0u;
        d->faults |= reset ? BQ_F_RESET : BQ_F_CONFIG;
        SEQ_TRY(d, f, X0_JOB_RELOAD, 0, 0);
        return BQ_OK;
    }
    d->scrub_ms = d->now_ms;
    return d->result;
    SEQ_END;
}

/* FETs, counter and balancing off, TS1 low, then the pattern 00, 01, 10 with nothing in between, then
 * silence, twice, because one silence may be a disturbed address (X0-SEQ-47). */
bq_status x0_job_ship(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    d->want_fets = d->shadow2 = 0;
    d->balance = 0;
    SEQ_CALL(d, f, X0_JOB_OFF, 0, 0);
    if (d->result != BQ_OK && d->state == X0_STATE_READY) {
        return d->result;
    }
    x0_drive(d, BQ_LINE_AFE_BOOT, false);
    for (f->tries = 0; f->tries < X0_TRIES; f->tries++) {
        for (f->i = 0; f->i < 3u; f->i++) {
            d->data[0] = (uint8_t)(d->shadow1 | f->i);
            SEQ_SEND(f, x0_send_write(d, BQ769X0_SYS_CTRL1, 1));
        }
        f->x = 0;
        for (f->i = 0; f->i < 2u; f->i++) {
            SEQ_WAIT(d, f, 10000u);
            SEQ_SEND(f, x0_send_read(d, BQ769X0_SYS_STAT, 1));
            f->x |= (uint8_t)(d->transfer != BQ_E_NACK);
        }
        if (f->x == 0u) {
            d->state = X0_STATE_SHIP;
            x0_invalidate(d, 0);
            return BQ_OK;
        }
    }
    return BQ_E_VERIFY;
    SEQ_END;
}
