/* SPDX-License-Identifier: Apache-2.0 */
/*
 * An empty driver. The order of the parts is that of the work: configuration, the engine that advances one
 * job, the jobs, the picture, the table.
 */
#include "monitor_template.h"
#include "bqhost/seq.h"
#include <string.h>

enum { JOB_NONE, JOB_START, JOB_SCAN, JOB_APPLY, JOB_SELF_TEST, JOB_SLEEP, JOB_WAKE };

/* ---- configuration ------------------------------------------------------------------------------- */

bq_status monitor_template_init(monitor_template *t, const monitor_template_config *config, const bq_i2c *i2c,
                                const bq_gpio *gpio, const bq_clock *clock)
{
    if (t == NULL || config == NULL || i2c == NULL || i2c->ops == NULL || clock == NULL ||
        clock->now_us == NULL) {
        return BQ_E_ARG;
    }
    if (config->cells < 1u || config->cells > MONITOR_TEMPLATE_CELLS) {
        return BQ_E_CELLS;
    }
    /* FILL IN: every limit to its code, by pure functions that refuse what no code expresses (BQ_E_NO_CODE);
     * contradictions (BQ_E_CONFIG). Nothing of `t` is touched before all of it is right. */
    memset(t, 0, sizeof *t);
    t->config = *config;
    t->i2c = *i2c;
    t->clock = *clock;
    if (gpio != NULL) {
        t->gpio = *gpio;
    }
    return BQ_OK;
}

/* ---- the engine ---------------------------------------------------------------------------------- */

static bq_status begin(monitor_template *t, uint8_t job)
{
    if (t->job != JOB_NONE) {
        return BQ_E_BUSY;
    }
    memset(&t->frame, 0, sizeof t->frame);
    t->job = job;
    t->waiting = false;
    t->last = BQ_PENDING;
    return BQ_OK;
}

/* Everything but start needs a monitor that is up; wake needs one that is asleep. */
static bq_status begin_started(monitor_template *t, uint8_t job)
{
    if (t->job != JOB_NONE) {
        return BQ_E_BUSY;
    }
    return t->started ? begin(t, job) : BQ_E_STATE;
}

/* The one place that waits. FILL IN: its twin that starts a transfer, with a bound of its own on top of the
 * back-end's, counted in t->stats (see drivers/bq769x0/transfer.c). */
static bq_status wait(monitor_template *t, uint32_t us)
{
    t->waiting = true;
    t->wait_from_us = t->clock.now_us(t->clock.ctx);
    t->wait_us = us;
    return BQ_PENDING;
}

/* ---- the jobs ------------------------------------------------------------------------------------ */

/* Bring-up, from top to bottom like the procedure of the datasheet. */
static bq_status job_start(monitor_template *t, monitor_template_frame *f)
{
    SEQ_BEGIN(f)
    t->started = false;
    t->measured = false;
    SEQ_YIELD(f, wait(t, 1000u)); /* FILL IN: power-up or boot, and the time it takes */
    /* FILL IN: find the part; outputs and balancing off, verified; calibration read twice; limits written and
     * read back; flags from before read and cleared one by one; the first measurement waited for. Then
     * t->started = true and BQ_OK. */
    return BQ_E_UNSUPPORTED;
    SEQ_END;
}

static bq_status run(monitor_template *t)
{
    switch (t->job) {
    case JOB_START:
        return job_start(t, &t->frame);
    /* FILL IN: JOB_SCAN: status, all measurements, the status cleared last and only what was read as set; a
     * reading that is damaged or impossible is repeated with a bound and then becomes quality bits, never a
     * value. JOB_APPLY: outputs and balancing, verified. JOB_SELF_TEST, JOB_SLEEP, JOB_WAKE. */
    default:
        return BQ_E_UNSUPPORTED;
    }
}

static bq_status tpl_poll(void *ctx, uint32_t *wait_us)
{
    monitor_template *t = ctx;
    uint32_t passed = t->waiting ? t->clock.now_us(t->clock.ctx) - t->wait_from_us : 0u;
    bq_status st;
    if (wait_us != NULL) {
        *wait_us = 0;
    }
    if (t->job == JOB_NONE) {
        return t->last;
    }
    if (t->waiting && passed < t->wait_us) {
        if (wait_us != NULL) {
            *wait_us = t->wait_us - passed;
        }
        return BQ_PENDING;
    }
    t->waiting = false;
    st = run(t);
    if (st != BQ_PENDING) {
        t->job = JOB_NONE;
        t->last = st;
    }
    return st;
}

static bq_status tpl_start(void *ctx)
{
    return begin(ctx, JOB_START);
}

static bq_status tpl_scan(void *ctx)
{
    return begin_started(ctx, JOB_SCAN);
}

static bq_status tpl_apply(void *ctx, const bq_action *action)
{
    /* FILL IN: copy what of `action` this family can do; the caller's may be gone before the job ends */
    return action == NULL ? BQ_E_ARG : begin_started(ctx, JOB_APPLY);
}

static bq_status tpl_self_test(void *ctx)
{
    return begin_started(ctx, JOB_SELF_TEST);
}

static bq_status tpl_sleep(void *ctx)
{
    return begin_started(ctx, JOB_SLEEP);
}

static bq_status tpl_wake(void *ctx)
{
    /* FILL IN: legal only after a sleep. A family that forgets everything in sleep puts start here. */
    const monitor_template *t = ctx;
    return t->job != JOB_NONE ? BQ_E_BUSY : BQ_E_STATE;
}

/* ---- the picture --------------------------------------------------------------------------------- */

static bq_status tpl_sample(void *ctx, bq_sample *s)
{
    const monitor_template *t = ctx;
    if (s == NULL || s->cell_capacity < t->config.cells || s->module_capacity < 1u) {
        return BQ_E_ARG;
    }
    if (!t->measured) {
        return BQ_E_STALE;
    }
    /* FILL IN: whole or not at all: counts, cells from the lowest potential up, temperatures, the module with
     * its age and flags, sequence and time of the conversion. A value that may not be used has no BQ_Q_VALID.
     */
    return BQ_E_STALE;
}

static uint8_t tpl_modules_found(void *ctx)
{
    const monitor_template *t = ctx;
    return t->started ? 1u : 0u;
}

static const bq_link_stats *tpl_stats(void *ctx)
{
    const monitor_template *t = ctx;
    return &t->stats;
}

/* ---- the table ----------------------------------------------------------------------------------- */

bq_afe monitor_template_afe(monitor_template *t)
{
    static const bq_afe_ops ops = {tpl_start,     tpl_scan,  tpl_poll, tpl_sample,        tpl_apply,
                                   tpl_self_test, tpl_sleep, tpl_wake, tpl_modules_found, tpl_stats};
    bq_afe afe = {&ops, t};
    return afe;
}
