/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file sim_ocv.h
 * Open-circuit voltage of a cell by state of charge: a table, linear between its points and continued beyond
 * its ends with the slope of the last segment (an overcharged cell keeps rising), within 0..SIM_OCV_V_MAX.
 */
#ifndef SIM_OCV_H
#define SIM_OCV_H

#include <stddef.h>

#define SIM_OCV_POINTS 512
#define SIM_OCV_V_MAX 6.0

typedef struct sim_ocv {
    int points;
    double soc[SIM_OCV_POINTS];   /**< percent, rising */
    double v[SIM_OCV_POINTS];     /**< volts */
    double slope[SIM_OCV_POINTS]; /**< volts per percent from this point to the next */
} sim_ocv;

/**
 * Reads a CSV file: lines beginning with # and empty lines are skipped, then the header `soc_percent,ocv_v`,
 * then rows with SOC rising within 0..100 and volts 0..SIM_OCV_V_MAX; at least two. Returns 0; or -1 with
 * `FILE:LINE: reason` in `error` and `ocv` unchanged.
 */
int sim_ocv_load(sim_ocv *ocv, const char *path, char *error, size_t error_size);

/** Volts at `soc` percent. `*segment` remembers the place between calls; start it at 0. */
double sim_ocv_volts(const sim_ocv *ocv, double soc, int *segment);

#endif
