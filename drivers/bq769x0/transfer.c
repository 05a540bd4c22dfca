/* SPDX-License-Identifier: Apache-2.0 */
/* Transactions of the bq769x0 with and without CRC, and the jobs that repeat them (X0-I2C, X0-SEQ-48..52). */
#include "bqhost/crc8.h"
#include "x0_internal.h"
#include <string.h>

static bq_status start(bq769x0 *d, size_t segments)
{
    d->sent = true;
    d->wait_from_us = d->now_us;
    d->stats.bytes += (uint32_t)d->segments[0].len + 1u + (segments > 1u ? d->segments[1].len + 1u : 0u);
    x0_bump(&d->stats.packets);
    d->transfer = d->i2c.ops->start(d->i2c.ctx, d->achieved.address7, d->segments, segments);
    if (d->transfer == BQ_OK) {
        d->io = X0_IO_TRANSFER;
    }
    return BQ_PENDING;
}

bq_status x0_send_read(bq769x0 *d, unsigned reg, unsigned n)
{
    d->pointer = (uint8_t)reg;
    d->reading = true;
    d->segments[0] = (bq_i2c_segment){&d->pointer, 1, false, false};
    d->segments[1] = (bq_i2c_segment){d->bus, (uint16_t)(d->achieved.crc ? 2u * n : n), true, true};
    return start(d, 2);
}

/* The first CRC covers address, register and data; each further one its data byte alone (X0-I2C-12,
 * X0-I2C-13). */
bq_status x0_send_write(bq769x0 *d, unsigned reg, unsigned n)
{
    uint8_t head[2] = {(uint8_t)(d->achieved.address7 << 1), (uint8_t)reg};
    uint8_t crc = bq_crc8(0, head, 2);
    unsigned length = 0;
    d->reading = false;
    d->bus[length++] = (uint8_t)reg;
    for (unsigned i = 0; i < n; i++) {
        d->bus[length++] = d->data[i];
        if (d->achieved.crc) {
            d->bus[length++] = bq_crc8(crc, &d->data[i], 1);
            crc = 0;
        }
    }
    d->segments[0] = (bq_i2c_segment){d->bus, (uint16_t)length, false, true};
    return start(d, 1);
}

/* Judges the transaction that ended last; after a good read d->data holds the registers. */
bq_status x0_reply(bq769x0 *d)
{
    unsigned n = d->segments[1].len;
    uint8_t crc, address = (uint8_t)(d->achieved.address7 * 2u + 1u);
    if (d->transfer != BQ_OK) {
        x0_bump(d->transfer == BQ_E_NACK ? &d->stats.no_answers : &d->stats.bus_errors);
        return d->transfer;
    }
    if (!d->reading) {
        return BQ_OK;
    }
    crc = bq_crc8(0, &address, 1);
    for (unsigned i = 0; i < n; i++) {
        unsigned k = d->achieved.crc ? i >> 1 : i;
        if (!d->achieved.crc || (i & 1u) == 0u) {
            d->data[k] = d->bus[i];
        } else if (bq_crc8(crc, &d->data[k], 1) != d->bus[i]) {
            x0_bump(&d->stats.crc_errors);
            return BQ_E_CRC;
        } else {
            crc = 0;
        }
    }
    return BQ_OK;
}

/* What to do between two tries: after silence 1 ms, after anything that may be a stuck bus its recovery, and
 * then the scrub (X0-SEQ-51, X0-SEQ-52, X0-SEQ-53). `tries` = failures so far. */
static bq_status between_tries(bq769x0 *d, bq_status st, unsigned tries)
{
    x0_bump(&d->stats.retries);
    if (st != BQ_E_CRC && (st != BQ_E_NACK || tries >= X0_TRIES)) {
        x0_recover(d);
    }
    return x0_wait(d, 1000u);
}

void x0_recover(bq769x0 *d)
{
    if (d->i2c.ops->recover != NULL) {
        (void)d->i2c.ops->recover(d->i2c.ctx);
    }
    d->scrub_ms = d->now_ms - X0_SCRUB_MS;
}

/* A silent part is asked once more after the bus was recovered. */
static bool gives_up(bq769x0_frame *f, bq_status st)
{
    return ++f->tries >= X0_TRIES + (st == BQ_E_NACK ? 1u : 0u);
}

/* Every try begins with the pointer (X0-SEQ-48): the part's own has moved on. */
bq_status x0_job_read(bq769x0 *d, bq769x0_frame *f)
{
    bq_status st;
    SEQ_BEGIN(f)
    for (;;) {
        SEQ_SEND(f, x0_send_read(d, f->reg, f->n));
        st = x0_reply(d);
        if (st == BQ_OK || gives_up(f, st)) {
            return st;
        }
        SEQ_SEND(f, between_tries(d, st, f->tries));
    }
    SEQ_END;
}

/* The same registers twice running, for what is read once and used for ever (X0-SEQ-11). */
bq_status x0_job_agree(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    for (f->tries = 0; f->tries < 4u; f->tries++) {
        SEQ_TRY(d, f, X0_JOB_READ, f->reg, f->n);
        if (f->tries != 0u && memcmp(d->data, d->data + X0_WANTED, f->n) == 0) {
            return BQ_OK;
        }
        memcpy(d->data + X0_WANTED, d->data, f->n);
    }
    return BQ_E_IMPLAUSIBLE;
    SEQ_END;
}

bq_status x0_job_write(bq769x0 *d, bq769x0_frame *f)
{
    bq_status st;
    SEQ_BEGIN(f)
    for (;;) {
        SEQ_SEND(f, x0_send_write(d, f->reg, f->n));
        st = x0_reply(d);
        if (st == BQ_OK || gives_up(f, st)) {
            return st;
        }
        x0_bump(&d->stats.write_errors);
        SEQ_SEND(f, between_tries(d, st, f->tries));
    }
    SEQ_END;
}

/* Writes `reg` (bits) to SYS_STAT; after a failure only what still reads as set is written again, so that an
 * event that came in between is not cleared unseen (X0-SEQ-50, X0-BIT-09). */
bq_status x0_job_clear(bq769x0 *d, bq769x0_frame *f)
{
    bq_status st;
    SEQ_BEGIN(f)
    for (;;) {
        d->data[0] = f->reg;
        SEQ_SEND(f, x0_send_write(d, BQ769X0_SYS_STAT, 1));
        st = x0_reply(d);
        if (st == BQ_OK || gives_up(f, st)) {
            return st;
        }
        SEQ_SEND(f, between_tries(d, st, f->tries));
        SEQ_TRY(d, f, X0_JOB_READ, BQ769X0_SYS_STAT, 1);
        f->reg &= d->data[0];
        if (f->reg == 0u) {
            return BQ_OK;
        }
    }
    SEQ_END;
}

/* Whether register `reg` reads as it should: reserved bits are masked (X0-BIT-03), and a FET that the chip
 * took back is no difference: whoever turned it on looks himself. */
bool x0_same(unsigned reg, uint8_t read, uint8_t wanted)
{
    static const uint8_t mask[] = {0x1f, 0x1f, 0x1f, 0x1f, 0xc0, 0x9f, 0x7f, 0xf0, 0xff, 0xff, 0x3f};
    uint8_t extra = reg == BQ769X0_SYS_CTRL2 ? (uint8_t)(read & ~wanted & BQ769X0_CTRL2_FETS) : 0u;
    return (((read ^ wanted) & mask[reg - 1u]) | extra) == 0;
}

/* Writes up to six registers from d->data, reads them back and compares (X0-SEQ-16). d->data holds what was
 * read. */
bq_status x0_job_set(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    memcpy(d->data + X0_WANTED, d->data, f->n);
    for (;;) {
        SEQ_TRY(d, f, X0_JOB_WRITE, f->reg, f->n);
        SEQ_TRY(d, f, X0_JOB_READ, f->reg, f->n);
        f->x = 0;
        for (unsigned i = 0; i < f->n; i++) {
            f->x |= (uint8_t)!x0_same(f->reg + i, d->data[i], d->data[X0_WANTED + i]);
        }
        if (f->x == 0u) {
            return BQ_OK;
        }
        x0_bump(&d->stats.write_errors);
        if (++f->tries >= X0_TRIES) {
            return BQ_E_VERIFY;
        }
        memcpy(d->data, d->data + X0_WANTED, f->n);
    }
    SEQ_END;
}
