/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file ps_watch.h
 * A live view of the pack on a terminal, refreshed in place.
 */
#ifndef PS_WATCH_H
#define PS_WATCH_H

#include "bqhost/app.h"
#include <stdint.h>
#include <stdio.h>

/** Draws the whole view at simulated time `t_ns`; `first` clears the screen before. */
void ps_watch_draw(FILE *to, uint64_t t_ns, const bq_app *app, int found, int first);

#endif
