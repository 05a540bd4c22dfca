/* SPDX-License-Identifier: Apache-2.0 */
/* The judge: every mistake has its ID, and what a careful host does has none. */
#include "sim_bench.h"

void setUp(void)
{
    TEST_ASSERT_EQUAL(0, sim_pl_init(&s, 1, NULL));
}

void tearDown(void)
{
}

/* proves: PL-FLT-14, PL-ADR-15, PL-TEST-03, PL-PKT-14, PL-BCAST-02, PL-COV-12 */
static void test_judge(void)
{
    put(0, 0x3b, 1);
    expect_misuse("PL-BCAST-02", "7e00010000");
    expect_misuse("PL-PKT-14", "024b02000000");
    expect_misuse("PL-PKT-12", "02000000");
    expect_misuse("PL-PKT-04", "0200010000000000");
    expect_misuse("PL-PKT-03", "03307d");
    expect_misuse("PL-CRC-02", "03307d31");
    expect_misuse("PL-PKT-01", "8200010000");
    expect_put_misuse("PL-FLT-14", 1, 0x21, 0x1f);
    expect_put_misuse("PL-FLT-14", 1, 0x20, 0xff);
    expect_put_misuse("PL-REG-01", 1, 0x13, 0);
    expect_put_misuse("PL-REG-02", 1, 0x30, 0x80);
    expect_put_misuse("PL-REG-03", 1, 0x03, 0);
    expect_put_misuse("PL-GPIO-06", 1, 0x31, 0x20);
    expect_put_misuse("PL-ADR-15", 1, 0x3b, 0x3f);
    put(0x3f, 0x3c, 0xa5);
    sim_pl_advance(&s, SIM_PL_MS);
    put(0, 0x3b, 1);
    expect_put_misuse("PL-ADR-15", 0x3f, 0x3b, 2);
    put(2, 0x3b, 1);
    expect_put_misuse("PL-TEST-03", 1, 0x3d, 0x25);
    expect_put_misuse("PL-TEST-03", 1, 0x3d, 0xa4);
    put(1, 0x30, 0x00);
    expect_put_misuse("PL-TEST-03", 1, 0x3d, 0x25);
    expect_put_misuse("PL-REG-31", 1, 0x3a, 0x36);
    expect_put_misuse("PL-POR-07", 1, 0x3c, 0xa4);
    expect_put_misuse("PL-OTP-04", 1, 0x3f, 0x91);
    expect_put_misuse("PL-OTP-05", 1, 0x3f, 0x90);
    expect_put_misuse("PL-G3-02", 1, 0x42, 0x2c);
    key_put(1, 0x42, 0x2c);
    expect_put_misuse("PL-G3-02", 1, 0x44, 0x10);
    put(1, 0x3a, 0x35);
    expect_put_misuse("PL-AMB-44", 1, 0x43, 0x80);
    put(1, 0x3a, 0x35);
    expect_put_misuse("PL-AMB-45", 1, 0x46, 0xc0);
    key_put(1, 0x44, 0x1a);
    put(1, 0x3a, 0x35);
    expect_put_misuse("PL-COV-12", 1, 0x42, 0x1f);
    put(1, 0x3d, 0x00);
    TEST_ASSERT_EQUAL(0, sim_pl_misuse(&s)->count);
    expect_put_misuse("PL-TEST-03", 1, 0x3d, 0xa4);
    expect_put_misuse("PL-TEST-04", 1, 0x3d, 0x25);
}

/* Who looks for a device tries both framings: a good packet with CRC is no mistake when the CRC is off. */
static void test_crc_framing_to_a_device_without_crc_is_not_judged(void)
{
    put(0, 0x3b, 0x81);
    key_put(1, 0x41, 0x01);
    put(1, 0x30, 0x05);
    TEST_ASSERT_EQUAL_HEX8(0x00, peek(1, 0x30));
    spi("023b010000");
    TEST_ASSERT_EQUAL_HEX8(0x81, rx[3]);
    TEST_ASSERT_EQUAL(0, driven[4]);
    TEST_ASSERT_EQUAL(0, sim_pl_misuse(&s)->count);
    spi("033005");
    TEST_ASSERT_EQUAL_HEX8(0x05, peek(1, 0x30));
    TEST_ASSERT_EQUAL(0, sim_pl_misuse(&s)->count);
    expect_misuse("PL-PKT-03", "03300500");
}

/* proves: PL-AMB-67, PL-CONV-03, PL-CONV-14, PL-ADC-18, PL-AMB-64, PL-AMB-85, PL-AMB-86, PL-AMB-70 */
static void test_judge_of_state(void)
{
    put(0, 0x3b, 1);
    put(1, 0x30, 0x45);
    expect_put_misuse("PL-ADC-18", 1, 0x34, 1);
    TEST_ASSERT_EQUAL(521 * SIM_PL_US, sim_pl_next_event(&s));
    expect_put_misuse("PL-CONV-14", 1, 0x30, 0x45);
    expect_misuse("PL-CONV-12", "0203020000"
                                "00");
    expect_put_misuse("PL-AMB-67", 1, 0x34, 1);
    sim_pl_advance(&s, SIM_PL_MS);
    sim_pl_set_conv(&s, true);
    sim_pl_advance(&s, SIM_PL_MS);
    expect_put_misuse("PL-CONV-03", 1, 0x34, 1);
    sim_pl_set_conv(&s, false);
    TEST_ASSERT_EQUAL(2, sim_pl_conversions(&s, 1));
    put(1, 0x33, 0x1e);
    put(1, 0x32, 0x01);
    expect_put_misuse("PL-AMB-85", 1, 0x33, 0x1f);
    put(1, 0x31, 0x40);
    TEST_ASSERT_EQUAL(0, sim_pl_misuse(&s)->count);
    expect_put_misuse("PL-AMB-86", 1, 0x31, 0x04);
    expect_put_misuse("PL-AMB-70", 1, 0x34, 1);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_judge);
    RUN_TEST(test_crc_framing_to_a_device_without_crc_is_not_judged);
    RUN_TEST(test_judge_of_state);
    return UNITY_END();
}
