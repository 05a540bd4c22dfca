/* SPDX-License-Identifier: Apache-2.0 */
/* A console on a fake board, and a terminal that shows what a user would see. */
#ifndef TERMINAL_H
#define TERMINAL_H

#include "bqhost/console.h"
#include "fake_board.h"

#define TERMINAL_TEXT 20000

typedef struct terminal {
    fake_board board;
    bq_console console;
    bq_console_target target;
    bq_mcu mcu;
    bq_boot boot;
    char typed[400]; /* not read yet */
    size_t typed_len, typed_read;
    char text[TERMINAL_TEXT]; /* everything written, as it came */
    size_t len;
    size_t takes;  /* most bytes the stream takes at once */
    char row[200]; /* the row the cursor is in, as shown */
    int column;
    int bells;
} terminal;

/* Up, standby, greeting already shown; what was shown is forgotten. */
void terminal_init(terminal *t);
/* Starts the console anew, on a stream or without. */
void terminal_restart(terminal *t, bool stream);
/* Types and lets the console work until it wants nothing more. */
void terminal_type(terminal *t, const char *keys);
/* Passes until nothing moves any more. */
void terminal_settle(terminal *t);
void terminal_forget(terminal *t);
/* Types a line and returns everything that was shown for it. */
const char *terminal_ask(terminal *t, const char *line);

#endif
