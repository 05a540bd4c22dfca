/* SPDX-License-Identifier: Apache-2.0 */
/* FAULT and ALERT service, memory faults, heat: PL-SEQ-08, PL-SEQ-15. */
#include "driver_rig.h"
#include "unity.h"
#include <string.h>

static driver_rig r;
static bq76pl536_config c;

static struct spy {
    int status_reads, clears, bad_masks;
    uint8_t last_mask[2];
} spy;

static bool watch(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    (void)ctx;
    (void)rx;
    spy.status_reads += (tx[0] & 1) == 0 && tx[1] == 0x20 && n == 10;
    if (n == 4 && (tx[0] & 1) == 1 && (tx[1] == 0x20 || tx[1] == 0x21)) {
        spy.clears++;
        spy.bad_masks += (tx[2] & 0x10) != 0;
        if (tx[2] != 0) {
            spy.last_mask[tx[1] - 0x20] = tx[2];
        }
    }
    return false;
}

void setUp(void)
{
    c = rig_config(3);
    rig_up(&r, &c, NULL);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    memset(&spy, 0, sizeof spy);
    sim_pl_bus_fault(&r.pl)->hook = watch;
}

void tearDown(void)
{
}

static void scan(void)
{
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
}

/* proves: PL-SEQ-08-01, PL-SEQ-08-02, PL-SEQ-08-06, PL-FLT-14, PL-FLT-19, PL-SEQ-08-10, PL-SEQ-00-06,
 * PL-COV-07, PL-AMB-33, PL-AMB-34, PL-AMB-36 */
static void overvoltage_is_reported_and_cleared_only_on_request(void)
{
    scan();
    TEST_ASSERT_EQUAL_INT(0, spy.status_reads); /* nothing to ask for */
    (void)sim_pl_set_cell(&r.pl, 2, 3, 4.3);
    (void)sim_pl_set_cell(&r.pl, 2, 5, 4.3);
    rig_advance_ms(&r, 600);
    for (int i = 0; i < 3; i++) {
        scan();
        TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, r.modules[1].faults);
        TEST_ASSERT_EQUAL_HEX16(0x14, r.modules[1].cell_ov);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[8].quality);
        TEST_ASSERT_EQUAL_HEX16(0, r.modules[0].faults);
    }
    TEST_ASSERT_EQUAL_INT(3, spy.status_reads);
    TEST_ASSERT_EQUAL_INT(0, spy.clears);
    r.action.clear_faults = true; /* the cause is still there: it returns after the delay */
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    TEST_ASSERT_EQUAL_HEX8(0x01, spy.last_mask[1]);
    scan();
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[1].faults);
    rig_advance_ms(&r, 600);
    scan();
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, r.modules[1].faults);
    (void)sim_pl_set_cell(&r.pl, 2, 3, 4.0);
    (void)sim_pl_set_cell(&r.pl, 2, 5, 4.0);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    rig_advance_ms(&r, 600);
    scan();
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[1].faults);
    TEST_ASSERT_FALSE(sim_pl_fault_pin(&r.pl));
    TEST_ASSERT_EQUAL_INT(0, spy.bad_masks);
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* proves: PL-FLT-19, PL-SEQ-00-06 */
static void a_persisting_flag_is_not_hammered(void)
{
    (void)sim_pl_set_cell(&r.pl, 1, 1, 4.3);
    rig_advance_ms(&r, 600);
    scan();
    r.action.clear_faults = true;
    for (int i = 0; i < 50; i++) { /* one second of impatience */
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
        scan();
        rig_advance_ms(&r, 20);
    }
    TEST_ASSERT_TRUE(spy.clears <= 3 * 2);
}

/* proves: PL-CUV-06, PL-SEQ-08-06 */
static void undervoltage_names_its_cells(void)
{
    (void)sim_pl_set_cell(&r.pl, 3, 6, 2.7);
    rig_advance_ms(&r, 600);
    scan();
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_UV, r.modules[2].faults);
    TEST_ASSERT_EQUAL_HEX16(0x20, r.modules[2].cell_uv);
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[2].cell_ov);
}

/* proves: PL-SEQ-08-06, PL-OT-07, PL-AMB-37, PL-AMB-38, PL-ALT-08 */
static void overtemperature_names_its_sensor(void)
{
    (void)sim_pl_set_ts_ratio(&r.pl, 1, 2, 0.31);
    rig_advance_ms(&r, 600);
    scan();
    TEST_ASSERT_EQUAL_HEX16(BQ_F_OVERTEMP, r.modules[0].faults);
    TEST_ASSERT_EQUAL_HEX8(0x02, r.modules[0].sensor_ot);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.temps[1].quality);
    (void)sim_pl_set_ts_ratio(&r.pl, 1, 2, 0.15);
    r.action.clear_faults = true;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    TEST_ASSERT_EQUAL_HEX8(0x02, spy.last_mask[0]);
    rig_advance_ms(&r, 600);
    scan();
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[0].faults);
    TEST_ASSERT_FALSE(sim_pl_alert_pin(&r.pl));
}

/* The CRC flag is dealt with before the comparator flag; only it is cleared.
 * proves: PL-SEQ-08-03, PL-SEQ-08-04, PL-AMB-01, PL-AMB-02, PL-AMB-06, PL-CRC-10 */
static void a_crc_flag_comes_first(void)
{
    uint8_t bad[4] = {0x03, 0x30, 0x7d, 0x31}, rx[4];
    (void)sim_pl_set_cell(&r.pl, 1, 2, 4.3);
    rig_advance_ms(&r, 600);
    sim_pl_spi(&r.pl, bad, rx, NULL, 4);
    TEST_ASSERT_EQUAL_HEX8(0x05, sim_pl_peek(&r.pl, 1, 0x21));
    uint32_t conversions = sim_pl_conversions(&r.pl, 1);
    scan();
    TEST_ASSERT_EQUAL_HEX8(0x04, spy.last_mask[1]);
    TEST_ASSERT_EQUAL_HEX8(0x01, sim_pl_peek(&r.pl, 1, 0x21));
    TEST_ASSERT_EQUAL_UINT(conversions + 2, sim_pl_conversions(&r.pl, 1)); /* the start was repeated */
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, r.modules[0].faults);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[1].quality);
}

/* proves: PL-SEQ-08-08 */
static void a_wild_force_bit_is_cleared_and_reported(void)
{
    rig_poke(&r, 2, 0x21, 0x10);
    rig_poke(&r, 3, 0x20, 0x10);
    scan();
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CONFIG, r.modules[1].faults);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CONFIG, r.modules[2].faults);
    TEST_ASSERT_FALSE(sim_pl_fault_pin(&r.pl));
    TEST_ASSERT_FALSE(sim_pl_alert_pin(&r.pl));
    scan();
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[1].faults);
}

/* proves: PL-SEQ-08-07, PL-AMB-51 */
static void a_device_that_fell_asleep_is_woken_and_measured_anew(void)
{
    rig_poke(&r, 2, 0x31, 0x04);
    (void)sim_pl_set_cell(&r.pl, 2, 1, 3.7);
    scan();
    TEST_ASSERT_EQUAL_INT(SIM_PL_ACTIVE, sim_pl_get_mode(&r.pl, 2));
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CONFIG, r.modules[1].faults);
    TEST_ASSERT_EQUAL_UINT(3700, r.cells[6].mv);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[6].quality);
    TEST_ASSERT_FALSE(sim_pl_alert_pin(&r.pl));
}

/* proves: PL-SEQ-15-01, PL-G3-09, PL-AMB-53 */
static void parity_is_repaired(void)
{
    TEST_ASSERT_EQUAL_INT(0, sim_pl_damage_ram(&r.pl, 2, 0x42, 0x04));
    TEST_ASSERT_TRUE((sim_pl_peek(&r.pl, 2, 0x20) & 0x40) != 0);
    scan();
    TEST_ASSERT_EQUAL_HEX8(0x2c, sim_pl_peek(&r.pl, 2, 0x42));
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&r.pl, 2, 0x20));
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&r.pl, 2, 0x24));
    TEST_ASSERT_TRUE((r.modules[1].faults & BQ_F_CONFIG) != 0);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[6].quality);
    scan();
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[1].faults);
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* proves: PL-SEQ-15-02, PL-ECC-05, PL-FLT-18, PL-SEQ-03-02, PL-AMB-49 */
static void an_uncorrectable_eprom_error_ends_as_a_defective_device(void)
{
    TEST_ASSERT_EQUAL_INT(0, sim_pl_damage_otp(&r.pl, 2, 0x44, 0x03));
    rig_poke(&r, 2, 0x3a, 0x27);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
        rig_advance_ms(&r, 100);
    }
    rig_sample(&r);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_DEFECTIVE | BQ_F_MEMORY,
                            r.modules[1].faults & (BQ_F_DEFECTIVE | BQ_F_MEMORY));
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_CHIP, r.cells[6].quality);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[0].quality);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[12].quality); /* it still serves as a link */
    TEST_ASSERT_EQUAL_UINT(3, bq76pl536_modules_found(&r.d));
}

/* proves: PL-ECC-06, PL-AMB-48, PL-AMB-50 */
static void a_corrected_eprom_error_is_reported_and_harmless(void)
{
    TEST_ASSERT_EQUAL_INT(0, sim_pl_damage_otp(&r.pl, 3, 0x44, 0x01));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    scan();
    TEST_ASSERT_EQUAL_UINT(3, bq76pl536_diagnose(&r.d)->ecc_corrected);
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[2].faults);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[12].quality);
}

/* proves: PL-SEQ-15-03, PL-TSD-03, PL-TSD-04, PL-AMB-52, PL-AMB-91, PL-SEQ-10-07 */
static void heat_shuts_a_device_down_until_it_has_cooled(void)
{
    (void)sim_pl_set_tdie(&r.pl, 2, 150.0);
    rig_advance_ms(&r, 10);
    for (int i = 0; i < 5; i++) {
        scan();
        TEST_ASSERT_TRUE((r.modules[1].faults & BQ_F_DIE_TEMP) != 0);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_CHIP, r.cells[6].quality);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_CHIP, r.temps[2].quality);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[0].quality);
        rig_advance_ms(&r, 300);
    }
    (void)sim_pl_set_tdie(&r.pl, 2, 60.0);
    rig_advance_ms(&r, 1100);
    scan();
    rig_advance_ms(&r, 100);
    scan();
    TEST_ASSERT_EQUAL_INT(SIM_PL_ACTIVE, sim_pl_get_mode(&r.pl, 2));
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[1].faults);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[6].quality);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.temps[2].quality);
    TEST_ASSERT_FALSE(sim_pl_alert_pin(&r.pl));
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* proves: PL-SEQ-03-02, PL-SEQ-15-02, PL-ECC-05 */
static void a_defective_eprom_is_found_at_bring_up(void)
{
    TEST_ASSERT_EQUAL_INT(0, sim_pl_damage_otp(&r.pl, 2, 0x45, 0x03));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    scan();
    TEST_ASSERT_EQUAL_HEX8(0, r.cells[6].quality & BQ_Q_VALID); /* never used, not even once */
    TEST_ASSERT_TRUE((r.modules[1].faults & BQ_F_DEFECTIVE) != 0);
    rig_advance_ms(&r, 100);
    scan();
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_CHIP, r.cells[6].quality);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[0].quality);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[12].quality);
    uint64_t packets = r.hal.transfers; /* and it costs one look at its flags, no more resets */
    scan();
    TEST_ASSERT_TRUE(r.hal.transfers - packets <= 5);
}

static bool hold_fault_line;

static bq_status held_read(void *ctx, bq_line line, bool *level)
{
    const bq_gpio good = hal_sim_gpio(ctx);
    bq_status st = good.ops->read(ctx, line, level);
    *level = *level || (line == BQ_LINE_FAULT && hold_fault_line);
    return st;
}

/* A line that stays high although every device is clean: polled, reported, not polled again and again.
 * proves: PL-SEQ-08-09 */
static void a_line_that_nobody_explains_is_reported_in_service(void)
{
    static bq_gpio_ops ops;
    ops = *hal_sim_gpio(&r.hal).ops;
    ops.read = held_read;
    hold_fault_line = false;
    const bq_gpio gpio = {&ops, &r.hal};
    const bq_spi spi = hal_sim_spi(&r.hal);
    const bq_clock clock = hal_sim_clock(&r.hal);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_init(&r.d, &c, &spi, &gpio, &clock, r.devices, 62));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    hold_fault_line = true;
    scan();
    TEST_ASSERT_FALSE(bq76pl536_diagnose(&r.d)->fault_line_stuck);
    scan();
    TEST_ASSERT_TRUE(bq76pl536_diagnose(&r.d)->fault_line_stuck);
    TEST_ASSERT_FALSE(bq76pl536_diagnose(&r.d)->alert_line_stuck);
    TEST_ASSERT_EQUAL_UINT(1, bq76pl536_diagnose(&r.d)->line_above);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CHAIN, r.modules[0].faults);
    uint64_t packets = r.hal.transfers;
    scan();
    TEST_ASSERT_EQUAL_UINT(4, r.hal.transfers - packets);
    hold_fault_line = false;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_self_test(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(&r, 5));
    scan();
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[0].faults);
    TEST_ASSERT_FALSE(bq76pl536_diagnose(&r.d)->fault_line_stuck);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(overvoltage_is_reported_and_cleared_only_on_request);
    RUN_TEST(a_persisting_flag_is_not_hammered);
    RUN_TEST(undervoltage_names_its_cells);
    RUN_TEST(overtemperature_names_its_sensor);
    RUN_TEST(a_crc_flag_comes_first);
    RUN_TEST(a_wild_force_bit_is_cleared_and_reported);
    RUN_TEST(a_device_that_fell_asleep_is_woken_and_measured_anew);
    RUN_TEST(parity_is_repaired);
    RUN_TEST(an_uncorrectable_eprom_error_ends_as_a_defective_device);
    RUN_TEST(a_corrected_eprom_error_is_reported_and_harmless);
    RUN_TEST(heat_shuts_a_device_down_until_it_has_cooled);
    RUN_TEST(a_defective_eprom_is_found_at_bring_up);
    RUN_TEST(a_line_that_nobody_explains_is_reported_in_service);
    return UNITY_END();
}
