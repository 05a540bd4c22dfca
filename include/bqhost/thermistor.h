/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file thermistor.h
 * NTC tables in integers: resistance to temperature by linear interpolation between table points that lie so
 * close that the interpolation error stays below 0.1 degree C.
 */
#ifndef BQHOST_THERMISTOR_H
#define BQHOST_THERMISTOR_H

#include "bqhost/status.h"
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A table of resistances, falling, at equally spaced temperatures. Make one for any sensor with
 * tools/thermistor.py; it is constant data, not copied, and must outlive its users. */
typedef struct bq_thermistor {
    const uint32_t *ohms; /**< [count], strictly falling */
    uint16_t count;       /**< 2 or more */
    int16_t first_dc;     /**< temperature of ohms[0], tenths of a degree C */
    int16_t step_dc;      /**< distance of two points, tenths of a degree C, > 0; the last must fit 16 bits */
} bq_thermistor;

/** 10 kOhm at 25 C, beta 3435 (103AT type, PL-TS-08), -40..125 C; at most 0.1 degree off the beta curve,
 * rounding included. */
extern const bq_thermistor bq_thermistor_103at;

/**
 * Temperature in tenths of a degree C of a resistance: linear between two points, rounded to the nearest,
 * halves upward.
 * Binary search and one 32-bit division; never blocks.
 * BQ_OK; BQ_E_RANGE: `ohms` outside the table, `*dc` then holds the temperature of the nearest end;
 * BQ_E_ARG, `*dc` unchanged: null pointer, fewer than two points, or a step that is not positive.
 */
bq_status bq_thermistor_dc(const bq_thermistor *t, uint32_t ohms, int16_t *dc);

#ifdef __cplusplus
}
#endif
#endif
