/* SPDX-License-Identifier: Apache-2.0 */
/* One pass: time, request, super-loop, watchdog, and then one thing to tell. */
#include "bqhost/firmware.h"
#include "app_internal.h"
#include <string.h>

#define SAFE_AGAIN_MS 100u  /* after a refusal the lines are written again */
#define SAFE_RETRY_MS 1000u /* and a bring-up that failed is repeated */
#define LOOK_US 5000u       /* a request line that bounces is seen low in between */

/* ---- set-up ---------------------------------------------------------------------------------- */

static void set_up(bq_firmware *fw, const bq_board *board)
{
    memset(fw, 0, sizeof *fw);
    fw->board = *board;
    fw->request = BQ_REQUEST_OFF;
    fw->ms_us = board->clock.now_us(board->clock.ctx);
    fw->fed_ms = UINT32_MAX;
    fw->target.name = board->name;
    fw->target.mcu = &fw->board.mcu;
    fw->target.can = &fw->board.can;
    fw->source.boot = board->mcu.boot;
    bq_console_init(&fw->console, &board->console);
    bq_telemetry_init(&fw->telemetry, &board->can);
}

bq_status bq_firmware_init(bq_firmware *fw, const bq_board *board, const bq_app_config *config,
                           const bq_afe *afe, bq_cell_reading *cells, uint16_t cell_capacity,
                           bq_temp_reading *temps, uint16_t temp_capacity, bq_module_reading *modules,
                           uint16_t module_capacity)
{
    bq_status status;

    if (fw == NULL || board == NULL || board->clock.now_us == NULL) {
        return BQ_E_ARG;
    }
    set_up(fw, board);
    status = bq_app_init(&fw->app, config, afe, board->gpio.ops != NULL ? &board->gpio : NULL, &board->clock,
                         board->ammeter.read != NULL ? &board->ammeter : NULL, cells, cell_capacity, temps,
                         temp_capacity, modules, module_capacity);
    if (status == BQ_OK) {
        fw->target.app = &fw->app;
        fw->source.app = &fw->app;
        fw->source.period_ms = config->period_ms;
    }
    return status;
}

static void open_lines(const bq_firmware *fw)
{
    const bq_gpio *gpio = &fw->board.gpio;

    if (gpio->ops != NULL) {
        (void)gpio->ops->write(gpio->ctx, BQ_LINE_CONTACTOR, false);
        (void)gpio->ops->write(gpio->ctx, BQ_LINE_PRECHARGE, false);
    }
}

void bq_firmware_refuse(bq_firmware *fw, const bq_board *board, bq_status why, const char *what)
{
    set_up(fw, board);
    open_lines(fw);
    fw->target.refused = why;
    fw->target.what = what;
    fw->source.refused = why;
    fw->safe_done = board->safe.ops == NULL;
    fw->step_ms = 0u - SAFE_RETRY_MS;
}

bq_app *bq_firmware_app(bq_firmware *fw)
{
    return fw->target.app;
}

bq_status bq_firmware_request(bq_firmware *fw, bq_pack_request request)
{
    if (fw == NULL ||
        (request != BQ_REQUEST_OFF && request != BQ_REQUEST_ON && request != BQ_REQUEST_SLEEP)) {
        return BQ_E_ARG;
    }
    fw->request = request;
    return BQ_OK;
}

/* ---- time ------------------------------------------------------------------------------------ */

static uint32_t smaller(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static void advance_time(bq_firmware *fw)
{
    const uint32_t passed_ms = (fw->board.clock.now_us(fw->board.clock.ctx) - fw->ms_us) / 1000u;

    fw->ms_us += passed_ms * 1000u;
    fw->now_ms += passed_ms;
    fw->target.now_ms = fw->now_ms;
    fw->source.now_ms = fw->now_ms;
}

/* Never twice at the same reading of the clock: one that stands still is no health. */
static void feed(bq_firmware *fw)
{
    const bq_mcu *mcu = &fw->board.mcu;

    if (mcu->ops != NULL && fw->now_ms != fw->fed_ms) {
        fw->fed_ms = fw->now_ms;
        mcu->ops->feed(mcu->ctx);
    }
}

/* ---- request --------------------------------------------------------------------------------- */

/* The line's wish: on only after it was high for a while. */
static bool line_on(bq_firmware *fw, bool high)
{
    if (high && !fw->high) {
        fw->high_ms = fw->now_ms;
    }
    fw->high = high;
    return high && fw->now_ms - fw->high_ms >= BQ_FIRMWARE_DEBOUNCE_MS;
}

static bq_pack_request wanted(bq_firmware *fw)
{
    const bq_gpio *gpio = &fw->board.gpio;
    bq_status status = BQ_E_UNSUPPORTED;
    bool high = false;

    if (gpio->ops != NULL) {
        status = gpio->ops->read(gpio->ctx, BQ_LINE_REQUEST, &high);
    }
    if (status == BQ_E_UNSUPPORTED) {
        return fw->request;
    }
    if (line_on(fw, status == BQ_OK && high)) {
        return BQ_REQUEST_ON;
    }
    return fw->request == BQ_REQUEST_SLEEP && !fw->high ? BQ_REQUEST_SLEEP : BQ_REQUEST_OFF;
}

/* When to look at the line again. */
static uint32_t look_us(const bq_firmware *fw)
{
    if (!fw->high) {
        return BQ_FIRMWARE_SLEEP_US;
    }
    return fw->now_ms - fw->high_ms < BQ_FIRMWARE_DEBOUNCE_MS ? LOOK_US : BQ_FIRMWARE_DEBOUNCE_MS * 1000u;
}

/* ---- reset ----------------------------------------------------------------------------------- */

/* Outputs off, carried out by the monitor, and the answer has left the console. */
static bool quiet(const bq_firmware *fw)
{
    const bq_app *app = &fw->app;

    return bq_console_idle(&fw->console) &&
           (fw->target.app == NULL || (!app->line_on && !app->action.charge_on && !app->action.discharge_on &&
                                       !app->apply_due && !app->step_now && app->job != BQ_JOB_APPLY));
}

static void reset_when_quiet(bq_firmware *fw)
{
    const bq_mcu *mcu = &fw->board.mcu;

    if (fw->target.reset && !fw->resetting) {
        fw->resetting = true;
        fw->reset_ms = fw->now_ms;
    }
    if (fw->resetting && (quiet(fw) || fw->now_ms - fw->reset_ms >= 2u * fw->source.period_ms)) {
        mcu->ops->reset(mcu->ctx);
    }
}

/* ---- the two lives --------------------------------------------------------------------------- */

/* 1.25 periods is what the loop promises. */
static bool in_time(const bq_firmware *fw)
{
    const uint32_t period = fw->source.period_ms;

    return fw->now_ms - fw->step_ms <= period + period / 4u + BQ_FIRMWARE_SLACK_MS;
}

/* The hint. A pass that copies a picture or steps the pack tells nothing: that waits for the next one. */
static uint32_t run(bq_firmware *fw)
{
    const bool healthy = in_time(fw);
    const uint32_t steps = bq_app_get_counters(&fw->app)->steps;
    uint32_t hint;

    (void)bq_app_request(&fw->app, fw->resetting ? BQ_REQUEST_OFF : wanted(fw));
    hint = bq_app_step(&fw->app);
    fw->step_ms = fw->now_ms - bq_app_step_age_ms(&fw->app);
    if (healthy && in_time(fw)) {
        feed(fw);
    }
    fw->busy = fw->app.copied || bq_app_get_counters(&fw->app)->steps != steps;
    return smaller(hint, look_us(fw));
}

/* Outputs that are the monitor's own FETs: its bring-up leaves them off. */
static uint32_t bring_up(bq_firmware *fw)
{
    const bq_afe *afe = &fw->board.safe;
    uint32_t wait_us = 0;
    bq_status status;

    if (!fw->safe_running) {
        if (fw->now_ms - fw->step_ms < SAFE_RETRY_MS) {
            return SAFE_AGAIN_MS * 1000u;
        }
        fw->step_ms = fw->now_ms;
        fw->safe_running = afe->ops->start(afe->ctx) == BQ_OK;
        return 0;
    }
    status = afe->ops->poll(afe->ctx, &wait_us);
    fw->safe_running = status == BQ_PENDING;
    fw->safe_done = status == BQ_OK;
    return wait_us;
}

static uint32_t stay_off(bq_firmware *fw)
{
    if (fw->now_ms - fw->safe_ms >= SAFE_AGAIN_MS) {
        fw->safe_ms = fw->now_ms;
        open_lines(fw);
    }
    feed(fw);
    fw->busy = false;
    return fw->safe_done ? SAFE_AGAIN_MS * 1000u : bring_up(fw);
}

/* ---- one pass -------------------------------------------------------------------------------- */

/* Frames of CAN, or a row of the console when there are none. */
static uint32_t tell(bq_firmware *fw)
{
    const uint32_t sent = fw->telemetry.sent;
    const uint32_t hint = bq_telemetry_step(&fw->telemetry, &fw->source);

    if (fw->telemetry.sent != sent) {
        return 0;
    }
    return smaller(hint, bq_console_step(&fw->console, &fw->target));
}

uint32_t bq_firmware_step(bq_firmware *fw)
{
    uint32_t hint;

    advance_time(fw);
    hint = fw->target.app != NULL ? run(fw) : stay_off(fw);
    if (fw->busy) {
        return 0;
    }
    hint = smaller(hint, tell(fw));
    reset_when_quiet(fw);
    return smaller(hint, BQ_FIRMWARE_SLEEP_US);
}
