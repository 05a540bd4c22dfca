/* SPDX-License-Identifier: Apache-2.0 */
/* Validation, instance set-up and the interface of the super-loop. */
#include "x0_internal.h"
#include <string.h>

static uint16_t bits(uint16_t mask)
{
    uint16_t n = 0;
    for (; mask != 0u; mask &= (uint16_t)(mask - 1u)) {
        n++;
    }
    return n;
}

static bq_status check_cells(const bq769x0_config *c, uint16_t *in_use)
{
    uint16_t all = (uint16_t)((1u << c->inputs) - 1u);
    *in_use = bq769x0_wiring(c->inputs, c->cells);
    if (*in_use == 0u) {
        return BQ_E_CELLS;
    }
    if (c->wiring != 0u) {
        *in_use = c->wiring;
    }
    /* each group is fed by its own cells: bottom, second and top input carry one (X0-CELL-16) */
    for (unsigned g = 0; g < c->inputs / 5u; g++) {
        if (((unsigned)*in_use >> (5u * g) & 0x13u) != 0x13u) {
            return BQ_E_CELLS;
        }
    }
    return bits(*in_use) == c->cells && (*in_use & ~all) == 0 ? BQ_OK : BQ_E_CELLS;
}

static bq_status check_ranges(const bq769x0_config *c)
{
    bool address =
        c->address7 == 0u || c->address7 == 0x08u || (c->address7 == 0x18u && c->crc != BQ769X0_CRC_ON);
    bool sensors = c->sensors <= c->inputs / 5u && (c->sensors == 0u || c->thermistor != NULL);
    bool recover = c->ov_recover_mv != 0u && c->ov_recover_mv < c->ov_mv && c->uv_recover_mv > c->uv_mv;
    if (!address || !sensors || c->crc > BQ769X0_CRC_ON || c->shunt_uohm < 100u || c->shunt_uohm > 100000u ||
        !recover) {
        return BQ_E_RANGE;
    }
    return c->uv_recover_mv < c->ov_mv && c->ov_recover_mv > c->uv_mv ? BQ_OK : BQ_E_CONFIG;
}

/* mA x uohm = nV; in uV without leaving 32 bits (limits above 4 kA and shunts of 100 mohm are refused before
 * by range) */
static uint32_t shunt_uv(uint32_t ma, uint32_t uohm)
{
    uint32_t amp = ma / 1000u, rest = ma % 1000u;
    return amp > 4000u ? UINT32_MAX : amp * uohm + rest * uohm / 1000u;
}

static bq_status check_codes(const bq769x0_config *c, bq769x0_achieved *a)
{
    bq_status st = bq769x0_current_codes(shunt_uv(c->ocd_ma, c->shunt_uohm), c->ocd_delay_ms,
                                         shunt_uv(c->scd_ma, c->shunt_uohm), c->scd_delay_us, &a->current);
    return st == BQ_OK ? bq769x0_protect3(c->ov_delay_s, c->uv_delay_s, &a->protect3) : st;
}

bq_status bq769x0_init(bq769x0 *d, const bq769x0_config *config, const bq_i2c *i2c, const bq_gpio *gpio,
                       const bq_clock *clock)
{
    bq769x0_achieved achieved;
    uint16_t in_use = 0;
    bq_status st;
    if (d == NULL || config == NULL || i2c == NULL || i2c->ops == NULL || clock == NULL ||
        clock->now_us == NULL) {
        return BQ_E_ARG;
    }
    if (config->inputs != 5u && config->inputs != 10u && config->inputs != 15u) {
        return BQ_E_RANGE;
    }
    memset(&achieved, 0, sizeof achieved);
    st = check_cells(config, &in_use);
    st = st == BQ_OK ? check_ranges(config) : st;
    st = st == BQ_OK ? check_codes(config, &achieved) : st;
    if (st != BQ_OK) {
        return st;
    }
    memset(d, 0, sizeof *d);
    d->config = *config;
    d->achieved = achieved;
    d->in_use = in_use;
    d->i2c = *i2c;
    d->clock = *clock;
    if (gpio != NULL) {
        d->gpio = *gpio;
    }
    d->gain2_q15 = 32768u;
    d->now_us = clock->now_us(clock->ctx);
    return BQ_OK;
}

bq_status bq769x0_begin_start(bq769x0 *d)
{
    return x0_begin(d, X0_JOB_START);
}

static bq_status begin_ready(bq769x0 *d, uint8_t job)
{
    return d->depth != 0u ? BQ_E_BUSY : d->state != X0_STATE_READY ? BQ_E_STATE : x0_begin(d, job);
}

bq_status bq769x0_begin_scan(bq769x0 *d)
{
    return begin_ready(d, X0_JOB_SCAN);
}

bq_status bq769x0_begin_self_test(bq769x0 *d)
{
    return begin_ready(d, X0_JOB_COMPARE);
}

bq_status bq769x0_begin_ship(bq769x0 *d)
{
    return begin_ready(d, X0_JOB_SHIP);
}

bq_status bq769x0_begin_oneshot(bq769x0 *d)
{
    return begin_ready(d, X0_JOB_ONESHOT);
}

/* Cells of the pack to inputs of the part (X0-CB-02). */
static uint16_t inputs_of(const bq769x0 *d, const uint32_t *cells)
{
    uint16_t mask = 0, cell = 0;
    for (unsigned i = 0; i < d->config.inputs; i++) {
        if ((d->in_use >> i & 1u) != 0u && bq_mask_get(cells, ++cell)) {
            mask = (uint16_t)(mask | 1u << i);
        }
    }
    return mask;
}

bq_status bq769x0_begin_apply(bq769x0 *d, const bq_action *action)
{
    bq_status st = action != NULL ? begin_ready(d, X0_JOB_APPLY) : BQ_E_ARG;
    if (st == BQ_OK) {
        d->want_fets = (uint8_t)((action->charge_on ? BQ769X0_CTRL2_CHG_ON : 0u) |
                                 (action->discharge_on ? BQ769X0_CTRL2_DSG_ON : 0u));
        d->want_balance = inputs_of(d, action->balance);
        d->served_ms = d->now_ms;
    }
    return st;
}

bool bq769x0_alert_pending(const bq769x0 *d)
{
    bool level = true;
    return d->gpio.ops == NULL || d->gpio.ops->read(d->gpio.ctx, BQ_LINE_ALERT, &level) != BQ_OK || level;
}

const bq769x0_achieved *bq769x0_get_achieved(const bq769x0 *d)
{
    return &d->achieved;
}

const bq769x0_charge *bq769x0_get_charge(const bq769x0 *d)
{
    return &d->charge;
}

void bq769x0_charge_reset(bq769x0 *d)
{
    memset(&d->charge, 0, sizeof d->charge);
}
