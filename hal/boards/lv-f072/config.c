/* SPDX-License-Identifier: Apache-2.0 */
/* The limits a board has before anybody configured it: fifteen NMC cells on a bq7694003, three thermistors of
 * type 103AT, a shunt of 1 milliohm. Ordinary numbers for the chemistry: check them against the cell in use.
 */
#include "board.h"
#include "bqhost/settings.h"

static const bq769x0_config afe_defaults = {
    .inputs = 15,
    .cells = BOARD_CELLS,
    .sensors = BOARD_SENSORS,
    .sensor = bq769x0_sensor_codes,
    .sensor_ctx = &bq769x0_codes_103at,
    .shunt_uohm = 1000,
    .ov_mv = 4300, /* above the pack's own limit: the monitor protects if the firmware does not */
    .uv_mv = 2500,
    .ov_recover_mv = 4150,
    .uv_recover_mv = 3000,
    .ov_delay_s = 1,
    .uv_delay_s = 1,
    .ocd_ma = 50000,
    .ocd_delay_ms = 320,
    .scd_ma = 111000,
    .scd_delay_us = 100,
    .frozen_scans = 20,
    .balance_timer_s = 4,
};

void board_defaults(board_config *c)
{
    c->afe = afe_defaults;
    c->app.period_ms = 250; /* the monitor's own rhythm */
    c->app.retry_ms = 1000;
    c->app.balance_timer_s = 4;
    c->app.pack = bq_pack_config_nmc(BOARD_CELLS, BOARD_SENSORS, 1);
    c->app.pack.comm_timeout_ms = 3500; /* temperatures are renewed every 2 s */
    c->app.pack.separate_paths = true;
    c->app.pack.soc.ocv = c->ocv;
    c->app.pack.soc.points = 0; /* no state of charge: the cell is not known */
}

bq_status board_settings(board_config *c, const bq_nvm *nvm)
{
    const bq_settings_part parts[] = {{&bq_app_config_fields, &c->app, 1},
                                      {&bq_ocv_point_fields, c->ocv, BOARD_OCV_POINTS},
                                      {&bq769x0_config_fields, &c->afe, 1}};
    const bq_settings settings = {parts, sizeof parts / sizeof parts[0]};
    bq_status st = bq_settings_load(&settings, nvm);
    return st == BQ_E_NOT_FOUND ? BQ_OK : st;
}
