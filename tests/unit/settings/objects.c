/* SPDX-License-Identifier: Apache-2.0 */
#include "objects.h"
#include <string.h>

void objects_init(objects *o)
{
    memset(o, 0, sizeof *o);
    o->app.period_ms = 100;
    o->app.balance_timer_s = 4;
    o->app.pack = bq_pack_config_nmc(96, 32, 16);
    o->app.pack.soc = (bq_soc_config){o->ocv, 3, 60000, 500, 2000, 5000};
    o->ocv[0] = (bq_ocv_point){0, 3000};
    o->ocv[1] = (bq_ocv_point){500, 3700};
    o->ocv[2] = (bq_ocv_point){1000, 4200};
    o->driver.devices = 16;
    o->driver.cells = o->cells;
    o->driver.thermistor = &bq_thermistor_103at;
    o->driver.cov_mv = 4350;
    o->driver.cov_delay_us = 500000;
    memset(o->cells, 6, sizeof o->cells);
    o->parts[0] = (bq_settings_part){&bq_app_config_fields, &o->app, 1};
    o->parts[1] = (bq_settings_part){&bq_ocv_point_fields, o->ocv, BQ_FIELD_MAX_POINTS};
    o->parts[2] = (bq_settings_part){&bq76pl536_config_fields, &o->driver, 1};
    o->parts[3] = (bq_settings_part){&bq_byte_fields, o->cells, BQ76PL536_MAX_DEVICES};
    o->settings = (bq_settings){o->parts, 4};
}
