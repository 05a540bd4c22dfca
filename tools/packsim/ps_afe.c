/* SPDX-License-Identifier: Apache-2.0 */
/* The bench with one bq769x0: no contactor, the part's own FETs, its own current measurement. */
#include "ps_rig.h"

#define SCAN (250 * PS_MS)
#define NOISE_UV_RMS                                                                                         \
    200.0 /* about half a code: no converter is silent, and a silent one counts as stopped                   \
           */
#define CC_NOISE_UV_RMS 4.0
#define ALERT_HELD (300 * PS_MS) /* longer than a result keeps ALERT high by itself */
#define READ_TIME (10 * PS_MS)   /* the longest block read, and a little */
#define SYS_CTRL1 0x04
#define ADC_EN 0x10

/* Another trim for every seed, inside what the parts are made with. */
static void set_trim(ps_rig *r)
{
    uint64_t x = (r->s->seed + 1u) * 0x9e3779b97f4a7c15ull;
    (void)sim_x0_set_gain(&r->x0, 375 + (int)(x >> 60));
    (void)sim_x0_set_offset(&r->x0, 30 + (int)(x >> 52 & 0x1fu));
}

static int build(ps_rig *r)
{
    sim_x0_options options = {0};
    options.seed = (uint32_t)r->s->seed;
    options.noise_uv_rms = NOISE_UV_RMS;
    options.cc_noise_uv_rms = CC_NOISE_UV_RMS;
    if (sim_x0_init(&r->x0, r->s->part, &options) != 0) {
        return -1;
    }
    set_trim(r);
    (void)sim_x0_set_tdie(&r->x0, r->s->world.ambient_c);
    hal_sim_x0_init(&r->hal_x0, &r->x0);
    r->hal_x0.advance = ps_rig_advance_hook;
    r->hal_x0.advance_ctx = r;
    r->hal_x0.missing = 1u << (unsigned)BQ_LINE_AFE_POWER | 1u << (unsigned)BQ_LINE_CONTACTOR |
                        1u << (unsigned)BQ_LINE_PRECHARGE | 1u << (unsigned)BQ_LINE_REQUEST;
    r->alert_until = UINT64_MAX;
    return 0;
}

static bq_status init(ps_rig *r)
{
    const bq_i2c i2c = hal_sim_x0_i2c(&r->hal_x0);
    const bq_gpio gpio = hal_sim_x0_gpio(&r->hal_x0);
    const bq_clock clock = hal_sim_x0_clock(&r->hal_x0);
    bq_status status = bq769x0_init(&r->fw.afe, &r->s->afe, &i2c, &gpio, &clock);
    if (status == BQ_OK) {
        r->afe = bq769x0_afe(&r->fw.afe);
    }
    return status;
}

static void release(ps_rig *r)
{
    hal_sim_x0_reset(&r->hal_x0);
}

static bq_gpio gpio(ps_rig *r)
{
    return hal_sim_x0_gpio(&r->hal_x0);
}

static bq_clock clock(ps_rig *r)
{
    return hal_sim_x0_clock(&r->hal_x0);
}

static uint64_t now(const ps_rig *r)
{
    return r->x0.now;
}

/* A converter that has stopped stays so until the firmware switches it off. */
static void quirks(ps_rig *r)
{
    if (!r->froze && r->x0.now >= r->s->adc_freeze) {
        r->froze = true;
        sim_x0_freeze(&r->x0, true);
    }
    if (r->x0.frozen && (sim_x0_peek(&r->x0, SYS_CTRL1) & ADC_EN) == 0u) {
        sim_x0_freeze(&r->x0, false);
    }
    if (r->x0.now >= r->alert_until) {
        r->alert_until = UINT64_MAX;
        (void)sim_x0_set_alert_ext(&r->x0, false);
    }
}

static void advance(ps_rig *r, uint64_t ns)
{
    quirks(r); /* what the bus has just done shows before time passes */
    sim_x0_advance(&r->x0, ns);
}

static uint64_t due(const ps_rig *r)
{
    return sim_x0_next_event(&r->x0);
}

static unsigned paths(const ps_rig *r)
{
    return (sim_x0_chg(&r->x0) ? PS_CHARGE : 0u) | (sim_x0_dsg(&r->x0) ? PS_DISCHARGE : 0u);
}

static void feed(ps_rig *r)
{
    uint64_t t = r->x0.now;
    sim_cells_x0_feed(&r->world, &r->x0);
    sim_cells_x0_show_current(&r->x0, r->s->shunt_ohm, ps_rig_asked_at(r, t), ps_rig_current_at(r, t));
}

static bool observe(ps_rig *r, double dt_s)
{
    return sim_cells_x0_observe(&r->world, &r->x0, dt_s);
}

/* The part converts by itself every 250 ms. One that published during the read cannot be told apart. */
static uint64_t conversion(const ps_rig *r, uint64_t read_t)
{
    uint64_t last = r->x0.t_scan;
    if (last == UINT64_MAX || r->x0.frozen || read_t < SCAN) {
        return UINT64_MAX;
    }
    while (last > read_t) {
        last -= SCAN;
    }
    return read_t - last < READ_TIME ? UINT64_MAX : last;
}

static void act(ps_rig *r, const ps_event *v)
{
    sim_x0_bus_fault *bus = sim_x0_bus(&r->x0);
    switch (v->kind) {
    case PS_ACT_DEVICE:
        (void)sim_x0_set_supply(&r->x0, v->on);
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
    case PS_ACT_XREADY:
        (void)sim_x0_strike_xready(&r->x0);
        break;
    case PS_ACT_ALERT:
        (void)sim_x0_set_alert_ext(&r->x0, true);
        r->alert_until = r->x0.now + ALERT_HELD;
        break;
    default:
        break;
    }
}

static uint64_t bytes(const ps_rig *r)
{
    return r->hal_x0.bytes;
}

static sim_misuse *misuse(ps_rig *r)
{
    return sim_x0_misuse(&r->x0);
}

static void record(ps_rig *r, sim_vcd *vcd)
{
    sim_x0_record(&r->x0, vcd);
}

const ps_monitor ps_afe = {
    .world_step = 50 * PS_MS,
    .age_slack_ms = 250,
    .measures_current = true,
    .build = build,
    .init = init,
    .release = release,
    .gpio = gpio,
    .clock = clock,
    .now = now,
    .advance = advance,
    .due = due,
    .paths = paths,
    .feed = feed,
    .observe = observe,
    .conversion = conversion,
    .act = act,
    .bytes = bytes,
    .misuse = misuse,
    .record = record,
};
