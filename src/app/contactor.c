/* SPDX-License-Identifier: Apache-2.0 */
/* The contactor line and its feedback contact. */
#include "app_internal.h"
#include <stddef.h>

static bq_status write_line(bq_app *app, bool on)
{
    bq_status status = BQ_E_UNSUPPORTED;

    if (app->gpio.ops != NULL) {
        status = app->gpio.ops->write(app->gpio.ctx, BQ_LINE_CONTACTOR, on);
    }
    return status == BQ_E_UNSUPPORTED ? BQ_OK : status;
}

/* BQ_PENDING: not yet. A board that was told to precharge and cannot never closes. */
static bq_status precharge(bq_app *app, bool on)
{
    if (app->precharge != NULL) {
        return app->precharge(app, on);
    }
    return on && app->config.precharge_ms != 0u ? BQ_E_UNSUPPORTED : BQ_OK;
}

bq_status bq_app_write_contactor(bq_app *app, bool on)
{
    bq_status status = precharge(app, on), line;

    on = on && (status == BQ_OK || app->line_on);
    line = write_line(app, on);
    status = status == BQ_OK || status == BQ_PENDING ? line : status;
    app->line_failed = status != BQ_OK;
    if (app->line_failed) {
        bq_app_count(&app->counters.line_failures);
    }
    if (app->line_on != on && (!on || line == BQ_OK)) { /* one that could not be closed is still open */
        app->line_on = on;
        app->precharge_ms = app->now_ms;
        app->mismatch = false; /* the contact has its time to follow the new command */
    }
    return status;
}

bool bq_app_precharge_overdue(const bq_app *app)
{
    return app->precharging && !app->line_on &&
           app->now_ms - app->precharge_ms > app->config.precharge_ms + app->config.pack.comm_timeout_ms;
}

/* A feedback that cannot be read contradicts every command. */
static bool contradicts(bq_app *app)
{
    bool closed = false;
    bq_status status = BQ_E_UNSUPPORTED;

    if (app->gpio.ops != NULL) {
        status = app->gpio.ops->read(app->gpio.ctx, BQ_LINE_CONTACTOR_FB, &closed);
    }
    if (status == BQ_E_UNSUPPORTED) {
        return app->line_failed;
    }
    if (status != BQ_OK) {
        bq_app_count(&app->counters.line_failures);
        return true;
    }
    return app->line_failed || closed != app->line_on;
}

uint32_t bq_app_mismatch_ms(const bq_app *app)
{
    const uint32_t ms = app->now_ms - app->mismatch_ms;

    if (!app->mismatch) {
        return 0;
    }
    return ms == 0u ? 1u : ms;
}

void bq_app_watch_contactor(bq_app *app)
{
    if (!contradicts(app)) {
        app->mismatch = false;
        return;
    }
    if (!app->mismatch) {
        app->mismatch = true;
        app->mismatch_told = false;
        app->mismatch_ms = app->now_ms;
    }
    if (!app->mismatch_told && bq_app_mismatch_ms(app) >= BQ_PACK_MISMATCH_MS) {
        app->mismatch_told = true;
        app->step_now = true;
    }
}
