/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file sim_cells_pl.h
 * Joins a string of cells to a stack of bq76PL536: module k of the string is device k, its cells are the
 * device's inputs from the bottom, unused inputs see 0 V (tied to the highest cell), its two sensors are TS1
 * and TS2.
 */
#ifndef SIM_CELLS_PL_H
#define SIM_CELLS_PL_H

#include "sim_cells.h"
#include "sim_pl536.h"

/** Shows the present voltages to the devices, and the sensors if a temperature moved. Modules have 6 cells at
 * most. */
void sim_cells_pl_feed(sim_cells *c, sim_pl *s);

/** Books the balancing outputs as they stand for the `dt_s` seconds just passed. Call it before anything can
 * have changed them. Returns true if any is on. */
bool sim_cells_pl_observe(sim_cells *c, const sim_pl *s, double dt_s);

#endif
