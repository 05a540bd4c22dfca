/* SPDX-License-Identifier: Apache-2.0 */
/* Supply, resets, SLEEP and thermal shutdown (PL-UVLO, PL-POR, PL-SLEEP, PL-TSD). */
#include "sim_pl536_internal.h"
#include <string.h>

#define UVLO_FALL_V 5.30
#define UVLO_RISE_V 5.675
#define POR_FALL_V 4.78
#define POR_RISE_V 5.28
#define SUPPLY_FILTER (15 * SIM_PL_US)
#define POR_TIME (56 * SIM_PL_MS)
#define RESET_TIME (500 * SIM_PL_US)
#define BLANK_TIME (200 * SIM_PL_US)
#define TSD_ON_C 142.0
#define TSD_OFF_C 134.0

double sim_pl_brick(const sim_pl_dev *d)
{
    if (d->vbat >= 0.0) {
        return d->vbat;
    }
    return d->cell[0] + d->cell[1] + d->cell[2] + d->cell[3] + d->cell[4] + d->cell[5];
}

bool sim_pl_reg50_on(const sim_pl_dev *d)
{
    return sim_pl_is_on(d) && !d->asleep && !d->tsd;
}

/* ---- resets -------------------------------------------------------------------------------------- */

static void stop_everything(sim_pl_dev *d)
{
    d->asleep = d->tsd = d->locked = d->cb_running = false;
    d->key = d->test = d->test_step = d->slept_by_host = false;
    d->hold_alert = d->hold_fault = 0;
    d->conv_end = d->cb_end = d->blank_end = d->prog_end = SIM_PL_NEVER;
    d->adc_ready = 0;
    sim_pl_protect_off(d);
    d->cov.latched = d->cuv.latched = d->ot.latched = 0;
}

static void go_off(sim_pl *s, sim_pl_dev *d)
{
    if (sim_pl_is_on(d) && (d->reg[REG_ADDRESS] & ADDR_AR) != 0) {
        d->lost = true;
    }
    memset(d->reg, 0, sizeof d->reg);
    stop_everything(d);
    d->uvlo = d->drdy = false;
    d->uvlo_at = d->por_at = d->reset_end = SIM_PL_NEVER;
    d->power = SIM_PL_POWER_OFF;
    sim_pl_inputs(s, d);
    sim_pl_chain_changed(s);
}

static uint64_t reset_time(const sim_pl *s)
{
    return s->options.amb93_reset_us != 0 ? s->options.amb93_reset_us * SIM_PL_US : RESET_TIME;
}

void sim_pl_reset_enter(sim_pl *s, sim_pl_dev *d, bool by_command)
{
    memset(d->reg, 0, sizeof d->reg);
    stop_everything(d);
    d->drdy = false;
    d->by_command = by_command;
    d->power = SIM_PL_POWER_RESET;
    d->reset_end = s->now + (by_command ? reset_time(s) : POR_TIME);
    sim_pl_inputs(s, d);
    sim_pl_chain_changed(s);
}

void sim_pl_reset_leave(sim_pl *s, sim_pl_dev *d)
{
    d->reset_end = SIM_PL_NEVER;
    d->power = SIM_PL_POWER_ON;
    d->drdy = !s->options.amb78_drdy_zero;
    sim_pl_reg_reset(d);
    if (d->by_command && s->options.amb54_reset_no_por) {
        d->reg[REG_FAULT] &= (uint8_t)~FA_POR;
    }
    sim_pl_eprom_load(s, d);
    sim_pl_tsd_update(s, d);
    sim_pl_touch(s, d);
    sim_pl_chain_changed(s);
}

/* ---- supply -------------------------------------------------------------------------------------- */

static void uvlo_enter(sim_pl *s, sim_pl_dev *d)
{
    d->uvlo = true;
    d->uvlo_at = SIM_PL_NEVER;
    sim_pl_adc_abort(d);
    d->reg[REG_CB_CTRL] = 0;
    sim_pl_balance_stop(s, d);
    sim_pl_protect_off(d);
}

static void uvlo_leave(sim_pl *s, sim_pl_dev *d)
{
    d->uvlo = false;
    if (sim_pl_is_on(d)) {
        sim_pl_adc_wake(s, d);
        sim_pl_protect_check(s, d);
    }
}

static void start_filter(const sim_pl *s, uint64_t *at, bool below)
{
    if (!below) {
        *at = SIM_PL_NEVER;
    } else if (*at == SIM_PL_NEVER) {
        *at = s->now + SUPPLY_FILTER;
    }
}

/* Powered: falls through the two thresholds after the filter, rises through them at once. */
static void supply_watch(sim_pl *s, sim_pl_dev *d, double volts)
{
    start_filter(s, &d->por_at, volts < POR_FALL_V - SIM_PL_EPS);
    start_filter(s, &d->uvlo_at, !d->uvlo && volts < UVLO_FALL_V - SIM_PL_EPS);
    if (d->uvlo && volts > UVLO_RISE_V + SIM_PL_EPS) {
        uvlo_leave(s, d);
    }
}

static void supply_rises(sim_pl *s, sim_pl_dev *d, double volts)
{
    if (volts > POR_RISE_V + SIM_PL_EPS) {
        d->uvlo = volts <= UVLO_RISE_V + SIM_PL_EPS;
        sim_pl_reset_enter(s, d, false);
    }
}

void sim_pl_power_update(sim_pl *s, sim_pl_dev *d)
{
    double volts = d->supply ? sim_pl_brick(d) : 0.0;

    if (d->power == SIM_PL_POWER_OFF) {
        supply_rises(s, d, volts);
    } else if (!d->supply) {
        go_off(s, d);
    } else if (d->power == SIM_PL_POWER_RESET && !d->by_command && volts <= POR_RISE_V + SIM_PL_EPS) {
        go_off(s, d); /* the reset time counts only above threshold plus hysteresis (PL-POR-03) */
    } else {
        supply_watch(s, d, volts);
    }
    sim_pl_touch(s, d);
}

void sim_pl_power_due(sim_pl *s, sim_pl_dev *d)
{
    if (d->por_at <= s->now) {
        go_off(s, d);
    }
    if (d->uvlo_at <= s->now) {
        uvlo_enter(s, d);
    }
    if (d->reset_end <= s->now) {
        sim_pl_reset_leave(s, d);
    }
    if (d->blank_end <= s->now) {
        d->blank_end = SIM_PL_NEVER;
        sim_pl_protect_check(s, d);
    }
}

/* ---- SLEEP and thermal shutdown --------------------------------------------------------------------- */

static void rest(sim_pl *s, sim_pl_dev *d)
{
    d->asleep = true;
    d->blank_end = SIM_PL_NEVER;
    sim_pl_protect_rest(d);
    if (s->options.amb86_sleep_stops_cb) {
        sim_pl_balance_stop(s, d);
    }
}

/* Called when IO_CONTROL[SLEEP] was written and when a conversion ends, because entry waits for it. */
void sim_pl_sleep_request(sim_pl *s, sim_pl_dev *d)
{
    bool wanted = (d->reg[REG_IO_CONTROL] & IO_SLEEP) != 0;

    if (wanted && !d->asleep && d->conv_end == SIM_PL_NEVER && !d->locked) {
        rest(s, d);
        sim_pl_alert_set(d, AL_SLEEP);
    } else if (!wanted && d->asleep) {
        d->asleep = d->slept_by_host = false;
        d->blank_end = s->now + BLANK_TIME;
        if (s->options.amb51_sleep_on_exit) {
            sim_pl_alert_set(d, AL_SLEEP);
        }
        sim_pl_adc_wake(s, d);
    }
}

void sim_pl_tsd_update(sim_pl *s, sim_pl_dev *d)
{
    if (!sim_pl_is_on(d)) {
        return;
    }
    if (!d->tsd && d->tdie >= TSD_ON_C - SIM_PL_EPS) {
        d->tsd = true;
        sim_pl_adc_abort(d);
        rest(s, d);
        d->reg[REG_IO_CONTROL] |= IO_SLEEP;
        sim_pl_alert_set(d, AL_TSD | AL_SLEEP);
    } else if (d->tsd && d->tdie <= TSD_OFF_C + SIM_PL_EPS) {
        d->tsd = false;
    }
}
