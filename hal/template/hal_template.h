/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file hal_template.h
 * An empty port: copy this folder, rename `template`, fill the places marked FILL IN. It compiles as it
 * stands and refuses everything, so that a forgotten place is noticed. The rules each function must keep are
 * in bqhost/hal.h.
 */
#ifndef HAL_TEMPLATE_H
#define HAL_TEMPLATE_H

#include "bqhost/hal.h"

#ifdef __cplusplus
extern "C" {
#endif

/* FILL IN: the flash that belongs to the settings. */
#define HAL_TEMPLATE_SECTORS 2u
#define HAL_TEMPLATE_SECTOR_BYTES 2048u
#define HAL_TEMPLATE_UNIT_BYTES 2u

/** Everything a port needs to remember; the caller owns it. Members are private. */
typedef struct hal_template {
    bool busy; /* an SPI transfer runs */
    bq_status
        outcome; /* set where the transfer ends: interrupt, DMA flag, or the last byte of a polled loop */
    uint32_t last_ticks; /* for the microsecond counter */
    bq_boot boot;        /* what the start-up code found out */
} hal_template;

/** Sets up pins and peripherals: all outputs inactive, SCLK and SDI low, CS high (PL-SEQ-01-01). BQ_OK or the
 * port's own error. */
bq_status hal_template_init(hal_template *h);

/** The tables for the drivers' init functions; `h` must outlive them. */
bq_spi hal_template_spi(hal_template *h);
bq_i2c hal_template_i2c(hal_template *h);
bq_gpio hal_template_gpio(hal_template *h);
bq_clock hal_template_clock(hal_template *h);
bq_ammeter hal_template_ammeter(hal_template *h);

/** The tables for bq_board of bqhost/firmware.h; `h` must outlive them. */
bq_can hal_template_can(hal_template *h);
bq_stream hal_template_stream(hal_template *h);
bq_nvm hal_template_nvm(hal_template *h);
bq_mcu hal_template_mcu(hal_template *h);

#ifdef __cplusplus
}
#endif
#endif
