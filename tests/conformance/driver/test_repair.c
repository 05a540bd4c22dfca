/* SPDX-License-Identifier: Apache-2.0 */
/* What the service of one device may and may not touch, and repairs that succeed: PL-SEQ-08, PL-SEQ-15. */
#include "bench.h"

static void scans(int n, uint32_t pause_ms)
{
    for (int i = 0; i < n; i++) {
        (void)bench_scan();
        bench_wait_ms(pause_ms);
    }
    bench_sample();
}

/* The EPROM was read wrongly once: after one RESET the device is as good as before. */
/* proves: PL-SEQ-15-02, PL-SEQ-15-01 */
static void an_eprom_error_that_a_reset_cures(void)
{
    uint16_t seen = 0;
    bench_ready(3, NULL);
    sim_pl_damage_otp(&b.pl, 2, 0x45, 0x03);
    bench_raw_write(2, 0x3a, 0x27);
    TEST_ASSERT_EQUAL_HEX8(0x20, PEEK(2, 0x20) & 0x20);
    TEST_ASSERT_EQUAL_HEX8(0x20, PEEK(2, 0x21) & 0x20);
    sim_pl_set_otp(&b.pl, 2, 0x45, 0x00);
    bench_mark();
    for (int i = 0; i < 8; i++) {
        scans(1, 150);
        seen |= MODULE(2)->faults;
    }
    TEST_ASSERT_EQUAL_HEX16(0, seen & BQ_F_DEFECTIVE);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_MEMORY, seen & BQ_F_MEMORY);
    TEST_ASSERT_EQUAL_INT(1, bench_count(W(2), 0x3c));
    TEST_ASSERT_EQUAL_INT(0, bench_count(W(1), 0x3c) + bench_count(W(3), 0x3c));
    for (int d = 1; d <= 3; d++) {
        TEST_ASSERT_EQUAL_HEX8(0x80 | d, PEEK(d, 0x3b));
        TEST_ASSERT_EQUAL_HEX8(0x85, PEEK(d, 0x45));
        TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(d, 0x20));
        TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(d, 0x21));
        TEST_ASSERT_EQUAL_HEX16(0, MODULE(d)->faults);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(d, 1)->quality);
    }
    bench_no_misuse();
}

/* Heat in one device ends the balancing of all, and nothing else is written to CB_CTRL. */
/* proves: PL-SEQ-15-03 */
static void heat_ends_all_balancing(void)
{
    int off = 0;
    bench_ready(3, NULL);
    EXPECT_STATUS(BQ_OK, bench_balance(1, 0x15));
    sim_pl_set_tdie(&b.pl, 2, 150);
    bench_wait_ms(10);
    bench_mark();
    scans(3, 20);
    for (uint32_t i = 0; i < b.packets; i++) {
        if (IS_WRITE(&b.log[i]) && b.log[i].tx[1] == 0x32) {
            TEST_ASSERT_EQUAL_HEX8(0x00, b.log[i].tx[2]);
            off += b.log[i].tx[0] == BROADCAST;
        }
    }
    TEST_ASSERT_TRUE(off > 0);
    for (int d = 1; d <= 3; d++) {
        TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_cb(&b.pl, d));
    }
}

/* A stray FORCE is cleared alone: what the comparators latched beside it waits for the acknowledgement. */
/* proves: PL-SEQ-08-08, PL-SEQ-08-06 */
static void clearing_force_leaves_the_comparators(void)
{
    bench_ready(2, NULL);
    sim_pl_set_cell(&b.pl, 1, 2, 4.3);
    sim_pl_set_cell(&b.pl, 2, 2, 2.6);
    sim_pl_set_ts_ratio(&b.pl, 1, 1, 0.32);
    sim_pl_set_ts_ratio(&b.pl, 2, 2, 0.32);
    bench_wait_ms(1500);
    for (int d = 1; d <= 2; d++) { /* the causes are gone, the flags are latched */
        sim_pl_set_cell(&b.pl, d, 2, 3.6);
        sim_pl_set_ts_ratio(&b.pl, d, d, 0.1369);
        bench_raw_write(d, 0x21, 0x10);
        bench_raw_write(d, 0x20, 0x10);
    }
    scans(2, 20);
    TEST_ASSERT_EQUAL_HEX8(0x01, PEEK(1, 0x21));
    TEST_ASSERT_EQUAL_HEX8(0x02, PEEK(2, 0x21));
    TEST_ASSERT_EQUAL_HEX8(0x01, PEEK(1, 0x20));
    TEST_ASSERT_EQUAL_HEX8(0x02, PEEK(2, 0x20));
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV | BQ_F_OVERTEMP, MODULE(1)->faults & (BQ_F_CELL_OV | BQ_F_OVERTEMP));
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_UV | BQ_F_OVERTEMP, MODULE(2)->faults & (BQ_F_CELL_UV | BQ_F_OVERTEMP));
    EXPECT_STATUS(BQ_OK, bench_acknowledge());
    scans(1, 0);
    TEST_ASSERT_EQUAL_HEX16(0, MODULE(1)->faults | MODULE(2)->faults);
    bench_no_misuse();
}

/* The thermistors of a device that was shut down need their time again. */
/* proves: PL-SEQ-15-03 */
static void sensors_settle_after_heat(void)
{
    uint64_t cooled = 0, valid = 0;
    bench_up(2, NULL);
    b.config.sensor_settle_ms = 400;
    bench_ready_from();
    bench_wait_ms(1000);
    scans(1, 0);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, b.temps[2].quality);
    sim_pl_set_tdie(&b.pl, 2, 150);
    bench_wait_ms(10);
    scans(2, 20);
    TEST_ASSERT_EQUAL_HEX8(0, b.temps[2].quality & BQ_Q_VALID);
    sim_pl_set_tdie(&b.pl, 2, 40);
    for (int i = 0; i < 200 && valid == 0; i++) {
        scans(1, 20);
        cooled = cooled == 0 && sim_pl_get_mode(&b.pl, 2) == SIM_PL_ACTIVE ? sim_pl_now(&b.pl) : cooled;
        valid = (b.temps[2].quality & BQ_Q_VALID) != 0 ? sim_pl_now(&b.pl) : 0;
    }
    TEST_ASSERT_TRUE(cooled != 0 && valid != 0);
    TEST_ASSERT_TRUE(valid - cooled >= 380 * SIM_PL_MS); /* seen one pause of 20 ms late */
    TEST_ASSERT_TRUE(valid - cooled <= 600 * SIM_PL_MS);
}

/* Reads of the flags of device 1 come to nothing; everything else works. */
static bool no_flags(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    (void)ctx;
    if (tx[0] != RD(1) || tx[1] != 0x20) {
        return false;
    }
    memset(rx, 0, n);
    return true;
}

/* A device that says FAULT or ALERT and does not say why is not believed, and is again once it does. */
/* proves: PL-SEQ-06-08, PL-SEQ-08-02 */
static void flags_that_cannot_be_read_leave_no_valid_reading(void)
{
    bench_ready(2, NULL);
    sim_pl_set_cell(&b.pl, 1, 5, 4.3);
    bench_wait_ms(1500);
    sim_pl_bus_fault(&b.pl)->hook = no_flags;
    (void)bench_scan();
    bench_sample();
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_COMM, CELL(1, 1)->quality);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_COMM, MODULE(1)->faults & BQ_F_COMM);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(2, 1)->quality);
    TEST_ASSERT_EQUAL_HEX16(0, MODULE(2)->faults);
    sim_pl_bus_fault(&b.pl)->hook = NULL;
    scans(2, 150);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(1, 1)->quality);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, MODULE(1)->faults);
}

/* Parity: the shadow registers come from the EPROM first, then from the driver; a comparator's flag beside it
 * is told in the same scan. */
/* proves: PL-SEQ-15-01, PL-SEQ-08-03 */
static void parity_begins_with_a_refresh(void)
{
    int refresh, key;
    bench_ready(2, NULL);
    sim_pl_set_cell(&b.pl, 2, 1, 4.3);
    bench_wait_ms(1500);
    sim_pl_damage_ram(&b.pl, 2, 0x43, 0x04);
    bench_mark();
    scans(1, 0);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, MODULE(2)->faults & BQ_F_CELL_OV);
    refresh = bench_find(0, W(2), 0x3a);
    TEST_ASSERT_TRUE(refresh >= 0);
    TEST_ASSERT_EQUAL_HEX8(0x27, b.log[refresh].tx[2]);
    key = bench_find(refresh + 1, W(2), 0x3a);
    TEST_ASSERT_TRUE(key > refresh);
    TEST_ASSERT_EQUAL_HEX8(0x35, b.log[key].tx[2]);
    TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(2, 0x25) | PEEK(2, 0x24));
    bench_no_misuse();
}

static uint8_t claimed; /* what device 1 claims of ALERT_STATUS and FAULT_STATUS besides the truth */
static bool in_fault;

static bool claim(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    uint8_t all[24];
    (void)ctx;
    if (tx[0] != RD(1) || tx[1] != 0x20 || claimed == 0) {
        return false;
    }
    memcpy(all, tx, 3);
    for (uint32_t i = 3; i + 1 < n; i++) {
        all[i] = (uint8_t)PEEK(1, (uint8_t)(0x20 + (int)i - 3));
    }
    all[in_fault ? 4 : 3] |= claimed;
    all[n - 1] = bench_crc(all, n - 1);
    memset(rx, 0, 3);
    memcpy(rx + 3, all + 3, n - 3);
    claimed = 0; /* once */
    return true;
}

/* A device that says that it was reset is configured again in the same scan, also where it still has its
 * address. */
/* proves: PL-SEQ-08-05 */
static void a_reset_that_is_only_told_is_believed(void)
{
    for (int fault = 0; fault <= 1; fault++) {
        bench_ready(2, NULL);
        sim_pl_set_ts_ratio(&b.pl, 1, 1, 0.32); /* makes the driver look */
        bench_wait_ms(1500);
        bench_raw_write(1, 0x3a, 0x35);
        bench_raw_write(1, 0x42, 0x3c);
        TEST_ASSERT_EQUAL_HEX8(0x3c, PEEK(1, 0x42));
        claimed = fault ? 0x08 : 0x80; /* POR, AR */
        in_fault = fault != 0;
        sim_pl_bus_fault(&b.pl)->hook = claim;
        scans(1, 0);
        sim_pl_bus_fault(&b.pl)->hook = NULL;
        TEST_ASSERT_EQUAL_HEX8(0, claimed);
        TEST_ASSERT_EQUAL_HEX16(BQ_F_RESET, MODULE(1)->faults & BQ_F_RESET);
        TEST_ASSERT_EQUAL_HEX8(0, CELL(1, 1)->quality & BQ_Q_VALID);
        TEST_ASSERT_EQUAL_HEX8(0x2c, PEEK(1, 0x42));
    }
}

/* proves: PL-SEQ-15-03 */
static void heat_is_polled_once_a_second(void)
{
    int tries = 0;
    bench_ready(2, NULL);
    sim_pl_set_tdie(&b.pl, 2, 150);
    bench_wait_ms(10);
    scans(1, 100);
    bench_mark();
    scans(100, 95);
    TEST_ASSERT_TRUE(b.packets < BENCH_LOG);
    for (uint32_t i = 0; i < b.packets; i++) {
        tries += b.log[i].tx[0] == W(2) && b.log[i].tx[1] == 0x20 && (b.log[i].tx[2] & 0x08) != 0;
    }
    TEST_ASSERT_TRUE_MESSAGE(tries >= 8 && tries <= 24, bench_text("%d in 10 s", tries)); /* two a try */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(an_eprom_error_that_a_reset_cures);
    RUN_TEST(heat_ends_all_balancing);
    RUN_TEST(clearing_force_leaves_the_comparators);
    RUN_TEST(sensors_settle_after_heat);
    RUN_TEST(flags_that_cannot_be_read_leave_no_valid_reading);
    RUN_TEST(parity_begins_with_a_refresh);
    RUN_TEST(a_reset_that_is_only_told_is_believed);
    RUN_TEST(heat_is_polled_once_a_second);
    return UNITY_END();
}
