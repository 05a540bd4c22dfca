/* SPDX-License-Identifier: Apache-2.0 */
/* The precharge path: closed before the contactor, open soon after it and whenever it is. */
#include "app_internal.h"
#include <stddef.h>

/* What could not be written stays as it was, and is tried again. */
static bq_status drive(bq_app *app, bool on)
{
    const bq_gpio *gpio = &app->gpio;
    const bq_status status =
        gpio->ops != NULL ? gpio->ops->write(gpio->ctx, BQ_LINE_PRECHARGE, on) : BQ_E_UNSUPPORTED;

    if (status == BQ_OK) {
        app->precharging = on;
    }
    return status;
}

/* By a current that was measured since the first half of the time was over. */
static bool charged(const bq_app *app, uint32_t passed_ms)
{
    const bq_sample *s = &app->sample;
    const uint32_t ma = s->current_ma < 0 ? 0u - (uint32_t)s->current_ma : (uint32_t)s->current_ma;
    const uint32_t room_ms = passed_ms - app->config.precharge_ms / 2u;
    const uint32_t copy_ms = app->now_ms - app->copied_ms;

    return app->config.precharge_end_ma == 0u ||
           (s->current_valid && copy_ms < room_ms && s->current_age_ms < room_ms - copy_ms &&
            ma <= app->config.precharge_end_ma);
}

static bq_status begin(bq_app *app)
{
    const bq_status status = drive(app, true);

    app->precharge_ms = app->now_ms;
    return status == BQ_OK ? BQ_PENDING : status;
}

/* Until it is no longer requested. */
static bq_status refuse(bq_app *app)
{
    if (!app->precharge_failed) {
        app->precharge_failed = true;
        bq_app_count(&app->counters.precharge_failures);
    }
    (void)drive(app, false);
    return BQ_E_STATE;
}

/* The contactor is open and shall close. */
static bq_status close_path(bq_app *app)
{
    const uint32_t passed_ms = app->now_ms - app->precharge_ms;

    if (app->precharge_failed || bq_app_precharge_overdue(app)) {
        return refuse(app);
    }
    if (!app->precharging) {
        return begin(app);
    }
    if (passed_ms < app->config.precharge_ms) {
        return BQ_PENDING;
    }
    return charged(app, passed_ms) ? BQ_OK : refuse(app);
}

static bq_status precharge_step(bq_app *app, bool on)
{
    if (!on) {
        app->precharge_failed = app->precharge_failed && app->input.request == BQ_REQUEST_ON;
        return drive(app, false);
    }
    if (!app->line_on) {
        return close_path(app);
    }
    if (app->precharging && app->now_ms - app->precharge_ms >= BQ_PACK_MISMATCH_MS) {
        return drive(app, false);
    }
    return BQ_OK;
}

void bq_app_use_precharge(bq_app *app)
{
    app->precharge = app->config.precharge_ms != 0u ? precharge_step : NULL;
}
