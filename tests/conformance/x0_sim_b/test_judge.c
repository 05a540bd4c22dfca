/* SPDX-License-Identifier: Apache-2.0 */
/* The judge: each forbidden thing is in its book with an ID, and a correct host has an empty one. */
#include "rig.h"

/* proves: X0-BIT-09 */
static void test_clearing_bits_that_were_not_read_as_set(void)
{
    static const uint8_t blind[] = {0x01, 0x02, 0x04, 0x08, 0x10, 0x20, 0x80, 0xbf};
    for (size_t i = 0; i < sizeof blind; i++) {
        rig_boot("bq7692003");
        (void)sim_x0_strike_xready(&chip);
        TEST_ASSERT_TRUE(rig_write(0x00, blind[i]));
        expect_misuse("X0-BIT-09");
    }
    rig_boot("bq7692003");
    (void)sim_x0_strike_xready(&chip);
    expect_stat(0x20);
    TEST_ASSERT_TRUE(rig_write(0x00, 0x28)); /* one that was read, one that was not */
    expect_misuse("X0-BIT-09");
    (void)sim_x0_strike_xready(&chip);
    expect_stat(0x20);
    TEST_ASSERT_TRUE(rig_write(0x00, 0x20));
    expect_clean();
    TEST_ASSERT_TRUE(rig_write(0x00, 0x20)); /* a second time: it was not read again */
    expect_misuse("X0-BIT-09");
    TEST_ASSERT_TRUE(rig_write(0x00, 0x00));
    expect_clean();
}

/* proves: X0-BIT-09 */
static void test_an_event_between_read_and_clear_survives_a_correct_host(void)
{
    rig_boot("bq7692003");
    (void)sim_x0_strike_xready(&chip);
    expect_stat(0x20);
    (void)sim_x0_set_sense(&chip, -0.010);
    rig_wait(8);
    TEST_ASSERT_TRUE(rig_write(0x00, 0x20));
    expect_stat(0x01);
    expect_clean();
}

/* proves: X0-I2C-21 */
static void test_split_reads(void)
{
    rig_boot("bq7694003");
    for (int reg = 0x0d; reg <= 0x33; reg += 2) {
        (void)rig_read(reg - 1); /* a high half alone is only useless */
        expect_clean();
        (void)rig_read(reg);
        expect_misuse("X0-I2C-21");
        (void)rig_read16(reg - 1);
        expect_clean();
    }
    (void)rig_read(0x51); /* no halves there */
    (void)rig_read(0x59);
    expect_clean();
}

/* proves: X0-ADC-14 */
static void test_reads_before_data_are_valid(void)
{
    for (int i = 0; i < 15; i++) {
        rig_pulse(rig_parts[i].name);
        rig_at(rig_first_ms() - 0.001);
        for (int reg = 0x0c; reg <= 0x30; reg += 2) {
            (void)rig_read16(reg);
            expect_misuse("X0-ADC-14");
        }
        (void)rig_read16(0x32); /* the counter has its own rhythm */
        expect_clean();
        rig_wait(0.001);
        for (int reg = 0x0c; reg <= 0x32; reg += 2) {
            (void)rig_read16(reg);
        }
        expect_clean();
    }
}

/* proves: X0-REG-08, X0-AMB-88 */
static void test_the_low_nibble_of_protect3(void)
{
    sim_x0_options eight = {.amb88_nibble_reads_8 = true};
    rig_boot("bq7693003");
    for (int low = 1; low < 16; low++) {
        TEST_ASSERT_TRUE(rig_write(0x08, 0x50 | low));
        expect_misuse("X0-REG-08");
    }
    TEST_ASSERT_TRUE(rig_write(0x08, 0x50));
    expect_clean();
    rig_boot_with("bq7693003", &eight); /* the other reading: what it comes up with has to stay */
    expect_reg(0x08, 0x08);
    TEST_ASSERT_TRUE(rig_write(0x08, 0x58));
    expect_clean();
    TEST_ASSERT_TRUE(rig_write(0x08, 0x50));
    expect_misuse("X0-REG-08");
}

/* proves: X0-AMB-15 */
static void test_the_converter_off_with_a_fet_on(void)
{
    rig_boot("bq7693003");
    TEST_ASSERT_TRUE(rig_write(0x04, 0x00));
    expect_clean();
    TEST_ASSERT_TRUE(rig_write(0x04, 0x10) && rig_write(0x05, 0x02));
    TEST_ASSERT_TRUE(rig_write(0x04, 0x00));
    expect_misuse("X0-AMB-15");
}

/* proves: X0-AMB-84, X0-AMB-85, X0-AMB-86 */
static void test_writes_where_nothing_can_be_written(void)
{
    sim_x0_options nacks = {.amb86_nack = true};
    for (int other = 0; other < 2; other++) {
        rig_boot_with("bq7692000", other ? &nacks : NULL);
        TEST_ASSERT_EQUAL(!other, rig_write(0x0c, 0));
        expect_misuse("X0-AMB-86");
        TEST_ASSERT_EQUAL(!other, rig_write(0x50, 0));
        expect_misuse("X0-AMB-86");
        TEST_ASSERT_EQUAL(!other, rig_write(0x40, 0));
        expect_misuse("X0-AMB-84");
        TEST_ASSERT_TRUE(rig_write(0x02, 0));
        expect_misuse("X0-AMB-85");
    }
}

/* proves: X0-AMB-83 */
static void test_a_host_that_relies_on_the_pointer(void)
{
    sim_x0_options lost = {.amb83_pointer_lost = true};
    for (int other = 0; other < 2; other++) {
        rig_boot_with("bq7692000", other ? &lost : NULL);
        sim_x0_i2c_start(&chip);
        (void)sim_x0_i2c_write(&chip, 0x10);
        (void)sim_x0_i2c_write(&chip, 0x09);
        sim_x0_i2c_stop(&chip);
        sim_x0_i2c_start(&chip);
        (void)sim_x0_i2c_write(&chip, 0x11);
        TEST_ASSERT_EQUAL_HEX8(other ? 0x00 : 0xac, sim_x0_i2c_read(&chip, false));
        sim_x0_i2c_stop(&chip);
        expect_reg(0x09, 0xac);
    }
}

/* What a fault on the wire did is not the host's misuse. */
static void test_a_disturbed_transfer_is_not_judged(void)
{
    rig_boot("bq7692000");
    for (int bit = 8; bit < 24; bit++) {
        (void)sim_x0_flip_sda(&chip, bit);
        TEST_ASSERT_TRUE(rig_write(0x09, 0xac));
        expect_clean();
    }
    rig_boot("bq7692000"); /* a status read with a flipped bit makes the host clear what was not set */
    (void)sim_x0_flip_sda(&chip, 24 + 3);
    expect_stat(0x10);
    TEST_ASSERT_TRUE(rig_write(0x00, 0x10));
    expect_clean();
    expect_stat(0x00);
    TEST_ASSERT_TRUE(rig_write(0x00, 0x10)); /* but not after a clean read */
    expect_misuse("X0-BIT-09");
}

/* A whole correct life: start, configuration, service, faults, balancing, temperature source, SHIP. */
static void lives_correctly(const rig_part *p)
{
    uint8_t raw[40];
    rig_pulse(p->name);
    rig_at(15);
    for (int g = 0; g < p->inputs / 5; g++) {
        TEST_ASSERT_TRUE(rig_write(1 + g, 0));
    }
    TEST_ASSERT_TRUE(rig_write(0x05, 0x00));
    TEST_ASSERT_TRUE(rig_block_write(0x06, (uint8_t[]){0x8b, 0x5a, 0x50, 0xbf, 0x99, 0x19}, 6));
    rig_block_read(0x01, raw, 11);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x18));
    rig_clear();
    TEST_ASSERT_TRUE(rig_write(0x05, 0x40));
    rig_at(rig_first_ms());
    TEST_ASSERT_TRUE(rig_write(0x05, 0x43));
    for (int n = 0; n < 60; n++) {
        rig_wait(250);
        rig_block_read(0x0c, raw, 40);
        rig_clear();
        for (int g = 0; g < p->inputs / 5; g++) {
            TEST_ASSERT_TRUE(rig_write(1 + g, n % 2 ? 0x15 : 0x0a));
        }
        if (n == 20) {
            (void)sim_x0_set_sense(&chip, -0.150);
        } else if (n == 21) {
            (void)sim_x0_set_sense(&chip, 0);
            TEST_ASSERT_TRUE(rig_write(0x05, 0x40));
        } else if (n == 30) {
            TEST_ASSERT_TRUE(rig_write(0x05, 0x43));
        }
    }
    TEST_ASSERT_TRUE(rig_write(0x05, 0x00));
    TEST_ASSERT_TRUE(rig_write(0x04, 0x18) && rig_write(0x04, 0x19) && rig_write(0x04, 0x1a));
    expect_clean();
    TEST_ASSERT_EQUAL(SIM_X0_SHIP, chip.mode);
}

static void test_a_correct_host_has_an_empty_book(void)
{
    rig_each(lives_correctly);
}

/* Quirks seen in the field, off by default. */
static void test_field_quirks(void)
{
    sim_x0_options o = {.field_zero_boot = true, .field_alert_high = true};
    sim_x0_options shift = {.field_nibble_offset = true, .amb88_nibble_reads_8 = true};
    rig_boot_with("bq7692003", &o);
    TEST_ASSERT_TRUE(sim_x0_alert(&chip));
    for (int reg = 0; reg < 0x60; reg++) {
        expect_reg(reg, 0);
    }
    TEST_ASSERT_TRUE(rig_write(0x04, 0x11) && rig_write(0x04, 0x12));
    TEST_ASSERT_EQUAL(SIM_X0_SHIP, chip.mode);
    (void)sim_x0_boot(&chip, 3 * MS);
    rig_wait(300);
    expect_reg(0x09, 0xac);
    TEST_ASSERT_EQUAL(9424, rig_read16(0x0c));
    sim_x0_freeze(&chip, true);
    (void)sim_x0_set_cell(&chip, 1, 4.5);
    rig_wait(5000);
    expect_reg(0x04, 0x10);
    TEST_ASSERT_EQUAL(9424, rig_read16(0x0c));
    expect_stat(0x00);
    sim_x0_freeze(&chip, false);
    rig_wait(250);
    TEST_ASSERT_EQUAL(11780, rig_read16(0x0c));
    for (int read_back = 0; read_back < 2; read_back++) {
        rig_boot_with("bq7692003", &shift);
        TEST_ASSERT_TRUE(rig_write(0x0b, 0x19) && rig_write(0x08, 0x00));
        if (read_back) {
            expect_reg(0x08, 0x00);
        }
        TEST_ASSERT_TRUE(rig_write(0x05, 0x40));
        rig_wait(250);
        TEST_ASSERT_EQUAL(read_back ? 592 : 0, rig_read16(0x32)); /* 1 A on 5 mohm */
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_clearing_bits_that_were_not_read_as_set);
    RUN_TEST(test_an_event_between_read_and_clear_survives_a_correct_host);
    RUN_TEST(test_split_reads);
    RUN_TEST(test_reads_before_data_are_valid);
    RUN_TEST(test_the_low_nibble_of_protect3);
    RUN_TEST(test_the_converter_off_with_a_fet_on);
    RUN_TEST(test_writes_where_nothing_can_be_written);
    RUN_TEST(test_a_host_that_relies_on_the_pointer);
    RUN_TEST(test_a_disturbed_transfer_is_not_judged);
    RUN_TEST(test_a_correct_host_has_an_empty_book);
    RUN_TEST(test_field_quirks);
    return UNITY_END();
}
