/* SPDX-License-Identifier: Apache-2.0 */
/* Smoke tests of the bq76PL536 model: whole paths from the world to the bus. */
#include "sim_pl536.h"
#include "unity.h"
#include <string.h>

static sim_pl s;
static uint8_t rx[64], driven[64];

void setUp(void)
{
    TEST_ASSERT_EQUAL(0, sim_pl_init(&s, 1, NULL));
}

void tearDown(void)
{
}

/* Sends a packet given as hex digits without blanks. */
static void spi(const char *hex)
{
    uint8_t tx[64];
    size_t n = strlen(hex) / 2;

    for (size_t i = 0; i < n; i++) {
        unsigned byte = 0;

        for (size_t k = 0; k < 2; k++) {
            char c = hex[2 * i + k];

            byte = byte * 16 + (unsigned)(c <= '9' ? c - '0' : c - 'a' + 10);
        }
        tx[i] = (uint8_t)byte;
    }
    sim_pl_spi(&s, tx, rx, driven, n);
}

static uint8_t crc8(const uint8_t *bytes, size_t n)
{
    unsigned crc = 0;

    for (size_t i = 0; i < n; i++) {
        crc ^= bytes[i];
        for (int k = 0; k < 8; k++) {
            crc = (crc & 0x80) != 0 ? (crc << 1 ^ 0x07) & 0xff : crc << 1;
        }
    }
    return (uint8_t)crc;
}

static void put(unsigned address, unsigned reg, unsigned value)
{
    uint8_t tx[4] = {(uint8_t)(address << 1 | 1), (uint8_t)reg, (uint8_t)value, 0};

    tx[3] = crc8(tx, 3);
    sim_pl_spi(&s, tx, rx, driven, 4);
}

static void key_put(unsigned address, unsigned reg, unsigned value)
{
    put(address, 0x3a, 0x35);
    put(address, reg, value);
}

static void expect_put_misuse(const char *id, unsigned address, unsigned reg, unsigned value)
{
    put(address, reg, value);
    TEST_ASSERT_MESSAGE(sim_misuse_of(sim_pl_misuse(&s), id) == 1, id);
    TEST_ASSERT_EQUAL_MESSAGE(1, (int)sim_pl_misuse(&s)->count, id);
    sim_misuse_clear(sim_pl_misuse(&s));
}

static void expect_misuse(const char *id, const char *hex)
{
    uint32_t before = sim_pl_misuse(&s)->count;

    spi(hex);
    TEST_ASSERT_EQUAL_MESSAGE(1, (int)(sim_misuse_of(sim_pl_misuse(&s), id) > 0), hex);
    TEST_ASSERT_MESSAGE(sim_pl_misuse(&s)->count > before, hex);
    sim_misuse_clear(sim_pl_misuse(&s));
}

/* proves: PL-NUM-41, PL-POR-05 */
static void test_reset_content_of_blank_part(void)
{
    for (int reg = 0; reg < 0x100; reg++) {
        int want = reg == 0x00 ? 0x61 : reg == 0x20 ? 0x80 : reg == 0x21 ? 0x09 : reg == 0x22 ? 0x3f : 0x00;

        TEST_ASSERT_EQUAL(want, sim_pl_peek(&s, 1, (uint8_t)reg));
    }
    sim_pl_set_otp(&s, 1, 0x42, 0x80);
    sim_pl_set_otp(&s, 1, 0x44, 0x80);
    spi("013ca51c");
    sim_pl_advance(&s, 500 * SIM_PL_US);
    TEST_ASSERT_EQUAL_HEX8(0x08, sim_pl_peek(&s, 1, 0x21));
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&s, 1, 0x22));
    TEST_ASSERT_EQUAL_HEX8(0x61, sim_pl_peek(&s, 1, 0x00));
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
    TEST_ASSERT_EQUAL_HEX8(0xe1, sim_pl_peek(&s, 1, 0x00));
    spi("023b010000");
    TEST_ASSERT_EQUAL_HEX8_ARRAY(addressed, rx, 5);
    spi("7f208007");
    spi("7f20008e");
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&s, 1, 0x20));
    TEST_ASSERT_EQUAL_HEX8(0xc1, sim_pl_peek(&s, 1, 0x00));
    spi("7f3a35d0");
    spi("7f422d92");
    spi("7f2108a3");
    spi("7f21009b");
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&s, 1, 0x21));
    TEST_ASSERT_EQUAL_HEX8(0x81, sim_pl_peek(&s, 1, 0x00));
    TEST_ASSERT_EQUAL(0, sim_pl_misuse(&s)->count);
}

/* proves: PL-VEC-38, PL-CONV-10, PL-DRDY-03 */
static void test_convert_and_read_six_cells(void)
{
    static const uint8_t want[] = {0x24, 0xdd, 0x24, 0xdd, 0x24, 0xdd, 0x24,
                                   0xdd, 0x24, 0xdd, 0x24, 0xdd, 0x92};

    spi("013b0102");
    put(0x3f, 0x30, 0x45);
    TEST_ASSERT_EQUAL_HEX8(0x45, sim_pl_peek(&s, 1, 0x30));
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
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&s, 1, 0x40));
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
    TEST_ASSERT_EQUAL_HEX8(0x08, sim_pl_peek(&s, 1, 0x21) & 0x09);
    sim_pl_set_cell(&s, 1, 3, 4.2);
    TEST_ASSERT_EQUAL(UINT64_MAX, sim_pl_next_event(&s));
    sim_pl_set_cell(&s, 1, 3, 4.201);
    sim_pl_advance(&s, 500 * SIM_PL_MS - 1);
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&s, 1, 0x22));
    sim_pl_advance(&s, 1);
    TEST_ASSERT_EQUAL_HEX8(0x04, sim_pl_peek(&s, 1, 0x22));
    TEST_ASSERT_EQUAL_HEX8(0x09, sim_pl_peek(&s, 1, 0x21));
    sim_pl_set_cell(&s, 1, 3, 4.16);
    spi("7f21019c");
    TEST_ASSERT_EQUAL_HEX8(0x08, sim_pl_peek(&s, 1, 0x21));
    sim_pl_advance(&s, 500 * SIM_PL_MS);
    TEST_ASSERT_EQUAL_HEX8(0x09, sim_pl_peek(&s, 1, 0x21));
    sim_pl_set_cell(&s, 1, 3, 4.149);
    spi("7f21019c");
    sim_pl_advance(&s, SIM_PL_S);
    TEST_ASSERT_EQUAL_HEX8(0x08, sim_pl_peek(&s, 1, 0x21));
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
    TEST_ASSERT_EQUAL(0, sim_pl_peek(&s, 1, 0) & 1);
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
    TEST_ASSERT_EQUAL_HEX8(0x5a, sim_pl_peek(&s, 1, 0x48));
    TEST_ASSERT_EQUAL_HEX8(0x69, sim_pl_peek(&s, 1, 0x00));
    sim_pl_damage_otp(&s, 1, 0x48, 0x02);
    spi("013ca51c");
    sim_pl_advance(&s, 500 * SIM_PL_US);
    TEST_ASSERT_EQUAL_HEX8(0xa0, sim_pl_peek(&s, 1, 0x20));
    TEST_ASSERT_EQUAL_HEX8(0x29, sim_pl_peek(&s, 1, 0x21));
    sim_pl_damage_ram(&s, 1, 0x4a, 0x80);
    TEST_ASSERT_EQUAL_HEX8(0x04, sim_pl_peek(&s, 1, 0x25));
    TEST_ASSERT_EQUAL_HEX8(0xe0, sim_pl_peek(&s, 1, 0x20));
}

static void expect_seen(double v1, double v2, double v3, double v4, double v5, double v6)
{
    const double want[6] = {v1, v2, v3, v4, v5, v6};

    put(1, 0x30, 0x05);
    put(1, 0x34, 0x01);
    sim_pl_advance(&s, SIM_PL_MS);
    for (int i = 0; i < 6; i++) {
        int code = sim_pl_peek(&s, 1, (uint8_t)(3 + 2 * i)) << 8 | sim_pl_peek(&s, 1, (uint8_t)(4 + 2 * i));

        TEST_ASSERT_INT_WITHIN(1, (int)(want[i] * 16383.0 / 6.25 + 0.5), code);
    }
}

static void balance(unsigned mask)
{
    put(1, 0x33, 0x1e);
    put(1, 0x32, 0x00);
    put(1, 0x32, mask);
    TEST_ASSERT_EQUAL_HEX8(mask, sim_pl_cb(&s, 1));
}

/* An open inner wire leaves the sum alone; balancing makes the reading collapse; an end wire takes from the
 * sum. */
static void test_open_wire(void)
{
    static const double cells[6] = {1.0, 1.2, 1.4, 1.6, 1.8, 2.0};

    put(0, 0x3b, 0x81);
    sim_pl_set_cells(&s, 1, cells);
    sim_pl_set_wire(&s, 1, 3, true);
    expect_seen(1.0, 1.2, 0.7, 2.3, 1.8, 2.0);
    balance(0x04);
    expect_seen(1.0, 1.2, 0.0, 3.0, 1.8, 2.0);
    balance(0x08);
    expect_seen(1.0, 1.2, 3.0, 0.0, 1.8, 2.0);
    balance(0x0c);
    expect_seen(1.0, 1.2, 1.5, 1.5, 1.8, 2.0);
    balance(0x02);
    expect_seen(1.0, 1.2, 0.7, 2.3, 1.8, 2.0);
    put(1, 0x32, 0x00);
    sim_pl_set_wire(&s, 1, 2, true);
    expect_seen(1.0, 0.6, 0.7, 2.9, 1.8, 2.0);
    balance(0x02);
    expect_seen(1.0, 0.0, 4.2 * 1.4 / 3.0, 4.2 * 1.6 / 3.0, 1.8, 2.0);
    sim_pl_advance(&s, 30 * SIM_PL_S);
    expect_seen(1.0, 0.6, 0.7, 2.9, 1.8, 2.0);
    sim_pl_set_wire(&s, 1, 2, false);
    sim_pl_set_wire(&s, 1, 3, false);
    expect_seen(1.0, 1.2, 1.4, 1.6, 1.8, 2.0);
}

static void test_open_end_wires(void)
{
    static const double cells[6] = {1.0, 1.2, 1.4, 1.6, 1.8, 2.0};

    put(0, 0x3b, 0x81);
    sim_pl_set_cells(&s, 1, cells);
    sim_pl_set_wire(&s, 1, 0, true);
    expect_seen(0.5, 1.2, 1.4, 1.6, 1.8, 2.0);
    sim_pl_set_wire(&s, 1, 6, true);
    expect_seen(0.5, 1.2, 1.4, 1.6, 1.8, 1.0);
    sim_pl_set_wire(&s, 1, 0, false);
    balance(0x20);
    expect_seen(1.0, 1.2, 1.4, 1.6, 1.8, 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 9.0, sim_pl_vbat(&s, 1));
}

/* The comparators see what the converter sees. */
static void test_open_wire_trips_the_comparators(void)
{
    put(0, 0x3b, 0x81);
    key_put(1, 0x42, 0x2c);
    key_put(1, 0x44, 0x15);
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&s, 1, 0x22));
    sim_pl_set_wire(&s, 1, 3, true);
    TEST_ASSERT_EQUAL_HEX8(0x08, sim_pl_peek(&s, 1, 0x22));
    TEST_ASSERT_EQUAL_HEX8(0x04, sim_pl_peek(&s, 1, 0x23));
}

/* proves: PL-SLEEP-02 */
static void test_sleep_keeps_the_flags_of_unlatched_comparators(void)
{
    put(0, 0x3b, 0x81);
    sim_pl_set_cell(&s, 1, 1, 0.5);
    TEST_ASSERT_EQUAL_HEX8(0x3e, sim_pl_peek(&s, 1, 0x22));
    TEST_ASSERT_EQUAL_HEX8(0x01, sim_pl_peek(&s, 1, 0x23));
    put(1, 0x31, 0x04);
    put(1, 0x21, 0x00);
    TEST_ASSERT_EQUAL_HEX8(0x0b, sim_pl_peek(&s, 1, 0x21));
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&s, 1, 0x22));
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&s, 1, 0x23));
    put(1, 0x21, 0x0a);
    TEST_ASSERT_EQUAL_HEX8(0x01, sim_pl_peek(&s, 1, 0x21));
    put(1, 0x31, 0x00);
    sim_pl_advance(&s, 200 * SIM_PL_US);
    TEST_ASSERT_EQUAL_HEX8(0x03, sim_pl_peek(&s, 1, 0x21));
    TEST_ASSERT_EQUAL_HEX8(0x3e, sim_pl_peek(&s, 1, 0x22));
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
    expect_put_misuse("PL-TEST-03", 1, 0x3d, 0xa4);
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
    expect_put_misuse("PL-AMB-86", 1, 0x31, 0x04);
    expect_put_misuse("PL-AMB-70", 1, 0x34, 1);
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
    RUN_TEST(test_open_wire);
    RUN_TEST(test_open_end_wires);
    RUN_TEST(test_open_wire_trips_the_comparators);
    RUN_TEST(test_sleep_keeps_the_flags_of_unlatched_comparators);
    RUN_TEST(test_supply_thresholds);
    RUN_TEST(test_judge);
    RUN_TEST(test_judge_of_state);
    return UNITY_END();
}
