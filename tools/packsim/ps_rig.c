/* SPDX-License-Identifier: Apache-2.0 */
#include "ps_rig.h"

#include <errno.h>
#include <math.h>
#include <string.h>

#define WORLD_STEP (100 * PS_MS)
#define OBSERVE_STEP (4 * PS_MS) /* resolution of balancing times while the bus is busy */
#define BLED_LATELY (20 * PS_S)  /* without balancing for so long: look only once per world step */
#define POISON 0xa5
#define FUNCTION_CONFIG 0x40
#define FAST_CONVERSIONS 0x50 /* ADCT = 01b: 6 us */

uint64_t ps_rig_now(const ps_rig *r)
{
    return sim_pl_now(&r->pl);
}

/* ---- the world -------------------------------------------------------------------------------- */

static double current_at(ps_rig *r, uint64_t t)
{
    return r->line_on || r->welded ? sim_cells_load_at(&r->s->load, (double)t / 1e9) : 0.0;
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
    sim_cells_pl_feed(&r->world, &r->pl);
    remember(r);
}

static void observe(ps_rig *r)
{
    uint64_t now = ps_rig_now(r);
    if (now > r->observed_t) {
        if (sim_cells_pl_observe(&r->world, &r->pl, (double)(now - r->observed_t) / 1e9)) {
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
    double to = current_at(r, now);
    sim_cells_step(&r->world, (double)(now - r->world_t) / 1e9, r->world_a, to);
    r->world_t = now;
    r->world_a = to;
}

/* A load that jumped takes effect at once. */
static void world_jump(ps_rig *r)
{
    r->world_a = current_at(r, ps_rig_now(r));
    sim_cells_step(&r->world, 0.0, r->world_a, r->world_a);
    show(r);
}

void ps_rig_advance(ps_rig *r, uint64_t ns)
{
    uint64_t now = ps_rig_now(r), end = now + ns;
    while (now < end) {
        uint64_t next = (now / r->step + 1u) * r->step;
        uint64_t piece = (next < end ? next : end) - now;
        sim_pl_advance(&r->pl, piece);
        now += piece;
        if (now == next) {
            world_step(r);
            show(r);
        } else if (now - r->observed_t >= OBSERVE_STEP && now - r->bled_t < BLED_LATELY) {
            observe(r);
        }
    }
}

/* The back-end lets time pass while the bus is busy. */
static void advance_hook(void *ctx, uint64_t ns)
{
    ps_rig_advance(ctx, ns);
}

bool ps_rig_outputs_on(const ps_rig *r)
{
    return hal_sim_line(&r->hal, BQ_LINE_CONTACTOR);
}

bool ps_rig_sync(ps_rig *r)
{
    bool on = ps_rig_outputs_on(r);
    if (on == r->line_on) {
        return false;
    }
    world_step(r);
    r->line_on = on;
    world_jump(r);
    return true;
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
    *current_ma = (int32_t)lround(current_at(r, ps_rig_now(r)) * 1000.0);
    return BQ_OK;
}

static bq_status boot(ps_rig *r)
{
    const ps_scenario *s = r->s;
    ps_firmware *f = &r->fw;
    const bq_spi spi = hal_sim_spi(&r->hal);
    const bq_gpio gpio = hal_sim_gpio(&r->hal);
    const bq_clock clock = hal_sim_clock(&r->hal);
    const bq_ammeter ammeter = {read_ammeter, r};
    bq_status status = bq76pl536_init(&f->driver, &s->driver, &spi, &gpio, &clock, f->devices,
                                      (uint8_t)BQ76PL536_MAX_DEVICES);
    if (status != BQ_OK) {
        return status;
    }
    r->afe = bq76pl536_afe(&f->driver);
    status = bq_app_init(&f->app, &s->app, &r->afe, &gpio, &clock, &ammeter, f->cells, SIM_CELLS_MAX,
                         f->temps, SIM_CELLS_MODULES * SIM_CELLS_SENSORS, f->modules, SIM_CELLS_MODULES);
    return status;
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
    (void)bq_app_request(&r->fw.app, r->request);
}

/* Memory as a reset leaves it, pins released, start from the reset vector. What the user asks for stays. */
static void restart(ps_rig *r)
{
    keep_stats(r);
    memset(&r->fw, POISON, sizeof r->fw);
    hal_sim_reset(&r->hal);
    (void)boot(r);
    (void)bq_app_request(&r->fw.app, r->request);
}

/* ---- life ------------------------------------------------------------------------------------- */

int ps_rig_init(ps_rig *r, ps_scenario *s, ps_error *e)
{
    memset(r, 0, sizeof *r);
    r->s = s;
    r->step = s->period < WORLD_STEP ? s->period : WORLD_STEP;
    sim_pl_options options = {0};
    options.seed = (uint32_t)s->seed;
    options.variant_a = s->driver.variant_a;
    if (sim_cells_init(&r->world, &s->world) != 0 || sim_pl_init(&r->pl, s->devices, &options) != 0) {
        return ps_fail(e, s->pack_at, "the simulator refuses this pack");
    }
    sim_pl_bus_fault(&r->pl)->rng = s->seed;
    for (int k = 1; s->eprom_fast && k <= s->devices; k++) {
        (void)sim_pl_set_otp(&r->pl, k, FUNCTION_CONFIG, FAST_CONVERSIONS);
    }
    hal_sim_init(&r->hal, &r->pl);
    r->hal.advance = advance_hook;
    r->hal.advance_ctx = r;
    r->hal.missing = 1u << (unsigned)BQ_LINE_AFE_POWER; /* the supply is the scenario's affair */
    show(r);
    bq_status status = boot(r);
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
    sim_pl_record(&r->pl, &r->vcd);
    r->recording = true;
    return 0;
}

int ps_rig_close(ps_rig *r)
{
    if (!r->recording) {
        return 0;
    }
    sim_pl_record(&r->pl, NULL);
    r->recording = false;
    return sim_vcd_close(&r->vcd, ps_rig_now(r));
}

/* ---- events ----------------------------------------------------------------------------------- */

static void set_wire(ps_rig *r, int wire, bool open)
{
    int module = 1, left = wire;
    while (left > r->world.config.cells_in_module[module - 1]) {
        left -= r->world.config.cells_in_module[module - 1];
        module++;
    }
    (void)sim_pl_set_wire(&r->pl, module, left, open);
}

static void mend(ps_rig *r)
{
    for (int k = 1; k < r->s->devices; k++) {
        (void)sim_pl_set_link(&r->pl, k, false);
    }
}

static void act_on_world(ps_rig *r, const ps_event *v)
{
    world_step(r);
    switch (v->kind) {
    case PS_ACT_CELL_VOLTS:
        (void)sim_cells_force(&r->world, v->n, v->value);
        break;
    case PS_ACT_CELL_FREE:
        (void)sim_cells_free(&r->world, v->n);
        break;
    case PS_ACT_SENSOR:
        (void)sim_cells_force_sensor(&r->world, v->n, v->value);
        break;
    case PS_ACT_CURRENT:
        r->s->load.use_table = 0;
        r->s->load.constant_a = v->value;
        break;
    case PS_ACT_CURRENT_FILE:
        r->s->load.use_table = 1;
        break;
    default:
        r->welded = true;
        hal_sim_weld(&r->hal, true);
        break;
    }
    world_jump(r);
}

void ps_rig_act(ps_rig *r, const ps_event *v)
{
    sim_bus_fault *bus = sim_pl_bus_fault(&r->pl);
    switch (v->kind) {
    case PS_ACT_REQUEST:
        ask(r, v->on);
        break;
    case PS_ACT_BREAK:
        (void)sim_pl_set_link(&r->pl, v->n, true);
        break;
    case PS_ACT_MEND:
        mend(r);
        break;
    case PS_ACT_DEVICE:
        (void)sim_pl_set_supply(&r->pl, v->n, v->on);
        break;
    case PS_ACT_WIRE:
        set_wire(r, v->n, v->on);
        break;
    case PS_ACT_SPI_FLIP:
        bus->flip_probability = v->value;
        break;
    case PS_ACT_BUS_DEAD:
        bus->dead = v->on ? 2 : 1;
        break;
    case PS_ACT_BUS_FREE:
        bus->dead = 0;
        break;
    case PS_ACT_MCU_RESET:
        restart(r);
        break;
    default:
        act_on_world(r, v);
        break;
    }
}
