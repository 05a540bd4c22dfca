/* SPDX-License-Identifier: Apache-2.0 */
/* What stands in each frame; the table is in include/bqhost/telemetry.h. */
#include "bqhost/telemetry.h"
#include <string.h>

#define NO_VALUE 0xffffu
#define CELLS_A_FRAME 3u

static void put16(uint8_t *at, uint32_t value)
{
    at[0] = (uint8_t)value;
    at[1] = (uint8_t)(value >> 8);
}

static void put32(uint8_t *at, uint32_t value)
{
    put16(at, value);
    put16(at + 2, value >> 16);
}

static uint8_t ones(uint32_t mask)
{
    uint8_t n = 0;

    for (; mask != 0u; mask &= mask - 1u) {
        n++;
    }
    return n;
}

static uint8_t flag(bool set, unsigned bit)
{
    return (uint8_t)((set ? 1u : 0u) << bit);
}

static uint32_t active(const bq_telemetry_source *s)
{
    return s->app != NULL ? bq_app_pack(s->app)->faults : (uint32_t)1 << BQ_FAULT_CONFIG;
}

static uint8_t health(const bq_app *app)
{
    const bq_action *a = bq_app_action(app);
    const bq_pack_input *in = bq_app_input(app);

    return (uint8_t)(flag(a->charge_on, 0) | flag(a->discharge_on, 1) | flag(bq_app_outputs_on(app), 2) |
                     flag(bq_app_pack(app)->summary.complete, 3) | flag(in->self_test == BQ_TEST_PASSED, 4) |
                     flag(in->request == BQ_REQUEST_ON, 5));
}

static void heartbeat(const bq_telemetry_source *s, uint8_t *d)
{
    bq_pack_fault cause = BQ_FAULT_CONFIG;

    d[0] = (uint8_t)BQ_PACK_FAULT;
    if (s->app != NULL) {
        d[0] = (uint8_t)bq_app_pack(s->app)->state;
        d[1] = health(s->app);
        cause = bq_pack_cause(bq_app_pack(s->app));
    }
    d[2] = cause == BQ_FAULT_COUNT ? (uint8_t)0xff : (uint8_t)cause;
    d[3] = ones(active(s));
    put32(d + 4, s->now_ms);
}

static void pack(const bq_app *app, uint8_t *d)
{
    put32(d, bq_app_pack(app)->summary.pack_mv);
    put32(d + 4, (uint32_t)bq_app_sample(app)->current_ma);
}

static void cells(const bq_pack_summary *y, uint8_t *d)
{
    put16(d, y->cell_min_mv);
    put16(d + 2, y->cell_max_mv);
    put16(d + 4, y->cell_min);
    put16(d + 6, y->cell_max);
}

static void temperatures(const bq_pack_summary *y, uint8_t *d)
{
    put16(d, (uint32_t)y->temp_min_dc);
    put16(d + 2, (uint32_t)y->temp_max_dc);
    put16(d + 4, (uint32_t)y->soc_permille);
    put16(d + 6, y->balancing);
}

/* In units of 10 ms, 255 = older. */
static uint8_t current_age(const bq_app *app)
{
    const bq_sample *s = bq_app_sample(app);
    const uint32_t since = bq_app_step_age_ms(app);

    if (!s->current_valid || s->current_age_ms >= 2550u || since >= 2550u - s->current_age_ms) {
        return 255;
    }
    return (uint8_t)((s->current_age_ms + since) / 10u);
}

static void faults(const bq_telemetry_source *s, uint8_t *d)
{
    const bq_boot *b = s->boot;

    put32(d, active(s));
    d[4] = s->app != NULL ? bq_app_modules_found(s->app) : (uint8_t)0;
    d[5] = (uint8_t)(s->app != NULL ? bq_app_input(s->app)->monitor_status : s->refused);
    d[6] = b != NULL ? (uint8_t)((unsigned)b->cause | flag(b->crashed, 7)) : (uint8_t)0;
    d[7] = s->app != NULL ? current_age(s->app) : (uint8_t)255;
}

static bool event(const bq_pack *p, uint32_t number, uint8_t *d)
{
    const bq_pack_event *e = &p->events[number % BQ_PACK_EVENTS];
    const bq_pack_fault_record *r;

    if ((e->kind != (uint8_t)BQ_EVENT_FAULT && e->kind != (uint8_t)BQ_EVENT_RECOVERED) ||
        e->code >= (uint8_t)BQ_FAULT_COUNT) {
        return false;
    }
    r = &p->fault[e->code];
    d[0] = e->code;
    d[1] = e->kind == (uint8_t)BQ_EVENT_FAULT ? (uint8_t)1 : (uint8_t)0;
    put16(d + 2, r->cell);
    d[4] = r->device;
    d[5] = r->sensor;
    d[6] = (uint8_t)r->wire;
    return true;
}

static uint16_t value(const bq_sample *s, uint32_t cell)
{
    if (cell >= s->cell_count || (s->cells[cell].quality & BQ_Q_VALID) == 0u) {
        return NO_VALUE;
    }
    return s->cells[cell].mv;
}

static bool voltages(const bq_sample *s, uint32_t index, uint8_t *d)
{
    const uint32_t first = index * CELLS_A_FRAME;

    if (first >= s->cell_count) {
        return false;
    }
    d[0] = (uint8_t)index;
    d[1] = (uint8_t)s->sequence;
    for (uint32_t i = 0; i < CELLS_A_FRAME; i++) {
        put16(d + 2u + 2u * i, value(s, first + i));
    }
    return true;
}

static void sample(const bq_sample *s, uint8_t *d)
{
    put32(d, s->sequence);
    put32(d + 4, s->t_us);
}

static void counters(const bq_app *app, uint8_t *d)
{
    const bq_link_stats *l = bq_app_link(app);

    put32(d, bq_app_get_counters(app)->periods);
    if (l != NULL) {
        put32(d + 4, l->crc_errors + l->no_answers + l->implausible + l->bus_errors + l->write_errors);
    }
}

static void boot(const bq_boot *b, uint8_t *d)
{
    if (b == NULL) {
        return;
    }
    d[0] = (uint8_t)b->cause;
    d[1] = (uint8_t)(flag(b->crashed, 0) | flag(b->crystal_failed, 1) | flag(b->image_ok, 2));
    if (b->crashed) {
        put16(d + 2, b->crash.kind);
        put32(d + 4, b->crash.pc);
    }
}

/* Frames that need a running loop. */
static bool of_app(const bq_app *app, bq_telemetry_id id, uint32_t index, uint8_t *d)
{
    switch (id) {
    case BQ_FRAME_PACK:
        pack(app, d);
        return true;
    case BQ_FRAME_CELLS:
        cells(&bq_app_pack(app)->summary, d);
        return true;
    case BQ_FRAME_TEMPERATURES:
        temperatures(&bq_app_pack(app)->summary, d);
        return true;
    case BQ_FRAME_EVENT:
        return event(bq_app_pack(app), index, d);
    case BQ_FRAME_VOLTAGES:
        return voltages(bq_app_sample(app), index, d);
    case BQ_FRAME_SAMPLE:
        sample(bq_app_sample(app), d);
        return true;
    case BQ_FRAME_COUNTERS:
        counters(app, d);
        return true;
    default:
        return false;
    }
}

bool bq_telemetry_frame(const bq_telemetry_source *source, bq_telemetry_id id, uint32_t index,
                        bq_can_frame *frame)
{
    memset(frame, 0, sizeof *frame);
    frame->id = BQ_TELEMETRY_ID + (uint32_t)id;
    frame->len = 8;
    switch (id) {
    case BQ_FRAME_HEARTBEAT:
        heartbeat(source, frame->data);
        return true;
    case BQ_FRAME_FAULTS:
        faults(source, frame->data);
        return true;
    case BQ_FRAME_BOOT:
        boot(source->boot, frame->data);
        return true;
    default:
        return source->app != NULL && of_app(source->app, id, index, frame->data);
    }
}
