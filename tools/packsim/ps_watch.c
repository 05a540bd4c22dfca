/* SPDX-License-Identifier: Apache-2.0 */
#include "ps_watch.h"

#define LINES 40 /* modules shown */

static void end_line(FILE *to)
{
    (void)fputs("\033[K\n", to);
}

static void draw_cell(FILE *to, const bq_sample *s, const bq_pack *pack, const bq_action *action, int i)
{
    const bq_cell_reading *c = &s->cells[i];
    bool known =
        (c->quality & BQ_Q_VALID) != 0u && s->modules[c->module].age_ms <= pack->config.comm_timeout_ms;
    char mark = bq_mask_get(action->balance, (uint16_t)(i + 1)) ? 'b' : ' ';
    if (known) {
        (void)fprintf(to, " %4u%c", (unsigned)c->mv, mark);
    } else {
        (void)fputs("    - ", to);
    }
}

static void draw_modules(FILE *to, const bq_app *app)
{
    const bq_sample *s = bq_app_sample(app);
    int cell = 0;
    for (int m = 0; m < s->module_count && m < LINES; m++) {
        (void)fprintf(to, "%3d ", m + 1);
        for (; cell < s->cell_count && s->cells[cell].module == m; cell++) {
            draw_cell(to, s, bq_app_pack(app), bq_app_action(app), cell);
        }
        for (int t = 0; t < s->temp_count; t++) {
            if (s->temps[t].module == m && (s->temps[t].quality & BQ_Q_VALID) != 0u) {
                (void)fprintf(to, "  %5.1f C", (double)s->temps[t].dc / 10.0);
            }
        }
        if (s->modules[m].faults != 0u) {
            (void)fprintf(to, "  flags %04x", (unsigned)s->modules[m].faults);
        }
        end_line(to);
    }
}

static void draw_faults(FILE *to, const bq_pack *pack)
{
    (void)fputs("faults:", to);
    for (int i = 0; i < BQ_FAULT_COUNT; i++) {
        if ((pack->faults >> (unsigned)i & 1u) != 0u) {
            (void)fprintf(to, " %s (%s)", bq_pack_fault_name((bq_pack_fault)i),
                          bq_pack_hold_name(pack->fault[i].hold));
        }
    }
    if (pack->faults == 0u) {
        (void)fputs(" none", to);
    }
    end_line(to);
}

void ps_watch_draw(FILE *to, uint64_t t_ns, const bq_app *app, int found, int first)
{
    const bq_pack *pack = bq_app_pack(app);
    const bq_sample *s = bq_app_sample(app);
    const bq_pack_summary *y = &pack->summary;
    (void)fputs(first != 0 ? "\033[2J\033[H" : "\033[H", to);
    (void)fprintf(to, "%.1f s  %s  outputs %s  devices %d", (double)t_ns / 1e9,
                  bq_pack_state_name(pack->state), bq_app_outputs_on(app) ? "on" : "off", found);
    end_line(to);
    (void)fprintf(to, "%.2f V  %.2f A  cells %u..%u mV  spread %d mV  balancing %u",
                  (double)y->pack_mv / 1000.0, s->current_valid ? (double)s->current_ma / 1000.0 : 0.0,
                  (unsigned)y->cell_min_mv, (unsigned)y->cell_max_mv,
                  (int)y->cell_max_mv - (int)y->cell_min_mv, (unsigned)y->balancing);
    if (y->soc_permille >= 0) {
        (void)fprintf(to, "  %.1f %%", (double)y->soc_permille / 10.0);
    }
    end_line(to);
    draw_faults(to, pack);
    draw_modules(to, app);
    (void)fputs("\033[J", to);
    (void)fflush(to);
}
