/* SPDX-License-Identifier: Apache-2.0 */
#include "ps_options.h"

#include <stdlib.h>
#include <string.h>

static int usage(ps_error *e, const char *option, int i, const char *reason)
{
    return ps_fail(e, (ps_place){option, i}, "%s", reason);
}

static int take_duration(ps_options *o, const char *text, int i, ps_error *e)
{
    if (!ps_time(text, &o->override.duration) || o->override.duration == 0) {
        return usage(e, "--duration", i, "not a time (number and us, ms, s, min or h)");
    }
    return 0;
}

static int take_seed(ps_options *o, const char *text, int i, ps_error *e)
{
    char *end;
    o->override.seed = strtoull(text, &end, 10);
    o->override.has_seed = true;
    return *text >= '0' && *text <= '9' && *end == '\0' ? 0 : usage(e, "--seed", i, "not a whole number");
}

static int take_set(ps_options *o, const char *text, int i, ps_error *e)
{
    if (o->sets == PS_SETS) {
        return usage(e, "--set", i, "too many");
    }
    o->set[o->sets++] = text;
    return 0;
}

static int take_current(ps_options *o, const char *text, int i, ps_error *e)
{
    (void)i;
    (void)e;
    o->override.current_file = text;
    return 0;
}

static int take_csv(ps_options *o, const char *text, int i, ps_error *e)
{
    (void)i;
    (void)e;
    o->csv = text;
    return 0;
}

static int take_vcd(ps_options *o, const char *text, int i, ps_error *e)
{
    (void)i;
    (void)e;
    o->vcd = text;
    return 0;
}

static int take_report(ps_options *o, const char *text, int i, ps_error *e)
{
    (void)i;
    (void)e;
    o->report = text;
    return 0;
}

static int take_decisions(ps_options *o, const char *text, int i, ps_error *e)
{
    (void)i;
    (void)e;
    o->decisions = text;
    return 0;
}

static int take_image(ps_options *o, const char *text, int i, ps_error *e)
{
    (void)i;
    (void)e;
    o->image = text;
    return 0;
}

static int take_board(ps_options *o, const char *text, int i, ps_error *e)
{
    (void)i;
    (void)e;
    o->board = text;
    return 0;
}

static int take_can(ps_options *o, const char *text, int i, ps_error *e)
{
    (void)i;
    (void)e;
    o->can = text;
    return 0;
}

static int take_costs(ps_options *o, const char *text, int i, ps_error *e)
{
    (void)i;
    (void)e;
    o->costs = text;
    return 0;
}

static int take_loop(ps_options *o, const char *text, int i, ps_error *e)
{
    char *end;
    o->loop = strtoull(text, &end, 16);
    return o->loop != 0 && o->loop <= UINT32_MAX && *end == '\0' ? 0
                                                                 : usage(e, "--loop", i, "not an address");
}

static const struct {
    const char *name;
    int (*take)(ps_options *o, const char *text, int i, ps_error *e);
} options[] = {
    {"--duration", take_duration}, {"--current", take_current}, {"--csv", take_csv},
    {"--seed", take_seed},         {"--set", take_set},         {"--vcd", take_vcd},
    {"--report", take_report},     {"--can", take_can},         {"--decisions", take_decisions},
    {"--image", take_image},       {"--board", take_board},     {"--costs", take_costs},
    {"--loop", take_loop},
};

static int take_option(ps_options *o, int argc, char **argv, int *i, ps_error *e)
{
    for (size_t k = 0; k < sizeof options / sizeof options[0]; k++) {
        if (strcmp(argv[*i], options[k].name) != 0) {
            continue;
        }
        *i += 1;
        return *i < argc ? options[k].take(o, argv[*i], *i, e)
                         : usage(e, argv[*i - 1], *i - 1, "needs an argument");
    }
    return usage(e, argv[*i], *i, "unknown option (see packsim --help)");
}

int ps_options_parse(ps_options *o, int argc, char **argv, ps_error *e)
{
    memset(o, 0, sizeof *o);
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--quiet") == 0) {
            o->quiet = true;
        } else if (strcmp(argv[i], "--list") == 0) {
            o->list = true;
        } else if (strcmp(argv[i], "--watch") == 0) {
            o->watch = true;
        } else if (strcmp(argv[i], "--console") == 0) {
            o->console = true;
        } else if (strcmp(argv[i], "--help") == 0) {
            o->help = true;
        } else if (argv[i][0] == '-') {
            if (take_option(o, argc, argv, &i, e) != 0) {
                return -1;
            }
        } else if (o->scenario != NULL) {
            return usage(e, argv[i], i, "more than one scenario");
        } else {
            o->scenario = argv[i];
        }
    }
    if (o->board != NULL && o->image == NULL) {
        return usage(e, "--board", 0, "needs --image");
    }
    if ((o->costs != NULL || o->loop != 0) && o->image == NULL) {
        return usage(e, "--costs", 0, "needs --image");
    }
    if (o->scenario == NULL && !o->list && !o->help) {
        return usage(e, "command line", 0, "no scenario (see packsim --help)");
    }
    if (o->console && o->watch) {
        return usage(e, "--console", 0, "--watch wants the terminal too");
    }
    return 0;
}

/* Both families of monitors have it. */
static bool named_before(int i)
{
    int k = 0;
    while (k < i && strcmp(ps_limit_name(k), ps_limit_name(i)) != 0) {
        k++;
    }
    return k < i;
}

void ps_options_help(FILE *to)
{
    (void)fputs(
        "packsim SCENARIO.ini [--duration T] [--current FILE.csv] [--csv FILE]\n"
        "        [--report FILE.html] [--can DEST] [--vcd FILE] [--seed N]"
        " [--set SECTION.KEY=VALUE]...\n"
        "        [--watch | --console] [--quiet]\n"
        "        [--decisions FILE] [--image FILE.bin [--board lv-f072|hv-f405] [--costs FILE [--loop "
        "HEX]]]\n"
        "packsim --list\n"
        "\n"
        "Runs the pack controller firmware on a simulated pack, faster than real time. SCENARIO is a path, "
        "or the name\n"
        "of one of the scenarios that --list shows. Times carry a unit: us, ms, s, min, h.\n"
        "--image runs the firmware image of a board on an emulated microcontroller instead: configured "
        "through "
        "its settings,\n"
        "seen through its pins and CAN. Nobody promises a speed then: \"speed above\" always holds.\n"
        "--costs: what the image cost: instructions, sleep, latencies, stack, and how often the instruction "
        "at "
        "each address was\n"
        "executed; --loop: the address of the function that its main loop calls, for the longest pass.\n"
        "--decisions: a line for each change of the state, of a fault and of the outputs.\n"
        "Exit status: 0 = every expectation held, 1 = one failed, 2 = unusable scenario or option, nothing "
        "simulated.\n"
        "--can: what the firmware sends on CAN; DEST is a file (log in the format of candump) or a SocketCAN "
        "interface.\n"
        "--console: the firmware's console. On a terminal in real time, without end (but --duration), Ctrl-] "
        "leaves without\n"
        "a judgement; from a pipe or file as fast as it can, where a line \"@TIME COMMAND\" is typed at that "
        "time.\n"
        "--duration beyond or short of the scenario's own: expectations that look beyond a shortened run are "
        "left out.\n"
        "\n"
        "[pack]   monitor (bq76pl536, or a bq769x0 such as bq7694003), devices, cells, chemistry (nmc, lfp, "
        "FILE.csv),\n"
        "         capacity_ah (5), resistance_mohm (2), soc_percent (50), soc_spread_percent (0), "
        "ambient_c (25),\n"
        "         bleed_ohm (33), shunt_mohm (1)\n"
        "         bq76pl536: eprom (blank; fast = the chips wake up from a reset with 6 us conversions "
        "selected)\n"
        "         bq769x0: adc_freeze (never; a time at which the converter stops until it is switched off)\n"
        "[run]    duration (60 s), period (100 ms), seed (1)\n"
        "[load]   current_a (0) or file; request on|off (off)\n"
        "[events] T = ACTION: cell N volts V; cell N free; sensor N celsius T; current A; current file; "
        "request on|off;\n"
        "         device K off|on; bus dead 00|ff; bus free; mcu reset\n"
        "         bq76pl536: break above K; mend; wire N open|closed; spi flip P; contactor weld\n"
        "         bq769x0: i2c flip P; afe xready; afe alert (something outside holds ALERT high for 300 "
        "ms)\n"
        "         Two sensors per device (bq769x0: one per five inputs). Wire N is the sense wire at the "
        "positive end of cell N,\n"
        "         on the side of the device that measures this cell; wire 0 is the lowest of the pack.\n"
        "[expect] state STATE at T; fault NAME [cell N | device K | sensor N] within T of T0; no fault "
        "before T; no faults;\n"
        "         discovered K at T; spread below X mv at T; soc error below X percent; measurement error "
        "below X mv;\n"
        "         outputs off within T of T0; recovered at T; misuse none; speed above X\n"
        "         \"outputs\": the contactor line; of a bq769x0: off when both FETs are. \"recovered\": "
        "standby or on, no fault,\n"
        "         every device found and every value valid. Errors are the worst of the run. Spread is the "
        "true one.\n",
        to);
    (void)fputs("[limits] integers under the firmware's own names:\n", to);
    int column = 0;
    for (int i = 0; ps_limit_name(i) != NULL; i++) {
        if (ps_limit_follows(ps_limit_name(i)) || named_before(i)) {
            continue;
        }
        column += fprintf(to, "%s %s", column == 0 ? "        " : ",", ps_limit_name(i));
        if (column > 90) {
            (void)fputs(",\n", to);
            column = 0;
        }
    }
    (void)fputc('\n', to);
}
