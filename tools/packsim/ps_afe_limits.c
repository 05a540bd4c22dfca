/* SPDX-License-Identifier: Apache-2.0 */
/* Limits of the bq769x0 driver: defaults and check. */
#include "ps_scenario.h"

#include <math.h>

#define OCD_UV 50000.0 /* across the shunt: the middle of the table with the wide range */
#define SCD_UV 111000.0
#define FROZEN_MS 2500u /* ten conversions that look the same */
/* Temperatures are renewed every 2 s and count 2.25 s after a configuration; the part protects by itself
 * meanwhile. */
#define PATIENCE_MS 3500u

void ps_afe_default(ps_scenario *s, bool lfp)
{
    bq769x0_config *d = &s->afe;
    uint32_t timer_s = s->app.period_ms * 125u / 90000u + 2u;
    s->app.pack.separate_paths = true;
    if (s->app.pack.comm_timeout_ms < PATIENCE_MS) {
        s->app.pack.comm_timeout_ms = PATIENCE_MS;
    }
    d->inputs = s->part->cells;
    d->cells = (uint8_t)s->cells;
    d->sensors = (uint8_t)s->sensors;
    d->sensor = bq769x0_sensor_codes;
    d->sensor_ctx = &bq769x0_codes_103at;
    d->shunt_uohm = (uint32_t)lround(s->shunt_ohm * 1e6);
    d->ov_mv = lfp ? 3750 : 4300;
    d->uv_mv = lfp ? 2300 : 2500;
    d->ov_recover_mv = s->app.pack.cell_ov_clear_mv;
    d->uv_recover_mv = s->app.pack.cell_uv_clear_mv;
    d->ov_delay_s = 1;
    d->uv_delay_s = 1;
    d->ocd_ma = (uint32_t)lround(OCD_UV / s->shunt_ohm / 1000.0);
    d->scd_ma = (uint32_t)lround(SCD_UV / s->shunt_ohm / 1000.0);
    d->ocd_delay_ms = 320;
    d->scd_delay_us = 100;
    d->frozen_scans = (uint16_t)(FROZEN_MS / s->app.period_ms + 10u);
    d->balance_timer_s = (uint8_t)(timer_s < 4u ? 4u : timer_s);
}

/* ---- the driver's own validator, on a bus that is never used ---- */

static bq_status no_start(void *ctx, uint8_t address7, const bq_i2c_segment *segments, size_t count)
{
    (void)ctx;
    (void)address7;
    (void)segments;
    (void)count;
    return BQ_E_BUS;
}

static bq_status no_poll(void *ctx)
{
    (void)ctx;
    return BQ_E_BUS;
}

static uint32_t no_time(void *ctx)
{
    (void)ctx;
    return 0;
}

bq_status ps_afe_check(const ps_scenario *s)
{
    static const bq_i2c_ops ops = {no_start, no_poll, NULL};
    bq769x0 d;
    const bq_i2c i2c = {&ops, NULL};
    const bq_clock clock = {no_time, NULL};
    return bq769x0_init(&d, &s->afe, &i2c, NULL, &clock);
}
