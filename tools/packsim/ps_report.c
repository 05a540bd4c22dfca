/* SPDX-License-Identifier: Apache-2.0 */
#include "ps_report.h"

#include <math.h>
#include <string.h>

#define WIDTH 1000.0
#define CELL_POINTS 60000 /* cells x moments kept */

typedef struct chart {
    const char *title, *unit;
    double height, low, high;
} chart;

/* ---- taking --------------------------------------------------------------------------------- */

int ps_report_open(ps_report *r, const char *path, int cells)
{
    memset(r, 0, sizeof *r);
    r->cells = cells;
    r->most = CELL_POINTS / cells;
    r->most = r->most > PS_REPORT_MOMENTS ? PS_REPORT_MOMENTS : r->most & ~1;
    r->every = 1;
    r->file = fopen(path, "w");
    return r->file != NULL ? 0 : -1;
}

static void thin_out(ps_report *r)
{
    for (int i = 0; 2 * i < r->count; i++) {
        r->moment[i] = r->moment[2 * i];
        memcpy(r->mv[i], r->mv[2 * i], sizeof r->mv[i]);
    }
    r->count = (r->count + 1) / 2;
    r->every *= 2;
}

static void take_cells(ps_report *r, const bq_app *app, ps_moment *m, uint16_t *mv)
{
    const bq_sample *s = bq_app_sample(app);
    int low = 0xffff, high = 0, valid = 0;
    for (int i = 0; i < r->cells; i++) {
        bool known = i < s->cell_count && (s->cells[i].quality & BQ_Q_VALID) != 0u &&
                     s->modules[s->cells[i].module].age_ms <= bq_app_pack(app)->config.comm_timeout_ms;
        mv[i] = known ? s->cells[i].mv : 0;
        if (known) {
            low = mv[i] < low ? mv[i] : low;
            high = mv[i] > high ? mv[i] : high;
            valid++;
        }
    }
    m->spread_mv = valid > 0 ? (float)(high - low) : NAN;
}

static float hottest(const bq_sample *s)
{
    float high = NAN;
    for (int i = 0; i < s->temp_count; i++) {
        float c = (float)s->temps[i].dc / 10.0f;
        if ((s->temps[i].quality & BQ_Q_VALID) != 0u && !(c <= high)) {
            high = c;
        }
    }
    return high;
}

void ps_report_take(ps_report *r, uint64_t t_ns, const bq_app *app)
{
    if (r->skip > 0) {
        r->skip--;
        return;
    }
    if (r->count == r->most) {
        thin_out(r);
    }
    r->skip = r->every - 1;
    const bq_sample *s = bq_app_sample(app);
    const bq_pack *pack = bq_app_pack(app);
    ps_moment *m = &r->moment[r->count];
    m->t = t_ns;
    m->current_a = s->current_valid ? (float)s->current_ma / 1000.0f : NAN;
    m->temp_max_c = hottest(s);
    m->soc_percent = pack->summary.soc_permille >= 0 ? (float)pack->summary.soc_permille / 10.0f : NAN;
    m->balancing = pack->summary.balancing;
    m->state = (int)pack->state;
    m->faults = 0;
    for (uint32_t f = pack->faults; f != 0u; f &= f - 1u) {
        m->faults++;
    }
    take_cells(r, app, m, r->mv[r->count]);
    r->count++;
}

/* ---- writing -------------------------------------------------------------------------------- */

static void escape(FILE *to, const char *text)
{
    for (; *text != '\0'; text++) {
        switch (*text) {
        case '<':
            (void)fputs("&lt;", to);
            break;
        case '&':
            (void)fputs("&amp;", to);
            break;
        case '"':
            (void)fputs("&quot;", to);
            break;
        default:
            (void)fputc(*text, to);
            break;
        }
    }
}

static double x_of(const ps_report *r, uint64_t t)
{
    double end = r->count > 0 ? (double)r->moment[r->count - 1].t : 1.0;
    return WIDTH * (double)t / (end > 0.0 ? end : 1.0);
}

static double curve_value(const ps_moment *m, int which)
{
    const double values[] = {m->spread_mv,   m->current_a, m->temp_max_c,
                             m->soc_percent, m->balancing, m->faults};
    return values[which];
}

/* A polyline; which < 0 = cell number -which. Interrupted where there is no value. */
static void curve(const ps_report *r, const chart *c, int which, const char *style)
{
    bool down = false;
    (void)fprintf(r->file, "<path class=\"%s\" d=\"", style);
    for (int i = 0; i < r->count; i++) {
        double v = which >= 0 ? curve_value(&r->moment[i], which) : r->mv[i][-which - 1];
        if (isnan(v) || (which < 0 && v <= 0.0)) {
            down = false;
            continue;
        }
        double y = c->height * (c->high - v) / (c->high - c->low);
        (void)fprintf(r->file, "%c%.1f %.1f", down ? 'L' : 'M', x_of(r, r->moment[i].t), y);
        down = true;
    }
    (void)fputs("\"/>\n", r->file);
}

static void include(chart *c, double v, bool *any)
{
    if (isnan(v)) {
        return;
    }
    c->low = !*any || v < c->low ? v : c->low;
    c->high = !*any || v > c->high ? v : c->high;
    *any = true;
}

static void scale(const ps_report *r, chart *c, int which)
{
    bool any = false;
    for (int i = 0; i < r->count; i++) {
        if (which >= 0) {
            include(c, curve_value(&r->moment[i], which), &any);
            continue;
        }
        for (int k = 0; k < r->cells; k++) {
            include(c, r->mv[i][k] > 0 ? (double)r->mv[i][k] : NAN, &any);
        }
    }
    double room = 0.05 * (c->high - c->low);
    room = room < 0.5 ? 0.5 : room;
    c->low -= room;
    c->high += room;
}

static void marks(const ps_report *r, const chart *c, const ps_scenario *s, const ps_judge *j)
{
    for (int i = 0; i < s->events; i++) {
        double x = x_of(r, s->event[i].t);
        (void)fprintf(
            r->file,
            "<line class=\"event\" x1=\"%.1f\" x2=\"%.1f\" y2=\"%.0f\"><title>%.3f s: %s</title></line>\n", x,
            x, c->height, (double)s->event[i].t / 1e9, s->event[i].text);
    }
    for (uint64_t i = 0; i < j->faults && i < PS_FAULTS_KEPT; i++) {
        const ps_fault_seen *f = &j->fault[i];
        double x = x_of(r, f->t);
        (void)fprintf(
            r->file,
            "<line class=\"fault\" x1=\"%.1f\" x2=\"%.1f\" y2=\"%.0f\"><title>%.3f s: %s</title></line>\n", x,
            x, c->height, (double)f->t / 1e9, bq_pack_fault_name((bq_pack_fault)f->id));
    }
}

static void open_chart(const ps_report *r, const chart *c)
{
    (void)fprintf(r->file,
                  "<h2>%s</h2>\n<div class=\"row\"><div "
                  "class=\"scale\"><span>%.5g</span><span>%s</span><span>%.5g</span></div>\n"
                  "<svg viewBox=\"0 0 1000 %.0f\" preserveAspectRatio=\"none\">\n",
                  c->title, c->high, c->unit, c->low, c->height);
}

static void close_chart(const ps_report *r)
{
    (void)fputs("</svg></div>\n", r->file);
}

static void draw(const ps_report *r, const ps_scenario *s, const ps_judge *j, int which, const char *title,
                 const char *unit)
{
    chart c = {title, unit, which < 0 ? 260.0 : 90.0, 0.0, 0.0};
    scale(r, &c, which);
    open_chart(r, &c);
    marks(r, &c, s, j);
    for (int k = 1; which < 0 && k <= r->cells; k++) {
        curve(r, &c, -k, "cell");
    }
    if (which >= 0) {
        curve(r, &c, which, "one");
    }
    close_chart(r);
}

static void draw_states(const ps_report *r, const ps_scenario *s, const ps_judge *j)
{
    chart c = {"State", "", 24.0, 0.0, 1.0};
    open_chart(r, &c);
    for (int i = 0; i < r->count;) {
        int k = i;
        while (k < r->count && r->moment[k].state == r->moment[i].state) {
            k++;
        }
        double x = x_of(r, r->moment[i].t), end = x_of(r, r->moment[k < r->count ? k : r->count - 1].t);
        (void)fprintf(r->file,
                      "<rect class=\"s%d\" x=\"%.1f\" width=\"%.1f\" height=\"24\"><title>%s from %.3f "
                      "s</title></rect>\n",
                      r->moment[i].state, x, end - x,
                      bq_pack_state_name((bq_pack_state_id)r->moment[i].state), (double)r->moment[i].t / 1e9);
        i = k;
    }
    marks(r, &c, s, j);
    close_chart(r);
}

static void table(const ps_report *r, const ps_scenario *s, const ps_judge *j)
{
    (void)fputs("<h2>Events and faults</h2>\n<table><tr><th>time</th><th>what</th></tr>\n", r->file);
    uint64_t f = 0, faults = j->faults < PS_FAULTS_KEPT ? j->faults : PS_FAULTS_KEPT;
    for (int e = 0; e < s->events || f < faults;) {
        if (f >= faults || (e < s->events && s->event[e].t <= j->fault[f].t)) {
            (void)fprintf(r->file, "<tr><td>%.3f s</td><td>event: ", (double)s->event[e].t / 1e9);
            escape(r->file, s->event[e].text);
            e++;
        } else {
            const ps_fault_seen *x = &j->fault[f++];
            (void)fprintf(r->file, "<tr class=\"bad\"><td>%.3f s</td><td>fault: %s", (double)x->t / 1e9,
                          bq_pack_fault_name((bq_pack_fault)x->id));
            (void)fprintf(r->file,
                          x->cell > 0     ? ", cell %d"
                          : x->sensor > 0 ? ", sensor %d"
                                          : ", device %d",
                          x->cell > 0     ? x->cell
                          : x->sensor > 0 ? x->sensor
                                          : x->device);
        }
        (void)fputs("</td></tr>\n", r->file);
    }
    (void)fputs("</table>\n", r->file);
}

static void copy_summary(const ps_report *r, FILE *summary)
{
    char line[1024];
    rewind(summary);
    (void)fputs("<pre>", r->file);
    while (fgets(line, sizeof line, summary) != NULL) {
        escape(r->file, line);
    }
    (void)fputs("</pre>\n", r->file);
}

static void begin_page(FILE *to)
{
    (void)fputs(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>packsim</title><style>\n"
        "body{font:14px sans-serif;max-width:1200px;margin:1em auto;padding:0 1em;color:#222}\n"
        "h2{font-size:14px;margin:1em 0 .2em}pre{background:#f4f4f4;padding:.8em;white-space:pre-wrap}\n"
        ".row{display:flex}.scale{width:70px;display:flex;flex-direction:column;justify-content:space-"
        "between;"
        "text-align:right;padding-right:6px;color:#666}\n"
        "svg{flex:1;background:#fafafa;border:1px solid "
        "#ccc}path{fill:none;vector-effect:non-scaling-stroke}\n"
        ".cell{stroke:#2a6;stroke-width:.7;opacity:.45}.one{stroke:#05a;stroke-width:1.3}\n"
        ".event{stroke:#999;stroke-width:1;stroke-dasharray:4 3}.fault{stroke:#c22;stroke-width:1.5}\n"
        ".s0{fill:#ccc}.s1{fill:#fd8}.s2{fill:#9cf}.s3{fill:#8d8}.s4{fill:#e77}.s5{fill:#777}\n"
        "td,th{text-align:left;padding:0 1em 0 0}.bad{color:#c22}\n</style></head><body>\n<h1>packsim</h1>\n",
        to);
}

int ps_report_close(ps_report *r, const ps_scenario *s, const ps_judge *j, FILE *summary)
{
    double end = r->count > 0 ? (double)r->moment[r->count - 1].t / 1e9 : 0.0;
    begin_page(r->file);
    copy_summary(r, summary);
    (void)fprintf(
        r->file,
        "<p>Time axis: 0 to %.1f s. Dashed: events; red: faults (hold the pointer over a line).</p>\n", end);
    draw_states(r, s, j);
    draw(r, s, j, -1, "Cell voltages, all cells", "mV");
    draw(r, s, j, 0, "Spread, highest minus lowest cell", "mV");
    draw(r, s, j, 1, "Pack current, positive charges", "A");
    draw(r, s, j, 2, "Highest temperature", "C");
    draw(r, s, j, 3, "State of charge", "%");
    draw(r, s, j, 4, "Cells being balanced", "");
    draw(r, s, j, 5, "Active faults", "");
    table(r, s, j);
    (void)fputs("</body></html>\n", r->file);
    int bad = ferror(r->file);
    bad |= fclose(r->file);
    r->file = NULL;
    return bad != 0 ? -1 : 0;
}
