/* SPDX-License-Identifier: Apache-2.0 */
/* What the files of the console share; see include/bqhost/console.h. */
#ifndef CONSOLE_INTERNAL_H
#define CONSOLE_INTERNAL_H

#include "bqhost/console.h"

/* ---- console_text.c: the row under construction ------------------------------------------------ */

void console_char(bq_console *c, char what);
void console_text(bq_console *c, const char *what);
/*
 * Text with values, taken from `v` in turn:
 *   %0 number        %1, %3 signed, with so many decimals: 25.1, -3.700
 *   %x 4 hexadecimal digits          %X 8
 *   %t milliseconds as seconds: 12.3                    %T since a time
 *   %a an age when the picture was made: , 12 ms old (above INT32_MAX: , never measured)
 *   %E bq_status     %S bq_pack_state_id       %F bq_pack_fault    %H bq_pack_hold
 *   %[off|on]   the value chooses one of the words
 *   %(, cell )  the text and the number, nothing when it is 0
 *   %?          0: "not valid", and the rest is left out
 */
void console_say(bq_console *c, const char *format, const int32_t *v);
void console_end(bq_console *c); /* CR LF; the row is complete */

/* ---- console_edit.c: the line --------------------------------------------------------------------- */

/* One byte of input. True: the line is complete. */
bool console_edit(bq_console *c, uint8_t byte);
void console_prompt(bq_console *c);
/* Remembers the line. */
void console_remember(bq_console *c);

/* ---- commands ------------------------------------------------------------------------------------- */

typedef enum console_row {
    CONSOLE_ROW,   /* a row was made, there may be more */
    CONSOLE_LATER, /* nothing yet, ask again later */
    CONSOLE_DONE   /* no more rows; none was made */
} console_row;

#define CONSOLE_GREETING 0xffu
/* Which command the line is; 0 = none. */
uint8_t console_parse(bq_console *c);
/* The next row of the running command. */
console_row console_run(bq_console *c, bq_console_target *t);

console_row console_status(bq_console *c, const bq_console_target *t);
console_row console_version(bq_console *c, const bq_console_target *t);
console_row console_cells(bq_console *c, const bq_app *app);
console_row console_faults(bq_console *c, const bq_app *app);
console_row console_counters(bq_console *c, const bq_app *app);
console_row console_bleeding(bq_console *c, const bq_app *app);

#endif
