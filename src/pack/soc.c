/* SPDX-License-Identifier: Apache-2.0 */
/* State of charge for display: open-circuit voltage at rest, then coulomb counting. */
#include "bqhost/soc.h"
#include <stddef.h>
#include <string.h>

#define MA_MS_PER_MAH 3600000
/* Two currents further apart say nothing about the time between; it also keeps the product within int64. */
#define LONGEST_MS 86400000u

bool bq_soc_config_ok(const bq_soc_config *c)
{
    if (c == NULL) {
        return false;
    }
    if (c->points == 0u) {
        return true;
    }
    if (c->ocv == NULL || c->points < 2u || c->capacity_mah == 0u || c->capacity_mah > 4000000u ||
        c->rest_ma < 0) {
        return false;
    }
    for (uint16_t i = 0; i < c->points; i++) {
        if (c->ocv[i].permille > 1000u) {
            return false;
        }
        if (i > 0u && (c->ocv[i].permille <= c->ocv[i - 1u].permille || c->ocv[i].mv < c->ocv[i - 1u].mv)) {
            return false;
        }
    }
    return true;
}

void bq_soc_init(bq_soc *s)
{
    memset(s, 0, sizeof *s);
}

/* One permille of the capacity, in mA x ms. */
static int64_t unit(const bq_soc_config *c)
{
    return (int64_t)c->capacity_mah * (MA_MS_PER_MAH / 1000);
}

static int64_t limited(int64_t charge, const bq_soc_config *c)
{
    if (charge < 0) {
        return 0;
    }
    return charge > unit(c) * 1000 ? unit(c) * 1000 : charge;
}

static uint32_t saturating_add(uint32_t a, uint32_t b)
{
    return b > UINT32_MAX - a ? UINT32_MAX : a + b;
}

/* Charge at an open-circuit voltage: linear between two points in steps of 1/256 permille, held at the ends.
 */
static int64_t charge_at(const bq_soc_config *c, uint16_t mv)
{
    const bq_ocv_point *t = c->ocv;
    uint32_t permille_256, rise, above;
    uint16_t i = 0;

    while (i < c->points && t[i].mv < mv) {
        i++;
    }
    if (i == 0u || i == c->points) {
        permille_256 = t[i == 0u ? 0u : i - 1u].permille * 256u;
    } else {
        rise = (uint32_t)t[i].mv - t[i - 1u].mv; /* > 0: t[i - 1] lies below mv, t[i] does not */
        above = (uint32_t)mv - t[i - 1u].mv;
        permille_256 = t[i - 1u].permille * 256u +
                       (uint32_t)(t[i].permille - t[i - 1u].permille) * above / rise * 256u +
                       (uint32_t)(t[i].permille - t[i - 1u].permille) * above % rise * 256u / rise;
    }
    return unit(c) * permille_256 / 256;
}

static void count(bq_soc *s, const bq_soc_config *c, uint32_t dt_ms, bool known, int32_t current_ma)
{
    if (known && s->last_known && dt_ms <= LONGEST_MS) {
        const int64_t mean_twice = (int64_t)s->last_ma + current_ma;
        s->charge_ma_ms = limited(s->charge_ma_ms + mean_twice * (int64_t)dt_ms / 2, c);
    } else {
        s->unknown_ms = saturating_add(s->unknown_ms, dt_ms);
        s->valid = s->unknown_ms <= c->gap_ms;
    }
}

void bq_soc_step(bq_soc *s, const bq_soc_config *c, uint32_t dt_ms, bool known, int32_t current_ma,
                 uint16_t cell_mv)
{
    const bool rest = known && current_ma <= c->rest_ma && current_ma >= -c->rest_ma;

    if (c->points == 0u) {
        return;
    }
    s->resting_ms = rest && s->last_known ? saturating_add(s->resting_ms, dt_ms) : 0u;
    if (s->valid) {
        count(s, c, dt_ms, known, current_ma);
    } else if (rest && s->resting_ms >= c->rest_ms && cell_mv != 0u) {
        s->charge_ma_ms = charge_at(c, cell_mv);
        s->unknown_ms = 0;
        s->valid = true;
    }
    s->last_ma = current_ma;
    s->last_known = known;
}

/* Without a 64-bit division, which costs more code than the rest of this file. */
int16_t bq_soc_permille(const bq_soc *s, const bq_soc_config *c)
{
    int16_t permille = 0;

    if (!s->valid || c->points == 0u) {
        return -1;
    }
    for (int16_t step = 512; step != 0; step = (int16_t)(step / 2)) {
        /* the highest whose lower edge, half a permille below it, is not above the charge */
        if (permille + step <= 1000 && unit(c) * (2 * (permille + step) - 1) <= s->charge_ma_ms * 2) {
            permille = (int16_t)(permille + step);
        }
    }
    return permille;
}
