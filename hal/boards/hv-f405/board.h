/* SPDX-License-Identifier: Apache-2.0 */
/* What the files of this board share. */
#ifndef BOARD_H
#define BOARD_H

#include "bqhost/bq76pl536.h"
#include "bqhost/firmware.h"
#include "stm32_can.h"
#include "stm32_life.h"
#include "stm32_time.h"
#include "stm32_uart.h"
#include "stm32f4_adc.h"
#include "stm32f4_spi.h"

/* Room for the largest stack that settings may name: 192 cells */
#define BOARD_DEVICES 32u
#define BOARD_CELLS (BOARD_DEVICES * BQ76PL536_MAX_CELLS)
#define BOARD_SENSORS (BOARD_DEVICES * 2u)
#define BOARD_OCV_POINTS 64u

/** The peripherals in use. */
typedef struct board_parts {
    bq_boot boot;
    stm32_time time;
    stm32_uart uart;
    stm32_can can;
    stm32_spi spi;
    stm32_adc adc;
} board_parts;

/** The configuration: what the settings hold. */
typedef struct board_config {
    bq_app_config app;
    bq_ocv_point ocv[BOARD_OCV_POINTS];
    bq76pl536_config stack;
    uint8_t cells[BQ76PL536_MAX_DEVICES]; /* of each device */
} board_config;

/** From reset to running peripherals; interrupts stay masked. Fills parts->boot. */
void board_start(board_parts *parts);

/** The board for the firmware; `parts` must outlive it. */
bq_board board_table(board_parts *parts);

/** Sets the LED. */
void board_led(bool on);

/** Limits of a board that nobody has configured, and the pointers that settings do not hold. */
void board_defaults(board_config *config);

/** Replaces the defaults by the settings in flash, if there are any, and chooses the clock of the bus where
 * they do not. BQ_OK, also without settings; otherwise a status of bq_settings_load(): they are there and
 * cannot be used. */
bq_status board_settings(board_config *config, const bq_nvm *nvm);

#endif
