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

/* Whether cell or sensor i (from 0), that is `r`, may decide: a valid reading that is fresh, or the last good
 * value of one that is not. What is not valid counts against its module. `seen` has a bit for each that has
 * been valid once. */
static bool decides(bq_pack *p, bq_picture *v, bool sensor, unsigned i, const bq_cell_reading *r)
{
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

#define NUMBER 511u
#if BQ_PACK_MAX_CELLS >= NUMBER || BQ_PACK_MAX_SENSORS >= NUMBER
#error "a number does not fit beside its value"
#endif

/* Sum and extremes of what decides. The longest loop of a step: where nothing is wrong with any module a
 * valid reading simply counts, and an extreme is one word, value << 9 | number from 1, of the highest with
 * the number inverted, so that of equals the first one is taken. Temperatures are turned into unsigned
 * values. */
static void look_at_readings(bq_pack *p, bq_picture *v, bool sensor)
{
    const bool untrusted = (v->any & (BQ_MODULE_OLD | BQ_MODULE_DISCARDED)) != 0u;
    const uint32_t plain = p->started && !untrusted ? BQ_Q_VALID : 0u;
    const uint32_t count = sensor ? v->s->temp_count : v->s->cell_count, turn = sensor ? 0x8000u : 0u;
    const bq_cell_reading *r = bq_reading(v->s, sensor, 0);
    bq_pack_summary *y = &p->summary;
    uint32_t sum = 0, lowest = UINT32_MAX, highest = 0;

    for (uint32_t i = 0; i < count; i++, r++) {
        const uint32_t value = r->mv ^ turn, word = value << 9 | (i + 1u);
        if ((r->quality & plain) == 0u && !decides(p, v, sensor, i, r)) {
            continue;
        }
        sum += value;
        lowest = word < lowest ? word : lowest;
        highest = (word ^ NUMBER) > highest ? word ^ NUMBER : highest;
    }
    if (highest == 0u) {
        return;
    }
    if (sensor) {
        y->temp_min_dc = (int16_t)((int32_t)(lowest >> 9) - 0x8000);
        y->temp_min = (uint8_t)(lowest & NUMBER);
        y->temp_max_dc = (int16_t)((int32_t)(highest >> 9) - 0x8000);
        y->temp_max = (uint8_t)(~highest & NUMBER);
    } else {
        y->pack_mv = sum;
        y->cell_min_mv = (uint16_t)(lowest >> 9);
        y->cell_min = (uint16_t)(lowest & NUMBER);
        y->cell_max_mv = (uint16_t)(highest >> 9);
        y->cell_max = (uint16_t)(~highest & NUMBER);
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
        look_at_readings(p, v, false);
        look_at_readings(p, v, true);
        v->current_known = s->current_valid &&
                           bq_pack_add_ms(s->current_age_ms, p->copy_age_ms) <= p->config.comm_timeout_ms;
    }
    update_blindness(p, v);
}
