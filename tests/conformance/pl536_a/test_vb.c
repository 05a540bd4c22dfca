/* SPDX-License-Identifier: Apache-2.0 */
/* Section 4, the vertical bus of a stack. */
#include "bench.h"

/* proves: PL-VB-01 */
static void test_a_selected_device_sees_the_bits_the_host_sent(void)
{
    uint8_t data[12];

    bench_stack(5);
    bench_address(5);
    bench_read_block(5, 0x40, 12, data); /* the CRC covers the header as device 5 received it */
    bench_write(5, 0x30, 0x2a);
    TEST_ASSERT_EQUAL_HEX8(0x2a, bench_peek(5, 0x30));
    bench_shadow(5, 0x48, 0xa5);
    TEST_ASSERT_EQUAL_HEX8(0xa5, bench_peek(5, 0x48));
}

/* proves: PL-VB-01, PL-VB-02 */
static void test_an_unaddressed_device_blocks_select_to_the_north(void)
{
    bench_stack(3);
    bench_write(ALL, 0x30, 0x3d); /* reaches the base alone */
    TEST_ASSERT_EQUAL_HEX8(0x3d, bench_peek(1, 0x30));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(2, 0x30));
    bench_write(0, 0x3b, 1);
    bench_write(ALL, 0x30, 0x05);
    TEST_ASSERT_EQUAL_HEX8(0x05, bench_peek(1, 0x30));
    TEST_ASSERT_EQUAL_HEX8(0x05, bench_peek(2, 0x30));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(3, 0x30));
    bench_write(0, 0x3b, 2);
    bench_write(0, 0x3b, 3);
    bench_write(ALL, 0x30, 0x02);
    TEST_ASSERT_EQUAL_HEX8(0x02, bench_peek(3, 0x30));
    bench_write(2, 0x3c,
                0xa5); /* device 2 loses its address: device 3 is cut off again, keeping what it has */
    expect("advance 1ms", "ok");
    bench_write(ALL, 0x30, 0x07);
    TEST_ASSERT_EQUAL_HEX8(0x07, bench_peek(2, 0x30));
    TEST_ASSERT_EQUAL_HEX8(0x02, bench_peek(3, 0x30));
    TEST_ASSERT_TRUE(bench_silent(3));
    bench_write(0, 0x3b, 2);
    TEST_ASSERT_EQUAL_HEX8(0x02, bench_read(3, 0x30));
}

/* proves: PL-VB-04, PL-AMB-23 */
static void test_read_data_passes_down_through_every_device(void)
{
    static const uint8_t tx[5] = {0x0c, 0x3b, 0x01, 0, 0};
    uint8_t rx[5], driven[5];

    bench_stack(6);
    bench_address(6);
    for (int link = 1; link <= 5; link++) {
        TEST_ASSERT_EQUAL_HEX8(0x86, bench_read(6, 0x3b));
        TEST_ASSERT_EQUAL(0, sim_pl_set_link(bench_pl(), link, true));
        sim_pl_spi(bench_pl(), tx, rx, driven, 5);
        TEST_ASSERT_EQUAL(0, driven[3]);
        TEST_ASSERT_EQUAL_HEX8(0x80 | link, bench_read(link, 0x3b));
        TEST_ASSERT_EQUAL(0, sim_pl_set_link(bench_pl(), link, false));
    }
    TEST_ASSERT_EQUAL(-1, sim_pl_set_link(bench_pl(), 0, true));
    TEST_ASSERT_EQUAL(-1, sim_pl_set_link(bench_pl(), 6, true));
}

/* proves: PL-VB-05 */
static void test_conv_drdy_fault_and_alert_need_no_address(void)
{
    bench_stack(3);
    expect("set dev.*.otp.42 80", "ok"); /* no COV from the blank part */
    expect("set dev.*.supply off", "ok");
    expect("advance 1ms", "ok");
    expect("set dev.*.supply on", "ok");
    expect("advance 57ms", "ok");
    expect("get pin.fault", "ok 1"); /* POR flags of three unaddressed devices */
    expect("get pin.alert", "ok 1");
    expect("get pin.drdy", "ok 1");
    expect("set pin.conv 1", "ok");
    expect("get pin.drdy", "ok 0");
    expect("advance 1ms", "ok");
    expect("get pin.drdy", "ok 1");
    expect("set pin.conv 0", "ok");
    TEST_ASSERT_EQUAL(1, sim_pl_conversions(bench_pl(), 3));
    TEST_ASSERT_EQUAL_HEX8(0x24, bench_peek(3, 0x03));
    bench_write(0, 0x3b, 1); /* the base alone becomes quiet: what is left comes from the unaddressed ones */
    bench_write(1, 0x20, 0x80);
    bench_write(1, 0x20, 0x00);
    bench_write(1, 0x21, 0x08);
    bench_write(1, 0x21, 0x00);
    TEST_ASSERT_EQUAL_HEX8(0x81, bench_read(1, 0x00));
    expect("get pin.fault", "ok 1");
    expect("get pin.alert", "ok 1");
    TEST_ASSERT_EQUAL(0, sim_pl_set_link(bench_pl(), 1, true));
    expect("get pin.fault", "ok 0");
    expect("get pin.alert", "ok 0");
}

static void expect_device_3_cut_off(void)
{
    TEST_ASSERT_TRUE(bench_silent(3));
    bench_write(3, 0x30, 0x05);
    bench_write(ALL, 0x30, 0x03);
    TEST_ASSERT_EQUAL_HEX8(0x3d, bench_peek(3, 0x30));
    expect("get pin.fault", "ok 0"); /* FORCE of device 3 does not pass */
    expect("get pin.alert", "ok 0");
    expect("get pin.drdy", "ok 0");
    expect("set pin.conv 1", "ok");
    expect("set pin.conv 0", "ok");
    bench_advance_us(100);
    TEST_ASSERT_EQUAL(0, sim_pl_conversions(bench_pl(), 3));
    TEST_ASSERT_EQUAL_HEX8(0xe1, bench_peek(3, 0x00));
}

static void prepare_three_with_force_at_the_top(void)
{
    bench_stack(3);
    bench_quiet(3);
    bench_write(3, 0x30, 0x3d);
    bench_write(3, 0x21, 0x10);
    bench_write(3, 0x20, 0x10);
    expect("get pin.fault", "ok 1");
    expect("get pin.alert", "ok 1");
}

/* proves: PL-VB-06, PL-POR-08 */
static void test_a_device_in_reset_passes_nothing(void)
{
    prepare_three_with_force_at_the_top();
    bench_write(2, 0x3c, 0xa5);
    expect("get dev.2.mode", "ok reset");
    TEST_ASSERT_EQUAL_HEX8(0x81, bench_read(1, 0x3b));
    expect("get pin.fault", "ok 0");
    TEST_ASSERT_TRUE(bench_silent(0));
    TEST_ASSERT_TRUE(bench_silent(2));
    expect("set pin.conv 1", "ok");
    expect("set pin.conv 0", "ok");
    TEST_ASSERT_EQUAL_HEX8(0x01, bench_peek(3, 0x00) & 0x01);
    bench_advance_us(499);
    TEST_ASSERT_TRUE(bench_silent(0));
    TEST_ASSERT_TRUE(bench_silent(3));
    bench_advance_us(2);
    TEST_ASSERT_FALSE(bench_silent(0));
    TEST_ASSERT_TRUE(bench_silent(3));
    bench_write(0, 0x3b, 2);
    TEST_ASSERT_EQUAL_HEX8(0x83, bench_read(3, 0x3b));
}

/* proves: PL-VB-06, PL-ADR-09 */
static void test_a_device_without_power_passes_nothing(void)
{
    prepare_three_with_force_at_the_top();
    expect("set dev.2.supply off", "ok");
    bench_advance_us(100);
    expect("get dev.2.mode", "ok off");
    expect_device_3_cut_off();
    expect("set dev.2.supply on", "ok");
    expect("advance 55ms", "ok");
    expect("get dev.2.mode", "ok reset");
    TEST_ASSERT_TRUE(bench_silent(0));
    TEST_ASSERT_TRUE(bench_silent(3));
    expect("advance 2ms", "ok");
    expect("get dev.2.mode", "ok active");
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(0, 0x3b)); /* the highest reachable device, answering at 0x00 */
    TEST_ASSERT_TRUE(bench_silent(3));
    bench_write(0, 0x3b, 2);
    TEST_ASSERT_EQUAL_HEX8(0x83, bench_read(3, 0x3b)); /* above it address and registers are as they were */
    TEST_ASSERT_EQUAL_HEX8(0x3d, bench_read(3, 0x30));
    TEST_ASSERT_EQUAL_HEX8(0x10, bench_read(3, 0x21));
    TEST_ASSERT_EQUAL_HEX8(0x2d, bench_read(3, 0x42));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(2, 0x42));
}

/* proves: PL-VB-07 */
static void test_the_conv_level_is_repeated_up_the_whole_stack(void)
{
    bench_stack(62);
    expect("set pin.conv 1", "ok");
    bench_advance_us(510); /* 500 us of the automatic mode and (1 + 1) x 3 us */
    for (int k = 1; k <= 62; k++) {
        TEST_ASSERT_EQUAL(1, sim_pl_conversions(bench_pl(), k));
        TEST_ASSERT_EQUAL_HEX8(0x24, bench_peek(k, 0x03));
    }
    bench_write(0, 0x3b, 1);
    bench_write(1, 0x34, 0x01); /* while the level is high, also in device 2, the bit starts nothing */
    bench_write(0, 0x34, 0x01);
    expect("advance 1ms", "ok");
    TEST_ASSERT_EQUAL(1, sim_pl_conversions(bench_pl(), 1));
    TEST_ASSERT_EQUAL(1, sim_pl_conversions(bench_pl(), 2));
    expect("set pin.conv 0", "ok");
    bench_write(0, 0x34, 0x01);
    expect("advance 1ms", "ok");
    TEST_ASSERT_EQUAL(2, sim_pl_conversions(bench_pl(), 2));
}

/* proves: PL-VB-09, PL-AMB-15 */
static void test_two_devices_with_one_address(void)
{
    static const uint8_t tx[6] = {0x0a, 0x30, 0x02, 0, 0, 0};
    uint8_t rx[6], driven[6], first[5] = {0x0a, 0x30, 0x02, 0x05, 0x40},
                              second[5] = {0x0a, 0x30, 0x02, 0x18, 0x80};

    bench_stack(2);
    bench_address(2);
    bench_write(1, 0x30, 0x05);
    bench_write(1, 0x31, 0x40);
    bench_write(2, 0x30, 0x18);
    bench_write(2, 0x31, 0x80);
    expect("set dev.1.gpio 0", "ok");
    bench_write(1, 0x3b, 5);
    bench_write(2, 0x3b, 5);
    sim_misuse_clear(sim_pl_misuse(bench_pl()));
    sim_pl_spi(bench_pl(), tx, rx, driven, 6);
    TEST_ASSERT_EQUAL_HEX8(0x05 | 0x18, rx[3]); /* ORed bit by bit, CRC included */
    TEST_ASSERT_EQUAL_HEX8(0x40 | 0x80, rx[4]);
    TEST_ASSERT_EQUAL_HEX8(bench_crc(first, 5) | bench_crc(second, 5), rx[5]);
    TEST_ASSERT_EQUAL(1, driven[3]);
    expect_misuse("PL-AMB-15 PL-VB-09 PL-ADR-15", -1);
    bench_write(5, 0x33, 0x1e); /* both execute a write */
    TEST_ASSERT_EQUAL_HEX8(0x1e, bench_peek(1, 0x33));
    TEST_ASSERT_EQUAL_HEX8(0x1e, bench_peek(2, 0x33));
}

/* proves: PL-AMB-21 */
static void test_the_height_of_a_stack_delays_nothing(void)
{
    bench_stack(62);
    sim_pl_set_spi_clock(bench_pl(), 1000000);
    bench_address(62);
    TEST_ASSERT_EQUAL_HEX8(0xbe, bench_read(62, 0x3b));
    bench_write(62, 0x21, 0x10);
    bench_write(ALL, 0x34, 0x01);
    TEST_ASSERT_EQUAL_UINT64(0, sim_pl_now(bench_pl()));
    expect("get pin.fault", "ok 1");
    expect("get pin.drdy", "ok 0");
    bench_advance_us(506);
    expect("get pin.drdy", "ok 1");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_selected_device_sees_the_bits_the_host_sent);
    RUN_TEST(test_an_unaddressed_device_blocks_select_to_the_north);
    RUN_TEST(test_read_data_passes_down_through_every_device);
    RUN_TEST(test_conv_drdy_fault_and_alert_need_no_address);
    RUN_TEST(test_a_device_in_reset_passes_nothing);
    RUN_TEST(test_a_device_without_power_passes_nothing);
    RUN_TEST(test_the_conv_level_is_repeated_up_the_whole_stack);
    RUN_TEST(test_two_devices_with_one_address);
    RUN_TEST(test_the_height_of_a_stack_delays_nothing);
    return UNITY_END();
}
