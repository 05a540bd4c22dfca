/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file sim_cells_x0.h
 * Joins a string of cells to one bq769x0. Module k of the string is the part's group of five inputs k; the
 * inputs that carry no cell are shorted and see 0 V. The first sensor of module k is the thermistor of group
 * k (10 kOhm at 25 C, shown to the part as ohms).
 */
#ifndef SIM_CELLS_X0_H
#define SIM_CELLS_X0_H

#include "sim_cells.h"
#include "sim_x0.h"

/** Fills modules and cells_in_module for `cells` cells on a part with `inputs` inputs (X0-CELL-01..15). 0, or
 * -1 for a count that the part's table does not have (nothing changed). */
int sim_cells_x0_share(sim_cells_config *config, int inputs, int cells);

/** Input 1..15 that carries a cell of a string filled by sim_cells_x0_share(). */
int sim_cells_x0_input(const sim_cells *c, int cell);

/** Sensor of the string that is thermistor 1..3 of the part. */
int sim_cells_x0_sensor(int thermistor);

/** Shows the present voltages to the part, and the thermistors if a temperature moved. */
void sim_cells_x0_feed(sim_cells *c, sim_x0 *s);

/** Books the balancing switches as they conduct now for the `dt_s` seconds just passed. Returns true if any
 * is commanded. */
bool sim_cells_x0_observe(sim_cells *c, const sim_x0 *s, double dt_s);

/**
 * Brings a current to the part: `flows_a` through the shunt (X0-CC-01), and the CHG pin pulled up to
 * SIM_CELLS_X0_LOAD_V by a load that asks for discharge current while CHG is off (X0-LOAD-01).
 */
void sim_cells_x0_show_current(sim_x0 *s, double shunt_ohm, double asked_a, double flows_a);
#define SIM_CELLS_X0_LOAD_V 5.0

#endif
