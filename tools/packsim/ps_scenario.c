/* SPDX-License-Identifier: Apache-2.0 */
/* From entries to a checked scenario. */
#include "ps_scenario.h"
#include "sim_cells_x0.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

typedef struct build {
    ps_scenario *s;
    ps_ini *ini;
    const ps_search *search;
    ps_error *e;
} build;

static int number(const build *b, const char *section, const char *key, double low, double high,
                  double *value)
{
    ps_place at;
    const char *text = ps_ini_get(b->ini, section, key, &at);
    if (text == NULL) {
        return 0;
    }
    if (!ps_number(text, value) || *value < low || *value > high) {
        return ps_fail(b->e, at, "%s: %s is not a number in %g..%g", key, text, low, high);
    }
    return 0;
}

static int whole(const build *b, const char *section, const char *key, int low, int high, int *value)
{
    ps_place at;
    const char *text = ps_ini_get(b->ini, section, key, &at);
    if (text == NULL) {
        return 0;
    }
    if (!ps_int(text, value) || *value < low || *value > high) {
        return ps_fail(b->e, at, "%s: %s is not a whole number in %d..%d", key, text, low, high);
    }
    return 0;
}

static int time_key(const build *b, const char *section, const char *key, uint64_t *ns)
{
    ps_place at;
    const char *text = ps_ini_get(b->ini, section, key, &at);
    if (text == NULL) {
        return 0;
    }
    return ps_time(text, ns)
               ? 0
               : ps_fail(b->e, at, "%s: %s is not a time (number and us, ms, s, min or h)", key, text);
}

/* A file beside the scenario, in the working directory, or among the data that comes with packsim. */
static void find_file(const build *b, const char *name, char *path, size_t size)
{
    const char *const dirs[] = {b->search->scenario_dir, "", b->search->data_dir};
    for (size_t i = 0; i < sizeof dirs / sizeof dirs[0] && name[0] != '/'; i++) {
        (void)snprintf(path, size, "%s%s%s", dirs[i], dirs[i][0] != '\0' ? "/" : "", name);
        if (access(path, R_OK) == 0) {
            return;
        }
    }
    (void)snprintf(path, size, "%s", name);
}

/* ---- [pack] --------------------------------------------------------------------------------- */

static int build_monitor(const build *b)
{
    ps_place at = {b->search->scenario_dir, 0};
    const char *text = ps_ini_get(b->ini, "pack", "monitor", &at);
    if (text == NULL) {
        at = b->ini->count > 0 ? b->ini->entry[0].at : (ps_place){"scenario", 0};
        return ps_fail(b->e, at, "[pack] has no monitor");
    }
    b->s->pack_at = at;
    b->s->part = sim_x0_find_part(text);
    return b->s->part != NULL || strcmp(text, "bq76pl536") == 0
               ? 0
               : ps_fail(b->e, at, "monitor: unknown part %s", text);
}

/* A key that only the other kind of monitor has. */
static int foreign(const build *b, const char *key, bool of_afe)
{
    ps_place at;
    if (ps_ini_get(b->ini, "pack", key, &at) == NULL || of_afe == (b->s->part != NULL)) {
        return 0;
    }
    return ps_fail(b->e, at, "%s concerns a %s", key, of_afe ? "bq769x0" : "bq76pl536");
}

static int build_afe_cells(const build *b)
{
    ps_scenario *s = b->s;
    s->cells = s->part->cells;
    if (whole(b, "pack", "cells", 1, SIM_CELLS_MAX, &s->cells) != 0) {
        return -1;
    }
    ps_place at = s->pack_at;
    (void)ps_ini_get(b->ini, "pack", "cells", &at);
    if (sim_cells_x0_share(&s->world, s->part->cells, s->cells) != 0) {
        return ps_fail(b->e, at, "%d cells cannot be connected to a %s", s->cells, s->part->name);
    }
    s->devices = 1;
    s->sensors = s->world.modules;
    return 0;
}

static int build_cells(const build *b)
{
    ps_scenario *s = b->s;
    if (s->part != NULL) {
        return build_afe_cells(b);
    }
    if (whole(b, "pack", "devices", 1, (int)BQ76PL536_MAX_DEVICES, &s->devices) != 0 ||
        whole(b, "pack", "cells", 1, SIM_CELLS_MAX, &s->cells) != 0) {
        return -1;
    }
    if (s->devices == 0 && s->cells == 0) {
        return ps_fail(b->e, s->pack_at, "[pack] has neither devices nor cells");
    }
    s->devices = s->devices != 0 ? s->devices : (s->cells + 5) / 6;
    s->cells = s->cells != 0 ? s->cells : 6 * s->devices;
    ps_place at = s->pack_at;
    (void)ps_ini_get(b->ini, "pack", "cells", &at);
    if (s->cells < 3 * s->devices || s->cells > 6 * s->devices) {
        return ps_fail(b->e, at, "%d cells cannot be shared by %d devices of 3 to 6 cells", s->cells,
                       s->devices);
    }
    s->sensors = s->devices * SIM_CELLS_SENSORS;
    s->world.modules = s->devices;
    for (int m = 0; m < s->devices; m++) {
        int n = s->cells / s->devices + (m < s->cells % s->devices ? 1 : 0);
        s->world.cells_in_module[m] = n;
        s->cells_of[m] = (uint8_t)n;
    }
    return 0;
}

static int build_chemistry(const build *b, bool *lfp)
{
    char path[PS_PATH], reason[PS_PATH + 256];
    ps_place at = b->s->pack_at;
    const char *text = ps_ini_get(b->ini, "pack", "chemistry", &at);
    text = text != NULL ? text : "nmc";
    *lfp = strcmp(text, "lfp") == 0;
    const char *name = *lfp ? "ocv_lfp.csv" : strcmp(text, "nmc") == 0 ? "ocv_nmc_lgm50.csv" : text;
    find_file(b, name, path, sizeof path);
    if (sim_ocv_load(&b->s->ocv, path, reason, sizeof reason) != 0) {
        return ps_fail(b->e, at, "chemistry: %s", reason);
    }
    return 0;
}

static int build_eprom(const build *b)
{
    ps_place at;
    const char *text = ps_ini_get(b->ini, "pack", "eprom", &at);
    b->s->eprom_fast = text != NULL && strcmp(text, "fast") == 0;
    if (text != NULL && !b->s->eprom_fast && strcmp(text, "blank") != 0) {
        return ps_fail(b->e, at, "eprom: %s is neither blank nor fast", text);
    }
    return 0;
}

static int build_pack(const build *b, bool *lfp)
{
    sim_cells_config *w = &b->s->world;
    double mohm = 2.0, shunt = 1.0;
    w->capacity_ah = 5.0;
    w->soc_percent = 50.0;
    w->ambient_c = 25.0;
    w->bleed_ohm = 33.0;
    b->s->adc_freeze = UINT64_MAX;
    if (build_monitor(b) != 0 || foreign(b, "devices", false) != 0 || foreign(b, "eprom", false) != 0 ||
        foreign(b, "adc_freeze", true) != 0 || build_cells(b) != 0 || build_chemistry(b, lfp) != 0 ||
        build_eprom(b) != 0 || number(b, "pack", "capacity_ah", 0.01, 4000.0, &w->capacity_ah) != 0 ||
        number(b, "pack", "resistance_mohm", 0.0, 1000.0, &mohm) != 0 ||
        number(b, "pack", "soc_percent", 0.0, 100.0, &w->soc_percent) != 0 ||
        number(b, "pack", "soc_spread_percent", 0.0, 100.0, &w->soc_spread_percent) != 0 ||
        number(b, "pack", "ambient_c", -40.0, 100.0, &w->ambient_c) != 0 ||
        number(b, "pack", "bleed_ohm", 0.1, 1e6, &w->bleed_ohm) != 0 ||
        number(b, "pack", "shunt_mohm", 0.1, 100.0, &shunt) != 0 ||
        time_key(b, "pack", "adc_freeze", &b->s->adc_freeze) != 0) {
        return -1;
    }
    b->s->shunt_ohm = shunt / 1000.0;
    w->resistance_ohm = mohm / 1000.0;
    w->ocv = &b->s->ocv;
    return 0;
}

/* ---- [run], [load] --------------------------------------------------------------------------- */

static int build_run(const build *b, const ps_override *o)
{
    ps_scenario *s = b->s;
    ps_place at = s->pack_at;
    s->duration = 60 * PS_S;
    s->period = 100 * PS_MS;
    s->seed = 1;
    if (time_key(b, "run", "duration", &s->duration) != 0 || time_key(b, "run", "period", &s->period) != 0) {
        return -1;
    }
    const char *text = ps_ini_get(b->ini, "run", "seed", &at);
    int seed = 1;
    if (text != NULL && (!ps_int(text, &seed) || seed < 0)) {
        return ps_fail(b->e, at, "seed: %s is not a whole number from 0", text);
    }
    s->seed = o->has_seed ? o->seed : (uint64_t)seed;
    s->world.seed = s->seed;
    (void)ps_ini_get(b->ini, "run", "duration", &at);
    if (s->duration == 0) {
        return ps_fail(b->e, at, "duration: nothing to simulate");
    }
    if (s->period < 10 * PS_MS || s->period > 10 * PS_S || s->period % PS_MS != 0) {
        (void)ps_ini_get(b->ini, "run", "period", &at);
        return ps_fail(b->e, at, "period: not a whole number of milliseconds in 10 ms..10 s");
    }
    return 0;
}

static int build_load(const build *b, const ps_override *o)
{
    ps_scenario *s = b->s;
    char path[PS_PATH], reason[PS_PATH + 256];
    ps_place at = s->pack_at;
    if (number(b, "load", "current_a", -10000.0, 10000.0, &s->load.constant_a) != 0) {
        return -1;
    }
    const char *request = ps_ini_get(b->ini, "load", "request", &at);
    s->request_on = request != NULL && strcmp(request, "on") == 0;
    if (request != NULL && !s->request_on && strcmp(request, "off") != 0) {
        return ps_fail(b->e, at, "request: %s is neither on nor off", request);
    }
    const char *name = ps_ini_get(b->ini, "load", "file", &at);
    if (name != NULL) {
        ps_place both;
        if (ps_ini_get(b->ini, "load", "current_a", &both) != NULL) {
            return ps_fail(b->e, at, "file and current_a exclude each other");
        }
        find_file(b, name, path, sizeof path);
    }
    if (o->current_file != NULL) {
        at = (ps_place){"--current", 1};
        (void)snprintf(path, sizeof path, "%s", o->current_file);
        name = path;
    }
    if (name != NULL && sim_cells_load_file(&s->load, path, reason, sizeof reason) != 0) {
        return ps_fail(b->e, at, "%s", reason);
    }
    s->has_load_file = name != NULL;
    return 0;
}

/* ---- [events], [expect] ---------------------------------------------------------------------- */

static int build_events(const build *b)
{
    ps_scenario *s = b->s;
    uint64_t last = 0;
    for (int i = 0; i < b->ini->count; i++) {
        const ps_ini_entry *x = &b->ini->entry[i];
        if (strcmp(x->section, "events") != 0) {
            continue;
        }
        if (s->events == PS_EVENTS) {
            return ps_fail(b->e, x->at, "more than %d events", PS_EVENTS);
        }
        ps_event *v = &s->event[s->events];
        if (ps_event_parse(v, s, x->key, x->value, x->at, b->e) != 0) {
            return -1;
        }
        if (v->t < last) {
            return ps_fail(b->e, x->at, "events are not in time order");
        }
        if (v->t > s->duration) {
            return ps_fail(b->e, x->at, "event after the end of the run");
        }
        last = v->t;
        s->events++;
    }
    return 0;
}

static int build_expects(const build *b)
{
    ps_scenario *s = b->s;
    for (int i = 0; i < b->ini->count; i++) {
        const ps_ini_entry *x = &b->ini->entry[i];
        if (strcmp(x->section, "expect") != 0) {
            continue;
        }
        if (s->expects == PS_EXPECTS) {
            return ps_fail(b->e, x->at, "more than %d expectations", PS_EXPECTS);
        }
        ps_expect *y = &s->expect[s->expects];
        if (ps_expect_parse(y, s, x->value, x->at, b->e) != 0) {
            return -1;
        }
        if (ps_expect_deadline(y) > s->duration) {
            return ps_fail(b->e, x->at, "looks beyond the end of the run");
        }
        if (y->kind == PS_EXP_SOC && s->app.pack.soc.points == 0) {
            return ps_fail(b->e, x->at, "the firmware has no state of charge for this curve");
        }
        s->expects++;
    }
    return 0;
}

/* A run cut short by the command line drops what lies beyond; one made longer keeps all. */
static void cut(ps_scenario *s, uint64_t duration)
{
    int kept = 0;
    s->duration = duration;
    while (s->events > 0 && s->event[s->events - 1].t > duration) {
        s->events--;
    }
    for (int i = 0; i < s->expects; i++) {
        if (ps_expect_deadline(&s->expect[i]) <= duration) {
            s->expect[kept++] = s->expect[i];
        }
    }
    s->expects_cut = s->expects - kept;
    s->expects = kept;
}

int ps_scenario_build(ps_scenario *s, ps_ini *ini, const ps_search *search, const ps_override *override,
                      ps_error *e)
{
    const build b = {s, ini, search, e};
    bool lfp = false;
    memset(s, 0, sizeof *s);
    if (build_pack(&b, &lfp) != 0 || build_run(&b, override) != 0 || build_load(&b, override) != 0) {
        return -1;
    }
    ps_limits_default(s, lfp);
    if (ps_limits_build(s, ini, e) != 0 || ps_ini_all_used(ini, e) != 0 || build_events(&b) != 0 ||
        build_expects(&b) != 0) {
        return -1;
    }
    if (override->duration != 0) {
        cut(s, override->duration);
    }
    return 0;
}
