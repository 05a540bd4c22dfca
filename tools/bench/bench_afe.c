/* SPDX-License-Identifier: Apache-2.0 */
/* bench afe: bytes and transactions of one update of each bq769x0; fails where the largest part needs more
 * than it must. */
#include "bench_afe.h"
#include "bqhost/bq769x0.h"
#include "hal_sim_x0.h"
#include <inttypes.h>
#include <stdio.h>

typedef struct bench_afe {
    sim_x0 chip;
    hal_sim_x0 hal;
    bq769x0 driver;
} bench_afe;

static bench_afe rig;

static bq_status finish(void)
{
    uint32_t wait_us = 0;
    bq_status status = bq769x0_poll(&rig.driver, &wait_us);
    while (status == BQ_PENDING) {
        hal_sim_x0_advance(&rig.hal, wait_us * 1000ull);
        status = bq769x0_poll(&rig.driver, &wait_us);
    }
    return status;
}

static bool set_up(const sim_x0_part *part)
{
    const bq769x0_config config = {
        .inputs = part->cells,
        .cells = part->cells,
        .sensors = 1,
        .sensor = bq769x0_sensor_codes,
        .sensor_ctx = &bq769x0_codes_103at,
        .shunt_uohm = 5000,
        .ov_mv = 4200,
        .ov_recover_mv = 4100,
        .ov_delay_s = 1,
        .uv_mv = 2800,
        .uv_recover_mv = 3000,
        .uv_delay_s = 1,
        .ocd_ma = 10000,
        .ocd_delay_ms = 320,
        .scd_ma = 20000,
        .scd_delay_us = 200,
    };
    if (sim_x0_init(&rig.chip, part, NULL) != 0) {
        return false;
    }
    hal_sim_x0_init(&rig.hal, &rig.chip);
    const bq_i2c i2c = hal_sim_x0_i2c(&rig.hal);
    const bq_gpio gpio = hal_sim_x0_gpio(&rig.hal);
    const bq_clock clock = hal_sim_x0_clock(&rig.hal);
    return bq769x0_init(&rig.driver, &config, &i2c, &gpio, &clock) == BQ_OK &&
           bq769x0_begin_start(&rig.driver) == BQ_OK && finish() == BQ_OK;
}

/* One update with a fresh result of the coulomb counter to fetch and clear. */
static bool update(void)
{
    hal_sim_x0_advance(&rig.hal, 250000000ull);
    return bq769x0_begin_scan(&rig.driver) == BQ_OK && finish() == BQ_OK;
}

/* 0, or -1 with the reason told. */
static int row(const char *name)
{
    const sim_x0_part *part = sim_x0_find_part(name);
    uint64_t transactions, bytes;
    bool largest = part->cells == 15;
    if (!set_up(part) || !update()) {
        fprintf(stderr, "bench: %s does not come up\n", name);
        return -1;
    }
    transactions = rig.hal.transactions;
    bytes = rig.hal.bytes;
    if (!update()) {
        fprintf(stderr, "bench: an update of %s failed\n", name);
        return -1;
    }
    transactions = rig.hal.transactions - transactions;
    bytes = rig.hal.bytes - bytes;
    printf("| %s | %u | %s | %" PRIu64 " | %" PRIu64 " | %.1f ms |\n", name, part->cells,
           part->crc ? "on" : "off", transactions, bytes, (double)bytes * 9.0 / 100.0);
    if (largest && (transactions != 3u || bytes != (part->crc ? 92u : 50u))) {
        fprintf(stderr, "bench: more on the bus than an update needs\n");
        return -1;
    }
    return 0;
}

int bench_afe_bus(void)
{
    static const char *const parts[] = {"bq7692000", "bq7692003", "bq7693000",
                                        "bq7693003", "bq7694000", "bq7694003"};
    printf("| part | cells | CRC | transactions | bytes | bus time at 100 kHz |\n");
    printf("|---|---|---|---|---|---|\n");
    for (unsigned i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        if (row(parts[i]) != 0) {
            return 1;
        }
    }
    return 0;
}
