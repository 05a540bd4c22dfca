/* SPDX-License-Identifier: Apache-2.0 */
#include "ps_rig.h"

#include <errno.h>
#include <math.h>
#include <string.h>

#define OBSERVE_STEP (4 * PS_MS) /* resolution of balancing times while the bus is busy */
#define BLED_LATELY (20 * PS_S)  /* without balancing for so long: look only once per world step */

uint64_t ps_rig_now(const ps_rig *r)
{
    return r->monitor->now(r);
}

/* ---- the world -------------------------------------------------------------------------------- */

double ps_rig_asked_at(const ps_rig *r, uint64_t t)
{
    return sim_cells_load_at(&r->s->load, (double)t / 1e9);
}

double ps_rig_current_at(const ps_rig *r, uint64_t t)
{
    unsigned open = r->welded ? PS_CHARGE | PS_DISCHARGE : r->paths;
    if (open == 0u) {
        return 0.0;
    }
    double asked = ps_rig_asked_at(r, t);
    return (open & (asked > 0.0 ? PS_CHARGE : PS_DISCHARGE)) != 0u ? asked : 0.0;
}

static void remember(ps_rig *r)
{
    ps_truth *t = &r->truth[r->truths % PS_TRUTHS];
    t->t = ps_rig_now(r);
    memcpy(t->volts, r->world.volts, (size_t)r->world.cells * sizeof t->volts[0]);
    r->truths++;
}

static void show(ps_rig *r)
{
    r->monitor->feed(r);
    remember(r);
}

static void observe(ps_rig *r)
{
    uint64_t now = ps_rig_now(r);
    if (now > r->observed_t) {
        if (r->monitor->observe(r, (double)(now - r->observed_t) / 1e9)) {
            r->bled_t = now;
        }
        r->observed_t = now;
    }
}

/* Brings the world to the present moment with the load it had until now. */
static void world_step(ps_rig *r)
{
    uint64_t now = ps_rig_now(r);
    observe(r);
    double to = ps_rig_current_at(r, now);
    sim_cells_step(&r->world, (double)(now - r->world_t) / 1e9, r->world_a, to);
    r->world_t = now;
    r->world_a = to;
}

/* A load that jumped takes effect at once. */
static void world_jump(ps_rig *r)
{
    r->world_a = ps_rig_current_at(r, ps_rig_now(r));
    sim_cells_step(&r->world, 0.0, r->world_a, r->world_a);
    show(r);
}

/* Brings moved paths into the world. */
static bool follow(ps_rig *r)
{
    unsigned paths = r->monitor->paths(r);
    if (paths == r->paths) {
        return false;
    }
    world_step(r);
    r->paths = paths;
    r->moved_t = ps_rig_now(r);
    world_jump(r);
    return true;
}

void ps_rig_follow(ps_rig *r)
{
    r->moved = follow(r) || r->moved;
}

static uint64_t piece_of(const ps_rig *r, uint64_t most)
{
    uint64_t due = r->monitor->due != NULL ? r->monitor->due(r) : most;
    return due < most ? due : most;
}

void ps_rig_advance(ps_rig *r, uint64_t ns)
{
    uint64_t now = ps_rig_now(r), end = now + ns;
    while (now < end) {
        uint64_t next = (now / r->step + 1u) * r->step;
        uint64_t piece = piece_of(r, (next < end ? next : end) - now);
        r->monitor->advance(r, piece);
        now += piece;
        if (r->monitor->due != NULL && follow(r)) {
            r->moved = true;
        }
        if (now == next) {
            world_step(r);
            show(r);
        } else if (now - r->observed_t >= OBSERVE_STEP && now - r->bled_t < BLED_LATELY) {
            observe(r);
        }
    }
}

void ps_rig_advance_hook(void *ctx, uint64_t ns)
{
    ps_rig_advance(ctx, ns);
}

bool ps_rig_outputs_on(const ps_rig *r)
{
    return r->monitor->paths(r) != 0u;
}

bool ps_rig_sync(ps_rig *r)
{
    bool moved = r->moved;
    r->moved = false;
    return follow(r) || moved;
}

const double *ps_rig_truth(const ps_rig *r, uint64_t t)
{
    unsigned kept = r->truths < PS_TRUTHS ? r->truths : PS_TRUTHS;
    for (unsigned i = 1; i <= kept; i++) {
        const ps_truth *x = &r->truth[(r->truths - i) % PS_TRUTHS];
        if (x->t <= t) {
            return x->volts;
        }
    }
    return NULL;
}

uint64_t ps_rig_bus_errors(const ps_rig *r)
{
    const bq_link_stats *now = r->afe.ops->stats(r->afe.ctx);
    uint64_t sum = 0;
    for (int life = 0; life < 2; life++) {
        const bq_link_stats *s = life == 0 ? &r->lost : now;
        sum += (uint64_t)s->crc_errors + s->no_answers + s->implausible + s->bus_errors + s->write_errors;
    }
    return sum;
}

/* ---- life ------------------------------------------------------------------------------------- */

int ps_rig_init(ps_rig *r, ps_scenario *s, ps_error *e)
{
    const ps_rig old = {.can = r->can,
                        .console = r->console,
                        .player = r->player,
                        .image = r->image,
                        .board = r->board,
                        .costs = r->costs,
                        .loop = r->loop};
    *r = old;
    r->player = r->player != NULL ? r->player : &ps_native;
    r->s = s;
    r->monitor = s->part != NULL ? &ps_afe : &ps_stack;
    r->step = s->period < r->monitor->world_step ? s->period : r->monitor->world_step;
    if (sim_cells_init(&r->world, &s->world) != 0 || r->monitor->build(r) != 0) {
        return ps_fail(e, s->pack_at, "the simulator refuses this pack");
    }
    show(r);
    r->request = s->request_on ? BQ_REQUEST_ON : BQ_REQUEST_OFF;
    return r->player->begin(r, e);
}

int ps_rig_record(ps_rig *r, const char *path)
{
    if (sim_vcd_open(&r->vcd, path) != 0) {
        return -1;
    }
    r->monitor->record(r, &r->vcd);
    r->recording = true;
    return 0;
}

int ps_rig_close(ps_rig *r)
{
    if (r->player != NULL) {
        r->player->end(r);
    }
    if (!r->recording) {
        return 0;
    }
    r->monitor->record(r, NULL);
    r->recording = false;
    return sim_vcd_close(&r->vcd, ps_rig_now(r));
}

/* ---- events ----------------------------------------------------------------------------------- */

void ps_rig_act(ps_rig *r, const ps_event *v)
{
    switch (v->kind) {
    case PS_ACT_REQUEST:
        r->request = v->on ? BQ_REQUEST_ON : BQ_REQUEST_OFF;
        r->player->request(r);
        return;
    case PS_ACT_MCU_RESET:
        r->player->reset(r);
        return;
    default:
        break;
    }
    world_step(r);
    switch (v->kind) {
    case PS_ACT_CELL_VOLTS:
        (void)sim_cells_force(&r->world, v->n, v->value);
        break;
    case PS_ACT_CELL_FREE:
        (void)sim_cells_free(&r->world, v->n);
        break;
    case PS_ACT_SENSOR:
        (void)sim_cells_force_sensor(&r->world, r->s->part != NULL ? sim_cells_x0_sensor(v->n) : v->n,
                                     v->value);
        break;
    case PS_ACT_CURRENT:
        r->s->load.use_table = 0;
        r->s->load.constant_a = v->value;
        break;
    case PS_ACT_CURRENT_FILE:
        r->s->load.use_table = 1;
        break;
    case PS_ACT_WELD:
        r->welded = true;
        hal_sim_weld(&r->hal, true);
        break;
    default:
        r->monitor->act(r, v);
        return;
    }
    world_jump(r);
}
