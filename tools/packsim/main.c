/* SPDX-License-Identifier: Apache-2.0 */
/* packsim: the pack controller firmware on a simulated pack. */
#include "ps_can.h"
#include "ps_options.h"
#include "ps_run.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { EXIT_PASS = 0, EXIT_FAILED = 1, EXIT_UNUSABLE = 2 };

typedef struct session {
    ps_options options;
    ps_search search;
    char scenario_path[PS_PATH];
    ps_ini ini;
    ps_scenario scenario;
    ps_rig rig;
    ps_judge judge;
    ps_csv csv;
    ps_report report;
    ps_can can;
    ps_console console;
    ps_run run;
} session;

static void directory_of(char *dir, size_t size, const char *path)
{
    const char *slash = strrchr(path, '/');
    (void)snprintf(dir, size, "%.*s", slash != NULL ? (int)(slash - path) : 1, slash != NULL ? path : ".");
}

static int load(session *x, const char *argv0, ps_error *e)
{
    char scenarios[PS_PATH];
    ps_home(scenarios, sizeof scenarios, argv0, "scenarios");
    ps_home(x->search.data_dir, sizeof x->search.data_dir, argv0, "data");
    ps_find_scenario(x->scenario_path, sizeof x->scenario_path, x->options.scenario, scenarios);
    directory_of(x->search.scenario_dir, sizeof x->search.scenario_dir, x->scenario_path);
    if (ps_ini_read(&x->ini, x->scenario_path, e) != 0) {
        return -1;
    }
    for (int i = 0; i < x->options.sets; i++) {
        if (ps_ini_set(&x->ini, x->options.set[i], i + 1, e) != 0) {
            return -1;
        }
    }
    return ps_scenario_build(&x->scenario, &x->ini, &x->search, &x->options.override, e);
}

static uint64_t simulated_now(void *ctx)
{
    return ps_rig_now(ctx);
}

/* What hangs on the board besides the monitor; before the firmware starts. */
static int attach(session *x, ps_error *e)
{
    if (x->options.can != NULL) {
        if (ps_can_open(&x->can, x->options.can, simulated_now, &x->rig) != 0) {
            return ps_fail(e, (ps_place){x->options.can, 0}, "%s", strerror(errno));
        }
        x->rig.can = ps_can_controller(&x->can);
    }
    if (x->options.console) {
        x->rig.console = ps_console_stream(&x->console);
        x->run.console = &x->console;
    }
    return 0;
}

/* The last thing before the run: a terminal is no longer itself afterwards. */
static void open_console(session *x)
{
    if (x->options.console) {
        ps_console_open(&x->console);
        if (x->console.terminal && x->options.override.duration == 0) {
            x->scenario.duration = UINT64_MAX / 4u;
        }
    }
}

static int prepare(session *x, ps_error *e)
{
    if (attach(x, e) != 0) {
        return -1;
    }
    x->rig.player = x->options.image != NULL ? &ps_image : &ps_native;
    x->rig.image = x->options.image;
    x->rig.board = x->options.board;
    x->rig.loop = (uint32_t)x->options.loop;
    if (x->options.costs != NULL) {
        x->rig.costs = fopen(x->options.costs, "w");
        if (x->rig.costs == NULL) {
            return ps_fail(e, (ps_place){x->options.costs, 0}, "%s", strerror(errno));
        }
    }
    if (ps_rig_init(&x->rig, &x->scenario, e) != 0) {
        return -1;
    }
    ps_judge_init(&x->judge, &x->scenario);
    x->run.rig = &x->rig;
    x->run.judge = &x->judge;
    x->run.watch = x->options.watch;
    x->run.progress =
        !x->options.quiet && !x->options.watch && !x->options.console && isatty(STDERR_FILENO) == 1;
    if (x->options.vcd != NULL && ps_rig_record(&x->rig, x->options.vcd) != 0) {
        return ps_fail(e, (ps_place){x->options.vcd, 0}, "%s", strerror(errno));
    }
    if (x->options.decisions != NULL) {
        x->run.decisions = fopen(x->options.decisions, "w");
        if (x->run.decisions == NULL) {
            return ps_fail(e, (ps_place){x->options.decisions, 0}, "%s", strerror(errno));
        }
    }
    if (x->options.csv != NULL) {
        if (ps_csv_open(&x->csv, x->options.csv, x->scenario.cells) != 0) {
            return ps_fail(e, (ps_place){x->options.csv, 0}, "%s", strerror(errno));
        }
        x->run.csv = &x->csv;
    }
    if (x->options.report != NULL) {
        if (ps_report_open(&x->report, x->options.report, x->scenario.cells) != 0) {
            return ps_fail(e, (ps_place){x->options.report, 0}, "%s", strerror(errno));
        }
        x->run.report = &x->report;
    }
    return 0;
}

static int write_report(session *x)
{
    FILE *summary = tmpfile();
    if (summary == NULL) {
        return -1;
    }
    (void)ps_summary(summary, &x->run, false);
    int status = ps_report_close(&x->report, &x->scenario, &x->judge, summary);
    (void)fclose(summary);
    return status;
}

static int finish(session *x)
{
    bool left = x->console.left; /* nothing was run to its end, so nothing is judged */
    if (x->options.console) {
        ps_console_close(&x->console);
    }
    int status = left || ps_summary(stdout, &x->run, x->options.quiet) ? EXIT_PASS : EXIT_FAILED;
    if (x->options.can != NULL && ps_can_close(&x->can) != 0) {
        (void)fprintf(stderr, "%s:0: cannot be written\n", x->options.can);
        status = EXIT_UNUSABLE;
    }
    if (x->run.decisions != NULL && fclose(x->run.decisions) != 0) {
        (void)fprintf(stderr, "%s:0: cannot be written\n", x->options.decisions);
        status = EXIT_UNUSABLE;
    }
    if (x->run.csv != NULL && ps_csv_close(&x->csv) != 0) {
        (void)fprintf(stderr, "%s:0: cannot be written\n", x->options.csv);
        status = EXIT_UNUSABLE;
    }
    if (x->run.report != NULL && write_report(x) != 0) {
        (void)fprintf(stderr, "%s:0: cannot be written\n", x->options.report);
        status = EXIT_UNUSABLE;
    }
    if (ps_rig_close(&x->rig) != 0) {
        (void)fprintf(stderr, "%s:0: cannot be written\n", x->options.vcd);
        status = EXIT_UNUSABLE;
    }
    if (x->rig.costs != NULL && fclose(x->rig.costs) != 0) {
        (void)fprintf(stderr, "%s:0: cannot be written\n", x->options.costs);
        status = EXIT_UNUSABLE;
    }
    return status;
}

static int list(const char *argv0)
{
    char scenarios[PS_PATH];
    ps_home(scenarios, sizeof scenarios, argv0, "scenarios");
    if (ps_list(stdout, scenarios) == 0) {
        return EXIT_PASS;
    }
    (void)fprintf(stderr, "%s:0: %s\n", scenarios, strerror(errno));
    return EXIT_UNUSABLE;
}

int main(int argc, char **argv)
{
    static ps_error error;
    session *x = calloc(1, sizeof *x);
    int status = EXIT_UNUSABLE;
    if (x == NULL) {
        (void)fputs("packsim:0: out of memory\n", stderr);
        return status;
    }
    if (ps_options_parse(&x->options, argc, argv, &error) != 0) {
        (void)fprintf(stderr, "%s\n", error.text);
    } else if (x->options.help) {
        ps_options_help(stdout);
        status = EXIT_PASS;
    } else if (x->options.list) {
        status = list(argv[0]);
    } else if (load(x, argv[0], &error) != 0 || prepare(x, &error) != 0) {
        (void)fprintf(stderr, "%s\n", error.text);
        (void)ps_rig_close(&x->rig);
    } else {
        open_console(x);
        ps_run_all(&x->run);
        status = finish(x);
    }
    free(x);
    return status;
}
