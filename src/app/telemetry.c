/* SPDX-License-Identifier: Apache-2.0 */
/* When which frame is due, and handing it to the controller. */
#include "bqhost/telemetry.h"
#include <string.h>

#define BIT(id) ((uint32_t)1 << (unsigned)(id))
#define REFUSED_PERIOD_MS 100u

#define OF_PERIOD                                                                                            \
    (BIT(BQ_FRAME_HEARTBEAT) | BIT(BQ_FRAME_PACK) | BIT(BQ_FRAME_CELLS) | BIT(BQ_FRAME_TEMPERATURES) |       \
     BIT(BQ_FRAME_FAULTS) | BIT(BQ_FRAME_COUNTERS))

void bq_telemetry_init(bq_telemetry *t, const bq_can *can)
{
    memset(t, 0, sizeof *t);
    if (can != NULL) {
        t->can = *can;
    }
}

/* ---- what is due ----------------------------------------------------------------------------- */

static uint32_t period_of(const bq_telemetry_source *s)
{
    return s->app != NULL ? s->period_ms : REFUSED_PERIOD_MS;
}

/* True once per period; the grid is kept unless a whole period was missed. */
static bool moment(uint32_t *last_ms, uint32_t now_ms, uint32_t period_ms)
{
    const uint32_t passed = now_ms - *last_ms;

    if (passed < period_ms) {
        return false;
    }
    *last_ms = passed < 2u * period_ms ? *last_ms + period_ms : now_ms;
    return true;
}

static void look_at_sample(bq_telemetry *t, const bq_sample *s)
{
    if (s->cell_count == 0u || (t->have_sample && s->sequence == t->sequence)) {
        return;
    }
    t->have_sample = true;
    t->sequence = s->sequence;
    t->index = 0;
    t->due |= BIT(BQ_FRAME_SAMPLE) | BIT(BQ_FRAME_VOLTAGES);
}

/* Moves on to the next event of a fault; those the log has lost leave a gap in the running number. */
static void look_at_events(bq_telemetry *t, const bq_telemetry_source *s)
{
    const bq_pack *pack = bq_app_pack(s->app);
    const uint32_t behind = pack->event_count - t->events;
    bq_can_frame unused;

    if (behind > BQ_PACK_EVENTS) {
        t->running = (uint8_t)(t->running + (behind - BQ_PACK_EVENTS));
        t->events = pack->event_count - BQ_PACK_EVENTS;
    }
    while (t->events != pack->event_count && !bq_telemetry_frame(s, BQ_FRAME_EVENT, t->events, &unused)) {
        t->events++;
    }
    if (t->events != pack->event_count) {
        t->due |= BIT(BQ_FRAME_EVENT);
    }
}

static void look(bq_telemetry *t, const bq_telemetry_source *s)
{
    if (!t->started) {
        t->started = true;
        t->period_ms = s->now_ms;
        t->boot_ms = s->now_ms;
        t->due = OF_PERIOD | BIT(BQ_FRAME_BOOT);
    }
    if (moment(&t->period_ms, s->now_ms, period_of(s))) {
        t->due |= OF_PERIOD;
    }
    if (moment(&t->boot_ms, s->now_ms, BQ_TELEMETRY_BOOT_MS)) {
        t->due |= BIT(BQ_FRAME_BOOT);
    }
    if (s->app != NULL) {
        look_at_sample(t, bq_app_sample(s->app));
        look_at_events(t, s);
    }
}

/* ---- sending --------------------------------------------------------------------------------- */

static uint32_t index_of(const bq_telemetry *t, bq_telemetry_id id)
{
    return id == BQ_FRAME_VOLTAGES ? t->index : t->events;
}

/* The most urgent frame that is due; what has nothing to tell is no longer due. */
static bool next_frame(bq_telemetry *t, const bq_telemetry_source *s, bq_telemetry_id *id,
                       bq_can_frame *frame)
{
    static const uint8_t order[] = {
        BQ_FRAME_BOOT,   BQ_FRAME_HEARTBEAT, BQ_FRAME_PACK,  BQ_FRAME_CELLS,  BQ_FRAME_TEMPERATURES,
        BQ_FRAME_FAULTS, BQ_FRAME_COUNTERS,  BQ_FRAME_EVENT, BQ_FRAME_SAMPLE, BQ_FRAME_VOLTAGES};

    for (uint8_t i = 0; i < sizeof order; i++) {
        *id = (bq_telemetry_id)order[i];
        if ((t->due & BIT(*id)) == 0u) {
            continue;
        }
        if (bq_telemetry_frame(s, *id, index_of(t, *id), frame)) {
            return true;
        }
        t->due &= ~BIT(*id);
    }
    return false;
}

/* The frame has left. */
static void advance(bq_telemetry *t, bq_telemetry_id id, const bq_telemetry_source *s)
{
    if (id == BQ_FRAME_VOLTAGES) {
        t->index++; /* no longer due when no cell is left */
        return;
    }
    t->due &= ~BIT(id);
    if (id == BQ_FRAME_EVENT) {
        t->events++;
        t->running++;
        look_at_events(t, s);
    }
}

static bq_status send_frame(bq_telemetry *t, bq_telemetry_id id, bq_can_frame *frame)
{
    bq_status status;

    if (id == BQ_FRAME_EVENT) {
        frame->data[7] = t->running;
    }
    status = t->can.ops->send(t->can.ctx, frame);
    if (status == BQ_OK) {
        t->sent++;
    } else if (status == BQ_E_BUSY || status == BQ_E_BUS) {
        t->busy++;
    } else {
        t->refused++;
    }
    return status;
}

static uint32_t until_due(const bq_telemetry *t, const bq_telemetry_source *s)
{
    const uint32_t period = period_of(s) - (s->now_ms - t->period_ms);
    const uint32_t boot = BQ_TELEMETRY_BOOT_MS - (s->now_ms - t->boot_ms);

    return (period < boot ? period : boot) * 1000u;
}

uint32_t bq_telemetry_step(bq_telemetry *t, const bq_telemetry_source *source)
{
    bq_telemetry_id id;
    bq_can_frame frame;

    if (t->can.ops == NULL) {
        return UINT32_MAX;
    }
    look(t, source);
    for (unsigned n = 0; n < BQ_TELEMETRY_FRAMES; n++) {
        bq_status status;
        if (!next_frame(t, source, &id, &frame)) {
            return until_due(t, source);
        }
        status = send_frame(t, id, &frame);
        if (status == BQ_E_BUSY || status == BQ_E_BUS) {
            return status == BQ_E_BUSY ? BQ_TELEMETRY_BUSY_US : BQ_TELEMETRY_OFF_US;
        }
        advance(t, id, source);
    }
    return 0;
}
