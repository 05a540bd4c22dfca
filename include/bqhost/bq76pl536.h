/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file bq76pl536.h
 * Driver for a stack of bq76PL536 (or bq76PL536A) monitors on one SPI port.
 * SKELETON: the driver's owner completes the documentation of every function.
 */
#ifndef BQHOST_BQ76PL536_H
#define BQHOST_BQ76PL536_H

#include "bqhost/afe.h"
#include "bqhost/hal.h"
#include "bqhost/thermistor.h"

#ifdef __cplusplus
extern "C" {
#endif

#define BQ76PL536_MAX_DEVICES 62u
#define BQ76PL536_MAX_CELLS 6u

typedef struct bq76pl536_config {
    uint8_t devices;          /**< 1..62, base first (above 32: beyond the datasheet's 192 cells, allowed) */
    uint8_t cells_per_device; /**< 3..6, when `cells` is NULL */
    const uint8_t *cells;     /**< NULL, or [devices] cell counts 3..6, base first; must outlive the instance */
    bool variant_a;           /**< the parts are bq76PL536A */
    bool crc_off;             /**< run the link without CRC (not advised, PL-CRC-09) */
    bool use_conv_pin;        /**< start conversions with BQ_LINE_CONV instead of a broadcast */
    bool allow_unlatched;     /**< permits protection delays of 0 */
    uint8_t sensors;          /**< thermistors per device, 0..2 */
    const bq_thermistor *thermistor; /**< table for ratio to temperature; NULL only with sensors = 0 */
    uint16_t sensor_settle_ms; /**< 5 time constants of the sensor network; 0 = 10 ms */
    uint16_t cov_mv;          /**< overvoltage trip 2000..5000 in steps of 50; 0 = comparator off */
    uint16_t cuv_mv;          /**< undervoltage trip 700..3300 in steps of 100; 0 = comparator off */
    uint32_t cov_delay_us;    /**< 100..3100 in steps of 100, or 100000..3100000 in steps of 100000 */
    uint32_t cuv_delay_us;    /**< same */
    uint8_t ot_c[2];          /**< sensor 1, 2: 40..90 degrees C in steps of 5; 0 = off */
    uint16_t ot_delay_ms;     /**< 10..2550 in steps of 10 */
    uint32_t spi_hz;          /**< 0 = by stack size (PL-TIM-10); otherwise 10000..1000000 and within PL-NUM-38 */
    uint8_t balance_timer_s;  /**< safety timer 1..63 s; 0 = 4 s */
    uint16_t balance_settle_ms; /**< wait after balancing off before a conversion; 0 = 10 ms */
    uint16_t scrub_period_ms; /**< every so often one device's configuration is read back; 0 = 1000 */
    uint16_t wire_limit_mv;   /**< brick minus sum of cells that counts as an open wire; 0 = 200 */
    uint8_t user[4];          /**< content of USER1..USER4 */
} bq76pl536_config;

#include "bqhost/bq76pl536_state.h" /* struct bq76pl536: complete, so that the caller can own it; members are private */

/** Validates the whole configuration, then sets up the instance. Touches no bus. `gpio` may be NULL (no lines). */
bq_status bq76pl536_init(bq76pl536 *d, const bq76pl536_config *config, const bq_spi *spi, const bq_gpio *gpio,
                         const bq_clock *clock, bq76pl536_device *devices, uint8_t device_capacity);

/** Fills the interface the super-loop uses. */
bq_afe bq76pl536_afe(bq76pl536 *d);

#ifdef __cplusplus
}
#endif
#endif
