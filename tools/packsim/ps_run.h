/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file ps_run.h
 * The run: firmware steps and simulated time in turn, events, rows and expectations at their moments.
 */
#ifndef PS_RUN_H
#define PS_RUN_H

#include "ps_console.h"
#include "ps_csv.h"
#include "ps_judge.h"
#include "ps_report.h"
#include "ps_rig.h"

typedef struct ps_run {
    ps_rig *rig;
    ps_judge *judge;
    ps_csv *csv;         /**< NULL = no table */
    ps_report *report;   /**< NULL = none */
    ps_console *console; /**< NULL = nobody types */
    FILE *decisions;     /**< a line for each change of state, faults and outputs; NULL = none */
    bool watch;          /**< live view on standard error */
    bool progress;       /**< a line on standard error */
    /* results */
    int found;             /**< most devices found */
    uint64_t scans;        /**< complete updates */
    double bytes_per_scan; /**< on the bus, mean from one update to the next */
    ps_totals totals;      /**< misuse and speed are filled at the end */
    double speed;
    double spread_start_mv, spread_end_mv;
    uint64_t simulated;
    /* private */
    int next_event;
    uint64_t next_row, next_look, next_progress;
    uint32_t fault_mask, sequence;
    int told_state;
    bool told_outputs;
    bool seen_sample;
    uint64_t bytes_at_sample, bytes_sum, bytes_scans;
    uint64_t shown_wall_ns;
    bool drawn;
} ps_run;

/** Runs the scenario to its end. */
void ps_run_all(ps_run *u);

/** The result lines on `to`: what failed, then the summary. Returns true when every expectation held. */
bool ps_summary(FILE *to, const ps_run *u, bool quiet);

#endif
