/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file sim_misuse.h
 * The judge's book: what a host did that the datasheet forbids, each with the requirement it breaks.
 */
#ifndef SIM_MISUSE_H
#define SIM_MISUSE_H

#include <stdint.h>

#define SIM_MISUSE_KEPT 64

typedef struct sim_misuse_entry {
    uint64_t time_ns;
    int device;  /**< 1-based; 0 = the bus or no particular device */
    char id[16]; /**< requirement, for example "PL-ADC-12" */
    char text[80];
} sim_misuse_entry;

typedef struct sim_misuse {
    uint32_t count; /**< all, including those not kept */
    sim_misuse_entry entry[SIM_MISUSE_KEPT];
} sim_misuse;

void sim_misuse_clear(sim_misuse *m);
void sim_misuse_add(sim_misuse *m, uint64_t time_ns, int device, const char *id, const char *text);
/** How often a requirement was broken, among the entries kept. */
uint32_t sim_misuse_of(const sim_misuse *m, const char *id);

#endif
