/* SPDX-License-Identifier: Apache-2.0 */
#include "sim_cells_pl.h"

#include <string.h>

void sim_cells_pl_feed(sim_cells *c, sim_pl *s)
{
    const double *v = c->volts;
    for (int m = 1; m <= c->config.modules; m++) {
        int n = c->config.cells_in_module[m - 1];
        if (n == 6) {
            (void)sim_pl_set_cells(s, m, v);
        } else {
            double six[6] = {0};
            memcpy(six, v, (size_t)n * sizeof *v);
            (void)sim_pl_set_cells(s, m, six);
        }
        v += n;
    }
    if (!c->temps_moved) {
        return;
    }
    c->temps_moved = false;
    for (int m = 1; m <= c->config.modules; m++) {
        for (int t = 1; t <= SIM_CELLS_SENSORS; t++) {
            (void)sim_pl_set_ts_ratio(s, m, t, sim_cells_ts_ratio(c, (m - 1) * SIM_CELLS_SENSORS + t));
        }
    }
}

bool sim_cells_pl_observe(sim_cells *c, const sim_pl *s, double dt_s)
{
    uint32_t any = 0;
    for (int m = 1; m <= c->config.modules; m++) {
        uint32_t mask = sim_pl_cb(s, m);
        sim_cells_bleed(c, m, mask, dt_s);
        any |= mask;
    }
    return any != 0u;
}
