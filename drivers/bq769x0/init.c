/* SPDX-License-Identifier: Apache-2.0 */
/* From physical units to what the base set is told: wiring, limits and delays in codes. */
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
    return c->sensors <= groups && (c->sensors == 0u || c->sensor != NULL) &&
           c->shunt_uohm - 100u <= 100000u - 100u;
}

bq_status x0_known_of(const bq769x0_config *c, unsigned in_use, bq769x0_known *k,
                      bq769x0_current_limits *current)
{
    static const uint32_t usual_v25_uv = BQ769X0_DIE_V25_UV;
    unsigned groups = c->inputs / 5u;
    uint8_t protect3;
    bq_status st;
    if (!wired(c, in_use)) {
        return BQ_E_CELLS;
    }
    if (!in_range(c, groups)) {
        return BQ_E_RANGE;
    }
    st = bq769x0_protect3(c->ov_delay_s, c->uv_delay_s, &protect3);
    if (st == BQ_OK) {
        st = bq769x0_current_codes(bq769x0_shunt_uv(c->ocd_ma, c->shunt_uohm), c->ocd_delay_ms,
                                   bq769x0_shunt_uv(c->scd_ma, c->shunt_uohm), c->scd_delay_us, current);
    }
    if (st != BQ_OK) {
        return st;
    }
    memset(k, 0, sizeof *k);
    k->registers[BQ769X0_PROTECT1] = current->protect1;
    k->registers[BQ769X0_PROTECT2] = current->protect2;
    k->registers[BQ769X0_PROTECT3] = protect3;
    k->registers[BQ769X0_CC_CFG] = BQ769X0_CC_CFG_VALUE;
    k->registers[BQ769X0_SYS_CTRL1] = BQ769X0_DIE;
    k->sensor = bq769x0_sensor_die;
    k->sensor_ctx = c->die_v25_uv != 0u ? &c->die_v25_uv : &usual_v25_uv;
    if (c->sensors != 0u) {
        k->registers[BQ769X0_SYS_CTRL1] = BQ769X0_THERMISTORS;
        k->sensor = c->sensor;
        k->sensor_ctx = c->sensor_ctx;
    }
    k->address7 = c->address7;
    k->crc = c->crc == BQ769X0_CRC_ON;
    k->groups = (uint8_t)groups;
    k->first = 15;
    k->codes = c->inputs;
    if (groups == 3u) {
        k->first = 0;
        k->codes = 20;
    }
    k->cells = c->cells;
    k->invert_current = c->invert_current;
    k->counter = c->counter_off ? 0u : BQ769X0_CTRL2_CC_EN;
    k->in_use = (uint16_t)in_use;
    k->ov_mv = c->ov_mv;
    k->uv_mv = c->uv_mv;
    k->shunt_uohm = c->shunt_uohm;
    return BQ_OK;
}

bq_status bq769x0_known_of(const bq769x0_config *config, bq769x0_known *known)
{
    bq769x0_current_limits current;
    return x0_known_of(config, config->wiring, known, &current);
}
