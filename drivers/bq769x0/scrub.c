/* SPDX-License-Identifier: Apache-2.0 */
/* The configuration in service: its comparison, its repair, and SHIP (X0-SEQ-20, X0-SEQ-47). */
#include "x0_internal.h"

#define FIRST BQ769X0_CELLBAL1 /* of the registers compared */
#define COUNT 11u

/* Twice different before it counts: one look may be damaged, or fall between a fault and its service. */
int x0_job_compare(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    for (f->tries = 0; f->tries < 2u; f->tries++) {
        SEQ_TRY(1, X0_FETCH(FIRST, COUNT));
        if (x0_holds(d, FIRST, COUNT)) { /* a FET that is off is turned on again by the next apply */
            d->known.registers[BQ769X0_SYS_CTRL2] &=
                (uint8_t)(x0_data(d)[BQ769X0_SYS_CTRL2 - FIRST] | ~BQ769X0_CTRL2_FETS);
            return BQ_OK;
        }
    }
    return BQ_E_VERIFY;
    SEQ_END;
}

/* The configuration was just written. */
void x0_configured(bq769x0 *d)
{
    d->scrub_ms = d->counting.ms = d->now_ms;
    x0_rescale(d);
}

/* Configures with FETs off and waits for data as after a boot (X0-SEQ-20, X0-AMB-16). */
int x0_job_reload(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    x0_bump(&d->stats.recoveries);
    x0_invalidate(d, BQ_Q_CHIP);
    x0_die_reset(d);
    d->known.registers[BQ769X0_SYS_CTRL2] = 0;
    SEQ_RUN(1, x0_job_configure);
    x0_configured(d);
    d->data_ms = d->now_ms + x0_first_ms(d) + X0_SCAN_MS;
    return BQ_OK;
    SEQ_END;
}

/* Whether limits and counter as read, from SYS_CTRL1 on, are those of a part that was just reset. */
bool x0_like_new(const uint8_t *ctrl1)
{
    return ctrl1[5] == 0xacu && ctrl1[6] == 0x97u && ctrl1[7] == 0u;
}

/* Once a second: what differs is written again, FETs off first (X0-SEQ-20). */
int x0_job_scrub(bq769x0 *d, bq769x0_frame *f)
{
    const uint8_t *read = x0_data(d) + (BQ769X0_SYS_CTRL1 - FIRST);
    SEQ_BEGIN(f)
    SEQ_RUN_CALL(1, x0_job_compare);
    if (d->result == BQ_E_VERIFY) {
        bool reset = *read == BQ769X0_CTRL1_ADC_EN && x0_like_new(read);
        d->faults |= reset ? BQ_F_RESET : BQ_F_CONFIG;
        SEQ_RUN(2, x0_job_reload);
        return BQ_OK;
    }
    d->scrub_ms = d->now_ms;
    d->suspect = false;
    return d->result;
    SEQ_END;
}

/* FETs, counter and balancing off, TS1 low, then the pattern 00, 01, 10 with nothing in between, then
 * silence, twice, because one silence may be a disturbed address (X0-SEQ-47). */
int x0_job_ship(bq769x0 *d, bq769x0_frame *f)
{
    uint8_t *ctrl1 = &d->known.registers[BQ769X0_SYS_CTRL1];
    SEQ_BEGIN(f)
    d->known.registers[BQ769X0_SYS_CTRL2] = 0;
    x0_balance(d, 0);
    SEQ_RUN_CALL(1, x0_job_off);
    if (d->result != BQ_OK && d->state == X0_STATE_READY) {
        return d->result;
    }
    x0_drive(d, false);
    for (f->tries = 0; f->tries < X0_TRIES; f->tries++) {
        for (f->i = 0; f->i < 3u; f->i++) {
            *ctrl1 = (uint8_t)((*ctrl1 & ~3u) | f->i);
            SEQ_CALL(2, X0_PUT(BQ769X0_SYS_CTRL1, 1) | X0_ONCE);
        }
        *ctrl1 &= 0xfcu;
        f->x = 0;
        for (f->i = 0; f->i < 2u; f->i++) {
            SEQ_TRY(3, x0_wait(d, 10000u));
            SEQ_CALL(4, X0_FETCH(BQ769X0_SYS_STAT, 1) | X0_ONCE);
            f->x |= (uint8_t)(d->result != BQ_E_NACK);
        }
        if (f->x == 0u) {
            d->state = X0_STATE_SHIP;
            x0_invalidate(d, BQ_Q_CHIP);
            return BQ_OK;
        }
    }
    return BQ_E_VERIFY;
    SEQ_END;
}
