/* SPDX-License-Identifier: Apache-2.0 */
/*
 * An empty port. Interrupts may exist in here; they only record (set h->outcome, clear h->busy). Everything
 * else runs in the context that calls the library.
 */
#include "hal_template.h"
#include <string.h>

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

/* ---- CAN: optional, put `ops` NULL into bq_board without it ----------------------------------------- */

static bq_status can_send(void *ctx, const bq_can_frame *frame)
{
    (void)ctx;
    if (frame == NULL || frame->len > 8u || frame->id > (frame->extended ? 0x1fffffffu : 0x7ffu)) {
        return BQ_E_ARG;
    }
    /* FILL IN: BQ_E_BUS while bus-off; BQ_E_BUSY without a free place; else queue it. The controller must
     * send in the order of queueing, not by identifier. */
    return BQ_E_BUS;
}

static bq_status can_receive(void *ctx, bq_can_frame *frame)
{
    (void)ctx;
    /* FILL IN: the oldest frame that the interrupt has put aside. */
    return frame == NULL ? BQ_E_ARG : BQ_PENDING;
}

static bq_can_state can_state(void *ctx)
{
    (void)ctx;
    /* FILL IN: also recover from bus-off, in hardware or here, and drop what was queued. */
    return BQ_CAN_OFF;
}

/* ---- console: optional -------------------------------------------------------------------------- */

static size_t stream_write(void *ctx, const uint8_t *data, size_t len)
{
    (void)ctx;
    (void)data;
    (void)len;
    /* FILL IN: into a ring that the transmit interrupt empties. */
    return 0;
}

static size_t stream_read(void *ctx, uint8_t *data, size_t len)
{
    (void)ctx;
    (void)data;
    (void)len;
    /* FILL IN: out of a ring that the receive interrupt fills. */
    return 0;
}

/* ---- settings: optional ------------------------------------------------------------------------- */

static bool inside(uint8_t sector, uint32_t offset, const void *data, size_t len)
{
    return data != NULL && sector < HAL_TEMPLATE_SECTORS && offset <= HAL_TEMPLATE_SECTOR_BYTES &&
           len <= HAL_TEMPLATE_SECTOR_BYTES - offset;
}

static bq_status nvm_read(void *ctx, uint8_t sector, uint32_t offset, void *data, size_t len)
{
    (void)ctx;
    if (!inside(sector, offset, data, len)) {
        return BQ_E_ARG;
    }
    /* FILL IN: copy. */
    return BQ_E_BUS;
}

static bq_status nvm_program(void *ctx, uint8_t sector, uint32_t offset, const void *data, size_t len)
{
    (void)ctx;
    if (!inside(sector, offset, data, len) || (offset | len) % HAL_TEMPLATE_UNIT_BYTES != 0u) {
        return BQ_E_ARG;
    }
    /* FILL IN: unlock, program, lock, read back (BQ_E_VERIFY). Begin nothing while the supply falls. */
    return BQ_E_BUS;
}

static bq_status nvm_erase(void *ctx, uint8_t sector)
{
    (void)ctx;
    if (sector >= HAL_TEMPLATE_SECTORS) {
        return BQ_E_ARG;
    }
    /* FILL IN: as above; feed the watchdog if erasing takes longer than it waits. */
    return BQ_E_BUS;
}

/* ---- the microcontroller ------------------------------------------------------------------------ */

static void mcu_feed(void *ctx)
{
    (void)ctx;
    /* FILL IN: restart the watchdog. */
}

static void mcu_reset(void *ctx)
{
    (void)ctx;
    /* FILL IN: outputs safe, then a software reset. Does not return. */
}

static uint32_t mcu_stack_free(void *ctx)
{
    (void)ctx;
    /* FILL IN: paint the stack at start, count the paint here. */
    return UINT32_MAX;
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
    memset(&h->boot, 0, sizeof h->boot);
    /* FILL IN: h->boot: why the last life ended, a crash record, whether the image is whole. Until then
     * image_ok is false and the outputs stay off. */
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

bq_can hal_template_can(hal_template *h)
{
    static const bq_can_ops ops = {can_send, can_receive, can_state};
    bq_can can = {&ops, h};
    return can;
}

bq_stream hal_template_stream(hal_template *h)
{
    static const bq_stream_ops ops = {stream_write, stream_read};
    bq_stream stream = {&ops, h};
    return stream;
}

bq_nvm hal_template_nvm(hal_template *h)
{
    static const bq_nvm_ops ops = {nvm_read, nvm_program, nvm_erase};
    bq_nvm nvm = {&ops, h, HAL_TEMPLATE_SECTORS, HAL_TEMPLATE_UNIT_BYTES, HAL_TEMPLATE_SECTOR_BYTES};
    return nvm;
}

bq_mcu hal_template_mcu(hal_template *h)
{
    static const bq_mcu_ops ops = {mcu_feed, mcu_reset, mcu_stack_free};
    bq_mcu mcu = {&ops, h, &h->boot};
    return mcu;
}
