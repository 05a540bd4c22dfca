/* SPDX-License-Identifier: Apache-2.0 */
#include "driver_rig.h"
#include "unity.h"
#include <stdio.h>
#include <string.h>

bq76pl536_config rig_config(int devices)
{
    bq76pl536_config c;
    memset(&c, 0, sizeof c);
    c.devices = (uint8_t)devices;
    c.cells_per_device = 6;
    c.sensors = 2;
    c.thermistor = &bq_thermistor_103at;
    c.cov_mv = 4200;
    c.cuv_mv = 2800;
    c.cov_delay_us = 500000;
    c.cuv_delay_us = 500000;
    c.ot_c[0] = 60;
    c.ot_c[1] = 60;
    c.ot_delay_ms = 500;
    c.scrub_period_ms = 60000;
    return c;
}

void rig_open(driver_rig *r, const bq76pl536_config *config, const sim_pl_options *options)
{
    memset(r, 0, sizeof *r);
    TEST_ASSERT_EQUAL_INT(0, sim_pl_init(&r->pl, config->devices, options));
    hal_sim_init(&r->hal, &r->pl);
    const bq_spi spi = hal_sim_spi(&r->hal);
    const bq_gpio gpio = hal_sim_gpio(&r->hal);
    const bq_clock clock = hal_sim_clock(&r->hal);
    r->sample.cells = r->cells;
    r->sample.temps = r->temps;
    r->sample.modules = r->modules;
    r->sample.cell_capacity = RIG_CELLS;
    r->sample.temp_capacity = BQ76PL536_MAX_DEVICES * 2;
    r->sample.module_capacity = BQ76PL536_MAX_DEVICES;
    TEST_ASSERT_EQUAL_INT(
        BQ_OK, bq76pl536_init(&r->d, config, &spi, &gpio, &clock, r->devices, BQ76PL536_MAX_DEVICES));
}

bq_status rig_run(driver_rig *r, double seconds)
{
    uint64_t end = sim_pl_now(&r->pl) + (uint64_t)(seconds * 1e9);
    bq_status st = BQ_PENDING;
    r->polls = 0;
    r->most_packets_per_poll = 0;
    while (st == BQ_PENDING && sim_pl_now(&r->pl) < end) {
        uint64_t before = r->hal.transfers;
        uint32_t wait_us = 0;
        st = bq76pl536_poll(&r->d, &wait_us);
        r->polls++;
        if (r->hal.transfers - before > r->most_packets_per_poll) {
            r->most_packets_per_poll = (uint32_t)(r->hal.transfers - before);
        }
        hal_sim_advance(&r->hal, wait_us != 0u ? wait_us * 1000ull : 100u);
    }
    return st;
}

bq_status rig_start(driver_rig *r)
{
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_start(&r->d));
    return rig_run(r, 120.0);
}

bq_status rig_scan(driver_rig *r)
{
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_scan(&r->d));
    return rig_run(r, 30.0);
}

bq_status rig_apply(driver_rig *r)
{
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_apply(&r->d, &r->action));
    return rig_run(r, 30.0);
}

void rig_up(driver_rig *r, const bq76pl536_config *config, const sim_pl_options *options)
{
    rig_open(r, config, options);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(r));
}

void rig_sample(driver_rig *r)
{
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_sample(&r->d, &r->sample));
}

void rig_advance_ms(driver_rig *r, uint32_t ms)
{
    hal_sim_advance(&r->hal, ms * SIM_PL_MS);
    (void)bq76pl536_poll(&r->d, NULL);
}

void rig_poke(driver_rig *r, uint8_t device, uint8_t reg, uint8_t value)
{
    uint8_t tx[4] = {(uint8_t)(device << 1 | 1), reg, value, 0};
    uint8_t rx[4];
    unsigned crc = 0;
    for (int k = 0; k < 3; k++) {
        crc ^= tx[k];
        for (int b = 0; b < 8; b++) {
            crc = (crc << 1) ^ ((crc & 0x80u) != 0u ? 0x107u : 0u);
        }
    }
    tx[3] = (uint8_t)crc;
    sim_pl_spi(&r->pl, tx, rx, NULL, 4);
    sim_pl_advance(&r->pl, 10 * SIM_PL_US);
}

uint32_t rig_misuse(driver_rig *r)
{
    return sim_pl_misuse(&r->pl)->count;
}

void rig_print_misuse(driver_rig *r)
{
    const sim_misuse *m = sim_pl_misuse(&r->pl);
    for (uint32_t i = 0; i < m->count && i < SIM_MISUSE_KEPT; i++) {
        printf("%12.6f dev %d %s %s\n", (double)m->entry[i].time_ns / 1e9, m->entry[i].device, m->entry[i].id,
               m->entry[i].text);
    }
}
