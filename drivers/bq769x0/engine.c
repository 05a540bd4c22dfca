/* SPDX-License-Identifier: Apache-2.0 */
/* The sequencer: time, the stack of jobs, and poll. */
#include "x0_internal.h"
#include <string.h>

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

void x0_wait(bq769x0 *d, uint32_t us)
{
    x0_tick(d);
    d->due_us = d->now_us + us + 1u;
}

bq769x0_frame *x0_push(bq769x0 *d, bq769x0_job job, unsigned reg, unsigned n)
{
    bq769x0_frame *f = ++d->top;
    memset(f, 0, sizeof *f);
    f->job = job;
    f->reg = (uint8_t)reg;
    f->n = (uint8_t)n;
    return f;
}

void x0_run(bq769x0 *d, bq769x0_job job)
{
    (void)x0_push(d, job, 0, 0);
}

bq_status x0_begin(bq769x0 *d, unsigned least_state, bq769x0_job job)
{
    if (d->top->job != NULL) {
        return BQ_E_BUSY;
    }
    if (d->state < least_state) {
        return BQ_E_STATE;
    }
    x0_tick(d);
    d->due_us = d->now_us;
    x0_run(d, job);
    return BQ_OK;
}

/* One step of the job on top. A failure ends its parents too, up to one that looks at results itself; below
 * the first job lies a frame without one that does. */
static void step(bq769x0 *d)
{
    bq769x0_frame *f = d->top;
    int next = f->job(d, f);
    if (next > 0) {
        f->at = (uint8_t)(next & ~X0_CATCHES);
        f->catches = (next & X0_CATCHES) != 0;
        return;
    }
    d->result = (bq_status)next;
    do {
        f--;
    } while (next != BQ_OK && !f->catches);
    d->top = f;
}

#define PATIENCE_US 200000 /* with a transfer that does not end */
#define AGAIN_US 50        /* between two looks at one that should have ended */

/* Whether the transfer under way goes on. */
static bool on_the_bus(bq769x0 *d)
{
    d->transfer = d->i2c.ops->poll(d->i2c.ctx);
    if (d->transfer == BQ_PENDING) {
        if ((int32_t)(d->now_us - d->due_us) < PATIENCE_US) {
            return true;
        }
        d->transfer = BQ_E_TIMEOUT;
    }
    d->due_us = d->now_us;
    return false;
}

/* Steps until a transfer goes out, a time must pass, or all is done; tells how long to wait. */
static uint32_t go_on(bq769x0 *d)
{
    while (d->top->job != NULL) {
        int32_t left = (int32_t)(d->due_us - d->now_us);
        if (d->busy && left < AGAIN_US) {
            left = AGAIN_US;
        }
        if (left > 0) {
            return (uint32_t)left;
        }
        step(d);
    }
    return 0;
}

bq_status bq769x0_poll(bq769x0 *d, uint32_t *wait_us)
{
    uint32_t left;
    if (d == NULL) {
        return BQ_E_ARG;
    }
    x0_tick(d);
    d->busy = d->busy && on_the_bus(d);
    left = go_on(d);
    if (wait_us != NULL) {
        *wait_us = left;
    }
    return d->top->job != NULL ? BQ_PENDING : d->result;
}
