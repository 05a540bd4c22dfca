/* SPDX-License-Identifier: Apache-2.0 */
/* The measuring half: conversion control and results (PL-ADC, PL-CONV, PL-DRDY, PL-VCELL, PL-GPAI, PL-VBAT,
 * PL-TS). All channels are sampled and stored together at the end of the cycle (PL-AMB-71). */
#include "sim_pl536_internal.h"

#define WAKE_TIME (500 * SIM_PL_US)
#define FULL_SCALE 16383

static const uint64_t channel_ns[4] = {3 * SIM_PL_US, 6 * SIM_PL_US, 12 * SIM_PL_US, 24 * SIM_PL_US};

static unsigned cells_selected(unsigned select)
{
    return (select & 7u) > 5u ? 1u : (select & 7u) + 1u;
}

static unsigned channels(unsigned select)
{
    return cells_selected(select) + ((select >> 3) & 1u) + ((select >> 4) & 1u) + ((select >> 5) & 1u);
}

static uint64_t channel_time(const sim_pl *s, unsigned adct)
{
    return channel_ns[adct == 0 && s->options.amb62_six_us ? 1 : adct];
}

static unsigned speed(const sim_pl *s, const sim_pl_dev *d)
{
    return s->options.variant_a ? 1u : d->reg[REG_FUNCTION] >> 6;
}

void sim_pl_adc_wake(sim_pl *s, sim_pl_dev *d)
{
    if ((d->reg[REG_ADC_CONTROL] & ADC_ON) != 0) {
        d->adc_ready = s->now + WAKE_TIME;
    }
}

void sim_pl_adc_abort(sim_pl_dev *d)
{
    if (d->conv_end != SIM_PL_NEVER) {
        d->conv_end = SIM_PL_NEVER;
        d->drdy = true;
    }
}

static void judge_start(sim_pl *s, const sim_pl_dev *d, bool by_pin)
{
    if (d->conv_end != SIM_PL_NEVER) {
        sim_pl_judge_state(s, d, by_pin ? "PL-CONV-05" : "PL-AMB-67",
                           "conversion started while one is running");
    } else if ((d->reg[REG_ADC_CONTROL] & ADC_ON) != 0 && s->now < d->adc_ready) {
        sim_pl_judge_state(s, d, "PL-ADC-18", "conversion started within 500 us of ADC_ON");
    }
}

/* The lock-up of PL-ADC-12: nothing but a reset ends it. */
static bool locks_up(sim_pl *s, sim_pl_dev *d)
{
    if (s->options.variant_a || speed(s, d) == 0 || (d->reg[REG_ADC_CONTROL] & ADC_ON) != 0) {
        return false;
    }
    sim_pl_judge_state(s, d, "PL-ADC-12", "conversion started with ADCT not 00b and ADC_ON = 0");
    d->locked = true;
    d->drdy = false;
    d->conv_end = SIM_PL_NEVER;
    return true;
}

void sim_pl_adc_start(sim_pl *s, sim_pl_dev *d, bool by_pin)
{
    uint64_t from = s->now;
    uint64_t wake = 0;

    if (d->uvlo || d->tsd || d->asleep || d->locked) {
        if (d->slept_by_host && !d->tsd) {
            sim_pl_judge_state(s, d, "PL-AMB-70", "conversion started in SLEEP");
        }
        return;
    }
    judge_start(s, d, by_pin);
    if (locks_up(s, d)) {
        return;
    }
    if ((d->reg[REG_ADC_CONTROL] & ADC_ON) == 0) {
        wake = sim_pl_scaled(s, WAKE_TIME);
    } else if (d->adc_ready > from) {
        from = d->adc_ready; /* held until the reference has settled (PL-AMB-64) */
    }
    d->conv_select = d->reg[REG_ADC_CONTROL];
    d->conv_adct = (uint8_t)speed(s, d);
    d->conv_end =
        from + wake + sim_pl_scaled(s, (channels(d->conv_select) + 1u) * channel_time(s, d->conv_adct));
    d->drdy = false;
}

/* ---- results ------------------------------------------------------------------------------------------ */

/* Nearly Gaussian, standard deviation 1: the sum of four uniform values. */
static double noise(sim_pl *s)
{
    uint64_t r = sim_pl_random(&s->rng);
    double sum = (double)(r & 0xffff) + (double)((r >> 16) & 0xffff) + (double)((r >> 32) & 0xffff) +
                 (double)(r >> 48);

    return (sum / 65536.0 - 2.0) * 1.7320508075688772;
}

static double noisy(sim_pl *s, double volts, double factor)
{
    return s->options.noise_uv_rms > 0.0 ? volts + noise(s) * factor * s->options.noise_uv_rms * 1e-6 : volts;
}

/* Nearest code, exact halves upward, limited to 14 bits (PL-NUM-02). */
static void store(sim_pl_dev *d, unsigned reg, double code, int correction)
{
    int n;

    if (!(code > 0.0)) {
        code = 0.0;
    }
    if (code > 2.0 * FULL_SCALE) {
        code = 2.0 * FULL_SCALE;
    }
    n = (int)(code + 0.5) + correction;
    n = n < 0 ? 0 : n > FULL_SCALE ? FULL_SCALE : n;
    d->reg[reg] = (uint8_t)(n >> 8);
    d->reg[reg + 1] = (uint8_t)(n & 0xff);
}

static void store_gpai(sim_pl *s, sim_pl_dev *d)
{
    double reference = 2.5;

    if ((d->reg[REG_FUNCTION] & FN_GPAI_SRC) != 0) {
        store(d, REG_GPAI, noisy(s, sim_pl_brick(d), 6.0) * 16384.0 / 33.333, 0);
        return;
    }
    if ((d->reg[REG_FUNCTION] & FN_GPAI_REF) != 0 && s->options.reg50_v > 0.0) {
        reference = s->options.reg50_v / 2.0;
    }
    store(d, REG_GPAI, noisy(s, d->gpai, 0.6) * 16383.0 / reference, 0);
}

/* A sensor whose switch is open, or without REG50, gives no difference (PL-AMB-76, PL-TS-11). */
static void store_ts(sim_pl *s, sim_pl_dev *d, int n)
{
    static const double scale[2] = {33046.0, 33068.0};
    static const int correction[2] = {-2, -9};
    bool fed = (d->reg[REG_IO_CONTROL] & (1u << n)) != 0 && sim_pl_reg50_on(d);
    double ratio = fed ? d->ts[n] + (noisy(s, 0.0, 0.6) / 5.0) : 0.0;

    store(d, n == 0 ? REG_TEMP1 : REG_TEMP2, ratio * scale[n], correction[n]);
}

void sim_pl_adc_finish(sim_pl *s, sim_pl_dev *d)
{
    unsigned cells = cells_selected(d->conv_select);

    for (unsigned i = 0; i < cells; i++) {
        store(d, REG_VCELL1 + 2 * i, (noisy(s, d->seen[i], 1.0) + d->offset_v[i]) * 16383.0 / 6.25, 0);
    }
    if ((d->conv_select & 0x08) != 0) {
        store_gpai(s, d);
    }
    if ((d->conv_select & 0x10) != 0) {
        store_ts(s, d, 0);
    }
    if ((d->conv_select & 0x20) != 0) {
        store_ts(s, d, 1);
    }
    d->conv_end = SIM_PL_NEVER;
    d->drdy = true;
    d->conversions++;
    sim_pl_sleep_request(s, d);
}
