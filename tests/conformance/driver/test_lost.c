/* SPDX-License-Identifier: Apache-2.0 */
/* A device lost in the middle of the stack: PL-SEQ-13; stacks that end early, and discovery under damage. */
#include "bench.h"

static void expect_valid(int devices, unsigned mask)
{
    bench_sample();
    for (int d = 1; d <= devices; d++) {
        bool want = (mask >> (d - 1) & 1u) != 0;
        TEST_ASSERT_EQUAL_INT_MESSAGE(want, (CELL(d, 1)->quality & BQ_Q_VALID) != 0,
                                      bench_text("device %d", d));
        TEST_ASSERT_EQUAL_INT_MESSAGE(want, (CELL(d, 6)->quality & BQ_Q_VALID) != 0,
                                      bench_text("device %d", d));
    }
}

static bool recovered(int devices)
{
    for (int i = 0; i < 10; i++) {
        bench_wait_ms(100);
        if (bench_scan() != BQ_OK) {
            continue;
        }
        bench_sample();
        bool all = true;
        for (int d = 1; d <= devices; d++) {
            all = all && CELL(d, 1)->quality == BQ_Q_VALID && MODULE(d)->faults == 0;
        }
        if (all) {
            return true;
        }
    }
    return false;
}

static void expect_configured(int devices)
{
    for (int d = 1; d <= devices; d++) {
        TEST_ASSERT_EQUAL_HEX8(0x80 | d, PEEK(d, 0x3b));
        TEST_ASSERT_EQUAL_HEX8(0x50, PEEK(d, 0x40));
        TEST_ASSERT_EQUAL_HEX8(0x2c, PEEK(d, 0x42));
        TEST_ASSERT_EQUAL_HEX8(0x85, PEEK(d, 0x45));
        TEST_ASSERT_EQUAL_HEX8(0x44, PEEK(d, 0x4b));
        TEST_ASSERT_EQUAL_HEX8(0x7d, PEEK(d, 0x30));
        TEST_ASSERT_EQUAL_HEX8(0x03, PEEK(d, 0x31));
        TEST_ASSERT_EQUAL_HEX8(0x81, PEEK(d, 0x00));
    }
}

/* proves: PL-SEQ-13-01, PL-SEQ-13-02, PL-SEQ-13-03, PL-SEQ-13-04, PL-SEQ-13-05, PL-SEQ-13-06, PL-SEQ-13-07,
 * PL-SEQ-13-08, PL-ADR-09, PL-ADR-10, PL-POR-10, PL-ADR-08 */
static void one_device_in_the_middle_comes_back(void)
{
    for (int k = 1; k <= 5; k++) {
        bench_ready(5, NULL);
        sim_pl_set_supply(&b.pl, k, false);
        bench_wait_ms(1);
        for (int i = 0; i < 4; i++) {
            bench_scan();
            expect_valid(5, (1u << (k - 1)) - 1u);
            for (int d = k; d <= 5; d++) {
                TEST_ASSERT_EQUAL_HEX16(BQ_F_COMM, MODULE(d)->faults & BQ_F_COMM);
            }
            bench_wait_ms(100);
        }
        sim_pl_set_supply(&b.pl, k, true);
        bench_wait_ms(130);
        bench_mark();
        TEST_ASSERT_TRUE_MESSAGE(recovered(5), bench_text("device %d", k));
        expect_configured(5);
        TEST_ASSERT_EQUAL_INT(0, bench_count(0x7f, 0x3c)); /* no reset of those that kept everything */
        TEST_ASSERT_TRUE(b.afe.ops->stats(b.afe.ctx)->recoveries > 0);
        bench_no_misuse();
        bench_judge_packets();
    }
}

/* proves: PL-SEQ-13-06, PL-SEQ-13-07, PL-SEQ-13-05 */
static void any_set_of_devices_comes_back(void)
{
    for (unsigned mask = 1; mask < 16; mask++) {
        bench_ready(4, NULL);
        for (int d = 1; d <= 4; d++) {
            sim_pl_set_supply(&b.pl, d, (mask >> (d - 1) & 1u) == 0);
        }
        bench_wait_ms(30);
        bench_scan();
        for (int d = 1; d <= 4; d++) {
            sim_pl_set_supply(&b.pl, d, true);
        }
        bench_wait_ms(200);
        if (!recovered(4)) {
            EXPECT_STATUS(BQ_OK, bench_start());
            TEST_ASSERT_TRUE_MESSAGE(recovered(4), bench_text("mask %x", mask));
        }
        expect_configured(4);
        bench_no_misuse();
    }
}

/* proves: PL-SEQ-13-04, PL-ADR-15, PL-AMB-15, PL-AMB-30 */
static void recovery_under_lost_packets_never_doubles_an_address(void)
{
    for (uint32_t n = 1; n < 90; n++) {
        bench_ready(4, NULL);
        bench_raw_write(2, 0x3c, 0xa5);
        bench_wait_ms(2);
        bench_mark();
        b.lose = n;
        for (int i = 0; i < 3; i++) {
            bench_scan();
            bench_wait_ms(120);
        }
        TEST_ASSERT_TRUE_MESSAGE(recovered(4), bench_text("packet %u", n));
        expect_configured(4);
        TEST_ASSERT_EQUAL_INT(0, sim_misuse_of(sim_pl_misuse(&b.pl), "PL-AMB-15"));
    }
}

/* proves: PL-SEQ-13-03, PL-SEQ-02-06, PL-ADR-14 */
static void a_stack_that_ends_early(void)
{
    for (int real = 1; real <= 4; real++) {
        for (int partial = 0; partial <= 1; partial++) {
            bench_up(4, NULL);
            b.config.allow_partial = partial != 0;
            if (real < 4) {
                sim_pl_set_link(&b.pl, real, true);
            }
            bench_init();
            bq_status status = bench_start();
            EXPECT_STATUS(real == 4 || partial ? BQ_OK : BQ_E_NOT_FOUND, status);
            TEST_ASSERT_EQUAL_UINT(real == 4 ? 0 : real + 1, bq76pl536_diagnose(&b.driver)->broken_hop);
            if (status == BQ_OK) {
                EXPECT_STATUS(BQ_OK, bench_scan());
                expect_valid(4, (1u << real) - 1u);
            } else {
                EXPECT_STATUS(BQ_E_STATE, b.afe.ops->scan(b.afe.ctx));
            }
        }
    }
}

/* proves: PL-ADR-11, PL-ADR-13, PL-ADR-15, PL-SEQ-02-02 */
static void stale_addresses_anywhere_are_cured(void)
{
    for (unsigned seed = 1; seed <= 40; seed++) {
        unsigned r = seed * 2654435761u;
        bench_up(5, NULL);
        for (int d = 1; d <= 5; d++) { /* addresses out of order, twice, missing */
            r = r * 1664525u + 1013904223u;
            bench_raw_write(0, 0x3b, 1 + (int)(r >> 24) % 6);
            if ((r >> 20 & 7u) == 0) {
                sim_pl_set_supply(&b.pl, d, false);
                bench_wait_ms(1);
                sim_pl_set_supply(&b.pl, d, true);
            }
        }
        bench_wait_ms(100);
        sim_misuse_clear(sim_pl_misuse(&b.pl));
        bench_init();
        EXPECT_STATUS(BQ_OK, bench_start());
        EXPECT_STATUS(BQ_OK, bench_scan());
        expect_valid(5, 0x1f);
        expect_configured(5);
    }
}

/* proves: PL-SEQ-02-06, PL-CRC-09 */
static void one_part_with_crc_off_in_its_eprom_is_named(void)
{
    for (int device = 1; device <= 3; device++) {
        bench_up(3, NULL);
        sim_pl_set_otp(&b.pl, device, 0x41, 0x01);
        bench_power_cycle();
        bench_wait_ms(60);
        bench_init();
        bq_status status = bench_start();
        if (status == BQ_OK) {
            TEST_ASSERT_TRUE(recovered(3));
            TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(device, 0x41));
        } else {
            TEST_ASSERT_TRUE_MESSAGE(status == BQ_E_CRC_OFF || status == BQ_E_NOT_FOUND,
                                     bq_status_name(status));
            TEST_ASSERT_EQUAL_UINT(device, bq76pl536_diagnose(&b.driver)->broken_hop);
        }
    }
}

/* proves: PL-SEQ-13-09, PL-AMB-16, PL-CRC-08, PL-CRC-09 */
static void a_link_without_crc_survives_the_reset_of_one_device(void)
{
    for (int device = 1; device <= 3; device++) {
        bench_up(3, NULL);
        b.config.crc_off = true;
        bench_init();
        EXPECT_STATUS(BQ_OK, bench_start());
        EXPECT_STATUS(BQ_OK, bench_scan());
        expect_valid(3, 7);
        for (int d = 1; d <= 3; d++) {
            TEST_ASSERT_EQUAL_HEX8(0x01, PEEK(d, 0x41));
        }
        sim_pl_set_supply(&b.pl, device, false);
        bench_wait_ms(1);
        bench_scan();
        expect_valid(3, (1u << (device - 1)) - 1u);
        sim_pl_set_supply(&b.pl, device, true);
        bench_wait_ms(200);
        if (!recovered(3)) {
            EXPECT_STATUS(BQ_OK, bench_start());
            TEST_ASSERT_TRUE_MESSAGE(recovered(3), bench_text("device %d", device));
        }
        TEST_ASSERT_EQUAL_HEX8(0x01, PEEK(device, 0x41));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(one_device_in_the_middle_comes_back);
    RUN_TEST(any_set_of_devices_comes_back);
    RUN_TEST(recovery_under_lost_packets_never_doubles_an_address);
    RUN_TEST(a_stack_that_ends_early);
    RUN_TEST(stale_addresses_anywhere_are_cured);
    RUN_TEST(one_part_with_crc_off_in_its_eprom_is_named);
    RUN_TEST(a_link_without_crc_survives_the_reset_of_one_device);
    return UNITY_END();
}
