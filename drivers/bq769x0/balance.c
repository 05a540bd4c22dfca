/* SPDX-License-Identifier: Apache-2.0 */
/* Which cells are bled, and through which switches (X0-SEQ-39..42). */
#include "x0_internal.h"

#define TURN_BITS 12u /* a set of cells is bled for 4.1 s, then another one */

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
unsigned x0_choose(const bq769x0 *d, unsigned asked)
{
    unsigned most = d->config.balance_max != 0u ? d->config.balance_max : BQ769X0_INPUTS;
    uint32_t turn = d->now_ms >> TURN_BITS;
    unsigned parity = (turn & 1u) != 0u ? 0xaaaau : 0x5555u;
    unsigned chosen = share(asked & parity, most, turn >> 1);
    unsigned blocked = (chosen << 1 & ~(unsigned)d->apart) | (chosen & ~(unsigned)d->apart) >> 1;
    return chosen | share(asked & ~parity & ~blocked, most - x0_bits(chosen), turn >> 1);
}
