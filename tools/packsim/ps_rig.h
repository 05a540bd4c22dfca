/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file ps_rig.h
 * The bench: firmware (super-loop, pack controller, driver), back-end, simulated stack and the world of
 * cells, wired together.
 */
#ifndef PS_RIG_H
#define PS_RIG_H

#include "bqhost/app.h"
#include "bqhost/bq76pl536.h"
#include "hal_sim.h"
#include "ps_scenario.h"
#include "sim_cells_pl.h"
#include "sim_pl536.h"
#include "sim_vcd.h"

#define PS_TRUTHS 8

/** Everything a microcontroller loses in a reset. */
typedef struct ps_firmware {
    bq_app app;
    bq76pl536 driver;
    bq76pl536_device devices[BQ76PL536_MAX_DEVICES];
    bq_cell_reading cells[SIM_CELLS_MAX];
    bq_temp_reading temps[SIM_CELLS_MODULES * SIM_CELLS_SENSORS];
    bq_module_reading modules[SIM_CELLS_MODULES];
} ps_firmware;

/** Cell voltages that were true from a moment on. */
typedef struct ps_truth {
    uint64_t t;
    double volts[SIM_CELLS_MAX];
} ps_truth;

typedef struct ps_rig {
    ps_scenario *s;
    ps_firmware fw;
    bq_afe afe;
    hal_sim hal;
    sim_pl pl;
    sim_cells world;
    sim_vcd vcd;
    bool recording;
    uint64_t step;       /**< of the world */
    uint64_t world_t;    /**< moment the world stands at */
    uint64_t bled_t;     /**< when an output was last seen on */
    uint64_t observed_t; /**< balancing outputs booked up to here */
    double world_a;      /**< current at world_t */
    bool line_on, welded;
    bq_pack_request request; /**< what the user wants, over firmware resets */
    ps_truth truth[PS_TRUTHS];
    unsigned truths;
    bq_link_stats lost; /**< of firmware lives that ended in a reset */
} ps_rig;

/** Builds everything, firmware initialised, simulated time 0. 0; or -1 with the error recorded. */
int ps_rig_init(ps_rig *r, ps_scenario *s, ps_error *e);
/** Records the host port's lines. 0, or -1 with errno set. */
int ps_rig_record(ps_rig *r, const char *path);
/** 0, or -1 if the waveform could not be written. */
int ps_rig_close(ps_rig *r);

uint64_t ps_rig_now(const ps_rig *r);
/** Lets simulated time pass, the world stepping on its grid. */
void ps_rig_advance(ps_rig *r, uint64_t ns);
/** To be called after the firmware ran: brings a moved contactor into the world. Returns true when its line
 * moved. */
bool ps_rig_sync(ps_rig *r);
/** Level of the contactor line. */
bool ps_rig_outputs_on(const ps_rig *r);
/** Carries out an event. */
void ps_rig_act(ps_rig *r, const ps_event *v);
/** Cell voltages in force at a moment; NULL when too long ago. */
const double *ps_rig_truth(const ps_rig *r, uint64_t t);
/** Errors on the link the firmware has counted, over all its lives. */
uint64_t ps_rig_bus_errors(const ps_rig *r);

#endif
