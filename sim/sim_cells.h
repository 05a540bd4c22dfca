/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file sim_cells.h
 * A string of cells in series: state of charge, open-circuit voltage, series resistance, balancing bleed,
 * temperature and thermistors. It knows no chip; sim_cells_pl.h joins it to a bq76PL536 stack,
 * sim_cells_x0.h to a bq769x0. All state lives in the caller's sim_cells. Cells, modules and sensors count
 * from 1, cell 1 at the bottom of the string.
 *
 * What the model holds to be true
 * - Voltage = OCV(state of charge) + R x (pack current - bleed current); positive current charges. The bleed
 *   current is the cell's voltage through bleed_ohm while its balancing output is on.
 * - Charge is counted without loss. SOC may leave 0..100 %; the OCV goes on with its last slope.
 * - All cells of a module share one temperature: a first-order system towards ambient, heated by I^2 R of its
 *   cells. Heat capacity and resistance scale with the cell's capacity (SIM_CELLS_HEAT_J_PER_K_AH,
 *   SIM_CELLS_THERMAL_TAU_S).
 * - Each module has SIM_CELLS_SENSORS thermistors, 10 kOhm at 25 C with B = 3435 K, between 1.47 kOhm in
 *   series and 1.82 kOhm to ground (PL-TS-08). The ratio V(TS)/REG50 comes from a table with one point per
 *   degree C, linear between.
 */
#ifndef SIM_CELLS_H
#define SIM_CELLS_H

#include "sim_ocv.h"
#include <stdbool.h>
#include <stdint.h>

#define SIM_CELLS_MAX 372
#define SIM_CELLS_MODULES 62
#define SIM_CELLS_SENSORS 2
#define SIM_CELLS_HEAT_J_PER_K_AH 17.0
#define SIM_CELLS_THERMAL_TAU_S 1800.0
#define SIM_CELLS_T_MIN (-60)
#define SIM_CELLS_T_MAX 160

typedef struct sim_cells_config {
    int modules;                            /**< 1..SIM_CELLS_MODULES */
    int cells_in_module[SIM_CELLS_MODULES]; /**< 1..15 each; SIM_CELLS_MAX together */
    double capacity_ah;                     /**< > 0 */
    double resistance_ohm;                  /**< >= 0 */
    double soc_percent;                     /**< 0..100, mean of the cells */
    double soc_spread_percent; /**< >= 0; cells spread evenly over +- half of it, in a seeded order */
    double ambient_c;          /**< SIM_CELLS_T_MIN..SIM_CELLS_T_MAX */
    double bleed_ohm;          /**< > 0 */
    uint64_t seed;
    const sim_ocv *ocv; /**< must outlive the instance */
} sim_cells_config;

typedef struct sim_cells {
    sim_cells_config config;
    int cells;
    int first_cell[SIM_CELLS_MODULES]; /**< index of the lowest cell of a module */
    double soc[SIM_CELLS_MAX];
    double volts[SIM_CELLS_MAX];            /**< at the terminals, as of the last step */
    double forced[SIM_CELLS_MAX];           /**< < 0 = not forced */
    uint32_t bleed_mask[SIM_CELLS_MODULES]; /**< outputs at the last observation */
    double bleed_s[SIM_CELLS_MODULES];      /**< time they have been so, not yet taken from the charge */
    int segment[SIM_CELLS_MAX];
    double t_module[SIM_CELLS_MODULES];
    double heat_j[SIM_CELLS_MODULES];
    double forced_t[SIM_CELLS_MODULES * SIM_CELLS_SENSORS]; /**< above SIM_CELLS_T_MAX = not forced */
    double heat_s;                                          /**< time since the temperatures moved */
    double current_a;                                       /**< through the string, as of the last step */
    bool any_forced, temps_moved;
    double ratio[SIM_CELLS_T_MAX - SIM_CELLS_T_MIN + 1];
} sim_cells;

/** Sets up the string at rest. Returns 0, or -1 with nothing usable when a field is outside its range. */
int sim_cells_init(sim_cells *c, const sim_cells_config *config);

/**
 * Lets `dt_s` seconds pass (>= 0) with the string current moving linearly from `from_a` to `to_a`, then
 * computes the terminal voltages at `to_a`. Temperatures move once per simulated second.
 */
void sim_cells_step(sim_cells *c, double dt_s, double from_a, double to_a);

/** Takes what was bled from the charge of a module's cells; from now on the outputs are `mask`. */
void sim_cells_take_bleed(sim_cells *c, int module, uint32_t mask);

/** Observes the balancing outputs: in the `dt_s` seconds just passed those of `module` were `mask` (bit n-1 =
 * its cell n). */
static inline void sim_cells_bleed(sim_cells *c, int module, uint32_t mask, double dt_s)
{
    mask &= (1u << (unsigned)c->config.cells_in_module[module - 1]) - 1u;
    if (mask != c->bleed_mask[module - 1]) {
        sim_cells_take_bleed(c, module, mask);
    }
    if (mask != 0u) {
        c->bleed_s[module - 1] += dt_s;
    }
}

/** Forces a cell's terminal voltage (0..SIM_OCV_V_MAX) until sim_cells_free(). Takes effect at once. 0, or -1
 * when refused. */
int sim_cells_force(sim_cells *c, int cell, double volts);
int sim_cells_free(sim_cells *c, int cell);

/** Forces a sensor to a temperature. 0, or -1 when refused. */
int sim_cells_force_sensor(sim_cells *c, int sensor, double celsius);

/** Resistance of a thermistor. */
double sim_cells_ntc_ohms(double celsius);

/** Temperature a sensor feels, and its ratio V(TS)/REG50. */
double sim_cells_celsius(const sim_cells *c, int sensor);
double sim_cells_ts_ratio(const sim_cells *c, int sensor);

/** Mean state of charge of the cells, percent. */
double sim_cells_mean_soc(const sim_cells *c);
/** Highest minus lowest terminal voltage, volts. */
double sim_cells_spread(const sim_cells *c);

#endif
