/* SPDX-License-Identifier: Apache-2.0 */
/* What the files of this board share; see board_main.h. */
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
#define BOARD_MODULES BOARD_DEVICES
#define BOARD_PRECHARGE true
#define BOARD_OCV_POINTS 64u

/** The peripherals in use. */
typedef struct board_parts {
    bq_boot boot;
    stm32_time time;
    stm32_uart uart;
    stm32_can can;
    stm32_can_inbox inbox;
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

#include "board_main.h"

#endif
