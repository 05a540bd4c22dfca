/* SPDX-License-Identifier: Apache-2.0 */
/* The bq_afe interface over one instance. */
#include "x0_internal.h"

static bq_status x0_afe_start(void *ctx)
{
    return x0_begin(ctx, X0_STATE_NONE, x0_job_start);
}

static bq_status x0_afe_scan(void *ctx)
{
    return x0_begin(ctx, X0_STATE_READY, x0_job_scan);
}

static bq_status x0_afe_poll(void *ctx, uint32_t *wait_us)
{
    return bq769x0_poll(ctx, wait_us);
}

static bq_status x0_afe_sample(void *ctx, bq_sample *s)
{
    return bq769x0_sample(ctx, s);
}

static bq_status x0_afe_apply(void *ctx, const bq_action *action)
{
    return bq769x0_begin_apply(ctx, action);
}

static bq_status x0_afe_self_test(void *ctx)
{
    return x0_begin(ctx, X0_STATE_READY, x0_job_compare);
}

static bq_status x0_afe_ship(void *ctx)
{
    return x0_begin(ctx, X0_STATE_READY, x0_job_ship);
}

static uint8_t x0_afe_modules_found(void *ctx)
{
    const bq769x0 *d = ctx;
    return d->state == X0_STATE_READY ? 1u : 0u;
}

static const bq_link_stats *x0_afe_stats(void *ctx)
{
    const bq769x0 *d = ctx;
    return &d->stats;
}

bq_afe bq769x0_afe(bq769x0 *d)
{
    static const bq_afe_ops ops = {x0_afe_start,         x0_afe_scan,      x0_afe_poll, x0_afe_sample,
                                   x0_afe_apply,         x0_afe_self_test, x0_afe_ship, x0_afe_start,
                                   x0_afe_modules_found, x0_afe_stats};
    bq_afe afe = {&ops, d};
    return afe;
}
