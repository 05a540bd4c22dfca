/* SPDX-License-Identifier: Apache-2.0 */
/* The [expect] section: one line per expectation. */
#include "ps_scenario.h"

#include <stdio.h>
#include <string.h>

typedef struct context {
    const ps_words *w;
    const ps_scenario *s;
    ps_place at;
    ps_error *e;
} context;

static int refuse(const context *c, const char *form)
{
    return ps_fail(c->e, c->at, "expected: %s", form);
}

/* `at T` from word i to the end. */
static bool at_time(const ps_words *w, int i, uint64_t *t)
{
    if (!ps_is(w, i, "at")) {
        return false;
    }
    i++;
    return ps_time_words(w, &i, t) && i == w->count;
}

/* `within T of T0` from word i to the end. */
static bool within(const ps_words *w, int i, uint64_t *t, uint64_t *t0)
{
    if (!ps_is(w, i, "within")) {
        return false;
    }
    i++;
    if (!ps_time_words(w, &i, t) || !ps_is(w, i, "of")) {
        return false;
    }
    i++;
    return ps_time_words(w, &i, t0) && i == w->count;
}

int ps_state_number(const char *name)
{
    for (int i = BQ_PACK_INIT; i <= BQ_PACK_SLEEP; i++) {
        if (strcmp(name, bq_pack_state_name((bq_pack_state_id)i)) == 0) {
            return i;
        }
    }
    return -1;
}

int ps_fault_number(const char *name)
{
    for (int i = 0; i < BQ_FAULT_COUNT; i++) {
        if (strcmp(name, bq_pack_fault_name((bq_pack_fault)i)) == 0) {
            return i;
        }
    }
    return -1;
}

static int expect_state(const context *c, ps_expect *x)
{
    x->kind = PS_EXP_STATE;
    if (c->w->count < 2 || !at_time(c->w, 2, &x->t)) {
        return refuse(c, "state STATE at T");
    }
    x->id = ps_state_number(c->w->word[1]);
    return x->id >= 0 ? 0 : ps_fail(c->e, c->at, "unknown state %s", c->w->word[1]);
}

static int fault_item(const context *c, int *i, ps_expect *x)
{
    static const char *const names[] = {"cell", "device", "sensor"};
    const int most[] = {c->s->cells, c->s->devices, c->s->sensors};
    for (int k = 0; k < 3; k++) {
        if (ps_is(c->w, *i, names[k])) {
            if (*i + 1 >= c->w->count || !ps_int(c->w->word[*i + 1], &x->n) || x->n < 1 || x->n > most[k]) {
                return ps_fail(c->e, c->at, "%s number is not in 1..%d", names[k], most[k]);
            }
            x->item = (ps_item)(PS_ITEM_CELL + k);
            *i += 2;
            return 0;
        }
    }
    return 0;
}

static int expect_fault(const context *c, ps_expect *x)
{
    x->kind = PS_EXP_FAULT;
    if (c->w->count < 2) {
        return refuse(c, "fault NAME [cell N | device K | sensor N] within T of T0");
    }
    x->id = ps_fault_number(c->w->word[1]);
    if (x->id < 0) {
        return ps_fail(c->e, c->at, "unknown fault %s", c->w->word[1]);
    }
    int i = 2;
    if (fault_item(c, &i, x) != 0) {
        return -1;
    }
    return within(c->w, i, &x->t, &x->t0)
               ? 0
               : refuse(c, "fault NAME [cell N | device K | sensor N] within T of T0");
}

static int expect_no(const context *c, ps_expect *x)
{
    if (c->w->count == 2 && ps_is(c->w, 1, "faults")) {
        x->kind = PS_EXP_NO_FAULTS;
        return 0;
    }
    x->kind = PS_EXP_NO_FAULT_BEFORE;
    int i = 3;
    if (!ps_is(c->w, 1, "fault") || !ps_is(c->w, 2, "before") || !ps_time_words(c->w, &i, &x->t) ||
        i != c->w->count) {
        return refuse(c, "no fault before T, or no faults");
    }
    return 0;
}

static int expect_discovered(const context *c, ps_expect *x)
{
    x->kind = PS_EXP_DISCOVERED;
    if (c->w->count < 2 || !ps_int(c->w->word[1], &x->id) || x->id < 0 || x->id > c->s->devices ||
        !at_time(c->w, 2, &x->t)) {
        return refuse(c, "discovered K at T, K up to the number of devices");
    }
    return 0;
}

/* `below X UNIT` from word i; returns the index behind it, or -1. */
static int below(const ps_words *w, int i, const char *unit, double *value)
{
    if (!ps_is(w, i, "below") || i + 1 >= w->count || !ps_number(w->word[i + 1], value) || *value < 0.0 ||
        !ps_is(w, i + 2, unit)) {
        return -1;
    }
    return i + 3;
}

static int expect_spread(const context *c, ps_expect *x)
{
    x->kind = PS_EXP_SPREAD;
    int i = below(c->w, 1, "mv", &x->value);
    return i > 0 && at_time(c->w, i, &x->t) ? 0 : refuse(c, "spread below X mv at T");
}

static int expect_soc(const context *c, ps_expect *x)
{
    x->kind = PS_EXP_SOC;
    if (!ps_is(c->w, 1, "error") || below(c->w, 2, "percent", &x->value) != c->w->count) {
        return refuse(c, "soc error below X percent");
    }
    return 0;
}

static int expect_measurement(const context *c, ps_expect *x)
{
    x->kind = PS_EXP_MEASUREMENT;
    if (!ps_is(c->w, 1, "error") || below(c->w, 2, "mv", &x->value) != c->w->count) {
        return refuse(c, "measurement error below X mv");
    }
    return 0;
}

static int expect_outputs(const context *c, ps_expect *x)
{
    x->kind = PS_EXP_OUTPUTS_OFF;
    return ps_is(c->w, 1, "off") && within(c->w, 2, &x->t, &x->t0) ? 0
                                                                   : refuse(c, "outputs off within T of T0");
}

static int expect_recovered(const context *c, ps_expect *x)
{
    x->kind = PS_EXP_RECOVERED;
    return at_time(c->w, 1, &x->t) ? 0 : refuse(c, "recovered at T");
}

static int expect_misuse(const context *c, ps_expect *x)
{
    x->kind = PS_EXP_MISUSE_NONE;
    return c->w->count == 2 && ps_is(c->w, 1, "none") ? 0 : refuse(c, "misuse none");
}

static int expect_speed(const context *c, ps_expect *x)
{
    x->kind = PS_EXP_SPEED;
    if (c->w->count != 3 || !ps_is(c->w, 1, "above") || !ps_number(c->w->word[2], &x->value)) {
        return refuse(c, "speed above X");
    }
    return 0;
}

int ps_expect_parse(ps_expect *x, const ps_scenario *s, const char *text, ps_place at, ps_error *e)
{
    static const struct {
        const char *word;
        int (*parse)(const context *c, ps_expect *x);
    } kinds[] = {
        {"state", expect_state},
        {"fault", expect_fault},
        {"no", expect_no},
        {"discovered", expect_discovered},
        {"spread", expect_spread},
        {"soc", expect_soc},
        {"measurement", expect_measurement},
        {"outputs", expect_outputs},
        {"recovered", expect_recovered},
        {"misuse", expect_misuse},
        {"speed", expect_speed},
    };
    memset(x, 0, sizeof *x);
    x->at = at;
    (void)snprintf(x->text, sizeof x->text, "%s", text);
    ps_words w;
    if (ps_split(&w, text) != 0 || w.count == 0) {
        return ps_fail(e, at, "unreadable expectation");
    }
    const context c = {&w, s, at, e};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        if (ps_is(&w, 0, kinds[i].word)) {
            return kinds[i].parse(&c, x);
        }
    }
    return ps_fail(e, at, "unknown expectation: %s", text);
}

uint64_t ps_expect_deadline(const ps_expect *x)
{
    switch (x->kind) {
    case PS_EXP_FAULT:
    case PS_EXP_OUTPUTS_OFF:
        return x->t0 + x->t;
    case PS_EXP_STATE:
    case PS_EXP_NO_FAULT_BEFORE:
    case PS_EXP_DISCOVERED:
    case PS_EXP_SPREAD:
    case PS_EXP_RECOVERED:
        return x->t;
    default:
        return 0;
    }
}
