/* SPDX-License-Identifier: Apache-2.0 */
/* The sample (X0-SEQ-23). */
#include "x0_internal.h"
#include <string.h>

/* What events of SYS_STAT mean to the pack: OCD, SCD; OV, UV; ALERT; XREADY. */
uint16_t x0_flags(unsigned events)
{
    return (uint16_t)((events & 0x03u) * BQ_F_OVERCURRENT |
                      (events & 0x0cu) / BQ769X0_STAT_OV * BQ_F_CELL_OV |
                      (events & 0x10u) / BQ769X0_STAT_OVRD_ALERT * BQ_F_CHAIN |
                      (events & 0x20u) / BQ769X0_STAT_XREADY * BQ_F_MEMORY);
}

#define TOPS 0x4210u /* the top input of each group, which always carries a cell */

/* Each group must supply the part with 6 to 25 V (X0-ELEC-01). */
static void fill_cells(const bq769x0 *d, bq_cell_reading *c, bq_module_reading *m)
{
    uint32_t group_mv = 0;
    bool outside = false;
    for (unsigned i = 0; i < BQ769X0_INPUTS; i++) {
        if ((d->in_use >> i & 1u) != 0u) {
            x0_read_cell(d, c, i);
            if (c->quality == BQ_Q_OPEN_WIRE) {
                m->faults |= BQ_F_OPEN_WIRE;
            }
            group_mv += c->mv;
            c++;
            if ((TOPS >> i & 1u) != 0u) {
                outside |= group_mv - 6000u > 25000u - 6000u;
                m->stack_mv += group_mv;
                group_mv = 0;
            }
        }
    }
    m->quality = x0_quality(d, d->valid, 0, outside);
}

static void fill_module(const bq769x0 *d, bq_module_reading *m)
{
    memset(m, 0, sizeof *m);
    m->age_ms = d->now_ms - d->picture_ms + X0_SCAN_MS;
    m->faults = d->faults | x0_flags(x0_events(d));
    m->balancing = d->balanced;
}

bq_status bq769x0_sample(bq769x0 *d, bq_sample *s)
{
    if (s == NULL || s->cell_capacity < d->cells || s->temp_capacity < d->temps || s->module_capacity < 1u) {
        return BQ_E_ARG;
    }
    if (!d->measured) {
        return BQ_E_STALE;
    }
    x0_tick(d);
    fill_module(d, s->modules);
    fill_cells(d, s->cells, s->modules);
    for (unsigned i = 0; i < d->temps; i++) {
        x0_read_temp(d, &s->temps[i], d->code[X0_TS + i]);
    }
    s->cell_count = d->cells;
    s->temp_count = d->temps;
    s->module_count = 1;
    s->sequence = d->sequence;
    s->t_us = d->picture_us;
    s->current_ma = bq769x0_current_ma(d->cc_code, d->config.shunt_uohm);
    s->current_age_ms = d->current_seen ? d->now_ms - d->cc_ms : UINT32_MAX;
    s->current_valid = s->current_age_ms < 600u && d->cc_code >= -31990 &&
                       d->cc_code <= 31990; /* saturated beyond (X0-CC-11) */
    return BQ_OK;
}
