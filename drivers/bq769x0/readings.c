/* SPDX-License-Identifier: Apache-2.0 */
/* From codes to single readings (X0-SEQ-23). */
#include "x0_internal.h"

/* A dead cell or broken wire: the part itself ignores it (X0-UV-08). Accuracy is stated for 2 to 5 V only
 * (X0-ADC-09). */
void bq769x0_read_cell(const bq769x0 *d, unsigned cell, bq_cell_reading *c)
{
    unsigned code = d->code[cell], quality = d->quality;
    int32_t scaled = (int32_t)(code * d->scale) + d->scale_zero;
    uint32_t mv = scaled < 0 ? 0u : (uint32_t)scaled >> 18;
    c->mv = (uint16_t)mv;
    c->module = 0;
    if (quality == BQ_Q_VALID) {
        if ((code + 1u) >> 14 != 0u) {
            quality = BQ_Q_RANGE;
        } else if (code < BQ769X0_UV_MINQUAL) {
            quality = BQ_Q_OPEN_WIRE;
        } else if (mv - 2000u > 3000u) {
            quality |= BQ_Q_OUTSIDE;
        }
    }
    c->quality = (uint8_t)quality;
}

void bq769x0_read_temp(const bq769x0 *d, unsigned sensor, bq_temp_reading *t)
{
    unsigned code = d->code[d->known.cells + sensor] & 0x3fffu, quality = d->temp_quality;
    bool works = d->known.sensor(d->known.sensor_ctx, (uint16_t)code, &t->dc);
    t->module = 0;
    if (quality == BQ_Q_VALID) {
        if (!works) {
            quality = BQ_Q_SENSOR;
        } else if (code - 785u > 7853u - 785u) { /* X0-TS-07 */
            quality |= BQ_Q_OUTSIDE;
        }
    }
    t->quality = (uint8_t)quality;
}

void bq769x0_read(bq769x0 *d, bq769x0_reading *r)
{
    uint32_t age_ms;
    x0_tick(d);
    r->age_ms = d->now_ms - d->picture_ms + X0_SCAN_MS;
    r->events = (uint8_t)x0_events(d);
    r->balancing = d->balanced;
    r->current_ma = bq769x0_current_ma(d->cc_code, d->known.shunt_uohm);
    age_ms = d->current_seen ? d->now_ms - d->cc_ms : UINT32_MAX;
    r->current_age_ms = age_ms;
    r->current_valid =
        age_ms < 600u && (uint32_t)(d->cc_code + 31990) <= 2u * 31990u; /* saturated beyond (X0-CC-11) */
}
