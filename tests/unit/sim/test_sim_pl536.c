/* SPDX-License-Identifier: Apache-2.0 */
/* Smoke tests of the bq76PL536 model: whole paths from the world to the bus. */
#include "sim_bench.h"

void setUp(void)
{
    TEST_ASSERT_EQUAL(0, sim_pl_init(&s, 1, NULL));
}

void tearDown(void)
{
}

/* proves: PL-NUM-41, PL-POR-05 */
static void test_reset_content_of_blank_part(void)
{
    for (int reg = 0; reg < 0x100; reg++) {
        int want = reg == 0x00 ? 0x61 : reg == 0x20 ? 0x80 : reg == 0x21 ? 0x09 : reg == 0x22 ? 0x3f : 0x00;

        TEST_ASSERT_EQUAL(want, peek(1, (uint8_t)reg));
    }
    sim_pl_set_otp(&s, 1, 0x42, 0x80);
    sim_pl_set_otp(&s, 1, 0x44, 0x80);
    spi("013ca51c");
    sim_pl_advance(&s, 500 * SIM_PL_US);
    TEST_ASSERT_EQUAL_HEX8(0x08, peek(1, 0x21));
    TEST_ASSERT_EQUAL_HEX8(0x00, peek(1, 0x22));
    TEST_ASSERT_EQUAL_HEX8(0x61, peek(1, 0x00));
}

/* proves: PL-NUM-42, PL-VEC-04, PL-VEC-08, PL-VEC-11 */
static void test_addressing_and_clearing(void)
{
    static const uint8_t idle[] = {0x00, 0x00, 0x00, 0x61, 0x35};
    static const uint8_t addressed[] = {0x00, 0x00, 0x00, 0x81, 0xba};

    spi("0000010000");
    TEST_ASSERT_EQUAL_HEX8_ARRAY(idle, rx, 5);
    TEST_ASSERT_EQUAL(0, driven[2]);
    TEST_ASSERT_EQUAL(1, driven[3]);
    TEST_ASSERT_EQUAL(1, driven[4]);
    spi("013b0102");
    TEST_ASSERT_EQUAL_HEX8(0xe1, peek(1, 0x00));
    spi("023b010000");
    TEST_ASSERT_EQUAL_HEX8_ARRAY(addressed, rx, 5);
    spi("7f208007");
    spi("7f20008e");
    TEST_ASSERT_EQUAL_HEX8(0x00, peek(1, 0x20));
    TEST_ASSERT_EQUAL_HEX8(0xc1, peek(1, 0x00));
    spi("7f3a35d0");
    spi("7f422d92");
    spi("7f2108a3");
    spi("7f21009b");
    TEST_ASSERT_EQUAL_HEX8(0x00, peek(1, 0x21));
    TEST_ASSERT_EQUAL_HEX8(0x81, peek(1, 0x00));
    TEST_ASSERT_EQUAL(0, sim_pl_misuse(&s)->count);
}

/* proves: PL-VEC-38, PL-CONV-10, PL-DRDY-03 */
static void test_convert_and_read_six_cells(void)
{
    static const uint8_t want[] = {0x24, 0xdd, 0x24, 0xdd, 0x24, 0xdd, 0x24,
                                   0xdd, 0x24, 0xdd, 0x24, 0xdd, 0x92};

    spi("013b0102");
    put(0x3f, 0x30, 0x45);
    TEST_ASSERT_EQUAL_HEX8(0x45, peek(1, 0x30));
    sim_pl_advance(&s, 600 * SIM_PL_US);
    spi("7f34018a");
    TEST_ASSERT_EQUAL(0, sim_pl_drdy_pin(&s));
    TEST_ASSERT_EQUAL(21 * SIM_PL_US, sim_pl_next_event(&s));
    sim_pl_advance(&s, 21 * SIM_PL_US - 1);
    TEST_ASSERT_EQUAL(0, sim_pl_drdy_pin(&s));
    sim_pl_advance(&s, 1);
    TEST_ASSERT_EQUAL(1, sim_pl_drdy_pin(&s));
    spi("02030c00000000000000000000000000");
    TEST_ASSERT_EQUAL_HEX8_ARRAY(want, rx + 3, 13);
    TEST_ASSERT_EQUAL(0, sim_pl_misuse(&s)->count);
}

/* proves: PL-VEC-43, PL-G3-02, PL-G3-04 */
static void test_configuration_with_key(void)
{
    static const char *const pairs[] = {"7f4050cc", "7f422c95", "7f4385d6", "7f441544",
                                        "7f4585a8", "7f4655a9", "7f47642b"};
    static const uint8_t want[] = {0x50, 0x00, 0x2c, 0x85, 0x15, 0x85, 0x55,
                                   0x64, 0x5a, 0x00, 0x00, 0x00, 0x83};

    spi("013b0102");
    spi("7f4050cc");
    TEST_ASSERT_EQUAL_HEX8(0x00, peek(1, 0x40));
    TEST_ASSERT_EQUAL(1, sim_pl_misuse(&s)->count);
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        spi("7f3a35d0");
        spi(pairs[i]);
    }
    spi("033a354d");
    spi("03485acf");
    spi("02400c00000000000000000000000000");
    TEST_ASSERT_EQUAL_HEX8_ARRAY(want, rx + 3, 13);
    TEST_ASSERT_EQUAL(1, sim_pl_misuse(&s)->count);
}

/* proves: PL-COV-02, PL-COV-03, PL-COV-08, PL-FLT-02 */
static void test_overvoltage_delay_latch_and_return(void)
{
    test_configuration_with_key();
    spi("7f21019c");
    sim_pl_advance(&s, 1);
    TEST_ASSERT_EQUAL_HEX8(0x08, peek(1, 0x21) & 0x09);
    sim_pl_set_cell(&s, 1, 3, 4.2);
    TEST_ASSERT_EQUAL(UINT64_MAX, sim_pl_next_event(&s));
    sim_pl_set_cell(&s, 1, 3, 4.201);
    sim_pl_advance(&s, 500 * SIM_PL_MS - 1);
    TEST_ASSERT_EQUAL_HEX8(0x00, peek(1, 0x22));
    sim_pl_advance(&s, 1);
    TEST_ASSERT_EQUAL_HEX8(0x04, peek(1, 0x22));
    TEST_ASSERT_EQUAL_HEX8(0x09, peek(1, 0x21));
    sim_pl_set_cell(&s, 1, 3, 4.16);
    spi("7f21019c");
    TEST_ASSERT_EQUAL_HEX8(0x08, peek(1, 0x21));
    sim_pl_advance(&s, 500 * SIM_PL_MS);
    TEST_ASSERT_EQUAL_HEX8(0x09, peek(1, 0x21));
    sim_pl_set_cell(&s, 1, 3, 4.149);
    spi("7f21019c");
    sim_pl_advance(&s, SIM_PL_S);
    TEST_ASSERT_EQUAL_HEX8(0x08, peek(1, 0x21));
}

/* proves: PL-ADC-12, PL-AMB-66, PL-POR-13 */
static void test_lock_up(void)
{
    spi("013b0102");
    spi("7f3a35d0");
    spi("7f4050cc");
    expect_misuse("PL-ADC-12", "7f34018a");
    TEST_ASSERT_EQUAL(SIM_PL_LOCKED, sim_pl_get_mode(&s, 1));
    sim_pl_advance(&s, SIM_PL_S);
    TEST_ASSERT_EQUAL(0, peek(1, 0) & 1);
    spi("7f3ca557");
    sim_pl_advance(&s, 500 * SIM_PL_US);
    TEST_ASSERT_EQUAL(SIM_PL_ACTIVE, sim_pl_get_mode(&s, 1));
}

/* proves: PL-OTP-02, PL-OTP-03, PL-OTP-12, PL-AMB-105, PL-AMB-111 */
static void test_programming_once(void)
{
    test_configuration_with_key();
    sim_misuse_clear(sim_pl_misuse(&s));
    sim_pl_set_vpp(&s, 1, true);
    sim_pl_set_vbat(&s, 1, 19.99);
    expect_misuse("PL-OTP-03", "033f9179");
    sim_pl_advance(&s, 2 * SIM_PL_MS);
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_otp(&s, 1, 0x42));
    sim_pl_set_vbat(&s, 1, 20.0);
    spi("033f9179");
    sim_pl_advance(&s, 1500 * SIM_PL_US);
    sim_pl_set_vpp(&s, 1, false);
    TEST_ASSERT_EQUAL_HEX8(0x2c, sim_pl_otp(&s, 1, 0x42));
    TEST_ASSERT_EQUAL(0, sim_pl_misuse(&s)->count);
    sim_pl_set_vpp(&s, 1, true);
    expect_misuse("PL-OTP-12", "033f9179");
    sim_pl_advance(&s, 50 * SIM_PL_MS);
    TEST_ASSERT_EQUAL(0, sim_pl_misuse(&s)->count);
    sim_pl_advance(&s, SIM_PL_US);
    TEST_ASSERT_EQUAL(1, sim_misuse_of(sim_pl_misuse(&s), "PL-AMB-105"));
}

/* proves: PL-ECC-01, PL-ECC-02, PL-ECC-03, PL-G3-08 */
static void test_damage(void)
{
    sim_pl_set_otp(&s, 1, 0x48, 0x5a);
    sim_pl_damage_otp(&s, 1, 0x48, 0x01);
    spi("013ca51c");
    sim_pl_advance(&s, 500 * SIM_PL_US);
    TEST_ASSERT_EQUAL_HEX8(0x5a, peek(1, 0x48));
    TEST_ASSERT_EQUAL_HEX8(0x69, peek(1, 0x00));
    sim_pl_damage_otp(&s, 1, 0x48, 0x02);
    spi("013ca51c");
    sim_pl_advance(&s, 500 * SIM_PL_US);
    TEST_ASSERT_EQUAL_HEX8(0xa0, peek(1, 0x20));
    TEST_ASSERT_EQUAL_HEX8(0x29, peek(1, 0x21));
    sim_pl_damage_ram(&s, 1, 0x4a, 0x80);
    TEST_ASSERT_EQUAL_HEX8(0x04, peek(1, 0x25));
    TEST_ASSERT_EQUAL_HEX8(0xe0, peek(1, 0x20));
}

/* proves: PL-SLEEP-02 */
static void test_sleep_keeps_the_flags_of_unlatched_comparators(void)
{
    put(0, 0x3b, 0x81);
    sim_pl_set_cell(&s, 1, 1, 0.5);
    TEST_ASSERT_EQUAL_HEX8(0x3e, peek(1, 0x22));
    TEST_ASSERT_EQUAL_HEX8(0x01, peek(1, 0x23));
    put(1, 0x31, 0x04);
    put(1, 0x21, 0x00);
    TEST_ASSERT_EQUAL_HEX8(0x0b, peek(1, 0x21));
    TEST_ASSERT_EQUAL_HEX8(0x00, peek(1, 0x22));
    TEST_ASSERT_EQUAL_HEX8(0x00, peek(1, 0x23));
    put(1, 0x21, 0x0a);
    TEST_ASSERT_EQUAL_HEX8(0x01, peek(1, 0x21));
    put(1, 0x31, 0x00);
    sim_pl_advance(&s, 200 * SIM_PL_US);
    TEST_ASSERT_EQUAL_HEX8(0x03, peek(1, 0x21));
    TEST_ASSERT_EQUAL_HEX8(0x3e, peek(1, 0x22));
}

/* proves: PL-COV-06, PL-CUV-05, PL-OT-05 */
static void test_flags_without_delay_cannot_be_cleared_while_the_cause_lasts(void)
{
    put(0, 0x3b, 0x81);
    sim_pl_set_cell(&s, 1, 1, 0.5);
    key_put(1, 0x46, 0x01);
    put(1, 0x31, 0x01);
    sim_pl_set_ts_ratio(&s, 1, 1, 0.3);
    put(1, 0x21, 0x0b);
    TEST_ASSERT_EQUAL_HEX8(0x03, peek(1, 0x21));
    put(1, 0x20, 0x81);
    TEST_ASSERT_EQUAL_HEX8(0x01, peek(1, 0x20));
}

/* proves: PL-UVLO-02, PL-ADC-20 */
static void test_converter_warms_up_again_after_uvlo(void)
{
    put(0, 0x3b, 0x81);
    put(1, 0x30, 0x45);
    sim_pl_advance(&s, SIM_PL_MS);
    sim_pl_set_vbat(&s, 1, 5.0);
    sim_pl_advance(&s, 15 * SIM_PL_US);
    TEST_ASSERT_EQUAL(SIM_PL_UVLO, sim_pl_get_mode(&s, 1));
    put(1, 0x33, 0x1e);
    put(1, 0x32, 0x01);
    TEST_ASSERT_EQUAL_HEX8(0x00, peek(1, 0x32));
    sim_pl_set_vbat(&s, 1, -1.0);
    put(1, 0x34, 0x01);
    TEST_ASSERT_EQUAL(521 * SIM_PL_US, sim_pl_next_event(&s));
    sim_pl_advance(&s, SIM_PL_MS);
    put(1, 0x30, 0x45); /* already on: no new warm-up */
    put(1, 0x34, 0x01);
    TEST_ASSERT_EQUAL(21 * SIM_PL_US, sim_pl_next_event(&s));
}

/* proves: PL-UVLO-01, PL-POR-01, PL-POR-03, PL-NUM-40 */
static void test_supply_thresholds(void)
{
    static const struct {
        double volts;
        sim_pl_mode mode;
    } step[] = {{5.31, SIM_PL_ACTIVE}, {5.29, SIM_PL_UVLO}, {4.79, SIM_PL_UVLO},
                {4.77, SIM_PL_OFF},    {5.27, SIM_PL_OFF},  {5.29, SIM_PL_RESET}};

    for (size_t i = 0; i < sizeof step / sizeof step[0]; i++) {
        sim_pl_set_vbat(&s, 1, step[i].volts);
        sim_pl_advance(&s, 15 * SIM_PL_US);
        TEST_ASSERT_EQUAL(step[i].mode, sim_pl_get_mode(&s, 1));
    }
    sim_pl_advance(&s, 56 * SIM_PL_MS);
    TEST_ASSERT_EQUAL(SIM_PL_UVLO, sim_pl_get_mode(&s, 1));
    sim_pl_set_vbat(&s, 1, 5.66);
    TEST_ASSERT_EQUAL(SIM_PL_UVLO, sim_pl_get_mode(&s, 1));
    sim_pl_set_vbat(&s, 1, 5.68);
    TEST_ASSERT_EQUAL(SIM_PL_ACTIVE, sim_pl_get_mode(&s, 1));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_reset_content_of_blank_part);
    RUN_TEST(test_addressing_and_clearing);
    RUN_TEST(test_convert_and_read_six_cells);
    RUN_TEST(test_configuration_with_key);
    RUN_TEST(test_overvoltage_delay_latch_and_return);
    RUN_TEST(test_lock_up);
    RUN_TEST(test_programming_once);
    RUN_TEST(test_damage);
    RUN_TEST(test_sleep_keeps_the_flags_of_unlatched_comparators);
    RUN_TEST(test_flags_without_delay_cannot_be_cleared_while_the_cause_lasts);
    RUN_TEST(test_converter_warms_up_again_after_uvlo);
    RUN_TEST(test_supply_thresholds);
    return UNITY_END();
}
