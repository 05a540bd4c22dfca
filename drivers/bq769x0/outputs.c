/* SPDX-License-Identifier: Apache-2.0 */
/* FETs and balancing switches (X0-FET-13, X0-SEQ-05, X0-SEQ-38..42). */
#include "x0_internal.h"

#define TURN_BITS 12u /* a set of cells is bled for 4.1 s, then another one */

/* FETs that may be on while these events stand. Overcurrent also needs CHG off to see the load (X0-LOAD-03).
 */
unsigned x0_allowed(unsigned events)
{
    unsigned fets = 0;
    if ((events & ~BQ769X0_STAT_UV) == 0u) {
        fets |= BQ769X0_CTRL2_CHG_ON;
    }
    if ((events & ~BQ769X0_STAT_OV) == 0u) {
        fets |= BQ769X0_CTRL2_DSG_ON;
    }
    return fets;
}

/* Cells (bit n-1 = cell n) to the inputs that carry them (X0-CB-02), and these to the registers. */
void x0_balance(bq769x0 *d, unsigned cells)
{
    unsigned inputs = 0;
    d->balance = (uint16_t)cells;
    for (unsigned bit = 1; bit <= d->in_use; bit <<= 1) {
        if ((d->in_use & bit) != 0u) {
            inputs |= (cells & 1u) * bit;
            cells >>= 1;
        }
    }
    d->want[BQ769X0_CELLBAL1] = inputs & 0x1fu;
    d->want[BQ769X0_CELLBAL1 + 1u] = inputs >> 5 & 0x1fu;
    d->want[BQ769X0_CELLBAL1 + 2u] = (uint8_t)(inputs >> 10);
}

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
 * (X0-SEQ-39), no more than the package may dissipate (X0-SEQ-42). Neighbours are cells, whatever inputs are
 * shorted between them (X0-CB-06). */
static unsigned choose(const bq769x0 *d, unsigned asked)
{
    unsigned most = d->config.balance_max != 0u ? d->config.balance_max : BQ769X0_INPUTS;
    uint32_t turn = d->now_ms >> TURN_BITS;
    unsigned parity = (turn & 1u) != 0u ? 0xaaaau : 0x5555u;
    unsigned chosen = share(asked & parity, most, turn >> 1);
    unsigned blocked = (chosen << 1 & ~(unsigned)d->apart) | (chosen & ~(unsigned)d->apart) >> 1;
    return chosen | share(asked & ~parity & ~blocked, most - x0_bits(chosen), turn >> 1);
}

/* The switches, then the FETs that f->reg asks for where they are not so yet. */
static int job_apply(bq769x0 *d, bq769x0_frame *f)
{
    uint8_t *ctrl2 = &d->want[BQ769X0_SYS_CTRL2];
    SEQ_BEGIN(f)
    SEQ_TRY(1, x0_set(d, BQ769X0_CELLBAL1, d->groups));
    if ((*ctrl2 & BQ769X0_CTRL2_FETS) == f->reg) {
        return BQ_OK;
    }
    *ctrl2 = (uint8_t)((*ctrl2 & BQ769X0_CTRL2_CC_EN) | f->reg);
    SEQ_TRY(2, x0_set(d, BQ769X0_SYS_CTRL2, 1));
    if ((f->reg & ~d->data[0]) != 0) { /* X0-FET-13: a fault took it back; the next scan serves it */
        *ctrl2 &= d->data[0];
        SEQ_TRY(3, x0_fetch(d, BQ769X0_SYS_STAT, 1));
        return (d->data[0] & BQ769X0_STAT_FAULTS) == 0u ? BQ_E_VERIFY : BQ_OK;
    }
    return BQ_OK;
    SEQ_END;
}

/* X0-SEQ-05: no FET without a valid picture, a known temperature and a clean SYS_STAT. */
bq_status bq769x0_begin_apply(bq769x0 *d, const bq_action *action)
{
    unsigned events = x0_events(d), fets = x0_allowed(events), cells = 0;
    bq_status st = action != NULL ? x0_begin(d, X0_STATE_READY, job_apply) : BQ_E_ARG;
    if (st != BQ_OK) {
        return st;
    }
    if (!action->charge_on) {
        fets &= ~BQ769X0_CTRL2_CHG_ON;
    }
    if (!action->discharge_on) {
        fets &= ~BQ769X0_CTRL2_DSG_ON;
    }
    d->frames[0].reg = d->valid && d->temp_valid ? (uint8_t)fets : 0u;
    d->asked = (uint16_t)(action->balance[0] & ((1u << d->config.cells) - 1u));
    if (d->valid && events == 0u && !d->die_hot) {
        cells = choose(d, d->asked);
    }
    x0_balance(d, cells);
    d->served_ms = d->now_ms;
    return BQ_OK;
}
