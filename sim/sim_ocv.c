/* SPDX-License-Identifier: Apache-2.0 */
#include "sim_ocv.h"
#include "sim_cells_csv.h"

#include <stdio.h>

static const char *take_row(void *ctx, double soc, double volts)
{
    sim_ocv *o = ctx;
    if (soc < 0.0 || soc > 100.0) {
        return "state of charge outside 0..100 percent";
    }
    if (volts < 0.0 || volts > SIM_OCV_V_MAX) {
        return "voltage outside 0..6 V";
    }
    if (o->points > 0 && soc <= o->soc[o->points - 1]) {
        return "state of charge does not rise";
    }
    if (o->points == SIM_OCV_POINTS) {
        return "too many rows (512 at most)";
    }
    o->soc[o->points] = soc;
    o->v[o->points] = volts;
    o->points++;
    return NULL;
}

int sim_ocv_load(sim_ocv *ocv, const char *path, char *error, size_t error_size)
{
    sim_ocv fresh = {0};
    if (sim_cells_csv_read(path, "soc_percent,ocv_v", take_row, &fresh, error, error_size) != 0) {
        return -1;
    }
    if (fresh.points < 2) {
        (void)snprintf(error, error_size, "%s:0: fewer than two rows", path);
        return -1;
    }
    for (int i = 0; i + 1 < fresh.points; i++) {
        fresh.slope[i] = (fresh.v[i + 1] - fresh.v[i]) / (fresh.soc[i + 1] - fresh.soc[i]);
    }
    *ocv = fresh;
    return 0;
}

double sim_ocv_volts(const sim_ocv *ocv, double soc, int *segment)
{
    int i = *segment;
    while (i > 0 && soc < ocv->soc[i]) {
        i--;
    }
    while (i < ocv->points - 2 && soc >= ocv->soc[i + 1]) {
        i++;
    }
    *segment = i;
    double v = ocv->v[i] + (soc - ocv->soc[i]) * ocv->slope[i];
    if (v < 0.0) {
        return 0.0;
    }
    return v > SIM_OCV_V_MAX ? SIM_OCV_V_MAX : v;
}
