/* SPDX-License-Identifier: Apache-2.0 */
/** @file hv_world.h
 * What hangs on the pins of hv-f405: a stack of simulated bq76PL536 whose converters have noise, contactor
 * with feedback contact, request line, console, a CAN bus with one listener. Written from the pin table in
 * docs/boards.md. The contactor's and the precharge pin are watched at every change. */
#ifndef HV_WORLD_H
#define HV_WORLD_H

#include "noise.h"
#include "sim_pl536.h"

#define HV_DEVICES 16 /* what a board has without settings */

typedef enum hv_feedback { HV_FOLLOWS, HV_STAYS_OPEN, HV_WELDED } hv_feedback;

typedef struct hv_world {
    emu *e;
    uint64_t now_ns;
    sim_pl stack;
    noise noise;
    bool request, contactor, precharge, led;
    hv_feedback feedback;
    bool forbidden;         /* neither contactor nor precharge must close now */
    unsigned unsafe;        /* times one of them did */
    uint64_t path_ns;       /* last time the precharge path closed */
    uint64_t precharged_ns; /* how long it was closed when the contactor closed last; 0 = it was open */
    unsigned closed;        /* times it closed */
    uint64_t opened_ns;     /* last time it opened */
    uint64_t closed_ns;     /* last time it closed */
    emu_can_result result;  /* of every frame sent */
    bool dead_wire;         /* CAN held dominant */
    uint32_t frames;        /* sent, whatever became of them */
    emu_can_frame last[16];
    unsigned count[16];           /* acknowledged, of each id from 0x100 on */
    uint64_t on_ns, settled_ns;   /* first heartbeat with the state on; with standby or on */
    uint64_t beat_ns, longest_ns; /* last heartbeat, longest pause between two */
    int miso;                     /* -1 = the stack answers, otherwise every byte is this */
    bool stop_in_packet;          /* stop the emulator at the next byte of a packet */
    unsigned packet;              /* bytes since chip select fell */
    unsigned misframed;           /* frames other than 8 bits, highest first */
    char said[4096];
    unsigned length;
    const char *type;
    uint64_t type_ns;
} hv_world;

extern hv_world hv;

/** Power on with the image. False: no processor in this build, or no image. */
bool hv_start(const char *image);
/** The same; `devices` of the stack, the chip still in reset: hv_power() starts it. */
bool hv_prepare(const char *image, int devices);
void hv_power(void);
void hv_end(void);
void hv_run(unsigned ms);       /**< from now on */
void hv_type(const char *line); /**< and runs on for 200 ms */
/** Request on, until the contactor is closed. */
void hv_up(void);
int hv_state(void); /**< of the newest heartbeat */
/** Nothing in any judge's book. */
void hv_clean(void);
unsigned hv_resets(emu_cause cause);
/** Restarts the measurement of the pause between two heartbeats. */
void hv_watch_period(void);

#endif
