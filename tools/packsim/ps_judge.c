/* SPDX-License-Identifier: Apache-2.0 */
#include "ps_judge.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void decide(ps_verdict *v, bool held, const char *format, ...) __attribute__((format(printf, 3, 4)));

static void decide(ps_verdict *v, bool held, const char *format, ...)
{
    if (v->decided) {
        return;
    }
    v->decided = true;
    v->held = held;
    if (!held) {
        va_list args;
        va_start(args, format);
        (void)vsnprintf(v->got, sizeof v->got, format, args);
        va_end(args);
    }
}

void ps_judge_init(ps_judge *j, const ps_scenario *s)
{
    memset(j, 0, sizeof *j);
    j->s = s;
}

/* The moment an expectation looks at the pack; UINT64_MAX for those that only listen. */
static uint64_t moment(const ps_expect *x)
{
    switch (x->kind) {
    case PS_EXP_STATE:
    case PS_EXP_DISCOVERED:
    case PS_EXP_SPREAD:
    case PS_EXP_RECOVERED:
        return x->t;
    case PS_EXP_OUTPUTS_OFF:
        return x->t0;
    default:
        return UINT64_MAX;
    }
}

uint64_t ps_judge_next(const ps_judge *j)
{
    uint64_t next = UINT64_MAX;
    for (int i = 0; i < j->s->expects; i++) {
        uint64_t m = moment(&j->s->expect[i]);
        if (!j->verdict[i].looked && m < next) {
            next = m;
        }
    }
    return next;
}

static void look(ps_verdict *v, const ps_expect *x, const ps_view *view)
{
    switch (x->kind) {
    case PS_EXP_STATE:
        decide(v, view->state == x->id, "state %s", bq_pack_state_name((bq_pack_state_id)view->state));
        break;
    case PS_EXP_DISCOVERED:
        decide(v, view->found == x->id, "%d discovered", view->found);
        break;
    case PS_EXP_SPREAD:
        decide(v, view->spread_mv < x->value, "spread %.2f mv", view->spread_mv);
        break;
    case PS_EXP_RECOVERED:
        decide(v, view->healthy, "not healthy, state %s", bq_pack_state_name((bq_pack_state_id)view->state));
        break;
    case PS_EXP_OUTPUTS_OFF:
        if (!view->outputs_on) {
            decide(v, true, "off");
        }
        break;
    default:
        break;
    }
}

void ps_judge_look(ps_judge *j, uint64_t t, const ps_view *view)
{
    for (int i = 0; i < j->s->expects; i++) {
        uint64_t m = moment(&j->s->expect[i]);
        if (m != UINT64_MAX && m <= t && !j->verdict[i].looked) {
            j->verdict[i].looked = true;
            look(&j->verdict[i], &j->s->expect[i], view);
        }
    }
}

static bool same_item(const ps_expect *x, const ps_fault_seen *f)
{
    switch (x->item) {
    case PS_ITEM_CELL:
        return f->cell == x->n;
    case PS_ITEM_DEVICE:
        return f->device == x->n;
    case PS_ITEM_SENSOR:
        return f->sensor == x->n;
    default:
        return true;
    }
}

void ps_judge_fault(ps_judge *j, const ps_fault_seen *f)
{
    if (j->faults < PS_FAULTS_KEPT) {
        j->fault[j->faults] = *f;
    }
    j->faults++;
    const char *name = bq_pack_fault_name((bq_pack_fault)f->id);
    double seconds = (double)f->t / 1e9;
    for (int i = 0; i < j->s->expects; i++) {
        const ps_expect *x = &j->s->expect[i];
        if (x->kind == PS_EXP_FAULT && x->id == f->id && same_item(x, f) && f->t >= x->t0 &&
            f->t <= x->t0 + x->t) {
            decide(&j->verdict[i], true, "seen");
        } else if (x->kind == PS_EXP_NO_FAULTS || (x->kind == PS_EXP_NO_FAULT_BEFORE && f->t < x->t)) {
            decide(&j->verdict[i], false, "%s at %.3f s", name, seconds);
        }
    }
}

void ps_judge_outputs(ps_judge *j, uint64_t t, bool on)
{
    for (int i = 0; i < j->s->expects && !on; i++) {
        const ps_expect *x = &j->s->expect[i];
        if (x->kind == PS_EXP_OUTPUTS_OFF && t >= x->t0 && t <= x->t0 + x->t) {
            decide(&j->verdict[i], true, "off");
        }
    }
}

static void finish(ps_verdict *v, const ps_expect *x, const ps_totals *z)
{
    switch (x->kind) {
    case PS_EXP_NO_FAULTS:
    case PS_EXP_NO_FAULT_BEFORE:
        decide(v, true, "none");
        break;
    case PS_EXP_FAULT:
        decide(v, false, "no such fault in this time");
        break;
    case PS_EXP_OUTPUTS_OFF:
        decide(v, false, "outputs stayed on");
        break;
    case PS_EXP_SOC:
        decide(v, z->soc_percent >= 0.0 && z->soc_percent < x->value, "%.2f percent", z->soc_percent);
        break;
    case PS_EXP_MEASUREMENT:
        decide(v, z->measurement_mv >= 0.0 && z->measurement_mv < x->value, "%.3f mv", z->measurement_mv);
        break;
    case PS_EXP_MISUSE_NONE:
        decide(v, z->misuse == 0, "%lu times", z->misuse);
        break;
    case PS_EXP_SPEED:
        decide(v, z->speed < 0.0 || z->speed > x->value, "%.0f", z->speed);
        break;
    default:
        decide(v, false, "never looked at");
        break;
    }
}

void ps_judge_end(ps_judge *j, const ps_totals *totals)
{
    for (int i = 0; i < j->s->expects; i++) {
        finish(&j->verdict[i], &j->s->expect[i], totals);
    }
}

int ps_judge_held(const ps_judge *j)
{
    int held = 0;
    for (int i = 0; i < j->s->expects; i++) {
        held += j->verdict[i].held ? 1 : 0;
    }
    return held;
}
