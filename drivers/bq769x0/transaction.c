/* SPDX-License-Identifier: Apache-2.0 */
/* One transaction with or without CRC: what travels, and what came of it (X0-I2C). */
#include "bqhost/crc8.h"
#include "x0_internal.h"

#define BYTE_US 90u /* eight bits and the acknowledgement at 100 kHz */

/* Walks over the bytes in d->bus and leaves there what is to travel, or the data without CRC. With CRC each
 * data byte is followed by its own; the first also covers the address, and in a write the register
 * (X0-I2C-12..15). False: a CRC is wrong. */
static bool walk(bq769x0 *d, const bq769x0_frame *f)
{
    bool reading = f->n >= X0_READING;
    uint8_t *to = d->bus + 2;
    const uint8_t *from = reading ? to : &d->want[f->reg];
    uint8_t crc = bq_crc8(0, d->bus, reading ? 1u : 2u);
    for (unsigned n = f->n & ~X0_READING; n != 0u; n--) {
        *to = *from++;
        crc = bq_crc8(crc, to++, 1);
        if (d->crc) {
            if (!reading) {
                *to++ = crc;
            } else if (*from++ != crc) {
                return false;
            }
        }
        crc = 0;
    }
    return true;
}

void x0_send(bq769x0 *d, const bq769x0_frame *f)
{
    unsigned reading = f->n >> 7, length = (f->n & ~X0_READING) << d->crc, bytes = length + 2u + reading;
    uint8_t *bus = d->bus;
    bus[0] = (uint8_t)(d->address7 * 2u + reading);
    bus[1] = f->reg;
    if (reading == 0u) {
        (void)walk(d, f);
    }
    d->stats.bytes += bytes;
    d->segments[1].len = (uint16_t)length;
    d->segments[1].data = bus + 2;
    d->segments[1].read = true;
    d->segments[0].len = (uint16_t)(reading != 0u ? 1u : length + 1u); /* the last one ends with STOP */
    d->segments[0].data = bus + 1;
    x0_bump(&d->stats.packets);
    d->due_us = d->now_us + bytes * BYTE_US;
    d->transfer = d->i2c.ops->start(d->i2c.ctx, d->address7, d->segments, reading + 1u);
    d->busy = d->transfer == BQ_OK;
    if (!d->busy) {
        d->due_us = d->now_us;
    }
}

/* Judges the transaction that ended last. */
bq_status x0_judge(bq769x0 *d, const bq769x0_frame *f)
{
    uint32_t *counter = &d->stats.bus_errors;
    if (d->transfer == BQ_OK) {
        if (f->n < X0_READING) {
            return BQ_OK;
        }
        if (walk(d, f)) {
            d->answer = d->bus[2];
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
