/* SPDX-License-Identifier: Apache-2.0 */
#include "sim_vcd.h"
#include <errno.h>
#include <inttypes.h>
#include <string.h>

static void put(sim_vcd *v, const char *text)
{
    if (fputs(text, v->file) < 0) {
        v->failed = 1;
    }
}

/* One printable character names a signal: '!' is 33. */
static void put_value(sim_vcd *v, int signal)
{
    char line[4];

    line[0] = v->value[signal] < 0 ? 'z' : (char)('0' + v->value[signal]);
    line[1] = (char)('!' + signal);
    line[2] = '\n';
    line[3] = '\0';
    put(v, line);
}

static int8_t level(int value)
{
    return (int8_t)(value < 0 ? -1 : value != 0);
}

static void header(sim_vcd *v)
{
    if (v->header_done) {
        return;
    }
    v->header_done = 1;
    put(v, "$timescale 1 ns $end\n$scope module bus $end\n");
    for (int i = 0; i < v->signals; i++) {
        if (fprintf(v->file, "$var wire 1 %c %s $end\n", '!' + i, v->name[i]) < 0) {
            v->failed = 1;
        }
    }
    put(v, "$upscope $end\n$enddefinitions $end\n#0\n$dumpvars\n");
    for (int i = 0; i < v->signals; i++) {
        put_value(v, i);
    }
    put(v, "$end\n");
}

static void put_time(sim_vcd *v, uint64_t time_ns)
{
    if (time_ns > v->now) {
        v->now = time_ns;
        if (fprintf(v->file, "#%" PRIu64 "\n", time_ns) < 0) {
            v->failed = 1;
        }
    }
}

int sim_vcd_open(sim_vcd *v, const char *path)
{
    memset(v, 0, sizeof *v);
    errno = 0;
    v->file = fopen(path, "w");
    return v->file != NULL ? 0 : -1;
}

int sim_vcd_signal(sim_vcd *v, const char *name, int initial)
{
    size_t n = strlen(name);
    int number = v->signals;

    for (int i = 0; i < v->signals; i++) {
        if (strncmp(v->name[i], name, sizeof v->name[0] - 1) == 0) {
            return i;
        }
    }
    if (number >= SIM_VCD_SIGNALS || v->header_done) {
        return -1;
    }
    if (n >= sizeof v->name[0]) {
        n = sizeof v->name[0] - 1;
    }
    memcpy(v->name[number], name, n);
    v->name[number][n] = '\0';
    v->value[number] = level(initial);
    v->signals++;
    return number;
}

void sim_vcd_set(sim_vcd *v, int signal, uint64_t time_ns, int value)
{
    if (v->file == NULL || signal < 0 || signal >= v->signals) {
        return;
    }
    if (v->value[signal] == level(value)) {
        return;
    }
    header(v);
    put_time(v, time_ns);
    v->value[signal] = level(value);
    put_value(v, signal);
}

int sim_vcd_close(sim_vcd *v, uint64_t time_ns)
{
    int result;

    if (v->file == NULL) {
        return -1;
    }
    header(v);
    put_time(v, time_ns);
    result = v->failed || ferror(v->file) ? -1 : 0;
    if (fclose(v->file) != 0) {
        result = -1;
    }
    v->file = NULL;
    return result;
}
