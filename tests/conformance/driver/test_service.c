/* SPDX-License-Identifier: Apache-2.0 */
/* FAULT and ALERT service, self-test of the chains, parity, ECC and heat: PL-SEQ-08, PL-SEQ-09, PL-SEQ-15. */
#include "bench.h"

static void scans(int n, uint32_t pause_ms)
{
    for (int i = 0; i < n; i++) {
        bench_scan();
        bench_wait_ms(pause_ms);
    }
    bench_sample();
}

/* proves: PL-SEQ-08-01, PL-SEQ-08-02, PL-SEQ-08-06, PL-SEQ-00-06, PL-FLT-14, PL-FLT-19, PL-COV-07, PL-CUV-06,
 * PL-OT-07, PL-AMB-36, PL-AMB-38, PL-AMB-37, PL-SEQ-08-09, PL-AMB-34 */
static void comparator_flags_wait_for_the_acknowledgement(void)
{
    bench_ready(3, NULL);
    sim_pl_set_cell(&b.pl, 1, 2, 2.5);
    sim_pl_set_cell(&b.pl, 3, 5, 4.3);
    sim_pl_set_ts_ratio(&b.pl, 2, 2, 0.32);
    bench_wait_ms(1500);
    bench_mark();
    scans(3, 50);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_UV, MODULE(1)->faults);
    TEST_ASSERT_EQUAL_HEX16(0x02, MODULE(1)->cell_uv);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_OVERTEMP, MODULE(2)->faults);
    TEST_ASSERT_EQUAL_HEX8(0x02, MODULE(2)->sensor_ot);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, MODULE(3)->faults);
    TEST_ASSERT_EQUAL_HEX16(0x10, MODULE(3)->cell_ov);
    for (uint32_t i = 0; i < b.packets; i++) { /* nothing is cleared unasked */
        TEST_ASSERT_FALSE(IS_WRITE(&b.log[i]) && (b.log[i].tx[1] == 0x20 || b.log[i].tx[1] == 0x21));
    }
    EXPECT_STATUS(BQ_OK, bench_acknowledge()); /* the causes remain: they return after the delay */
    bench_wait_ms(1500);
    scans(1, 0);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_UV, MODULE(1)->faults);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_OVERTEMP, MODULE(2)->faults);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, MODULE(3)->faults);
    sim_pl_set_cell(&b.pl, 1, 2, 3.6);
    sim_pl_set_cell(&b.pl, 3, 5, 3.6);
    sim_pl_set_ts_ratio(&b.pl, 2, 2, 0.1369);
    scans(1, 1500);
    bench_mark();
    EXPECT_STATUS(BQ_OK, bench_acknowledge());
    bench_judge_packets();
    for (uint32_t i = 0; i < b.packets; i++) { /* only the bits that were seen */
        const bench_packet *p = &b.log[i];
        if (IS_WRITE(p) && p->tx[1] == 0x21 && p->tx[2] != 0) {
            TEST_ASSERT_EQUAL_HEX8(p->tx[0] == W(1) ? 0x02 : 0x01, p->tx[2]);
        }
        if (IS_WRITE(p) && p->tx[1] == 0x20 && p->tx[2] != 0) {
            TEST_ASSERT_EQUAL_HEX8(W(2), p->tx[0]);
            TEST_ASSERT_EQUAL_HEX8(0x02, p->tx[2]);
        }
    }
    scans(1, 0);
    for (int d = 1; d <= 3; d++) {
        TEST_ASSERT_EQUAL_HEX16(0, MODULE(d)->faults);
    }
    TEST_ASSERT_FALSE(sim_pl_fault_pin(&b.pl));
    TEST_ASSERT_FALSE(sim_pl_alert_pin(&b.pl));
    bench_no_misuse();
}

/* proves: PL-SEQ-08-01, PL-AMB-01 */
static void flags_are_found_without_any_line(void)
{
    bench_up(3, NULL);
    b.no_lines = true;
    bench_ready_from();
    sim_pl_set_cell(&b.pl, 3, 1, 4.3);
    sim_pl_set_ts_ratio(&b.pl, 1, 1, 0.32);
    bench_wait_ms(1500);
    scans(1, 0);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, MODULE(3)->faults);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_OVERTEMP, MODULE(1)->faults);
}

static void bad_crc(int device)
{
    uint8_t tx[4] = {(uint8_t)W(device), 0x32, 0x00, 0x00}, rx[4];
    tx[3] = (uint8_t)(bench_crc(tx, 3) ^ 0x40u);
    sim_pl_spi(&b.pl, tx, rx, NULL, 4);
}

/* proves: PL-SEQ-08-03, PL-SEQ-08-04, PL-SEQ-06-08, PL-CRC-10, PL-AMB-02, PL-AMB-06 */
static void a_crc_flag_is_cleared_and_leaves_no_doubt(void)
{
    bench_ready(3, NULL);
    bad_crc(2);
    scans(3, 20);
    for (int d = 1; d <= 3; d++) {
        TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(d, 0x21));
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(d, 1)->quality);
        TEST_ASSERT_EQUAL_HEX16(0, MODULE(d)->faults);
    }
    TEST_ASSERT_TRUE(b.afe.ops->stats(b.afe.ctx)->write_errors > 0);
}

/* proves: PL-SEQ-06-08, PL-SEQ-00-03 */
static void a_damaged_start_is_repeated(void)
{
    for (int bit = 16; bit < 32; bit++) { /* data or CRC of the broadcast: every device flags it */
        bench_ready(3, NULL);
        sim_pl_set_cell(&b.pl, 2, 2, 3.3);
        sim_pl_bus_fault(&b.pl)->flip_mosi_bit = 1 + bit;
        EXPECT_STATUS(BQ_OK, bench_scan());
        bench_sample();
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(2, 2)->quality);
        TEST_ASSERT_EQUAL_UINT(3300, CELL(2, 2)->mv);
        TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(3, 0x21));
    }
}

/* proves: PL-AMB-07, PL-SEQ-08-04 */
static void a_truncated_write_is_repeated(void)
{
    bench_ready(3, NULL);
    sim_pl_set_cell(&b.pl, 3, 3, 3.2);
    sim_pl_bus_fault(&b.pl)->short_packets = 1; /* the conversion start loses its CRC */
    EXPECT_STATUS(BQ_OK, bench_scan());
    bench_sample();
    TEST_ASSERT_EQUAL_UINT(3200, CELL(3, 3)->mv);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(3, 3)->quality);
    TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(3, 0x21));
}

/* proves: PL-AMB-42, PL-AMB-41, PL-ELEC-14 */
static void a_flag_inside_the_hysteresis_is_no_defect(void)
{
    bench_ready(1, NULL);
    sim_pl_set_cell(&b.pl, 1, 1, 4.25);
    bench_wait_ms(1500);
    sim_pl_set_cell(&b.pl, 1, 1, 4.17); /* below the threshold, not released */
    scans(1, 0);
    bench_acknowledge();
    bench_wait_ms(1500);
    scans(1, 0);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, MODULE(1)->faults); /* back, and nothing but that */
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(1, 1)->quality);
    TEST_ASSERT_EQUAL_UINT(4170, CELL(1, 1)->mv);
    sim_pl_set_cell(&b.pl, 1, 1, 4.1);
    scans(1, 0);
    EXPECT_STATUS(BQ_OK, bench_acknowledge());
    bench_wait_ms(1500);
    scans(1, 0);
    TEST_ASSERT_EQUAL_HEX16(0, MODULE(1)->faults);
}

/* proves: PL-SEQ-08-05, PL-POR-10, PL-POR-11, PL-SEQ-13-05, PL-G3-07, PL-SEQ-13-01 */
static void an_unexpected_reset_is_reported_and_repaired(void)
{
    for (int device = 1; device <= 3; device++) {
        bench_ready(3, NULL);
        bench_raw_write(device, 0x3c, 0xa5);
        bench_wait_ms(5);
        bench_scan();
        bench_sample();
        bool seen = (MODULE(device)->faults & (BQ_F_RESET | BQ_F_COMM)) != 0;
        TEST_ASSERT_TRUE_MESSAGE(seen, bench_text("device %d", device));
        scans(4, 150);
        for (int d = 1; d <= 3; d++) {
            TEST_ASSERT_EQUAL_HEX8(0x80 | d, PEEK(d, 0x3b));
            TEST_ASSERT_EQUAL_HEX8(0x2c, PEEK(d, 0x42));
            TEST_ASSERT_EQUAL_HEX8(0x44, PEEK(d, 0x4b));
            TEST_ASSERT_EQUAL_HEX8(0x7d, PEEK(d, 0x30));
            TEST_ASSERT_EQUAL_HEX8(0x81, PEEK(d, 0x00));
            TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(d, 1)->quality);
        }
        bench_no_misuse();
    }
}

/* proves: PL-SEQ-08-08 */
static void a_stray_force_is_cleared(void)
{
    bench_ready(2, NULL);
    bench_raw_write(2, 0x21, 0x10);
    bench_raw_write(1, 0x20, 0x10);
    scans(2, 20);
    TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(2, 0x21));
    TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(1, 0x20));
    TEST_ASSERT_FALSE(sim_pl_fault_pin(&b.pl));
}

/* proves: PL-SEQ-08-07, PL-SEQ-15-01, PL-G3-09, PL-SEQ-03-02 */
static void parity_is_repaired(void)
{
    for (int r = 0x40; r <= 0x4b; r++) {
        if (r == 0x41) {
            continue;
        }
        bench_ready(2, NULL);
        sim_pl_damage_ram(&b.pl, 2, (uint8_t)r, 0x04);
        bench_wait_ms(1);
        scans(3, 50);
        TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(2, 0x20));
        TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(2, 0x24));
        TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(2, 0x25));
        TEST_ASSERT_EQUAL_HEX8(0x2c, PEEK(2, 0x42));
        TEST_ASSERT_EQUAL_HEX8(0x50, PEEK(2, 0x40));
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(2, 1)->quality);
        bench_no_misuse();
    }
}

/* proves: PL-SEQ-15-02, PL-ECC-05, PL-FLT-18, PL-AMB-49 */
static void an_uncorrectable_eprom_makes_a_device_defective(void)
{
    for (int option = 0; option <= 1; option++) {
        const sim_pl_options o = {.amb49_no_ifault = option != 0};
        bench_up(3, &o);
        sim_pl_damage_otp(&b.pl, 2, 0x45, 0x03);
        bench_power_cycle();
        bench_wait_ms(60);
        bench_init();
        (void)bench_start();
        scans(4, 150);
        TEST_ASSERT_EQUAL_HEX16(BQ_F_DEFECTIVE, MODULE(2)->faults & BQ_F_DEFECTIVE);
        for (int c = 1; c <= 6; c++) {
            TEST_ASSERT_EQUAL_HEX8(0, CELL(2, c)->quality & BQ_Q_VALID); /* a link only */
            TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(1, c)->quality);
            TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(3, c)->quality);
        }
        TEST_ASSERT_TRUE(bench_balance(2, 0x01) != BQ_OK || sim_pl_cb(&b.pl, 2) == 0);
        TEST_ASSERT_EQUAL_HEX8(0, sim_pl_cb(&b.pl, 2));
    }
}

/* proves: PL-ECC-06, PL-AMB-48, PL-AMB-50, PL-SEQ-03-02 */
static void a_corrected_eprom_is_reported_and_usable(void)
{
    bench_up(2, NULL);
    sim_pl_damage_otp(&b.pl, 2, 0x48, 0x01);
    bench_power_cycle();
    bench_wait_ms(60);
    bench_init();
    EXPECT_STATUS(BQ_OK, bench_start());
    scans(1, 0);
    TEST_ASSERT_EQUAL_UINT(2, bq76pl536_diagnose(&b.driver)->ecc_corrected);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(2, 1)->quality);
}

/* proves: PL-SEQ-15-03, PL-TSD-03, PL-TSD-04, PL-AMB-91, PL-AMB-52, PL-SEQ-10-07 */
static void heat_is_reported_and_survived(void)
{
    bench_ready(3, NULL);
    EXPECT_STATUS(BQ_OK, bench_balance(1, 0x01));
    sim_pl_set_tdie(&b.pl, 2, 150);
    bench_wait_ms(10);
    scans(2, 20);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_DIE_TEMP, MODULE(2)->faults & BQ_F_DIE_TEMP);
    TEST_ASSERT_EQUAL_HEX8(0, CELL(2, 1)->quality & BQ_Q_VALID);
    TEST_ASSERT_EQUAL_HEX8(0, b.temps[2].quality & BQ_Q_VALID);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(3, 1)->quality);
    bench_balance(2, 0x3f);
    TEST_ASSERT_EQUAL_HEX8(0, sim_pl_cb(&b.pl, 2));
    scans(5, 900);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_DIE_TEMP, MODULE(2)->faults & BQ_F_DIE_TEMP);
    sim_pl_set_tdie(&b.pl, 2, 40);
    scans(6, 900);
    TEST_ASSERT_EQUAL_HEX16(0, MODULE(2)->faults);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(2, 1)->quality);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, b.temps[2].quality);
    TEST_ASSERT_EQUAL_INT(SIM_PL_ACTIVE, sim_pl_get_mode(&b.pl, 2));
    TEST_ASSERT_EQUAL_HEX8(0x03, PEEK(2, 0x31));
    TEST_ASSERT_EQUAL_HEX8(0x81, PEEK(2, 0x00));
}

/* proves: PL-SEQ-08-07, PL-AMB-51 */
static void a_device_that_fell_asleep_is_woken(void)
{
    bench_ready(3, NULL);
    bench_raw_write(2, 0x31, 0x04);
    bench_wait_ms(1);
    sim_pl_set_cell(&b.pl, 2, 1, 3.3);
    bench_scan();
    bench_sample();
    TEST_ASSERT_TRUE((CELL(2, 1)->quality & BQ_Q_VALID) == 0 || CELL(2, 1)->mv == 3300);
    scans(4, 1100);
    TEST_ASSERT_EQUAL_INT(SIM_PL_ACTIVE, sim_pl_get_mode(&b.pl, 2));
    TEST_ASSERT_EQUAL_HEX8(0x03, PEEK(2, 0x31));
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(2, 1)->quality);
    TEST_ASSERT_EQUAL_UINT(3300, CELL(2, 1)->mv);
    TEST_ASSERT_FALSE(sim_pl_alert_pin(&b.pl));
}

/* proves: PL-SEQ-09-01, PL-SEQ-09-02, PL-SEQ-09-03, PL-SEQ-09-04, PL-SEQ-09-05, PL-SEQ-09-06, PL-FLT-17 */
static void self_test_forces_the_top_device(void)
{
    bench_ready(4, NULL);
    bench_mark();
    EXPECT_STATUS(BQ_OK, bench_self_test());
    for (int reg = 0x20; reg <= 0x21; reg++) {
        int forced = -1;
        for (uint32_t i = 0; i < b.packets; i++) {
            const bench_packet *p = &b.log[i];
            if (IS_WRITE(p) && p->tx[1] == reg && p->tx[2] == 0x10) {
                TEST_ASSERT_EQUAL_HEX8(W(4), p->tx[0]);
                forced = (int)i;
            }
        }
        TEST_ASSERT_TRUE(forced >= 0);
        TEST_ASSERT_TRUE(bench_find(forced, RD(4), -1) > forced); /* read back */
        for (int d = 1; d <= 3; d++) {
            TEST_ASSERT_TRUE(bench_find(forced, RD(d), -1) > forced); /* the others are silent */
        }
        TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(4, (uint8_t)reg));
    }
    TEST_ASSERT_FALSE(bq76pl536_diagnose(&b.driver)->chain_skipped);
    bench_no_misuse();
    bench_judge_packets();
}

/* proves: PL-SEQ-09-04, PL-SEQ-03-11, PL-SEQ-08-09, PL-SEQ-09-01, PL-SEQ-01-03 */
static void stuck_lines_are_named(void)
{
    for (int alert = 0; alert <= 1; alert++) {
        bench_up(3, NULL);
        b.stuck_alert = alert != 0;
        b.stuck_fault = alert == 0;
        bench_init();
        (void)bench_start();
        const bq76pl536_diagnosis *g = bq76pl536_diagnose(&b.driver);
        TEST_ASSERT_EQUAL_INT(alert, g->alert_line_stuck);
        TEST_ASSERT_EQUAL_INT(!alert, g->fault_line_stuck);
        scans(1, 0);
        uint16_t any = 0;
        for (int d = 1; d <= 3; d++) {
            any = any | MODULE(d)->faults;
            TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(d, 1)->quality);
        }
        TEST_ASSERT_EQUAL_HEX16(BQ_F_CHAIN, any & BQ_F_CHAIN);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(comparator_flags_wait_for_the_acknowledgement);
    RUN_TEST(flags_are_found_without_any_line);
    RUN_TEST(a_crc_flag_is_cleared_and_leaves_no_doubt);
    RUN_TEST(a_damaged_start_is_repeated);
    RUN_TEST(a_truncated_write_is_repeated);
    RUN_TEST(a_flag_inside_the_hysteresis_is_no_defect);
    RUN_TEST(an_unexpected_reset_is_reported_and_repaired);
    RUN_TEST(a_stray_force_is_cleared);
    RUN_TEST(parity_is_repaired);
    RUN_TEST(an_uncorrectable_eprom_makes_a_device_defective);
    RUN_TEST(a_corrected_eprom_is_reported_and_usable);
    RUN_TEST(heat_is_reported_and_survived);
    RUN_TEST(a_device_that_fell_asleep_is_woken);
    RUN_TEST(self_test_forces_the_top_device);
    RUN_TEST(stuck_lines_are_named);
    return UNITY_END();
}
