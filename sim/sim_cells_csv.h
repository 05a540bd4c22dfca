/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file sim_cells_csv.h
 * Two-column CSV files of the world model: # comments and empty lines, a fixed header, then rows of two
 * numbers.
 */
#ifndef SIM_CELLS_CSV_H
#define SIM_CELLS_CSV_H

#include <stddef.h>

/** Takes one row; returns NULL, or why the row is refused. */
typedef const char *(*sim_cells_csv_row)(void *ctx, double a, double b);

/** Reads the file row by row. Returns 0; or -1 with `FILE:LINE: reason` in `error` (rows before it have been
 * given out). */
int sim_cells_csv_read(const char *path, const char *header, sim_cells_csv_row row, void *ctx, char *error,
                       size_t error_size);

#endif
