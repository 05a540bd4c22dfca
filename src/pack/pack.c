/* SPDX-License-Identifier: Apache-2.0 */
/* The pack controller's step: look, judge, change state, decide. */
#include "bqhost/text.h"
#include "pack_internal.h"
#include <string.h>

const char *bq_pack_state_name(bq_pack_state_id state)
{
    return bq_word("init\0self-test\0standby\0on\0fault\0sleep\0?", (uint32_t)state);
}

const char *bq_pack_hold_name(bq_pack_hold hold)
{
    return bq_word("none\0condition\0hysteresis\0unknown\0request\0time\0?", (uint32_t)hold);
}

void bq_pack_log(bq_pack *p, bq_pack_event_kind kind, unsigned code, unsigned where)
{
    bq_pack_event *e = &p->events[p->event_count++ % BQ_PACK_EVENTS];

    e->t_ms = p->last_ms;
    e->kind = (uint8_t)kind;
    e->code = (uint8_t)code;
    e->where = (uint16_t)where;
}

bq_status bq_pack_init(bq_pack *p, const bq_pack_config *config)
{
    bq_status status = p == NULL ? BQ_E_ARG : bq_pack_config_validate(config, NULL);

    if (status != BQ_OK) {
        return status;
    }
    memset(p, 0, sizeof *p);
    p->config = *config;
    p->state = BQ_PACK_INIT;
    p->summary.soc_permille = -1; /* and all zero is what bq_soc_init() makes */
    return BQ_OK;
}

/* New flags are logged once each. True: there are some that may be cleared, because they are judged in this
 * same step (PL-SEQ-08-06). */
static bool log_chip_flags(bq_pack *p, const bq_picture *v)
{
    uint32_t any = 0;

    for (uint16_t m = 0; v->s != NULL && m < v->s->module_count; m++) {
        const bq_module_reading *r = &v->s->modules[m];
        const uint32_t flags = r->faults, risen = flags & ~(uint32_t)p->flags[m];
        if (risen != 0u) {
            bq_pack_log(p, BQ_EVENT_CHIP_FLAGS, m + 1u, risen);
        }
        p->flags[m] = (uint16_t)flags;
        any |= flags | r->cell_ov | r->cell_uv | r->sensor_ot;
    }
    return any != 0u && v->live;
}

/* Whatever was measured before the sleep does not count any more. Active faults stay. */
static void wake(bq_pack *p)
{
    p->started = false;
    memset(p->blind_ms, 0, sizeof p->blind_ms);
    p->pending = 0;
    p->clearing = 0;
}

/* The transition table of pack.h, line by line. */
static bq_pack_state_id next_state(const bq_pack *p, const bq_pack_input *in)
{
    const bool passed = in->self_test == BQ_TEST_PASSED;
    const bool agrees = in->contactor_mismatch_ms == 0u;

    if (p->state == BQ_PACK_SLEEP) {
        return in->request == BQ_REQUEST_SLEEP ? BQ_PACK_SLEEP : BQ_PACK_INIT;
    }
    if (in->request == BQ_REQUEST_SLEEP && p->drives == 0u && agrees) {
        return BQ_PACK_SLEEP;
    }
    if (p->faults != 0u) {
        return BQ_PACK_FAULT;
    }
    if (p->state == BQ_PACK_ON) {
        return in->request == BQ_REQUEST_ON ? BQ_PACK_ON : BQ_PACK_STANDBY;
    }
    if (in->monitor != BQ_MONITOR_UP) {
        return BQ_PACK_INIT;
    }
    switch (p->state) {
    case BQ_PACK_FAULT:
        return passed ? BQ_PACK_STANDBY : BQ_PACK_INIT;
    case BQ_PACK_INIT:
        return p->started ? BQ_PACK_SELF_TEST : BQ_PACK_INIT;
    case BQ_PACK_SELF_TEST:
        return passed && p->summary.complete ? BQ_PACK_STANDBY : BQ_PACK_SELF_TEST;
    default: /* standby */
        if (!passed) {
            return BQ_PACK_INIT;
        }
        return in->request == BQ_REQUEST_ON && p->summary.complete && p->pending == 0u && agrees
                   ? BQ_PACK_ON
                   : BQ_PACK_STANDBY;
    }
}

static void change_state(bq_pack *p, const bq_pack_input *in)
{
    const bq_pack_state_id next = next_state(p, in);

    if (next != p->state) {
        if (p->state == BQ_PACK_SLEEP) {
            wake(p);
        }
        p->state = next;
        p->state_ms = p->last_ms;
        bq_pack_log(p, BQ_EVENT_STATE, (unsigned)next, 0);
    }
}

/* In the state "on" both directions conduct. In "fault" one may stay on if it was, never come back. */
static void decide_outputs(bq_pack *p, const bq_pack_input *in, bq_action *a)
{
    if (p->state == BQ_PACK_ON) {
        p->drives = BQ_DRIVES_CHARGE | BQ_DRIVES_DISCHARGE;
    } else if (p->state == BQ_PACK_FAULT && in->request == BQ_REQUEST_ON) {
        p->drives &= (uint8_t)~bq_pack_stopped(p);
    } else {
        p->drives = 0;
    }
    a->charge_on = (p->drives & BQ_DRIVES_CHARGE) != 0u;
    a->discharge_on = (p->drives & BQ_DRIVES_DISCHARGE) != 0u;
    a->sleep = p->state == BQ_PACK_SLEEP;
    a->unlock = in->request == BQ_REQUEST_OFF;
}

static void update_soc(bq_pack *p, const bq_picture *v)
{
    const uint32_t mean = p->summary.complete ? p->summary.pack_mv / p->config.cells : 0u;

    bq_soc_step(&p->soc, &p->config.soc, v->dt_ms, v->current_known, v->current_known ? v->s->current_ma : 0,
                (uint16_t)mean);
    p->summary.soc_permille = bq_soc_permille(&p->soc, &p->config.soc);
}

void bq_pack_step(bq_pack *p, const bq_sample *s, const bq_pack_input *in, uint32_t now_ms, bq_action *a)
{
    bq_picture v;
    bq_condition c[BQ_FAULT_COUNT];
    bool flags = false;

    if (a != NULL) {
        memset(a, 0, sizeof *a);
    }
    if (p == NULL || in == NULL || a == NULL) {
        return;
    }
    memset(&v, 0, sizeof v);
    v.in = in;
    v.dt_ms = p->stepped ? now_ms - p->last_ms : 0u;
    p->last_ms = now_ms;
    p->stepped = true;
    bq_pack_look(p, s, &v);
    if (p->state != BQ_PACK_SLEEP) {
        flags = log_chip_flags(p, &v);
        bq_pack_judge(p, &v, c);
        bq_pack_update_faults(p, &v, c);
    }
    change_state(p, in);
    decide_outputs(p, in, a);
    bq_pack_balance(p, &v, a);
    a->clear_faults = flags && p->state != BQ_PACK_SLEEP;
    update_soc(p, &v);
}
