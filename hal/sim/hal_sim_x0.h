/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file hal_sim_x0.h
 * Back-end that ends in a simulated bq769x0 instead of in pins: I2C, ALERT, the boot signal, contactor lines
 * and a clock. A transaction lets its own bus time pass (9 clocks a byte at 100 kHz); all other time passes
 * only when the caller advances.
 */
#ifndef HAL_SIM_X0_H
#define HAL_SIM_X0_H

#include "bqhost/hal.h"
#include "sim_x0.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct hal_sim_x0 {
    sim_x0 *chip;
    /* May be set after hal_sim_x0_init() and changed at any time. */
    void (*advance)(void *ctx, uint64_t ns); /**< lets time pass; the default is sim_x0_advance() */
    void *advance_ctx;
    uint32_t missing; /**< bit of each bq_line that this board does not have */
    uint32_t fail_at; /**< this transaction from now (1 = the next) is not carried out and ends with BQ_E_BUS;
                         0 = none */
    uint32_t pending; /**< so many polls answer BQ_PENDING before a transaction ends */
    /* To read. */
    uint64_t transactions, bytes;
    uint32_t overlaps; /**< starts while a transaction ran: a mistake of the driver */
    uint32_t recoveries;
    /* Private. */
    bool level[BQ_LINE_COUNT];
    bool busy;
    uint64_t boot_from; /**< rise of the boot signal */
    uint32_t left;
    bq_status outcome;
} hal_sim_x0;

/** Sets up a back-end on a simulated part, which must outlive it. All outputs low. */
void hal_sim_x0_init(hal_sim_x0 *h, sim_x0 *chip);
/** A reset of the microcontroller: outputs low, no transaction under way. */
void hal_sim_x0_reset(hal_sim_x0 *h);

/** The tables for bq769x0_init() and bq_app_init(); `h` must outlive them. */
bq_i2c hal_sim_x0_i2c(hal_sim_x0 *h);
bq_gpio hal_sim_x0_gpio(hal_sim_x0 *h);
bq_clock hal_sim_x0_clock(hal_sim_x0 *h);

/** Lets time pass through the hook. */
void hal_sim_x0_advance(hal_sim_x0 *h, uint64_t ns);

#ifdef __cplusplus
}
#endif
#endif
