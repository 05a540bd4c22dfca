/* SPDX-License-Identifier: Apache-2.0 */
/* Inputs and outputs of the bq769x0: one table row per path. */
#include "bqsim_call.h"
#include "bqsim_value.h"

typedef struct item {
    const char *name;
    bqsim_notation as;
    int index_per_group; /* 0 = no index; else indices 1..this times the groups of the part */
    double low, high;
    int (*set)(sim_x0 *a, int index, double value);
    double (*get)(const sim_x0 *a, int index);
} item;

static int set_cell(sim_x0 *a, int i, double v)
{
    return sim_x0_set_cell(a, i, v);
}

static double get_cell(const sim_x0 *a, int i)
{
    return a->cell[i - 1];
}

static int set_ts(sim_x0 *a, int i, double v)
{
    return sim_x0_set_ts(a, i, v);
}

static double get_ts(const sim_x0 *a, int i)
{
    return a->ts_ohm[i - 1];
}

static int set_tdie(sim_x0 *a, int i, double v)
{
    (void)i;
    return sim_x0_set_tdie(a, v);
}

static double get_tdie(const sim_x0 *a, int i)
{
    (void)i;
    return a->tdie;
}

static int set_sense(sim_x0 *a, int i, double v)
{
    (void)i;
    return sim_x0_set_sense(a, v);
}

static double get_sense(const sim_x0 *a, int i)
{
    (void)i;
    return a->sense;
}

static int set_chgpin(sim_x0 *a, int i, double v)
{
    (void)i;
    return sim_x0_set_chgpin(a, v);
}

static double get_chgpin(const sim_x0 *a, int i)
{
    (void)i;
    return a->chgpin;
}

static int set_ext(sim_x0 *a, int i, double v)
{
    (void)i;
    return sim_x0_set_alert_ext(a, v > 0.5);
}

static double get_ext(const sim_x0 *a, int i)
{
    (void)i;
    return a->alert_ext;
}

static int set_gain(sim_x0 *a, int i, double v)
{
    (void)i;
    return sim_x0_set_gain(a, (int)v);
}

static double get_gain(const sim_x0 *a, int i)
{
    (void)i;
    return a->gain_uv;
}

static int set_offset(sim_x0 *a, int i, double v)
{
    (void)i;
    return sim_x0_set_offset(a, (int)v);
}

static double get_offset(const sim_x0 *a, int i)
{
    (void)i;
    return a->offset_mv;
}

static int set_supply(sim_x0 *a, int i, double v)
{
    (void)i;
    return sim_x0_set_supply(a, v > 0.5);
}

static double get_supply(const sim_x0 *a, int i)
{
    (void)i;
    return a->supply;
}

static int set_boot(sim_x0 *a, int i, double ns)
{
    (void)i;
    return sim_x0_boot(a, (uint64_t)ns);
}

static int set_xready(sim_x0 *a, int i, double v)
{
    (void)i;
    return v > 0.5 ? sim_x0_strike_xready(a) : 0;
}

/* The fault strikes once and leaves nothing to read but its status bit. */
static double get_xready(const sim_x0 *a, int i)
{
    (void)i;
    return (sim_x0_peek(a, 0x00) & 0x20u) != 0u;
}

static double get_alert(const sim_x0 *a, int i)
{
    (void)i;
    return sim_x0_alert(a);
}

static double get_chg(const sim_x0 *a, int i)
{
    (void)i;
    return sim_x0_chg(a);
}

static double get_dsg(const sim_x0 *a, int i)
{
    (void)i;
    return sim_x0_dsg(a);
}

static double get_cb(const sim_x0 *a, int i)
{
    (void)i;
    return sim_x0_cb(a);
}

static double get_mode(const sim_x0 *a, int i)
{
    (void)i;
    return (double)a->mode;
}

static const char *const mode[] = {"off", "ship", "boot", "normal"};

static const item items[] = {
    {"cell", BQSIM_VOLTS, 5, -100.0, 100.0, set_cell, get_cell},
    {"ts", BQSIM_NUMBER, 1, 0.0, 1e9, set_ts, get_ts},
    {"tdie", BQSIM_NUMBER, 0, -273.15, 1000.0, set_tdie, get_tdie},
    {"sense", BQSIM_NUMBER, 0, -10.0, 10.0, set_sense, get_sense},
    {"chgpin", BQSIM_NUMBER, 0, -100.0, 100.0, set_chgpin, get_chgpin},
    {"gain", BQSIM_WHOLE, 0, 365.0, 396.0, set_gain, get_gain},
    {"offset", BQSIM_WHOLE, 0, -128.0, 127.0, set_offset, get_offset},
    {"supply", BQSIM_SWITCH, 0, 0.0, 1.0, set_supply, get_supply},
    {"boot", BQSIM_TIME, 0, 0.0, 0.0, set_boot, NULL},
    {"xready", BQSIM_LEVEL, 0, 0.0, 1.0, set_xready, get_xready},
    {"chg", BQSIM_LEVEL, 0, 0.0, 0.0, NULL, get_chg},
    {"dsg", BQSIM_LEVEL, 0, 0.0, 0.0, NULL, get_dsg},
    {"cb", BQSIM_WORD, 0, 0.0, 0.0, NULL, get_cb},
    {"mode", BQSIM_NAME, 0, 0.0, 0.0, NULL, get_mode},
};
static const item alert = {"alert", BQSIM_LEVEL, 0, 0.0, 0.0, NULL, get_alert};
static const item alert_ext = {"alert.ext", BQSIM_LEVEL, 0, 0.0, 1.0, set_ext, get_ext};

/* The row of a path, and its index; NULL when there is none. */
static const item *find_item(const sim_x0 *a, bqsim_text path, int *index)
{
    bqsim_text name, part;
    uint32_t number = 0;

    *index = 0;
    if (bqsim_is(path, alert.name)) {
        return &alert;
    }
    if (bqsim_is(path, alert_ext.name)) {
        return &alert_ext;
    }
    if (!bqsim_part(&path, &name)) {
        return NULL;
    }
    for (size_t i = 0; i < sizeof items / sizeof items[0]; i++) {
        const item *it = &items[i];

        if (!bqsim_is(name, it->name)) {
            continue;
        }
        if (it->index_per_group == 0) {
            return bqsim_part(&path, &part) ? NULL : it;
        }
        if (!bqsim_part(&path, &part) || path.p != NULL ||
            !bqsim_count(part, 1, (uint32_t)(it->index_per_group * a->part->cells / 5), &number)) {
            return NULL;
        }
        *index = (int)number;
        return it;
    }
    return NULL;
}

bqsim_result bqsim_afe_set(bqsim_call *c, bqsim_text path)
{
    int index;
    double value;
    bqsim_text word;
    const item *it;

    if (!bqsim_afe_present(c)) {
        return BQSIM_ERR;
    }
    it = find_item(&c->s->afe, path, &index);
    if (it == NULL) {
        return bqsim_refuse(c, "unknown path afe", path);
    }
    if (it->set == NULL) {
        return bqsim_refuse(c, "read only: afe", path);
    }
    if (!bqsim_argument(c, "value", &word)) {
        return BQSIM_ERR;
    }
    if (!bqsim_read_value(it->as, word, it->low, it->high, &value)) {
        return bqsim_refuse(c, "value not possible here", word);
    }
    if (!bqsim_end(c)) {
        return BQSIM_ERR;
    }
    if (it->set(&c->s->afe, index, value) != 0) {
        return bqsim_refuse(c, "the model refuses this value now", word);
    }
    return bqsim_accept(c, NULL);
}

bqsim_result bqsim_afe_get(bqsim_call *c, bqsim_text path)
{
    int index;
    char text[80];
    const item *it;

    if (!bqsim_afe_present(c)) {
        return BQSIM_ERR;
    }
    it = find_item(&c->s->afe, path, &index);
    if (it == NULL) {
        return bqsim_refuse(c, "unknown path afe", path);
    }
    if (it->get == NULL) {
        return bqsim_refuse(c, "write only: afe", path);
    }
    if (!bqsim_end(c)) {
        return BQSIM_ERR;
    }
    if (it->as == BQSIM_NAME) {
        return bqsim_accept(c, mode[(unsigned)it->get(&c->s->afe, index)]);
    }
    bqsim_print_value(it->as, it->get(&c->s->afe, index), text, sizeof text);
    return bqsim_accept(c, text);
}
