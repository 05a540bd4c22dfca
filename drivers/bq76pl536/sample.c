/* SPDX-License-Identifier: Apache-2.0 */
/* The picture for the pack controller: whole or not at all. */
#include "pl536_internal.h"

static uint32_t age_ms(const bq76pl536 *d, const bq76pl536_device *dev)
{
    return (dev->flags & PL_DEV_MEASURED) != 0u ? d->now_ms - dev->t_ms : UINT32_MAX;
}

static uint16_t all_cells(const bq76pl536 *d)
{
    unsigned cells = 0;
    for (unsigned n = 1; n <= d->config.devices; n++) {
        cells += pl_cells(d, n);
    }
    return (uint16_t)cells;
}

static void fill_module(const bq76pl536 *d, const bq76pl536_device *dev, bq_module_reading *m)
{
    m->stack_mv = d->gpai_pins || dev->gpai_quality == 0u ? 0u : dev->gpai_mv;
    m->quality = d->gpai_pins ? 0u : dev->gpai_quality;
    m->age_ms = age_ms(d, dev);
    m->faults = dev->faults;
    m->cell_ov = (dev->fault & BQ76PL536_FAULT_COV) != 0u ? dev->cov : 0u;
    m->cell_uv = (dev->fault & BQ76PL536_FAULT_CUV) != 0u ? dev->cuv : 0u;
    m->open_wire = dev->open_wire;
    m->balancing = dev->cb_seen;
    m->sensor_ot = dev->alert & (BQ76PL536_ALERT_OT1 | BQ76PL536_ALERT_OT2);
}

bq_status bq76pl536_sample(bq76pl536 *d, bq_sample *s)
{
    if (d == NULL || s == NULL) {
        return BQ_E_ARG;
    }
    uint16_t temps = (uint16_t)(d->config.devices * d->config.sensors);
    if (s->cell_capacity < all_cells(d) || s->temp_capacity < temps ||
        s->module_capacity < d->config.devices) {
        return BQ_E_ARG;
    }
    if (d->sequence == 0u) {
        return BQ_E_STALE;
    }
    if (d->reading) {
        return BQ_E_BUSY;
    }
    pl_tick(d);
    bq_cell_reading *cell = s->cells;
    bq_temp_reading *temp = s->temps;
    for (unsigned n = 1; n <= d->config.devices; n++) {
        const bq76pl536_device *dev = pl_dev(d, n);
        for (unsigned i = 0; i < pl_cells(d, n); i++, cell++) {
            cell->mv = dev->cell_mv[i];
            cell->quality = dev->cell_quality[i];
            cell->module = (uint8_t)(n - 1u);
        }
        for (unsigned i = 0; i < d->config.sensors; i++, temp++) {
            temp->dc = dev->temp_dc[i];
            temp->quality = dev->temp_quality[i];
            temp->module = (uint8_t)(n - 1u);
        }
        fill_module(d, dev, &s->modules[n - 1u]);
    }
    s->cell_count = (uint16_t)(cell - s->cells);
    s->temp_count = temps;
    s->module_count = d->config.devices;
    s->sequence = d->sequence;
    s->t_us = d->start_us;
    return BQ_OK;
}
