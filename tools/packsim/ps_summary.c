/* SPDX-License-Identifier: Apache-2.0 */
/* The last lines of a run. */
#include "ps_run.h"

static void print_fault(FILE *to, const ps_fault_seen *f)
{
    (void)fprintf(to, "%s", bq_pack_fault_name((bq_pack_fault)f->id));
    if (f->cell > 0) {
        (void)fprintf(to, " cell %d", f->cell);
    } else if (f->sensor > 0) {
        (void)fprintf(to, " sensor %d", f->sensor);
    } else if (f->device > 0) {
        (void)fprintf(to, " device %d", f->device);
    }
    (void)fprintf(to, " at %.3f s", (double)f->t / 1e9);
}

static void print_faults(FILE *to, const ps_judge *j)
{
    (void)fputs("faults: ", to);
    if (j->faults == 0) {
        (void)fputs("none\n", to);
        return;
    }
    uint64_t kept = j->faults < PS_FAULTS_KEPT ? j->faults : PS_FAULTS_KEPT;
    for (uint64_t i = 0; i < kept; i++) {
        (void)fputs(i > 0 ? "; " : "", to);
        print_fault(to, &j->fault[i]);
    }
    if (j->faults > kept) {
        (void)fprintf(to, "; and %llu more", (unsigned long long)(j->faults - kept));
    }
    (void)fputc('\n', to);
}

static void print_expects(FILE *to, const ps_run *u, bool quiet)
{
    const ps_scenario *s = u->rig->s;
    for (int i = 0; i < s->expects; i++) {
        const ps_expect *x = &s->expect[i];
        const ps_verdict *v = &u->judge->verdict[i];
        if (!v->held) {
            (void)fprintf(to, "failed: %s:%d: %s (%s)\n", x->at.file, x->at.line, x->text, v->got);
        } else if (!quiet) {
            (void)fprintf(to, "held: %s\n", x->text);
        }
    }
    if (s->expects_cut > 0) {
        (void)fprintf(to, "left out: %d expectations beyond the shortened run\n", s->expects_cut);
    }
}

static void print_misuse(FILE *to, const sim_misuse *m)
{
    for (uint32_t i = 0; m != NULL && i < m->count && i < SIM_MISUSE_KEPT; i++) {
        const sim_misuse_entry *x = &m->entry[i];
        (void)fprintf(to, "misuse: %.6f s device %d %s %s\n", (double)x->time_ns / 1e9, x->device, x->id,
                      x->text);
    }
}

static void print_or_none(FILE *to, const char *name, double value, int places)
{
    if (value < 0.0) {
        (void)fprintf(to, "%s: none\n", name);
    } else {
        (void)fprintf(to, "%s: %.*f\n", name, places, value);
    }
}

bool ps_summary(FILE *to, const ps_run *u, bool quiet)
{
    const ps_scenario *s = u->rig->s;
    int held = ps_judge_held(u->judge);
    print_expects(to, u, quiet);
    print_misuse(to, u->rig->monitor->misuse(u->rig));
    print_misuse(to, u->rig->player->misuse(u->rig));
    (void)fprintf(to, "monitor: %s\ndevices found: %d\ncells: %d\n",
                  s->part != NULL ? s->part->name : "bq76pl536", u->found, s->cells);
    (void)fprintf(to, "simulated: %.3f s\nscans: %llu\n", (double)u->simulated / 1e9,
                  (unsigned long long)u->scans);
    (void)fprintf(to, "bus bytes per scan: %.1f\n", u->bytes_per_scan);
    (void)fprintf(to, "bus errors: %llu\n", (unsigned long long)ps_rig_bus_errors(u->rig));
    print_or_none(to, "worst measurement error mv", u->totals.measurement_mv, 3);
    (void)fprintf(to, "spread start mv: %.2f\nspread end mv: %.2f\n", u->spread_start_mv, u->spread_end_mv);
    print_or_none(to, "soc error percent", u->totals.soc_percent, 2);
    print_faults(to, u->judge);
    (void)fprintf(to, "state: %s\n", bq_pack_state_name(bq_app_pack(&u->rig->fw.firmware.app)->state));
    (void)fprintf(to, "misuse: %lu\nspeed: %.0f\n", u->totals.misuse, u->speed);
    (void)fprintf(to, "expectations: %d/%d\n", held, s->expects);
    (void)fprintf(to, "result: %s\n", held == s->expects ? "pass" : "fail");
    return held == s->expects;
}
