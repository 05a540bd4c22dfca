/* SPDX-License-Identifier: Apache-2.0 */
/* Inputs and outputs of the bq76PL536 stack: one table row per path. */
#include "bqsim_call.h"
#include "bqsim_value.h"

static const bqsim_text nothing = {NULL, 0};

/* A row of dev.D: every value travels as a double. set == NULL: read only. */
typedef struct item {
    const char *name;
    bqsim_notation as;
    uint32_t index_first, index_last; /* both 0 = no index; above 0x3f = a register in hex */
    double low, high;
    int (*set)(bqsim_session *s, int device, int index, double value);
    double (*get)(const bqsim_session *s, int device, int index);
} item;

static int set_cell(bqsim_session *s, int d, int i, double v)
{
    return sim_pl_set_cell(&s->stack, d, i, v);
}

static double get_cell(const bqsim_session *s, int d, int i)
{
    return sim_pl_cell(&s->stack, d, i);
}

/* -1 stands for sum, as in the model. */
static int set_vbat(bqsim_session *s, int d, int i, double v)
{
    (void)i;
    if (sim_pl_set_vbat(&s->stack, d, v) != 0) {
        return -1;
    }
    s->vbat_is_sum[d] = v < 0.0;
    return 0;
}

static double get_vbat(const bqsim_session *s, int d, int i)
{
    (void)i;
    return s->vbat_is_sum[d] ? -1.0 : sim_pl_vbat(&s->stack, d);
}

static int set_ts(bqsim_session *s, int d, int i, double v)
{
    return sim_pl_set_ts_ratio(&s->stack, d, i, v);
}

static double get_ts(const bqsim_session *s, int d, int i)
{
    return sim_pl_ts_ratio(&s->stack, d, i);
}

static int set_gpai(bqsim_session *s, int d, int i, double v)
{
    (void)i;
    return sim_pl_set_gpai(&s->stack, d, v);
}

static double get_gpai(const bqsim_session *s, int d, int i)
{
    (void)i;
    return sim_pl_gpai(&s->stack, d);
}

static int set_gpio(bqsim_session *s, int d, int i, double v)
{
    (void)i;
    if (sim_pl_set_gpio(&s->stack, d, v > 0.5) != 0) {
        return -1;
    }
    s->gpio_level[d] = v > 0.5;
    return 0;
}

static double get_gpio(const bqsim_session *s, int d, int i)
{
    (void)i;
    return s->gpio_level[d];
}

static int set_tdie(bqsim_session *s, int d, int i, double v)
{
    (void)i;
    return sim_pl_set_tdie(&s->stack, d, v);
}

static double get_tdie(const bqsim_session *s, int d, int i)
{
    (void)i;
    return sim_pl_tdie(&s->stack, d);
}

static int set_supply(bqsim_session *s, int d, int i, double v)
{
    (void)i;
    return sim_pl_set_supply(&s->stack, d, v > 0.5);
}

static double get_supply(const bqsim_session *s, int d, int i)
{
    (void)i;
    return sim_pl_supply(&s->stack, d);
}

static int set_otp(bqsim_session *s, int d, int i, double v)
{
    return sim_pl_set_otp(&s->stack, d, (uint8_t)i, (uint8_t)v);
}

static double get_otp(const bqsim_session *s, int d, int i)
{
    return sim_pl_otp(&s->stack, d, (uint8_t)i);
}

static int set_vpp(bqsim_session *s, int d, int i, double v)
{
    (void)i;
    return sim_pl_set_vpp(&s->stack, d, v > 0.5);
}

static double get_vpp(const bqsim_session *s, int d, int i)
{
    (void)i;
    return sim_pl_vpp(&s->stack, d);
}

static double get_cb(const bqsim_session *s, int d, int i)
{
    (void)i;
    return sim_pl_cb(&s->stack, d);
}

static double get_mode(const bqsim_session *s, int d, int i)
{
    (void)i;
    return (double)sim_pl_get_mode(&s->stack, d);
}

static const char *const mode[] = {"off", "reset", "active", "sleep", "tsd", "uvlo", "locked"};

static const item items[] = {
    {"cell", BQSIM_VOLTS, 1, 6, -100.0, 100.0, set_cell, get_cell},
    {"vbat", BQSIM_VBAT, 0, 0, 0.0, 100.0, set_vbat, get_vbat},
    {"ts", BQSIM_NUMBER, 1, 2, -1.0, 2.0, set_ts, get_ts},
    {"gpai", BQSIM_NUMBER, 0, 0, -100.0, 100.0, set_gpai, get_gpai},
    {"gpio", BQSIM_LEVEL, 0, 0, 0.0, 1.0, set_gpio, get_gpio},
    {"tdie", BQSIM_NUMBER, 0, 0, -273.15, 1000.0, set_tdie, get_tdie},
    {"supply", BQSIM_SWITCH, 0, 0, 0.0, 1.0, set_supply, get_supply},
    {"otp", BQSIM_BYTE, 0x40, 0x4b, 0.0, 255.0, set_otp, get_otp},
    {"vpp", BQSIM_SWITCH, 0, 0, 0.0, 1.0, set_vpp, get_vpp},
    {"cb", BQSIM_BYTE, 0, 0, 0.0, 0.0, NULL, get_cb},
    {"mode", BQSIM_NAME, 0, 0, 0.0, 0.0, NULL, get_mode},
};

/* The row of a path without its device, and its index. */
static const item *find_item(bqsim_text path, int *index)
{
    bqsim_text name, part;
    uint32_t number = 0;
    uint8_t reg;

    if (!bqsim_part(&path, &name)) {
        return NULL;
    }
    for (size_t i = 0; i < sizeof items / sizeof items[0]; i++) {
        const item *it = &items[i];

        if (!bqsim_is(name, it->name)) {
            continue;
        }
        if (it->index_last == 0) {
            *index = 0;
            return bqsim_part(&path, &part) ? NULL : it;
        }
        if (!bqsim_part(&path, &part) || path.p != NULL) {
            return NULL;
        }
        if (it->as == BQSIM_BYTE) {
            if (!bqsim_hex8(part, &reg)) {
                return NULL;
            }
            number = reg;
        } else if (!bqsim_count(part, it->index_first, it->index_last, &number)) {
            return NULL;
        }
        *index = (int)number;
        return number >= it->index_first && number <= it->index_last ? it : NULL;
    }
    return NULL;
}

/* Devices first..last that a path names; `*` names all. */
static bool find_devices(const bqsim_session *s, bqsim_text part, bool several, int *first, int *last)
{
    uint32_t d;

    if (several && bqsim_is(part, "*")) {
        *first = 1;
        *last = s->stack.devices;
        return true;
    }
    if (!bqsim_count(part, 1, (uint32_t)s->stack.devices, &d)) {
        return false;
    }
    *first = (int)d;
    *last = (int)d;
    return true;
}

/* Everything of a dev path; NULL after a refusal. */
static const item *resolve(bqsim_call *c, bqsim_text path, bool several, int *first, int *last, int *index)
{
    bqsim_text device, whole = path;
    const item *it;

    if (!c->s->has_stack) {
        (void)bqsim_refuse(c, "no stack", nothing);
        return NULL;
    }
    if (!bqsim_part(&path, &device) || !find_devices(c->s, device, several, first, last)) {
        (void)bqsim_refuse(c, "no such device in dev", whole);
        return NULL;
    }
    it = find_item(path, index);
    if (it == NULL) {
        (void)bqsim_refuse(c, "unknown path dev", whole);
    }
    return it;
}

bqsim_result bqsim_stack_set_dev(bqsim_call *c, bqsim_text path)
{
    int first, last, index;
    bqsim_text word;
    double value;
    const item *it = resolve(c, path, true, &first, &last, &index);

    if (it == NULL) {
        return BQSIM_ERR;
    }
    if (it->set == NULL) {
        return bqsim_refuse(c, "read only: dev", path);
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
    for (int d = first; d <= last; d++) {
        if (it->set(c->s, d, index, value) !=
            0) { /* depends on the value alone: the first device refuses or none */
            return bqsim_refuse(c, "the model refuses this value", word);
        }
    }
    return bqsim_accept(c, NULL);
}

bqsim_result bqsim_stack_get_dev(bqsim_call *c, bqsim_text path)
{
    int device, last, index;
    char text[80];
    const item *it = resolve(c, path, false, &device, &last, &index);

    if (it == NULL || !bqsim_end(c)) {
        return BQSIM_ERR;
    }
    if (it->as == BQSIM_NAME) {
        return bqsim_accept(c, mode[(unsigned)it->get(c->s, device, index)]);
    }
    bqsim_print_value(it->as, it->get(c->s, device, index), text, sizeof text);
    return bqsim_accept(c, text);
}

bqsim_result bqsim_stack_set_pin(bqsim_call *c, bqsim_text path)
{
    bqsim_text word;
    double level;

    if (!c->s->has_stack) {
        return bqsim_refuse(c, "no stack", nothing);
    }
    if (!bqsim_is(path, "conv")) {
        return bqsim_refuse(c, "unknown or read-only path pin", path);
    }
    if (!bqsim_argument(c, "level", &word)) {
        return BQSIM_ERR;
    }
    if (!bqsim_choice(word, "0", "1", &level)) {
        return bqsim_refuse(c, "a level is 0 or 1", word);
    }
    if (!bqsim_end(c)) {
        return BQSIM_ERR;
    }
    sim_pl_set_conv(&c->s->stack, level > 0.5);
    return bqsim_accept(c, NULL);
}

bqsim_result bqsim_stack_get_pin(bqsim_call *c, bqsim_text path)
{
    static const struct {
        const char *name;
        bool (*get)(const sim_pl *s);
    } pins[] = {{"conv", sim_pl_conv},
                {"fault", sim_pl_fault_pin},
                {"alert", sim_pl_alert_pin},
                {"drdy", sim_pl_drdy_pin}};

    if (!c->s->has_stack) {
        return bqsim_refuse(c, "no stack", nothing);
    }
    for (size_t i = 0; i < sizeof pins / sizeof pins[0]; i++) {
        if (bqsim_is(path, pins[i].name)) {
            return bqsim_end(c) ? bqsim_accept(c, pins[i].get(&c->s->stack) ? "1" : "0") : BQSIM_ERR;
        }
    }
    return bqsim_refuse(c, "unknown path pin", path);
}
