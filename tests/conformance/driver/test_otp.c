/* SPDX-License-Identifier: Apache-2.0 */
/* EPROM programming: PL-SEQ-12. */
#include "bench.h"

static const uint8_t image[12] = {0x50, 0x00, 0x2c, 0x85, 0x15, 0x85, 0x55, 0x64, 0x5a, 0xa5, 0x0f, 0xf0};

static void ready(void)
{
    bench_up(3, NULL);
    b.vpp_device = 2;
    bench_ready_from();
    bench_mark();
}

static bq_status program(void)
{
    return bench_run(bq76pl536_program_otp(&b.driver, 2, image, BQ76PL536_OTP_GUARD));
}

static void expect_blank(void)
{
    for (int d = 1; d <= 3; d++) {
        for (int r = 0x40; r <= 0x4b; r++) {
            TEST_ASSERT_EQUAL_HEX8(0, sim_pl_otp(&b.pl, d, (uint8_t)r));
        }
    }
    TEST_ASSERT_FALSE(sim_pl_vpp(&b.pl, 2));
}

/* proves: PL-SEQ-12-02, PL-SEQ-12-03, PL-SEQ-12-04, PL-SEQ-12-05, PL-SEQ-12-06, PL-SEQ-12-07, PL-SEQ-12-08,
 * PL-OTP-06, PL-OTP-07, PL-TIM-26, PL-AMB-103, PL-AMB-104, PL-AMB-105, PL-OTP-08, PL-VEC-32, PL-SPI-14,
 * PL-G3-06, PL-AMB-110, PL-OTP-02, PL-AMB-102 */
static void a_part_is_programmed(void)
{
    ready();
    EXPECT_STATUS(BQ_OK, program());
    for (int i = 0; i < 12; i++) {
        TEST_ASSERT_EQUAL_HEX8(image[i], sim_pl_otp(&b.pl, 2, (uint8_t)(0x40 + i)));
        TEST_ASSERT_EQUAL_HEX8(0, sim_pl_otp(&b.pl, 1, (uint8_t)(0x40 + i)));
    }
    TEST_ASSERT_FALSE(sim_pl_vpp(&b.pl, 2));
    TEST_ASSERT_TRUE(b.vpp_longest_us >= 2000 && b.vpp_longest_us <= 5000);
    TEST_ASSERT_EQUAL_UINT(0, b.under_vpp);
    int burn = bench_find(0, W(2), 0x3f);
    TEST_ASSERT_TRUE(burn > 0);
    TEST_ASSERT_EQUAL_HEX8(0x91, b.log[burn].tx[2]);
    TEST_ASSERT_EQUAL_INT(1, bench_count(W(2), 0x3f));
    TEST_ASSERT_TRUE(b.log[burn + 1].t_us - b.log[burn].t_us >= 2500); /* silence */
    int refresh = -1, last = -1;
    for (int i = 0; i < burn; i++) {
        refresh = b.log[i].tx[0] == W(2) && b.log[i].tx[1] == 0x3a && b.log[i].tx[2] == 0x27 && refresh < 0
                      ? i
                      : refresh;
        last = b.log[i].tx[0] == RD(2) && b.log[i].tx[1] == 0x40 && b.log[i].tx[2] == 12 ? i : last;
    }
    TEST_ASSERT_TRUE(refresh >= 0 && bench_find(refresh, RD(2), 0x40) > refresh); /* proven blank */
    TEST_ASSERT_TRUE(last >= 0 && memcmp(b.log[last].rx + 3, image, 12) == 0);    /* proven loaded */
    bench_no_misuse();
    bench_judge_packets();
    bench_power_cycle();
    bench_wait_ms(60);
    TEST_ASSERT_EQUAL_HEX8(0xf0, PEEK(2, 0x4b));
}

/* proves: PL-SEQ-12-01, PL-OTP-09, PL-ELEC-12, PL-ELEC-04, PL-NUM-16, PL-OTP-03 */
static void guards(void)
{
    uint8_t bad[12];
    ready();
    EXPECT_STATUS(BQ_E_ARG, bq76pl536_program_otp(&b.driver, 2, image, 0));
    EXPECT_STATUS(BQ_E_ARG, bq76pl536_program_otp(&b.driver, 0, image, BQ76PL536_OTP_GUARD));
    EXPECT_STATUS(BQ_E_ARG, bq76pl536_program_otp(&b.driver, 4, image, BQ76PL536_OTP_GUARD));
    EXPECT_STATUS(BQ_E_ARG, bq76pl536_program_otp(&b.driver, 0x3f, image, BQ76PL536_OTP_GUARD));
    EXPECT_STATUS(BQ_E_ARG, bq76pl536_program_otp(&b.driver, 2, NULL, BQ76PL536_OTP_GUARD));
    static const struct {
        uint8_t index, value;
    } v[] = {{0, 0x51}, {1, 0x02}, {1, 0x01}, {2, 0x3d}, {2, 0x40}, {3, 0x20},
             {3, 0x00}, {4, 0x1b}, {5, 0x80}, {6, 0xc0}, {7, 0x00}};
    for (size_t i = 0; i < sizeof v / sizeof v[0]; i++) {
        memcpy(bad, image, sizeof bad);
        bad[v[i].index] = v[i].value;
        TEST_ASSERT_TRUE_MESSAGE(bq76pl536_program_otp(&b.driver, 2, bad, BQ76PL536_OTP_GUARD) < 0,
                                 bench_text("byte %u = %02x", v[i].index, v[i].value));
    }
    memcpy(bad, image, sizeof bad);
    bad[2] = 0x1f;
    bad[4] = 0x1a;
    EXPECT_STATUS(BQ_E_COV_CUV, bq76pl536_program_otp(&b.driver, 2, bad, BQ76PL536_OTP_GUARD));
    TEST_ASSERT_EQUAL_UINT(0, b.packets);
    sim_pl_set_vbat(&b.pl, 2, 19.5);
    EXPECT_STATUS(BQ_E_VOLTAGE, program());
    TEST_ASSERT_EQUAL_INT(0, bench_count(W(2), 0x3f));
    expect_blank();
    bench_no_misuse();
}

/* proves: PL-SEQ-12-04, PL-SEQ-12-06 */
static void no_voltage_no_programming(void)
{
    ready();
    b.vpp_fails = true;
    TEST_ASSERT_TRUE(program() != BQ_OK);
    TEST_ASSERT_EQUAL_INT(0, bench_count(W(2), 0x3f));
    expect_blank();
}

/* proves: PL-SEQ-12-02, PL-AMB-111, PL-OTP-12 */
static void a_part_that_is_not_blank_is_refused(void)
{
    for (int r = 0x40; r <= 0x4b; r++) {
        if (r == 0x41) {
            continue;
        }
        bench_up(3, NULL);
        b.vpp_device = 2;
        sim_pl_set_otp(&b.pl, 2, (uint8_t)r, 0x01 << 2);
        bench_power_cycle();
        bench_wait_ms(60);
        bench_ready_from();
        bench_mark();
        EXPECT_STATUS(BQ_E_NOT_BLANK, program());
        TEST_ASSERT_EQUAL_INT(0, bench_count(W(2), 0x3f));
        TEST_ASSERT_EQUAL_UINT(0, b.vpp_longest_us);
    }
    ready();
    EXPECT_STATUS(BQ_OK, program());
    bench_wait_ms(200);
    (void)bench_scan();
    bench_mark();
    TEST_ASSERT_TRUE(program() != BQ_OK);
    TEST_ASSERT_EQUAL_INT(0, bench_count(W(2), 0x3f));
}

/* proves: PL-SEQ-12-09, PL-SEQ-12-06, PL-SEQ-12-03 */
static void every_lost_packet_ends_without_voltage_and_at_most_one_run(void)
{
    ready();
    EXPECT_STATUS(BQ_OK, program());
    uint32_t total = b.transfers;
    for (uint32_t n = 1; n <= total; n++) {
        for (int kind = 0; kind < 3; kind++) {
            ready();
            b.lose = kind == 0 ? n : 0;
            b.refuse = kind == 1 ? n : 0;
            b.fail_after = kind == 2 ? n : 0;
            bq_status status = program();
            TEST_ASSERT_FALSE(sim_pl_vpp(&b.pl, 2));
            TEST_ASSERT_TRUE(b.vpp_longest_us <= 5000);
            TEST_ASSERT_EQUAL_UINT(0, b.under_vpp);
            TEST_ASSERT_EQUAL_INT(0, sim_misuse_of(sim_pl_misuse(&b.pl), "PL-OTP-12"));
            TEST_ASSERT_EQUAL_INT(0, sim_misuse_of(sim_pl_misuse(&b.pl), "PL-OTP-05"));
            int programmed = 0;
            for (int i = 0; i < 12; i++) {
                programmed += sim_pl_otp(&b.pl, 2, (uint8_t)(0x40 + i)) == image[i];
            }
            TEST_ASSERT_TRUE_MESSAGE(programmed == 12 || programmed == 1,
                                     bench_text("packet %u kind %d", n, kind));
            if (status == BQ_OK) {
                TEST_ASSERT_EQUAL_INT(12, programmed);
            }
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_part_is_programmed);
    RUN_TEST(guards);
    RUN_TEST(no_voltage_no_programming);
    RUN_TEST(a_part_that_is_not_blank_is_refused);
    RUN_TEST(every_lost_packet_ends_without_voltage_and_at_most_one_run);
    return UNITY_END();
}
