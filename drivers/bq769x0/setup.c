/* SPDX-License-Identifier: Apache-2.0 */
/* The whole driver: validation of what is beyond the base set, and the functions that begin a job. */
#include "x0_internal.h"

static bool in_range(const bq769x0_config *c)
{
    bool address =
        c->address7 == 0u || c->address7 == 0x08u || (c->address7 == 0x18u && c->crc != BQ769X0_CRC_ON);
    bool recover = c->ov_recover_mv != 0u && c->ov_recover_mv < c->ov_mv && c->uv_recover_mv > c->uv_mv;
    return address && recover && c->crc <= BQ769X0_CRC_ON;
}

static bool die_in_range(const bq769x0_config *c)
{
    bool v25 = c->die_v25_uv == 0u || c->die_v25_uv - 1100000u <= 200000u;
    return v25 && (uint16_t)c->die_limit_dc <= 950u && (uint16_t)c->die_fault_dc <= 1000u &&
           (c->die_check_s == 0u || c->die_check_s >= 5u);
}

/* Lowest cells of the upper groups: below them lies a border between groups. */
static uint16_t borders(unsigned in_use)
{
    return (uint16_t)(1u << x0_bits(in_use & 0x001fu) | 1u << x0_bits(in_use & 0x03ffu));
}

static bq_status check(const bq769x0_config *c)
{
    int16_t dc;
    if (c->inputs != 5u && c->inputs != 10u && c->inputs != 15u) {
        return BQ_E_RANGE;
    }
    if (!in_range(c) || !die_in_range(c)) {
        return BQ_E_RANGE;
    }
    if (c->sensors != 0u && c->sensor != NULL && !c->sensor(c->sensor_ctx, BQ769X0_TS_CODE(10000), &dc)) {
        return BQ_E_CONFIG;
    }
    return c->uv_recover_mv < c->ov_mv && c->ov_recover_mv > c->uv_mv ? BQ_OK : BQ_E_CONFIG;
}

static bool complete(const bq_i2c *i2c, const bq_gpio *gpio, const bq_clock *clock)
{
    bool bus = i2c != NULL && i2c->ops != NULL && i2c->ops->start != NULL && i2c->ops->poll != NULL;
    bool lines = gpio == NULL || gpio->ops == NULL || (gpio->ops->read != NULL && gpio->ops->write != NULL);
    return bus && lines && clock != NULL && clock->now_us != NULL;
}

bq_status bq769x0_init(bq769x0 *d, const bq769x0_config *config, const bq_i2c *i2c, const bq_gpio *gpio,
                       const bq_clock *clock)
{
    bq_status st;
    bq769x0_known known;
    bq769x0_current_limits current;
    if (d == NULL || config == NULL || !complete(i2c, gpio, clock)) {
        return BQ_E_ARG;
    }
    st = check(config);
    if (st == BQ_OK) {
        uint16_t in_use =
            config->wiring != 0u ? config->wiring : bq769x0_wiring(config->inputs, config->cells);
        st = x0_known_of(config, in_use, &known, &current);
    }
    if (st != BQ_OK) {
        return st;
    }
    bq769x0_init_known(d, &known, i2c, clock);
    d->config = *config;
    if (config->die_v25_uv == 0u) {
        d->config.die_v25_uv = BQ769X0_DIE_V25_UV;
    }
    if (config->sensors == 0u) {
        d->known.sensor_ctx = &d->config.die_v25_uv;
    }
    d->achieved.current = current;
    d->gain2_q15 = 32768u;
    if (gpio != NULL) {
        d->gpio = *gpio;
    }
    if (config->balance_across_groups) {
        d->known.apart = borders(d->known.in_use);
    }
    return BQ_OK;
}

bq_status bq769x0_begin_start(bq769x0 *d)
{
    return x0_begin(d, X0_STATE_NONE, x0_job_start);
}

bq_status bq769x0_begin_scan(bq769x0 *d)
{
    return x0_begin(d, X0_STATE_READY, x0_job_scan);
}

bq_status bq769x0_begin_self_test(bq769x0 *d)
{
    return x0_begin(d, X0_STATE_READY, x0_job_compare);
}

bq_status bq769x0_begin_ship(bq769x0 *d)
{
    return x0_begin(d, X0_STATE_READY, x0_job_ship);
}

bq_status bq769x0_begin_oneshot(bq769x0 *d)
{
    return x0_begin(d, X0_STATE_READY, x0_job_oneshot);
}

bool bq769x0_alert_pending(const bq769x0 *d)
{
    bool level = true;
    return d->gpio.ops == NULL || d->gpio.ops->read(d->gpio.ctx, BQ_LINE_ALERT, &level) != BQ_OK || level;
}

bq769x0_trim x0_trim(const bq769x0 *d)
{
    return bq769x0_trim_from((uint8_t)(d->trim >> 16), (uint8_t)(d->trim >> 8), (uint8_t)(d->trim >> 24));
}

const bq769x0_achieved *bq769x0_get_achieved(bq769x0 *d)
{
    bq769x0_achieved *a = &d->achieved;
    const uint8_t *registers = d->known.registers;
    a->trim = x0_trim(d);
    a->ov_trip = registers[BQ769X0_OV_TRIP];
    a->uv_trip = registers[BQ769X0_UV_TRIP];
    a->protect3 = registers[BQ769X0_PROTECT3];
    a->ov_uv = bq769x0_cell_uv(a->trim, bq769x0_ov_code(a->ov_trip));
    a->uv_uv = bq769x0_cell_uv(a->trim, bq769x0_uv_code(a->uv_trip));
    a->address7 = d->known.address7;
    a->crc = d->known.crc;
    return a;
}

unsigned bq769x0_config_warnings(const bq769x0_config *c)
{
    unsigned warnings = c->inputs > 5u && !c->balance_external ? BQ769X0_WARN_BALANCE : 0u;
    return warnings | (bq769x0_shunt_uv(c->scd_ma, c->shunt_uohm) > 300000u ? BQ769X0_WARN_SHUNT : 0u);
}

bool bq769x0_current_outside(const bq769x0 *d)
{
    return d->cc_code > 23696 || d->cc_code < -23696;
}
