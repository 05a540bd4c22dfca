/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file thermistor.h
 * NTC tables in integers: resistance to temperature by linear interpolation between table points that lie so close that
 * the interpolation error stays below 0.1 degree C.
 */
#ifndef BQHOST_THERMISTOR_H
#define BQHOST_THERMISTOR_H

#include "bqhost/status.h"
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A table of resistances, falling, at equally spaced temperatures. */
typedef struct bq_thermistor {
    const uint32_t *ohms; /**< [count], strictly falling */
    uint16_t count;       /**< 2 or more */
    int16_t first_dc;     /**< temperature of ohms[0], tenths of a degree C */
    int16_t step_dc;      /**< distance of two points, tenths of a degree C, > 0 */
} bq_thermistor;

/** 10 kOhm at 25 C, beta 3435 (103AT type), -40..125 C. */
extern const bq_thermistor bq_thermistor_103at;

/** Temperature in tenths of a degree C of a resistance, rounded to the nearest.
 *  BQ_OK; BQ_E_RANGE outside the table (`*dc` then holds the nearest end); BQ_E_ARG. */
bq_status bq_thermistor_dc(const bq_thermistor *t, uint32_t ohms, int16_t *dc);

#ifdef __cplusplus
}
#endif
#endif
