/* SPDX-License-Identifier: Apache-2.0 */
/* The jobs that repeat transactions and read back what was written (X0-SEQ-16, X0-SEQ-48..53). */
#include "x0_internal.h"

void x0_recover(bq769x0 *d)
{
    if (d->i2c.ops->recover != NULL) {
        (void)d->i2c.ops->recover(d->i2c.ctx);
    }
    d->scrub_ms = d->now_ms - X0_SCRUB_MS; /* X0-SEQ-53 */
}

/* Every try begins with the pointer (X0-SEQ-48): the part's own has moved on. After silence 1 ms passes,
 * after anything that may be a stuck bus its recovery; a silent part is asked once more after that
 * (X0-SEQ-51, X0-SEQ-52). A clearing of SYS_STAT is repeated only for what still reads as set, so that an
 * event that came in between is not cleared unseen (X0-SEQ-50, X0-BIT-09). */
int x0_job_transfer(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    for (;;) {
        bool silent;
        SEQ_YIELD(1, x0_send(d, f));
        if (x0_judge(d, f) == BQ_OK) {
            return BQ_OK;
        }
        silent = d->transfer == BQ_E_NACK;
        if (++f->tries >= X0_TRIES + silent) {
            return d->transfer;
        }
        x0_bump(&d->stats.retries);
        if (d->transfer != BQ_E_CRC && (!silent || f->tries >= X0_TRIES)) {
            x0_recover(d);
        }
        SEQ_YIELD(2, x0_wait(d, 1000u));
        if (f->n < X0_READING) {
            x0_bump(&d->stats.write_errors);
            if (f->reg == BQ769X0_SYS_STAT) {
                SEQ_TRY(3, x0_fetch_stat(d));
                d->want[0] &= d->answer;
            }
        }
    }
    SEQ_END;
}

void x0_fetch(bq769x0 *d, unsigned reg, unsigned n)
{
    (void)x0_push(d, x0_job_transfer, reg, n | X0_READING);
}

void x0_put(bq769x0 *d, unsigned reg, unsigned n)
{
    (void)x0_push(d, x0_job_transfer, reg, n);
}

/* One try only. */
void x0_once(bq769x0 *d, unsigned reg, unsigned n, bool reading)
{
    x0_push(d, x0_job_transfer, reg, reading ? n | X0_READING : n)->tries = X0_TRIES;
}

/* Whether registers `reg`.. as read hold what they should: reserved bits are masked (X0-BIT-03), and a FET
 * that the chip took back is no difference: whoever turned it on looks himself. */
bool x0_holds(bq769x0 *d, unsigned reg, unsigned n)
{
    static const uint8_t mask[] = {0, 0x1f, 0x1f, 0x1f, 0x1f, 0xc3, 0x9f, 0x7f, 0xf0, 0xff, 0xff, 0x3f};
    for (const uint8_t *read = x0_data(d); n != 0u; n--, reg++) {
        unsigned differs = (unsigned)(*read++ ^ d->want[reg]) & mask[reg];
        if (reg == BQ769X0_SYS_CTRL2) {
            differs &= ~(d->want[reg] & BQ769X0_CTRL2_FETS);
        }
        if (differs != 0u) {
            return false;
        }
    }
    return true;
}

/* Writes registers as they should be, reads them back and compares (X0-SEQ-16).
 */
int x0_job_set(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    for (f->tries = 0; f->tries < X0_TRIES; f->tries++) {
        SEQ_TRY(1, x0_put(d, f->reg, f->n));
        SEQ_TRY(2, x0_fetch(d, f->reg, f->n));
        if (x0_holds(d, f->reg, f->n)) {
            return BQ_OK;
        }
        x0_bump(&d->stats.write_errors);
    }
    return BQ_E_VERIFY;
    SEQ_END;
}

void x0_set(bq769x0 *d, unsigned reg, unsigned n)
{
    (void)x0_push(d, x0_job_set, reg, n);
}

void x0_fetch_stat(bq769x0 *d)
{
    x0_fetch(d, BQ769X0_SYS_STAT, 1);
}

void x0_set_ctrl2(bq769x0 *d)
{
    x0_set(d, BQ769X0_SYS_CTRL2, 1);
}

void x0_set_switches(bq769x0 *d)
{
    x0_set(d, BQ769X0_CELLBAL1, d->groups);
}
