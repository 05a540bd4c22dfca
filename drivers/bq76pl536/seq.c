/* SPDX-License-Identifier: Apache-2.0 */
/* The sequencer: time, packets, the stack of jobs, and poll. */
#include "pl536_internal.h"
#include <string.h>

/* Longer than any chain of steps without a packet or a wait in between; keeps one poll bounded. */
#define STEPS_PER_POLL 160u

/* ---- time and lines ---------------------------------------------------------------------------- */

void pl_tick(bq76pl536 *d)
{
    uint32_t now = d->clock.now_us(d->clock.ctx);
    uint32_t passed = now - d->now_us;
    d->now_us = now;
    if (passed >= 1000u - d->rest_us) {
        d->now_ms += passed / 1000u;
        d->rest_us += passed % 1000u;
        if (d->rest_us >= 1000u) {
            d->rest_us -= 1000u;
            d->now_ms++;
        }
    } else {
        d->rest_us += passed;
    }
}

bq_status pl_wait(bq76pl536 *d, uint32_t us)
{
    d->io = PL_IO_WAIT;
    d->wait_from_us = d->clock.now_us(d->clock.ctx);
    d->wait_us = us + 1u; /* the reading may be just about to change */
    return BQ_PENDING;
}

bool pl_line(const bq76pl536 *d, bq_line line, bool *level)
{
    return d->gpio.ops != NULL && d->gpio.ops->read(d->gpio.ctx, line, level) == BQ_OK;
}

void pl_drive(const bq76pl536 *d, bq_line line, bool level)
{
    if (d->gpio.ops != NULL) {
        (void)d->gpio.ops->write(d->gpio.ctx, line,
                                 level); /* a line the board does not have needs no driving */
    }
}

/* ---- packets ------------------------------------------------------------------------------------- */

static void bump(uint32_t *counter)
{
    if (*counter != UINT32_MAX) {
        (*counter)++;
    }
}

bq_status pl_send_raw(bq76pl536 *d, size_t length)
{
    d->sent = true;
    d->length = (uint8_t)length;
    d->stats.bytes += (uint32_t)length;
    bump(&d->stats.packets);
    d->transfer = d->spi.ops->start(d->spi.ctx, d->tx, d->rx, length);
    d->wait_from_us = d->now_us;
    if (d->transfer == BQ_OK) {
        d->io = PL_IO_TRANSFER;
    } else {
        bump(&d->stats.bus_errors);
    }
    return BQ_PENDING;
}

bq_status pl_send_read(bq76pl536 *d, unsigned dev, unsigned reg, unsigned count)
{
    size_t length = 0;
    d->data = BQ76PL536_READ_HEADER;
    if (d->crc && (reg != BQ76PL536_BURST_FIRST || count != BQ76PL536_BURST_COUNT) &&
        bq76pl536_packet_ambiguous((uint8_t)dev, (uint8_t)reg, (uint8_t)count)) {
        if (reg + count <=
            BQ76PL536_REG_LAST) { /* one register more: a dead bus cannot pass then (PL-CRC-12) */
            count++;
        } else {
            reg--;
            count++;
            d->data++;
        }
    }
    d->transfer = bq76pl536_packet_read(d->tx, sizeof d->tx, (uint8_t)dev, (uint8_t)reg, (uint8_t)count,
                                        d->crc, &length);
    return d->transfer == BQ_OK ? pl_send_raw(d, length) : BQ_PENDING;
}

bq_status pl_send_write(bq76pl536 *d, unsigned dev, unsigned reg, unsigned val)
{
    size_t length = 0;
    d->transfer = bq76pl536_packet_write(d->tx, sizeof d->tx, (uint8_t)dev, (uint8_t)reg, (uint8_t)val,
                                         d->crc, &length);
    return d->transfer == BQ_OK ? pl_send_raw(d, length) : BQ_PENDING;
}

bq_status pl_answer(const bq76pl536 *d)
{
    return d->transfer != BQ_OK ? d->transfer : bq76pl536_packet_check(d->tx, d->rx, d->length, d->crc);
}

bq_status pl_reply(bq76pl536 *d)
{
    const bq_status st = pl_answer(d);
    if (st == BQ_E_NO_ANSWER) {
        bump(&d->stats.no_answers);
    } else if (st == BQ_E_CRC) {
        bump(&d->stats.crc_errors);
    }
    return st;
}

/* A back-end bounds its own transfers; this is the bound for one that does not. */
static uint32_t transfer_us(const bq76pl536 *d)
{
    return (uint32_t)(d->length * 8000ul / (d->spi_hz / 1000ul)) + 3u;
}

static bool transfer_running(bq76pl536 *d)
{
    bq_status st = d->spi.ops->poll(d->spi.ctx);
    if (st == BQ_PENDING) {
        if (d->now_us - d->wait_from_us <= 2u * transfer_us(d) + 5000u) {
            return true;
        }
        st = BQ_E_TIMEOUT;
    }
    if (st != BQ_OK) {
        bump(&d->stats.bus_errors);
    }
    d->transfer = st;
    d->io = PL_IO_NONE;
    return false;
}

/* ---- jobs ---------------------------------------------------------------------------------------- */

bq_status pl_push(bq76pl536 *d, uint8_t job, unsigned dev, unsigned reg, unsigned val)
{
    if (d->depth >= BQ76PL536_FRAMES) {
        d->result = BQ_E_STATE; /* cannot happen: the deepest chain of jobs is shorter */
        return BQ_PENDING;
    }
    bq76pl536_frame *f = &d->frames[d->depth++];
    memset(f, 0, sizeof *f);
    f->job = job;
    f->dev = (uint8_t)dev;
    f->reg = (uint8_t)reg;
    f->val = (uint8_t)val;
    return BQ_PENDING;
}

bq_status pl_begin(bq76pl536 *d, uint8_t job, unsigned dev)
{
    (void)pl_push(d, job, dev, 0, 0);
    d->io = PL_IO_NONE;
    d->last = BQ_PENDING;
    return BQ_OK;
}

static bq_status dispatch(bq76pl536 *d, bq76pl536_frame *f)
{
    switch (f->job) {
#define JOB(NAME, name)                                                                                      \
    case PL_JOB_##NAME:                                                                                      \
        return pl_job_##name(d, f);
        PL_JOBS(JOB)
#undef JOB
    default:
        return BQ_E_STATE;
    }
}

static void pl_step(bq76pl536 *d)
{
    bq_status st = dispatch(d, &d->frames[d->depth - 1u]);
    if (st == BQ_PENDING) {
        return;
    }
    d->depth--;
    d->result = st;
    if (d->depth == 0u) {
        d->last = st;
    }
}

static bool waiting(bq76pl536 *d, uint32_t *left_us)
{
    uint32_t passed = d->now_us - d->wait_from_us;
    if (passed >= d->wait_us) {
        d->io = PL_IO_NONE;
        return false;
    }
    *left_us = d->wait_us - passed;
    return true;
}

bq_status bq76pl536_poll(bq76pl536 *d, uint32_t *wait_us)
{
    uint32_t left = 0;
    if (d == NULL) {
        return BQ_E_ARG;
    }
    pl_tick(d);
    bool blocked = false;
    d->sent = false;
    if (d->io == PL_IO_TRANSFER) {
        blocked = transfer_running(d);
    } else if (d->io == PL_IO_WAIT) {
        blocked = waiting(d, &left);
    }
    for (unsigned i = 0; !blocked && i < STEPS_PER_POLL && d->depth != 0u && d->io == PL_IO_NONE; i++) {
        pl_step(d);
        blocked = d->sent; /* at most one packet, even one the back-end refused */
    }
    if (d->io == PL_IO_TRANSFER) {
        /* a polled back-end has completed it inside start, and the clock has moved on */
        uint32_t passed = d->clock.now_us(d->clock.ctx) - d->wait_from_us;
        left = transfer_us(d) > passed ? transfer_us(d) - passed : 0u;
    } else if (d->io == PL_IO_WAIT && left == 0u) {
        left = d->wait_us; /* began just now */
    }
    if (wait_us != NULL) {
        *wait_us = d->depth != 0u ? left : 0u;
    }
    return d->depth != 0u ? BQ_PENDING : d->last;
}

bq_status bq76pl536_wait(bq76pl536 *d, uint32_t timeout_us)
{
    if (d == NULL) {
        return BQ_E_ARG;
    }
    uint32_t from = d->clock.now_us(d->clock.ctx);
    bq_status st = bq76pl536_poll(d, NULL);
    while (st == BQ_PENDING) {
        if (d->clock.now_us(d->clock.ctx) - from >= timeout_us) {
            return BQ_E_TIMEOUT;
        }
        st = bq76pl536_poll(d, NULL);
    }
    return st;
}
