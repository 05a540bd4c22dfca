/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file pack.h
 * The pack controller: one pure step from (configuration, state, sample, request, time) to an action.
 * SKELETON: the owner of src/pack completes fields and documentation.
 */
#ifndef BQHOST_PACK_H
#define BQHOST_PACK_H

#include "bqhost/sample.h"
#include "bqhost/status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum bq_pack_state_id {
    BQ_PACK_INIT,      /**< waiting for the first complete sample */
    BQ_PACK_SELF_TEST,
    BQ_PACK_STANDBY,   /**< healthy, outputs off */
    BQ_PACK_ON,        /**< outputs on */
    BQ_PACK_FAULT,     /**< outputs off because of a fault */
    BQ_PACK_SLEEP
} bq_pack_state_id;

/** Pack faults; bit numbers of bq_pack.faults. The names returned by bq_pack_fault_name() are those of the scenario language. */
typedef enum bq_pack_fault {
    BQ_FAULT_CELL_OV,       /**< "cell_ov" */
    BQ_FAULT_CELL_UV,       /**< "cell_uv" */
    BQ_FAULT_OVERTEMP,      /**< "overtemp" */
    BQ_FAULT_UNDERTEMP,     /**< "undertemp" */
    BQ_FAULT_IMBALANCE,     /**< "imbalance" */
    BQ_FAULT_COMM_LOSS,     /**< "comm_loss" */
    BQ_FAULT_CHIP,          /**< "chip": a monitor reports itself unusable */
    BQ_FAULT_CHIP_CELL_OV,  /**< "chip_cell_ov": hardware comparator */
    BQ_FAULT_CHIP_CELL_UV,  /**< "chip_cell_uv" */
    BQ_FAULT_CHIP_OVERTEMP, /**< "chip_overtemp" */
    BQ_FAULT_OPEN_WIRE,     /**< "open_wire" */
    BQ_FAULT_SENSOR,        /**< "sensor": no valid temperature where one is configured */
    BQ_FAULT_SELF_TEST,     /**< "self_test" */
    BQ_FAULT_CONFIG,        /**< "config": monitor configuration could not be established */
    BQ_FAULT_COUNT
} bq_pack_fault;

typedef enum bq_pack_request { BQ_REQUEST_OFF, BQ_REQUEST_ON, BQ_REQUEST_SLEEP } bq_pack_request;

typedef struct bq_pack_config {
    uint16_t cell_ov_mv, cell_ov_clear_mv; /**< trip above, release below */
    uint16_t cell_uv_mv, cell_uv_clear_mv; /**< trip below, release above */
    int16_t overtemp_dc, overtemp_clear_dc;
    int16_t undertemp_dc, undertemp_clear_dc;
    uint16_t imbalance_mv, imbalance_clear_mv; /**< highest minus lowest cell; 0 = off */
    uint16_t debounce_ms;     /**< a limit must be broken this long, by every sample in it */
    uint16_t recover_ms;      /**< ... and kept this long before a fault clears by itself */
    uint16_t comm_timeout_ms; /**< oldest value that may still decide; older = outputs off */
    uint16_t balance_start_mv; /**< spread that starts balancing */
    uint16_t balance_stop_mv;  /**< a cell is bled while above the lowest by more than this */
    uint16_t balance_min_cell_mv; /**< no bleeding below */
    int16_t balance_max_temp_dc;  /**< no bleeding above */
    int32_t balance_rest_ma;  /**< |current| up to this counts as rest; bleeding at rest or while charging only */
    uint16_t balance_rest_ms; /**< rest must have lasted this long */
    uint8_t balance_duty_percent; /**< share of time in which bleeding is allowed, 1..100 */
    uint8_t balance_max_per_module; /**< cells bled at once in one module; 0 = all */
} bq_pack_config;

#ifdef __cplusplus
}
#endif
#endif
