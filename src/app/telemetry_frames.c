/* SPDX-License-Identifier: Apache-2.0 */
/* What stands in each frame; the table is in include/bqhost/telemetry.h. */
#include "bqhost/telemetry.h"
#include <string.h>

#define NO_VALUE 0xffffu
#define CELLS_A_FRAME 3u

/* The bytes 0 to 3 and 4 to 7 of a frame, the first one lowest. */
typedef struct halves {
    uint32_t low, high;
} halves;

/* Two numbers of 16 bits. */
static uint32_t pair(uint32_t first, uint32_t second)
{
    return (first & 0xffffu) | second << 16;
}

static uint32_t ones(uint32_t mask)
{
    uint32_t n = 0;

    for (; mask != 0u; mask &= mask - 1u) {
        n++;
    }
    return n;
}

static uint32_t flag(bool set, unsigned bit)
{
    return (uint32_t)set << bit;
}

static uint32_t active(const bq_telemetry_source *s)
{
    return s->app != NULL ? bq_app_pack(s->app)->faults : (uint32_t)1 << BQ_FAULT_CONFIG;
}

static uint32_t health(const bq_app *app)
{
    const bq_action *a = bq_app_action(app);
    const bq_pack_input *in = bq_app_input(app);

    return flag(a->charge_on, 0) | flag(a->discharge_on, 1) | flag(bq_app_outputs_on(app), 2) |
           flag(bq_app_pack(app)->summary.complete, 3) | flag(in->self_test == BQ_TEST_PASSED, 4) |
           flag(in->request == BQ_REQUEST_ON, 5);
}

static void heartbeat(const bq_telemetry_source *s, halves *h)
{
    uint32_t cause = (uint32_t)BQ_FAULT_CONFIG;

    h->low = (uint32_t)BQ_PACK_FAULT;
    if (s->app != NULL) {
        h->low = (uint32_t)bq_app_pack(s->app)->state | health(s->app) << 8;
        cause = (uint32_t)bq_pack_cause(bq_app_pack(s->app));
    }
    h->low |= (cause == (uint32_t)BQ_FAULT_COUNT ? 0xffu : cause) << 16 | ones(active(s)) << 24;
    h->high = s->now_ms;
}

/* In units of 10 ms, 255 = older or never measured. */
static uint32_t current_age(const bq_app *app)
{
    const bq_sample *s = bq_app_sample(app);
    const uint32_t since = bq_app_step_age_ms(app);

    if (!s->current_valid || s->current_age_ms >= 2550u || since >= 2550u - s->current_age_ms) {
        return 255;
    }
    return (s->current_age_ms + since) * 6554u >> 16; /* by 10, exact below 16389 */
}

static void faults(const bq_telemetry_source *s, halves *h)
{
    const bq_boot *b = s->boot;
    const bq_app *app = s->app;
    uint32_t modules = 0, age = 255;
    bq_status status = s->refused;

    if (app != NULL) {
        modules = bq_app_modules_found(app);
        status = bq_app_input(app)->monitor_status;
        age = current_age(app);
    }
    h->low = active(s);
    h->high = modules | (uint32_t)(uint8_t)status << 8 | age << 24;
    if (b != NULL) {
        h->high |= (uint32_t)b->cause << 16 | flag(b->crashed, 23);
    }
}

static void boot(const bq_boot *b, halves *h)
{
    if (b == NULL) {
        return;
    }
    h->low = (uint32_t)b->cause | flag(b->crashed, 8) | flag(b->crystal_failed, 9) | flag(b->image_ok, 10);
    if (b->crashed) {
        h->low |= b->crash.kind << 16;
        h->high = b->crash.pc;
    }
}

static bool event(const bq_pack *p, uint32_t number, halves *h)
{
    const bq_pack_event *e = &p->events[number % BQ_PACK_EVENTS];
    const uint32_t code = e->code, kind = e->kind;
    const bq_pack_fault_record *r;

    if ((kind != (uint32_t)BQ_EVENT_FAULT && kind != (uint32_t)BQ_EVENT_RECOVERED) ||
        code >= (uint32_t)BQ_FAULT_COUNT) {
        return false;
    }
    r = &p->fault[code];
    h->low = code | flag(kind == (uint32_t)BQ_EVENT_FAULT, 8) | (uint32_t)r->cell << 16;
    h->high = r->device | (uint32_t)r->sensor << 8 | (uint32_t)(uint8_t)r->wire << 16;
    return true;
}

static uint32_t millivolts(const bq_sample *s, uint32_t cell)
{
    if (cell >= s->cell_count || (s->cells[cell].quality & BQ_Q_VALID) == 0u) {
        return NO_VALUE;
    }
    return s->cells[cell].mv;
}

static bool voltages(const bq_sample *s, uint32_t index, halves *h)
{
    const uint32_t first = index * CELLS_A_FRAME;

    h->low = (index & 0xffu) | (s->sequence & 0xffu) << 8 | millivolts(s, first) << 16;
    h->high = pair(millivolts(s, first + 1u), millivolts(s, first + 2u));
    return first < s->cell_count;
}

static void counters(const bq_app *app, halves *h)
{
    const bq_link_stats *l = bq_app_link(app);

    h->low = bq_app_get_counters(app)->periods;
    if (l != NULL) {
        h->high = l->crc_errors + l->no_answers + l->implausible + l->bus_errors + l->write_errors;
    }
}

/* Frames that need a running loop. */
static bool of_app(const bq_app *app, bq_telemetry_id id, uint32_t index, halves *h)
{
    const bq_pack *p = bq_app_pack(app);
    const bq_pack_summary *y = &p->summary;
    const bq_sample *s = bq_app_sample(app);

    switch (id) {
    case BQ_FRAME_PACK:
        h->low = y->pack_mv;
        h->high = (uint32_t)s->current_ma;
        break;
    case BQ_FRAME_CELLS:
        h->low = pair(y->cell_min_mv, y->cell_max_mv);
        h->high = pair(y->cell_min, y->cell_max);
        break;
    case BQ_FRAME_TEMPERATURES:
        h->low = pair((uint32_t)y->temp_min_dc, (uint32_t)y->temp_max_dc);
        h->high = pair((uint32_t)y->soc_permille, y->balancing);
        break;
    case BQ_FRAME_EVENT:
        return event(p, index, h);
    case BQ_FRAME_VOLTAGES:
        return voltages(s, index, h);
    case BQ_FRAME_SAMPLE:
        h->low = s->sequence;
        h->high = s->t_us;
        break;
    default:
        counters(app, h);
        break;
    }
    return true;
}

bool bq_telemetry_frame(const bq_telemetry_source *source, bq_telemetry_id id, uint32_t index,
                        bq_can_frame *frame)
{
    halves h = {0, 0};
    bool known = true;

    if (id == BQ_FRAME_HEARTBEAT) {
        heartbeat(source, &h);
    } else if (id == BQ_FRAME_FAULTS) {
        faults(source, &h);
    } else if (id == BQ_FRAME_BOOT) {
        boot(source->boot, &h);
    } else {
        known = id < BQ_FRAME_BOOT && source->app != NULL && of_app(source->app, id, index, &h);
    }
    frame->id = BQ_TELEMETRY_ID + (uint32_t)id;
    frame->extended = false;
    frame->len = 8;
    for (unsigned i = 0; i < 8u; i++) {
        frame->data[i] = (uint8_t)h.low;
        h.low = h.low >> 8 | h.high << 24;
        h.high >>= 8;
    }
    return known;
}
