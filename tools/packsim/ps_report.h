/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file ps_report.h
 * A run as one self-contained HTML page: summary on top, then everything over one time axis. What the curves
 * show is what the firmware measured; gaps are times without a valid value. The number of moments kept is
 * bounded: when it is reached every second one is dropped and the distance doubled.
 */
#ifndef PS_REPORT_H
#define PS_REPORT_H

#include "bqhost/app.h"
#include "ps_judge.h"
#include "ps_scenario.h"
#include <stdio.h>

#define PS_REPORT_MOMENTS 1200

/** NAN = no valid value. */
typedef struct ps_moment {
    uint64_t t;
    float current_a, temp_max_c, spread_mv, soc_percent;
    int balancing, faults, state;
} ps_moment;

typedef struct ps_report {
    FILE *file;
    int cells, most, count;
    uint64_t every, skip; /**< of so many moments offered one is kept; how many to let pass now */
    ps_moment moment[PS_REPORT_MOMENTS];
    uint16_t mv[PS_REPORT_MOMENTS][SIM_CELLS_MAX]; /**< 0 = no valid value */
} ps_report;

/** Opens the file. 0, or -1 with errno set. */
int ps_report_open(ps_report *r, const char *path, int cells);
/** Offers a moment. */
void ps_report_take(ps_report *r, uint64_t t_ns, const bq_app *app);
/** Writes the page and closes it. `summary` is read from its beginning. 0, or -1 if anything could not be
 * written. */
int ps_report_close(ps_report *r, const ps_scenario *s, const ps_judge *j, FILE *summary);

#endif
