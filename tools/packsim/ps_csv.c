/* SPDX-License-Identifier: Apache-2.0 */
#include "ps_csv.h"

#include <stdbool.h>
#include <string.h>

#define ROW_MAX (400 + 8 * SIM_CELLS_MAX)

/* A decimal with `places` digits behind the point, from an integer in units of its last digit. */
static char *put(char *p, int64_t value, int places)
{
    char digits[24];
    int n = 0;
    if (value < 0) {
        *p++ = '-';
        value = -value;
    }
    do {
        digits[n++] = (char)('0' + value % 10);
        value /= 10;
    } while (value != 0 || n <= places);
    while (n > 0) {
        *p++ = digits[--n];
        if (n == places && n > 0) {
            *p++ = '.';
        }
    }
    return p;
}

static char *put_text(char *p, const char *text)
{
    size_t n = strlen(text);
    memcpy(p, text, n);
    return p + n;
}

typedef struct extremes {
    int64_t low, high, sum;
    int valid;
} extremes;

static void include(extremes *x, int64_t value)
{
    x->low = x->valid == 0 || value < x->low ? value : x->low;
    x->high = x->valid == 0 || value > x->high ? value : x->high;
    x->sum += value;
    x->valid++;
}

static bool cell_known(const bq_app *app, const bq_sample *s, int i)
{
    const bq_cell_reading *r = &s->cells[i];
    return i < s->cell_count && (r->quality & BQ_Q_VALID) != 0u &&
           s->modules[r->module].age_ms <= bq_app_pack(app)->config.comm_timeout_ms;
}

static extremes of_cells(const bq_app *app, const bq_sample *s)
{
    extremes x = {0, 0, 0, 0};
    for (int i = 0; i < s->cell_count; i++) {
        if (cell_known(app, s, i)) {
            include(&x, s->cells[i].mv);
        }
    }
    return x;
}

static extremes of_temps(const bq_sample *s)
{
    extremes x = {0, 0, 0, 0};
    for (int i = 0; i < s->temp_count; i++) {
        if ((s->temps[i].quality & BQ_Q_VALID) != 0u) {
            include(&x, s->temps[i].dc);
        }
    }
    return x;
}

static char *put_if(char *p, bool known, int64_t value, int places)
{
    p = known ? put(p, value, places) : p;
    *p++ = ',';
    return p;
}

/* Cells of the world, tenths of a millivolt. */
static extremes of_world(const sim_cells *world)
{
    double low = world->volts[0], high = world->volts[0];
    for (int i = 1; i < world->cells; i++) {
        low = world->volts[i] < low ? world->volts[i] : low;
        high = world->volts[i] > high ? world->volts[i] : high;
    }
    extremes x = {(int64_t)(low * 1e4 + 0.5), (int64_t)(high * 1e4 + 0.5), 0, world->cells};
    return x;
}

static int64_t bits_of(uint32_t mask)
{
    int64_t n = 0;
    for (; mask != 0u; mask &= mask - 1u) {
        n++;
    }
    return n;
}

int ps_csv_open(ps_csv *c, const char *path, int cells)
{
    c->cells = cells;
    c->file = fopen(path, "w");
    if (c->file == NULL) {
        return -1;
    }
    (void)setvbuf(c->file, NULL, _IOFBF, 1u << 18);
    (void)fputs(
        "time_s,state,current_a,pack_v,soc_percent,cell_min_mv,cell_max_mv,cell_min_true_mv,cell_max_true_mv,"
        "temp_max_c,balancing_cells,fault_count",
        c->file);
    for (int i = 1; i <= cells; i++) {
        (void)fprintf(c->file, ",cell_%d_mv", i);
    }
    (void)fputc('\n', c->file);
    return 0;
}

void ps_csv_row(ps_csv *c, uint64_t t_ns, const bq_app *app, const sim_cells *world)
{
    char row[ROW_MAX], *p = row;
    const bq_sample *s = bq_app_sample(app);
    const bq_pack *pack = bq_app_pack(app);
    extremes cells = of_cells(app, s), temps = of_temps(s), truth = of_world(world);
    p = put_if(p, true, (int64_t)(t_ns / 1000000u), 3);
    p = put_text(p, bq_pack_state_name(pack->state));
    *p++ = ',';
    p = put_if(p, s->current_valid, s->current_ma, 3);
    p = put_if(p, cells.valid == c->cells, cells.sum, 3);
    p = put_if(p, pack->summary.soc_permille >= 0, pack->summary.soc_permille, 1);
    p = put_if(p, cells.valid > 0, cells.low, 0);
    p = put_if(p, cells.valid > 0, cells.high, 0);
    p = put_if(p, true, truth.low, 1);
    p = put_if(p, true, truth.high, 1);
    p = put_if(p, temps.valid > 0, temps.high, 1);
    p = put_if(p, true, pack->summary.balancing, 0);
    p = put(p, bits_of(pack->faults), 0);
    for (int i = 0; i < c->cells; i++) {
        *p++ = ',';
        if (cell_known(app, s, i)) {
            p = put(p, s->cells[i].mv, 0);
        }
    }
    *p++ = '\n';
    (void)fwrite(row, 1, (size_t)(p - row), c->file);
}

int ps_csv_close(ps_csv *c)
{
    int bad = ferror(c->file);
    bad |= fclose(c->file);
    c->file = NULL;
    return bad != 0 ? -1 : 0;
}
