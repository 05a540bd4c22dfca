/* SPDX-License-Identifier: Apache-2.0 */
/* Life and time of a simulated stack: set-up, the event clock, and what every change in a device ends with.
 */
#include "sim_pl536_internal.h"
#include <string.h>

uint64_t sim_pl_random(uint64_t *state)
{
    uint64_t z;

    *state += 0x9e3779b97f4a7c15ull;
    z = *state;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
}

uint64_t sim_pl_scaled(const sim_pl *s, uint64_t ns)
{
    double percent = s->options.delay_percent;

    return percent < 0.0 || percent > 0.0 ? (uint64_t)((double)ns * (1.0 + percent / 100.0) + 0.5) : ns;
}

static void no_times(sim_pl_dev *d)
{
    d->next = d->conv_end = d->cb_end = d->reset_end = d->blank_end = SIM_PL_NEVER;
    d->uvlo_at = d->por_at = d->prog_end = d->vpp_limit = SIM_PL_NEVER;
    d->adc_ready = 0;
}

static void device_init(sim_pl *s, sim_pl_dev *d)
{
    for (int i = 0; i < 6; i++) {
        double spread = (double)(sim_pl_random(&s->rng) >> 11) / 4503599627370496.0 - 1.0; /* -1..1 */

        d->cell[i] = 3.600;
        d->offset_v[i] = spread * s->options.cell_offset_uv_max * 1e-6;
    }
    d->vbat = -1.0;
    d->ts[0] = d->ts[1] = 0.1369;
    d->tdie = 25.0;
    d->supply = d->gpio_level = true;
    no_times(d);
    sim_pl_inputs(s, d);
    sim_pl_reset_enter(s, d, false);
    sim_pl_reset_leave(s, d);
}

static bool usable(const sim_pl_options *o)
{
    return o == NULL || (o->delay_percent >= -12.0 && o->delay_percent <= 10.0 && o->noise_uv_rms >= 0.0 &&
                         o->cell_offset_uv_max >= 0.0 && o->wire_drift >= 0.0 && o->wire_drift <= 1.0 &&
                         o->reg50_v >= 0.0);
}

int sim_pl_init(sim_pl *s, int devices, const sim_pl_options *options)
{
    if (devices < 1 || devices > SIM_PL_MAX_DEVICES || !usable(options)) {
        return -1;
    }
    memset(s, 0, sizeof *s);
    if (options != NULL) {
        s->options = *options;
    }
    s->devices = devices;
    s->spi_hz = 250000;
    s->spi_mode = 1;
    s->next = SIM_PL_NEVER;
    s->rng = s->options.seed;
    for (int i = 0; i < devices; i++) {
        device_init(s, &s->dev[i]);
    }
    sim_pl_chain_changed(s);
    sim_pl_chain_settle(s);
    return 0;
}

static uint8_t status_of(const sim_pl *s, const sim_pl_dev *d)
{
    unsigned status = d->reg[REG_STATUS] & ST_ECC_COR;

    status |= d->reg[REG_ADDRESS] & ADDR_AR;
    status |= (d->reg[REG_FAULT] & FA_ALL) != 0 ? ST_FAULT : 0u;
    status |=
        d->reg[REG_ALERT] != 0 || (s->options.amb48_ecc_alert && (status & ST_ECC_COR) != 0) ? ST_ALERT : 0u;
    status |= d->uvlo ? ST_UVLO : 0u;
    status |= d->cb_running ? ST_CBT : 0u;
    status |= d->drdy ? ST_DRDY : 0u;
    return (uint8_t)status;
}

static uint64_t earlier(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static uint64_t guard_next(const sim_pl_guard *g)
{
    uint64_t next = SIM_PL_NEVER;

    for (int i = 0; i < 6 && g->pending != 0; i++) {
        next = earlier(next, g->due[i]);
    }
    return next;
}

static uint64_t device_next(const sim_pl_dev *d)
{
    uint64_t next = earlier(earlier(d->conv_end, d->cb_end), earlier(d->reset_end, d->blank_end));

    next = earlier(next, earlier(earlier(d->uvlo_at, d->por_at), earlier(d->prog_end, d->vpp_limit)));
    if ((d->cov.pending | d->cuv.pending | d->ot.pending) != 0) {
        next = earlier(next, earlier(guard_next(&d->cov), earlier(guard_next(&d->cuv), guard_next(&d->ot))));
    }
    return next;
}

void sim_pl_touch(sim_pl *s, sim_pl_dev *d)
{
    if (sim_pl_is_on(d)) {
        d->reg[REG_ADC_CONVERT] = s->options.amb68_conv_reads_one && d->conv_end != SIM_PL_NEVER;
        d->reg[REG_STATUS] = status_of(s, d);
    }
    d->next = device_next(d);
    s->next = earlier(s->next, d->next);
}

static void device_due(sim_pl *s, sim_pl_dev *d)
{
    sim_pl_power_due(s, d);
    if (d->conv_end <= s->now) {
        sim_pl_adc_finish(s, d);
    }
    if (d->cb_end <= s->now) {
        sim_pl_balance_expire(s, d);
    }
    sim_pl_eprom_due(s, d);
    sim_pl_protect_due(s, d);
    sim_pl_touch(s, d);
}

static uint64_t earliest(const sim_pl *s)
{
    uint64_t next = SIM_PL_NEVER;

    for (int i = 0; i < s->devices; i++) {
        next = earlier(next, s->dev[i].next);
    }
    return next;
}

/* Everything that is due at the next event time. */
static void step(sim_pl *s)
{
    s->now = s->next > s->now ? s->next : s->now;
    for (int i = 0; i < s->devices; i++) {
        if (s->dev[i].next <= s->now) {
            device_due(s, &s->dev[i]);
        }
    }
    sim_pl_chain_settle(s);
    s->next = earliest(s);
    sim_pl_pins_record(s);
}

void sim_pl_advance(sim_pl *s, uint64_t ns)
{
    uint64_t target = s->now + ns;

    if (target < s->now) {
        target = SIM_PL_NEVER - 1;
    }
    while (s->next <= target) {
        step(s);
    }
    s->now = target;
}

uint64_t sim_pl_now(const sim_pl *s)
{
    return s->now;
}

uint64_t sim_pl_next_event(const sim_pl *s)
{
    uint64_t next = earliest(s);

    return next == SIM_PL_NEVER ? UINT64_MAX : next - s->now;
}

sim_misuse *sim_pl_misuse(sim_pl *s)
{
    return &s->misuse;
}

struct sim_bus_fault *sim_pl_bus_fault(sim_pl *s)
{
    return &s->fault;
}

void sim_pl_chain_changed(sim_pl *s)
{
    s->chain_changed = true;
    s->reach_valid = false;
}

/* CONV travels up through every device that is on (PL-VB-06, PL-VB-07); a rising edge starts a cycle. */
static void carry_conv(sim_pl *s)
{
    bool level = s->conv;

    for (int i = 0; i < s->devices; i++) {
        sim_pl_dev *d = &s->dev[i];
        bool rises = level && !d->conv_in;

        d->conv_in = level;
        if (rises && sim_pl_is_on(d)) {
            sim_pl_adc_start(s, d, true);
            sim_pl_touch(s, d);
        }
        level = level && sim_pl_is_on(d) && !sim_pl_link_down(s, i);
    }
}

/* Edges that come from power and links are not the host's. */
void sim_pl_chain_settle(sim_pl *s)
{
    if (s->chain_changed) {
        bool exempt = s->exempt;

        s->chain_changed = false;
        s->exempt = true;
        carry_conv(s);
        s->exempt = exempt;
    }
}

void sim_pl_set_conv(sim_pl *s, bool level)
{
    s->conv = level;
    carry_conv(s);
    sim_pl_pins_record(s);
}

bool sim_pl_conv(const sim_pl *s)
{
    return s->conv;
}
