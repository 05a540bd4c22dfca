/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file sim_cells_load.h
 * Pack current over time: a constant, or a table that is linear between its rows and begins again at its end.
 */
#ifndef SIM_CELLS_LOAD_H
#define SIM_CELLS_LOAD_H

#include <stddef.h>

#define SIM_CELLS_LOAD_ROWS 20000

typedef struct sim_cells_load {
    int rows;      /**< 0 = no table: only the constant */
    int place;     /**< remembered segment */
    int use_table; /**< 0 = constant */
    double constant_a;
    double t[SIM_CELLS_LOAD_ROWS]; /**< seconds, rising */
    double a[SIM_CELLS_LOAD_ROWS]; /**< amperes, positive charges */
} sim_cells_load;

/** Reads `time_s,current_a` (time rising, at least two rows, |current| <= 10000 A) and selects the table.
 * Returns 0; or -1 with `FILE:LINE: reason` in `error`; the load is then without a table. */
int sim_cells_load_file(sim_cells_load *l, const char *path, char *error, size_t error_size);

/** Amperes at `t` seconds since the start of the run (t >= 0). The last row falls together with the first of
 * the next turn. */
double sim_cells_load_at(sim_cells_load *l, double t);

#endif
