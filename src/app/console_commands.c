/* SPDX-License-Identifier: Apache-2.0 */
/* Which command a line is, and the commands of a row or two. */
#include "bqhost/text.h"
#include "console_internal.h"
#include <string.h>

/* In the order of `commands`; 0 = none. */
enum {
    HELP = 1,
    VERSION,
    STATUS,
    CELLS,
    FAULTS,
    COUNTERS,
    SELF_TEST,
    BALANCE,
    BALANCE_ON,
    BALANCE_OFF,
    RESET,
    UNKNOWN
};

/* Each with its row of help. */
static const char commands[] = "help: this list\0"
                               "version: last reset, crash\0"
                               "status: state, reason, measurements\0"
                               "cells: every cell and sensor\0"
                               "faults: every one since the start\0"
                               "counters: of loop and link\0"
                               "self-test: of the monitors, outputs off\0"
                               "balance: which cells bleed\0"
                               "balance on: allow it\0"
                               "balance off: forbid it\0"
                               "reset: outputs off, then restart";

/* ---- taking the line apart ------------------------------------------------------------------------ */

/* One blank between words, none around them. */
static void tidy(char *line)
{
    char *to = line;

    for (const char *from = line; *from != '\0'; from++) {
        if (*from != ' ' || (from[1] != ' ' && from[1] != '\0' && to != line)) {
            *to++ = *from;
        }
    }
    *to = '\0';
}

/* Whether `line` is what stands before the colon. */
static bool is(const char *line, const char *command)
{
    while (*line != '\0' && *line == *command) {
        line++;
        command++;
    }
    return *line == '\0' && *command == ':';
}

uint8_t console_parse(bq_console *c)
{
    uint8_t n = 0;

    tidy(c->line);
    if (c->line[0] != '\0') {
        while (n < (uint8_t)UNKNOWN - 1u && !is(c->line, bq_word(commands, n))) {
            n++;
        }
        n++;
    }
    return n;
}

/* ---- rows ------------------------------------------------------------------------------------------- */

/* The only row of a command. */
static console_row only(bq_console *c, const char *what)
{
    if (c->row++ > 0u) {
        return CONSOLE_DONE;
    }
    console_text(c, what);
    return CONSOLE_ROW;
}

static console_row help(bq_console *c)
{
    if (c->row >= (uint8_t)UNKNOWN - 1u) {
        return CONSOLE_DONE;
    }
    console_text(c, bq_word(commands, c->row++));
    return CONSOLE_ROW;
}

static console_row self_test(bq_console *c, bq_app *app)
{
    const bq_pack_input *in = bq_app_input(app);

    if (c->row == 0u) {
        if (bq_app_self_test(app) != BQ_OK) {
            return only(c, "not now: an output is on, or the monitor is not up");
        }
        c->item = 1;
        return only(c, "running");
    }
    if (c->item == 0u) {
        return CONSOLE_DONE;
    }
    if (in->self_test == BQ_TEST_NONE && in->monitor == BQ_MONITOR_UP) {
        return CONSOLE_LATER;
    }
    {
        const int32_t v[] = {(int32_t)in->self_test, (int32_t)in->self_test_status};
        c->item = 0;
        console_say(c, "%[the monitor was lost|passed|failed], %E", v);
    }
    return CONSOLE_ROW;
}

static console_row balance(bq_console *c, bq_app *app)
{
    if (c->row++ > 0u) {
        return console_bleeding(c, app);
    }
    if (c->command != (uint8_t)BALANCE) {
        (void)bq_app_balance(app, c->command == (uint8_t)BALANCE_ON);
    }
    {
        const int32_t v[] = {bq_app_input(app)->balance_off, bq_app_pack(app)->summary.balancing};
        console_say(c, "%[allowed|forbidden], cells that bleed: %0", v);
    }
    return CONSOLE_ROW;
}

static console_row reset(bq_console *c, bq_console_target *t)
{
    if (t->mcu == NULL || t->mcu->ops == NULL) {
        return only(c, "not on this board");
    }
    t->reset = true;
    return only(c, "outputs off, then reset");
}

static console_row of_app(bq_console *c, bq_app *app)
{
    switch (c->command) {
    case CELLS:
        return console_cells(c, app);
    case FAULTS:
        return console_faults(c, app);
    case COUNTERS:
        return console_counters(c, app);
    case SELF_TEST:
        return self_test(c, app);
    default:
        return balance(c, app);
    }
}

console_row console_run(bq_console *c, bq_console_target *t)
{
    switch (c->command) {
    case HELP:
        return help(c);
    case VERSION:
        return console_version(c, t);
    case STATUS:
        return console_status(c, t);
    case RESET:
        return reset(c, t);
    case UNKNOWN:
        return only(c, "unknown, try help");
    case CONSOLE_GREETING:
        return c->row == 0u ? console_version(c, t) : CONSOLE_DONE;
    default:
        return t->app != NULL ? of_app(c, t->app) : only(c, "nothing runs, see status");
    }
}
