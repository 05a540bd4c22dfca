/* SPDX-License-Identifier: Apache-2.0 */
/** @file lv_world.h
 * What hangs on the pins of lv-f072: a bq7694003 with fifteen cells of 3.6 V, the request line, a console and
 * a CAN bus with one listener. Written from the pin table in docs/boards.md. */
#ifndef LV_WORLD_H
#define LV_WORLD_H

#include "noise.h"
#include "sim_x0.h"

typedef struct lv_world {
    emu *e;
    sim_x0 chip;
    bool request;
    uint64_t boot_from; /* AFE_BOOT rose; 0 = it is low */
    char said[4096];    /* by the console, ends with 0 */
    unsigned length;
    const char *type; /* typed into the console, 2 ms apart, \r for Return */
    uint64_t type_ns;
    uint32_t frames;        /* on CAN, all */
    emu_can_frame last[16]; /* of each id from 0x100 on */
    unsigned count[16];
    bool led;
    uint64_t clock_first, clock_last; /* changes of SCL and SDA by hand: recovery */
    unsigned upset;                   /* so many of the next address bytes get this answer instead */
    emu_i2c_answer upset_answer;
    uint64_t stretch_ns; /* after the next byte, once */
    noise noise;
    emu_can_result result;        /* of every frame sent; only what is acknowledged is kept */
    uint64_t beat_ns, longest_ns; /* last heartbeat, longest pause between two */
    uint64_t settled_ns;          /* first heartbeat with the state standby or on */
} lv_world;

extern lv_world lv;

/** Power on with the image. False: no processor in this build, or no image. */
bool lv_start(const char *image);
void lv_end(void);
/** Runs until `ms` of simulated time since power-on. */
void lv_run(unsigned ms);
/** Types a line and runs on for 300 ms. */
void lv_type(const char *line);
bool lv_both_fets(void);
/** Restarts the measurement of the pause between two heartbeats. */
void lv_watch_period(void);
/** Marks the step of the main loop, which the map beside the image names. */
bool lv_mark(const char *map);

#endif
