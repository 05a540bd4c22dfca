/* SPDX-License-Identifier: Apache-2.0 */
/*
 * bench bus            bytes and packets of one scan for several stack sizes; fails unless they are 23 N + 4
 * in N + 1 bench afe            the same for one update of the bq769x0 parts; the largest must need 92 bytes
 * (50 without CRC) in 3 bench scan N COUNT   bring-up of N devices, then COUNT times scan and copy the
 * sample: the work of which instructions are counted
 */
#include "bench_afe.h"
#include "bqhost/bq76pl536.h"
#include "hal_sim.h"
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct bench {
    sim_pl pl;
    hal_sim hal;
    bq76pl536 driver;
    bq76pl536_device devices[BQ76PL536_MAX_DEVICES];
    bq_cell_reading cells[BQ76PL536_MAX_DEVICES * BQ76PL536_MAX_CELLS];
    bq_temp_reading temps[BQ76PL536_MAX_DEVICES * 2];
    bq_module_reading modules[BQ76PL536_MAX_DEVICES];
    bq_sample sample;
} bench;

static bench rig; /* a tool may own a static instance; it is too large for a stack */

static bq_status finish(void)
{
    uint32_t wait_us = 0;
    bq_status status = bq76pl536_poll(&rig.driver, &wait_us);
    while (status == BQ_PENDING) {
        hal_sim_advance(&rig.hal, wait_us * SIM_PL_US);
        status = bq76pl536_poll(&rig.driver, &wait_us);
    }
    return status;
}

static bool set_up(uint8_t devices)
{
    const bq76pl536_config config = {
        .devices = devices,
        .cells_per_device = BQ76PL536_MAX_CELLS,
        .sensors = 2,
        .thermistor = &bq_thermistor_103at,
        .cov_mv = 4200,
        .cuv_mv = 2800,
        .cov_delay_us = 500000,
        .cuv_delay_us = 500000,
        .ot_c = {60, 60},
        .ot_delay_ms = 1000,
        .scrub_period_ms = 60000, /* its packets are counted apart */
    };
    if (sim_pl_init(&rig.pl, devices, NULL) != 0) {
        return false;
    }
    for (int d = 1; d <= devices; d++) {
        for (int c = 1; c <= 6; c++) {
            sim_pl_set_cell(&rig.pl, d, c, 3.6 + 0.001 * c + 0.0001 * d);
        }
        sim_pl_set_ts_ratio(&rig.pl, d, 1, 0.1369);
        sim_pl_set_ts_ratio(&rig.pl, d, 2, 0.1300);
    }
    hal_sim_init(&rig.hal, &rig.pl);
    const bq_spi spi = hal_sim_spi(&rig.hal);
    const bq_gpio gpio = hal_sim_gpio(&rig.hal);
    const bq_clock clock = hal_sim_clock(&rig.hal);
    rig.sample = (bq_sample){.cells = rig.cells,
                             .temps = rig.temps,
                             .modules = rig.modules,
                             .cell_capacity = sizeof rig.cells / sizeof rig.cells[0],
                             .temp_capacity = sizeof rig.temps / sizeof rig.temps[0],
                             .module_capacity = BQ76PL536_MAX_DEVICES};
    return bq76pl536_init(&rig.driver, &config, &spi, &gpio, &clock, rig.devices, devices) == BQ_OK &&
           bq76pl536_start(&rig.driver) == BQ_OK && finish() == BQ_OK;
}

/* One scan 100 ms after the one before, every cell fresh and within a millivolt of the truth. */
static bool scan(uint8_t devices)
{
    hal_sim_advance(&rig.hal, 100 * SIM_PL_MS);
    if (bq76pl536_scan(&rig.driver) != BQ_OK || finish() != BQ_OK ||
        bq76pl536_sample(&rig.driver, &rig.sample) != BQ_OK || rig.sample.cell_count != 6u * devices) {
        return false;
    }
    for (unsigned i = 0; i < rig.sample.cell_count; i++) {
        int truth_mv = (int)(1000.0 * sim_pl_cell(&rig.pl, (int)(i / 6u) + 1, (int)(i % 6u) + 1) + 0.5);
        if (rig.sample.cells[i].quality != BQ_Q_VALID || abs(rig.sample.cells[i].mv - truth_mv) > 1) {
            return false;
        }
    }
    return true;
}

static int bus(void)
{
    static const uint8_t sizes[] = {1, 8, 16, 32, 62};
    printf("| devices | cells | packets | bytes | 23 N + 4 | bus time at the default clock |\n");
    printf("|---|---|---|---|---|---|\n");
    for (unsigned i = 0; i < sizeof sizes; i++) {
        uint8_t n = sizes[i];
        if (!set_up(n) || !scan(n)) {
            fprintf(stderr, "bench: a stack of %u does not come up\n", n);
            return 1;
        }
        uint64_t packets = rig.hal.transfers, bytes = rig.hal.bytes;
        if (!scan(n)) {
            fprintf(stderr, "bench: a scan of %u devices failed\n", n);
            return 1;
        }
        packets = rig.hal.transfers - packets;
        bytes = rig.hal.bytes - bytes;
        double us = (double)bytes * 8e6 / rig.hal.clock_hz + 3.0 * (double)packets;
        printf("| %u | %u | %" PRIu64 " | %" PRIu64 " | %u | %.1f ms at %.4g kHz |\n", n, 6u * n, packets,
               bytes, 23u * n + 4u, us / 1000.0, rig.hal.clock_hz / 1000.0);
        if (packets != n + 1u || bytes != 23u * n + 4u) {
            fprintf(stderr, "bench: more on the bus than a scan needs\n");
            return 1;
        }
    }
    return 0;
}

static int scans(uint8_t devices, long count)
{
    bool good = set_up(devices);
    while (good && count-- > 0) {
        good = scan(devices);
    }
    if (!good) {
        fprintf(stderr, "bench: a scan failed\n");
    }
    return good ? 0 : 1;
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "bus") == 0) {
        return bus();
    }
    if (argc == 2 && strcmp(argv[1], "afe") == 0) {
        return bench_afe_bus();
    }
    if (argc == 4 && strcmp(argv[1], "scan") == 0 && atoi(argv[2]) >= 1 && atoi(argv[2]) <= 62) {
        return scans((uint8_t)atoi(argv[2]), atol(argv[3]));
    }
    fprintf(stderr, "usage: bench bus | bench afe | bench scan DEVICES COUNT\n");
    return 2;
}
