/* SPDX-License-Identifier: Apache-2.0 */
#include "sim_cells.h"

#include <math.h>
#include <string.h>

#define R_B 1820.0
#define R_T 1470.0
#define NTC_R25 10000.0
#define NTC_BETA 3435.0
#define KELVIN 273.15

static uint64_t next_random(uint64_t *state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
}

static bool in(double x, double low, double high)
{
    return x >= low && x <= high; /* false for NaN */
}

static int count_cells(const sim_cells_config *k)
{
    if (k->modules < 1 || k->modules > SIM_CELLS_MODULES) {
        return -1;
    }
    int cells = 0;
    for (int m = 0; m < k->modules; m++) {
        if (k->cells_in_module[m] < 1 || k->cells_in_module[m] > 15) {
            return -1;
        }
        cells += k->cells_in_module[m];
    }
    return cells <= SIM_CELLS_MAX ? cells : -1;
}

static bool valid(const sim_cells_config *k)
{
    return k->ocv != NULL && k->ocv->points >= 2 && in(k->capacity_ah, 1e-3, 1e6) &&
           in(k->resistance_ohm, 0.0, 1e3) && in(k->soc_percent, 0.0, 100.0) &&
           in(k->soc_spread_percent, 0.0, 100.0) && in(k->ambient_c, SIM_CELLS_T_MIN, SIM_CELLS_T_MAX) &&
           in(k->bleed_ohm, 1e-3, 1e9);
}

double sim_cells_ntc_ohms(double celsius)
{
    return NTC_R25 * exp(NTC_BETA * (1.0 / (celsius + KELVIN) - 1.0 / (25.0 + KELVIN)));
}

static void fill_ratio_table(sim_cells *c)
{
    for (int i = 0; i <= SIM_CELLS_T_MAX - SIM_CELLS_T_MIN; i++) {
        c->ratio[i] = R_B / (R_B + R_T + sim_cells_ntc_ohms((double)(SIM_CELLS_T_MIN + i)));
    }
}

/* The places of an even spread, dealt out in a seeded order. */
static void deal_soc(sim_cells *c)
{
    double place[SIM_CELLS_MAX];
    for (int i = 0; i < c->cells; i++) {
        place[i] = c->cells > 1 ? (double)i / (double)(c->cells - 1) - 0.5 : 0.0;
    }
    uint64_t rng = c->config.seed;
    for (int i = c->cells - 1; i > 0; i--) {
        int j = (int)(next_random(&rng) % (uint64_t)(i + 1));
        double x = place[i];
        place[i] = place[j];
        place[j] = x;
    }
    for (int i = 0; i < c->cells; i++) {
        c->soc[i] = c->config.soc_percent + place[i] * c->config.soc_spread_percent;
    }
}

int sim_cells_init(sim_cells *c, const sim_cells_config *config)
{
    int cells = count_cells(config);
    if (cells < 0 || !valid(config)) {
        return -1;
    }
    memset(c, 0, sizeof *c);
    c->config = *config;
    c->cells = cells;
    for (int i = 0; i < cells; i++) {
        c->forced[i] = -1.0;
    }
    for (int m = 0; m < config->modules; m++) {
        c->t_module[m] = config->ambient_c;
        c->first_cell[m] = m > 0 ? c->first_cell[m - 1] + config->cells_in_module[m - 1] : 0;
    }
    for (int s = 0; s < SIM_CELLS_MODULES * SIM_CELLS_SENSORS; s++) {
        c->forced_t[s] = SIM_CELLS_T_MAX + 1.0;
    }
    fill_ratio_table(c);
    deal_soc(c);
    sim_cells_step(c, 0.0, 0.0, 0.0);
    c->temps_moved = true;
    return 0;
}

static void warm(sim_cells *c)
{
    double j_per_k = SIM_CELLS_HEAT_J_PER_K_AH * c->config.capacity_ah;
    double fade = c->heat_s / SIM_CELLS_THERMAL_TAU_S;
    if (fade > 1.0) {
        fade = 1.0;
    }
    for (int m = 0; m < c->config.modules; m++) {
        double cells = (double)c->config.cells_in_module[m];
        c->t_module[m] += c->heat_j[m] / (j_per_k * cells) - (c->t_module[m] - c->config.ambient_c) * fade;
        if (c->t_module[m] > SIM_CELLS_T_MAX) {
            c->t_module[m] = SIM_CELLS_T_MAX;
        }
        c->heat_j[m] = 0.0;
    }
    c->heat_s = 0.0;
    c->temps_moved = true;
}

static void heat(sim_cells *c, double dt_s, double mean_square)
{
    c->heat_s += dt_s;
    double joule = mean_square * c->config.resistance_ohm * dt_s;
    for (int m = 0; m < c->config.modules; m++) {
        c->heat_j[m] += joule * (double)c->config.cells_in_module[m];
    }
    if (c->heat_s >= 0.9999999) {
        warm(c);
    }
}

void sim_cells_take_bleed(sim_cells *c, int module, uint32_t mask)
{
    double seconds = c->bleed_s[module - 1];
    double percent = 100.0 / (c->config.capacity_ah * 3600.0) / c->config.bleed_ohm * seconds;
    uint32_t on = c->bleed_mask[module - 1];
    for (int i = c->first_cell[module - 1]; seconds > 0.0 && on != 0u; i++, on >>= 1) {
        if ((on & 1u) != 0u) {
            c->soc[i] -= c->volts[i] * percent;
        }
    }
    c->bleed_s[module - 1] = 0.0;
    c->bleed_mask[module - 1] = mask;
}

/* The bleed current through the cell's own resistance. */
static void bleed_drop(sim_cells *c, int module)
{
    double left = 1.0 - c->config.resistance_ohm / c->config.bleed_ohm;
    uint32_t on = c->bleed_mask[module - 1];
    for (int i = c->first_cell[module - 1]; on != 0u; i++, on >>= 1) {
        if ((on & 1u) != 0u) {
            c->volts[i] *= left;
        }
    }
}

void sim_cells_step(sim_cells *c, double dt_s, double from_a, double to_a)
{
    double percent_per_as = 100.0 / (c->config.capacity_ah * 3600.0);
    double charge = 0.5 * (from_a + to_a) * dt_s * percent_per_as;
    double rise = to_a * c->config.resistance_ohm;
    const sim_ocv *ocv = c->config.ocv;
    c->current_a = to_a;
    for (int m = 1; m <= c->config.modules; m++) {
        if (c->bleed_mask[m - 1] != 0u) {
            sim_cells_take_bleed(c, m, c->bleed_mask[m - 1]);
        }
    }
    heat(c, dt_s, (from_a * from_a + from_a * to_a + to_a * to_a) / 3.0);
    for (int i = 0; i < c->cells; i++) {
        c->soc[i] += charge;
        double v = sim_ocv_volts(ocv, c->soc[i], &c->segment[i]) + rise;
        c->volts[i] = v < 0.0 ? 0.0 : v > SIM_OCV_V_MAX ? SIM_OCV_V_MAX : v;
    }
    for (int m = 1; m <= c->config.modules; m++) {
        if (c->bleed_mask[m - 1] != 0u) {
            bleed_drop(c, m);
        }
    }
    if (c->any_forced) {
        for (int i = 0; i < c->cells; i++) {
            if (c->forced[i] >= 0.0) {
                c->volts[i] = c->forced[i];
            }
        }
    }
}

int sim_cells_force(sim_cells *c, int cell, double volts)
{
    if (cell < 1 || cell > c->cells || !in(volts, 0.0, SIM_OCV_V_MAX)) {
        return -1;
    }
    c->forced[cell - 1] = volts;
    c->volts[cell - 1] = volts;
    c->any_forced = true;
    return 0;
}

int sim_cells_free(sim_cells *c, int cell)
{
    if (cell < 1 || cell > c->cells) {
        return -1;
    }
    c->forced[cell - 1] = -1.0;
    sim_cells_step(c, 0.0, c->current_a, c->current_a);
    return 0;
}

int sim_cells_force_sensor(sim_cells *c, int sensor, double celsius)
{
    if (sensor < 1 || sensor > c->config.modules * SIM_CELLS_SENSORS ||
        !in(celsius, SIM_CELLS_T_MIN, SIM_CELLS_T_MAX)) {
        return -1;
    }
    c->forced_t[sensor - 1] = celsius;
    c->temps_moved = true;
    return 0;
}

double sim_cells_celsius(const sim_cells *c, int sensor)
{
    double forced = c->forced_t[sensor - 1];
    return forced <= SIM_CELLS_T_MAX ? forced : c->t_module[(sensor - 1) / SIM_CELLS_SENSORS];
}

double sim_cells_ts_ratio(const sim_cells *c, int sensor)
{
    double x = sim_cells_celsius(c, sensor) - SIM_CELLS_T_MIN;
    int i = (int)x;
    if (i < 0) {
        return c->ratio[0];
    }
    if (i >= SIM_CELLS_T_MAX - SIM_CELLS_T_MIN) {
        return c->ratio[SIM_CELLS_T_MAX - SIM_CELLS_T_MIN];
    }
    return c->ratio[i] + (c->ratio[i + 1] - c->ratio[i]) * (x - (double)i);
}

double sim_cells_mean_soc(const sim_cells *c)
{
    double sum = 0.0;
    for (int i = 0; i < c->cells; i++) {
        sum += c->soc[i];
    }
    return sum / (double)c->cells;
}

double sim_cells_spread(const sim_cells *c)
{
    double low = c->volts[0], high = c->volts[0];
    for (int i = 1; i < c->cells; i++) {
        low = c->volts[i] < low ? c->volts[i] : low;
        high = c->volts[i] > high ? c->volts[i] : high;
    }
    return high - low;
}
