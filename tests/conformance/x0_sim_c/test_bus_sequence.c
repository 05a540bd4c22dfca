/* SPDX-License-Identifier: Apache-2.0 */
/* X0-SEQ-47..54: SHIP and a failing bus, by a host of the rows. */
#include "rig.h"

static void ship(const rig_part *p)
{
    rig_boot(p->name);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x18));
    TEST_ASSERT_TRUE(rig_write(0x05, 0x00));
    expect_reg(0x05, 0x00);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x18) && rig_write(0x04, 0x19));
    TEST_ASSERT_TRUE(rig_write(0x05, 0x00)); /* something between: no SHIP, and the address still answers */
    TEST_ASSERT_TRUE(rig_write(0x04, 0x1a));
    rig_wait(10);
    TEST_ASSERT_TRUE(rig_answers(p->address));
    TEST_ASSERT_TRUE(rig_write(0x04, 0x18) && rig_write(0x04, 0x19) && rig_write(0x04, 0x1a));
    rig_wait(10);
    TEST_ASSERT_FALSE(rig_answers(p->address));
    TEST_ASSERT_FALSE(sim_x0_alert(&chip) || sim_x0_chg(&chip) || sim_x0_dsg(&chip));
    expect_clean();
}

/* A lost answer: 01 written a second time disarms, so the pattern is begun anew. */
/* proves: X0-SEQ-47, X0-SEQ-50 */
static void test_ship(void)
{
    rig_each(ship);
    rig_boot("bq7692003");
    TEST_ASSERT_TRUE(rig_write(0x04, 0x10) && rig_write(0x04, 0x11) && rig_write(0x04, 0x11));
    TEST_ASSERT_TRUE(rig_write(0x04, 0x12));
    TEST_ASSERT_EQUAL(SIM_X0_NORMAL, chip.mode);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x10) && rig_write(0x04, 0x11) && rig_write(0x04, 0x12));
    TEST_ASSERT_EQUAL(SIM_X0_SHIP, chip.mode);
}

/* The answer to a clear is lost and repeated blindly: an event of the time between is gone, and the book says
 * so. */
/* proves: X0-SEQ-50 */
static void test_a_blind_repetition_of_a_clear(void)
{
    rig_boot("bq7693000");
    (void)sim_x0_strike_xready(&chip);
    expect_stat(0x20);
    TEST_ASSERT_TRUE(rig_write(0x00, 0x20));
    rig_wait(1);
    (void)sim_x0_strike_xready(&chip);
    rig_wait(1);
    TEST_ASSERT_TRUE(rig_write(0x00, 0x20));
    expect_misuse("X0-BIT-09");
    expect_stat(0x00);
    rig_wait(1);
    (void)sim_x0_strike_xready(&chip);
    expect_stat(0x20); /* read back before repeating */
    TEST_ASSERT_TRUE(rig_write(0x00, 0x20));
    expect_clean();
}

/* One byte with its CRC; true when the CRC holds. */
static bool read_one(int reg, uint8_t *value, bool again)
{
    uint8_t head[2] = {0x11, 0};
    sim_x0_i2c_start(&chip);
    if (!again) {
        (void)sim_x0_i2c_write(&chip, 0x10);
        (void)sim_x0_i2c_write(&chip, (uint8_t)reg);
        sim_x0_i2c_start(&chip);
    }
    (void)sim_x0_i2c_write(&chip, 0x11);
    head[1] = *value = sim_x0_i2c_read(&chip, true);
    bool good = sim_x0_i2c_read(&chip, false) == rig_crc(head, 2);
    sim_x0_i2c_stop(&chip);
    return good;
}

/* proves: X0-SEQ-48, X0-SEQ-49 */
static void test_damaged_transfers(void)
{
    for (int bit = 24; bit < 40; bit++) { /* data and CRC of the answer */
        uint8_t value;
        rig_boot("bq7692003");
        (void)sim_x0_flip_sda(&chip, bit);
        TEST_ASSERT_FALSE(read_one(0x09, &value, false));
        TEST_ASSERT_TRUE(read_one(0x09, &value, false)); /* with the pointer: the same register */
        TEST_ASSERT_EQUAL_HEX8(0xac, value);
        (void)read_one(0x09, &value, true); /* a bare repetition goes on at another one */
        TEST_ASSERT_EQUAL_HEX8(0x97, value);
    }
    for (int bit = 8; bit < 32; bit++) { /* register, data, CRC of a write */
        rig_boot("bq7692003");
        (void)sim_x0_flip_sda(&chip, bit);
        TEST_ASSERT_FALSE(rig_write(0x0b, 0x19));
        expect_reg(0x0b, 0x00);
        TEST_ASSERT_TRUE(rig_write(0x0b, 0x19));
        expect_reg(0x0b, 0x19);
    }
}

/* proves: X0-SEQ-51, X0-SEQ-54 */
static void test_silence(void)
{
    rig_boot("bq7694003");
    TEST_ASSERT_TRUE(rig_write(0x07, 0x7f) && rig_write(0x05, 0x03));
    sim_x0_bus(&chip)->nack_bytes = 3;
    for (int n = 0; n < 3; n++) {
        TEST_ASSERT_FALSE(rig_answers(0x08));
        rig_wait(1);
    }
    TEST_ASSERT_TRUE(rig_answers(0x08));
    sim_x0_bus(&chip)->dead = 2; /* for ever, as far as this host can see: the FETs stay on by themselves */
    rig_wait(60000);
    TEST_ASSERT_TRUE(sim_x0_chg(&chip) && sim_x0_dsg(&chip));
    (void)sim_x0_set_alert_ext(&chip, true); /* the host's own means */
    TEST_ASSERT_FALSE(sim_x0_chg(&chip) || sim_x0_dsg(&chip));
    sim_x0_bus(&chip)->dead = 0;
    (void)sim_x0_set_supply(&chip, false);
    TEST_ASSERT_FALSE(rig_answers(0x08));
    (void)sim_x0_set_supply(&chip, true);
    TEST_ASSERT_FALSE(rig_answers(0x08)); /* SHIP: boot again */
    (void)sim_x0_set_alert_ext(&chip, false);
    (void)sim_x0_boot(&chip, 3 * MS);
    rig_wait(11);
    TEST_ASSERT_TRUE(rig_answers(0x08));
}

/* proves: X0-SEQ-52, X0-SEQ-53 */
static void test_recovery_clocks(void)
{
    for (int stuck = 1; stuck <= 9; stuck++) {
        int clocks = 0;
        rig_boot("bq7692000");
        TEST_ASSERT_TRUE(rig_write(0x0b, 0x19));
        sim_x0_bus(&chip)->stuck_clocks = stuck;
        while (!sim_x0_sda_free(&chip) && clocks < 9) {
            sim_x0_recovery_clock(&chip);
            clocks++;
        }
        TEST_ASSERT_TRUE(sim_x0_sda_free(&chip));
        TEST_ASSERT_EQUAL(stuck, clocks);
        sim_x0_i2c_start(&chip);
        sim_x0_i2c_stop(&chip);
        expect_stat(0x00);
        expect_reg(0x0b, 0x19); /* the scrub afterwards */
        expect_clean();
    }
    rig_boot("bq7692000"); /* on this part a transfer that broke off in a block may have changed a register */
    sim_x0_i2c_start(&chip);
    TEST_ASSERT_TRUE(sim_x0_i2c_write(&chip, 0x10) && sim_x0_i2c_write(&chip, 0x06));
    TEST_ASSERT_TRUE(sim_x0_i2c_write(&chip, 0x8b));
    sim_x0_i2c_start(&chip);
    sim_x0_i2c_stop(&chip);
    expect_reg(0x06, 0x8b);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_ship);
    RUN_TEST(test_a_blind_repetition_of_a_clear);
    RUN_TEST(test_damaged_transfers);
    RUN_TEST(test_silence);
    RUN_TEST(test_recovery_clocks);
    return UNITY_END();
}
