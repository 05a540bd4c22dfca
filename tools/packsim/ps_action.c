/* SPDX-License-Identifier: Apache-2.0 */
/* The [events] section: T = ACTION. */
#include "ps_scenario.h"

#include <stdio.h>
#include <string.h>

typedef struct context {
    const ps_words *w;
    const ps_scenario *s;
    ps_place at;
    ps_error *e;
} context;

/* Word i is a whole number 1..most (0..most with zero). */
static int index_of(const context *c, int i, const char *what, int least, int most, int *n)
{
    if (!ps_int(c->w->word[i], n) || *n < least || *n > most) {
        return ps_fail(c->e, c->at, "%s %s is not in %d..%d", what, c->w->word[i], least, most);
    }
    return 0;
}

static int value_of(const context *c, int i, const char *what, double low, double high, double *value)
{
    if (!ps_number(c->w->word[i], value) || *value < low || *value > high) {
        return ps_fail(c->e, c->at, "%s %s is not a number in %g..%g", what, c->w->word[i], low, high);
    }
    return 0;
}

static int one_of(const context *c, int i, const char *no, const char *yes, bool *on)
{
    *on = ps_is(c->w, i, yes);
    if (!*on && !ps_is(c->w, i, no)) {
        return ps_fail(c->e, c->at, "%s is neither %s nor %s", c->w->word[i], yes, no);
    }
    return 0;
}

static int cell_action(const context *c, ps_event *v)
{
    if (index_of(c, 1, "cell", 1, c->s->cells, &v->n) != 0) {
        return -1;
    }
    if (c->w->count == 3 && ps_is(c->w, 2, "free")) {
        v->kind = PS_ACT_CELL_FREE;
        return 0;
    }
    v->kind = PS_ACT_CELL_VOLTS;
    if (c->w->count != 4 || !ps_is(c->w, 2, "volts")) {
        return ps_fail(c->e, c->at, "expected: cell N volts V, or cell N free");
    }
    return value_of(c, 3, "voltage", 0.0, SIM_OCV_V_MAX, &v->value);
}

static int sensor_action(const context *c, ps_event *v)
{
    v->kind = PS_ACT_SENSOR;
    if (c->w->count != 4 || !ps_is(c->w, 2, "celsius")) {
        return ps_fail(c->e, c->at, "expected: sensor N celsius T");
    }
    if (index_of(c, 1, "sensor", 1, c->s->sensors, &v->n) != 0) {
        return -1;
    }
    return value_of(c, 3, "temperature", SIM_CELLS_T_MIN, SIM_CELLS_T_MAX, &v->value);
}

static int current_action(const context *c, ps_event *v)
{
    if (ps_is(c->w, 1, "file")) {
        v->kind = PS_ACT_CURRENT_FILE;
        return c->s->has_load_file ? 0 : ps_fail(c->e, c->at, "no current file in [load] and no --current");
    }
    v->kind = PS_ACT_CURRENT;
    return value_of(c, 1, "current", -10000.0, 10000.0, &v->value);
}

static int break_action(const context *c, ps_event *v)
{
    v->kind = PS_ACT_BREAK;
    if (!ps_is(c->w, 1, "above") || c->w->count != 3) {
        return ps_fail(c->e, c->at, "expected: break above K");
    }
    if (c->s->devices < 2) {
        return ps_fail(c->e, c->at, "a stack of one device has no wiring to break");
    }
    return index_of(c, 2, "device", 1, c->s->devices - 1, &v->n);
}

static int device_action(const context *c, ps_event *v)
{
    v->kind = PS_ACT_DEVICE;
    return index_of(c, 1, "device", 1, c->s->devices, &v->n) != 0 ? -1 : one_of(c, 2, "off", "on", &v->on);
}

static int wire_action(const context *c, ps_event *v)
{
    v->kind = PS_ACT_WIRE;
    return index_of(c, 1, "wire", 0, c->s->cells, &v->n) != 0 ? -1 : one_of(c, 2, "closed", "open", &v->on);
}

static int flip_action(const context *c, ps_event *v)
{
    v->kind = PS_ACT_FLIP;
    if (!ps_is(c->w, 1, "flip")) {
        return ps_fail(c->e, c->at, "expected: %s flip P", c->w->word[0]);
    }
    return value_of(c, 2, "probability", 0.0, 1.0, &v->value);
}

static int bus_action(const context *c, ps_event *v)
{
    if (c->w->count == 2 && ps_is(c->w, 1, "free")) {
        v->kind = PS_ACT_BUS_FREE;
        return 0;
    }
    v->kind = PS_ACT_BUS_DEAD;
    if (c->w->count != 3 || !ps_is(c->w, 1, "dead")) {
        return ps_fail(c->e, c->at, "expected: bus dead 00, bus dead ff, or bus free");
    }
    return one_of(c, 2, "00", "ff", &v->on);
}

static int request_action(const context *c, ps_event *v)
{
    v->kind = PS_ACT_REQUEST;
    return one_of(c, 1, "off", "on", &v->on);
}

static int mend_action(const context *c, ps_event *v)
{
    (void)c;
    v->kind = PS_ACT_MEND;
    return 0;
}

static int mcu_action(const context *c, ps_event *v)
{
    v->kind = PS_ACT_MCU_RESET;
    return ps_is(c->w, 1, "reset") ? 0 : ps_fail(c->e, c->at, "expected: mcu reset");
}

static int weld_action(const context *c, ps_event *v)
{
    v->kind = PS_ACT_WELD;
    return ps_is(c->w, 1, "weld") ? 0 : ps_fail(c->e, c->at, "expected: contactor weld");
}

static int afe_action(const context *c, ps_event *v)
{
    bool xready = false;
    if (one_of(c, 1, "alert", "xready", &xready) != 0) {
        return -1;
    }
    v->kind = xready ? PS_ACT_XREADY : PS_ACT_ALERT;
    return 0;
}

int ps_event_parse(ps_event *v, const ps_scenario *s, const char *time, const char *action, ps_place at,
                   ps_error *e)
{
    enum { ANY, STACK, AFE }; /* which packs it makes sense for */
    static const struct {
        const char *verb;
        int least, most; /* words */
        int family;
        int (*parse)(const context *c, ps_event *v);
    } verbs[] = {
        {"cell", 3, 4, ANY, cell_action},       {"sensor", 4, 4, ANY, sensor_action},
        {"current", 2, 2, ANY, current_action}, {"request", 2, 2, ANY, request_action},
        {"break", 3, 3, STACK, break_action},   {"mend", 1, 1, STACK, mend_action},
        {"device", 3, 3, ANY, device_action},   {"wire", 3, 3, STACK, wire_action},
        {"spi", 3, 3, STACK, flip_action},      {"bus", 2, 3, ANY, bus_action},
        {"mcu", 2, 2, ANY, mcu_action},         {"contactor", 2, 2, STACK, weld_action},
        {"i2c", 3, 3, AFE, flip_action},        {"afe", 2, 2, AFE, afe_action},
    };
    memset(v, 0, sizeof *v);
    v->at = at;
    (void)snprintf(v->text, sizeof v->text, "%s", action);
    if (!ps_time(time, &v->t)) {
        return ps_fail(e, at, "%s is not a time (number and us, ms, s, min or h)", time);
    }
    ps_words w;
    if (ps_split(&w, action) != 0 || w.count == 0) {
        return ps_fail(e, at, "unreadable action");
    }
    const context c = {&w, s, at, e};
    for (size_t i = 0; i < sizeof verbs / sizeof verbs[0]; i++) {
        if (ps_is(&w, 0, verbs[i].verb)) {
            if (verbs[i].family == (s->part != NULL ? STACK : AFE)) {
                return ps_fail(e, at, "%s concerns a %s; this pack has a %s", w.word[0],
                               s->part != NULL ? "bq76pl536 stack" : "bq769x0",
                               s->part != NULL ? s->part->name : "bq76pl536 stack");
            }
            if (w.count < verbs[i].least || w.count > verbs[i].most) {
                return ps_fail(e, at, "wrong number of words in: %s", action);
            }
            return verbs[i].parse(&c, v);
        }
    }
    return ps_fail(e, at, "unknown action: %s", action);
}
