/* SPDX-License-Identifier: Apache-2.0 */
/* The functions that begin a job, and those that look. */
#include "pl536_internal.h"

static bq_status begin(bq76pl536 *d, uint8_t job)
{
    if (d == NULL) {
        return BQ_E_ARG;
    }
    if (d->depth != 0u) {
        return BQ_E_BUSY;
    }
    pl_tick(d);
    return pl_begin(d, job, 0);
}

static bq_status begin_in(bq76pl536 *d, uint8_t job, uint8_t state)
{
    if (d == NULL) {
        return BQ_E_ARG;
    }
    if (d->depth != 0u) {
        return BQ_E_BUSY;
    }
    return d->state == state ? begin(d, job) : BQ_E_STATE;
}

bq_status bq76pl536_start(bq76pl536 *d)
{
    return begin(d, PL_JOB_START);
}

bq_status bq76pl536_scan(bq76pl536 *d)
{
    return begin_in(d, PL_JOB_SCAN, PL_STATE_READY);
}

bq_status bq76pl536_self_test(bq76pl536 *d)
{
    return begin_in(d, PL_JOB_SELF_TEST, PL_STATE_READY);
}

bq_status bq76pl536_wire_test(bq76pl536 *d)
{
    return begin_in(d, PL_JOB_WIRE_TEST, PL_STATE_READY);
}

bq_status bq76pl536_sleep(bq76pl536 *d)
{
    return begin_in(d, PL_JOB_SLEEP, PL_STATE_READY);
}

bq_status bq76pl536_wake(bq76pl536 *d)
{
    return begin_in(d, PL_JOB_WAKE, PL_STATE_ASLEEP);
}

bq_status bq76pl536_select_gpai(bq76pl536 *d, bool pins)
{
    bq_status st = begin_in(d, PL_JOB_RECONFIGURE, PL_STATE_READY);
    if (st == BQ_OK) {
        d->gpai_pins = pins;
        for (unsigned n = 1; n <= d->config.devices; n++) {
            pl_dev(d, n)->gpai_quality = 0; /* what is there was measured at the other input */
        }
    }
    return st;
}

/* The six bits of a pack-wide mask that begin at cell `first` (0-based). */
static uint8_t six_bits(const uint32_t *mask, unsigned first)
{
    unsigned word = first / 32u;
    unsigned shift = first % 32u;
    uint32_t bits = mask[word] >> shift;
    if (shift > 26u && word + 1u < BQ_MASK_WORDS) {
        bits |= mask[word + 1u] << (32u - shift);
    }
    return (uint8_t)(bits & BQ76PL536_CB_MASK);
}

bq_status bq76pl536_apply(bq76pl536 *d, const bq_action *action)
{
    if (action == NULL) {
        return BQ_E_ARG;
    }
    bq_status st = begin_in(d, PL_JOB_APPLY, PL_STATE_READY);
    if (st != BQ_OK) {
        return st;
    }
    unsigned first = 0;
    for (unsigned n = 1; n <= d->config.devices; n++) {
        pl_dev(d, n)->cb_want = six_bits(action->balance, first);
        first += pl_cells(d, n);
    }
    d->clear_faults = action->clear_faults;
    return BQ_OK;
}

uint8_t bq76pl536_modules_found(const bq76pl536 *d)
{
    return d->found;
}

const bq_link_stats *bq76pl536_stats(const bq76pl536 *d)
{
    return &d->stats;
}

const bq76pl536_diagnosis *bq76pl536_diagnose(const bq76pl536 *d)
{
    return &d->diagnosis;
}

bq_status bq76pl536_device_flags(const bq76pl536 *d, uint8_t device, bq76pl536_flags *flags)
{
    if (d == NULL || flags == NULL || device < 1u || device > d->config.devices) {
        return BQ_E_ARG;
    }
    const bq76pl536_device *dev = &d->devices[device - 1u];
    flags->device_status = dev->status;
    flags->alert_status = dev->alert;
    flags->fault_status = dev->fault;
    flags->cov_fault = dev->cov;
    flags->cuv_fault = dev->cuv;
    flags->gpai_mv = dev->gpai_mv;
    flags->gpai_quality = dev->gpai_quality;
    flags->balancing = dev->cb_on;
    return BQ_OK;
}

static bq_status afe_start(void *ctx)
{
    return bq76pl536_start(ctx);
}

static bq_status afe_scan(void *ctx)
{
    return bq76pl536_scan(ctx);
}

static bq_status afe_poll(void *ctx, uint32_t *wait_us)
{
    return bq76pl536_poll(ctx, wait_us);
}

static bq_status afe_sample(void *ctx, bq_sample *sample)
{
    return bq76pl536_sample(ctx, sample);
}

static bq_status afe_apply(void *ctx, const bq_action *action)
{
    return bq76pl536_apply(ctx, action);
}

static bq_status afe_self_test(void *ctx)
{
    return bq76pl536_self_test(ctx);
}

static bq_status afe_sleep(void *ctx)
{
    return bq76pl536_sleep(ctx);
}

static bq_status afe_wake(void *ctx)
{
    return bq76pl536_wake(ctx);
}

static uint8_t afe_modules_found(void *ctx)
{
    return bq76pl536_modules_found(ctx);
}

static const bq_link_stats *afe_stats(void *ctx)
{
    return bq76pl536_stats(ctx);
}

bq_afe bq76pl536_afe(bq76pl536 *d)
{
    static const bq_afe_ops ops = {afe_start,     afe_scan,  afe_poll, afe_sample,        afe_apply,
                                   afe_self_test, afe_sleep, afe_wake, afe_modules_found, afe_stats};
    bq_afe afe = {&ops, d};
    return afe;
}
