/* SPDX-License-Identifier: Apache-2.0 */
/* The faults: their names, what they forbid, their order, and the way each becomes active and clears. */
#include "bqhost/text.h"
#include "pack_internal.h"

/* In the order of bq_pack_fault. */
static const char names[] = "cell_ov\0cell_uv\0overtemp\0undertemp\0imbalance\0comm_loss\0"
                            "chip\0chip_cell_ov\0chip_cell_uv\0chip_overtemp\0open_wire\0sensor\0"
                            "self_test\0config\0contactor\0no_reading\0overcurrent\0"
                            "charge_overcurrent\0?";

/* Shown first: loss of protection, then hazards of the cells, then loss of information. */
static const uint8_t order[BQ_FAULT_COUNT] = {
    BQ_FAULT_CHIP,         BQ_FAULT_CONTACTOR,  BQ_FAULT_OVERCURRENT,   BQ_FAULT_CHARGE_CURRENT,
    BQ_FAULT_CHIP_CELL_OV, BQ_FAULT_CELL_OV,    BQ_FAULT_CHIP_OVERTEMP, BQ_FAULT_OVERTEMP,
    BQ_FAULT_CHIP_CELL_UV, BQ_FAULT_CELL_UV,    BQ_FAULT_UNDERTEMP,     BQ_FAULT_OPEN_WIRE,
    BQ_FAULT_COMM_LOSS,    BQ_FAULT_NO_READING, BQ_FAULT_SENSOR,        BQ_FAULT_SELF_TEST,
    BQ_FAULT_CONFIG,       BQ_FAULT_IMBALANCE,
};

/* With separate paths these leave a direction as it is; all others stop both. */
#define BIT(fault) ((uint32_t)1u << (fault))
#define SPARES_CHARGE (BIT(BQ_FAULT_CELL_UV) | BIT(BQ_FAULT_CHIP_CELL_UV))
#define SPARES_DISCHARGE                                                                                     \
    (BIT(BQ_FAULT_CELL_OV) | BIT(BQ_FAULT_CHIP_CELL_OV) | BIT(BQ_FAULT_UNDERTEMP) |                          \
     BIT(BQ_FAULT_CHARGE_CURRENT))
/* These clear only while the request is off. */
#define LATCHED (BIT(BQ_FAULT_CONTACTOR) | BIT(BQ_FAULT_CHARGE_CURRENT))

const char *bq_pack_fault_name(bq_pack_fault fault)
{
    return bq_word(names, (unsigned)fault < BQ_FAULT_COUNT ? (unsigned)fault : BQ_FAULT_COUNT);
}

bool bq_pack_fault_stops_charge(bq_pack_fault fault)
{
    return (unsigned)fault < BQ_FAULT_COUNT && (BIT(fault) & SPARES_CHARGE) == 0u;
}

bool bq_pack_fault_stops_discharge(bq_pack_fault fault)
{
    return (unsigned)fault < BQ_FAULT_COUNT && (BIT(fault) & SPARES_DISCHARGE) == 0u;
}

bool bq_pack_stops(const bq_pack *p, bool charge)
{
    const uint32_t spares = charge ? SPARES_CHARGE : SPARES_DISCHARGE;

    return (p->faults & ~(p->config.separate_paths ? spares : 0u)) != 0u;
}

bq_pack_fault bq_pack_cause(const bq_pack *p)
{
    for (unsigned i = 0; i < BQ_FAULT_COUNT; i++) {
        if ((p->faults & BIT(order[i])) != 0u) {
            return (bq_pack_fault)order[i];
        }
    }
    return BQ_FAULT_COUNT;
}

static void trip(bq_pack *p, bq_pack_fault f, const bq_condition *c, uint32_t now_ms)
{
    bq_pack_fault_record *r = &p->fault[f];

    if (r->count == 0u) {
        r->first_ms = now_ms;
    }
    r->count = bq_pack_add_ms(r->count, 1u);
    r->trip_ms = now_ms;
    r->value = c->value;
    r->cell = c->cell;
    r->device = c->device;
    r->sensor = c->sensor;
    r->wire = c->wire;
    r->active = true;
    p->faults |= BIT(f);
    bq_pack_log(p, now_ms, BQ_EVENT_FAULT, (uint8_t)f,
                r->cell != 0u     ? r->cell
                : r->sensor != 0u ? r->sensor
                                  : r->device);
}

/* The cause is present: debounce, then active. timer_ms counts from the step that saw it first. */
static void present(bq_pack *p, bq_pack_fault f, const bq_condition *c, uint32_t now_ms, uint32_t dt_ms)
{
    bq_pack_fault_record *r = &p->fault[f];

    r->timer_ms = r->pending ? bq_pack_add_ms(r->timer_ms, dt_ms) : 0u;
    r->pending = true;
    r->clearing = false;
    if (!r->active && r->timer_ms >= c->debounce_ms) {
        trip(p, f, c, now_ms);
    }
    if (r->active) {
        r->last_ms = now_ms;
        r->hold = BQ_HOLD_CONDITION;
    }
}

static bq_pack_hold reason(const bq_pack *p, bq_pack_fault f, const bq_pack_input *in, bool clear)
{
    if (!clear) {
        return BQ_HOLD_HYSTERESIS;
    }
    if (!p->summary.complete) {
        return BQ_HOLD_UNKNOWN;
    }
    if ((BIT(f) & LATCHED) != 0u && in->request != BQ_REQUEST_OFF) {
        return BQ_HOLD_REQUEST;
    }
    return BQ_HOLD_TIME;
}

/* The cause is gone: an active fault clears after recover_ms without a reason to hold, by a new picture. */
static void gone(bq_pack *p, bq_pack_fault f, const bq_picture *v, const bq_pack_input *in, bool clear,
                 uint32_t now_ms, uint32_t dt_ms)
{
    bq_pack_fault_record *r = &p->fault[f];

    r->pending = false;
    if (!r->active) {
        return;
    }
    r->hold = reason(p, f, in, clear);
    if (r->hold != BQ_HOLD_TIME) {
        r->clearing = false;
        return;
    }
    r->timer_ms = r->clearing ? bq_pack_add_ms(r->timer_ms, dt_ms) : 0u;
    r->clearing = true;
    if (v->fresh && r->timer_ms >= p->config.recover_ms) {
        r->active = false;
        r->hold = BQ_HOLD_NONE;
        p->faults &= ~BIT(f);
        bq_pack_log(p, now_ms, BQ_EVENT_RECOVERED, (uint8_t)f, 0);
    }
}

void bq_pack_update_faults(bq_pack *p, const bq_picture *v, const bq_pack_input *in, const bq_condition *c,
                           uint32_t now_ms, uint32_t dt_ms)
{
    for (unsigned f = 0; f < BQ_FAULT_COUNT; f++) {
        if (c[f].broken) {
            present(p, (bq_pack_fault)f, &c[f], now_ms, dt_ms);
        } else {
            gone(p, (bq_pack_fault)f, v, in, c[f].clear, now_ms, dt_ms);
        }
    }
}

bool bq_pack_pending(const bq_pack *p)
{
    for (unsigned f = 0; f < BQ_FAULT_COUNT; f++) {
        if (p->fault[f].pending) {
            return true;
        }
    }
    return false;
}
