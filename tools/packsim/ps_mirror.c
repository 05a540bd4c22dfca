/* SPDX-License-Identifier: Apache-2.0 */
#include "ps_mirror.h"

#include <string.h>

#define CELLS_A_FRAME 3
#define NO_VALUE 0xffffu

static uint32_t get16(const uint8_t *d)
{
    return (uint32_t)d[0] | (uint32_t)d[1] << 8;
}

static uint32_t get32(const uint8_t *d)
{
    return get16(d) | get16(d + 2) << 16;
}

static int16_t get_i16(const uint8_t *d)
{
    uint32_t value = get16(d);
    return (int16_t)(value < 0x8000u ? (int32_t)value : (int32_t)value - 0x10000);
}

static int32_t get_i32(const uint8_t *d)
{
    int64_t value = get32(d);
    return (int32_t)(value < 0x80000000ll ? value : value - 0x100000000ll);
}

/* ---- life ------------------------------------------------------------------------------------- */

static uint8_t module_of(const ps_rig *r, int cell)
{
    int module = 0;
    while (r->s->part == NULL && cell >= r->s->cells_of[module]) {
        cell -= r->s->cells_of[module++];
    }
    return (uint8_t)module;
}

void ps_mirror_begin(ps_mirror *m, ps_rig *r)
{
    ps_firmware *f = &r->fw;
    bq_app *app = &f->firmware.app;
    memset(m, 0, sizeof *m);
    memset(f, 0, sizeof *f);
    app->config = r->s->app;
    app->pack.config = r->s->app.pack;
    app->pack.state = BQ_PACK_INIT;
    app->pack.summary.soc_permille = -1;
    app->sample = (bq_sample){.cells = f->cells, .temps = f->temps, .modules = f->modules};
    app->sample.cell_capacity = SIM_CELLS_MAX;
    app->sample.temp_capacity = SIM_CELLS_MODULES * SIM_CELLS_SENSORS;
    app->sample.module_capacity = SIM_CELLS_MODULES;
    for (int i = 0; i < r->s->cells; i++) {
        f->cells[i].module = module_of(r, i);
    }
}

/* ---- frames of the period --------------------------------------------------------------------- */

static void heartbeat(ps_mirror *m, ps_rig *r, const uint8_t *d)
{
    bq_app *app = &r->fw.firmware.app;
    m->alive = true;
    m->uptime_ms = get32(d + 4);
    app->pack.state = (bq_pack_state_id)d[0];
    app->action.charge_on = (d[1] & 1u) != 0u;
    app->action.discharge_on = (d[1] & 2u) != 0u;
    app->line_on = (d[1] & 4u) != 0u;
    app->pack.summary.complete = (d[1] & 8u) != 0u;
}

static void pack(ps_mirror *m, ps_rig *r, const uint8_t *d)
{
    bq_app *app = &r->fw.firmware.app;
    (void)m;
    app->pack.summary.pack_mv = get32(d);
    app->sample.current_ma = get_i32(d + 4);
}

static void cells(ps_mirror *m, ps_rig *r, const uint8_t *d)
{
    bq_pack_summary *y = &r->fw.firmware.app.pack.summary;
    (void)m;
    y->cell_min_mv = (uint16_t)get16(d);
    y->cell_max_mv = (uint16_t)get16(d + 2);
    y->cell_min = (uint16_t)get16(d + 4);
    y->cell_max = (uint16_t)get16(d + 6);
}

/* Of the sensors only the extremes are told. */
static void temperatures(ps_mirror *m, ps_rig *r, const uint8_t *d)
{
    bq_app *app = &r->fw.firmware.app;
    bq_pack_summary *y = &app->pack.summary;
    (void)m;
    y->temp_min_dc = get_i16(d);
    y->temp_max_dc = get_i16(d + 2);
    y->soc_permille = get_i16(d + 4);
    y->balancing = (uint16_t)get16(d + 6);
    app->sample.temp_count = 2;
    r->fw.temps[0] = (bq_temp_reading){y->temp_min_dc, BQ_Q_VALID, 0};
    r->fw.temps[1] = (bq_temp_reading){y->temp_max_dc, BQ_Q_VALID, 0};
}

/* The event that names the cell follows its table. One that never comes was lost: the table counts. */
static void faults(ps_mirror *m, ps_rig *r, const uint8_t *d)
{
    bq_app *app = &r->fw.firmware.app;
    uint32_t active = get32(d), before = app->pack.faults;
    m->found = d[4];
    app->sample.current_valid = d[7] != 255u;
    app->pack.faults = (before & active) | (m->told & active);
    m->told = active & ~before;
}

static void event(ps_mirror *m, ps_rig *r, const uint8_t *d)
{
    bq_pack *p = &r->fw.firmware.app.pack;
    if (d[0] >= BQ_FAULT_COUNT) {
        m->unknown++;
        return;
    }
    bq_pack_fault_record *f = &p->fault[d[0]];
    uint32_t bit = 1u << d[0];
    f->active = d[1] != 0u;
    f->cell = (uint16_t)get16(d + 2);
    f->device = d[4];
    f->sensor = d[5];
    f->wire = (int8_t)d[6];
    p->faults = f->active ? p->faults | bit : p->faults & ~bit;
    m->told &= ~bit;
}

static void counters(ps_mirror *m, ps_rig *r, const uint8_t *d)
{
    (void)r;
    m->periods = get32(d);
    m->stats.bus_errors = get32(d + 4);
}

static void boot(ps_mirror *m, ps_rig *r, const uint8_t *d)
{
    (void)m;
    r->boot.cause = (bq_reset_cause)d[0];
    r->boot.crashed = (d[1] & 1u) != 0u;
    r->boot.crystal_failed = (d[1] & 2u) != 0u;
    r->boot.image_ok = (d[1] & 4u) != 0u;
}

/* ---- samples ---------------------------------------------------------------------------------- */

static void sample(ps_mirror *m, ps_rig *r, const uint8_t *d, uint32_t clock_us)
{
    m->sequence = get32(d);
    m->t_us = (uint32_t)(ps_rig_now(r) / 1000u) - (clock_us - get32(d + 4));
    m->frames = 0;
}

/* Ages are not told: of a picture that is not complete nobody knows which part is old. */
static void publish(const ps_mirror *m, ps_rig *r)
{
    bq_app *app = &r->fw.firmware.app;
    bq_sample *s = &app->sample;
    for (int i = 0; i < r->s->cells; i++) {
        bool valid = m->mv[i] != NO_VALUE;
        r->fw.cells[i].quality = valid ? BQ_Q_VALID : 0u;
        r->fw.cells[i].mv = valid ? m->mv[i] : r->fw.cells[i].mv;
    }
    for (int k = 0; k < r->s->devices; k++) {
        r->fw.modules[k].age_ms = app->pack.summary.complete ? 0u : UINT32_MAX;
    }
    s->cell_count = (uint16_t)r->s->cells;
    s->module_count = (uint16_t)r->s->devices;
    s->t_us = m->t_us;
    s->sequence = m->sequence;
}

static void voltages(ps_mirror *m, ps_rig *r, const uint8_t *d)
{
    int first = d[0] * CELLS_A_FRAME;
    if (d[0] != m->frames || d[1] != (uint8_t)m->sequence || first >= r->s->cells) {
        m->unknown++;
        return;
    }
    m->frames++;
    for (int i = 0; i < CELLS_A_FRAME && first + i < r->s->cells; i++) {
        m->mv[first + i] = (uint16_t)get16(d + 2 + 2 * i);
    }
    if (first + CELLS_A_FRAME < r->s->cells) {
        return;
    }
    publish(m, r);
}

void ps_mirror_hear(ps_mirror *m, ps_rig *r, uint32_t id, const uint8_t data[8], uint32_t clock_us)
{
    static void (*const kinds[])(ps_mirror *, ps_rig *, const uint8_t *) = {
        [BQ_FRAME_HEARTBEAT] = heartbeat,       [BQ_FRAME_PACK] = pack,         [BQ_FRAME_CELLS] = cells,
        [BQ_FRAME_TEMPERATURES] = temperatures, [BQ_FRAME_FAULTS] = faults,     [BQ_FRAME_EVENT] = event,
        [BQ_FRAME_VOLTAGES] = voltages,         [BQ_FRAME_COUNTERS] = counters, [BQ_FRAME_BOOT] = boot,
    };
    uint32_t kind = id - BQ_TELEMETRY_ID;
    m->heard++;
    if (id >= BQ_TELEMETRY_ID && kind == BQ_FRAME_SAMPLE) {
        sample(m, r, data, clock_us);
        return;
    }
    if (id < BQ_TELEMETRY_ID || kind >= sizeof kinds / sizeof kinds[0]) {
        m->unknown++;
        return;
    }
    kinds[kind](m, r, data);
}
