/* SPDX-License-Identifier: Apache-2.0 */
#include "hv_settings.h"
#include "bqhost/bq76pl536_convert.h"
#include "bqhost/settings.h"
#include "hv_world.h"
#include "unity.h"
#include <string.h>

void hv_settings_make(hv_settings *s, uint8_t devices, uint32_t delay_ms)
{
    memset(s, 0, sizeof *s);
    s->app = (bq_app_config){.period_ms = 100, .retry_ms = 1000, .balance_timer_s = 4};
    s->app.pack = bq_pack_config_nmc((uint16_t)(devices * 6u), (uint16_t)(devices * 2u), devices);
    s->stack = (bq76pl536_config){.devices = devices,
                                  .cells_per_device = 6,
                                  .sensors = 2,
                                  .thermistor = &bq_thermistor_103at,
                                  .cov_mv = 4300,
                                  .cuv_mv = 2500,
                                  .cov_delay_us = delay_ms * 1000u,
                                  .cuv_delay_us = delay_ms * 1000u,
                                  .ot_c = {65, 65},
                                  .ot_delay_ms = (uint16_t)delay_ms,
                                  .balance_timer_s = 4};
    memset(s->cells, 6, sizeof s->cells);
}

size_t hv_settings_record(hv_settings *s, uint32_t sequence, uint8_t *record, size_t capacity)
{
    const bq_settings_part parts[] = {{&bq_app_config_fields, &s->app, 1},
                                      {&bq_ocv_point_fields, s->ocv, 64},
                                      {&bq76pl536_config_fields, &s->stack, 1},
                                      {&bq_byte_fields, s->cells, BQ76PL536_MAX_DEVICES}};
    const bq_settings settings = {parts, 4};
    return bq_settings_encode(&settings, sequence, record, capacity);
}

void hv_settings_put(hv_settings *s, uint32_t sequence, uint32_t address)
{
    uint8_t record[2048];
    size_t n = hv_settings_record(s, sequence, record, sizeof record);
    TEST_ASSERT_TRUE(n > 0);
    TEST_ASSERT_TRUE(emu_load(hv.e, address, record, n));
}
