/* SPDX-License-Identifier: Apache-2.0 */
/* FETs and balancing switches as the caller wants them (X0-FET-13, X0-SEQ-05, X0-SEQ-38). */
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

/* The switches, then the FETs that f->reg asks for where they are not so yet. None comes on without its
 * limits, which a part that was reset has lost (X0-SEQ-05); one that a fault took back (X0-FET-13) is no
 * longer wanted: the next scan serves the fault. f->n: how it ends, negated. */
static int job_apply(bq769x0 *d, bq769x0_frame *f)
{
    uint8_t *ctrl2 = &d->want[BQ769X0_SYS_CTRL2];
    SEQ_BEGIN(f)
    SEQ_TRY(1, x0_set_switches(d));
    if ((f->reg & ~*ctrl2) != 0) {
        SEQ_TRY(2, x0_fetch(d, BQ769X0_SYS_CTRL1, 8));
        if (!x0_holds(d, BQ769X0_SYS_CTRL1, 8)) {
            f->reg &= *ctrl2;
            f->n = (uint8_t)-BQ_E_VERIFY;
        }
    }
    if ((*ctrl2 & BQ769X0_CTRL2_FETS) != f->reg) {
        *ctrl2 = (uint8_t)((*ctrl2 & BQ769X0_CTRL2_CC_EN) | f->reg);
        SEQ_TRY(3, x0_set_ctrl2(d));
        if ((f->reg & ~d->answer) != 0) {
            *ctrl2 &= d->answer;
            f->n = (uint8_t)-BQ_E_VERIFY;
        }
    }
    return -(int)f->n;
    SEQ_END;
}

/* X0-SEQ-05: no FET without a valid picture, a known temperature and a clean SYS_STAT. */
bq_status bq769x0_begin_apply(bq769x0 *d, const bq_action *action)
{
    unsigned events = x0_events(d), fets, granted, cells = 0;
    bq_status st = action != NULL ? x0_begin(d, X0_STATE_READY, job_apply) : BQ_E_ARG;
    if (st != BQ_OK) {
        return st;
    }
    fets = action->charge_on * BQ769X0_CTRL2_CHG_ON + action->discharge_on * BQ769X0_CTRL2_DSG_ON;
    granted = d->valid && d->temp_valid ? fets & x0_allowed(events) : 0u;
    d->top->reg = (uint8_t)granted;
    d->top->n = granted != fets ? (uint8_t)-BQ_E_STATE : 0u;
    d->asked = (uint16_t)(action->balance[0] & ((1u << d->cells) - 1u));
    if (d->valid && events == 0u && !d->die_hot) {
        cells = x0_choose(d, d->asked);
    }
    x0_balance(d, cells);
    d->served_ms = d->now_ms;
    return BQ_OK;
}
