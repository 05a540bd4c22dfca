/* SPDX-License-Identifier: Apache-2.0 */
/* The sequencer: time, the stack of jobs, and poll. */
#include "x0_internal.h"

void x0_bump(uint32_t *counter)
{
    if (*counter != UINT32_MAX) {
        (*counter)++;
    }
}

void x0_tick(bq769x0 *d)
{
    uint32_t now = d->clock.now_us(d->clock.ctx);
    uint32_t ms = (now - d->whole_us) / 1000u;
    d->now_us = now;
    d->now_ms += ms;
    d->whole_us += ms * 1000u;
}

void x0_pause(bq769x0 *d, uint32_t us)
{
    x0_tick(d);
    d->due_us = d->now_us + us + 1u;
}

int x0_push(bq769x0 *d, bq769x0_job job, int op)
{
    bq769x0_frame *f = ++d->top;
    bq769x0_frame fresh = {job, 0, op, 0, 0, 0, 0, 0};
    *f = fresh;
    return op;
}

bq_status x0_begin(bq769x0 *d, unsigned least_state, bq769x0_job job)
{
    if (d->top->job != NULL) {
        return BQ_E_BUSY;
    }
    if (d->state < least_state) {
        return BQ_E_STATE;
    }
    x0_pause(d, (uint32_t)-1);
    (void)x0_push(d, job, 0);
    return BQ_OK;
}

/* One step of the job on top. A failure ends its parents too, up to one that looks at results itself; below
 * the first job lies a frame without one that does. */
static void step(bq769x0 *d)
{
    bq769x0_frame *f = d->top;
    int next = f->job(d, f);
    if (next > 0) {
        f->next = next;
        f->at = (uint8_t)next;
        if (next >> 24 != 0) {
            (void)x0_push(d, x0_job_transfer, next);
        }
        return;
    }
    d->result = next;
    do {
        f--;
        if (next == BQ_OK) {
            break;
        }
    } while ((f->next & X0_CATCH) == 0);
    d->top = f;
}

#define PATIENCE_US 200000 /* with a transfer that does not end */
#define AGAIN_US 50        /* between two looks at one that should have ended */

bq_status bq769x0_poll(bq769x0 *d, uint32_t *wait_us)
{
    int32_t left;
    if (d == NULL) {
        return BQ_E_ARG;
    }
    x0_tick(d);
    if (d->transfer == BQ_PENDING) {
        d->transfer = d->i2c.ops->poll(d->i2c.ctx);
        left = (int32_t)(d->due_us - d->now_us);
        if (d->transfer == BQ_PENDING) {
            if (left > -PATIENCE_US) {
                left = left < AGAIN_US ? AGAIN_US : left;
                goto out;
            }
            d->transfer = BQ_E_TIMEOUT;
        }
        d->due_us = d->now_us;
    }
    for (;;) {
        if (d->top->job == NULL) {
            left = 0;
            break;
        }
        left = (int32_t)(d->due_us - d->now_us);
        if (left > 0) {
            break;
        }
        step(d);
    }
out:
    if (wait_us != NULL) {
        *wait_us = (uint32_t)left;
    }
    return left != 0 ? BQ_PENDING : (bq_status)d->result;
}
