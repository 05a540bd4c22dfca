/* SPDX-License-Identifier: Apache-2.0 */
/* A bq769x0, its board and its driver on one bench: what the driver tests share. */
#ifndef X0_RIG_H
#define X0_RIG_H

#include "bqhost/bq769x0.h"
#include "hal_sim_x0.h"
#include "unity.h"

typedef struct x0_rig {
    sim_x0 chip;
    hal_sim_x0 hal;
    bq769x0 d;
    bq769x0_config config;
    bq_sample sample;
    bq_cell_reading cells[15];
    bq_temp_reading temps[3];
    bq_module_reading modules[1];
    bq_i2c_ops ops; /* the back-end's, with a logger in front */
    /* every transaction, to read */
    uint8_t log[64][16]; /* written: address register data..; read: address register count */
    unsigned logged;
    bool legal_only; /* nothing the judge notes is expected */
} x0_rig;

extern x0_rig rig;

/** A fresh part in SHIP with `cells` cells of 3.6 V and a configuration that fits; nothing started. */
void rig_part(const char *name, unsigned cells);
/** The same with bring-up finished. */
void rig_up(const char *name, unsigned cells);
bq_status rig_init(void);
/** Polls until the job ends; time passes. */
bq_status rig_run(bq_status begun);
bq_status rig_start(void);
bq_status rig_scan(void);
/** `ms` of time with a scan every 250 ms. */
void rig_pass(unsigned ms);
bq_status rig_apply(bool charge, bool discharge, uint32_t balance);
void rig_wait_ms(unsigned ms);
bq_status rig_sample(void);
uint16_t rig_faults(void);
uint8_t rig_reg(uint8_t reg);
/** Sets every cell of the pack, in volts. */
void rig_cells(double volts);
/** Input (1..15) of a pack cell (1..). */
unsigned rig_input(unsigned cell);
/** Nothing the judge could note happened. */
void rig_clean(void);

#endif
