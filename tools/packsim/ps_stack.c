/* SPDX-License-Identifier: Apache-2.0 */
/* The bench with a stack of bq76PL536. */
#include "ps_rig.h"

#define FUNCTION_CONFIG 0x40
#define FAST_CONVERSIONS 0x50 /* ADCT = 01b: 6 us */

static int build(ps_rig *r)
{
    const ps_scenario *s = r->s;
    sim_pl_options options = {0};
    options.seed = (uint32_t)s->seed;
    options.variant_a = s->driver.variant_a;
    if (sim_pl_init(&r->pl, s->devices, &options) != 0) {
        return -1;
    }
    sim_pl_bus_fault(&r->pl)->rng = s->seed;
    for (int k = 1; s->eprom_fast && k <= s->devices; k++) {
        (void)sim_pl_set_otp(&r->pl, k, FUNCTION_CONFIG, FAST_CONVERSIONS);
    }
    hal_sim_init(&r->hal, &r->pl);
    r->hal.advance = ps_rig_advance_hook;
    r->hal.advance_ctx = r;
    /* supply and request are the scenario's affair */
    r->hal.missing = 1u << (unsigned)BQ_LINE_AFE_POWER | 1u << (unsigned)BQ_LINE_REQUEST;
    return 0;
}

static bq_status init(ps_rig *r)
{
    ps_firmware *f = &r->fw;
    const bq_spi spi = hal_sim_spi(&r->hal);
    const bq_gpio gpio = hal_sim_gpio(&r->hal);
    const bq_clock clock = hal_sim_clock(&r->hal);
    bq_status status = bq76pl536_init(&f->driver, &r->s->driver, &spi, &gpio, &clock, f->devices,
                                      (uint8_t)BQ76PL536_MAX_DEVICES);
    if (status == BQ_OK) {
        r->afe = bq76pl536_afe(&f->driver);
    }
    return status;
}

static void release(ps_rig *r)
{
    hal_sim_reset(&r->hal);
}

static bq_gpio gpio(ps_rig *r)
{
    return hal_sim_gpio(&r->hal);
}

static bq_clock clock(ps_rig *r)
{
    return hal_sim_clock(&r->hal);
}

static uint64_t now(const ps_rig *r)
{
    return sim_pl_now(&r->pl);
}

static void advance(ps_rig *r, uint64_t ns)
{
    sim_pl_advance(&r->pl, ns);
}

static unsigned paths(const ps_rig *r)
{
    return hal_sim_line(&r->hal, BQ_LINE_CONTACTOR) ? PS_CHARGE | PS_DISCHARGE : 0u;
}

static void feed(ps_rig *r)
{
    sim_cells_pl_feed(&r->world, &r->pl);
}

static bool observe(ps_rig *r, double dt_s)
{
    return sim_cells_pl_observe(&r->world, &r->pl, dt_s);
}

/* The driver's time stamp is the conversion start. */
static uint64_t conversion(const ps_rig *r, uint64_t read_t)
{
    (void)r;
    return read_t;
}

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

static void act(ps_rig *r, const ps_event *v)
{
    sim_bus_fault *bus = sim_pl_bus_fault(&r->pl);
    switch (v->kind) {
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
    case PS_ACT_FLIP:
        bus->flip_probability = v->value;
        break;
    case PS_ACT_BUS_DEAD:
        bus->dead = v->on ? 2 : 1;
        break;
    case PS_ACT_BUS_FREE:
        bus->dead = 0;
        break;
    default:
        break;
    }
}

static uint64_t bytes(const ps_rig *r)
{
    return sim_pl_bus_fault((sim_pl *)&r->pl)->bytes;
}

static sim_misuse *misuse(ps_rig *r)
{
    return sim_pl_misuse(&r->pl);
}

static void record(ps_rig *r, sim_vcd *vcd)
{
    sim_pl_record(&r->pl, vcd);
}

const ps_monitor ps_stack = {
    .world_step = 100 * PS_MS,
    .build = build,
    .init = init,
    .release = release,
    .gpio = gpio,
    .clock = clock,
    .now = now,
    .advance = advance,
    .paths = paths,
    .feed = feed,
    .observe = observe,
    .conversion = conversion,
    .act = act,
    .bytes = bytes,
    .misuse = misuse,
    .record = record,
};
