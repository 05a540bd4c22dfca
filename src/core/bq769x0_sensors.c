/* SPDX-License-Identifier: Apache-2.0 */
/* Temperatures of the bq769x0: each way from a code to a temperature is linked by those who use it. */
#include "bqhost/bq769x0_convert.h"
#include "bqhost/bq769x0_known.h"
#include "bqhost/thermistor.h"

bool bq769x0_sensor_thermistor(const void *thermistor, uint16_t code, int16_t *dc)
{
    uint32_t ohms;
    return bq769x0_ts_ohms(code, &ohms) == BQ_OK && bq_thermistor_dc(thermistor, ohms, dc) == BQ_OK;
}

bool bq769x0_sensor_die(const void *v25_uv, uint16_t code, int16_t *dc)
{
    *dc = bq769x0_die_dc(code, *(const uint32_t *)v25_uv);
    return true;
}

bool bq769x0_sensor_codes(const void *table, uint16_t code, int16_t *dc)
{
    const bq769x0_code_table *t = table;
    const uint16_t *p = t->codes, *last = p + t->count - 1;
    uint32_t at_dc = 0, step_dc = (uint32_t)t->step_dc, span;
    if (code > *p) {
        return false;
    }
    while (*++p > code) {
        if (p == last) {
            return false;
        }
        at_dc += step_dc;
    }
    span = (uint32_t)(p[-1] - p[0]);
    at_dc += ((uint32_t)(p[-1] - code) * 2u * step_dc + span) / (span * 2u);
    *dc = (int16_t)(t->first_dc + (int32_t)at_dc);
    return true;
}
