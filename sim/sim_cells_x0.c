/* SPDX-License-Identifier: Apache-2.0 */
#include "sim_cells_x0.h"

/* Inputs that gain a cell beyond three per group, in this order (X0-CELL-17). */
static const unsigned char gains[3][6] = {{3, 4}, {3, 8, 4, 9}, {3, 8, 13, 4, 9, 14}};

int sim_cells_x0_share(sim_cells_config *config, int inputs, int cells)
{
    int groups = inputs / 5;
    if (inputs % 5 != 0 || groups < 1 || groups > 3 || cells < 3 * groups || cells > 5 * groups) {
        return -1;
    }
    config->modules = groups;
    for (int g = 0; g < groups; g++) {
        config->cells_in_module[g] = 3;
    }
    for (int i = 0; i < cells - 3 * groups; i++) {
        config->cells_in_module[(gains[groups - 1][i] - 1) / 5]++;
    }
    return 0;
}

/* Within a group the topmost cell is at the fifth input, the others count from the bottom (X0-CELL-16). */
static int input_in_group(int cell, int of)
{
    return cell == of ? 5 : cell;
}

int sim_cells_x0_input(const sim_cells *c, int cell)
{
    int m = 0;
    while (m + 1 < c->config.modules && cell > c->first_cell[m + 1]) {
        m++;
    }
    return 5 * m + input_in_group(cell - c->first_cell[m], c->config.cells_in_module[m]);
}

int sim_cells_x0_sensor(int thermistor)
{
    return (thermistor - 1) * SIM_CELLS_SENSORS + 1;
}

void sim_cells_x0_feed(sim_cells *c, sim_x0 *s)
{
    int i = 0;
    for (int m = 0; m < c->config.modules; m++) {
        int of = c->config.cells_in_module[m];
        for (int cell = 1; cell <= of; cell++) {
            (void)sim_x0_set_cell(s, 5 * m + input_in_group(cell, of), c->volts[i++]);
        }
        for (int input = of; input < 5; input++) {
            (void)sim_x0_set_cell(s, 5 * m + input, 0.0);
        }
    }
    if (!c->temps_moved) {
        return;
    }
    c->temps_moved = false;
    for (int t = 1; t <= c->config.modules; t++) {
        (void)sim_x0_set_ts(s, t, sim_cells_ntc_ohms(sim_cells_celsius(c, sim_cells_x0_sensor(t))));
    }
}

bool sim_cells_x0_observe(sim_cells *c, const sim_x0 *s, double dt_s)
{
    uint32_t on = sim_x0_cb(s) != 0u ? sim_x0_cb_conducting(s) : 0u;
    for (int m = 0; m < c->config.modules; m++) {
        uint32_t group = on >> (5u * (unsigned)m) & 0x1fu;
        int of = c->config.cells_in_module[m];
        uint32_t below = group & ((1u << (unsigned)(of - 1)) - 1u);
        sim_cells_bleed(c, m + 1, below | (group >> 4) << (unsigned)(of - 1), dt_s);
    }
    return sim_x0_cb(s) != 0u;
}

void sim_cells_x0_show_current(sim_x0 *s, double shunt_ohm, double asked_a, double flows_a)
{
    (void)sim_x0_set_chgpin(s, asked_a < 0.0 && !sim_x0_chg(s) ? SIM_CELLS_X0_LOAD_V : 0.0);
    (void)sim_x0_set_sense(s, flows_a * shunt_ohm);
}
