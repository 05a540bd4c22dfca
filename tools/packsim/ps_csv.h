/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file ps_csv.h
 * The table of a run: one row per control period.
 */
#ifndef PS_CSV_H
#define PS_CSV_H

#include "bqhost/app.h"
#include "sim_cells.h"
#include <stdio.h>

typedef struct ps_csv {
    FILE *file;
    int cells;
} ps_csv;

/** Opens and writes the header. 0, or -1 with errno set. */
int ps_csv_open(ps_csv *c, const char *path, int cells);
/** One row at `t_ns`. */
void ps_csv_row(ps_csv *c, uint64_t t_ns, const bq_app *app, const sim_cells *world);
/** 0, or -1 if anything could not be written. */
int ps_csv_close(ps_csv *c);

#endif
