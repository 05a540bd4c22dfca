/* SPDX-License-Identifier: Apache-2.0 */
/* FETs and balancing switches as the caller wants them (X0-FET-13, X0-SEQ-05, X0-SEQ-38..41). */
#include "x0_internal.h"

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
    for (unsigned bit = 1; bit <= d->known.in_use; bit <<= 1) {
        if ((d->known.in_use & bit) != 0u) {
            if ((cells & 1u) != 0u) {
                inputs |= bit;
            }
            cells >>= 1;
        }
    }
    d->known.registers[BQ769X0_CELLBAL1] = inputs & 0x1fu;
    d->known.registers[BQ769X0_CELLBAL1 + 1u] = inputs >> 5 & 0x1fu;
    d->known.registers[BQ769X0_CELLBAL1 + 2u] = (uint8_t)(inputs >> 10);
}

/* The switches, then the FETs where they are not so yet. No FET without a valid picture, a known temperature
 * and a clean SYS_STAT (X0-SEQ-05), nor without its limits, which a part that was reset has lost; one that a
 * fault took back (X0-FET-13) is no longer wanted: the next scan serves the fault. f->i: those that are to be
 * on; f->x, f->tries: asked for, granted. */
static int job_apply(bq769x0 *d, bq769x0_frame *f)
{
    unsigned events = x0_events(d), fets;
    uint8_t *ctrl2 = &d->known.registers[BQ769X0_SYS_CTRL2];
    SEQ_BEGIN(f)
    /* what is not valid forbids as much as DEVICE_XREADY */
    events |= (~(unsigned)(d->quality & d->temp_quality) & BQ_Q_VALID) * BQ769X0_STAT_XREADY;
    f->tries = f->i = (uint8_t)(f->x & x0_allowed(events));
    x0_balance(d, events == 0u ? f->word : 0u);
    SEQ_TRY(1, X0_SET_SWITCHES(d));
    if ((f->i & ~*ctrl2) != 0) {
        SEQ_TRY(2, X0_FETCH(BQ769X0_SYS_CTRL1, 8));
        if (!x0_holds(d, BQ769X0_SYS_CTRL1, 8)) {
            f->i &= *ctrl2;
        }
    }
    fets = (*ctrl2 & ~BQ769X0_CTRL2_FETS) | f->i;
    if (*ctrl2 != fets) {
        *ctrl2 = (uint8_t)fets;
        SEQ_TRY(3, X0_SET_CTRL2);
        *ctrl2 &= (uint8_t)(d->answer | ~BQ769X0_CTRL2_FETS);
    }
    if ((f->tries & ~*ctrl2) != 0) {
        return BQ_E_VERIFY;
    }
    return f->x != f->tries ? BQ_E_STATE : BQ_OK;
    SEQ_END;
}

/* `cells` are no neighbours. */
bq_status x0_begin_outputs(bq769x0 *d, unsigned fets, unsigned cells)
{
    bq_status st = x0_begin(d, X0_STATE_READY, job_apply);
    if (st == BQ_OK) {
        d->top->x = (uint8_t)fets;
        d->top->word = cells;
    }
    return st;
}
