/* SPDX-License-Identifier: Apache-2.0 */
/* Transactions of the bq769x0 with and without CRC, and the jobs that repeat them (X0-I2C, X0-SEQ-48..52). */
#include "bqhost/crc8.h"
#include "x0_internal.h"
#include <string.h>

#define READING 0x80u       /* in the frame of a transfer, beside the number of registers */
#define PATIENCE_US 200000u /* with a transfer that does not end */

/* Walks over the data bytes of d->bus: puts them there from d->want, or takes them to d->data. With CRC each
 * is followed by its own; the first also covers the address, and in a write the register (X0-I2C-12..15).
 * False: a CRC is wrong. */
static bool walk(bq769x0 *d, const bq769x0_frame *f)
{
    bool reading = f->n >= READING;
    uint8_t *data = reading ? d->data : &d->want[f->reg], *at = d->bus + 2;
    uint8_t crc = bq_crc8(0, d->bus, reading ? 1u : 2u);
    for (unsigned n = f->n & ~READING; n != 0u; n--, data++) {
        uint8_t *byte = at++;
        if (reading) {
            *data = *byte;
        } else {
            *byte = *data;
        }
        if (d->crc) {
            crc = bq_crc8(crc, data, 1);
            if (!reading) {
                *at = crc;
            }
            if (*at++ != crc) {
                return false;
            }
            crc = 0;
        }
    }
    return true;
}

static void send(bq769x0 *d, const bq769x0_frame *f)
{
    bool reading = f->n >= READING;
    unsigned length = (f->n & ~READING) << d->crc;
    d->bus[0] = (uint8_t)(d->address7 * 2u + reading);
    d->bus[1] = f->reg;
    d->segments[0].data = d->bus + 1;
    d->segments[0].len = (uint16_t)(reading ? 1u : length + 1u);
    d->segments[1].data = d->bus + 2;
    d->segments[1].len = (uint16_t)length;
    d->segments[1].read = true; /* the last segment ends with STOP */
    if (!reading) {
        (void)walk(d, f);
    }
    d->stats.bytes += length + 2u + reading;
    x0_bump(&d->stats.packets);
    d->due_us = d->now_us + PATIENCE_US;
    d->transfer = d->i2c.ops->start(d->i2c.ctx, d->address7, d->segments, reading ? 2u : 1u);
    d->busy = d->transfer == BQ_OK;
    if (!d->busy) {
        d->due_us = d->now_us;
    }
}

/* Judges the transaction that ended last; after a good read d->data holds the registers. */
static bq_status judge(bq769x0 *d, const bq769x0_frame *f)
{
    uint32_t *counter = &d->stats.bus_errors;
    if (d->transfer == BQ_OK) {
        if (f->n < READING || walk(d, f)) {
            return BQ_OK;
        }
        d->transfer = BQ_E_CRC;
        counter = &d->stats.crc_errors;
    } else if (d->transfer == BQ_E_NACK) {
        counter = &d->stats.no_answers;
    }
    x0_bump(counter);
    return d->transfer;
}

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
        SEQ_YIELD(1, send(d, f));
        if (judge(d, f) == BQ_OK) {
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
        if (f->n < READING) {
            x0_bump(&d->stats.write_errors);
            if (f->reg == BQ769X0_SYS_STAT) {
                SEQ_TRY(3, x0_fetch(d, BQ769X0_SYS_STAT, 1));
                d->want[0] &= d->data[0];
            }
        }
    }
    SEQ_END;
}

void x0_fetch(bq769x0 *d, unsigned reg, unsigned n)
{
    (void)x0_push(d, x0_job_transfer, reg, n | READING);
}

void x0_put(bq769x0 *d, unsigned reg, unsigned n)
{
    (void)x0_push(d, x0_job_transfer, reg, n);
}

/* One try only. */
void x0_once(bq769x0 *d, unsigned reg, unsigned n, bool reading)
{
    x0_push(d, x0_job_transfer, reg, reading ? n | READING : n)->tries = X0_TRIES;
}

/* Whether registers `reg`.. as read hold what they should: reserved bits are masked (X0-BIT-03), and a FET
 * that the chip took back is no difference: whoever turned it on looks himself. */
bool x0_holds(const bq769x0 *d, unsigned reg, unsigned n)
{
    static const uint8_t mask[] = {0, 0x1f, 0x1f, 0x1f, 0x1f, 0xc3, 0x9f, 0x7f, 0xf0, 0xff, 0xff, 0x3f};
    for (unsigned i = 0; i < n; i++, reg++) {
        unsigned differs = (unsigned)(d->data[i] ^ d->want[reg]) & mask[reg];
        if (reg == BQ769X0_SYS_CTRL2) {
            differs &= ~(d->want[reg] & BQ769X0_CTRL2_FETS);
        }
        if (differs != 0u) {
            return false;
        }
    }
    return true;
}

/* Writes registers as they should be, reads them back and compares (X0-SEQ-16). d->data holds what was read.
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
