/* SPDX-License-Identifier: Apache-2.0 */
/* Transactions of the bq769x0 with and without CRC, and the jobs that repeat them (X0-I2C, X0-SEQ-48..52). */
#include "bqhost/crc8.h"
#include "x0_internal.h"

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

/* What to do between two tries: 1 ms after silence, recovery of a stuck bus (X0-SEQ-51, X0-SEQ-52). */
static bq_status between_tries(bq769x0 *d, bq_status st)
{
    x0_bump(&d->stats.retries);
    if ((st == BQ_E_ARBITRATION || st == BQ_E_TIMEOUT || st == BQ_E_BUS) && d->i2c.ops->recover != NULL) {
        (void)d->i2c.ops->recover(d->i2c.ctx);
    }
    return x0_wait(d, 1000u);
}

bq_status x0_job_read(bq769x0 *d, bq769x0_frame *f)
{
    bq_status st;
    SEQ_BEGIN(f)
    for (;;) {
        SEQ_SEND(f, x0_send_read(d, f->reg, f->n));
        st = x0_reply(d);
        if (st == BQ_OK || ++f->tries >= X0_TRIES) {
            return st;
        }
        SEQ_SEND(f, between_tries(d, st));
    }
    SEQ_END;
}

bq_status x0_job_write(bq769x0 *d, bq769x0_frame *f)
{
    bq_status st;
    SEQ_BEGIN(f)
    for (;;) {
        SEQ_SEND(f, x0_send_write(d, f->reg, f->n));
        st = x0_reply(d);
        if (st == BQ_OK || ++f->tries >= X0_TRIES) {
            return st;
        }
        x0_bump(&d->stats.write_errors);
        SEQ_SEND(f, between_tries(d, st));
    }
    SEQ_END;
}

/* Bits of a register that read back as written. */
static uint8_t compared(unsigned reg)
{
    static const uint8_t mask[] = {0x1f, 0x1f, 0x1f, 0x1f, 0xc3, 0x9f, 0x7f, 0xf0, 0xff, 0xff, 0x3f};
    return mask[reg - 1u];
}

/* Writes up to six registers from d->data, reads them back and compares (X0-SEQ-16). d->bus keeps what was
 * wanted. */
bq_status x0_job_set(bq769x0 *d, bq769x0_frame *f)
{
    SEQ_BEGIN(f)
    for (;;) {
        for (unsigned i = 0; i < f->n; i++) {
            d->data[34u + i] = d->data[i]; /* beyond what a read-back of six overwrites */
        }
        SEQ_TRY(d, f, X0_JOB_WRITE, f->reg, f->n);
        SEQ_TRY(d, f, X0_JOB_READ, f->reg, f->n);
        f->x = 0;
        for (unsigned i = 0; i < f->n; i++) {
            f->x |= (uint8_t)((d->data[i] ^ d->data[34u + i]) & compared(f->reg + i));
            d->data[i] = d->data[34u + i];
        }
        if (f->x == 0u) {
            return BQ_OK;
        }
        x0_bump(&d->stats.write_errors);
        if (++f->tries >= X0_TRIES) {
            return BQ_E_VERIFY;
        }
    }
    SEQ_END;
}
