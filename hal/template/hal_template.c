/* SPDX-License-Identifier: Apache-2.0 */
/*
 * An empty port. Interrupts may exist in here; they only record (set h->outcome, clear h->busy). Everything
 * else runs in the context that calls the library.
 */
#include "hal_template.h"

/* ---- SPI: needed for the bq76PL536 -------------------------------------------------------------- */

static bq_status spi_start(void *ctx, const uint8_t *tx, uint8_t *rx, size_t len)
{
    hal_template *h = ctx;
    if (tx == NULL || rx == NULL || len < 1u || len > 256u) {
        return BQ_E_ARG;
    }
    if (h->busy) {
        return BQ_E_BUSY;
    }
    /* FILL IN: CS low; start the DMA of `len` bytes from `tx` to `rx` (SPI mode 1, MSB first), set h->busy
     * and return BQ_OK. Without DMA: move the bytes here, no pause above 100 us, CS high, h->outcome = BQ_OK,
     * h->busy = true, return BQ_OK. At least 3 us of CS high before the next packet: wait them here, before
     * CS goes low. */
    h->outcome = BQ_E_UNSUPPORTED;
    return BQ_E_BUS;
}

static bq_status spi_poll(void *ctx)
{
    hal_template *h = ctx;
    /* FILL IN: BQ_PENDING while the DMA runs; BQ_E_TIMEOUT, with the transfer stopped and CS high, when it
     * takes longer than twice its nominal time plus 1 ms. */
    h->busy = false;
    return h->outcome;
}

static bq_status spi_set_clock(void *ctx, uint32_t hz)
{
    (void)ctx;
    (void)hz;
    /* FILL IN: the fastest divider that does not exceed `hz`; BQ_E_RANGE if there is none. Or put NULL into
     * the table. */
    return BQ_E_RANGE;
}

/* ---- I2C: needed for the bq769x0 ------------------------------------------------------------------ */

static bq_status i2c_start(void *ctx, uint8_t address7, const bq_i2c_segment *segments, size_t count)
{
    (void)ctx;
    (void)address7;
    if (segments == NULL || count == 0u) {
        return BQ_E_ARG;
    }
    /* FILL IN: each segment begins with START (or repeated START) and the address byte; STOP where stop_after
     * says so and after the last one. */
    return BQ_E_ARBITRATION;
}

static bq_status i2c_poll(void *ctx)
{
    (void)ctx;
    /* FILL IN: BQ_PENDING, BQ_OK, BQ_E_NACK, BQ_E_ARBITRATION, BQ_E_TIMEOUT (stretching beyond 10 ms) or
     * BQ_E_BUS. */
    return BQ_E_BUS;
}

static bq_status i2c_recover(void *ctx)
{
    (void)ctx;
    /* FILL IN: up to nine clocks while SDA is low, then STOP. At most 200 us. */
    return BQ_E_ARBITRATION;
}

/* ---- lines ---------------------------------------------------------------------------------------- */

static bq_status line_read(void *ctx, bq_line line, bool *level)
{
    (void)ctx;
    if (level == NULL || (unsigned)line >= (unsigned)BQ_LINE_COUNT) {
        return BQ_E_ARG;
    }
    switch (line) {
    /* FILL IN: case BQ_LINE_FAULT: *level = ...; return BQ_OK;  and so on for DRDY, ALERT, CONTACTOR_FB. */
    default:
        return BQ_E_UNSUPPORTED; /* this board does not have it: the library uses its substitute */
    }
}

static bq_status line_write(void *ctx, bq_line line, bool level)
{
    (void)ctx;
    (void)level;
    if ((unsigned)line >= (unsigned)BQ_LINE_COUNT) {
        return BQ_E_ARG;
    }
    switch (line) {
    /* FILL IN: CONV, VPP (manufacturing only), AFE_POWER, AFE_BOOT, CONTACTOR, PRECHARGE: the ones the board
     * has. */
    default:
        return BQ_E_UNSUPPORTED;
    }
}

/* ---- time ------------------------------------------------------------------------------------------ */

static uint32_t now_us(void *ctx)
{
    hal_template *h = ctx;
    /* FILL IN: a free-running 32-bit microsecond counter that also runs while the CPU sleeps. */
    return h->last_ticks;
}

/* ---- pack current ---------------------------------------------------------------------------------- */

static bq_status ammeter_read(void *ctx, int32_t *current_ma)
{
    (void)ctx;
    (void)current_ma;
    /* FILL IN: positive while charging. BQ_E_STALE while there is no new conversion. */
    return BQ_E_STALE;
}

/* ---- tables ---------------------------------------------------------------------------------------- */

bq_status hal_template_init(hal_template *h)
{
    if (h == NULL) {
        return BQ_E_ARG;
    }
    h->busy = false;
    h->outcome = BQ_OK;
    h->last_ticks = 0;
    /* FILL IN: clocks, pins, SPI or I2C, timer. Contactor and precharge outputs first, and open. */
    return BQ_OK;
}

bq_spi hal_template_spi(hal_template *h)
{
    static const bq_spi_ops ops = {spi_start, spi_poll, spi_set_clock};
    bq_spi spi = {&ops, h};
    return spi;
}

bq_i2c hal_template_i2c(hal_template *h)
{
    static const bq_i2c_ops ops = {i2c_start, i2c_poll, i2c_recover};
    bq_i2c i2c = {&ops, h};
    return i2c;
}

bq_gpio hal_template_gpio(hal_template *h)
{
    static const bq_gpio_ops ops = {line_read, line_write};
    bq_gpio gpio = {&ops, h};
    return gpio;
}

bq_clock hal_template_clock(hal_template *h)
{
    bq_clock clock = {now_us, h};
    return clock;
}

bq_ammeter hal_template_ammeter(hal_template *h)
{
    bq_ammeter ammeter = {ammeter_read, h};
    return ammeter;
}
