/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file sim_vcd.h
 * Waveforms as Value Change Dump (IEEE 1364), time unit 1 ns, for GTKWave, sigrok-cli and the like.
 */
#ifndef SIM_VCD_H
#define SIM_VCD_H

#include <stdint.h>
#include <stdio.h>

#define SIM_VCD_SIGNALS 32

typedef struct sim_vcd {
    FILE *file;
    int signals;
    char name[SIM_VCD_SIGNALS][16];
    int8_t value[SIM_VCD_SIGNALS]; /**< 0, 1, or -1 = high impedance */
    uint64_t now;
    int header_done, failed;
} sim_vcd;

/** Opens `path`. Returns 0, or -1 with errno set. */
int sim_vcd_open(sim_vcd *v, const char *path);
/** Adds a one-bit signal before the first change; returns its number, or that of a signal which has this name
 * already; -1 when full. */
int sim_vcd_signal(sim_vcd *v, const char *name, int initial);
/** Records a change; times that run backwards are recorded at the latest time seen. */
void sim_vcd_set(sim_vcd *v, int signal, uint64_t time_ns, int value);
/** Closes the file at time_ns. Returns 0, or -1 if anything could not be written. */
int sim_vcd_close(sim_vcd *v, uint64_t time_ns);

#endif
