/* SPDX-License-Identifier: Apache-2.0 */
/* One look at the sample: what is valid, how old it is, and the extremes that may decide. */
#include "pack_internal.h"
#include <string.h>

uint32_t bq_pack_add_ms(uint32_t a, uint32_t b)
{
    const uint32_t sum = a + b;

    return sum | (0u - (uint32_t)(sum < a));
}

/* Nothing is outside the modules, and cells are in their order. */
static bool places_ok(const bq_sample *s, bool sensor)
{
    const bq_cell_reading *r = bq_reading(s, sensor, 0);
    uint32_t least = 0;

    for (uint32_t n = sensor ? s->temp_count : s->cell_count; n > 0u; n--, r++) {
        if (r->module < least || r->module >= s->module_count) {
            return false;
        }
        least = sensor ? 0u : r->module;
    }
    return true;
}

/* The configured numbers of everything. */
static bool shape_ok(const bq_pack *p, const bq_sample *s)
{
    return s != NULL && s->cell_count == p->config.cells && s->temp_count == p->config.sensors &&
           s->module_count == p->config.modules && places_ok(s, false) && places_ok(s, true);
}

static uint32_t module_age(const bq_pack *p, const bq_sample *s, uint16_t m)
{
    const uint32_t age = bq_pack_add_ms(s->modules[m].age_ms, p->copy_age_ms);

    return age > p->sequence_age_ms ? age : p->sequence_age_ms;
}

static void advance_ages(bq_pack *p, bq_picture *v)
{
    p->copy_age_ms = v->s != NULL && v->in->sample_copied ? 0u : bq_pack_add_ms(p->copy_age_ms, v->dt_ms);
    p->sequence_age_ms = bq_pack_add_ms(p->sequence_age_ms, v->dt_ms);
    v->fresh = v->s != NULL && (!p->have_sequence || v->s->sequence != p->sequence);
    if (v->fresh) {
        p->sequence = v->s->sequence;
        p->have_sequence = true;
        p->sequence_age_ms = 0;
    }
    for (uint16_t m = 0; m < p->config.modules; m++) {
        p->blind_ms[m] = v->live ? bq_pack_add_ms(p->blind_ms[m], v->dt_ms) : 0u;
    }
}

static void mark(bq_picture *v, unsigned m, unsigned what)
{
    v->module[m] |= (uint8_t)what;
    v->any |= (uint8_t)what;
}

static void look_at_modules(const bq_pack *p, bq_picture *v)
{
    for (uint16_t m = 0; m < v->s->module_count; m++) {
        const uint32_t flags = v->s->modules[m].faults;
        unsigned what = module_age(p, v->s, m) > p->config.comm_timeout_ms ? BQ_MODULE_OLD : 0u;
        if ((flags & BQ_F_COMM) != 0u) {
            what |= BQ_MODULE_SILENT;
        }
        if ((flags & BQ_F_SUPPLY) != 0u) {
            what |= BQ_MODULE_DISCARDED | BQ_MODULE_NO_CELL;
        }
        mark(v, m, what);
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

/* Whether cell or sensor i (from 0) may decide: a valid reading that is fresh, or the last good value of one
 * that is not. What is not valid counts against its module. `seen` has a bit for each that has been valid
 * once. */
static bool decides(bq_pack *p, bq_picture *v, bool sensor, unsigned i)
{
    const bq_cell_reading *r = bq_reading(v->s, sensor, i);
    const uint32_t bit = (uint32_t)1u << (i % 32u), quality = r->quality;
    uint32_t *seen = &(sensor ? p->sensor_seen : p->cell_seen)[i / 32u];
    const unsigned m = r->module;

    if ((quality & BQ_Q_VALID) != 0u) {
        if ((v->module[m] & (BQ_MODULE_OLD | BQ_MODULE_DISCARDED)) != 0u) {
            return false;
        }
        if (!p->started) {
            *seen |= bit;
        }
        return true;
    }
    if ((quality & BQ_Q_OPEN_WIRE) != 0u && v->open_cell == 0u && !sensor) {
        v->open_cell = (uint16_t)(i + 1u);
    }
    mark(v, m,
         (quality & BQ_Q_COMM) != 0u ? BQ_MODULE_SILENT
         : sensor                    ? BQ_MODULE_NO_TEMP
                                     : BQ_MODULE_NO_CELL);
    return (*seen & bit) != 0u && p->blind_ms[m] <= p->config.comm_timeout_ms &&
           (v->module[m] & BQ_MODULE_DISCARDED) == 0u;
}

/* The longest loop of a step: what it collects stays in registers, and where nothing is wrong with any module
 * a valid cell simply counts. */
static void look_at_cells(bq_pack *p, bq_picture *v)
{
    const bool untrusted = (v->any & (BQ_MODULE_OLD | BQ_MODULE_DISCARDED)) != 0u;
    const uint32_t plain = p->started && !untrusted ? BQ_Q_VALID : 0u;
    bq_pack_summary *y = &p->summary;
    const uint16_t count = v->s->cell_count;
    const bq_cell_reading *c = v->s->cells;
    uint32_t sum = 0, highest = 0, lowest = UINT32_MAX, at_highest = 0, at_lowest = 0;

    for (uint32_t i = 0; i < count; i++, c++) {
        const uint32_t mv = c->mv;
        if ((c->quality & plain) == 0u && !decides(p, v, false, i)) {
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

static void look_at_sensors(bq_pack *p, bq_picture *v)
{
    for (uint16_t i = 0; i < v->s->temp_count; i++) {
        if (decides(p, v, true, i)) {
            take_sensor(&p->summary, (uint16_t)(i + 1u), v->s->temps[i].dc);
        }
    }
}

/* A module with only valid readings is as blind as they are old. Complete = that, and fresh, everywhere. */
static void update_blindness(bq_pack *p, const bq_picture *v)
{
    bq_pack_summary *y = &p->summary;

    y->complete = v->s != NULL && (v->any & (uint8_t)~BQ_MODULE_DISCARDED) == 0u &&
                  (v->current_known || !bq_pack_limits_current(&p->config));
    if (y->complete && v->in->monitor == BQ_MONITOR_UP) {
        p->started = true;
    }
    for (uint16_t m = 0; m < p->config.modules; m++) {
        uint32_t blind = p->blind_ms[m];
        if (v->s != NULL && v->live &&
            (v->module[m] & (BQ_MODULE_SILENT | BQ_MODULE_NO_CELL | BQ_MODULE_NO_TEMP)) == 0u) {
            const uint32_t age = module_age(p, v->s, m);
            /* until the first complete picture the time since the monitor is up counts */
            blind = p->started || age < blind ? age : blind;
            p->blind_ms[m] = blind;
        }
        if (blind > y->blind_ms) {
            y->blind_ms = blind;
        }
    }
}

void bq_pack_look(bq_pack *p, const bq_sample *s, bq_picture *v)
{
    memset(&p->summary, 0, sizeof p->summary);
    v->live = p->started || v->in->monitor == BQ_MONITOR_UP;
    v->s = shape_ok(p, s) ? s : NULL;
    advance_ages(p, v);
    if (v->s != NULL) {
        look_at_modules(p, v);
        look_at_cells(p, v);
        look_at_sensors(p, v);
        v->current_known = s->current_valid &&
                           bq_pack_add_ms(s->current_age_ms, p->copy_age_ms) <= p->config.comm_timeout_ms;
    }
    update_blindness(p, v);
}
