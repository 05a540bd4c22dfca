/* SPDX-License-Identifier: Apache-2.0 */
/* State of charge for display: open-circuit voltage at rest, then coulomb counting. */
#include "pack_internal.h"
#include <stddef.h>
#include <string.h>

#define MA_MS_PER_MAH 3600000u
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
    for (const bq_ocv_point *t = c->ocv, *last = t + c->points - 1; t != last; t++) {
        if (t[1].permille <= t->permille || t[1].mv < t->mv || t[1].permille > 1000u) {
            return false;
        }
    }
    return true;
}

void bq_soc_init(bq_soc *s)
{
    memset(s, 0, sizeof *s);
}

/* So many permille of the capacity, in halves of mA x ms. */
static uint64_t share(const bq_soc_config *c, uint32_t permille)
{
    return (uint64_t)(permille * (MA_MS_PER_MAH / 500u)) * c->capacity_mah;
}

/* Charge at an open-circuit voltage: linear between two points in steps of 1/64 permille, held at the ends.
 */
static int64_t charge_at(const bq_soc_config *c, uint16_t mv)
{
    const bq_ocv_point *t = c->ocv, *last = t + c->points - 1;
    uint32_t permille_64;

    while (t != last && t[1].mv < mv) {
        t++;
    }
    permille_64 = t->permille * 64u;
    if (t != last && t->mv < mv) { /* not above the next one, which so lies higher */
        permille_64 += (uint32_t)(t[1].permille - t->permille) * 64u * (uint32_t)(mv - t->mv) /
                       (uint32_t)(t[1].mv - t->mv);
    }
    return (int64_t)(share(c, permille_64) / 64u);
}

static void count(bq_soc *s, const bq_soc_config *c, uint32_t dt_ms, bool known, int32_t current_ma)
{
    if (known && s->last_known && dt_ms <= LONGEST_MS) {
        const int64_t full = (int64_t)share(c, 1000);
        int64_t charge = s->charge + ((int64_t)s->last_ma + current_ma) * dt_ms;
        if (charge > full) {
            charge = full;
        }
        s->charge = charge < 0 ? 0 : charge;
    } else {
        s->unknown_ms = bq_pack_add_ms(s->unknown_ms, dt_ms);
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
    s->resting_ms = rest && s->last_known ? bq_pack_add_ms(s->resting_ms, dt_ms) : 0u;
    if (s->valid) {
        count(s, c, dt_ms, known, current_ma);
    } else if (rest && s->resting_ms >= c->rest_ms && cell_mv != 0u) {
        s->charge = charge_at(c, cell_mv);
        s->unknown_ms = 0;
        s->valid = true;
    }
    s->last_ma = current_ma;
    s->last_known = known;
}

/* The quotient bit by bit: a 64-bit division would cost more code than the rest of this file. */
int16_t bq_soc_permille(const bq_soc *s, const bq_soc_config *c)
{
    uint64_t rest = (uint64_t)s->charge + share(c, 1) / 2u, part = share(c, 512);
    unsigned permille = 0;

    if (!s->valid || c->points == 0u) {
        return -1;
    }
    for (unsigned bit = 512; bit != 0u; bit /= 2u) {
        if (rest >= part) {
            rest -= part;
            permille += bit;
        }
        rest *= 2u;
    }
    return (int16_t)permille;
}
