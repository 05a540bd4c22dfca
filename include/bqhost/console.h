/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file console.h
 * A command line on a stream of bytes (UART, terminal, pipe). docs/console.md is the user's manual.
 *
 *     help  version  status  cells  faults  counters  self-test  balance [on|off]  reset
 *
 * - Line editing: backspace and delete, left, right, Home and End (also Ctrl-A, Ctrl-E), up and down (also
 *   Ctrl-P, Ctrl-N) through the last BQ_CONSOLE_HISTORY lines (the same line again is not kept twice), Ctrl-U
 * clears the line, Ctrl-C abandons it or ends a running command, Ctrl-L draws it again. CR, LF and CR LF end
 * a line. What does not fit into BQ_CONSOLE_LINE characters rings the bell. Rows end with CR LF.
 * - Never blocks: a row is made when the one before it has left. The stream takes as much as it likes,
 *   nothing too. Input beyond the running command waits in the stream.
 * - Numbers carry unit and age; a value that is not valid is told as such with the reason.
 * - Never touches outputs or the monitor itself: balance, self-test and reset go through bq_app and
 *   bq_firmware.
 */
#ifndef BQHOST_CONSOLE_H
#define BQHOST_CONSOLE_H

#include "bqhost/app.h"
#include "bqhost/hal.h"

#ifdef __cplusplus
extern "C" {
#endif

#define BQ_CONSOLE_LINE 40u      /**< longest line */
#define BQ_CONSOLE_HISTORY 5u    /**< lines remembered */
#define BQ_CONSOLE_ROW 112u      /**< longest row of output */
#define BQ_CONSOLE_WAIT_US 2000u /**< the stream took nothing: the next try */

/** What the commands are about. Owned by the caller. */
typedef struct bq_console_target {
    bq_app *app;       /**< NULL = the configuration was refused: status says why, the rest is empty */
    const char *name;  /**< of the board, for example "lv-f072" */
    const bq_mcu *mcu; /**< NULL, or with ops NULL: a PC */
    const bq_can *can; /**< NULL, or with ops NULL: none */
    uint32_t now_ms;   /**< since start */
    bq_status refused; /**< without app: why */
    const char *what;  /**< and which field or part; NULL = not said */
    bool reset;        /**< set by the command reset; the caller carries it out */
} bq_console_target;

/** One console. Caller-owned, about 420 bytes. */
typedef struct bq_console {
    /* private */
    bq_stream stream;
    uint32_t now_ms, since_ms; /* time of the loop, and since its last pack step */
    uint16_t row;              /* next row of the running command */
    uint16_t item;             /* and where in its list it stands */
    uint8_t out_len, out_sent;
    uint8_t len, cursor;
    uint8_t recalled; /* 0 = the line itself, n = history[n] */
    uint8_t escape;   /* state of an escape sequence */
    uint8_t command;  /* running, 0 = none */
    uint8_t held;     /* input byte read ahead, valid with has_held */
    bool has_held, after_cr;
    char line[BQ_CONSOLE_LINE + 1u];
    char out[BQ_CONSOLE_ROW];
    char history[BQ_CONSOLE_HISTORY + 1u][BQ_CONSOLE_LINE + 1u]; /* the line being typed, then newest first */
} bq_console;

/** Greets and prompts in the first steps. `stream` is copied; NULL or `ops` NULL: there is none, and every
 *  step returns UINT32_MAX. */
void bq_console_init(bq_console *c, const bq_stream *stream);

/**
 * One pass: sends what is waiting, or makes one row, or takes one byte of input. Returns at once; the result
 * is the time in us until the next call is of use: 0 = at once, BQ_CONSOLE_WAIT_US = the stream is full or a
 * command waits for the monitor, UINT32_MAX = when a byte arrives (call at least once per control period, so
 * that a command is answered within one).
 */
uint32_t bq_console_step(bq_console *c, bq_console_target *target);

/** True when nothing is waiting to be sent and no command is running. */
bool bq_console_idle(const bq_console *c);

#ifdef __cplusplus
}
#endif
#endif
