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
/* These become active after the pack's debounce time. */
#define LIMITS                                                                                               \
    (BIT(BQ_FAULT_CELL_OV) | BIT(BQ_FAULT_CELL_UV) | BIT(BQ_FAULT_OVERTEMP) | BIT(BQ_FAULT_UNDERTEMP) |      \
     BIT(BQ_FAULT_IMBALANCE))
#define DEBOUNCED (LIMITS | BIT(BQ_FAULT_OPEN_WIRE) | BIT(BQ_FAULT_CHARGE_CURRENT))
/* These clear only while the request is off. */
#define LATCHED (BIT(BQ_FAULT_CONTACTOR) | BIT(BQ_FAULT_CHARGE_CURRENT))

const char *bq_pack_fault_name(bq_pack_fault fault)
{
    return bq_word(names, (uint32_t)fault);
}

bool bq_pack_fault_stops_charge(bq_pack_fault fault)
{
    return (unsigned)fault < BQ_FAULT_COUNT && (BIT(fault) & SPARES_CHARGE) == 0u;
}

bool bq_pack_fault_stops_discharge(bq_pack_fault fault)
{
    return (unsigned)fault < BQ_FAULT_COUNT && (BIT(fault) & SPARES_DISCHARGE) == 0u;
}

uint8_t bq_pack_stopped(const bq_pack *p)
{
    const uint32_t spares = p->config.separate_paths ? UINT32_MAX : 0u;

    return (uint8_t)(((p->faults & ~(spares & SPARES_CHARGE)) != 0u ? BQ_DRIVES_CHARGE : 0u) |
                     ((p->faults & ~(spares & SPARES_DISCHARGE)) != 0u ? BQ_DRIVES_DISCHARGE : 0u));
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

static void trip(bq_pack *p, unsigned f, const bq_condition *c, const bq_sample *s)
{
    bq_pack_fault_record *r = &p->fault[f];
    unsigned where = c->cell != 0u ? c->cell : c->sensor;

    r->device = c->device;
    if (where == 0u) {
        where = c->device;
    } else if (c->device == 0u) {
        r->device = (uint8_t)(bq_reading(s, c->cell == 0u, where - 1u)->module + 1u);
    }
    if (r->count == 0u) {
        r->first_ms = p->last_ms;
    }
    r->count = bq_pack_add_ms(r->count, 1u);
    r->trip_ms = p->last_ms;
    r->value = c->value;
    r->cell = c->cell;
    r->sensor = c->sensor;
    r->wire = (int8_t)(c->wire - 1);
    r->active = true;
    p->faults |= BIT(f);
    bq_pack_log(p, BQ_EVENT_FAULT, f, where);
}

/* Whether `ms` have passed since the first of the steps in a row for which this was asked; `row` has a bit
 * for each fault whose time is running. */
static bool lasted(const bq_pack *p, bq_pack_fault_record *r, uint32_t *row, uint32_t bit, uint32_t ms)
{
    if ((*row & bit) == 0u) {
        *row |= bit;
        r->since_ms = p->last_ms;
    }
    return p->last_ms - r->since_ms >= ms;
}

/* The cause is present: debounce, then active. */
static void present(bq_pack *p, unsigned f, const bq_condition *c, const bq_sample *s)
{
    bq_pack_fault_record *r = &p->fault[f];
    const uint32_t bit = BIT(f);
    const uint32_t debounce_ms = (bit & DEBOUNCED) != 0u ? p->config.debounce_ms : c->debounce_ms;

    p->clearing &= ~bit;
    if (lasted(p, r, &p->pending, bit, debounce_ms) && !r->active) {
        trip(p, f, c, s);
    }
    if (r->active) {
        r->last_ms = p->last_ms;
        r->hold = BQ_HOLD_CONDITION;
    }
}

static bq_pack_hold reason(const bq_pack *p, uint32_t bit, const bq_pack_input *in, bool clear)
{
    if (!clear && (bit & LIMITS) != 0u) {
        return BQ_HOLD_HYSTERESIS;
    }
    if (!p->summary.complete) {
        return BQ_HOLD_UNKNOWN;
    }
    if ((bit & LATCHED) != 0u && in->request != BQ_REQUEST_OFF) {
        return BQ_HOLD_REQUEST;
    }
    return BQ_HOLD_TIME;
}

/* The cause is gone: an active fault clears after recover_ms without a reason to hold, by a new picture. */
static void gone(bq_pack *p, unsigned f, const bq_picture *v, bool clear)
{
    bq_pack_fault_record *r = &p->fault[f];
    const uint32_t bit = BIT(f);

    p->pending &= ~bit;
    if (!r->active) {
        return;
    }
    r->hold = reason(p, bit, v->in, clear);
    if (r->hold != BQ_HOLD_TIME) {
        p->clearing &= ~bit;
    } else if (lasted(p, r, &p->clearing, bit, p->config.recover_ms) && v->fresh) {
        r->active = false;
        r->hold = BQ_HOLD_NONE;
        p->faults &= ~bit;
        bq_pack_log(p, BQ_EVENT_RECOVERED, f, 0);
    }
}

void bq_pack_update_faults(bq_pack *p, const bq_picture *v, const bq_condition *c)
{
    for (unsigned f = 0; f < BQ_FAULT_COUNT; f++, c++) {
        if (c->broken) {
            present(p, f, c, v->s);
        } else {
            gone(p, f, v, c->clear);
        }
    }
}
