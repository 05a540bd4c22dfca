/* SPDX-License-Identifier: Apache-2.0 */
/* Self-test of the FAULT and ALERT chains: PL-SEQ-09. */
#include "pl536_internal.h"

#define FORCE BQ76PL536_FAULT_FORCE /* the same bit in both registers */

static bq_line line_of(unsigned reg)
{
    return reg == BQ76PL536_FAULT_STATUS ? BQ_LINE_FAULT : BQ_LINE_ALERT;
}

static void report_break(bq76pl536 *d, unsigned reg, uint8_t device)
{
    if (reg == BQ76PL536_FAULT_STATUS) {
        d->diagnosis.fault_chain_break = device;
    } else {
        d->diagnosis.alert_chain_break = device;
    }
    if (device != 0u) {
        pl_dev(d, device)->faults |= BQ_F_CHAIN;
    }
}

static void report_stuck(bq76pl536 *d, unsigned reg)
{
    if (reg == BQ76PL536_FAULT_STATUS) {
        d->diagnosis.fault_line_stuck = true;
    } else {
        d->diagnosis.alert_line_stuck = true;
    }
    pl_dev(d, 1)->faults |= BQ_F_CHAIN;
}

/*
 * The chain of status register `reg`: FORCE in the top device must reach the host, and only from there. If it
 * does not, the lowest device that is not heard is sought by halving: the break is below it. f->n = device
 * forced, f->val = highest that was heard, f->x = lowest that was not.
 */
bq_status pl_job_chain(bq76pl536 *d, bq76pl536_frame *f)
{
    bool high = false;
    SEQ_BEGIN(f)
    report_break(d, f->reg, 0);
    if (!pl_line(d, line_of(f->reg), &high) ||
        high) { /* no line, or proven up to its present source only (09-01) */
        d->diagnosis.chain_skipped = true;
        return BQ_OK;
    }
    for (f->x = (uint8_t)(d->found + 1u); f->val + 1u < f->x;) {
        f->n = f->x > d->found ? d->found : (uint8_t)((f->val + f->x) / 2u);
        SEQ_TRY(d, f, PL_JOB_WRITE, f->n, f->reg, FORCE);
        f->i = pl_line(d, line_of(f->reg), &high) && high ? 1u : 0u;
        if (f->n == d->found && f->i != 0u) {
            for (f->tries = 1; f->tries < f->n; f->tries++) { /* 09-03 */
                SEQ_TRY(d, f, PL_JOB_READ, f->tries, BQ76PL536_DEVICE_STATUS, 1);
                if ((pl_data(d)[0] &
                     (f->reg == BQ76PL536_FAULT_STATUS ? BQ76PL536_DS_FAULT : BQ76PL536_DS_ALERT)) != 0u) {
                    d->diagnosis.chain_skipped = true; /* it came from below: nothing is proven */
                }
            }
        }
        SEQ_TRY(d, f, PL_JOB_WRITE, f->n, f->reg, 0);
        if (f->i != 0u) {
            f->val = f->n;
        } else {
            f->x = f->n;
        }
    }
    if (f->x > d->found) {
        f->x = 0;
    }
    report_break(d, f->reg, f->x);
    if (pl_line(d, line_of(f->reg), &high) && high) { /* 09-04 */
        report_stuck(d, f->reg);
        return BQ_E_LINE_STUCK;
    }
    return f->x != 0u ? BQ_E_CHAIN_BROKEN : BQ_OK;
    SEQ_END;
}

bq_status pl_job_self_test(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    for (f->n = 1; f->n <= d->config.devices; f->n++) {
        pl_dev(d, f->n)->faults &= (uint16_t)~BQ_F_CHAIN;
    }
    d->diagnosis.chain_skipped = false;
    SEQ_CALL(d, f, PL_JOB_LINES, 0, 0, 0);
    if (d->result != BQ_OK) {
        return d->result;
    }
    SEQ_CALL(d, f, PL_JOB_CHAIN, 0, BQ76PL536_FAULT_STATUS, 0);
    f->x = d->result != BQ_OK;
    f->i = d->result == BQ_E_LINE_STUCK ? 1u : 0u;
    f->tries = d->result != BQ_OK && d->result != BQ_E_LINE_STUCK && d->result != BQ_E_CHAIN_BROKEN ? 1u : 0u;
    if (f->tries != 0u) {
        return d->result; /* the bus, not the chain */
    }
    SEQ_CALL(d, f, PL_JOB_CHAIN, 0, BQ76PL536_ALERT_STATUS, 0);
    if (d->result != BQ_OK) {
        return d->result;
    }
    if (f->x != 0u) {
        return f->i != 0u ? BQ_E_LINE_STUCK : BQ_E_CHAIN_BROKEN;
    }
    return BQ_OK;
    SEQ_END;
}
