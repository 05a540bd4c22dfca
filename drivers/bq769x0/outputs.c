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
    if ((f->reg & ~d->answer) != 0) { /* X0-FET-13: a fault took it back; the next scan serves it */
        *ctrl2 &= d->answer;
        SEQ_TRY(3, x0_fetch(d, BQ769X0_SYS_STAT, 1));
        return (d->answer & BQ769X0_STAT_FAULTS) == 0u ? BQ_E_VERIFY : BQ_OK;
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
    d->top->reg = d->valid && d->temp_valid ? (uint8_t)fets : 0u;
    d->asked = (uint16_t)(action->balance[0] & ((1u << d->cells) - 1u));
    if (d->valid && events == 0u && !d->die_hot) {
        cells = x0_choose(d, d->asked);
    }
    x0_balance(d, cells);
    d->served_ms = d->now_ms;
    return BQ_OK;
}
