/* SPDX-License-Identifier: Apache-2.0 */
#include "ps_rig.h"

#include <errno.h>
#include <math.h>
#include <string.h>

#define OBSERVE_STEP (4 * PS_MS) /* resolution of balancing times while the bus is busy */
#define BLED_LATELY (20 * PS_S)  /* without balancing for so long: look only once per world step */
#define POISON 0xa5

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

/* ---- the firmware ----------------------------------------------------------------------------- */

static bq_status read_ammeter(void *ctx, int32_t *current_ma)
{
    ps_rig *r = ctx;
    *current_ma = (int32_t)lround(ps_rig_current_at(r, ps_rig_now(r)) * 1000.0);
    return BQ_OK;
}

static void feed_watchdog(void *ctx)
{
    ps_rig *r = ctx;
    uint64_t gap = ps_rig_now(r) - r->fed_t;
    r->fed_gap = gap > r->fed_gap ? gap : r->fed_gap;
    r->fed_t += gap;
}

/* Carried out when the present pass has returned: ps_rig_sync(). */
static void ask_reset(void *ctx)
{
    ((ps_rig *)ctx)->reset_asked = true;
}

static uint32_t stack_free(void *ctx)
{
    (void)ctx;
    return 0; /* of a PC nobody knows */
}

static bq_board board_of(ps_rig *r)
{
    static const bq_mcu_ops mcu = {feed_watchdog, ask_reset, stack_free};
    bq_board board = {0};
    board.name = "packsim";
    board.gpio = r->monitor->gpio(r);
    board.clock = r->monitor->clock(r);
    if (!r->monitor->measures_current) {
        board.ammeter = (bq_ammeter){read_ammeter, r};
    }
    board.can = r->can;
    board.console = r->console;
    board.mcu = (bq_mcu){&mcu, r, &r->boot};
    return board;
}

static bq_status boot(ps_rig *r, bq_reset_cause cause)
{
    ps_firmware *f = &r->fw;
    const bq_board board = board_of(r);
    bq_status status = r->monitor->init(r);
    if (status != BQ_OK) {
        return status;
    }
    r->boot = (bq_boot){.cause = cause, .image_ok = true};
    r->reset_asked = false;
    r->fed_t = ps_rig_now(r);
    return bq_firmware_init(&f->firmware, &board, &r->s->app, &r->afe, f->cells, SIM_CELLS_MAX, f->temps,
                            SIM_CELLS_MODULES * SIM_CELLS_SENSORS, f->modules, SIM_CELLS_MODULES);
}

static uint64_t errors_of(const bq_link_stats *s)
{
    return (uint64_t)s->crc_errors + s->no_answers + s->implausible + s->bus_errors + s->write_errors;
}

uint64_t ps_rig_bus_errors(const ps_rig *r)
{
    return errors_of(&r->lost) + errors_of(r->afe.ops->stats(r->afe.ctx));
}

static void keep_stats(ps_rig *r)
{
    const bq_link_stats *s = r->afe.ops->stats(r->afe.ctx);
    r->lost.crc_errors += s->crc_errors;
    r->lost.no_answers += s->no_answers;
    r->lost.implausible += s->implausible;
    r->lost.bus_errors += s->bus_errors;
    r->lost.write_errors += s->write_errors;
}

static void ask(ps_rig *r, bool on)
{
    r->request = on ? BQ_REQUEST_ON : BQ_REQUEST_OFF;
    (void)bq_firmware_request(&r->fw.firmware, r->request);
}

/* Memory as a reset leaves it, pins released, start from the reset vector. What the user asks for stays. */
static void restart(ps_rig *r, bq_reset_cause cause)
{
    keep_stats(r);
    memset(&r->fw, POISON, sizeof r->fw);
    r->monitor->release(r);
    (void)boot(r, cause);
    (void)bq_firmware_request(&r->fw.firmware, r->request);
}

bool ps_rig_reset_asked(ps_rig *r)
{
    if (!r->reset_asked) {
        return false;
    }
    restart(r, BQ_RESET_SOFTWARE);
    return true;
}

/* ---- life ------------------------------------------------------------------------------------- */

int ps_rig_init(ps_rig *r, ps_scenario *s, ps_error *e)
{
    const bq_can can = r->can;
    const bq_stream console = r->console;
    memset(r, 0, sizeof *r);
    r->can = can;
    r->console = console;
    r->s = s;
    r->monitor = s->part != NULL ? &ps_afe : &ps_stack;
    r->step = s->period < r->monitor->world_step ? s->period : r->monitor->world_step;
    if (sim_cells_init(&r->world, &s->world) != 0 || r->monitor->build(r) != 0) {
        return ps_fail(e, s->pack_at, "the simulator refuses this pack");
    }
    show(r);
    bq_status status = boot(r, BQ_RESET_POWER);
    if (status != BQ_OK) {
        return ps_fail(e, s->pack_at, "the firmware refuses this configuration (%s)", bq_status_name(status));
    }
    ask(r, s->request_on);
    return 0;
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
        ask(r, v->on);
        return;
    case PS_ACT_MCU_RESET:
        restart(r, BQ_RESET_PIN);
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
