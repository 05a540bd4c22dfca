/* SPDX-License-Identifier: Apache-2.0 */
/* The limits a board has before anybody configured it: sixteen bq76PL536 with six NMC cells and two
 * thermistors of type 103AT each. Ordinary numbers for the chemistry: check them against the cell in use. */
#include "board.h"
#include "bqhost/bq76pl536_convert.h"
#include "bqhost/settings.h"
#include <string.h>

#define DEFAULT_DEVICES 16u
#define DEFAULT_CELLS 6u

static const bq76pl536_config stack_defaults = {
    .devices = DEFAULT_DEVICES,
    .cells_per_device = DEFAULT_CELLS,
    .sensors = 2,
    .thermistor = &bq_thermistor_103at,
    .cov_mv = 4300, /* beyond the pack's own limits: the devices protect if the firmware does not */
    .cuv_mv = 2500,
    .cov_delay_us = 500000,
    .cuv_delay_us = 500000,
    .normal_max_mv = 4200,
    .normal_min_mv = 2800,
    .ot_c = {65, 65},
    .ot_delay_ms = 500,
    .balance_timer_s = 4,
    /* 25 s. The datasheet bounds the noise of the converter from above only (PL-VCELL-04): with a fifth of it
     * a pack at rest repeats all its codes for 5 s at times, and a healthy one must not open. What must be
     * quick is seen by other means: a locked converter by DRDY, the cells' limits by the devices' own
     * comparators. */
    .frozen_scans = 250,
    .warm_start = true, /* a reset of the microcontroller is no reset of the stack */
};

void board_defaults(board_config *c)
{
    c->stack = stack_defaults;
    c->stack.cells = c->cells;
    memset(c->cells, DEFAULT_CELLS, sizeof c->cells);
    c->app.period_ms = 100;
    c->app.retry_ms = 1000;
    c->app.precharge_ms = 300;
    c->app.precharge_end_ma = 2000;
    c->app.balance_timer_s = stack_defaults.balance_timer_s;
    c->app.pack = bq_pack_config_nmc(DEFAULT_DEVICES * DEFAULT_CELLS, DEFAULT_DEVICES * 2u, DEFAULT_DEVICES);
    c->app.pack.soc.ocv = c->ocv;
    c->app.pack.soc.points = 0; /* no state of charge: the cell is not known */
}

/* Where the settings leave the rate to the stack: the highest that SPI1 has within the limit of PL-NUM-38.
 * That limit is for a duty of 40 %; SPI1 has 50 %, which is the margin of 20 % that PL-TIM-10 asks for. */
static void choose_rate(bq76pl536_config *c)
{
    uint32_t limit;
    if (c->spi_hz == 0u && bq76pl536_spi_max_hz(c->devices, &limit) == BQ_OK) {
        c->spi_hz = stm32_spi_rate(limit);
    }
}

bq_status board_settings(board_config *c, const bq_nvm *nvm)
{
    const bq_settings_part parts[] = {{&bq_app_config_fields, &c->app, 1},
                                      {&bq_ocv_point_fields, c->ocv, BOARD_OCV_POINTS},
                                      {&bq76pl536_config_fields, &c->stack, 1},
                                      {&bq_byte_fields, c->cells, BQ76PL536_MAX_DEVICES}};
    const bq_settings settings = {parts, sizeof parts / sizeof parts[0]};
    bq_status st = bq_settings_load(&settings, nvm);
    if (st == BQ_OK || st == BQ_E_NOT_FOUND) {
        choose_rate(&c->stack);
        st = BQ_OK;
    }
    return st;
}
