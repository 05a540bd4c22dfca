/* SPDX-License-Identifier: Apache-2.0 */
/* The [limits] section: fields of the pack controller, of the super-loop and of the driver, under the
 * firmware's own names. */
#include "ps_scenario.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

enum { ANY, STACK, AFE }; /* which packs have the field */

/* Fields that the pack controller has no setter for. */
static const struct {
    const char *name;
    size_t offset, size;
    int family;
    bool is_bool;
} fields[] = {
#define DRIVER(name, member, is_bool)                                                                        \
    {                                                                                                        \
        name, offsetof(ps_scenario, driver.member), sizeof(((ps_scenario *)NULL)->driver.member), STACK,     \
            is_bool                                                                                          \
    }
#define AFE_DRIVER(member, is_bool)                                                                          \
    {                                                                                                        \
#member, offsetof(ps_scenario, afe.member), sizeof(((ps_scenario *)NULL)->afe.member), AFE, is_bool  \
    }
    DRIVER("cov_mv", cov_mv, false),
    DRIVER("cuv_mv", cuv_mv, false),
    DRIVER("cov_delay_us", cov_delay_us, false),
    DRIVER("cuv_delay_us", cuv_delay_us, false),
    DRIVER("ot1_c", ot_c[0], false),
    DRIVER("ot2_c", ot_c[1], false),
    DRIVER("ot_delay_ms", ot_delay_ms, false),
    DRIVER("spi_hz", spi_hz, false),
    DRIVER("balance_timer_s", balance_timer_s, false),
    DRIVER("balance_settle_ms", balance_settle_ms, false),
    DRIVER("sensor_settle_ms", sensor_settle_ms, false),
    DRIVER("scrub_period_ms", scrub_period_ms, false),
    DRIVER("wire_limit_mv", wire_limit_mv, false),
    DRIVER("frozen_scans", frozen_scans, false),
    DRIVER("use_conv_pin", use_conv_pin, true),
    DRIVER("variant_a", variant_a, true),
    DRIVER("allow_partial", allow_partial, true),
    DRIVER("warm_start", warm_start, true),
    AFE_DRIVER(ov_mv, false),
    AFE_DRIVER(uv_mv, false),
    AFE_DRIVER(ov_recover_mv, false),
    AFE_DRIVER(uv_recover_mv, false),
    AFE_DRIVER(ov_delay_s, false),
    AFE_DRIVER(uv_delay_s, false),
    AFE_DRIVER(ocd_ma, false),
    AFE_DRIVER(scd_ma, false),
    AFE_DRIVER(ocd_delay_ms, false),
    AFE_DRIVER(scd_delay_us, false),
    AFE_DRIVER(load_settle_ms, false),
    AFE_DRIVER(frozen_scans, false),
    AFE_DRIVER(balance_timer_s, false),
    AFE_DRIVER(balance_across_groups, true),
    AFE_DRIVER(keep_fets, true),
    {"retry_ms", offsetof(ps_scenario, app.retry_ms), sizeof(uint32_t), ANY, false},
    {"precharge_ms", offsetof(ps_scenario, app.precharge_ms), sizeof(uint16_t), ANY, false},
    {"precharge_end_ma", offsetof(ps_scenario, app.precharge_end_ma), sizeof(uint32_t), ANY, false},
    {"soc_rest_ma", offsetof(ps_scenario, app.pack.soc.rest_ma), sizeof(int32_t), ANY, false},
    {"soc_rest_ms", offsetof(ps_scenario, app.pack.soc.rest_ms), sizeof(uint32_t), ANY, false},
    {"soc_gap_ms", offsetof(ps_scenario, app.pack.soc.gap_ms), sizeof(uint32_t), ANY, false},
#undef AFE_DRIVER
#undef DRIVER
};

#define FIELDS ((int)(sizeof fields / sizeof fields[0]))

bool ps_limit_follows(const char *key)
{
    return strcmp(key, "cells") == 0 || strcmp(key, "sensors") == 0 || strcmp(key, "modules") == 0;
}

const char *ps_limit_name(int i)
{
    if (i < FIELDS) {
        return fields[i].name;
    }
    return bq_pack_config_field((uint16_t)(i - FIELDS));
}

/* 0, 1 = no such field, -1 = outside its range. */
static int set_field(ps_scenario *s, const char *key, int value)
{
    for (int i = 0; i < FIELDS; i++) {
        if (strcmp(key, fields[i].name) != 0 || fields[i].family == (s->part != NULL ? STACK : AFE)) {
            continue;
        }
        unsigned char *p = (unsigned char *)s + fields[i].offset;
        if (value < 0 || (fields[i].size < sizeof value && value >> (8u * (unsigned)fields[i].size) != 0)) {
            return -1;
        }
        if (fields[i].is_bool && value > 1) {
            return -1;
        }
        uint8_t u8 = (uint8_t)value;
        uint16_t u16 = (uint16_t)value;
        uint32_t u32 = (uint32_t)value;
        const void *from = fields[i].size == 1   ? (const void *)&u8
                           : fields[i].size == 2 ? (const void *)&u16
                                                 : &u32;
        memcpy(p, from, fields[i].size);
        return 0;
    }
    return 1;
}

static int apply_key(ps_scenario *s, const char *key, const char *text, ps_place at, ps_error *e)
{
    int value = 0;
    int known = set_field(s, key, 0);
    int32_t old = 0;
    if (known == 1 && bq_pack_config_get(&s->app.pack, key, &old) != BQ_OK) {
        return ps_fail(e, at, "unknown key %s in [limits]", key);
    }
    if (ps_limit_follows(key)) {
        return ps_fail(e, at, "%s follows from [pack]", key);
    }
    if (!ps_int(text, &value)) {
        return ps_fail(e, at, "%s: %s is not a whole number", key, text);
    }
    bool refused =
        known != 1 ? set_field(s, key, value) != 0 : bq_pack_config_set(&s->app.pack, key, value) != BQ_OK;
    return refused ? ps_fail(e, at, "%s: %d is outside its range", key, value) : 0;
}

/* ---- defaults ------------------------------------------------------------------------------- */

static void soc_default(ps_scenario *s)
{
    for (int i = 0; i < s->ocv.points; i++) {
        s->soc_points[i].permille = (uint16_t)(s->ocv.soc[i] * 10.0 + 0.5);
        s->soc_points[i].mv = (uint16_t)(s->ocv.v[i] * 1000.0 + 0.5);
    }
    bq_soc_config *c = &s->app.pack.soc;
    c->ocv = s->soc_points;
    c->points = (uint16_t)s->ocv.points;
    c->capacity_mah = (uint32_t)(s->world.capacity_ah * 1000.0 + 0.5);
    c->rest_ma = 500;
    c->rest_ms = 2000;
    c->gap_ms = 5000;
    if (!bq_soc_config_ok(c)) {
        memset(c, 0, sizeof *c); /* a curve that the firmware cannot use: no state of charge */
    }
}

static void stack_default(ps_scenario *s, bool lfp)
{
    bq76pl536_config *d = &s->driver;
    d->devices = (uint8_t)s->devices;
    d->cells = s->cells_of;
    d->sensors = SIM_CELLS_SENSORS;
    d->thermistor = &bq_thermistor_103at;
    d->cov_mv = lfp ? 3850 : 4350;
    d->cuv_mv = lfp ? 2000 : 2500;
    d->cov_delay_us = 500000;
    d->cuv_delay_us = 500000;
    d->ot_c[0] = 70;
    d->ot_c[1] = 70;
    d->ot_delay_ms = 500;
    uint32_t timer_s = s->app.period_ms * 125u / 90000u + 2u;
    d->balance_timer_s = (uint8_t)(timer_s < 4u ? 4u : timer_s);
}

void ps_limits_default(ps_scenario *s, bool lfp)
{
    uint16_t cells = (uint16_t)s->cells, sensors = (uint16_t)s->sensors;
    uint16_t modules = (uint16_t)s->devices;
    s->app.pack =
        lfp ? bq_pack_config_lfp(cells, sensors, modules) : bq_pack_config_nmc(cells, sensors, modules);
    s->app.period_ms = (uint32_t)(s->period / PS_MS);
    uint32_t patience = 4u * s->app.period_ms;
    if (s->app.pack.comm_timeout_ms < patience && patience <= 30000u) {
        s->app.pack.comm_timeout_ms = (uint16_t)patience;
    }
    soc_default(s);
    if (s->part != NULL) {
        ps_afe_default(s, lfp);
    } else {
        stack_default(s, lfp);
    }
}

/* ---- the firmware's own validators ------------------------------------------------------------ */

static bq_status no_start(void *ctx, const uint8_t *tx, uint8_t *rx, size_t len)
{
    (void)ctx;
    (void)tx;
    (void)rx;
    (void)len;
    return BQ_E_BUS;
}

static bq_status no_poll(void *ctx)
{
    (void)ctx;
    return BQ_E_BUS;
}

static bq_status no_clock(void *ctx, uint32_t hz)
{
    (void)ctx;
    (void)hz;
    return BQ_OK;
}

static uint32_t no_time(void *ctx)
{
    (void)ctx;
    return 0;
}

static bq_status check_driver(const bq76pl536_config *config)
{
    static const bq_spi_ops ops = {no_start, no_poll, no_clock};
    static bq76pl536 d;
    static bq76pl536_device devices[BQ76PL536_MAX_DEVICES];
    const bq_spi spi = {&ops, NULL};
    const bq_clock clock = {no_time, NULL};
    return bq76pl536_init(&d, config, &spi, NULL, &clock, devices, BQ76PL536_MAX_DEVICES);
}

typedef bq_status (*checker)(const ps_scenario *s, const char **field);

static bq_status check_app(const ps_scenario *s, const char **field)
{
    return bq_app_config_validate(&s->app, field);
}

static bq_status check_monitor(const ps_scenario *s, const char **field)
{
    if (s->part != NULL) {
        *field = "the driver's configuration";
        return ps_afe_check(s);
    }
    bq_status status = check_driver(&s->driver);
    *field = status == BQ_E_COV_CUV ? "cov_mv - cuv_mv" : "the driver's configuration";
    return status;
}

/* Which line is to blame: that of the field itself, or the first that is refused when it alone differs from
 * the defaults. */
static ps_place blame(const ps_scenario *s, ps_ini *ini, const ps_scenario *plain, checker check,
                      const char *field)
{
    static ps_scenario one;
    ps_place at = s->pack_at;
    if (ps_ini_get(ini, "limits", field, &at) != NULL) {
        return at;
    }
    for (int i = 0; i < ini->count; i++) {
        const ps_ini_entry *x = &ini->entry[i];
        const char *ignored = NULL;
        ps_error unused = {0};
        one = *plain;
        if (strcmp(x->section, "limits") == 0 && apply_key(&one, x->key, x->value, x->at, &unused) == 0 &&
            check(&one, &ignored) != BQ_OK) {
            return x->at;
        }
    }
    return at;
}

/* With the key of the line to blame in front, when it is another one than the field. */
static int refuse(const ps_scenario *s, ps_ini *ini, const ps_scenario *plain, checker check, ps_error *e)
{
    const char *field = NULL, *key = NULL;
    bq_status status = check(s, &field);
    if (status == BQ_OK) {
        return 0;
    }
    field = field != NULL ? field : "limits";
    ps_place at = blame(s, ini, plain, check, field);
    for (int i = 0; i < ini->count; i++) {
        const ps_ini_entry *x = &ini->entry[i];
        if (strcmp(x->section, "limits") == 0 && x->at.file == at.file && x->at.line == at.line) {
            key = x->key;
        }
    }
    if (status == BQ_E_COV_CUV) {
        return ps_fail(e, at, "cov_mv %u and cuv_mv %u are less than 300 mV apart (%s)",
                       (unsigned)s->driver.cov_mv, (unsigned)s->driver.cuv_mv, bq_status_name(status));
    }
    if (key == NULL || strcmp(key, field) == 0) {
        return ps_fail(e, at, "%s is refused (%s)", field, bq_status_name(status));
    }
    return ps_fail(e, at, "%s: %s is refused (%s)", key, field, bq_status_name(status));
}

int ps_limits_build(ps_scenario *s, ps_ini *ini, ps_error *e)
{
    static ps_scenario plain;
    plain = *s;
    for (int i = 0; i < ini->count; i++) {
        ps_ini_entry *x = &ini->entry[i];
        if (strcmp(x->section, "limits") == 0) {
            x->used = true;
            if (apply_key(s, x->key, x->value, x->at, e) != 0) {
                return -1;
            }
        }
    }
    s->app.balance_timer_s = s->part != NULL ? s->afe.balance_timer_s : s->driver.balance_timer_s;
    return refuse(s, ini, &plain, check_app, e) != 0 ? -1 : refuse(s, ini, &plain, check_monitor, e);
}
