/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file hal_sim.h
 * Back-end that ends in the simulator instead of in pins: for tests, for packsim, and for trying the library
 * on a PC.
 *
 * A transfer lets its own bus time pass (8 clocks a byte, 3 us of CS gap); all other time passes only when
 * the caller advances the simulator, usually by what poll asked to wait. Set `advance` when a world of cells
 * has to move along.
 */
#ifndef HAL_SIM_H
#define HAL_SIM_H

#include "bqhost/hal.h"
#include "sim_pl536.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct hal_sim {
    sim_pl *pl;
    /* May be set after hal_sim_init() and changed at any time. */
    void (*advance)(void *ctx, uint64_t ns); /**< lets time pass; the default is sim_pl_advance() */
    void *advance_ctx;
    uint32_t tick_ns; /**< every reading of the clock lets so much time pass (for blocking waits); 0 = none */
    int vpp_device;   /**< device that BQ_LINE_VPP reaches, 1 unless changed */
    uint32_t missing; /**< bit of each bq_line that this board does not have */
    bool fixed_clock; /**< the board cannot change its SPI clock: set_clock returns BQ_E_RANGE */
    int32_t current_ma;                 /**< what the ammeter shows */
    bool current_stale, current_broken; /**< the ammeter answers BQ_E_STALE or BQ_E_BUS */
    uint32_t fail_at; /**< this transfer from now (1 = the next) is not carried out and ends with BQ_E_BUS; 0
                         = none */
    uint32_t fail_count; /**< how many in a row then fail; 0 counts as 1 */
    bool fail_in_start;  /**< ... already start refuses them */
    uint32_t pending;    /**< so many polls answer BQ_PENDING before a transfer ends */
    /* To read. */
    uint64_t transfers, bytes;
    uint32_t clock_hz;
    uint32_t overlaps; /**< starts while a transfer ran: a mistake of the driver */
    /* Private. */
    bool level[BQ_LINE_COUNT];
    bool welded, busy;
    uint32_t left;
    bq_status outcome;
} hal_sim;

/** Sets up a back-end on a simulated stack, which must outlive it. All outputs low, supply on, 250 kHz. */
void hal_sim_init(hal_sim *h, sim_pl *pl);
/** A reset of the microcontroller: outputs low, no transfer under way. The supply of the stack, the welded
 * contactor, the settings stay. */
void hal_sim_reset(hal_sim *h);

/** The tables for bq76pl536_init() and bq_app_init(); `h` must outlive them. */
bq_spi hal_sim_spi(hal_sim *h);
bq_gpio hal_sim_gpio(hal_sim *h);
bq_clock hal_sim_clock(hal_sim *h);
bq_ammeter hal_sim_ammeter(hal_sim *h);

/** Lets time pass through the hook. */
void hal_sim_advance(hal_sim *h, uint64_t ns);
/** Level of a line as a probe on the board sees it. */
bool hal_sim_line(const hal_sim *h, bq_line line);
/** The contactor sticks closed (true) or follows its line again. */
void hal_sim_weld(hal_sim *h, bool welded);

#ifdef __cplusplus
}
#endif
#endif
