/* SPDX-License-Identifier: Apache-2.0 */
#include "sim_cells_load.h"
#include "sim_cells_csv.h"

#include <math.h>
#include <stdio.h>

static const char *take_row(void *ctx, double t, double a)
{
    sim_cells_load *l = ctx;
    if (l->rows > 0 && t <= l->t[l->rows - 1]) {
        return "time does not rise";
    }
    if (fabs(a) > 10000.0) {
        return "current beyond 10000 A";
    }
    if (l->rows == SIM_CELLS_LOAD_ROWS) {
        return "too many rows (20000 at most)";
    }
    l->t[l->rows] = t;
    l->a[l->rows] = a;
    l->rows++;
    return NULL;
}

int sim_cells_load_file(sim_cells_load *l, const char *path, char *error, size_t error_size)
{
    l->rows = 0;
    l->place = 0;
    l->use_table = 0;
    if (sim_cells_csv_read(path, "time_s,current_a", take_row, l, error, error_size) != 0) {
        l->rows = 0;
        return -1;
    }
    if (l->rows < 2) {
        l->rows = 0;
        (void)snprintf(error, error_size, "%s:0: fewer than two rows", path);
        return -1;
    }
    l->use_table = 1;
    return 0;
}

double sim_cells_load_at(sim_cells_load *l, double t)
{
    if (!l->use_table || l->rows < 2) {
        return l->constant_a;
    }
    double turn = l->t[l->rows - 1] - l->t[0];
    double x = l->t[0] + fmod(t, turn);
    int i = l->place;
    if (x < l->t[i]) {
        i = 0;
    }
    while (i < l->rows - 2 && x >= l->t[i + 1]) {
        i++;
    }
    l->place = i;
    return l->a[i] + (l->a[i + 1] - l->a[i]) * (x - l->t[i]) / (l->t[i + 1] - l->t[i]);
}
