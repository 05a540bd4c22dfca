/* SPDX-License-Identifier: Apache-2.0 */
/* Which cells are bled, and what else an action asks for (X0-SEQ-39..42). */
#include "x0_internal.h"

/* At most `most` of `cells`, and in each turn the next ones, so that every cell gets the same share. */
static unsigned share(unsigned cells, unsigned most, uint32_t turn)
{
    unsigned all = x0_bits(cells), chosen = 0, number;
    if (all <= most) {
        return cells;
    }
    number = all - turn * most % all; /* of the lowest cell, counted from the first that is served */
    for (unsigned bit = 1; bit <= cells; bit <<= 1) {
        if ((cells & bit) != 0u && number++ % all < most) {
            chosen |= bit;
        }
    }
    return chosen;
}

/* Of what was asked, the cells that may be bled together: one and the other of two neighbours in turn
 * (X0-SEQ-39), no more than the package may dissipate (X0-SEQ-42). */
static unsigned choose(const bq769x0 *d)
{
    unsigned most = d->config.balance_max != 0u ? d->config.balance_max : BQ769X0_INPUTS;
    uint32_t turn = d->now_ms >> X0_TURN_BITS;
    unsigned first = d->asked & ((turn & 1u) != 0u ? 0xaaaau : 0x5555u);
    unsigned chosen = share(first, most, turn >> 1);
    unsigned rest = d->asked & ~first & ~x0_beside(chosen, d->known.apart);
    return chosen | share(rest, most - x0_bits(chosen), turn >> 1);
}

bq_status bq769x0_begin_apply(bq769x0 *d, const bq_action *action)
{
    bq_status st;
    if (action == NULL) {
        return BQ_E_ARG;
    }
    st = x0_begin_outputs(
        d, action->charge_on * BQ769X0_CTRL2_CHG_ON + action->discharge_on * BQ769X0_CTRL2_DSG_ON, 0);
    if (st == BQ_OK) {
        d->asked = (uint16_t)(action->balance[0] & ((1u << d->known.cells) - 1u));
        d->top->word = d->die_hot ? 0u : choose(d);
        d->served_ms = d->now_ms;
        if (action->unlock) {
            bq769x0_unlock(d);
        }
    }
    return st;
}
