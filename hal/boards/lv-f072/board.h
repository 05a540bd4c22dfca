/* SPDX-License-Identifier: Apache-2.0 */
/* What the files of this board share; see board_main.h. */
#ifndef BOARD_H
#define BOARD_H

#include "bqhost/bq769x0.h"
#include "bqhost/firmware.h"
#include "stm32_can.h"
#include "stm32_i2c.h"
#include "stm32_life.h"
#include "stm32_time.h"
#include "stm32_uart.h"

#define BOARD_CELLS 15u
#define BOARD_SENSORS 3u
#define BOARD_MODULES 1u
#define BOARD_PRECHARGE false
#define BOARD_OCV_POINTS 64u

/** The peripherals in use. */
typedef struct board_parts {
    stm32_i2c i2c; /* small ones that interrupts look at first: a Cortex-M0 reaches the first bytes cheaply */
    stm32_time time;
    stm32_can can;
    bq_boot boot;
    stm32_uart uart;
} board_parts;

/** The configuration: what the settings hold. */
typedef struct board_config {
    bq_app_config app;
    bq_ocv_point ocv[BOARD_OCV_POINTS];
    bq769x0_config afe;
} board_config;

#include "board_main.h"

#endif
