/* SPDX-License-Identifier: Apache-2.0 */
/* Conversion control (PL-CONV) and data ready (PL-DRDY). */
#include "rig.h"

static bool busy(int device)
{
    return (rig_read(device, R_STATUS) & 1) == 0;
}

static void pin_pulse(void)
{
    sim_pl_set_conv(&rig, true);
    sim_pl_set_conv(&rig, false);
}

/* proves: PL-CONV-01, PL-CONV-02, PL-CONV-06, PL-CONV-08, PL-AMB-68 */
static void edge_and_bit_start_a_cycle(void)
{
    rig_ready(1);
    rig_adc(1, 0x45, 0x40);
    rig_write(1, R_CONV, 1);
    TEST_ASSERT_TRUE(busy(1));
    EXPECT(0x00, 1, R_CONV);
    rig_us(42);
    TEST_ASSERT_FALSE(busy(1));
    EXPECT_WORD(0x24dd, 1, R_CELL6);
    rig_write(1, R_CONV, 0);
    TEST_ASSERT_FALSE(busy(1));
    sim_pl_set_conv(&rig, true);
    TEST_ASSERT_TRUE(busy(1));
    rig_us(42);
    TEST_ASSERT_FALSE(busy(1));
    rig_ms(1); /* level does nothing */
    TEST_ASSERT_EQUAL_UINT32(2, sim_pl_conversions(&rig, 1));
    sim_pl_set_conv(&rig, false); /* nor does the falling edge */
    TEST_ASSERT_FALSE(busy(1));
    rig_ms(1);
    TEST_ASSERT_EQUAL_UINT32(2, sim_pl_conversions(&rig, 1));
    sim_pl_set_conv(&rig, true);
    sim_pl_set_conv(&rig, true); /* no edge */
    rig_us(42);
    TEST_ASSERT_EQUAL_UINT32(3, sim_pl_conversions(&rig, 1));
    sim_pl_set_conv(&rig, false);
    EXPECT_CLEAN();
}

/* proves: PL-CONV-03, PL-AMB-69 */
static void a_high_pin_blocks_the_bit(void)
{
    rig_ready(2);
    rig_adc(ALL, 0x45, 0x40);
    sim_pl_set_conv(&rig, true);
    rig_ms(1);
    EXPECT_CLEAN();
    rig_write(ALL, R_CONV, 1);
    TEST_ASSERT_FALSE(busy(1));
    TEST_ASSERT_FALSE(busy(2));
    rig_ms(1);
    TEST_ASSERT_EQUAL_UINT32(1, sim_pl_conversions(&rig, 2));
    EXPECT_MISUSE("PL-CONV-03", "PL-AMB-69", "PL-CONV-04");
    sim_pl_set_conv(&rig, false);
    rig_ms(1);
    TEST_ASSERT_EQUAL_UINT32(1, sim_pl_conversions(&rig, 1));
    rig_convert(ALL);
    TEST_ASSERT_EQUAL_UINT32(2, sim_pl_conversions(&rig, 1));
}

/* proves: PL-CONV-07, PL-VB-05, PL-VB-07 */
static void the_pin_starts_everybody_addressed_or_not(void)
{
    rig_up(5);
    rig_address(2);
    sim_pl_set_conv(&rig, true);
    rig_ms(1);
    sim_pl_set_conv(&rig, false);
    for (int d = 1; d <= 5; d++) {
        TEST_ASSERT_EQUAL_UINT32(1, sim_pl_conversions(&rig, d));
    }
    rig_ready(5);
    sim_pl_set_supply(&rig, 3, false); /* a dead device passes no CONV */
    rig_ms(1);
    sim_pl_set_conv(&rig, true);
    rig_ms(1);
    sim_pl_set_conv(&rig, false);
    TEST_ASSERT_EQUAL_UINT32(1, sim_pl_conversions(&rig, 2));
    TEST_ASSERT_EQUAL_UINT32(0, sim_pl_conversions(&rig, 3));
    TEST_ASSERT_EQUAL_UINT32(0, sim_pl_conversions(&rig, 4));
}

/* proves: PL-CONV-11, PL-AMB-71 */
static void all_channels_are_sampled_at_the_end(void)
{
    rig_ready(1);
    rig_write(1, R_IO, 0x03);
    rig_adc(1, 0x7d, 0x40);
    rig_write(1, R_CONV, 1);
    rig_us(59);
    for (int c = 1; c <= 6; c++) {
        sim_pl_set_cell(&rig, 1, c, 2.5);
    }
    sim_pl_set_gpai(&rig, 1, 1.0);
    sim_pl_set_ts_ratio(&rig, 1, 1, 0.25);
    sim_pl_set_ts_ratio(&rig, 1, 2, 0.25);
    EXPECT_WORD(0, 1, R_CELL1); /* nothing is stored early */
    rig_us(1);
    for (int r = R_CELL1; r <= R_CELL6; r += 2) {
        EXPECT_WORD(0x1999, 1, r);
    }
    EXPECT_WORD(0x1999, 1, R_GPAI);
    EXPECT_WORD(0x2044, 1, R_TEMP1);
    EXPECT_WORD(0x2042, 1, R_TEMP2);
}

/* proves: PL-CONV-15 */
static void a_conversion_changes_results_and_drdy_only(void)
{
    int before[256];
    rig_ready(1);
    rig_adc(1, 0x7d, 0x50);
    for (int r = 0; r < 256; r++) {
        before[r] = sim_pl_peek(&rig, 1, (uint8_t)r);
    }
    rig_write(1, R_CONV, 1);
    rig_us(20);
    for (int r = R_GPAI; r < 256; r++) {
        TEST_ASSERT_EQUAL_INT(before[r], sim_pl_peek(&rig, 1, (uint8_t)r));
    }
    TEST_ASSERT_EQUAL_HEX8(before[0] & 0xfe, sim_pl_peek(&rig, 1, 0));
    rig_ms(1);
    TEST_ASSERT_EQUAL_HEX8(before[0], sim_pl_peek(&rig, 1, 0));
    for (int r = 0x13; r < 256; r++) {
        TEST_ASSERT_EQUAL_INT(before[r], sim_pl_peek(&rig, 1, (uint8_t)r));
    }
}

/* proves: PL-AMB-67 */
static void a_second_start_begins_the_cycle_again(void)
{
    for (int kind = 0; kind < 4; kind++) {
        rig_ready(1);
        rig_adc(1, 0x45, 0x40);
        if (kind & 1) {
            pin_pulse();
        } else {
            rig_write(1, R_CONV, 1);
        }
        rig_us(30);
        EXPECT_CLEAN();
        if (kind & 2) {
            pin_pulse();
        } else {
            rig_write(1, R_CONV, 1);
        }
        EXPECT_MISUSE("PL-AMB-67", "PL-CONV-05");
        rig_us(41);
        TEST_ASSERT_TRUE(busy(1));
        rig_us(1);
        TEST_ASSERT_FALSE(busy(1));
        TEST_ASSERT_EQUAL_UINT32(1, sim_pl_conversions(&rig, 1));
    }
}

/* proves: PL-CONV-14 */
static void settings_written_in_a_cycle_are_judged_and_count_for_the_next(void)
{
    rig_ready(1);
    rig_adc(1, 0x45, 0x40);
    rig_write(1, R_CONV, 1);
    rig_us(10);
    rig_write(1, R_ADC, 0x40);
    EXPECT_MISUSE("PL-CONV-14");
    rig_us(31);
    TEST_ASSERT_TRUE(busy(1));
    rig_us(1);
    TEST_ASSERT_FALSE(busy(1));
    EXPECT_WORD(0x24dd, 1, R_CELL6);
}

/* proves: PL-AMB-70, PL-AMB-91 */
static void uvlo_and_tsd_abort_a_running_cycle(void)
{
    for (int tsd = 0; tsd <= 1; tsd++) {
        rig_ready(1);
        rig_adc(1, 0x45, 0xc0); /* 168 us */
        rig_write(1, R_CONV, 1);
        rig_us(50);
        TEST_ASSERT_TRUE(busy(1));
        if (tsd) {
            sim_pl_set_tdie(&rig, 1, 150.0);
        } else {
            sim_pl_set_vbat(&rig, 1, 5.2);
        }
        rig_us(20);
        TEST_ASSERT_FALSE(busy(1));
        rig_ms(1);
        EXPECT_WORD(0, 1, R_CELL1);
        TEST_ASSERT_EQUAL_UINT32(0, sim_pl_conversions(&rig, 1));
    }
}

/* proves: PL-DRDY-01, PL-DRDY-02, PL-DRDY-03, PL-AMB-77, PL-AMB-79, PL-AMB-80 */
static void the_bit_is_local_and_the_pin_is_the_stack(void)
{
    rig_ready(3);
    rig_adc(ALL, 0x45, 0x40);
    TEST_ASSERT_TRUE(sim_pl_drdy_pin(&rig));
    rig_write(3, R_CONV, 1);
    TEST_ASSERT_FALSE(busy(1));
    TEST_ASSERT_FALSE(busy(2));
    TEST_ASSERT_TRUE(busy(3));
    TEST_ASSERT_FALSE(sim_pl_drdy_pin(&rig));
    rig_us(20);
    rig_write(1, R_CONV, 1);
    TEST_ASSERT_TRUE(busy(1));
    rig_us(22);
    TEST_ASSERT_FALSE(busy(3));
    TEST_ASSERT_FALSE(sim_pl_drdy_pin(&rig));
    rig_us(20);
    TEST_ASSERT_FALSE(busy(1));
    TEST_ASSERT_TRUE(sim_pl_drdy_pin(&rig));
    pin_pulse();
    TEST_ASSERT_FALSE(sim_pl_drdy_pin(&rig));
    rig_us(41);
    TEST_ASSERT_FALSE(sim_pl_drdy_pin(&rig));
    rig_us(1);
    TEST_ASSERT_TRUE(sim_pl_drdy_pin(&rig));
    sim_pl_set_supply(&rig, 2, false); /* a dead device blocks it */
    rig_ms(1);
    TEST_ASSERT_FALSE(sim_pl_drdy_pin(&rig));
}

/* proves: PL-AMB-79 */
static void option_pin_shows_the_base_only(void)
{
    const sim_pl_options o = {.amb79_drdy_base_only = true};
    rig_ready_with(3, &o);
    rig_adc(ALL, 0x45, 0x40);
    rig_write(3, R_CONV, 1);
    TEST_ASSERT_TRUE(busy(3));
    TEST_ASSERT_TRUE(sim_pl_drdy_pin(&rig));
    rig_write(1, R_CONV, 1);
    TEST_ASSERT_FALSE(sim_pl_drdy_pin(&rig));
}

/* proves: PL-AMB-78, PL-AMB-35 */
static void drdy_before_the_first_conversion(void)
{
    const sim_pl_options o = {.amb78_drdy_zero = true};
    rig_up(2);
    EXPECT(0x61, 0, R_STATUS);
    TEST_ASSERT_TRUE(sim_pl_drdy_pin(&rig));
    rig_up_with(2, &o);
    EXPECT(0x60, 0, R_STATUS);
    TEST_ASSERT_FALSE(sim_pl_drdy_pin(&rig));
    rig_ready_with(2, &o);
    EXPECT(0x80, 1, R_STATUS);
    rig_adc(ALL, 0x45, 0x40);
    rig_convert(1);
    EXPECT(0x81, 1, R_STATUS);
    EXPECT(0x80, 2, R_STATUS);
    TEST_ASSERT_FALSE(sim_pl_drdy_pin(&rig));
    rig_convert(2);
    TEST_ASSERT_TRUE(sim_pl_drdy_pin(&rig));
    rig_reset(1);
    EXPECT(0x60, 0, R_STATUS);
}

/* proves: PL-AMB-81, PL-PKT-13, PL-AMB-68 */
static void reads_leave_drdy_alone(void)
{
    uint8_t all[19];
    rig_ready(1);
    rig_adc(1, 0x45, 0x40);
    rig_convert(1);
    for (int again = 0; again < 3; again++) {
        rig_read_block(1, 0, all, sizeof all);
        TEST_ASSERT_EQUAL_HEX8(0x81, all[0]);
        TEST_ASSERT_TRUE(sim_pl_drdy_pin(&rig));
    }
    rig_write(1, R_CONV, 1);
    rig_us(10);
    rig_read_block(1, 0, all, sizeof all);
    EXPECT(0x00, 1, R_CONV);
    TEST_ASSERT_TRUE(busy(1));
    rig_us(32);
    TEST_ASSERT_FALSE(busy(1));
}

/* proves: PL-DRDY-07, PL-SLEEP-02 */
static void sleep_waits_for_the_running_cycle(void)
{
    rig_ready(1);
    rig_adc(1, 0x45, 0xc0);
    rig_write(1, R_CONV, 1);
    rig_us(100);
    rig_write(1, R_IO, 0x04);
    rig_us(67);
    TEST_ASSERT_TRUE(busy(1));
    EXPECT(0x00, 1, R_ALERT);
    TEST_ASSERT_TRUE(sim_pl_reg50(&rig, 1));
    rig_us(1);
    TEST_ASSERT_FALSE(busy(1));
    EXPECT(0x04, 1, R_ALERT);
    MODE(SIM_PL_SLEEP, 1);
    EXPECT_WORD(0x24dd, 1, R_CELL6);
    TEST_ASSERT_FALSE(sim_pl_reg50(&rig, 1));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(edge_and_bit_start_a_cycle);
    RUN_TEST(a_high_pin_blocks_the_bit);
    RUN_TEST(the_pin_starts_everybody_addressed_or_not);
    RUN_TEST(all_channels_are_sampled_at_the_end);
    RUN_TEST(a_conversion_changes_results_and_drdy_only);
    RUN_TEST(a_second_start_begins_the_cycle_again);
    RUN_TEST(settings_written_in_a_cycle_are_judged_and_count_for_the_next);
    RUN_TEST(uvlo_and_tsd_abort_a_running_cycle);
    RUN_TEST(the_bit_is_local_and_the_pin_is_the_stack);
    RUN_TEST(option_pin_shows_the_base_only);
    RUN_TEST(drdy_before_the_first_conversion);
    RUN_TEST(reads_leave_drdy_alone);
    RUN_TEST(sleep_waits_for_the_running_cycle);
    return UNITY_END();
}
