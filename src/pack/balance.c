/* SPDX-License-Identifier: Apache-2.0 */
/* Which cells to bleed. Deterministic: equal pictures and histories give equal masks. */
#include "pack_internal.h"

static bool charging(const bq_pack *p, const bq_picture *v)
{
    return v->current_known && v->s->current_ma > p->config.balance_rest_ma;
}

/* Rest is a small measured current, or open outputs where nobody has ever measured one. */
static bool resting(const bq_pack *p, const bq_picture *v)
{
    if (v->current_known) {
        return v->s->current_ma <= p->config.balance_rest_ma &&
               v->s->current_ma >= -p->config.balance_rest_ma;
    }
    return v->s != NULL && !v->s->current_valid && p->drives == 0u && v->in->contactor_mismatch_ms == 0u;
}

/* Everything but the spread: PL-SEQ-10-01 asks for fresh valid voltages, no fault, no lockout, no sleep. */
static bool permitted(const bq_pack *p, const bq_picture *v)
{
    const bq_pack_config *k = &p->config;

    return !v->in->balance_off && (p->state == BQ_PACK_STANDBY || p->state == BQ_PACK_ON) &&
           v->in->monitor == BQ_MONITOR_UP && p->summary.complete && p->pending == 0u &&
           k->balance_start_mv != 0u &&
           (p->summary.temp_max == 0u || p->summary.temp_max_dc <= k->balance_max_temp_dc) &&
           (charging(p, v) || (p->resting && p->rest_ms >= k->balance_rest_ms));
}

/* Starts at a spread of balance_start_mv, goes on down to balance_stop_mv. */
static bool wanted(const bq_pack *p)
{
    const uint16_t spread = (uint16_t)(p->summary.cell_max_mv - p->summary.cell_min_mv);

    return p->balancing ? spread > p->config.balance_stop_mv : spread >= p->config.balance_start_mv;
}

/* The lowest voltage at which a cell is bled. */
static uint32_t least_mv(const bq_pack *p)
{
    const uint32_t above = (uint32_t)p->summary.cell_min_mv + p->config.balance_stop_mv + 1u;

    return above > p->config.balance_min_cell_mv ? above : p->config.balance_min_cell_mv;
}

/* How many cells of the module that begins at `first` are to be bled rather than cell i: the higher ones, and
 * of equals those with a lower number. */
static uint32_t before(const bq_sample *s, uint32_t first, uint32_t i)
{
    const bq_cell_reading *me = &s->cells[i];
    uint32_t n = 0;

    for (; first < s->cell_count && s->cells[first].module == me->module; first++) {
        const bq_cell_reading *c = &s->cells[first];
        if (c->mv > me->mv || (c->mv == me->mv && first < i)) {
            n++;
        }
    }
    return n;
}

static void choose(bq_pack *p, const bq_sample *s, bq_action *a)
{
    const uint32_t least = least_mv(p), limit = p->config.balance_max_per_module;
    uint32_t first = 0;

    for (uint32_t i = 0; i < s->cell_count; i++) {
        if (s->cells[i].module != s->cells[first].module) {
            first = i;
        }
        if (s->cells[i].mv >= least && (limit == 0u || before(s, first, i) < limit)) {
            a->balance[i / 32u] |= (uint32_t)1u << (i % 32u);
            p->summary.balancing++;
        }
    }
}

void bq_pack_balance(bq_pack *p, const bq_picture *v, bq_action *a)
{
    const bool rest = resting(p, v);

    p->rest_ms = rest && p->resting ? bq_pack_add_ms(p->rest_ms, v->dt_ms) : 0u;
    p->resting = rest;
    if (p->state != BQ_PACK_STANDBY && p->state != BQ_PACK_ON) {
        p->balancing = false; /* a pause for any other reason keeps it */
    }
    if (!permitted(p, v)) {
        return;
    }
    p->balancing = wanted(p);
    if (!p->balancing) {
        return;
    }
    p->duty = (uint16_t)(p->duty + p->config.balance_duty_percent);
    if (p->duty >= 100u) {
        p->duty = (uint16_t)(p->duty - 100u);
        choose(p, v->s, a);
    }
}
