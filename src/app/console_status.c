/* SPDX-License-Identifier: Apache-2.0 */
/* The commands status and version: one row for each subject. */
#include "bqhost/version.h"
#include "console_internal.h"
#include <string.h>

#define MOST_VALUES 5u

static const char *const formats[] = {
    "state     %S for %t",
    "outputs   charge %[off|on], discharge %[off|on], contactor %[off|on]",
    "request   %[off|on|sleep]",
    "cause     %F, held by %H",
    "pack      %v, %[not complete|complete]%a",
    "cells     %?%v (%u) to %v (%u)",
    "sensors   %?%c (%u) to %c (%u)",
    "current   %?%i%a",
    "charge    %?%p",
    "balance   %[allowed|forbidden], cells %u",
    "monitor   %[down|up|failed], modules %u, %E",
    "self-test %[not done|passed|failed], %E",
    "can       %[active|passive|bus-off|none]",
    "uptime    %t",
};

#define ROWS_OF_APP 12u
#define ROWS (sizeof formats / sizeof formats[0])

static const char *cause(const bq_pack *p, int32_t *v)
{
    const bq_pack_fault f = bq_pack_cause(p);

    if (f == BQ_FAULT_COUNT) {
        return "cause     none";
    }
    v[0] = (int32_t)f;
    v[1] = (int32_t)p->fault[f].hold;
    return formats[3];
}

static void extremes(int32_t *v, int32_t least, unsigned at_least, int32_t most, unsigned at_most)
{
    v[0] = (int32_t)at_least;
    v[1] = least;
    v[2] = (int32_t)at_least;
    v[3] = most;
    v[4] = (int32_t)at_most;
}

/* The values of one row; returns its format. */
static const char *look(const bq_app *app, uint16_t row, int32_t *v)
{
    const bq_pack *p = bq_app_pack(app);
    const bq_pack_summary *y = &p->summary;
    const bq_pack_input *in = bq_app_input(app);
    const bq_sample *s = bq_app_sample(app);
    const uint32_t since = bq_app_step_age_ms(app);

    switch (row) {
    case 0:
        v[0] = (int32_t)p->state;
        v[1] = (int32_t)(bq_app_now_ms(app) - p->state_ms);
        break;
    case 1:
        v[0] = bq_app_action(app)->charge_on;
        v[1] = bq_app_action(app)->discharge_on;
        v[2] = bq_app_outputs_on(app);
        break;
    case 2:
        v[0] = (int32_t)in->request;
        break;
    case 3:
        return cause(p, v);
    case 4:
        v[0] = (int32_t)y->pack_mv;
        v[1] = y->complete;
        v[2] = console_age(s->cell_count == 0u ? UINT32_MAX : y->blind_ms, since);
        break;
    case 5:
        extremes(v, y->cell_min_mv, y->cell_min, y->cell_max_mv, y->cell_max);
        break;
    case 6:
        extremes(v, y->temp_min_dc, y->temp_min, y->temp_max_dc, y->temp_max);
        break;
    case 7:
        v[0] = s->current_valid;
        v[1] = s->current_ma;
        v[2] = console_age(s->current_age_ms, since);
        break;
    case 8:
        v[0] = y->soc_permille >= 0;
        v[1] = y->soc_permille;
        break;
    case 9:
        v[0] = in->balance_off;
        v[1] = y->balancing;
        break;
    case 10:
        v[0] = (int32_t)in->monitor;
        v[1] = bq_app_modules_found(app);
        v[2] = (int32_t)in->monitor_status;
        break;
    default:
        v[0] = (int32_t)in->self_test;
        v[1] = (int32_t)in->self_test_status;
        break;
    }
    return formats[row];
}

static void refused(bq_console *c, const bq_console_target *t)
{
    const int32_t v = (int32_t)t->refused;

    console_say(c, "refused   %E ", &v);
    console_text(c, t->what != NULL ? t->what : "");
    console_text(c, ", outputs stay off");
}

console_row console_status(bq_console *c, const bq_console_target *t)
{
    const uint16_t row = c->row++;
    int32_t v[MOST_VALUES];

    if (row >= ROWS) {
        return CONSOLE_DONE;
    }
    if (row >= ROWS_OF_APP) {
        v[0] = (int32_t)t->now_ms;
        if (row == ROWS_OF_APP) {
            v[0] = t->can != NULL && t->can->ops != NULL ? (int32_t)t->can->ops->state(t->can->ctx) : 3;
        }
        console_say(c, formats[row], v);
    } else if (t->app != NULL) {
        console_say(c, look(t->app, row, v), v);
    } else {
        c->row = ROWS_OF_APP;
        refused(c, t);
    }
    return CONSOLE_ROW;
}

/* ---- version ------------------------------------------------------------------------------------ */

static void identity(bq_console *c, const bq_console_target *t)
{
    console_text(c, "bqhost " BQHOST_VERSION " ");
    console_text(c, t->name != NULL ? t->name : "");
}

static void crash(bq_console *c, const bq_crash *k)
{
    const int32_t v[] = {(int32_t)k->kind, (int32_t)k->pc, (int32_t)k->lr, (int32_t)k->sp,
                         (int32_t)k->uptime_ms};

    console_say(c, "crash     kind %u pc %X lr %X sp %X after %t", v);
}

static void registers(bq_console *c, const bq_crash *k)
{
    const int32_t v[] = {(int32_t)k->psr, (int32_t)k->cfsr, (int32_t)k->hfsr, (int32_t)k->address};

    console_say(c, "          psr %X cfsr %X hfsr %X address %X", v);
}

static void start(bq_console *c, const bq_mcu *m)
{
    const bq_boot *b = m->boot;
    const int32_t v[] = {(int32_t)b->cause, b->crystal_failed, (int32_t)b->image_crc, b->image_ok,
                         m->ops != NULL ? (int32_t)m->ops->stack_free(m->ctx) : 0};

    console_say(c,
                "reset by  %[unknown|power-on|brown-out|pin|software|watchdog|crash]%[|, crystal failed], "
                "image %X %[damaged|ok], stack left %u",
                v);
}

console_row console_version(bq_console *c, const bq_console_target *t)
{
    const bq_boot *b = t->mcu != NULL ? t->mcu->boot : NULL;
    const uint16_t row = c->row++;

    if (row > 3u || (row > 0u && b == NULL) || (row > 1u && !b->crashed)) {
        return CONSOLE_DONE;
    }
    switch (row) {
    case 0:
        identity(c, t);
        break;
    case 1:
        start(c, t->mcu);
        break;
    case 2:
        crash(c, &b->crash);
        break;
    default:
        registers(c, &b->crash);
        break;
    }
    return CONSOLE_ROW;
}
