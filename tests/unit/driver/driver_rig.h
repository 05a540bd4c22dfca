/* SPDX-License-Identifier: Apache-2.0 */
/* A driver on a simulated stack, for tests. */
#ifndef DRIVER_RIG_H
#define DRIVER_RIG_H

#include "bqhost/bq76pl536.h"
#include "hal_sim.h"
#include "sim_bus_fault.h"
#include "sim_pl536.h"

#define RIG_CELLS (BQ76PL536_MAX_DEVICES * BQ76PL536_MAX_CELLS)

typedef struct driver_rig {
    sim_pl pl;
    hal_sim hal;
    bq76pl536 d;
    bq76pl536_device devices[BQ76PL536_MAX_DEVICES];
    bq_cell_reading cells[RIG_CELLS];
    bq_temp_reading temps[BQ76PL536_MAX_DEVICES * 2];
    bq_module_reading modules[BQ76PL536_MAX_DEVICES];
    bq_sample sample;
    bq_action action;
    uint32_t polls, most_packets_per_poll; /* of the last rig_run() */
} driver_rig;

/* 4.20 V / 2.8 V / 60 C, 500 ms each, two sensors, full cells: a configuration every test may change before
 * rig_open(). */
bq76pl536_config rig_config(int devices);
/* Powers the stack up and initialises the driver; the test fails if init refuses. */
void rig_open(driver_rig *r, const bq76pl536_config *config, const sim_pl_options *options);
/* Polls and lets time pass until the job ends, at most `seconds` of simulated time (then BQ_PENDING). */
bq_status rig_run(driver_rig *r, double seconds);
/* Begins and runs. */
bq_status rig_start(driver_rig *r);
bq_status rig_scan(driver_rig *r);
bq_status rig_apply(driver_rig *r);
/* rig_open() and rig_start(), expected to succeed. */
void rig_up(driver_rig *r, const bq76pl536_config *config, const sim_pl_options *options);
/* Copies the sample, expected to succeed. */
void rig_sample(driver_rig *r);
void rig_advance_ms(driver_rig *r, uint32_t ms);
/* A write of somebody else, with its CRC, past the driver. */
void rig_poke(driver_rig *r, uint8_t device, uint8_t reg, uint8_t value);
uint32_t rig_misuse(driver_rig *r);
/* Prints what the judge wrote, for failing tests. */
void rig_print_misuse(driver_rig *r);

#endif
