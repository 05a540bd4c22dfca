/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file soc.h
 * State of charge for display: a start value from the open-circuit voltage at rest, then coulomb counting. No
 * protection decision uses it. Integers only.
 */
#ifndef BQHOST_SOC_H
#define BQHOST_SOC_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** One point of an open-circuit voltage curve. */
typedef struct bq_ocv_point {
    uint16_t permille; /**< state of charge, 0..1000 */
    uint16_t mv;       /**< open-circuit voltage of one cell */
} bq_ocv_point;

typedef struct bq_soc_config {
    const bq_ocv_point *ocv; /**< [points], permille strictly ascending, mv not falling; must outlive the
                                  instance; NULL with points = 0 */
    uint16_t points;         /**< 2 or more; 0 = no state of charge */
    uint32_t capacity_mah;   /**< 1..4000000; ignored with points = 0 */
    int32_t rest_ma;         /**< |current| up to this counts as rest, 0 or more */
    uint32_t rest_ms;        /**< rest must have lasted this long before the voltage is taken for the
                                  open-circuit voltage */
    uint32_t gap_ms;         /**< the value becomes invalid once the current was unknown for longer than this
                                  in total */
} bq_soc_config;

typedef struct bq_soc {
    int64_t charge;      /**< in the pack, in halves of mA x ms; 1 mAh = 7200000 */
    uint32_t resting_ms; /**< how long rest has lasted, saturating */
    uint32_t unknown_ms; /**< sum of times with unknown current since the start value, saturating */
    int32_t last_ma;     /**< current of the last step */
    bool last_known;     /**< last_ma is a measured value */
    bool valid;          /**< permille() is meaningful */
} bq_soc;

/** True if the configuration can be used: points = 0, or a table as described, capacity and rest within their
 *  ranges. */
bool bq_soc_config_ok(const bq_soc_config *c);

/** Forgets everything; not valid until the first rest. */
void bq_soc_init(bq_soc *s);

/**
 * Advances by `dt_ms`. `known` says whether `current_ma` (positive charges) is measured and fresh; `cell_mv`
 * is the mean cell voltage, 0 = unknown. While not valid and after rest_ms of rest with a known cell voltage,
 * the start value is taken from the table (linear between points, held at its ends). While valid, charge is
 * added by the trapezoid of the last two currents and kept within 0..capacity; a step of more than a day
 * counts as unknown. Never blocks, never fails.
 */
void bq_soc_step(bq_soc *s, const bq_soc_config *c, uint32_t dt_ms, bool known, int32_t current_ma,
                 uint16_t cell_mv);

/** State of charge in permille, 0..1000, rounded to the nearest; -1 while not valid. */
int16_t bq_soc_permille(const bq_soc *s, const bq_soc_config *c);

#ifdef __cplusplus
}
#endif
#endif
