/* SPDX-License-Identifier: Apache-2.0 */
/* Power modes: supply, boot, SHIP. */
#include "rig.h"

#define REGS_IN_USE 12

/* The control registers as every entry to NORMAL leaves them. */
static void expect_defaults(void)
{
    static const uint8_t reset[REGS_IN_USE] = {0, 0, 0, 0, 0x10, 0, 0, 0, 0, 0xac, 0x97, 0};
    for (int reg = 0; reg < REGS_IN_USE; reg++) {
        expect_reg(reg, reset[reg]);
    }
}

static void fill(void)
{
    for (int reg = 1; reg < REGS_IN_USE; reg++) {
        static const uint8_t value[REGS_IN_USE] = {0,    0x15, 0x15, 0x15, 0x18, 0x43,
                                                   0x9f, 0x7f, 0xf0, 0xc9, 0x9a, 0x19};
        TEST_ASSERT_TRUE(rig_write(reg, value[reg]));
    }
    sim_misuse_clear(sim_x0_misuse(&chip)); /* absent CELLBAL registers of the smaller sizes */
}

static void boots(const rig_part *p)
{
    rig_ship(p->name);
    TEST_ASSERT_EQUAL(SIM_X0_SHIP, chip.mode);
    rig_wait(60000);
    TEST_ASSERT_EQUAL(SIM_X0_SHIP, chip.mode);
    TEST_ASSERT_FALSE(rig_answers(p->address));
    (void)sim_x0_boot(&chip, 2 * MS - 1);
    rig_wait(100);
    TEST_ASSERT_EQUAL(SIM_X0_SHIP, chip.mode);
    (void)sim_x0_boot(&chip, 2 * MS);
    TEST_ASSERT_EQUAL(SIM_X0_BOOT, chip.mode);
    rig_wait(0.999);
    TEST_ASSERT_FALSE(rig_answers(p->address));
    rig_wait(0.001);
    TEST_ASSERT_TRUE(rig_answers(p->address));
    expect_reg(0x09, 0xac); /* reads give reset values */
    expect_reg(0x04, 0x00);
    rig_wait(8.999);
    TEST_ASSERT_EQUAL(SIM_X0_BOOT, chip.mode);
    rig_wait(0.001);
    TEST_ASSERT_EQUAL(SIM_X0_NORMAL, chip.mode);
    TEST_ASSERT_EQUAL(0, chip.i2c.pointer);
    expect_defaults();
    expect_clean();
}

/*
 * proves: X0-MODE-01, X0-MODE-04, X0-MODE-05, X0-MODE-06, X0-MODE-07, X0-TIM-08, X0-TIM-09, X0-AMB-68,
 *     X0-AMB-69, X0-TS-10
 */
static void test_the_boot(void)
{
    rig_each(boots);
}

/* proves: X0-MODE-06, X0-AMB-68 */
static void test_a_pulse_known_only_at_its_end(void)
{
    rig_ship("bq7692003");
    rig_at(100);
    TEST_ASSERT_EQUAL(0, sim_x0_boot_ended(&chip, 98 * MS + 1)); /* 1.999999 ms */
    TEST_ASSERT_EQUAL(SIM_X0_SHIP, chip.mode);
    TEST_ASSERT_EQUAL(0, sim_x0_boot_ended(&chip, 97 * MS));
    TEST_ASSERT_TRUE(rig_answers(0x08)); /* 3 ms after the rise */
    rig_at(106.999);
    TEST_ASSERT_EQUAL(SIM_X0_BOOT, chip.mode);
    rig_at(107);
    TEST_ASSERT_EQUAL(SIM_X0_NORMAL, chip.mode);
    TEST_ASSERT_EQUAL(-1, sim_x0_boot_ended(&chip, 108 * MS)); /* from the future */
}

/* proves: X0-MODE-06 */
static void test_a_pulse_longer_than_the_boot(void)
{
    rig_ship("bq7692003");
    rig_at(110.5);
    TEST_ASSERT_EQUAL(0, sim_x0_boot_ended(&chip, 100 * MS)); /* 10 ms were over at 110 ms */
    rig_wait(0);
    TEST_ASSERT_EQUAL(SIM_X0_NORMAL, chip.mode);
    TEST_ASSERT_EQUAL_UINT64(110500 * US, chip.now);
    TEST_ASSERT_EQUAL_UINT64(250 * MS, sim_x0_next_event(&chip));
}

/* proves: X0-MODE-07, X0-AMB-70 */
static void test_no_timer_and_no_memory_of_the_host_survives_ship(void)
{
    rig_boot("bq7692003");
    (void)sim_x0_strike_xready(&chip);
    expect_stat(0x20);
    (void)sim_x0_set_cell(&chip, 1, 4.5);
    rig_wait(900); /* most of the delay */
    TEST_ASSERT_TRUE(rig_write(0x04, 0x11) && rig_write(0x04, 0x12));
    (void)sim_x0_boot(&chip, 3 * MS);
    rig_wait(20);
    TEST_ASSERT_TRUE(rig_write(0x00, 0x20)); /* read before SHIP only */
    expect_misuse("X0-BIT-09");
    rig_wait(1239.999);
    expect_stat(0x00);
    rig_wait(0.001); /* first publication and the whole delay */
    expect_stat(0x04);
}

/* proves: X0-AMB-75 */
static void test_only_a_pulse_after_ship_boots(void)
{
    rig_boot("bq7692003");
    rig_at(1000);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x11) && rig_write(0x04, 0x12));
    rig_at(1010);
    TEST_ASSERT_EQUAL(0, sim_x0_boot_ended(&chip, 900 * MS)); /* TS1 was high already */
    TEST_ASSERT_EQUAL(SIM_X0_SHIP, chip.mode);
    TEST_ASSERT_EQUAL(0, sim_x0_boot_ended(&chip, 1005 * MS));
    TEST_ASSERT_EQUAL(SIM_X0_BOOT, chip.mode);
}

/* proves: X0-AMB-69, X0-MODE-09 */
static void test_writes_before_normal_are_lost(void)
{
    rig_pulse("bq7693003");
    for (int t = 1; t < 10; t++) {
        rig_at(t);
        TEST_ASSERT_TRUE(rig_write(0x09, 0xbf)); /* acknowledged */
        expect_misuse("X0-MODE-09");
    }
    rig_at(10);
    expect_defaults();
    TEST_ASSERT_TRUE(rig_write(0x09, 0xbf));
    expect_reg(0x09, 0xbf);
    expect_clean();
}

/* proves: X0-AMB-69 */
static void test_a_bus_that_wakes_with_normal_in_the_other_reading(void)
{
    sim_x0_options late = {.amb69_i2c_at_boot = true};
    rig_pulse_with("bq7693003", &late);
    rig_at(9.999);
    TEST_ASSERT_FALSE(rig_answers(0x08));
    rig_at(10);
    TEST_ASSERT_TRUE(rig_answers(0x08));
}

/* A boot signal in NORMAL changes nothing. */
static void test_a_boot_pulse_in_normal_is_ignored(void)
{
    rig_boot("bq7693003");
    fill();
    (void)sim_x0_boot(&chip, 3 * MS);
    rig_wait(50);
    TEST_ASSERT_EQUAL(SIM_X0_NORMAL, chip.mode);
    expect_reg(0x09, 0xc9);
}

static void goes_to_ship(const rig_part *p)
{
    rig_boot(p->name);
    fill();
    rig_wait(1000);
    rig_clear();
    TEST_ASSERT_TRUE(rig_write(0x04, 0x18) && rig_write(0x04, 0x19) && rig_write(0x04, 0x1a));
    TEST_ASSERT_EQUAL(SIM_X0_SHIP, chip.mode);
    for (int address = 0; address < 128; address++) {
        TEST_ASSERT_FALSE(rig_answers(address));
    }
    TEST_ASSERT_FALSE(sim_x0_chg(&chip) || sim_x0_dsg(&chip) || sim_x0_alert(&chip));
    TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&chip));
    (void)sim_x0_set_sense(&chip, -0.250); /* no comparator, converter or counter */
    (void)sim_x0_set_cell(&chip, 1, 4.9);
    rig_wait(60000);
    TEST_ASSERT_FALSE(sim_x0_alert(&chip));
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, sim_x0_next_event(&chip));
    (void)sim_x0_set_sense(&chip, 0);
    (void)sim_x0_boot(&chip, 3 * MS);
    rig_wait(10);
    expect_defaults(); /* nothing survives SHIP */
    for (int reg = 0x0c; reg < 0x34; reg++) {
        expect_reg(reg, 0);
    }
}

/* proves: X0-MODE-07, X0-MODE-08, X0-MODE-10, X0-MODE-12, X0-FET-09, X0-AMB-70, X0-AMB-73, X0-CB-03 */
static void test_ship_and_back(void)
{
    rig_each(goes_to_ship);
}

static bool ships(const uint8_t *writes, int n, const sim_x0_options *options)
{
    rig_boot_with("bq7692003", options);
    for (int i = 0; i < n; i++) {
        TEST_ASSERT_TRUE(rig_write(0x04, writes[i]));
    }
    return chip.mode == SIM_X0_SHIP;
}

/* proves: X0-MODE-10, X0-MODE-11, X0-AMB-71, X0-BIT-13 */
static void test_the_pattern(void)
{
    sim_x0_options needs_00 = {.amb71_needs_00 = true};
    static const struct {
        uint8_t writes[4];
        int n;
        bool ships, strict;
    } c[] = {
        {{0x10, 0x11, 0x12}, 3, true, true},
        {{0x11, 0x12}, 2, true, true},
        {{0x12, 0x11, 0x12}, 3, true, false},
        {{0x13, 0x11, 0x12}, 3, true, false},
        {{0x11, 0x11, 0x12}, 3, false, false},
        {{0x11, 0x13, 0x12}, 3, false, false},
        {{0x11, 0x10, 0x12}, 3, false, false},
        {{0x12}, 1, false, false},
        {{0x13}, 1, false, false},
        {{0x11}, 1, false, false},
        {{0x11, 0x11, 0x11, 0x12}, 4, false, false},
        {{0x01, 0x02}, 2, true, true},
        {{0x19, 0x0a}, 2, true, true},
        {{0x12, 0x12}, 2, false, false},
    };
    for (size_t i = 0; i < sizeof c / sizeof c[0]; i++) {
        TEST_ASSERT_EQUAL(c[i].ships, ships(c[i].writes, c[i].n, NULL));
        TEST_ASSERT_EQUAL(c[i].strict, ships(c[i].writes, c[i].n, &needs_00));
    }
}

/* proves: X0-MODE-11, X0-AMB-71 */
static void test_what_comes_between(void)
{
    static const int others[] = {0x00, 0x01, 0x05, 0x0b, 0x0c, 0x50, 0x77, 0xff};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        rig_boot("bq7692003");
        TEST_ASSERT_TRUE(rig_write(0x04, 0x11) && rig_write(others[i], 0x00) && rig_write(0x04, 0x12));
        TEST_ASSERT_EQUAL(SIM_X0_NORMAL, chip.mode);
    }
    rig_boot("bq7692003"); /* reads and a write with a wrong CRC change nothing */
    TEST_ASSERT_TRUE(rig_write(0x04, 0x11));
    expect_reg(0x04, 0x11);
    expect_stat(0x00);
    sim_x0_i2c_start(&chip);
    (void)sim_x0_i2c_write(&chip, 0x10);
    (void)sim_x0_i2c_write(&chip, 0x05);
    (void)sim_x0_i2c_write(&chip, 0x00);
    TEST_ASSERT_FALSE(sim_x0_i2c_write(&chip, 0x00));
    sim_x0_i2c_stop(&chip);
    rig_wait(100000);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x12));
    TEST_ASSERT_EQUAL(SIM_X0_SHIP, chip.mode);
}

/* proves: X0-BIT-13, X0-AMB-72 */
static void test_the_pattern_reads_back(void)
{
    sim_x0_options reads_0 = {.amb72_shut_reads_0 = true};
    for (int other = 0; other < 2; other++) {
        rig_boot_with("bq7692003", other ? &reads_0 : NULL);
        for (int pattern = 3; pattern >= 0; pattern--) {
            TEST_ASSERT_TRUE(rig_write(0x04, 0x10 | pattern));
            expect_reg(0x04, 0x10 | (other ? 0 : pattern));
        }
    }
}

static void loses_its_supply(const rig_part *p)
{
    rig_boot(p->name);
    fill();
    TEST_ASSERT_EQUAL(0, sim_x0_set_supply(&chip, false));
    TEST_ASSERT_EQUAL(SIM_X0_OFF, chip.mode);
    TEST_ASSERT_FALSE(sim_x0_chg(&chip) || sim_x0_dsg(&chip) || sim_x0_alert(&chip));
    TEST_ASSERT_FALSE(rig_answers(p->address));
    (void)sim_x0_boot(&chip, 3 * MS); /* without supply no pulse boots */
    rig_wait(1000);
    TEST_ASSERT_EQUAL(SIM_X0_OFF, chip.mode);
    TEST_ASSERT_EQUAL(0, sim_x0_set_supply(&chip, true));
    TEST_ASSERT_EQUAL(SIM_X0_SHIP, chip.mode); /* never NORMAL */
    rig_wait(1000);
    TEST_ASSERT_EQUAL(SIM_X0_SHIP, chip.mode);
    (void)sim_x0_boot(&chip, 3 * MS);
    rig_wait(10);
    expect_defaults();
    (void)sim_x0_set_supply(&chip, true); /* no change, no effect */
    TEST_ASSERT_EQUAL(SIM_X0_NORMAL, chip.mode);
}

/* proves: X0-MODE-01, X0-MODE-02, X0-MODE-03, X0-AMB-67 */
static void test_the_supply(void)
{
    rig_each(loses_its_supply);
}

/* proves: X0-MODE-03, X0-AMB-69, X0-MODE-02 */
static void test_a_brown_out_during_the_boot(void)
{
    rig_pulse("bq7692003");
    rig_at(5);
    (void)sim_x0_set_supply(&chip, false);
    (void)sim_x0_set_supply(&chip, true);
    rig_at(1000);
    TEST_ASSERT_EQUAL(SIM_X0_SHIP, chip.mode);
    TEST_ASSERT_FALSE(rig_answers(0x08));
}

/* proves: X0-MODE-08 */
static void test_values_last_until_ship_or_reset(void)
{
    rig_boot("bq7694003");
    fill();
    for (int i = 0; i < 100; i++) {
        rig_wait(36000);
        (void)rig_read(0x00);
    }
    expect_reg(0x01, 0x15);
    expect_reg(0x04, 0x18);
    expect_reg(0x06, 0x9f);
    expect_reg(0x07, 0x7f);
    expect_reg(0x08, 0xf0);
    expect_reg(0x09, 0xc9);
    expect_reg(0x0a, 0x9a);
    expect_reg(0x0b, 0x19);
}

/* proves: X0-MODE-15 */
static void test_converter_and_counter_off_leave_the_rest_alone(void)
{
    rig_boot("bq7693003");
    TEST_ASSERT_TRUE(rig_write(0x05, 0x00) && rig_write(0x04, 0x00));
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, sim_x0_next_event(&chip));
    rig_wait(3600000);
    TEST_ASSERT_TRUE(rig_answers(0x08));
    (void)sim_x0_set_sense(&chip, -0.030);
    rig_wait(8);
    expect_stat(0x03);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_boot);
    RUN_TEST(test_a_pulse_known_only_at_its_end);
    RUN_TEST(test_a_pulse_longer_than_the_boot);
    RUN_TEST(test_no_timer_and_no_memory_of_the_host_survives_ship);
    RUN_TEST(test_only_a_pulse_after_ship_boots);
    RUN_TEST(test_writes_before_normal_are_lost);
    RUN_TEST(test_a_bus_that_wakes_with_normal_in_the_other_reading);
    RUN_TEST(test_a_boot_pulse_in_normal_is_ignored);
    RUN_TEST(test_ship_and_back);
    RUN_TEST(test_the_pattern);
    RUN_TEST(test_what_comes_between);
    RUN_TEST(test_the_pattern_reads_back);
    RUN_TEST(test_the_supply);
    RUN_TEST(test_a_brown_out_during_the_boot);
    RUN_TEST(test_values_last_until_ship_or_reset);
    RUN_TEST(test_converter_and_counter_off_leave_the_rest_alone);
    return UNITY_END();
}
