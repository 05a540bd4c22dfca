/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file app.h
 * The super-loop: joins a monitor (bq_afe), the pack controller and the board's lines. Nothing blocks.
 *
 * Every period: begin a scan, poll it to its end, copy the sample, read the ammeter, run the pack step, write
 * the contactor line if it has to open, hand the action to the monitor, poll that to its end, and only then
 * write the contactor line if it has to close.
 *
 * One pass does one of these at most: copy the sample, run the pack step, begin a job; a pass that has more
 * to do returns 0.
 *
 * Guarantees, as long as bq_app_step() is called at the latest when its hint has passed:
 * - The pack step runs at least every 1.25 x period_ms, with old data and their age if nothing newer is
 *   there, even if the monitor's jobs never end or its functions return errors for ever. Opening the
 *   contactor waits for no monitor. So the line is low at the latest
 *       pack.comm_timeout_ms + 1.25 x period_ms
 *   after the conversion start of the last complete valid picture, plus the lateness of the caller.
 * - A self-test that passed is followed by two pack steps in the next passes, with the picture there is,
 *   instead of one period later each: the first leads to standby, the second acts on a request that waits.
 * - With a contradicting feedback contact: BQ_PACK_MISMATCH_MS + 1.25 x period_ms.
 * - A request off or sleep opens the contactor in the next bq_app_step() (the monitor's own FETs with the
 *   action of the step that follows).
 * - Bring-up is repeated at most once per retry_ms.
 */
#ifndef BQHOST_APP_H
#define BQHOST_APP_H

#include "bqhost/afe.h"
#include "bqhost/hal.h"
#include "bqhost/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

#define BQ_APP_BRING_UP_MS                                                                                   \
    10000u /**< a bring-up that takes longer is reported as failed with BQ_E_TIMEOUT                         \
            */

typedef struct bq_app_config {
    uint32_t period_ms; /**< control period, 10..10000; comm_timeout_ms must be 2 periods or more */
    uint32_t retry_ms;  /**< pause between attempts at bring-up, wake, sleep and self-test, 100..60000; 0 =
                             1000 */
    uint8_t balance_timer_s;   /**< safety timer of the monitors' balancing outputs; 0 = they have none or
                                    balancing is never used. 0.9 x timer must exceed the longest time between
                                    two steps, 1.25 x period_ms (PL-CB-14) */
    uint16_t precharge_ms;     /**< how long the precharge path is closed alone before the contactor closes,
                                   1..10000; 0 = the contactor closes directly. Needs bq_app_use_precharge() */
    uint32_t precharge_end_ma; /**< current in either direction that may flow at the end of that time: more,
                                   or none measured after the first half of it, is no charged load and the
                                   contactor stays open; 0 = not looked at; 0 while precharge_ms is 0 */
    bq_pack_config pack;
} bq_app_config;

/** Counted since init, saturating. */
typedef struct bq_app_counters {
    uint32_t periods;         /**< periods begun */
    uint32_t steps;           /**< pack steps run */
    uint32_t overruns;        /**< periods that began while the job of an earlier one was still running, or
                                   were skipped */
    uint32_t late_scans;      /**< pack steps that could not wait for the running scan */
    uint32_t scan_failures;   /**< scans that ended with an error or could not begin */
    uint32_t sample_failures; /**< pictures that could not be copied */
    uint32_t apply_failures;  /**< actions that failed or could not begin */
    uint32_t bring_ups;       /**< attempts at bring-up */
    uint32_t bring_up_failures;
    uint32_t self_test_failures;
    uint32_t line_failures;      /**< contactor or feedback accesses that failed */
    uint32_t ammeter_failures;   /**< ammeter readings that failed, BQ_E_STALE excepted */
    uint32_t precharge_failures; /**< precharge times that ended with too much or an unknown current, or did
                                      not end */
} bq_app_counters;

typedef enum bq_app_job {
    BQ_JOB_NONE,
    BQ_JOB_START,
    BQ_JOB_SELF_TEST,
    BQ_JOB_SCAN,
    BQ_JOB_APPLY,
    BQ_JOB_SLEEP,
    BQ_JOB_WAKE
} bq_app_job;

/** One super-loop. Caller-owned; use the functions below to read it. */
typedef struct bq_app {
    /* private; small members first: only what lies near the beginning is one instruction away on a Cortex-M0
     */
    bq_pack_input input;
    bool pausing; /* retry_ms is the begin of a pause */
    bool copied;  /* the picture for the next step was copied: the step is due */
    bool scan_due, scan_ended, apply_due, step_now;
    bool scanned; /* a scan has succeeded since the monitor is up */
    bool asleep;
    bool line_on, line_failed, mismatch, mismatch_told, current_seen;
    bool precharging, precharge_failed;
    bq_app_job job;
    uint32_t last_us, ms_us, now_ms;    /* software-extended time; the clock when now_ms began */
    uint32_t period_us, tick_us;        /* when the present period began */
    uint32_t step_us, step_ms;          /* last pack step */
    uint32_t wait_us;                   /* hint of the running job */
    uint32_t job_ms, retry_ms, scan_ms; /* job began, last retryable failure, last good scan */
    uint32_t copied_ms;                 /* when that picture was copied */
    uint32_t current_age_ms, mismatch_ms, precharge_ms;
    int32_t current_ma;
    bq_afe afe;
    bq_clock clock;
    bq_gpio gpio;
    bq_ammeter ammeter;
    bq_status (*precharge)(struct bq_app *app, bool on);
    bq_action action, applied;
    bq_app_counters counters;
    bq_sample sample;
    bq_app_config config;
    bq_pack pack;
} bq_app;

/**
 * Checks every field: the statuses of bq_pack_config_validate(), BQ_E_RANGE (period_ms, retry_ms,
 * precharge_ms, which also stands for precharge_end_ma without it), BQ_E_CONFIG (comm_timeout_ms shorter than
 * two periods; balance_timer_s too short for the period). `field` as there.
 */
bq_status bq_app_config_validate(const bq_app_config *config, const char **field);

/**
 * Sets up the loop and opens the contactor and precharge lines; the monitor is first touched by
 * bq_app_step(). `config`, `afe`, `gpio`, `clock`, `ammeter` are copied (their `ctx` must outlive the
 * instance). `gpio` NULL = the board has no line; `ammeter` NULL = the monitor measures the current or nobody
 * does. The three arrays hold the sample and belong to the instance until it is no longer used; their lengths
 * must be at least the configured cells, sensors (array NULL with 0) and modules. BQ_OK; BQ_E_ARG (null
 * pointer, missing function, array too short); the statuses of bq_app_config_validate(); or what the
 * contactor line returned if it could not be opened (BQ_E_UNSUPPORTED is no error). After an error the
 * instance must not be used.
 */
bq_status bq_app_init(bq_app *app, const bq_app_config *config, const bq_afe *afe, const bq_gpio *gpio,
                      const bq_clock *clock, const bq_ammeter *ammeter, bq_cell_reading *cells,
                      uint16_t cell_capacity, bq_temp_reading *temps, uint16_t temp_capacity,
                      bq_module_reading *modules, uint16_t module_capacity);

/**
 * One pass: polls the running job once, runs what is due, returns at once. The result is the time in
 * microseconds until the next thing is due (0 = call again at once); calling earlier is harmless, calling
 * later costs punctuality, and calls must come at least every 2^31 us. The state of charge, timeouts and
 * periods follow the clock, not the number of calls. UINT32_MAX if `app` is NULL.
 */
uint32_t bq_app_step(bq_app *app);

/**
 * Tells that the board has a precharge path on BQ_LINE_PRECHARGE; to be called once after bq_app_init(). From
 * then on, with precharge_ms in the configuration, closing means: the path closes, precharge_ms later
 * (rounded up to a control period) the contactor closes if the current is then no more than precharge_end_ma,
 * and in the first pack step BQ_PACK_MISMATCH_MS after that the path opens. Opening opens both, whatever was
 * under way. A load that does not charge, and a path that cannot be switched, count as a contactor that does
 * not follow: it stays open, the path opens, and the fault "contactor" is latched until the request is off.
 * Whatever the monitor does or does not do, the path is closed alone for precharge_ms + comm_timeout_ms +
 * 1.25 x period_ms at most: its resistor must bear that. A path that never conducts is not noticed: no
 * current flows through it either.
 * Without this call a configuration with precharge_ms never closes the contactor, which is that fault too.
 * `app` must not be NULL.
 */
void bq_app_use_precharge(bq_app *app);

/** What the user wants; initially BQ_REQUEST_OFF. Takes effect in the next bq_app_step(). BQ_OK; BQ_E_ARG
 *  (NULL, or not a bq_pack_request: the request stays as it was). */
bq_status bq_app_request(bq_app *app, bq_pack_request request);

/**
 * Switches balancing off by the user's wish, or on again (initially on, not remembered over a reset). Takes
 * effect in the next pack step; that on means "as the pack controller decides". BQ_E_ARG if `app` is NULL.
 */
bq_status bq_app_balance(bq_app *app, bool on);

/**
 * Asks for another self-test of the monitor, to be begun when the running job has ended. Until its result is
 * there the pack is not in standby and cannot go on. bq_app_input()->self_test is BQ_TEST_NONE from now on
 * until the test ended, then passed or failed. BQ_OK, also while one is under way; BQ_E_STATE: an output is
 * on (the test forces the fault lines of the monitors), the monitor is not up or asleep; BQ_E_ARG.
 */
bq_status bq_app_self_test(bq_app *app);

/** What the last pack step was told besides the sample, and what the next one will be: request, state of the
 *  monitor, self-test, last statuses. Never NULL. */
const bq_pack_input *bq_app_input(const bq_app *app);

/** Configuration in use. Never NULL. */
const bq_app_config *bq_app_get_config(const bq_app *app);

/** Milliseconds since the last pack step (since init before the first), by the clock of the last
 *  bq_app_step(). */
uint32_t bq_app_step_age_ms(const bq_app *app);

/** Modules the monitor has found, 0 before; its link statistics, NULL if it keeps none. */
uint8_t bq_app_modules_found(const bq_app *app);
const bq_link_stats *bq_app_link(const bq_app *app);

/** The picture the last pack step saw (counts are 0 before the first), the pack controller, the last action,
 *  counters. Never NULL. */
const bq_sample *bq_app_sample(const bq_app *app);
const bq_pack *bq_app_pack(const bq_app *app);
const bq_action *bq_app_action(const bq_app *app);
const bq_app_counters *bq_app_get_counters(const bq_app *app);

/** Level last wanted of the contactor line (also on a board without it): charging and discharging both
 *  allowed. A line that could not be written high counts as low until it could. */
bool bq_app_outputs_on(const bq_app *app);

/** Milliseconds since init: the 32-bit microsecond clock extended in software. It is the `now_ms` of the pack
 *  and wraps after 49 days. */
uint32_t bq_app_now_ms(const bq_app *app);

#ifdef __cplusplus
}
#endif
#endif
