/* SPDX-License-Identifier: Apache-2.0 */
/* The access primitives PL-SEQ-00-01 .. 00-06, each with bounded retries. */
#include "pl536_internal.h"

static void count_retry(bq76pl536 *d)
{
    if (d->stats.retries != UINT32_MAX) {
        d->stats.retries++;
    }
}

static void count_write_error(bq76pl536 *d)
{
    if (d->stats.write_errors != UINT32_MAX) {
        d->stats.write_errors++;
    }
}

/* PL-SEQ-00-01: dev, reg, val = number of registers. The whole request is sent again after any error. */
bq_status pl_job_read(bq76pl536 *d, bq76pl536_frame *f)
{
    bq_status st;
    SEQ_BEGIN(f)
    for (;;) {
        SEQ_SEND(f, pl_send_read(d, f->dev, f->reg, f->val));
        st = pl_reply(d);
        if (st == BQ_OK || ++f->tries >= PL_TRIES) {
            return st;
        }
        count_retry(d);
    }
    SEQ_END;
}

/* PL-SEQ-00-02: write, read back under the mask of what the register keeps; a CRC flag is cleared before the
 * next try. */
bq_status pl_job_write(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    for (;;) {
        SEQ_SEND(f, pl_send_write(d, f->dev, f->reg, f->val));
        SEQ_TRY(d, f, PL_JOB_READ, f->dev, f->reg, 1);
        f->x = (uint8_t)((pl_data(d)[0] ^ f->val) & bq76pl536_readback_mask(f->reg));
        if (f->x == 0u) {
            return BQ_OK;
        }
        count_write_error(d);
        if (++f->tries >= PL_TRIES) {
            return BQ_E_VERIFY;
        }
        count_retry(d);
        SEQ_TRY(d, f, PL_JOB_READ, f->dev, BQ76PL536_FAULT_STATUS, 1);
        if ((pl_data(d)[0] & BQ76PL536_FAULT_CRC) != 0u) {
            SEQ_SEND(f, pl_send_write(d, f->dev, BQ76PL536_FAULT_STATUS, BQ76PL536_FAULT_CRC));
            SEQ_SEND(f, pl_send_write(d, f->dev, BQ76PL536_FAULT_STATUS, 0));
        }
    }
    SEQ_END;
}

/* PL-SEQ-00-03: a register that cannot be read back; no CRC flag counts as accepted. */
bq_status pl_job_command(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    for (;;) {
        SEQ_SEND(f, pl_send_write(d, f->dev, f->reg, f->val));
        f->x = d->transfer == BQ_OK ? 1u : 0u;
        SEQ_TRY(d, f, PL_JOB_READ, f->dev, BQ76PL536_FAULT_STATUS, 1);
        if (f->x != 0u && (pl_data(d)[0] & BQ76PL536_FAULT_CRC) == 0u) {
            return BQ_OK;
        }
        count_write_error(d);
        if (++f->tries >= PL_TRIES) {
            return BQ_E_VERIFY;
        }
        count_retry(d);
        SEQ_SEND(f, pl_send_write(d, f->dev, BQ76PL536_FAULT_STATUS, BQ76PL536_FAULT_CRC));
        SEQ_SEND(f, pl_send_write(d, f->dev, BQ76PL536_FAULT_STATUS, 0));
    }
    SEQ_END;
}

/* PL-SEQ-00-04: the key, directly after it the register, then read back; by broadcast (dev 0x3f) the caller
 * verifies. */
bq_status pl_job_shadow(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    for (;;) {
        SEQ_SEND(f, pl_send_write(d, f->dev, BQ76PL536_SHDW_CTRL, BQ76PL536_SHDW_KEY));
        if (d->transfer != BQ_OK) { /* without the key the write would be in vain */
            if (++f->tries >= PL_TRIES) {
                return d->transfer;
            }
            continue;
        }
        SEQ_SEND(f, pl_send_write(d, f->dev, f->reg, f->val));
        if (f->dev == BQ76PL536_ADDR_BROADCAST) {
            return BQ_OK;
        }
        SEQ_TRY(d, f, PL_JOB_READ, f->dev, f->reg, 1);
        f->x = (uint8_t)((pl_data(d)[0] ^ f->val) & bq76pl536_readback_mask(f->reg));
        if (f->x == 0u) {
            return BQ_OK;
        }
        count_write_error(d);
        if (++f->tries >= PL_TRIES) {
            break;
        }
        count_retry(d);
        SEQ_TRY(d, f, PL_JOB_READ, f->dev, BQ76PL536_FAULT_STATUS, 1);
        if ((pl_data(d)[0] & BQ76PL536_FAULT_CRC) != 0u) {
            SEQ_SEND(f, pl_send_write(d, f->dev, BQ76PL536_FAULT_STATUS, BQ76PL536_FAULT_CRC));
            SEQ_SEND(f, pl_send_write(d, f->dev, BQ76PL536_FAULT_STATUS, 0));
        }
    }
    if (f->reg < BQ76PL536_USER1) { /* USER bits that do not stick are no reason to reload protection */
        SEQ_SEND(f, pl_send_write(d, f->dev, BQ76PL536_SHDW_CTRL, BQ76PL536_SHDW_REFRESH));
    }
    return BQ_E_VERIFY;
    SEQ_END;
}

/* PL-SEQ-00-06: 1, then 0, then look. Only bits in `val` are touched; FORCE (bit 4) always stays 0. A write
 * that did not arrive is repeated: surely when it was flagged or not sent, once when nothing is known. A flag
 * that is still there then has its cause still there. */
bq_status pl_job_clear(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    f->val &= (uint8_t)~BQ76PL536_FAULT_FORCE;
    for (;;) {
        SEQ_SEND(f, pl_send_write(d, f->dev, f->reg, f->val));
        f->i = d->transfer != BQ_OK ? 1u : 0u;
        SEQ_SEND(f, pl_send_write(d, f->dev, f->reg, 0));
        f->i |= d->transfer != BQ_OK ? 1u : 0u;
        SEQ_TRY(d, f, PL_JOB_READ, f->dev, BQ76PL536_ALERT_STATUS, 2);
        f->x = pl_data(d)[f->reg - BQ76PL536_ALERT_STATUS] & (f->val | BQ76PL536_FAULT_FORCE);
        f->n = pl_data(d)[1] & BQ76PL536_FAULT_CRC;
        if (f->x == 0u && f->n == 0u && f->i == 0u) {
            return BQ_OK;
        }
        if (f->n == 0u && f->i == 0u && f->tries != 0u) {
            return (f->x & f->val) != 0u ? BQ_E_PERSISTS : BQ_E_VERIFY;
        }
        if (++f->tries >= PL_TRIES) {
            return BQ_E_VERIFY;
        }
        count_retry(d);
        if (f->n != 0u) {
            count_write_error(d);
            SEQ_SEND(f, pl_send_write(d, f->dev, BQ76PL536_FAULT_STATUS, BQ76PL536_FAULT_CRC));
            SEQ_SEND(f, pl_send_write(d, f->dev, BQ76PL536_FAULT_STATUS, 0));
        }
    }
    SEQ_END;
}
