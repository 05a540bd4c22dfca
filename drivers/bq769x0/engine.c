/* SPDX-License-Identifier: Apache-2.0 */
/* The sequencer: time, the stack of jobs, and poll. */
#include "x0_internal.h"
#include <string.h>

#define STEPS_PER_POLL 64u /* longer than any chain of steps without a transfer or a wait */

void x0_bump(uint32_t *counter)
{
    if (*counter != UINT32_MAX) {
        (*counter)++;
    }
}

void x0_tick(bq769x0 *d)
{
    uint32_t now = d->clock.now_us(d->clock.ctx);
    uint32_t passed = now - d->now_us + d->rest_us;
    d->now_us = now;
    d->now_ms += passed / 1000u;
    d->rest_us = passed % 1000u;
}

bq_status x0_wait(bq769x0 *d, uint32_t us)
{
    d->io = X0_IO_WAIT;
    d->wait_from_us = d->clock.now_us(d->clock.ctx);
    d->wait_us = us + 1u;
    return BQ_PENDING;
}

bq_status x0_push(bq769x0 *d, uint8_t job, unsigned reg, unsigned n)
{
    bq769x0_frame *f = &d->frames[d->depth];
    if (d->depth >= BQ769X0_FRAMES) {
        d->result = BQ_E_STATE; /* cannot happen: the deepest chain of jobs is shorter */
        return BQ_PENDING;
    }
    d->depth++;
    memset(f, 0, sizeof *f);
    f->job = job;
    f->reg = (uint8_t)reg;
    f->n = (uint8_t)n;
    return BQ_PENDING;
}

bq_status x0_begin(bq769x0 *d, uint8_t job)
{
    if (d->depth != 0u) {
        return BQ_E_BUSY;
    }
    (void)x0_push(d, job, 0, 0);
    d->io = X0_IO_NONE;
    d->last = BQ_PENDING;
    return BQ_OK;
}

static bq_status dispatch(bq769x0 *d, bq769x0_frame *f)
{
    switch (f->job) {
#define JOB(NAME, name)                                                                                      \
    case X0_JOB_##NAME:                                                                                      \
        return x0_job_##name(d, f);
        X0_JOBS(JOB)
#undef JOB
    default:
        return BQ_E_STATE;
    }
}

static void step(bq769x0 *d)
{
    bq_status st = dispatch(d, &d->frames[d->depth - 1u]);
    if (st != BQ_PENDING) {
        d->depth--;
        d->result = st;
        if (d->depth == 0u) {
            d->last = st;
        }
    }
}

/* True while a transfer or a wait is under way. */
static bool held_up(bq769x0 *d, uint32_t *left_us)
{
    uint32_t passed = d->now_us - d->wait_from_us;
    if (d->io == X0_IO_TRANSFER) {
        bq_status st = d->i2c.ops->poll(d->i2c.ctx);
        if (st == BQ_PENDING && passed < 200000u) {
            return true;
        }
        d->transfer = st == BQ_PENDING ? BQ_E_TIMEOUT : st;
    } else if (d->io == X0_IO_WAIT && passed < d->wait_us) {
        *left_us = d->wait_us - passed;
        return true;
    }
    d->io = X0_IO_NONE;
    return false;
}

bq_status bq769x0_poll(bq769x0 *d, uint32_t *wait_us)
{
    uint32_t left = 0;
    if (d == NULL) {
        return BQ_E_ARG;
    }
    x0_tick(d);
    d->sent = false;
    for (unsigned n = 0; n < STEPS_PER_POLL && d->depth != 0u && !d->sent; n++) {
        if (held_up(d, &left)) {
            break;
        }
        step(d);
    }
    if (wait_us != NULL) {
        *wait_us = left;
    }
    return d->depth != 0u ? BQ_PENDING : d->last;
}
