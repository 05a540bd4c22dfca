/* SPDX-License-Identifier: Apache-2.0 */
/* The super-loop: time, period, pack step, outputs. */
#include "app_internal.h"
#include "bqhost/text.h"
#include <string.h>

#define DEFAULT_RETRY_MS 1000u
#define FRESH_COPY_MS 1u /* a pass or two */

void bq_app_count(uint32_t *counter)
{
    if (*counter != UINT32_MAX) {
        (*counter)++;
    }
}

/* ---- set-up ---------------------------------------------------------------------------------- */

/* Number of the first field of the loop's own that cannot be, below; FIELDS: none. */
enum { PERIOD, RETRY, PRECHARGE, TIMEOUT, TIMER, FIELDS };

static unsigned wrong_field(const bq_app_config *c)
{
    if (c->period_ms < 10u || c->period_ms > 10000u) {
        return PERIOD;
    }
    if (c->retry_ms != 0u && (c->retry_ms < 100u || c->retry_ms > 60000u)) {
        return RETRY;
    }
    if (c->precharge_ms > 10000u || (c->precharge_ms == 0u && c->precharge_end_ma != 0u)) {
        return PRECHARGE;
    }
    if (c->pack.comm_timeout_ms < 2u * c->period_ms) {
        return TIMEOUT;
    }
    /* 0.9 x timer > 1.25 x period (PL-CB-14), in ms and multiplied by 100 */
    return c->balance_timer_s != 0u && c->balance_timer_s * 90000u <= 125u * c->period_ms ? TIMER : FIELDS;
}

bq_status bq_app_config_validate(const bq_app_config *config, const char **field)
{
    bq_status status = bq_pack_config_validate(config != NULL ? &config->pack : NULL, field);
    const unsigned wrong = status == BQ_OK ? wrong_field(config) : FIELDS;

    if (wrong != FIELDS) {
        status = wrong < TIMEOUT ? BQ_E_RANGE : BQ_E_CONFIG;
        if (field != NULL) {
            *field = bq_word("period_ms\0retry_ms\0precharge_ms\0comm_timeout_ms\0balance_timer_s", wrong);
        }
    }
    return status;
}

static bool complete(const bq_afe *afe)
{
    const bq_afe_ops *o = afe != NULL ? afe->ops : NULL;

    return o != NULL && o->start != NULL && o->scan != NULL && o->poll != NULL && o->sample != NULL &&
           o->apply != NULL && o->self_test != NULL && o->sleep != NULL && o->wake != NULL;
}

static bool lines_ok(const bq_gpio *gpio)
{
    return gpio == NULL || (gpio->ops != NULL && gpio->ops->read != NULL && gpio->ops->write != NULL);
}

static bq_status open_lines(bq_app *app)
{
    const bq_status status = bq_app_write_contactor(app, false);

    if (app->gpio.ops != NULL) {
        (void)app->gpio.ops->write(app->gpio.ctx, BQ_LINE_PRECHARGE, false);
    }
    return status;
}

static void start_time(bq_app *app)
{
    app->last_us = app->clock.now_us(app->clock.ctx);
    app->tick_us = app->last_us;
    app->ms_us = app->last_us;
    app->step_now = true;
}

bq_status bq_app_init(bq_app *app, const bq_app_config *config, const bq_afe *afe, const bq_gpio *gpio,
                      const bq_clock *clock, const bq_ammeter *ammeter, bq_cell_reading *cells,
                      uint16_t cell_capacity, bq_temp_reading *temps, uint16_t temp_capacity,
                      bq_module_reading *modules, uint16_t module_capacity)
{
    bq_status status;

    if (app == NULL || !complete(afe) || !lines_ok(gpio) || clock == NULL || clock->now_us == NULL ||
        (ammeter != NULL && ammeter->read == NULL)) {
        return BQ_E_ARG;
    }
    status = bq_app_config_validate(config, NULL);
    if (status != BQ_OK) {
        return status;
    }
    if (cells == NULL || modules == NULL || (temps == NULL && temp_capacity != 0u) ||
        cell_capacity < config->pack.cells || temp_capacity < config->pack.sensors ||
        module_capacity < config->pack.modules) {
        return BQ_E_ARG;
    }
    memset(app, 0, sizeof *app);
    app->config = *config;
    app->config.retry_ms = config->retry_ms != 0u ? config->retry_ms : DEFAULT_RETRY_MS;
    app->period_us = config->period_ms * 1000u;
    app->afe = *afe;
    app->clock = *clock;
    if (gpio != NULL) {
        app->gpio = *gpio;
    }
    if (ammeter != NULL) {
        app->ammeter = *ammeter;
    }
    app->sample.cells = cells;
    app->sample.temps = temps;
    app->sample.modules = modules;
    app->sample.cell_capacity = cell_capacity;
    app->sample.temp_capacity = temp_capacity;
    app->sample.module_capacity = module_capacity;
    app->sample.current_age_ms = UINT32_MAX;
    start_time(app);
    status = open_lines(app);
    return status != BQ_OK ? status : bq_pack_init(&app->pack, &config->pack);
}

/* ---- one pass -------------------------------------------------------------------------------- */

static void advance_time(bq_app *app)
{
    uint32_t passed_ms;

    app->last_us = app->clock.now_us(app->clock.ctx);
    passed_ms = (app->last_us - app->ms_us) / 1000u;
    app->ms_us += passed_ms * 1000u;
    app->now_ms += passed_ms;
}

/* Periods begin at multiples of the period; those that passed unused count as overruns. */
static void begin_period(bq_app *app)
{
    const uint32_t begun = (app->last_us - app->tick_us) / app->period_us;

    if (begun == 0u) {
        return;
    }
    app->tick_us += begun * app->period_us;
    bq_app_count(&app->counters.periods);
    if (begun > 1u || app->scan_due || app->job == BQ_JOB_SCAN || app->job == BQ_JOB_APPLY) {
        bq_app_count(&app->counters.overruns);
    }
    app->scan_due = app->input.monitor == BQ_MONITOR_UP;
}

static uint32_t latest_us(const bq_app *app)
{
    return app->period_us + app->period_us / 4u;
}

static void read_current(bq_app *app, uint32_t passed_ms)
{
    const uint32_t room = UINT32_MAX - app->current_age_ms;
    bq_status status;

    if (app->ammeter.read == NULL) {
        return;
    }
    status = app->ammeter.read(app->ammeter.ctx, &app->current_ma);
    if (status == BQ_OK) {
        app->current_seen = true;
        app->current_age_ms = 0;
    } else {
        app->current_age_ms += passed_ms < room ? passed_ms : room;
        if (status != BQ_E_STALE) {
            bq_app_count(&app->counters.ammeter_failures);
        }
    }
    app->sample.current_ma = app->current_ma;
    app->sample.current_valid = app->current_seen;
    app->sample.current_age_ms = app->current_seen ? app->current_age_ms : UINT32_MAX;
}

static void copy_sample(bq_app *app)
{
    const bq_status status = app->afe.ops->sample(app->afe.ctx, &app->sample);

    app->input.sample_copied = status == BQ_OK;
    if (status != BQ_OK && status != BQ_E_STALE) {
        bq_app_count(&app->counters.sample_failures);
    }
    app->copied = true;
    app->copied_ms = app->now_ms;
}

/* The picture for the step that follows in the next pass. What is not requested may open before that. */
static void prepare_step(bq_app *app)
{
    if (app->input.request != BQ_REQUEST_ON && app->line_on) {
        (void)bq_app_write_contactor(app, false);
    }
    app->scan_ended = false; /* one that ends before the step wants another step */
    copy_sample(app);
}

/* Opening at once; closing when the monitor has carried out the action (monitor.c). */
static void write_outputs(bq_app *app)
{
    if (!(app->action.charge_on && app->action.discharge_on)) {
        (void)bq_app_write_contactor(app, false);
    } else if (app->line_on || bq_app_precharge_overdue(app)) {
        (void)bq_app_write_contactor(app, true);
    }
    app->apply_due = app->input.monitor == BQ_MONITOR_UP;
}

static void step_pack(bq_app *app)
{
    const bq_pack_state_id before = app->pack.state;

    if (app->job == BQ_JOB_SCAN && !app->step_now) {
        bq_app_count(&app->counters.late_scans);
    }
    bq_app_count(&app->counters.steps);
    if (app->now_ms - app->copied_ms > FRESH_COPY_MS) {
        copy_sample(app); /* the caller came late: its ages no longer hold */
    }
    app->copied = false;
    read_current(app, app->now_ms - app->step_ms);
    app->input.contactor_mismatch_ms = bq_app_mismatch_ms(app);
    bq_pack_step(&app->pack, &app->sample, &app->input, app->now_ms, &app->action);
    app->step_us = app->last_us;
    app->step_ms = app->now_ms;
    /* a test that passed is followed by one more step, which acts on a request that waits */
    app->step_now = before == BQ_PACK_SELF_TEST && app->pack.state == BQ_PACK_STANDBY;
    write_outputs(app);
}

bool bq_app_step_due(const bq_app *app)
{
    return app->copied || app->scan_ended || app->step_now || app->last_us - app->step_us >= latest_us(app);
}

static uint32_t smaller(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static uint32_t hint_us(const bq_app *app)
{
    const uint32_t in_period = app->last_us - app->tick_us;
    const uint32_t since_step = app->last_us - app->step_us;
    uint32_t hint = smaller(app->period_us - in_period, latest_us(app) - since_step);
    uint32_t left_us;

    if (app->job != BQ_JOB_NONE) {
        hint = smaller(hint, app->wait_us);
    } else if (bq_app_paused(app, &left_us)) {
        hint = smaller(hint, left_us);
    }
    if (app->mismatch && !app->mismatch_told) {
        hint = smaller(hint, (BQ_PACK_MISMATCH_MS - (app->now_ms - app->mismatch_ms)) * 1000u);
    }
    return hint;
}

uint32_t bq_app_step(bq_app *app)
{
    if (app == NULL) {
        return UINT32_MAX;
    }
    advance_time(app);
    bq_app_poll_job(app);
    bq_app_watch_contactor(app);
    begin_period(app);
    if (app->copied) {
        step_pack(app);
        return 0;
    }
    if (bq_app_step_due(app)) {
        prepare_step(app);
        return 0;
    }
    return bq_app_begin_job(app) ? 0u : hint_us(app);
}

bq_status bq_app_request(bq_app *app, bq_pack_request request)
{
    if (app == NULL ||
        (request != BQ_REQUEST_OFF && request != BQ_REQUEST_ON && request != BQ_REQUEST_SLEEP)) {
        return BQ_E_ARG;
    }
    if (app->input.request != request) {
        app->input.request = request;
        app->step_now = true;
    }
    return BQ_OK;
}

bq_status bq_app_balance(bq_app *app, bool on)
{
    if (app == NULL) {
        return BQ_E_ARG;
    }
    app->input.balance_off = !on;
    return BQ_OK;
}

bq_status bq_app_self_test(bq_app *app)
{
    if (app == NULL) {
        return BQ_E_ARG;
    }
    if (app->input.monitor != BQ_MONITOR_UP || app->line_on || app->action.charge_on ||
        app->action.discharge_on || app->action.sleep) {
        return BQ_E_STATE;
    }
    app->input.self_test = BQ_TEST_NONE;
    app->pausing = false;
    return BQ_OK;
}

/* ---- reading --------------------------------------------------------------------------------- */

const bq_pack_input *bq_app_input(const bq_app *app)
{
    return &app->input;
}

const bq_app_config *bq_app_get_config(const bq_app *app)
{
    return &app->config;
}

uint32_t bq_app_step_age_ms(const bq_app *app)
{
    return app->now_ms - app->step_ms;
}

uint8_t bq_app_modules_found(const bq_app *app)
{
    const bq_afe_ops *ops = app->afe.ops;

    return ops->modules_found != NULL ? ops->modules_found(app->afe.ctx) : (uint8_t)0;
}

const bq_link_stats *bq_app_link(const bq_app *app)
{
    const bq_afe_ops *ops = app->afe.ops;

    return ops->stats != NULL ? ops->stats(app->afe.ctx) : NULL;
}

const bq_sample *bq_app_sample(const bq_app *app)
{
    return &app->sample;
}

const bq_pack *bq_app_pack(const bq_app *app)
{
    return &app->pack;
}

const bq_action *bq_app_action(const bq_app *app)
{
    return &app->action;
}

const bq_app_counters *bq_app_get_counters(const bq_app *app)
{
    return &app->counters;
}

bool bq_app_outputs_on(const bq_app *app)
{
    return app->line_on;
}

uint32_t bq_app_now_ms(const bq_app *app)
{
    return app->now_ms;
}
