/* SPDX-License-Identifier: Apache-2.0 */
/* The sample (X0-SEQ-23). */
#include "x0_internal.h"
#include <string.h>

uint32_t x0_cell_mv(const bq769x0 *d, unsigned cell)
{
    bq_cell_reading c;
    bq769x0_read_cell(d, cell, &c);
    return c.mv;
}

/* What events of SYS_STAT mean to the pack: OCD, SCD; OV, UV; ALERT; XREADY. */
static unsigned flags(unsigned events)
{
    return events << 14 | (events >> 2 & 3u) | (events & 0x10u) << 9 | (events & 0x20u) << 1;
}

#define TOPS 0x4210u /* the top input of each group, which always carries a cell */

/* Each group must supply the part with 6 to 25 V (X0-ELEC-01). */
static void fill_cells(const bq769x0 *d, bq_cell_reading *c, bq_module_reading *m)
{
    uint32_t group_mv = 0;
    unsigned tops = TOPS;
    m->quality = d->quality;
    for (unsigned in_use = d->known.in_use, n = 0; in_use != 0u; in_use >>= 1, tops >>= 1) {
        if ((in_use & 1u) != 0u) {
            bq769x0_read_cell(d, n++, c);
            if (c->quality == BQ_Q_OPEN_WIRE) {
                m->faults |= BQ_F_OPEN_WIRE;
            }
            group_mv += c->mv;
            c++;
        }
        if ((tops & 1u) != 0u) {
            if (group_mv - 6000u > 25000u - 6000u && m->quality == BQ_Q_VALID) {
                m->quality = BQ_Q_VALID | BQ_Q_OUTSIDE;
            }
            m->stack_mv += group_mv;
            group_mv = 0;
        }
    }
}

bq_status bq769x0_sample(bq769x0 *d, bq_sample *s)
{
    unsigned temps = d->config.sensors != 0u ? d->config.sensors : 1u;
    bq_module_reading *m;
    bq769x0_reading r;
    if (s == NULL || s->cell_capacity < d->known.cells || s->temp_capacity < temps ||
        s->module_capacity < 1u) {
        return BQ_E_ARG;
    }
    if (!d->measured) {
        return BQ_E_STALE;
    }
    bq769x0_read(d, &r);
    m = s->modules;
    memset(m, 0, sizeof *m);
    m->age_ms = r.age_ms;
    m->faults = (uint16_t)(d->faults | flags(r.events));
    m->balancing = r.balancing;
    fill_cells(d, s->cells, m);
    for (unsigned i = 0; i < temps; i++) {
        bq769x0_read_temp(d, i, &s->temps[i]);
    }
    s->cell_count = d->known.cells;
    s->temp_count = (uint16_t)temps;
    s->module_count = 1;
    s->sequence = d->sequence;
    s->t_us = d->now_us - (d->now_ms - d->picture_ms) * 1000u;
    s->current_ma = r.current_ma;
    s->current_age_ms = r.current_age_ms;
    s->current_valid = r.current_valid;
    return BQ_OK;
}
