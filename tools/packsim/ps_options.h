/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file ps_options.h
 * The command line of packsim.
 */
#ifndef PS_OPTIONS_H
#define PS_OPTIONS_H

#include "ps_scenario.h"
#include <stdio.h>

#define PS_SETS 64

typedef struct ps_options {
    const char *scenario;
    const char *csv, *vcd, *report, *can, *decisions;
    const char *image, *board; /**< NULL = the native firmware; the board that fits */
    const char *costs;         /**< of an image */
    uint64_t loop;             /**< address of its super-loop; 0 = not given */
    const char *set[PS_SETS];
    int sets;
    ps_override override;
    bool quiet, watch, console, list, help;
} ps_options;

/** 0, or -1 with the error recorded (as --OPTION:ARGUMENT NUMBER: reason). */
int ps_options_parse(ps_options *o, int argc, char **argv, ps_error *e);
void ps_options_help(FILE *to);

/** Where the program's scenarios and data are: beside the executable, or in the source tree it was built
 * from. */
void ps_home(char *path, size_t size, const char *argv0, const char *folder);
/** Finds a scenario by path, or by bare name among those that come with packsim. The result may not exist. */
void ps_find_scenario(char *path, size_t size, const char *name, const char *folder);
/** Prints name and first comment line of each scenario in `folder`. 0, or -1 when there is no such folder. */
int ps_list(FILE *to, const char *folder);

#endif
