/* SPDX-License-Identifier: Apache-2.0 */
/* One look at the sample: what is valid, how old it is, and the extremes that may decide. */
#include "pack_internal.h"
#include <string.h>

#define BIT(m) ((uint64_t)1 << (m))

uint32_t bq_pack_add_ms(uint32_t a, uint32_t b)
{
    return b > UINT32_MAX - a ? UINT32_MAX : a + b;
}

static bool seen(const uint32_t *mask, uint16_t n)
{
    return ((mask[n / 32u] >> (n % 32u)) & 1u) != 0u;
}

static void set_seen(uint32_t *mask, uint16_t n)
{
    mask[n / 32u] |= (uint32_t)1u << (n % 32u);
}

/* The configured numbers of everything; cells in the order of their modules, nothing outside these. */
static bool shape_ok(const bq_pack *p, const bq_sample *s)
{
    uint32_t module = 0;

    if (s == NULL || s->cell_count != p->config.cells || s->temp_count != p->config.sensors ||
        s->module_count != p->config.modules) {
        return false;
    }
    for (const bq_cell_reading *c = s->cells, *end = c + s->cell_count; c != end; c++) {
        if (c->module < module) {
            return false;
        }
        module = c->module;
    }
    if (module >= s->module_count) {
        return false;
    }
    for (uint16_t i = 0; i < s->temp_count; i++) {
        if (s->temps[i].module >= s->module_count) {
            return false;
        }
    }
    return true;
}

static uint32_t module_age(const bq_pack *p, const bq_sample *s, uint16_t m)
{
    const uint32_t age = bq_pack_add_ms(s->modules[m].age_ms, p->copy_age_ms);

    return age > p->sequence_age_ms ? age : p->sequence_age_ms;
}

static void advance_ages(bq_pack *p, const bq_sample *s, const bq_pack_input *in, uint32_t dt_ms,
                         bq_picture *v)
{
    p->copy_age_ms = s != NULL && in->sample_copied ? 0u : bq_pack_add_ms(p->copy_age_ms, dt_ms);
    v->fresh = s != NULL && (!p->have_sequence || s->sequence != p->sequence);
    if (v->fresh) {
        p->sequence = s->sequence;
        p->have_sequence = true;
        p->sequence_age_ms = 0;
    } else {
        p->sequence_age_ms = bq_pack_add_ms(p->sequence_age_ms, dt_ms);
    }
    for (uint16_t m = 0; m < p->config.modules; m++) {
        p->blind_ms[m] = v->live ? bq_pack_add_ms(p->blind_ms[m], dt_ms) : 0u;
    }
}

static void look_at_modules(const bq_pack *p, bq_picture *v)
{
    for (uint16_t m = 0; m < v->s->module_count; m++) {
        const bq_module_reading *r = &v->s->modules[m];
        if (module_age(p, v->s, m) > p->config.comm_timeout_ms) {
            v->old |= BIT(m);
        }
        if ((r->faults & BQ_F_COMM) != 0u) {
            v->silent |= BIT(m);
        }
        if ((r->faults & BQ_F_SUPPLY) != 0u) {
            v->discarded |= BIT(m);
            v->no_cell |= BIT(m);
        }
    }
}

static void take_sensor(bq_pack_summary *y, uint16_t number, int16_t dc)
{
    if (y->temp_max == 0u || dc > y->temp_max_dc) {
        y->temp_max_dc = dc;
        y->temp_max = (uint8_t)number;
    }
    if (y->temp_min == 0u || dc < y->temp_min_dc) {
        y->temp_min_dc = dc;
        y->temp_min = (uint8_t)number;
    }
}

/* Whether a reading that is not valid may still decide with its last good value. */
static bool stands(const bq_pack *p, const bq_picture *v, uint16_t m)
{
    return p->blind_ms[m] <= p->config.comm_timeout_ms && (v->discarded & BIT(m)) == 0u;
}

/* Counts what kind of invalid reading this is against its module. */
static void blame(bq_picture *v, uint64_t *kind, uint8_t quality, uint16_t m)
{
    if ((quality & BQ_Q_COMM) != 0u) {
        v->silent |= BIT(m);
    } else {
        *kind |= BIT(m);
    }
}

/* A reading that is not valid: what it says about its module, and whether its last good value still counts.
 */
static bool invalid_cell_counts(const bq_pack *p, bq_picture *v, uint16_t i)
{
    const bq_cell_reading *c = &v->s->cells[i];

    blame(v, &v->no_cell, c->quality, c->module);
    if ((c->quality & BQ_Q_OPEN_WIRE) != 0u && v->open_cell == 0u) {
        v->open_cell = (uint16_t)(i + 1u);
    }
    return seen(p->cell_seen, i) && stands(p, v, c->module);
}

static bool valid_cell_counts(bq_pack *p, uint64_t untrusted, const bq_cell_reading *c, uint16_t i)
{
    if (untrusted != 0u && (untrusted & BIT(c->module)) != 0u) {
        return false;
    }
    if (!p->started) {
        set_seen(p->cell_seen, i);
    }
    return true;
}

/* The longest loop of a step: what it collects stays in registers. */
static void look_at_cells(bq_pack *p, bq_picture *v, bq_pack_summary *y)
{
    const uint64_t untrusted = v->old | v->discarded;
    const bool plain = untrusted == 0u && p->started;
    const uint16_t count = v->s->cell_count;
    const bq_cell_reading *c = v->s->cells;
    uint32_t sum = 0, highest = 0, lowest = UINT32_MAX, at_highest = 0, at_lowest = 0;

    for (uint32_t i = 0; i < count; i++, c++) {
        const uint32_t mv = c->mv;
        if ((c->quality & BQ_Q_VALID) == 0u) {
            if (!invalid_cell_counts(p, v, (uint16_t)i)) {
                continue;
            }
        } else if (!plain && !valid_cell_counts(p, untrusted, c, (uint16_t)i)) {
            continue;
        }
        sum += mv;
        if (mv > highest || at_highest == 0u) {
            highest = mv;
            at_highest = i + 1u;
        }
        if (mv < lowest) {
            lowest = mv;
            at_lowest = i + 1u;
        }
    }
    y->pack_mv = sum;
    y->cell_max_mv = (uint16_t)highest;
    y->cell_max = (uint16_t)at_highest;
    y->cell_min_mv = at_lowest == 0u ? (uint16_t)0 : (uint16_t)lowest;
    y->cell_min = (uint16_t)at_lowest;
}

static void look_at_sensors(bq_pack *p, bq_picture *v, bq_pack_summary *y)
{
    const uint64_t untrusted = v->old | v->discarded;

    for (uint16_t i = 0; i < v->s->temp_count; i++) {
        const bq_temp_reading *t = &v->s->temps[i];
        const bool valid = (t->quality & BQ_Q_VALID) != 0u;
        if (valid) {
            if ((untrusted & BIT(t->module)) != 0u) {
                continue;
            }
            if (!p->started) {
                set_seen(p->sensor_seen, i);
            }
        } else {
            blame(v, &v->no_temp, t->quality, t->module);
            if (!seen(p->sensor_seen, i) || !stands(p, v, t->module)) {
                continue;
            }
        }
        take_sensor(y, (uint16_t)(i + 1u), t->dc);
    }
}

/* A module with only valid readings is as blind as they are old. Complete = that, and fresh, everywhere. */
static void update_blindness(bq_pack *p, const bq_picture *v, const bq_pack_input *in, bq_pack_summary *y)
{
    const uint64_t bad = v->silent | v->no_cell | v->no_temp;

    y->complete = v->s != NULL && (bad | v->old) == 0u;
    p->started = p->started || (y->complete && in->monitor == BQ_MONITOR_UP);
    for (uint16_t m = 0; m < p->config.modules; m++) {
        if (v->s != NULL && v->live && (bad & BIT(m)) == 0u) {
            const uint32_t age = module_age(p, v->s, m);
            /* until the first complete picture the time since the monitor is up counts */
            p->blind_ms[m] = p->started || age < p->blind_ms[m] ? age : p->blind_ms[m];
        }
        if (p->blind_ms[m] > y->blind_ms) {
            y->blind_ms = p->blind_ms[m];
        }
    }
}

void bq_pack_look(bq_pack *p, const bq_sample *s, const bq_pack_input *in, uint32_t dt_ms, bq_picture *v)
{
    bq_pack_summary y;

    memset(v, 0, sizeof *v);
    memset(&y, 0, sizeof y);
    v->live = p->started || in->monitor == BQ_MONITOR_UP;
    v->s = shape_ok(p, s) ? s : NULL;
    advance_ages(p, v->s, in, dt_ms, v);
    if (v->s != NULL) {
        look_at_modules(p, v);
        look_at_cells(p, v, &y);
        look_at_sensors(p, v, &y);
        v->current_known = s->current_valid &&
                           bq_pack_add_ms(s->current_age_ms, p->copy_age_ms) <= p->config.comm_timeout_ms;
    }
    update_blindness(p, v, in, &y);
    p->summary = y;
}
