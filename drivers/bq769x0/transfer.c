/* SPDX-License-Identifier: Apache-2.0 */
/* Transactions with or without CRC (X0-I2C), repeated where they fail, and the reading back of what was
 * written (X0-SEQ-11, X0-SEQ-16, X0-SEQ-48..53). */
#include "bqhost/crc8.h"
#include "x0_internal.h"
#include <string.h>

#define BYTE_US 90u /* eight bits and the acknowledgement at 100 kHz */

/* Walks over the bytes in d->bus and leaves there what is to travel, or the data without CRC. With CRC each
 * data byte is followed by its own; the first also covers the address, and in a write the register
 * (X0-I2C-12..15). False: a CRC is wrong. */
static bool walk(bq769x0 *d, bool reading, unsigned n)
{
    uint8_t *to = d->bus + 2, crc;
    const uint8_t *from = to;
    if (!reading) {
        from = &d->known.registers[d->bus[1]];
    }
    if (!d->known.crc) {
        if (!reading) {
            memcpy(to, from, n);
        }
        return true;
    }
    crc = bq_crc8(0, d->bus, 2u - reading);
    do {
        *to = *from++;
        crc = bq_crc8(crc, to++, 1);
        if (!reading) {
            *to++ = crc;
        } else if (*from++ != crc) {
            return false;
        }
        crc = 0;
    } while (--n != 0u);
    return true;
}

static void send(bq769x0 *d, unsigned op)
{
    unsigned n = op >> 24, reading = op / X0_READ & 1u;
    unsigned length = n << d->known.crc, bytes = length + 2u + reading;
    uint8_t *bus = d->bus;
    bus[0] = (uint8_t)(d->known.address7 * 2u + reading);
    bus[1] = (uint8_t)(op >> 16);
    if (reading == 0u) {
        (void)walk(d, false, n);
    }
    d->stats.bytes += bytes;
    d->segments[1].len = (uint16_t)length;
    d->segments[0].len = (uint16_t)(reading != 0u ? 1u : length + 1u); /* the last one ends with STOP */
    x0_bump(&d->stats.packets);
    d->transfer = d->i2c.ops->start(d->i2c.ctx, d->known.address7, d->segments, reading + 1u);
    if (d->transfer == BQ_OK) {
        d->transfer = BQ_PENDING;
        d->due_us = d->now_us + bytes * BYTE_US;
    }
}

void x0_recover(bq769x0 *d)
{
    if (d->i2c.ops->recover != NULL) {
        (void)d->i2c.ops->recover(d->i2c.ctx);
    }
    d->suspect = true; /* X0-SEQ-53 */
}

/* Whether registers `reg`.. as read hold what they should: reserved bits are masked (X0-BIT-03), and a FET
 * that the chip took back is no difference: whoever turned it on looks himself. */
bool x0_holds(bq769x0 *d, unsigned reg, unsigned n)
{
    static const uint8_t mask[] = {0, 0x1f, 0x1f, 0x1f, 0x1f, 0xc3, 0x9f, 0x7f, 0xf0, 0xff, 0xff, 0x3f};
    for (const uint8_t *read = x0_data(d); n != 0u; n--, reg++) {
        unsigned differs = (unsigned)(*read++ ^ d->known.registers[reg]) & mask[reg];
        if (reg == BQ769X0_SYS_CTRL2) {
            differs &= ~(d->known.registers[reg] & BQ769X0_CTRL2_FETS);
        }
        if (differs != 0u) {
            return false;
        }
    }
    return true;
}

/* What follows from a transaction that went well: BQ_OK, that was all; BQ_PENDING, another one; or how the
 * transfer ends. What is checked is read back, and written again where it differs, three times (X0-SEQ-16).
 */
static int follow(bq769x0 *d, bq769x0_frame *f)
{
    bool reading = (f->op & X0_READ) != 0;
    if (reading) {
        d->answer = *x0_data(d);
    }
    if ((f->op & X0_CHECK) == 0 || (reading && x0_holds(d, d->bus[1], (unsigned)f->op >> 24))) {
        return BQ_OK;
    }
    if (reading) {
        x0_bump(&d->stats.write_errors);
        if (++f->x == X0_TRIES) {
            return BQ_E_VERIFY;
        }
    }
    f->op ^= X0_READ;
    f->tries = 0;
    return BQ_PENDING;
}

/* After one that failed: whether it is repeated. After anything that may be a stuck bus comes its recovery; a
 * silent part is asked once more after that (X0-SEQ-51, X0-SEQ-52). */
static bool again(bq769x0 *d, bq769x0_frame *f, int st)
{
    unsigned silent = 0;
    uint32_t *counter = &d->stats.bus_errors;
    switch (st) {
    case BQ_E_NACK:
        silent = 1;
        counter = &d->stats.no_answers;
        break;
    case BQ_E_CRC:
        counter = &d->stats.crc_errors;
        break;
    default:
        break;
    }
    x0_bump(counter);
    if (++f->tries >= X0_TRIES + silent || (f->op & X0_ONCE) != 0) {
        return false;
    }
    x0_bump(&d->stats.retries);
    if (st != BQ_E_CRC && (silent == 0u || f->tries >= X0_TRIES)) {
        x0_recover(d);
    }
    return true;
}

/* Every try begins with the pointer (X0-SEQ-48): the part's own has moved on; 1 ms lies between two. A
 * clearing of SYS_STAT is repeated only for what still reads as set, so that an event that came in between is
 * not cleared unseen (X0-SEQ-50, X0-BIT-09). */
int x0_job_transfer(bq769x0 *d, bq769x0_frame *f)
{
    int st;
    SEQ_BEGIN(f)
    for (;;) {
        send(d, (unsigned)f->op);
        SEQ_TRY(1, 0);
        st = d->transfer;
        if (st == BQ_OK && (f->op & X0_READ) != 0 && !walk(d, true, (unsigned)f->op >> 24)) {
            st = BQ_E_CRC;
        }
        if (st == BQ_OK) {
            st = follow(d, f);
            if (st == BQ_PENDING) {
                continue;
            }
            return st;
        }
        if (!again(d, f, st)) {
            return st;
        }
        SEQ_TRY(2, x0_wait(d, 1000u));
        if ((f->op & X0_READ) == 0) {
            x0_bump(&d->stats.write_errors);
            if (((unsigned)f->op >> 16 & 0xffu) == BQ769X0_SYS_STAT) {
                SEQ_TRY(3, X0_FETCH_STAT);
                d->known.registers[0] &= d->answer;
            }
        }
    }
    SEQ_END;
}
