/* SPDX-License-Identifier: Apache-2.0 */
#include "hal_sim.h"
#include <string.h>

#define GAP_NS 3000u

static void default_advance(void *ctx, uint64_t ns)
{
    sim_pl_advance(ctx, ns);
}

void hal_sim_advance(hal_sim *h, uint64_t ns)
{
    h->advance(h->advance_ctx, ns);
}

/* ---- SPI ----------------------------------------------------------------------------------------- */

static bool fails_now(hal_sim *h)
{
    if (h->fail_at == 0u) {
        return false;
    }
    if (h->fail_at > 1u) {
        h->fail_at--;
        return false;
    }
    if (h->fail_count > 1u) {
        h->fail_count--;
    } else {
        h->fail_count = 0;
        h->fail_at = 0;
    }
    return true;
}

static bq_status spi_start(void *ctx, const uint8_t *tx, uint8_t *rx, size_t len)
{
    hal_sim *h = ctx;
    if (tx == NULL || rx == NULL || len < 1u || len > 256u) {
        return BQ_E_ARG;
    }
    if (h->busy) {
        h->overlaps++;
        return BQ_E_BUSY;
    }
    h->transfers++;
    h->bytes += len;
    bool fails = fails_now(h);
    if (fails && h->fail_in_start) {
        return BQ_E_BUS;
    }
    h->outcome = BQ_OK;
    if (fails) {
        memset(rx, 0x5a, len); /* undefined after an error */
        h->outcome = BQ_E_BUS;
    } else {
        sim_pl_spi(h->pl, tx, rx, NULL, len);
    }
    hal_sim_advance(h, (uint64_t)len * 8000000000ull / h->clock_hz + GAP_NS);
    h->busy = true;
    h->left = h->pending;
    return BQ_OK;
}

static bq_status spi_poll(void *ctx)
{
    hal_sim *h = ctx;
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

static bq_status spi_set_clock(void *ctx, uint32_t hz)
{
    hal_sim *h = ctx;
    if (h->fixed_clock || hz == 0u) {
        return BQ_E_RANGE;
    }
    h->clock_hz = hz;
    sim_pl_set_spi_clock(h->pl, hz);
    return BQ_OK;
}

/* ---- lines --------------------------------------------------------------------------------------- */

static bool is_missing(const hal_sim *h, bq_line line)
{
    return (h->missing >> (unsigned)line & 1u) != 0u;
}

bool hal_sim_line(const hal_sim *h, bq_line line)
{
    switch (line) {
    case BQ_LINE_DRDY:
        return sim_pl_drdy_pin(h->pl);
    case BQ_LINE_FAULT:
        return sim_pl_fault_pin(h->pl);
    case BQ_LINE_ALERT:
        return sim_pl_alert_pin(h->pl);
    case BQ_LINE_CONV:
        return sim_pl_conv(h->pl);
    case BQ_LINE_CONTACTOR_FB:
        return h->welded || h->level[BQ_LINE_CONTACTOR];
    default:
        return (unsigned)line < (unsigned)BQ_LINE_COUNT && h->level[line];
    }
}

static bq_status line_read(void *ctx, bq_line line, bool *level)
{
    const hal_sim *h = ctx;
    if ((unsigned)line >= (unsigned)BQ_LINE_COUNT || level == NULL) {
        return BQ_E_ARG;
    }
    if (is_missing(h, line)) {
        return BQ_E_UNSUPPORTED;
    }
    *level = hal_sim_line(h, line);
    return BQ_OK;
}

static void supply(hal_sim *h, bool on)
{
    for (int device = 1; sim_pl_set_supply(h->pl, device, on) == 0; device++) {
    }
}

static bq_status line_write(void *ctx, bq_line line, bool level)
{
    hal_sim *h = ctx;
    if ((unsigned)line >= (unsigned)BQ_LINE_COUNT) {
        return BQ_E_ARG;
    }
    if (is_missing(h, line)) {
        return BQ_E_UNSUPPORTED;
    }
    switch (line) {
    case BQ_LINE_CONV:
        sim_pl_set_conv(h->pl, level);
        break;
    case BQ_LINE_VPP:
        (void)sim_pl_set_vpp(h->pl, h->vpp_device, level);
        break;
    case BQ_LINE_AFE_POWER:
        if (level != h->level[line]) {
            supply(h, level);
        }
        break;
    default:
        break;
    }
    h->level[line] = level;
    return BQ_OK;
}

/* ---- time and current ------------------------------------------------------------------------------ */

static uint32_t clock_now(void *ctx)
{
    hal_sim *h = ctx;
    if (h->tick_ns != 0u) {
        hal_sim_advance(h, h->tick_ns);
    }
    return (uint32_t)(sim_pl_now(h->pl) / 1000u);
}

static bq_status ammeter_read(void *ctx, int32_t *current_ma)
{
    const hal_sim *h = ctx;
    if (h->current_broken) {
        return BQ_E_BUS;
    }
    if (h->current_stale) {
        return BQ_E_STALE;
    }
    *current_ma = h->current_ma;
    return BQ_OK;
}

/* ---- set-up ---------------------------------------------------------------------------------------- */

void hal_sim_init(hal_sim *h, sim_pl *pl)
{
    memset(h, 0, sizeof *h);
    h->pl = pl;
    h->advance = default_advance;
    h->advance_ctx = pl;
    h->vpp_device = 1;
    h->clock_hz = 250000u;
    h->level[BQ_LINE_AFE_POWER] = true;
    sim_pl_set_spi_clock(pl, h->clock_hz);
}

void hal_sim_reset(hal_sim *h)
{
    bool power = h->level[BQ_LINE_AFE_POWER];
    memset(h->level, 0, sizeof h->level);
    h->level[BQ_LINE_AFE_POWER] = power;
    h->busy = false;
    sim_pl_set_conv(h->pl, false);
    (void)sim_pl_set_vpp(h->pl, h->vpp_device, false);
}

void hal_sim_weld(hal_sim *h, bool welded)
{
    h->welded = welded;
}

bq_spi hal_sim_spi(hal_sim *h)
{
    static const bq_spi_ops ops = {spi_start, spi_poll, spi_set_clock};
    bq_spi spi = {&ops, h};
    return spi;
}

bq_gpio hal_sim_gpio(hal_sim *h)
{
    static const bq_gpio_ops ops = {line_read, line_write};
    bq_gpio gpio = {&ops, h};
    return gpio;
}

bq_clock hal_sim_clock(hal_sim *h)
{
    bq_clock clock = {clock_now, h};
    return clock;
}

bq_ammeter hal_sim_ammeter(hal_sim *h)
{
    bq_ammeter ammeter = {ammeter_read, h};
    return ammeter;
}
