/* SPDX-License-Identifier: Apache-2.0 */
/* From codes to readings: the sample (X0-SEQ-23). */
#include "x0_internal.h"
#include <string.h>

uint32_t x0_cell_mv(const bq769x0 *d, unsigned input)
{
    int32_t uv = bq769x0_cell_uv(d->achieved.trim, d->code[input]);
    uint32_t mv = uv < 0 ? 0u : ((uint32_t)uv + 500u) / 1000u;
    return (mv * d->gain2_q15 + 16384u) >> 15;
}

/* What events of SYS_STAT mean to the pack. */
uint16_t x0_flags(unsigned events)
{
    static const uint16_t flag[6] = {BQ_F_OVERCURRENT, BQ_F_SHORT, BQ_F_CELL_OV,
                                     BQ_F_CELL_UV,     BQ_F_CHAIN, BQ_F_MEMORY};
    unsigned flags = 0;
    for (unsigned i = 0; i < 6u; i++) {
        if ((events >> i & 1u) != 0u) {
            flags |= flag[i];
        }
    }
    return (uint16_t)flags;
}

static uint8_t cell_quality(const bq769x0 *d, unsigned code, unsigned mv)
{
    if (!d->valid) {
        return BQ_Q_COMM;
    }
    if (code < BQ769X0_UV_MINQUAL) {
        return BQ_Q_OPEN_WIRE; /* dead cell or broken wire: the part itself ignores it (X0-UV-08) */
    }
    if (code == 0x3fffu) {
        return BQ_Q_RANGE;
    }
    return mv < 2000u || mv > 5000u ? BQ_Q_VALID | BQ_Q_RANGE /* accuracy is not stated there (X0-ADC-09) */
                                    : BQ_Q_VALID;
}

static void fill_cells(const bq769x0 *d, bq_sample *s)
{
    bq_module_reading *m = s->modules;
    bq_cell_reading *c = s->cells;
    for (unsigned i = 0; i < d->config.inputs; i++) {
        if (((unsigned)d->in_use >> i & 1u) != 0u) {
            c->mv = (uint16_t)x0_cell_mv(d, i);
            c->module = 0;
            c->quality = cell_quality(d, d->code[i], c->mv);
            m->stack_mv += c->mv;
            if (c->quality == BQ_Q_OPEN_WIRE) {
                m->faults |= BQ_F_OPEN_WIRE;
            }
            c++;
        }
    }
}

static void fill_temp(const bq769x0 *d, bq_temp_reading *t, unsigned code)
{
    uint32_t ohms;
    bq_status st = BQ_OK;
    t->module = 0;
    t->quality = BQ_Q_VALID;
    if (d->config.sensors == 0u) {
        t->dc = bq769x0_die_dc((uint16_t)code, d->die_v25_uv);
    } else {
        st = bq769x0_ts_ohms((uint16_t)code, &ohms);
        st = st == BQ_OK ? bq_thermistor_dc(d->config.thermistor, ohms, &t->dc) : st;
    }
    if (st != BQ_OK) {
        t->quality = BQ_Q_SENSOR;
    } else if (code < 785u || code > 7853u) {
        t->quality |= BQ_Q_RANGE; /* X0-TS-07 */
    }
    if (!d->temp_valid) {
        t->quality = BQ_Q_COMM;
    }
}

static void fill_module(const bq769x0 *d, bq_module_reading *m)
{
    memset(m, 0, sizeof *m);
    m->age_ms = d->measured ? d->now_ms - d->picture_ms + X0_SCAN_MS : UINT32_MAX;
    m->faults = d->faults | x0_flags(x0_events(d));
    m->balancing = d->balanced;
    m->quality = d->valid ? BQ_Q_VALID : BQ_Q_COMM;
}

bq_status bq769x0_sample(bq769x0 *d, bq_sample *s)
{
    unsigned temps = d->config.sensors != 0u ? d->config.sensors : 1u;
    if (s == NULL || s->cell_capacity < d->config.cells || s->temp_capacity < temps ||
        s->module_capacity < 1u) {
        return BQ_E_ARG;
    }
    if (!d->measured) {
        return BQ_E_STALE;
    }
    x0_tick(d);
    fill_module(d, s->modules);
    fill_cells(d, s);
    for (unsigned i = 0; i < temps; i++) {
        fill_temp(d, &s->temps[i], d->code[X0_TS + i]);
    }
    s->cell_count = d->config.cells;
    s->temp_count = (uint16_t)temps;
    s->module_count = 1;
    s->sequence = d->sequence;
    s->t_us = d->picture_us;
    s->current_ma = bq769x0_current_ma(d->cc_code, d->config.shunt_uohm);
    s->current_age_ms = d->current_seen ? d->now_ms - d->cc_ms : UINT32_MAX;
    s->current_valid = s->current_age_ms < 600u && d->cc_code >= -31990 &&
                       d->cc_code <= 31990; /* saturated beyond (X0-CC-11) */
    return BQ_OK;
}
