/* SPDX-License-Identifier: Apache-2.0 */
/* Which cells to bleed. Deterministic: equal pictures and histories give equal masks. */
#include "pack_internal.h"

static bool charging(const bq_pack *p, const bq_picture *v)
{
    return v->current_known && v->s->current_ma > p->config.balance_rest_ma;
}

/* Rest is a small measured current, or open outputs where nobody has ever measured one. */
static bool resting(const bq_pack *p, const bq_picture *v, const bq_pack_input *in)
{
    if (v->current_known) {
        return v->s->current_ma <= p->config.balance_rest_ma &&
               v->s->current_ma >= -p->config.balance_rest_ma;
    }
    return v->s != NULL && !v->s->current_valid && !p->outputs_on && in->contactor_mismatch_ms == 0u;
}

/* Everything but the spread: PL-SEQ-10-01 asks for fresh valid voltages, no fault, no lockout, no sleep. */
static bool permitted(const bq_pack *p, const bq_picture *v, const bq_pack_input *in)
{
    const bq_pack_config *k = &p->config;

    return !in->balance_off && (p->state == BQ_PACK_STANDBY || p->state == BQ_PACK_ON) &&
           in->monitor == BQ_MONITOR_UP && p->summary.complete && !bq_pack_pending(p) &&
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

static bool eligible(const bq_pack *p, const bq_cell_reading *c)
{
    return c->mv > (uint32_t)p->summary.cell_min_mv + p->config.balance_stop_mv &&
           c->mv >= p->config.balance_min_cell_mv;
}

/* The highest eligible cell of first..end - 1 not chosen yet, the lower number of equals; end = none. */
static uint16_t highest(const bq_pack *p, const bq_sample *s, uint16_t first, uint16_t end,
                        const bq_action *a)
{
    uint16_t best = end;

    for (uint16_t i = first; i < end; i++) {
        if (eligible(p, &s->cells[i]) && !bq_mask_get(a->balance, (uint16_t)(i + 1u)) &&
            (best == end || s->cells[i].mv > s->cells[best].mv)) {
            best = i;
        }
    }
    return best;
}

/* Cells first..end - 1 form one module. */
static uint16_t choose_in_module(const bq_pack *p, const bq_sample *s, uint16_t first, uint16_t end,
                                 bq_action *a)
{
    const uint16_t limit = p->config.balance_max_per_module;
    uint16_t chosen = 0;

    if (limit == 0u || limit >= end - first) {
        for (uint16_t i = first; i < end; i++) {
            if (eligible(p, &s->cells[i])) {
                bq_mask_set(a->balance, (uint16_t)(i + 1u));
                chosen++;
            }
        }
        return chosen;
    }
    while (chosen < limit) {
        const uint16_t i = highest(p, s, first, end, a);
        if (i == end) {
            break;
        }
        bq_mask_set(a->balance, (uint16_t)(i + 1u));
        chosen++;
    }
    return chosen;
}

static void choose(bq_pack *p, const bq_sample *s, bq_action *a)
{
    uint16_t first = 0;

    for (uint16_t i = 1; i <= s->cell_count; i++) {
        if (i == s->cell_count || s->cells[i].module != s->cells[first].module) {
            p->summary.balancing = (uint16_t)(p->summary.balancing + choose_in_module(p, s, first, i, a));
            first = i;
        }
    }
}

void bq_pack_balance(bq_pack *p, const bq_picture *v, const bq_pack_input *in, uint32_t dt_ms, bq_action *a)
{
    const bool rest = resting(p, v, in);

    p->rest_ms = rest && p->resting ? bq_pack_add_ms(p->rest_ms, dt_ms) : 0u;
    p->resting = rest;
    if (p->state != BQ_PACK_STANDBY && p->state != BQ_PACK_ON) {
        p->balancing = false; /* a pause for any other reason keeps it */
    }
    if (!permitted(p, v, in)) {
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
