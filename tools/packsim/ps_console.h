/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file ps_console.h
 * The firmware's console on standard input and output. On a terminal: keys as they are pressed, simulated
 * time runs as fast as the clock on the wall, Ctrl-] leaves. From a pipe or file: simulated time runs as fast
 * as it can; a line "@TIME COMMAND" is typed at that simulated time, any other when the one before it has
 * been answered.
 */
#ifndef PS_CONSOLE_H
#define PS_CONSOLE_H

#include "bqhost/hal.h"
#include "ps_text.h"
#include <stdbool.h>

#define PS_CONSOLE_STEP (5 * PS_MS) /* the firmware looks for keys at least so often */

typedef struct ps_console {
    bool terminal, left;
    uint64_t wall_ns, begun; /* of the same moment */
    char line[256];          /* typed, not taken yet */
    size_t len, taken;
    char ahead[256]; /* a line that waits for its time */
    uint64_t due;    /* that time */
    bool waiting, ended;
    unsigned matched; /* so much of a prompt was seen */
    bool prompted;    /* the last that was seen is a prompt */
} ps_console;

/** A terminal is set to raw mode until the program ends. */
void ps_console_open(ps_console *c);
void ps_console_close(ps_console *c);
/** Before a pass of the firmware at the simulated time `now`: waits for the wall clock (terminal), takes
 * keys. */
void ps_console_turn(ps_console *c, uint64_t now);
/** What the firmware's board offers. `c` must outlive it. */
bq_stream ps_console_stream(ps_console *c);

#endif
