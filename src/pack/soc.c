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

static int64_t full(const bq_soc_config *c)
{
    return (int64_t)c->capacity_mah * MA_MS_PER_MAH;
}

static int64_t limited(int64_t charge, const bq_soc_config *c)
{
    if (charge < 0) {
        return 0;
    }
    return charge > full(c) ? full(c) : charge;
}

static uint32_t saturating_add(uint32_t a, uint32_t b)
{
    return b > UINT32_MAX - a ? UINT32_MAX : a + b;
}

/* Charge at an open-circuit voltage: linear between two points, held at the ends. */
static int64_t charge_at(const bq_soc_config *c, uint16_t mv)
{
    const bq_ocv_point *t = c->ocv;
    uint16_t i = 1;
    int32_t rise, above;

    if (mv <= t[0].mv) {
        return full(c) / 1000 * t[0].permille;
    }
    while (i < c->points && t[i].mv < mv) {
        i++;
    }
    if (i == c->points) {
        return full(c) / 1000 * t[i - 1u].permille;
    }
    rise = (int32_t)t[i].mv - (int32_t)t[i - 1u].mv; /* > 0: t[i - 1] lies below mv, t[i] does not */
    above = (int32_t)mv - (int32_t)t[i - 1u].mv;
    return full(c) / 1000 * t[i - 1u].permille +
           full(c) / 1000 * (t[i].permille - t[i - 1u].permille) * above / rise;
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

int16_t bq_soc_permille(const bq_soc *s, const bq_soc_config *c)
{
    const int64_t unit = full(c) / 1000;

    if (!s->valid || c->points == 0u) {
        return -1;
    }
    return (int16_t)((s->charge_ma_ms + unit / 2) / unit);
}
