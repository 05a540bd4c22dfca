/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file firmware.h
 * The whole firmware above the board: super-loop (app.h), console, telemetry, the request line and the
 * watchdog. A board's main program:
 *
 *     board = what the back-end offers; config = bq_settings_load() or defaults; driver init, bq_afe
 *     status = boot->image_ok ? bq_firmware_init(&fw, &board, &config, ...) : BQ_E_CRC;
 *     if (status != BQ_OK) {
 *         bq_firmware_refuse(&fw, &board, status, "settings");
 *     }
 *     for (;;) {
 *         sleep until bq_firmware_step(&fw) us have passed or an interrupt has come
 *     }
 *
 * - One pass does one expensive thing at most: the copy of a picture, or a pack step, or up to
 * BQ_TELEMETRY_FRAMES frames of CAN, or one row of the console. So a pass ends within 200 us on a Cortex-M0
 * at 48 MHz (15 cells) and on a Cortex-M4 at 168 MHz (192 cells), and no output, however long, delays the
 * super-loop by more than one pass.
 * - The watchdog is fed only in a pass that began no later than 1.25 periods and BQ_FIRMWARE_SLACK_MS after
 *   the last pack step, and only when the clock has moved on since the last feeding. A stuck driver, a pack
 *   step that no longer comes, a caller that is always late and a clock that stands still end in a reset.
 * - The request: on a board with BQ_LINE_REQUEST, on = the line has been high for BQ_FIRMWARE_DEBOUNCE_MS,
 *   anything else (low, or it cannot be read) is off at once; a board without the line (BQ_E_UNSUPPORTED)
 *   follows bq_firmware_request().
 * - The command reset: request off, the outputs opened and the action carried out by the monitor (at most
 *   two periods), then mcu.ops->reset.
 */
#ifndef BQHOST_FIRMWARE_H
#define BQHOST_FIRMWARE_H

#include "bqhost/app.h"
#include "bqhost/console.h"
#include "bqhost/hal.h"
#include "bqhost/telemetry.h"

#ifdef __cplusplus
extern "C" {
#endif

#define BQ_FIRMWARE_SLACK_MS 100u    /**< lateness that the watchdog forgives */
#define BQ_FIRMWARE_DEBOUNCE_MS 20u  /**< the request line must be high for so long */
#define BQ_FIRMWARE_SLEEP_US 250000u /**< longest time between two passes: watchdog and request line */

/** What a board offers. Copied; what it points to must outlive the firmware. All zero but `clock` = a board
 *  with nothing. */
typedef struct bq_board {
    const char *name;   /**< for the console, for example "lv-f072"; NULL = "" */
    bq_gpio gpio;       /**< ops NULL = no lines */
    bq_clock clock;     /**< now_us mandatory */
    bq_ammeter ammeter; /**< read NULL = none */
    bq_can can;         /**< ops NULL = none */
    bq_stream console;  /**< ops NULL = none */
    bq_nvm nvm;         /**< not used by the loop; main loads the settings from it */
    bq_mcu mcu;         /**< ops NULL = a PC: no watchdog, no reset */
    bq_afe safe; /**< only for bq_firmware_refuse(), on boards whose outputs are FETs of the monitor: its
                    bring-up leaves them off and is tried once a second until it succeeds. ops NULL = not
                    needed */
} bq_board;

/** One firmware. Caller-owned; read it with the functions of app.h through bq_firmware_app(). */
typedef struct bq_firmware {
    /* private; small members first, as in bq_app */
    bq_pack_request request; /* of bq_firmware_request() */
    bool high, resetting, busy, safe_running, safe_done;
    uint32_t ms_us, now_ms; /* the clock, extended; what it read when now_ms began */
    uint32_t step_ms, fed_ms, high_ms, reset_ms, safe_ms;
    bq_telemetry_source source;
    bq_console_target target;
    bq_board board;
    bq_telemetry telemetry;
    bq_console console;
    bq_app app;
} bq_firmware;

/**
 * Sets up everything, outputs off. The arguments from `config` on are those of bq_app_init() (a bq_gpio with
 * ops NULL there is a NULL pointer). Touches no bus. BQ_OK; BQ_E_ARG (null pointer, no clock); the statuses
 * of bq_app_init(). After an error only bq_firmware_refuse() is legal.
 */
bq_status bq_firmware_init(bq_firmware *fw, const bq_board *board, const bq_app_config *config,
                           const bq_afe *afe, bq_cell_reading *cells, uint16_t cell_capacity,
                           bq_temp_reading *temps, uint16_t temp_capacity, bq_module_reading *modules,
                           uint16_t module_capacity);

/**
 * The other way to set up: the configuration or the image cannot be trusted. Contactor and precharge are
 * opened, now and again every 100 ms, and there is no way on but a reset. Console (status tells `why` and
 * `what`), heartbeat, watchdog and the command reset stay alive. `what` names the field or part and must stay
 * valid; may be NULL. `fw` and `board` must not be NULL, board->clock.now_us must be there.
 */
void bq_firmware_refuse(bq_firmware *fw, const bq_board *board, bq_status why, const char *what);

/** One pass of the super-loop. Returns at once; the result is the time in us until the next thing is due, 0 =
 *  at once, at most BQ_FIRMWARE_SLEEP_US. Calling earlier is harmless: do so when an interrupt has come. */
uint32_t bq_firmware_step(bq_firmware *fw);

/** What the user wants, on a board without a request line; BQ_REQUEST_SLEEP also on one with, while the line
 *  is low. Initially off. BQ_OK; BQ_E_ARG (not a bq_pack_request; nothing changed). */
bq_status bq_firmware_request(bq_firmware *fw, bq_pack_request request);

/** The loop inside, for reading and for tests; NULL after bq_firmware_refuse(). */
bq_app *bq_firmware_app(bq_firmware *fw);

#ifdef __cplusplus
}
#endif
#endif
