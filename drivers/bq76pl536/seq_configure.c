/* SPDX-License-Identifier: Apache-2.0 */
/* Configuration by shadow writes: PL-SEQ-03 and PL-SEQ-04, and the read-back that keeps it true. */
#include "pl536_internal.h"

#define RAISE 1u /* some device has a lower COV than wanted */
#define LOWER 2u /* some device has a higher one */
#define STEPS 11u

/* Thresholds before delays, COV and CUV in the order that keeps them 300 mV apart, OT delay before OT (03-04
 * .. 03-07). IO_CONFIG is not here: the framing changes last of all. */
static uint8_t order(unsigned step, bool cov_first)
{
    static const uint8_t regs[STEPS] = {
        BQ76PL536_FUNCTION_CONFIG, BQ76PL536_CONFIG_COV,  BQ76PL536_CONFIG_CUV,  BQ76PL536_CONFIG_OTT,
        BQ76PL536_CONFIG_OT,       BQ76PL536_CONFIG_COVT, BQ76PL536_CONFIG_CUVT, BQ76PL536_USER1,
        BQ76PL536_USER1 + 1u,      BQ76PL536_USER1 + 2u,  BQ76PL536_USER4};
    if (!cov_first && (step == 1u || step == 2u)) {
        step = 3u - step;
    }
    return regs[step];
}

static bool is_user(uint8_t reg)
{
    return reg >= BQ76PL536_USER1;
}

static uint8_t cov_direction(const bq76pl536 *d, unsigned n, uint8_t present)
{
    uint8_t wanted = pl_image(d, n, BQ76PL536_CONFIG_COV) & BQ76PL536_COV_CODE_MAX;
    uint8_t is = present & 0x3fu;
    if (wanted == is) {
        return 0;
    }
    return wanted > is ? RAISE : LOWER;
}

/* Bits of group 3 in which device n differs, from the 12 bytes just read. */
static uint16_t differences(const bq76pl536 *d, unsigned n, const uint8_t *data)
{
    unsigned diff = 0;
    for (unsigned i = 0; i < BQ76PL536_GROUP3_COUNT; i++) {
        unsigned reg = BQ76PL536_GROUP3_FIRST + i;
        if (reg == BQ76PL536_IO_CONFIG || (is_user((uint8_t)reg) && d->user_readonly)) {
            continue;
        }
        if (data[i] != pl_image(d, n, reg)) {
            diff |= 1u << i;
        }
    }
    return (uint16_t)diff;
}

/* What all devices have in common goes out by broadcast; `val` = RAISE and LOWER of the stack. Verified is
 * only what the next step needs: ADC_ON, CN of unequal devices, the first threshold. */
bq_status pl_job_broadcast(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    for (f->n = 1; f->n <= d->found; f->n++) {
        SEQ_TRY(d, f, PL_JOB_WRITE, f->n, BQ76PL536_ADC_CONTROL, pl_adc_control(d, f->n));
    }
    SEQ_WAIT(d, f, PL_ADC_ON_US);
    SEQ_SEND(f, pl_send_write(d, BQ76PL536_ADDR_BROADCAST, BQ76PL536_IO_CONTROL, pl_io_control(d)));
    if (!pl_uniform(d)) { /* CN must be right before CUV is armed (PL-CUV-08) */
        for (f->n = 1; f->n <= d->found; f->n++) {
            SEQ_TRY(d, f, PL_JOB_SHADOW, f->n, BQ76PL536_FUNCTION_CONFIG,
                    pl_image(d, f->n, BQ76PL536_FUNCTION_CONFIG));
        }
    }
    f->val = (uint8_t)(f->val ^ (RAISE | LOWER));
    for (f->i = !pl_uniform(d); f->i < STEPS && f->val != 0u; f->i++) {
        f->reg = order(f->i, (f->val & LOWER) != 0u); /* inverted above: nobody has to lower COV */
        if (is_user(f->reg) && pl_image(d, 1, f->reg) == 0u) {
            continue;
        }
        SEQ_CALL(d, f, PL_JOB_SHADOW, BQ76PL536_ADDR_BROADCAST, f->reg, pl_image(d, 1, f->reg));
        for (f->n = 1; f->i == 1u && f->n <= d->found;
             f->n++) { /* the first threshold, before the second leans on it */
            SEQ_TRY(d, f, PL_JOB_READ, f->n, f->reg, 1);
            if (pl_data(d)[0] != pl_image(d, f->n, f->reg)) {
                SEQ_TRY(d, f, PL_JOB_SHADOW, f->n, f->reg, pl_image(d, f->n, f->reg));
            }
        }
    }
    return BQ_OK;
    SEQ_END;
}

/*
 * Brings device `dev` to the configured state, whatever it holds, and proves it: reads everything, writes
 * only what differs. Also the scrub and the answer to a reset. `val` = 1: a difference is a finding
 * (BQ_F_CONFIG).
 */
bq_status pl_job_establish(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    for (;;) {
        SEQ_TRY(d, f, PL_JOB_READ, f->dev, BQ76PL536_ADC_CONTROL, 2);
        f->x = pl_data(d)[1] & bq76pl536_readback_mask(BQ76PL536_IO_CONTROL);
        f->n = 0;
        if (pl_data(d)[0] != pl_adc_control(d, f->dev)) {
            f->n = 1;
            SEQ_TRY(d, f, PL_JOB_WRITE, f->dev, BQ76PL536_ADC_CONTROL, pl_adc_control(d, f->dev));
            SEQ_WAIT(d, f, PL_ADC_ON_US);
        }
        if (f->x != pl_io_control(d)) {
            f->n = 1;
            SEQ_TRY(d, f, PL_JOB_WRITE, f->dev, BQ76PL536_IO_CONTROL, pl_io_control(d));
        }
        SEQ_TRY(d, f, PL_JOB_READ, f->dev, BQ76PL536_GROUP3_FIRST, BQ76PL536_GROUP3_COUNT);
        d->diff = differences(d, f->dev, pl_data(d));
        f->x = cov_direction(d, f->dev, pl_data(d)[BQ76PL536_CONFIG_COV - BQ76PL536_GROUP3_FIRST]);
        if (f->val != 0u && (f->n != 0u || d->diff != 0u)) {
            pl_dev(d, f->dev)->faults |= BQ_F_CONFIG;
        }
        for (f->i = 0; f->i < STEPS; f->i++) {
            f->reg = order(f->i, f->x != LOWER);
            if ((d->diff >> (f->reg - BQ76PL536_GROUP3_FIRST) & 1u) == 0u) {
                continue;
            }
            SEQ_CALL(d, f, PL_JOB_SHADOW, f->dev, f->reg, pl_image(d, f->dev, f->reg));
            if (d->result == BQ_E_VERIFY && is_user(f->reg)) {
                d->user_readonly = true; /* PL-AMB-100: report and go on */
                d->diagnosis.user_readonly = true;
            } else if (d->result != BQ_OK) {
                return d->result;
            }
        }
        SEQ_TRY(d, f, PL_JOB_READ, f->dev, BQ76PL536_PRESULT_A, 2);
        if (pl_data(d)[0] == 0u && pl_data(d)[1] == 0u) {
            return BQ_OK;
        }
        if (++f->tries >= 2u) {
            return BQ_E_DEFECTIVE;
        }
        SEQ_CALL(d, f, PL_JOB_COMMAND, f->dev, BQ76PL536_SHDW_CTRL, BQ76PL536_SHDW_REFRESH); /* 15-01 */
    }
    SEQ_END;
}

/* Clears what a reset, a wake-up or a new threshold left behind in device `dev`. What speaks of memory or
 * heat stays for service. */
bq_status pl_job_acknowledge(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    SEQ_TRY(d, f, PL_JOB_READ, f->dev, BQ76PL536_ALERT_STATUS, 2);
    f->x = pl_data(d)[0] & (uint8_t)~(BQ76PL536_ALERT_ECC_ERR | BQ76PL536_ALERT_TSD);
    f->n = pl_data(d)[1] & (uint8_t)~BQ76PL536_FAULT_I_FAULT;
    if (f->n != 0u) {
        SEQ_CALL(d, f, PL_JOB_CLEAR, f->dev, BQ76PL536_FAULT_STATUS, f->n);
        if (d->result != BQ_OK && d->result != BQ_E_PERSISTS) {
            return d->result;
        }
    }
    if (f->x != 0u) {
        SEQ_CALL(d, f, PL_JOB_CLEAR, f->dev, BQ76PL536_ALERT_STATUS, f->x);
        if (d->result != BQ_OK && d->result != BQ_E_PERSISTS) {
            return d->result;
        }
    }
    return BQ_OK;
    SEQ_END;
}

/* Runs device `dev` (0x3f: all) without CRC from now on. A device that did not follow still speaks with CRC
 * (PL-AMB-16). */
bq_status pl_job_framing(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    if (d->crc) {
        SEQ_CALL(d, f, PL_JOB_SHADOW, BQ76PL536_ADDR_BROADCAST, BQ76PL536_IO_CONFIG, BQ76PL536_IOC_CRC_DIS);
        d->crc = false;
    }
    for (f->n = 1; f->n <= d->found; f->n++) {
        for (f->tries = 0; f->tries < PL_TRIES; f->tries++) {
            SEQ_CALL(d, f, PL_JOB_READ, f->n, BQ76PL536_IO_CONFIG, 1);
            if (d->result == BQ_OK && pl_data(d)[0] == BQ76PL536_IOC_CRC_DIS) {
                break;
            }
            d->crc = true;
            SEQ_SEND(f, pl_send_write(d, f->n, BQ76PL536_SHDW_CTRL, BQ76PL536_SHDW_KEY));
            SEQ_SEND(f, pl_send_write(d, f->n, BQ76PL536_IO_CONFIG, BQ76PL536_IOC_CRC_DIS));
            d->crc = false;
        }
        if (f->tries >= PL_TRIES) {
            return BQ_E_VERIFY;
        }
    }
    return BQ_OK;
    SEQ_END;
}

/* FAULT and ALERT must be low when no device has a reason to hold them high (03-11). Looks at every device
 * and notes its flags. */
bq_status pl_job_lines(bq76pl536 *d, bq76pl536_frame *f)
{
    bool high;
    SEQ_BEGIN(f)
    for (f->n = 1; f->n <= d->found; f->n++) {
        SEQ_TRY(d, f, PL_JOB_READ, f->n, BQ76PL536_ALERT_STATUS, 2);
        pl_dev(d, f->n)->alert = pl_data(d)[0];
        pl_dev(d, f->n)->fault = pl_data(d)[1];
        SEQ_TRY(d, f, PL_JOB_READ, f->n, BQ76PL536_DEVICE_STATUS,
                1); /* ALERT may stand for ECC_COR alone (PL-AMB-48) */
        f->x |= (pl_data(d)[0] & BQ76PL536_DS_ALERT) != 0u ? 1u : 0u;
        f->x |= (pl_data(d)[0] & BQ76PL536_DS_FAULT) != 0u ? 2u : 0u;
    }
    d->diagnosis.fault_line_stuck = false;
    d->diagnosis.alert_line_stuck = false;
    d->diagnosis.line_above = 0;
    if (d->found < d->config.devices) {
        return BQ_OK; /* those above the break hold the lines high */
    }
    if ((f->x & 2u) == 0u && pl_line(d, BQ_LINE_FAULT, &high) && high) {
        d->diagnosis.fault_line_stuck = true;
    }
    if ((f->x & 1u) == 0u && pl_line(d, BQ_LINE_ALERT, &high) && high) {
        d->diagnosis.alert_line_stuck = true;
    }
    if (d->diagnosis.fault_line_stuck || d->diagnosis.alert_line_stuck) {
        d->diagnosis.line_above = 1;
        pl_dev(d, 1)->faults |= BQ_F_CHAIN;
        return BQ_E_LINE_STUCK;
    }
    return BQ_OK;
    SEQ_END;
}

/* PL-SEQ-03 for devices 1..found. */
bq_status pl_job_configure(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    for (f->n = 1; f->n <= d->found; f->n++) { /* 03-02 */
        SEQ_TRY(d, f, PL_JOB_READ, f->n, BQ76PL536_DEVICE_STATUS, 1);
        if ((pl_data(d)[0] & BQ76PL536_DS_ECC_COR) != 0u) {
            d->diagnosis.ecc_corrected = f->n;
        }
        SEQ_TRY(d, f, PL_JOB_READ, f->n, BQ76PL536_GROUP3_FIRST, BQ76PL536_GROUP3_COUNT);
        f->x |= cov_direction(d, f->n, pl_data(d)[BQ76PL536_CONFIG_COV - BQ76PL536_GROUP3_FIRST]);
    }
    SEQ_TRY(d, f, PL_JOB_BROADCAST, 0, 0, f->x);
    for (f->n = 1; f->n <= d->found; f->n++) { /* 03-09 */
        SEQ_TRY(d, f, PL_JOB_ESTABLISH, f->n, 0, 0);
    }
    if (d->config.crc_off) {
        SEQ_TRY(d, f, PL_JOB_FRAMING, 0, 0, 0);
    }
    SEQ_WAIT(d, f, pl_settle_us(d));
    for (f->n = 1; f->n <= d->found; f->n++) { /* 03-10 */
        SEQ_TRY(d, f, PL_JOB_ACKNOWLEDGE, f->n, 0, 0);
    }
    SEQ_WAIT(d, f, pl_longest_delay_us(d));
    SEQ_CALL(d, f, PL_JOB_LINES, 0, 0, 0);
    return d->result == BQ_E_LINE_STUCK ? BQ_OK : d->result; /* reported; the bus works */
    SEQ_END;
}

/* Every device again, by unicast: after the meaning of the configuration changed. */
bq_status pl_job_reconfigure(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    for (f->n = 1; f->n <= d->found; f->n++) {
        SEQ_TRY(d, f, PL_JOB_ESTABLISH, f->n, 0, 0);
    }
    return BQ_OK;
    SEQ_END;
}
