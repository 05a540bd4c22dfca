/* SPDX-License-Identifier: Apache-2.0 */
#include "driver_lives.h"
#include "unity.h"
#include <string.h>

driver_rig r;
bq76pl536_config c;
int reference[BQ76PL536_MAX_DEVICES + 1][256];

struct spy spy;

bool life_watch(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    (void)ctx;
    (void)rx;
    if (spy.packets == 0u && n == 4u) {
        memcpy(spy.first, tx, 4);
    }
    spy.packets++;
    spy.bytes += n;
    spy.resets += tx[0] == 0x7fu && tx[1] == 0x3cu;
    spy.assignments += (tx[0] & 1u) != 0u && tx[1] == 0x3bu;
    spy.keys += (tx[0] & 1u) != 0u && (tx[1] == 0x3au || tx[1] == 0x3fu);
    if (spy.act != NULL && spy.packets == spy.at) {
        spy.act();
    }
    return false;
}

void life_set_up(void)
{
    memset(&spy, 0, sizeof spy);
    c = rig_config(LIFE_DEVICES);
    c.warm_start = true;
}

void life_tear_down(void)
{
    sim_pl_bus_fault(&r.pl)->hook = NULL;
}

void life_remember(void)
{
    for (int n = 1; n <= c.devices; n++) {
        for (int reg = 0; reg < 256; reg++) {
            reference[n][reg] = sim_pl_peek(&r.pl, n, (uint8_t)reg);
        }
    }
}

/* A life of the host with readings; what follows belongs to the next one. */
void life_first(const sim_pl_options *options)
{
    rig_up(&r, &c, options);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    TEST_ASSERT_EQUAL_INT(BQ76PL536_WARM_UNHEARD, bq76pl536_diagnose(&r.d)->warm);
    TEST_ASSERT_EQUAL_UINT(1, bq76pl536_diagnose(&r.d)->warm_device);
    life_remember();
    sim_pl_bus_fault(&r.pl)->hook = life_watch;
}

/* The host forgets everything. */
void life_reset_host(void)
{
    const bq_spi spi = hal_sim_spi(&r.hal);
    const bq_gpio gpio = hal_sim_gpio(&r.hal);
    const bq_clock clock = hal_sim_clock(&r.hal);
    while (spi.ops->poll(spi.ctx) == BQ_PENDING) { /* the packet under way still ends */
        hal_sim_advance(&r.hal, 100000);
    }
    TEST_ASSERT_EQUAL_INT(BQ_OK,
                          bq76pl536_init(&r.d, &c, &spi, &gpio, &clock, r.devices, BQ76PL536_MAX_DEVICES));
    spy.packets = spy.bytes = spy.resets = spy.assignments = spy.keys = 0;
}

bq76pl536_warm life_warm(void)
{
    return bq76pl536_diagnose(&r.d)->warm;
}

void life_assert_registers(void)
{
    for (int n = 1; n <= c.devices; n++) {
        for (int reg = 0x40; reg <= 0x4b; reg++) {
            TEST_ASSERT_EQUAL_HEX8(reference[n][reg], sim_pl_peek(&r.pl, n, (uint8_t)reg));
        }
        TEST_ASSERT_EQUAL_HEX8(0x80 + n, sim_pl_peek(&r.pl, n, 0x3b));
        TEST_ASSERT_EQUAL_HEX8(reference[n][0x30], sim_pl_peek(&r.pl, n, 0x30));
        TEST_ASSERT_EQUAL_HEX8(reference[n][0x31], sim_pl_peek(&r.pl, n, 0x31));
        TEST_ASSERT_EQUAL_HEX8(0, sim_pl_peek(&r.pl, n, 0x32));
        TEST_ASSERT_EQUAL_HEX8(0, sim_pl_peek(&r.pl, n, 0x20));
        TEST_ASSERT_EQUAL_HEX8(0, sim_pl_peek(&r.pl, n, 0x21));
    }
}

void life_assert_picture(void)
{
    rig_sample(&r);
    for (unsigned i = 0; i < c.devices * 6u; i++) {
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[i].quality);
        TEST_ASSERT_EQUAL_UINT(3600, r.cells[i].mv);
    }
    for (unsigned i = 0; i < c.devices * 2u; i++) {
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.temps[i].quality);
    }
    for (unsigned n = 0; n < c.devices; n++) {
        TEST_ASSERT_EQUAL_HEX16(0, r.modules[n].faults);
    }
}

/* Bring-up ends well and the first picture is complete and right. */
void life_assert_right(void)
{
    life_assert_registers();
    TEST_ASSERT_FALSE(sim_pl_fault_pin(&r.pl));
    TEST_ASSERT_FALSE(sim_pl_alert_pin(&r.pl));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    life_assert_picture();
}

void life_next(void)
{
    const uint32_t before = rig_misuse(&r);
    life_reset_host();
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_EQUAL_UINT(c.devices, bq76pl536_modules_found(&r.d));
    TEST_ASSERT_EQUAL_UINT(before, rig_misuse(&r));
}

/* The next life starts anew for the reason given, and rightly. */
void life_expect_cold(bq76pl536_warm why, unsigned device)
{
    life_next();
    TEST_ASSERT_EQUAL_INT(why, life_warm());
    TEST_ASSERT_EQUAL_UINT(device, bq76pl536_diagnose(&r.d)->warm_device);
    TEST_ASSERT_GREATER_THAN(0, spy.resets);
    life_assert_right();
}

void life_expect_adopted(void)
{
    life_next();
    TEST_ASSERT_EQUAL_INT(BQ76PL536_WARM_ADOPTED, life_warm());
    TEST_ASSERT_EQUAL_UINT(0, bq76pl536_diagnose(&r.d)->warm_device);
    TEST_ASSERT_EQUAL_UINT(0, spy.resets);
    TEST_ASSERT_EQUAL_UINT(0, spy.assignments);
    life_assert_right();
}
