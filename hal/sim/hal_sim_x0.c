/* SPDX-License-Identifier: Apache-2.0 */
#include "hal_sim_x0.h"
#include <string.h>

#define BIT_NS 10000u /* 100 kHz */

static void default_advance(void *ctx, uint64_t ns)
{
    sim_x0_advance(ctx, ns);
}

void hal_sim_x0_advance(hal_sim_x0 *h, uint64_t ns)
{
    h->advance(h->advance_ctx, ns);
}

/* ---- I2C ---- */

static bq_status carry_out(hal_sim_x0 *h, uint8_t address7, const bq_i2c_segment *seg, uint64_t *bits)
{
    sim_x0_i2c_start(h->chip);
    *bits += 10u;
    h->bytes++;
    if (!sim_x0_i2c_write(h->chip, (uint8_t)(address7 * 2u + (seg->read ? 1u : 0u)))) {
        return BQ_E_NACK;
    }
    for (unsigned i = 0; i < seg->len; i++) {
        *bits += 9u;
        h->bytes++;
        if (seg->read) {
            seg->data[i] = sim_x0_i2c_read(h->chip, i + 1u < seg->len);
        } else if (!sim_x0_i2c_write(h->chip, seg->data[i])) {
            return BQ_E_NACK;
        }
    }
    return BQ_OK;
}

static bool legal(const bq_i2c_segment *segments, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if ((segments[i].len > 0u && segments[i].data == NULL) ||
            (segments[i].read && segments[i].len == 0u)) {
            return false;
        }
    }
    return segments != NULL && count > 0u;
}

static bool fails_now(hal_sim_x0 *h)
{
    return h->fail_at != 0u && --h->fail_at == 0u;
}

static bq_status i2c_start(void *ctx, uint8_t address7, const bq_i2c_segment *segments, size_t count)
{
    hal_sim_x0 *h = ctx;
    uint64_t bits = 0;
    if (segments == NULL || !legal(segments, count)) {
        return BQ_E_ARG;
    }
    if (h->busy) {
        h->overlaps++;
        return BQ_E_BUSY;
    }
    h->transactions++;
    if (!sim_x0_sda_free(h->chip)) {
        return BQ_E_ARBITRATION;
    }
    h->outcome = fails_now(h) ? BQ_E_BUS : BQ_OK;
    for (size_t i = 0; i < count && h->outcome == BQ_OK; i++) {
        h->outcome = carry_out(h, address7, &segments[i], &bits);
        if (h->outcome == BQ_OK && segments[i].stop_after) {
            sim_x0_i2c_stop(h->chip);
        }
    }
    sim_x0_i2c_stop(h->chip);
    hal_sim_x0_advance(h, (bits + 2u) * BIT_NS + (uint64_t)sim_x0_bus(h->chip)->stretch_us * 1000u);
    if (sim_x0_bus(h->chip)->stretch_us > 10000u) {
        h->outcome = BQ_E_TIMEOUT; /* the contract tolerates 10 ms */
    }
    h->busy = true;
    h->left = h->pending;
    return BQ_OK;
}

static bq_status i2c_poll(void *ctx)
{
    hal_sim_x0 *h = ctx;
    if (!h->busy) {
        return BQ_OK;
    }
    if (h->left > 0u) {
        h->left--;
        return BQ_PENDING;
    }
    h->busy = false;
    return h->outcome;
}

static bq_status i2c_recover(void *ctx)
{
    hal_sim_x0 *h = ctx;
    h->recoveries++;
    for (int clock = 0; clock < 9 && !sim_x0_sda_free(h->chip); clock++) {
        sim_x0_recovery_clock(h->chip);
        hal_sim_x0_advance(h, BIT_NS);
    }
    if (!sim_x0_sda_free(h->chip)) {
        return BQ_E_ARBITRATION;
    }
    sim_x0_i2c_start(h->chip);
    sim_x0_i2c_stop(h->chip);
    return BQ_OK;
}

/* ---- lines ---- */

static bool is_missing(const hal_sim_x0 *h, bq_line line)
{
    return (h->missing >> (unsigned)line & 1u) != 0u;
}

static bq_status line_read(void *ctx, bq_line line, bool *level)
{
    const hal_sim_x0 *h = ctx;
    if ((unsigned)line >= (unsigned)BQ_LINE_COUNT || level == NULL) {
        return BQ_E_ARG;
    }
    if (is_missing(h, line) || line == BQ_LINE_DRDY || line == BQ_LINE_FAULT ||
        line == BQ_LINE_CONTACTOR_FB) {
        return BQ_E_UNSUPPORTED;
    }
    *level = line == BQ_LINE_ALERT ? sim_x0_alert(h->chip) : h->level[line];
    return BQ_OK;
}

/* The pulse counts when it ends: its length decides whether the part boots. */
static void boot_signal(hal_sim_x0 *h, bool level)
{
    if (level && !h->level[BQ_LINE_AFE_BOOT]) {
        h->boot_from = h->chip->now;
    } else if (!level && h->level[BQ_LINE_AFE_BOOT]) {
        (void)sim_x0_boot_ended(h->chip, h->boot_from);
    }
}

static bq_status line_write(void *ctx, bq_line line, bool level)
{
    hal_sim_x0 *h = ctx;
    if ((unsigned)line >= (unsigned)BQ_LINE_COUNT) {
        return BQ_E_ARG;
    }
    if (is_missing(h, line)) {
        return BQ_E_UNSUPPORTED;
    }
    if (line == BQ_LINE_AFE_BOOT) {
        boot_signal(h, level);
    }
    h->level[line] = level;
    return BQ_OK;
}

static uint32_t now_us(void *ctx)
{
    const hal_sim_x0 *h = ctx;
    return (uint32_t)(h->chip->now / 1000u);
}

/* ---- life ---- */

void hal_sim_x0_init(hal_sim_x0 *h, sim_x0 *chip)
{
    memset(h, 0, sizeof *h);
    h->chip = chip;
    h->advance = default_advance;
    h->advance_ctx = chip;
}

void hal_sim_x0_reset(hal_sim_x0 *h)
{
    memset(h->level, 0, sizeof h->level);
    h->busy = false;
}

bq_i2c hal_sim_x0_i2c(hal_sim_x0 *h)
{
    static const bq_i2c_ops ops = {i2c_start, i2c_poll, i2c_recover};
    const bq_i2c i2c = {&ops, h};
    return i2c;
}

bq_gpio hal_sim_x0_gpio(hal_sim_x0 *h)
{
    static const bq_gpio_ops ops = {line_read, line_write};
    const bq_gpio gpio = {&ops, h};
    return gpio;
}

bq_clock hal_sim_x0_clock(hal_sim_x0 *h)
{
    const bq_clock clock = {now_us, h};
    return clock;
}
