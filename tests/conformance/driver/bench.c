/* SPDX-License-Identifier: Apache-2.0 */
#include "bench.h"
#include <stdarg.h>
#include <stdio.h>

bench b;

void setUp(void)
{
}

void tearDown(void)
{
}

const char *bench_text(const char *format, ...)
{
    static char texts[4][200];
    static unsigned next;
    char *text = texts[next++ % 4u];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof texts[0], format, args);
    va_end(args);
    return text;
}

uint8_t bench_crc(const uint8_t *data, size_t n)
{
    unsigned crc = 0;
    for (size_t i = 0; i < n; i++) {
        crc ^= data[i];
        for (int bit = 0; bit < 8; bit++) {
            crc = (crc & 0x80u) ? ((crc << 1) ^ 0x07u) & 0xffu : (crc << 1) & 0xffu;
        }
    }
    return (uint8_t)crc;
}

void bench_raw_write(int device, int reg, int value)
{
    uint8_t tx[4] = {(uint8_t)W(device), (uint8_t)reg, (uint8_t)value, 0}, rx[4];
    tx[3] = bench_crc(tx, 3);
    sim_pl_spi(&b.pl, tx, rx, NULL, sizeof tx);
}

static bq_status spi_start(void *ctx, const uint8_t *tx, uint8_t *rx, size_t len)
{
    (void)ctx;
    TEST_ASSERT_TRUE_MESSAGE(len >= 1 && len <= 24, "packet length");
    b.transfers++;
    b.under_vpp += b.vpp_device != 0 && sim_pl_vpp(&b.pl, b.vpp_device) && tx[1] != 0x3f;
    if (b.refuse != 0 && b.transfers == b.refuse) {
        return BQ_E_BUS;
    }
    if (b.lose != 0 && b.transfers == b.lose) {
        sim_pl_bus_fault(&b.pl)->drop_packets = 1;
    }
    sim_pl_advance(&b.pl, len * 8u * SIM_PL_S / b.hz); /* a packet acts when CS rises at its end */
    sim_pl_spi(&b.pl, tx, rx, NULL, len);
    if (b.packets < BENCH_LOG) {
        bench_packet *p = &b.log[b.packets];
        p->t_us = sim_pl_now(&b.pl) / 1000;
        p->n = (uint8_t)len;
        memcpy(p->tx, tx, len);
        memcpy(p->rx, rx, len);
    }
    b.packets++;
    b.bytes += len;
    sim_pl_advance(&b.pl, 3000u);
    return BQ_OK;
}

static bq_status spi_poll(void *ctx)
{
    (void)ctx;
    return b.fail_after != 0 && b.transfers == b.fail_after ? BQ_E_BUS : BQ_OK;
}

static bq_status spi_clock(void *ctx, uint32_t hz)
{
    (void)ctx;
    b.hz = hz;
    sim_pl_set_spi_clock(&b.pl, hz);
    return BQ_OK;
}

static bq_status line_read(void *ctx, bq_line line, bool *level)
{
    (void)ctx;
    if (b.no_lines) {
        return BQ_E_UNSUPPORTED;
    }
    switch (line) {
    case BQ_LINE_FAULT:
        *level = b.stuck_fault || sim_pl_fault_pin(&b.pl);
        return BQ_OK;
    case BQ_LINE_ALERT:
        *level = b.stuck_alert || sim_pl_alert_pin(&b.pl);
        return BQ_OK;
    case BQ_LINE_DRDY:
        *level = b.stuck_drdy || sim_pl_drdy_pin(&b.pl);
        return BQ_OK;
    default:
        return BQ_E_UNSUPPORTED;
    }
}

static void vpp(bool on)
{
    uint64_t now = sim_pl_now(&b.pl) / 1000;
    if (on && !sim_pl_vpp(&b.pl, b.vpp_device)) {
        b.vpp_since_us = now;
    } else if (!on && sim_pl_vpp(&b.pl, b.vpp_device) && now - b.vpp_since_us > b.vpp_longest_us) {
        b.vpp_longest_us = now - b.vpp_since_us;
    }
    sim_pl_set_vpp(&b.pl, b.vpp_device, on);
}

static bq_status line_write(void *ctx, bq_line line, bool level)
{
    (void)ctx;
    if (b.no_lines) {
        return BQ_E_UNSUPPORTED;
    }
    switch (line) {
    case BQ_LINE_CONV:
        b.conv_edges += level && !sim_pl_conv(&b.pl);
        sim_pl_set_conv(&b.pl, level);
        return BQ_OK;
    case BQ_LINE_VPP:
        if (b.vpp_device == 0 || (level && b.vpp_fails)) {
            return BQ_E_UNSUPPORTED;
        }
        vpp(level);
        return BQ_OK;
    default:
        return BQ_E_UNSUPPORTED;
    }
}

static uint32_t now_us(void *ctx)
{
    (void)ctx;
    return (uint32_t)(sim_pl_now(&b.pl) / 1000u) + b.clock_offset_us;
}

void bench_up(int devices, const sim_pl_options *options)
{
    memset(&b, 0, sizeof b);
    TEST_ASSERT_EQUAL_INT(0, sim_pl_init(&b.pl, devices, options));
    b.hz = 250000;
    b.config = (bq76pl536_config){
        .devices = (uint8_t)devices,
        .cells_per_device = 6,
        .variant_a = options != NULL && options->variant_a,
        .sensors = 2,
        .thermistor = &bq_thermistor_103at,
        .cov_mv = 4200,
        .cuv_mv = 2800,
        .cov_delay_us = 500000,
        .cuv_delay_us = 500000,
        .ot_c = {60, 60},
        .ot_delay_ms = 1000,
        .user = {0x11, 0x22, 0x33, 0x44},
    };
}

void bench_init(void)
{
    static const bq_spi_ops spi_ops = {spi_start, spi_poll, spi_clock};
    static const bq_gpio_ops gpio_ops = {line_read, line_write};
    const bq_spi spi = {&spi_ops, &b};
    const bq_gpio gpio = {&gpio_ops, &b};
    const bq_clock clock = {now_us, &b};
    EXPECT_STATUS(BQ_OK, bq76pl536_init(&b.driver, &b.config, &spi, &gpio, &clock, b.devices,
                                        (uint8_t)BQ76PL536_MAX_DEVICES));
    b.afe = bq76pl536_afe(&b.driver);
    b.sample = (bq_sample){.cells = b.cells,
                           .temps = b.temps,
                           .modules = b.modules,
                           .cell_capacity = 6 * BQ76PL536_MAX_DEVICES,
                           .temp_capacity = 2 * BQ76PL536_MAX_DEVICES,
                           .module_capacity = BQ76PL536_MAX_DEVICES};
}

bq_status bench_run(bq_status begun)
{
    uint64_t limit = sim_pl_now(&b.pl) + 600 * SIM_PL_S;
    if (begun != BQ_OK) {
        return begun;
    }
    for (;;) {
        uint32_t wait_us = 0, before = b.transfers;
        bq_status status = b.afe.ops->poll(b.afe.ctx, &wait_us);
        TEST_ASSERT_TRUE_MESSAGE(b.transfers - before <= 1, "more than one transfer in a poll");
        if (status != BQ_PENDING) {
            return status;
        }
        sim_pl_advance(&b.pl, (uint64_t)(wait_us != 0 && !b.eager ? wait_us : 1) * 1000u);
        TEST_ASSERT_TRUE_MESSAGE(sim_pl_now(&b.pl) < limit, "the job does not end");
    }
}

bq_status bench_start(void)
{
    return bench_run(b.afe.ops->start(b.afe.ctx));
}

bq_status bench_scan(void)
{
    return bench_run(b.afe.ops->scan(b.afe.ctx));
}

bq_status bench_sleep(void)
{
    return bench_run(b.afe.ops->sleep(b.afe.ctx));
}

bq_status bench_wake(void)
{
    return bench_run(b.afe.ops->wake(b.afe.ctx));
}

bq_status bench_self_test(void)
{
    return bench_run(b.afe.ops->self_test(b.afe.ctx));
}

bq_status bench_apply(const bq_action *action)
{
    return bench_run(b.afe.ops->apply(b.afe.ctx, action));
}

bq_status bench_balance(int device, unsigned mask)
{
    bq_action action = {.charge_on = true, .discharge_on = true};
    for (int c = 1; c <= 6; c++) {
        if (mask >> (c - 1) & 1u) {
            bq_mask_set(action.balance, (uint16_t)((device - 1) * 6 + c));
        }
    }
    return bench_apply(&action);
}

bq_status bench_acknowledge(void)
{
    const bq_action action = {.clear_faults = true};
    return bench_apply(&action);
}

const bq_sample *bench_sample(void)
{
    EXPECT_STATUS(BQ_OK, b.afe.ops->sample(b.afe.ctx, &b.sample));
    return &b.sample;
}

void bench_ready_from(void)
{
    bench_init();
    EXPECT_STATUS(BQ_OK, bench_start());
    EXPECT_STATUS(BQ_OK, bench_scan());
    bench_no_misuse();
}

void bench_ready(int devices, const sim_pl_options *options)
{
    bench_up(devices, options);
    bench_ready_from();
}

void bench_wait_ms(uint32_t ms)
{
    sim_pl_advance(&b.pl, ms * SIM_PL_MS);
}

void bench_power_cycle(void)
{
    for (int d = 1; d <= b.config.devices; d++) {
        sim_pl_set_supply(&b.pl, d, false);
    }
    bench_wait_ms(10);
    for (int d = 1; d <= b.config.devices; d++) {
        sim_pl_set_supply(&b.pl, d, true);
    }
    sim_misuse_clear(sim_pl_misuse(&b.pl));
}

void bench_mark(void)
{
    b.packets = 0;
    b.transfers = 0;
    b.bytes = 0;
}

int bench_find(int from, int first_byte, int reg)
{
    int end = b.packets < BENCH_LOG ? (int)b.packets : BENCH_LOG;
    for (int i = from; i < end; i++) {
        if (b.log[i].tx[0] == first_byte && (reg < 0 || b.log[i].tx[1] == reg)) {
            return i;
        }
    }
    return -1;
}

int bench_count(int first_byte, int reg)
{
    int n = 0;
    for (int i = bench_find(0, first_byte, reg); i >= 0; i = bench_find(i + 1, first_byte, reg)) {
        n++;
    }
    return n;
}

void bench_no_misuse(void)
{
    const sim_misuse *m = sim_pl_misuse(&b.pl);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, m->count, bench_text("%s: %s", m->entry[0].id, m->entry[0].text));
}
