/* SPDX-License-Identifier: Apache-2.0 */
/* An image on the emulated STM32F405 with simulated monitors on its pins: what the tests of this folder
 * share. */
#ifndef RIG_H
#define RIG_H

#include "emu.h"
#include "sim_pl536.h"
#include "sim_x0.h"

/* What goes wrong once, at the first transfer after `trouble_ns`. */
typedef enum rig_trouble {
    RIG_FINE,
    RIG_NACK,
    RIG_LOST,      /* arbitration */
    RIG_BUS_ERROR, /* START or STOP at a forbidden place */
    RIG_STRETCH,   /* 5 ms: allowed */
    RIG_TOO_LONG,  /* 30 ms: beyond what must be tolerated */
    RIG_STUCK,     /* SDA is held until five clocks have come */
    RIG_DEAD       /* SDA is held for ever */
} rig_trouble;

typedef struct rig {
    emu *e;
    uint64_t now_ns, trouble_ns, boot_ns;
    rig_trouble trouble;
    bool request, contactor;
    unsigned held;   /* clocks until SDA is free again */
    unsigned clocks; /* of the recovery by hand */
    unsigned heartbeats;
    uint8_t heartbeat[8], boot[8];
    int devices; /* of the stack; 0 = none */
    sim_pl stack;
    bool has_afe;
    sim_x0 afe;
} rig;

extern rig r;

/* What keeps the tests from running, NULL = nothing. */
const char *rig_missing(void);
/* Powers the chip with an image and its monitors. */
void rig_stack(int devices);  /* hv-f405 */
void rig_afe(void);           /* f405-afe */
void rig_run(double seconds); /* from now on */
void rig_clean(void);         /* nothing in any judge's book, no reset, no fault */
void rig_end(void);

#endif
