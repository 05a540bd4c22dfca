/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Taking over a stack that an earlier life of the host left running, without resetting it
 * (config.warm_start).
 *
 * Everything is read once and has to be as bring-up leaves it; nothing is repaired here except a flag that
 * says that a packet was damaged, which is what a host that dies in the middle of one leaves behind. Any
 * doubt ends the attempt, and the bring-up that follows resets every device.
 *
 * That registers are right does not say how old they are: bring-up may have been cut off before sensors and
 * comparators had settled, or before it was known that nobody stands above the top device. So a bring-up that
 * came to its end leaves a mark, the balancing period in CB_TIME of every device, which no reset leaves there
 * (0) and which no output needs while all are off.
 */
#include "pl536_internal.h"

static bq_status refuse(bq76pl536 *d, unsigned n, bq76pl536_warm why)
{
    d->diagnosis.warm = why;
    d->diagnosis.warm_device = (uint8_t)n;
    return BQ_E_STATE;
}

static bool image_kept(const bq76pl536 *d, unsigned n, const uint8_t *data)
{
    for (unsigned i = 0; i < BQ76PL536_GROUP3_COUNT; i++) {
        if (data[i] != pl_image(d, n, BQ76PL536_GROUP3_FIRST + i)) {
            return false;
        }
    }
    return true;
}

/* What is read of every device. */
enum { LOOK_ADDRESS, LOOK_IMAGE, LOOK_CONTROLS, LOOK_FLAGS, LOOK_STATUS, LOOKS };

static const uint8_t looks[LOOKS][2] = {{BQ76PL536_ADDRESS_CONTROL, 1},
                                        {BQ76PL536_GROUP3_FIRST, BQ76PL536_GROUP3_COUNT},
                                        {BQ76PL536_ADC_CONTROL, 4},
                                        {BQ76PL536_ALERT_STATUS, 6},
                                        {BQ76PL536_DEVICE_STATUS, 1}};

/* ADC_CONTROL, IO_CONTROL, CB_CTRL, CB_TIME of device n. */
static bq76pl536_warm judge_controls(const bq76pl536 *d, unsigned n, const uint8_t *data)
{
    if (data[2] != 0u) {
        return BQ76PL536_WARM_BALANCING;
    }
    if (data[0] != pl_adc_control(d, n) ||
        (data[1] & bq76pl536_readback_mask(BQ76PL536_IO_CONTROL)) != pl_io_control(d)) {
        return BQ76PL536_WARM_SETTINGS;
    }
    return data[3] == d->config.balance_timer_s ? BQ76PL536_WARM_ADOPTED : BQ76PL536_WARM_UNFINISHED;
}

/* ALERT, FAULT, COV, CUV, PRESULT_A, PRESULT_B: nothing, but for the flag of a damaged packet. */
static bool flags_clear(const uint8_t *data)
{
    return (data[0] | (data[1] & (uint8_t)~BQ76PL536_FAULT_CRC) | data[2] | data[3] | data[4] | data[5]) ==
           0u;
}

/* What was read of device n by the packet that ended last. */
static bq76pl536_warm judge(const bq76pl536 *d, unsigned n, unsigned look)
{
    const uint8_t *data = pl_data(d);

    if (pl_answer(d) != BQ_OK) {
        return BQ76PL536_WARM_UNHEARD;
    }
    switch (look) {
    case LOOK_ADDRESS:
        return data[0] == (BQ76PL536_ADDRESS_AR | n) ? BQ76PL536_WARM_ADOPTED : BQ76PL536_WARM_UNHEARD;
    case LOOK_IMAGE:
        return image_kept(d, n, data) ? BQ76PL536_WARM_ADOPTED : BQ76PL536_WARM_SETTINGS;
    case LOOK_CONTROLS:
        return judge_controls(d, n, data);
    case LOOK_FLAGS:
        return flags_clear(data) ? BQ76PL536_WARM_ADOPTED : BQ76PL536_WARM_FLAGS;
    default:
        return data[0] == (BQ76PL536_DS_AR | BQ76PL536_DS_DRDY) ? BQ76PL536_WARM_ADOPTED
                                                                : BQ76PL536_WARM_FLAGS;
    }
}

/* Device `dev` is where it belongs and as bring-up left it. */
bq_status pl_job_warm_device(bq76pl536 *d, bq76pl536_frame *f)
{
    bq76pl536_warm verdict;
    SEQ_BEGIN(f)
    for (f->i = 0; f->i < LOOKS; f->i++) {
        SEQ_SEND(f, pl_send_read(d, f->dev, looks[f->i][0], looks[f->i][1]));
        verdict = judge(d, f->dev, f->i);
        if (verdict != BQ76PL536_WARM_ADOPTED) {
            return refuse(d, f->dev, verdict);
        }
        if (f->i == LOOK_FLAGS && pl_data(d)[1] != 0u) {
            SEQ_CALL(d, f, PL_JOB_CLEAR, f->dev, BQ76PL536_FAULT_STATUS, BQ76PL536_FAULT_CRC);
            if (d->result != BQ_OK) {
                return refuse(d, f->dev, BQ76PL536_WARM_FLAGS);
            }
        }
    }
    return BQ_OK;
    SEQ_END;
}

/* The whole stack: outputs off at once, every device in its place, and then, so that a device lost meanwhile
 * is noticed, nobody at address 0 and nobody above the top. */
bq_status pl_job_warm(bq76pl536 *d, bq76pl536_frame *f)
{
    SEQ_BEGIN(f)
    d->crc = true;
    SEQ_SEND(f, pl_send_write(d, BQ76PL536_ADDR_BROADCAST, BQ76PL536_CB_CTRL, 0));
    d->cb_ms = d->now_ms;
    for (f->n = 1; f->n <= d->config.devices; f->n++) {
        SEQ_TRY(d, f, PL_JOB_WARM_DEVICE, f->n, 0, 0);
    }
    for (f->tries = 0; f->tries < 4u; f->tries++) { /* twice each: one lost answer hides nobody */
        f->n = f->tries >= 2u && d->config.devices < BQ76PL536_ADDR_LAST ? d->config.devices + 1u
                                                                         : BQ76PL536_ADDR_NONE;
        SEQ_SEND(f, pl_send_read(d, f->n, BQ76PL536_DEVICE_STATUS, 1));
        if (pl_answer(d) != BQ_E_NO_ANSWER) {
            return refuse(d, f->n, BQ76PL536_WARM_STRANGER);
        }
    }
    if (d->now_ms - d->cb_ms <= d->config.balance_settle_ms) { /* they may have been on until now */
        SEQ_WAIT(d, f, d->config.balance_settle_ms * 1000ul);
    }
    d->found = d->config.devices; /* what discovery would have learned */
    d->height = d->config.devices;
    d->attempt = 1;
    d->diagnosis.warm = BQ76PL536_WARM_ADOPTED;
    SEQ_CALL(d, f, PL_JOB_SELF_TEST, 0, 0, 0);
    return d->result == BQ_OK ? BQ_OK : refuse(d, 0, BQ76PL536_WARM_SELF_TEST);
    SEQ_END;
}
