/* SPDX-License-Identifier: Apache-2.0 */
/* Active test of the sense wires: PL-SEQ-14-04. One output at a time, the same cell in every device. */
#include "bqhost/bq76pl536_convert.h"
#include "pl536_internal.h"

#define ON_US 40000u /* some tens of milliseconds */

/* How far cell `i` of the burst just read lies below its value with the output off, mV; negative: it rose. */
static int drop(const bq76pl536 *d, const bq76pl536_device *dev, unsigned i)
{
    uint16_t mv = 0;
    (void)bq76pl536_cell_mv(bq76pl536_burst_word(pl_data(d), (uint8_t)(BQ76PL536_BURST_CELL1 + i)), &mv);
    return (int)dev->cell_mv[i] - (int)mv;
}

/* A reading that collapses under its own output hangs on an open wire: the one shared with the neighbour that
 * rose. */
static uint8_t judge(const bq76pl536 *d, unsigned n, unsigned cell)
{
    const bq76pl536_device *dev = &d->devices[n - 1u];
    unsigned i = cell - 1u;
    unsigned cells = pl_cells(d, n);
    int limit = d->config.wire_limit_mv;
    if (drop(d, dev, i) <= limit) {
        return 0;
    }
    if (i > 0u && drop(d, dev, i - 1u) < -limit / 2) {
        return (uint8_t)(1u << i);
    }
    if (i + 1u < cells && drop(d, dev, i + 1u) < -limit / 2) {
        return (uint8_t)(2u << i);
    }
    if (cell == 1u) {
        return 1u;
    }
    return (uint8_t)(cell == cells ? 1u << cells : 3u << i);
}

/* Cell `val` of all devices: on, wait, convert, read, off. A device that cannot be tested is left out. */
bq_status pl_job_wire_cell(bq76pl536 *d, bq76pl536_frame *f)
{
    bq_status st;
    SEQ_BEGIN(f)
    for (f->n = 1; f->n <= d->found; f->n++) {
        if (f->val <= pl_cells(d, f->n) && pl_may_balance(d, f->n)) {
            SEQ_TRY(d, f, PL_JOB_CB_ON, f->n, 0, 1u << (f->val - 1u));
        }
    }
    d->cb_ms = d->now_ms;
    SEQ_WAIT(d, f, ON_US);
    SEQ_TRY(d, f, PL_JOB_CONVERT, 0, 0, 0);
    for (f->n = 1; f->n <= d->found; f->n++) {
        if (pl_dev(d, f->n)->cb_on == 0u) {
            continue;
        }
        for (f->tries = 0;;) {
            SEQ_SEND(f, pl_send_read(d, f->n, BQ76PL536_BURST_FIRST, BQ76PL536_BURST_COUNT));
            st = pl_reply(d);
            st = st != BQ_OK ? st : bq76pl536_burst_check(pl_data(d));
            if (st == BQ_OK) {
                pl_dev(d, f->n)->open_wire |= judge(d, f->n, f->val);
                break;
            }
            if (++f->tries >= PL_TRIES) {
                return st;
            }
        }
    }
    return BQ_OK;
    SEQ_END;
}

bq_status pl_job_wire_test(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    SEQ_TRY(d, f, PL_JOB_SCAN, 0, 0, 0); /* the readings with every output off */
    for (f->val = 1; f->val <= BQ76PL536_MAX_CELLS; f->val++) {
        SEQ_CALL(d, f, PL_JOB_WIRE_CELL, 0, 0, f->val);
        f->x = d->result != BQ_OK ? 1u : 0u;
        SEQ_TRY(d, f, PL_JOB_CB_OFF, 0, 0, 0); /* always, verified */
        if (f->x != 0u) {
            return BQ_E_VERIFY;
        }
        SEQ_WAIT(d, f, d->config.balance_settle_ms * 1000ul);
    }
    for (f->n = 1; f->n <= d->found; f->n++) {
        bq76pl536_device *dev = pl_dev(d, f->n);
        for (f->i = 0; f->i < pl_cells(d, f->n); f->i++) {
            if ((dev->open_wire >> f->i & 3u) != 0u) {
                dev->cell_quality[f->i] = BQ_Q_OPEN_WIRE;
                dev->faults |= BQ_F_OPEN_WIRE;
            }
        }
    }
    return BQ_OK;
    SEQ_END;
}
