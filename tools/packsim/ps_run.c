/* SPDX-License-Identifier: Apache-2.0 */
#include "ps_run.h"
#include "ps_watch.h"

#include <math.h>
#include <time.h>

#define IDLE_LIMIT 100000 /* firmware steps without time passing */

static uint64_t wall_ns(void)
{
    struct timespec t = {0, 0};
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * PS_S + (uint64_t)t.tv_nsec;
}

static void tell(const ps_run *u, const char *what, const char *name, const char *more)
{
    if (u->decisions != NULL) {
        (void)fprintf(u->decisions, "%.3f %s %s%s\n", (double)ps_rig_now(u->rig) / 1e9, what, name, more);
    }
}

static void tell_faults(const ps_run *u, uint32_t changed, uint32_t active)
{
    for (unsigned i = 0; i < (unsigned)BQ_FAULT_COUNT; i++) {
        if ((changed >> i & 1u) != 0u) {
            tell(u, "fault", bq_pack_fault_name((bq_pack_fault)i),
                 (active >> i & 1u) != 0u ? " active" : " gone");
        }
    }
}

static void tell_decisions(ps_run *u)
{
    int state = (int)bq_app_pack(&u->rig->fw.firmware.app)->state;
    bool on = ps_rig_outputs_on(u->rig);
    if (state != u->told_state) {
        tell(u, "state", bq_pack_state_name((bq_pack_state_id)state), "");
    }
    if (on != u->told_outputs) {
        tell(u, "outputs", on ? "on" : "off", "");
    }
    u->told_state = state;
    u->told_outputs = on;
}

static void watch_faults(ps_run *u)
{
    const bq_pack *pack = bq_app_pack(&u->rig->fw.firmware.app);
    uint32_t fresh = pack->faults & ~u->fault_mask;
    tell_faults(u, pack->faults ^ u->fault_mask, pack->faults);
    u->fault_mask = pack->faults;
    for (int i = 0; fresh != 0u; i++, fresh >>= 1) {
        if ((fresh & 1u) != 0u) {
            const bq_pack_fault_record *f = &pack->fault[i];
            ps_fault_seen seen = {ps_rig_now(u->rig), i, f->cell, f->device, f->sensor};
            ps_judge_fault(u->judge, &seen);
        }
    }
}

/* Worst difference between what was measured and what was true at the conversion. */
static void watch_cells(ps_run *u, const bq_sample *s)
{
    const ps_rig *r = u->rig;
    uint32_t age_us = (uint32_t)(ps_rig_now(r) / 1000u) - s->t_us;
    /* the last nanosecond of the microsecond that the firmware knows: what changed at its beginning was
     * measured */
    uint64_t t = r->monitor->conversion(r, (ps_rig_now(r) / 1000u - age_us) * 1000u + 999u);
    const double *truth = t != UINT64_MAX ? ps_rig_truth(r, t) : NULL;
    if (truth == NULL) {
        return;
    }
    double worst = u->totals.measurement_mv;
    for (int i = 0; i < s->cell_count; i++) {
        const bq_cell_reading *c = &s->cells[i];
        if ((c->quality & BQ_Q_VALID) != 0u &&
            s->modules[c->module].age_ms <= age_us / 1000u + 1u + r->monitor->age_slack_ms) {
            double error = fabs((double)c->mv - truth[i] * 1000.0);
            worst = error > worst ? error : worst;
        }
    }
    u->totals.measurement_mv = worst;
}

static void watch_soc(ps_run *u)
{
    int16_t permille = bq_app_pack(&u->rig->fw.firmware.app)->summary.soc_permille;
    if (permille >= 0) {
        double error = fabs((double)permille / 10.0 - sim_cells_mean_soc(&u->rig->world));
        u->totals.soc_percent = error > u->totals.soc_percent ? error : u->totals.soc_percent;
    }
}

static void watch_sample(ps_run *u)
{
    const bq_sample *s = bq_app_sample(&u->rig->fw.firmware.app);
    if (s->cell_count == 0u || s->sequence == u->sequence) {
        return;
    }
    uint64_t bytes = u->rig->monitor->bytes(u->rig);
    if (u->seen_sample) {
        u->bytes_sum += bytes - u->bytes_at_sample;
        u->bytes_scans++;
    }
    u->seen_sample = true;
    u->bytes_at_sample = bytes;
    u->sequence = s->sequence;
    u->scans++;
    watch_cells(u, s);
    watch_soc(u);
}

static void look(ps_run *u)
{
    ps_rig *r = u->rig;
    const bq_pack *pack = bq_app_pack(&r->fw.firmware.app);
    int found = r->afe.ops->modules_found(r->afe.ctx);
    bool running = pack->state == BQ_PACK_STANDBY || pack->state == BQ_PACK_ON;
    ps_view view = {
        .state = (int)pack->state,
        .found = found,
        .outputs_on = ps_rig_outputs_on(r),
        .healthy = running && pack->faults == 0u && pack->summary.complete && found == r->s->devices,
        .spread_mv = sim_cells_spread(&r->world) * 1000.0,
    };
    ps_judge_look(u->judge, ps_rig_now(r), &view);
    u->next_look = ps_judge_next(u->judge);
}

/* A new life of the firmware has begun. */
static void forget(ps_run *u)
{
    u->seen_sample = false;
    u->sequence = 0;
    u->fault_mask = 0;
}

static void do_events(ps_run *u, uint64_t now)
{
    const ps_scenario *s = u->rig->s;
    while (u->next_event < s->events && s->event[u->next_event].t <= now) {
        const ps_event *v = &s->event[u->next_event++];
        ps_rig_act(u->rig, v);
        if (v->kind == PS_ACT_MCU_RESET) {
            forget(u);
        }
    }
}

static void progress(ps_run *u, uint64_t now)
{
    u->next_progress = now + (u->watch ? 1u : 10u) * 100u * PS_MS;
    uint64_t wall = wall_ns();
    if (wall - u->shown_wall_ns < 200 * PS_MS) {
        return;
    }
    u->shown_wall_ns = wall;
    if (u->watch) {
        ps_watch_draw(stderr, now, &u->rig->fw.firmware.app, u->found, u->drawn ? 0 : 1);
        u->drawn = true;
        return;
    }
    (void)fprintf(stderr, "\r%.0f / %.0f s  %s   ", (double)now / 1e9, (double)u->rig->s->duration / 1e9,
                  bq_pack_state_name(bq_app_pack(&u->rig->fw.firmware.app)->state));
}

static bool rows_wanted(const ps_run *u)
{
    return u->csv != NULL || u->report != NULL;
}

static void rows(ps_run *u)
{
    if (u->csv != NULL) {
        ps_csv_row(u->csv, u->next_row, &u->rig->fw.firmware.app, &u->rig->world);
    }
    if (u->report != NULL) {
        ps_report_take(u->report, u->next_row, &u->rig->fw.firmware.app);
    }
    u->next_row += u->rig->s->period;
}

/* One turn of the firmware, with everything that is due at this moment. Returns its hint in nanoseconds. */
static uint64_t turn(ps_run *u, uint64_t now)
{
    ps_rig *r = u->rig;
    do_events(u, now);
    uint64_t hint = r->player->pass(r);
    if (ps_rig_sync(r)) {
        ps_judge_outputs(u->judge, r->moved_t, ps_rig_outputs_on(r));
    }
    if (bq_app_pack(&r->fw.firmware.app)->faults != u->fault_mask) {
        watch_faults(u);
    }
    tell_decisions(u);
    watch_sample(u);
    if (r->player->restarted(r)) {
        forget(u);
        hint = 0;
    }
    if (u->next_look <= now) {
        look(u);
    }
    while (rows_wanted(u) && u->next_row <= now) {
        rows(u);
    }
    if ((u->progress || u->watch) && u->next_progress <= now) {
        progress(u, now);
    }
    return hint;
}

static uint64_t earlier(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static uint64_t next_stop(const ps_run *u)
{
    const ps_scenario *s = u->rig->s;
    uint64_t stop = earlier(s->duration, u->next_look);
    if (rows_wanted(u)) {
        stop = earlier(stop, u->next_row);
    }
    if (u->console != NULL) {
        stop = earlier(stop, ps_rig_now(u->rig) + PS_CONSOLE_STEP);
    }
    return u->next_event < s->events ? earlier(stop, s->event[u->next_event].t) : stop;
}

/* Keys for the next pass. False: the user has left. */
static bool keys(ps_run *u, uint64_t now)
{
    if (u->console == NULL) {
        return true;
    }
    ps_console_turn(u->console, now);
    return !u->console->left;
}

static void loop(ps_run *u)
{
    ps_rig *r = u->rig;
    uint64_t now = ps_rig_now(r), idle = 0;
    while (keys(u, now)) {
        uint64_t hint = turn(u, now);
        int found = r->afe.ops->modules_found(r->afe.ctx);
        u->found = found > u->found ? found : u->found;
        now = ps_rig_now(r);
        uint64_t stop = next_stop(u);
        if (stop <= now) {
            if (now >= r->s->duration && u->next_look > now && (!rows_wanted(u) || u->next_row > now)) {
                return;
            }
            continue;
        }
        idle = hint == 0 ? idle + 1 : 0;
        uint64_t dt = hint == 0 && idle > IDLE_LIMIT ? 1000u : hint;
        r->player->elapse(r, earlier(dt, stop - now));
        now = ps_rig_now(r);
    }
}

static unsigned long misuses(ps_rig *r)
{
    const sim_misuse *inside = r->player->misuse(r);
    return r->monitor->misuse(r)->count + (inside != NULL ? inside->count : 0u);
}

void ps_run_all(ps_run *u)
{
    u->totals.measurement_mv = -1.0;
    u->totals.soc_percent = -1.0;
    u->next_row = u->rig->s->period;
    u->next_look = ps_judge_next(u->judge);
    u->spread_start_mv = sim_cells_spread(&u->rig->world) * 1000.0;
    uint64_t begin = wall_ns();
    loop(u);
    double seconds = (double)(wall_ns() - begin) / 1e9;
    u->simulated = ps_rig_now(u->rig);
    u->spread_end_mv = sim_cells_spread(&u->rig->world) * 1000.0;
    u->bytes_per_scan = u->bytes_scans > 0 ? (double)u->bytes_sum / (double)u->bytes_scans : 0.0;
    u->totals.misuse = misuses(u->rig);
    u->speed = (double)u->simulated / 1e9 / (seconds > 1e-9 ? seconds : 1e-9);
    u->totals.speed = u->rig->player == &ps_image ? -1.0 : u->speed;
    ps_judge_end(u->judge, &u->totals);
    if (u->watch) {
        ps_watch_draw(stderr, u->simulated, &u->rig->fw.firmware.app, u->found, 0);
    } else if (u->progress) {
        (void)fputs("\r\033[K", stderr);
    }
}
