/* SPDX-License-Identifier: Apache-2.0 */
/* Checks that every user needs, limits of current and delays to codes, and the instance itself. */
#include "x0_internal.h"
#include <string.h>

unsigned x0_bits(unsigned mask)
{
    unsigned n = 0;
    for (; mask != 0u; mask &= mask - 1u) {
        n++;
    }
    return n;
}

/* Each group is fed by its own cells: bottom, second and top input carry one (X0-CELL-16). */
static bool wired(const bq769x0_config *c, unsigned in_use)
{
    unsigned fed = 0x4e73u & ((1u << c->inputs) - 1u); /* 0x13 in each group */
    return (in_use & fed) == fed && in_use >> c->inputs == 0u && x0_bits(in_use) == c->cells;
}

static bool in_range(const bq769x0_config *c, unsigned groups)
{
    return c->sensors <= groups && (c->sensors == 0u || c->thermistor != NULL) &&
           c->shunt_uohm - 100u <= 100000u - 100u;
}

bq_status x0_init(bq769x0 *d, const bq769x0_config *config, uint16_t in_use, const bq_i2c *i2c,
                  const bq_clock *clock)
{
    bq769x0_current_limits current;
    unsigned groups = config->inputs / 5u;
    int ov, uv;
    bq_status st;
    if (!wired(config, in_use)) {
        return BQ_E_CELLS;
    }
    if (!in_range(config, groups)) {
        return BQ_E_RANGE;
    }
    ov = bq769x0_delay_code(BQ769X0_DELAY_OV_S, config->ov_delay_s, &current.ocd_delay_ms); /* overwritten */
    uv = bq769x0_delay_code(BQ769X0_DELAY_UV_S, config->uv_delay_s, &current.ocd_delay_ms);
    if ((ov | uv) < 0) { /* one of them is -1 */
        return BQ_E_NO_CODE;
    }
    st = bq769x0_current_codes(bq769x0_shunt_uv(config->ocd_ma, config->shunt_uohm), config->ocd_delay_ms,
                               bq769x0_shunt_uv(config->scd_ma, config->shunt_uohm), config->scd_delay_us,
                               &current);
    if (st != BQ_OK) {
        return st;
    }
    memset(d, 0, sizeof *d);
    d->config = *config;
    if (config->die_v25_uv == 0u) {
        d->config.die_v25_uv = 1200000u;
    }
    d->achieved.current = current;
    d->achieved.protect3 = (uint8_t)(uv << 6 | ov << 4);
    d->in_use = in_use;
    d->inputs = config->inputs;
    d->cells = config->cells;
    d->temps = config->sensors != 0u ? config->sensors : 1u;
    d->groups = (uint8_t)groups;
    d->address7 = d->achieved.address7 = config->address7;
    d->crc = d->achieved.crc = config->crc == BQ769X0_CRC_ON;
    d->gain2_q15 = 32768u;
    d->top = d->frames;
    d->top->catches = true; /* no job: the end of every failure */
    d->i2c = *i2c;
    d->clock = *clock;
    return BQ_OK;
}

bq_status bq769x0_init_known(bq769x0 *d, const bq769x0_config *config, const bq_i2c *i2c,
                             const bq_clock *clock)
{
    return x0_init(d, config, config->wiring, i2c, clock);
}
