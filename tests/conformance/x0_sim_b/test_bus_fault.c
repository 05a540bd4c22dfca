/* SPDX-License-Identifier: Apache-2.0 */
/* Faults injected on the bus, byte by byte and line by line, and what is left after each. */
#include "rig.h"

static sim_x0_bus_fault *bus;

static void boot(const char *part)
{
    rig_boot(part);
    bus = sim_x0_bus(&chip);
}

/* Reads a register without the rig's demands; -1 when a byte was not acknowledged, -2 when the CRC is wrong.
 */
static int try_read(int reg)
{
    uint8_t got[2] = {0x11, 0};
    bool ok;
    int crc;
    sim_x0_i2c_start(&chip);
    ok = sim_x0_i2c_write(&chip, 0x10) && sim_x0_i2c_write(&chip, (uint8_t)reg);
    sim_x0_i2c_start(&chip);
    ok = ok && sim_x0_i2c_write(&chip, 0x11);
    got[1] = ok ? sim_x0_i2c_read(&chip, true) : 0;
    crc = ok ? sim_x0_i2c_read(&chip, false) : 0;
    sim_x0_i2c_stop(&chip);
    return !ok ? -1 : crc != rig_crc(got, 2) ? -2 : got[1];
}

/* proves: X0-I2C-27 */
static void test_random_flips_never_pass_the_crc_unseen(void)
{
    int good = 0, bad = 0, unanswered = 0;
    boot("bq7692003");
    bus->flip_probability = 0.005;
    for (int i = 0; i < 3000; i++) {
        int got = try_read(0x0a);
        good += got == 0x97;
        bad += got == -2;
        unanswered += got == -1;
        if (got >= 0 && got != 0x97) { /* only a flip in the register's address can do that */
            TEST_ASSERT_NOT_EQUAL(0x0b, chip.i2c.pointer);
        }
    }
    TEST_ASSERT_GREATER_THAN(0, bad);
    TEST_ASSERT_GREATER_THAN(0, unanswered);
    TEST_ASSERT_GREATER_THAN(1500, good);
    TEST_ASSERT_GREATER_THAN(0, bus->flips);
    bus->flip_probability = 0.0;
    expect_reg(0x0a, 0x97);
    expect_clean();
}

static void test_the_same_seed_flips_the_same_bits(void)
{
    int got[2][200];
    for (int round = 0; round < 2; round++) {
        boot("bq7692003");
        bus->flip_probability = 0.02;
        for (int i = 0; i < 200; i++) {
            got[round][i] = try_read(0x0a);
        }
    }
    TEST_ASSERT_EQUAL_MEMORY(got[0], got[1], sizeof got[0]);
}

static void test_a_dead_bus(void)
{
    for (int kind = 1; kind <= 2; kind++) {
        boot("bq7692000");
        bus->dead = kind;
        sim_x0_i2c_start(&chip);
        TEST_ASSERT_EQUAL(kind == 1, sim_x0_i2c_write(&chip, 0x10));
        TEST_ASSERT_EQUAL(kind == 1, sim_x0_i2c_write(&chip, 0x09));
        TEST_ASSERT_EQUAL_HEX8(kind == 1 ? 0x00 : 0xff, sim_x0_i2c_read(&chip, false));
        sim_x0_i2c_stop(&chip);
        TEST_ASSERT_EQUAL(kind != 1, sim_x0_sda_free(&chip));
        (void)rig_write(0x09, 0x55);
        TEST_ASSERT_EQUAL_HEX8(0xac, sim_x0_peek(&chip, 0x09)); /* the device hears nothing */
        bus->dead = 0;
        expect_reg(0x09, 0xac);
        expect_clean();
    }
}

static void test_bytes_not_acknowledged(void)
{
    for (uint32_t n = 1; n <= 4; n++) {
        boot("bq7692003");
        bus->nack_bytes = n;
        for (uint32_t i = 0; i < n; i++) {
            TEST_ASSERT_FALSE(rig_write(0x09, 0x55)); /* the host stops at the first */
            TEST_ASSERT_EQUAL_HEX8(0xac, sim_x0_peek(&chip, 0x09));
        }
        TEST_ASSERT_EQUAL(0, bus->nack_bytes);
        TEST_ASSERT_TRUE(rig_write(0x09, 0x55));
        expect_reg(0x09, 0x55);
        expect_clean();
    }
}

static void test_a_stuck_line_is_freed_by_clocks(void)
{
    boot("bq7692000");
    bus->stuck_clocks = 5;
    TEST_ASSERT_FALSE(sim_x0_sda_free(&chip));
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_x0_i2c_read(&chip, false)); /* a transfer meanwhile reads low */
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_FALSE(sim_x0_sda_free(&chip));
        sim_x0_recovery_clock(&chip);
    }
    TEST_ASSERT_TRUE(sim_x0_sda_free(&chip));
    sim_x0_recovery_clock(&chip); /* one too many does no harm */
    expect_reg(0x09, 0xac);
    bus->stuck_clocks = -1;
    for (int i = 0; i < 1000; i++) {
        sim_x0_recovery_clock(&chip);
        TEST_ASSERT_FALSE(sim_x0_sda_free(&chip));
    }
    bus->stuck_clocks = 0;
    expect_reg(0x09, 0xac);
}

/* proves: X0-I2C-22 */
static void test_a_stuck_line_at_line_level(void)
{
    boot("bq7692000");
    TEST_ASSERT_TRUE(sim_x0_lines(&chip, true, true)); /* nobody drives: pulled up */
    TEST_ASSERT_FALSE(sim_x0_lines(&chip, true, false));
    TEST_ASSERT_TRUE(sim_x0_lines(&chip, true, true));
    bus->stuck_clocks = 3;
    TEST_ASSERT_FALSE(sim_x0_lines(&chip, true, true)); /* the host releases, the line stays low */
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_FALSE(sim_x0_lines(&chip, false, true));
        TEST_ASSERT_EQUAL(i == 2, sim_x0_lines(&chip, true, true));
    }
    expect_reg(0x09, 0xac);
    bus->dead = 2;
    TEST_ASSERT_TRUE(sim_x0_lines(&chip, true, true));
    bus->dead = 1;
    TEST_ASSERT_FALSE(sim_x0_lines(&chip, true, true));
}

/* proves: X0-I2C-17, X0-AMB-80 */
static void test_a_device_lost_inside_a_block(void)
{
    boot("bq7692000");
    sim_x0_i2c_start(&chip);
    TEST_ASSERT_TRUE(sim_x0_i2c_write(&chip, 0x10) && sim_x0_i2c_write(&chip, 0x06));
    TEST_ASSERT_TRUE(sim_x0_i2c_write(&chip, 0x8b));
    (void)sim_x0_set_supply(&chip, false);
    TEST_ASSERT_FALSE(sim_x0_i2c_write(&chip, 0x5a));
    TEST_ASSERT_EQUAL_HEX8(0xff, sim_x0_i2c_read(&chip, true));
    sim_x0_i2c_stop(&chip);
    (void)sim_x0_set_supply(&chip, true);
    (void)sim_x0_boot(&chip, 3 * MS);
    rig_wait(20);
    expect_reg(0x06, 0x00);
}

/* A flip hits its own transaction only; one that the transaction is too short for is dropped. */
static void test_a_flip_is_for_one_transaction(void)
{
    boot("bq7692000");
    (void)sim_x0_flip_sda(&chip, 500);
    TEST_ASSERT_TRUE(rig_answers(0x08));
    for (int i = 0; i < 20; i++) {
        uint8_t block[40];
        rig_block_read(0x06, block, 40);
        TEST_ASSERT_EQUAL_HEX8(0xac, block[3]);
    }
    TEST_ASSERT_EQUAL_UINT64(0, bus->flips);
    (void)sim_x0_flip_sda(&chip, 26); /* third bit of the answer */
    expect_reg(0x09, 0xac ^ 0x20);
    TEST_ASSERT_EQUAL_UINT64(1, bus->flips);
    expect_reg(0x09, 0xac);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_random_flips_never_pass_the_crc_unseen);
    RUN_TEST(test_the_same_seed_flips_the_same_bits);
    RUN_TEST(test_a_dead_bus);
    RUN_TEST(test_bytes_not_acknowledged);
    RUN_TEST(test_a_stuck_line_is_freed_by_clocks);
    RUN_TEST(test_a_stuck_line_at_line_level);
    RUN_TEST(test_a_device_lost_inside_a_block);
    RUN_TEST(test_a_flip_is_for_one_transaction);
    return UNITY_END();
}
