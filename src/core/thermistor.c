/* SPDX-License-Identifier: Apache-2.0 */
#include "bqhost/thermistor.h"
#include <stddef.h>

/* Index of the interval that holds `ohms`: table[i] >= ohms > table[i + 1], or the last one. */
static uint16_t interval(const bq_thermistor *t, uint32_t ohms)
{
    uint16_t low = 0;
    uint16_t high = (uint16_t)(t->count - 1u);
    while (high - low > 1) {
        uint16_t middle = (uint16_t)((low + high) / 2);
        if (t->ohms[middle] >= ohms) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

bq_status bq_thermistor_dc(const bq_thermistor *t, uint32_t ohms, int16_t *dc)
{
    if (t == NULL || dc == NULL || t->ohms == NULL || t->count < 2u || t->step_dc <= 0) {
        return BQ_E_ARG;
    }
    if (ohms > t->ohms[0]) {
        *dc = t->first_dc;
        return BQ_E_RANGE;
    }
    if (ohms < t->ohms[t->count - 1u]) {
        *dc = (int16_t)((int32_t)t->first_dc + (int32_t)t->step_dc * (t->count - 1));
        return BQ_E_RANGE;
    }
    uint16_t i = interval(t, ohms);
    uint32_t span = t->ohms[i] - t->ohms[i + 1u];
    uint32_t part = t->ohms[i] - ohms;
    while (span > 0xffffu) { /* 16 bits are plenty for a fraction, and the product below stays in 32 */
        span >>= 1;
        part >>= 1;
    }
    uint32_t step = (uint32_t)t->step_dc;
    *dc = (int16_t)((int32_t)t->first_dc + (int32_t)(step * i + (2u * step * part + span) / (2u * span)));
    return BQ_OK;
}
