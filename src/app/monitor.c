/* SPDX-License-Identifier: Apache-2.0 */
/* The monitor's jobs: which one comes next, and what follows from its end. */
#include "app_internal.h"

static void begin_pause(bq_app *app)
{
    app->pausing = true;
    app->retry_ms = app->now_ms;
}

bool bq_app_paused(const bq_app *app, uint32_t *left_us)
{
    const uint32_t passed = app->now_ms - app->retry_ms;

    if (!app->pausing || passed >= app->config.retry_ms) {
        return false;
    }
    *left_us = (app->config.retry_ms - passed) * 1000u;
    return true;
}

/* The monitor has to be brought up (again): nothing that was known about it holds. */
static void lose_monitor(bq_app *app, bq_pack_monitor state, bq_status status)
{
    app->input.monitor = state;
    app->input.monitor_status = status;
    app->input.self_test = BQ_TEST_NONE;
    app->input.apply_status = BQ_OK;
    app->scanned = false;
    app->apply_due = false;
    app->asleep = false;
    begin_pause(app);
}

static void monitor_up(bq_app *app)
{
    app->input.monitor = BQ_MONITOR_UP;
    app->input.monitor_status = BQ_OK;
    app->asleep = false;
    app->pausing = false;
    app->scan_ms = app->now_ms;
    app->tick_us = app->last_us; /* a new period begins here, with a scan */
    app->scan_due = true;
}

static void bring_up_ended(bq_app *app, bq_status status)
{
    if (status == BQ_OK) {
        monitor_up(app);
        return;
    }
    bq_app_count(&app->counters.bring_up_failures);
    lose_monitor(app, BQ_MONITOR_FAILED, status);
}

static void scan_ended(bq_app *app, bq_status status)
{
    app->scan_ended = true;
    if (status == BQ_OK) {
        app->scan_ms = app->now_ms;
        app->scanned = true;
        return;
    }
    bq_app_count(&app->counters.scan_failures);
    if (status == BQ_E_STATE || app->now_ms - app->scan_ms > app->config.pack.comm_timeout_ms) {
        lose_monitor(app, BQ_MONITOR_DOWN, status);
    }
}

/* Closing waits for the monitor to have carried out the action, and for a step that is due, which may want
 * another one; opening was done before. */
static void apply_ended(bq_app *app, bq_status status)
{
    app->input.apply_status = status;
    if (status != BQ_OK) {
        bq_app_count(&app->counters.apply_failures);
        return;
    }
    if (app->action.charge_on && app->action.discharge_on && !app->apply_due && !bq_app_step_due(app)) {
        (void)bq_app_write_contactor(app, true);
    }
}

static void self_test_ended(bq_app *app, bq_status status)
{
    app->input.self_test = status == BQ_OK ? BQ_TEST_PASSED : BQ_TEST_FAILED;
    app->input.self_test_status = status;
    app->pausing = false;
    if (status != BQ_OK) {
        bq_app_count(&app->counters.self_test_failures);
        begin_pause(app);
    } else {
        app->step_now = true; /* the way to the outputs goes on without waiting for the next scan */
    }
}

static void sleep_ended(bq_app *app, bq_status status)
{
    lose_monitor(app, BQ_MONITOR_DOWN, status);
    if (status == BQ_OK) {
        app->asleep = true;
        app->pausing = false;
    }
}

static void job_ended(bq_app *app, bq_status status)
{
    const bq_app_job job = app->job;

    app->job = BQ_JOB_NONE;
    app->wait_us = 0;
    switch (job) {
    case BQ_JOB_START:
    case BQ_JOB_WAKE: /* a failed wake is followed by a bring-up */
        bring_up_ended(app, status);
        break;
    case BQ_JOB_SELF_TEST:
        self_test_ended(app, status);
        break;
    case BQ_JOB_SCAN:
        scan_ended(app, status);
        break;
    case BQ_JOB_APPLY:
        apply_ended(app, status);
        break;
    case BQ_JOB_SLEEP:
        sleep_ended(app, status);
        break;
    default:
        break;
    }
}

void bq_app_poll_job(bq_app *app)
{
    bq_status status;

    if (app->job == BQ_JOB_NONE) {
        return;
    }
    app->wait_us = 0;
    status = app->afe.ops->poll(app->afe.ctx, &app->wait_us);
    if (status != BQ_PENDING) {
        job_ended(app, status);
        return;
    }
    if (app->job == BQ_JOB_START && app->input.monitor != BQ_MONITOR_FAILED &&
        app->now_ms - app->job_ms >= BQ_APP_BRING_UP_MS) {
        app->input.monitor = BQ_MONITOR_FAILED; /* still polled: it may yet succeed */
        app->input.monitor_status = BQ_E_TIMEOUT;
    }
}

static bq_app_job next_job(const bq_app *app)
{
    uint32_t left_us;
    const bool paused = bq_app_paused(app, &left_us);

    if (app->asleep) {
        return app->action.sleep || paused ? BQ_JOB_NONE : BQ_JOB_WAKE;
    }
    if (app->input.monitor != BQ_MONITOR_UP) {
        return paused ? BQ_JOB_NONE : BQ_JOB_START;
    }
    if (app->action.sleep) {
        return BQ_JOB_SLEEP;
    }
    if (app->apply_due) {
        return BQ_JOB_APPLY;
    }
    /* before the next scan: scans that last a whole period would leave no room for it */
    if (app->scanned && app->input.self_test != BQ_TEST_PASSED && !paused) {
        return BQ_JOB_SELF_TEST;
    }
    return app->scan_due ? BQ_JOB_SCAN : BQ_JOB_NONE;
}

static bq_status begin(bq_app *app, bq_app_job job)
{
    const bq_afe_ops *ops = app->afe.ops;

    switch (job) {
    case BQ_JOB_START:
        bq_app_count(&app->counters.bring_ups);
        return ops->start(app->afe.ctx);
    case BQ_JOB_WAKE:
        return ops->wake(app->afe.ctx);
    case BQ_JOB_SLEEP:
        return ops->sleep(app->afe.ctx);
    case BQ_JOB_APPLY:
        app->apply_due = false;
        app->applied = app->action; /* the next step may come before the monitor is done with it */
        return ops->apply(app->afe.ctx, &app->applied);
    case BQ_JOB_SCAN:
        app->scan_due = false;
        return ops->scan(app->afe.ctx);
    default:
        return ops->self_test(app->afe.ctx);
    }
}

bool bq_app_begin_job(bq_app *app)
{
    const bq_app_job job = app->job == BQ_JOB_NONE ? next_job(app) : BQ_JOB_NONE;
    bq_status status;

    if (job == BQ_JOB_NONE) {
        return false;
    }
    app->job = job;
    app->job_ms = app->now_ms;
    app->wait_us = 0;
    status = begin(app, job);
    if (status != BQ_OK) {
        job_ended(app, status);
    }
    return true;
}
