/* SPDX-License-Identifier: Apache-2.0 */
/* Section 2, pins. */
#include "bench.h"
#include <stdio.h>

/* proves: PL-PIN-01, PL-PIN-02, PL-SPI-07 */
static void test_without_chip_select_nothing_is_heard_and_the_pull_up_answers(void)
{
    static const uint8_t read[5] = {0x02, 0x3b, 0x01, 0x00, 0x00}, write[4] = {0x03, 0x30, 0x7d, 0x30};
    uint8_t rx[5], driven[5], before[256], after[256];

    bench_address(1);
    bench_dump(1, before);
    bench_fault()->drop_packets = 2; /* chip select stays high for two packets */
    sim_pl_spi(bench_pl(), read, rx, driven, 5);
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL(0, driven[i]);
        TEST_ASSERT_EQUAL_HEX8(0xff, rx[i]);
    }
    sim_pl_spi(bench_pl(), write, rx, driven, 4);
    bench_dump(1, after);
    TEST_ASSERT_EQUAL_MEMORY(before, after, 256);
    TEST_ASSERT_EQUAL_HEX8(0x81, bench_read(1, 0x3b));
    bench_write(1, 0x30, 0x7d);
    TEST_ASSERT_EQUAL_HEX8(0x7d, bench_read(1, 0x30));
}

/* proves: PL-PIN-03 */
static void test_conv_is_low_when_open_and_starts_on_its_rising_edge(void)
{
    expect("get pin.conv", "ok 0");
    expect("advance 10ms", "ok");
    TEST_ASSERT_EQUAL(0, sim_pl_conversions(bench_pl(), 1));
    expect("set pin.conv 1", "ok");
    expect("get pin.drdy", "ok 0");
    expect("advance 1ms", "ok");
    expect("get pin.drdy", "ok 1");
    TEST_ASSERT_EQUAL(1, sim_pl_conversions(bench_pl(), 1));
    TEST_ASSERT_EQUAL_HEX8(0x24, bench_read(0, 0x03));
    expect("set pin.conv 0", "ok"); /* the falling edge does nothing */
    expect("advance 10ms", "ok");
    TEST_ASSERT_EQUAL(1, sim_pl_conversions(bench_pl(), 1));
}

/* proves: PL-PIN-04, PL-PIN-08 */
static void test_host_pins_are_active_high_and_stand_for_the_stack(void)
{
    bench_stack(3);
    bench_quiet(3);
    expect("get pin.fault", "ok 0");
    expect("get pin.alert", "ok 0");
    expect("get pin.drdy", "ok 1");
    for (int k = 1; k <= 3; k++) {
        bench_write(k, 0x21, 0x10);
        expect("get pin.fault", "ok 1");
        expect("get pin.alert", "ok 0");
        bench_write(k, 0x21, 0x00);
        expect("get pin.fault", "ok 0");
        bench_write(k, 0x20, 0x10);
        expect("get pin.alert", "ok 1");
        expect("get pin.fault", "ok 0");
        bench_write(k, 0x20, 0x00);
        expect("get pin.alert", "ok 0");
        bench_write(k, 0x34, 0x01);
        expect("get pin.drdy", "ok 0");
        expect("advance 10ms", "ok");
        expect("get pin.drdy", "ok 1");
    }
    expect_no_misuse();
}

/* proves: PL-PIN-06, PL-PIN-08 */
static void test_select_clock_data_and_conv_travel_north(void)
{
    bench_stack(4);
    bench_address(4);
    bench_write(4, 0x30, 0x05);
    TEST_ASSERT_EQUAL_HEX8(0x05, bench_peek(4, 0x30));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(3, 0x30));
    expect("set pin.conv 1", "ok");
    expect("advance 1ms", "ok");
    expect("set pin.conv 0", "ok");
    for (int k = 1; k <= 4; k++) {
        TEST_ASSERT_EQUAL(1, sim_pl_conversions(bench_pl(), k));
    }
}

/* proves: PL-PIN-07, PL-PIN-08 */
static void test_data_ready_fault_and_alert_travel_south(void)
{
    bench_stack(4);
    bench_quiet(4);
    TEST_ASSERT_EQUAL_HEX8(0x84, bench_read(4, 0x3b));
    bench_write(4, 0x21, 0x10);
    bench_write(4, 0x20, 0x10);
    bench_write(4, 0x34, 0x01);
    expect("get pin.fault", "ok 1");
    expect("get pin.alert", "ok 1");
    expect("get pin.drdy", "ok 0");
    for (int k = 1; k < 4; k++) { /* the devices in between only pass it on */
        TEST_ASSERT_EQUAL_HEX8(0x81, bench_read(k, 0x00));
    }
    TEST_ASSERT_EQUAL(0, sim_pl_set_link(bench_pl(), 2, true)); /* link above device 2 broken */
    expect("get pin.fault", "ok 0");
    expect("get pin.alert", "ok 0");
    TEST_ASSERT_TRUE(bench_silent(4));
    TEST_ASSERT_EQUAL_HEX8(0x82, bench_read(2, 0x3b));
    TEST_ASSERT_EQUAL(0, sim_pl_set_link(bench_pl(), 2, false));
    expect("get pin.fault", "ok 1");
    expect("get pin.alert", "ok 1");
    TEST_ASSERT_EQUAL_HEX8(0x84, bench_read(4, 0x3b));
}

/* proves: PL-PIN-09 */
static void test_cb_outputs_are_high_for_their_bit(void)
{
    char reply[8];

    bench_address(1);
    bench_write(1, 0x33, 0x3f);
    expect("get dev.1.cb", "ok 00");
    for (int n = 1; n <= 6; n++) {
        bench_write(1, 0x32, 0x00);
        bench_write(1, 0x32, 1 << (n - 1));
        (void)snprintf(reply, sizeof reply, "ok %02x", 1u << (n - 1));
        expect("get dev.1.cb", reply);
    }
    bench_write(1, 0x32, 0x00);
    expect("get dev.1.cb", "ok 00");
}

/* proves: PL-PIN-10 */
static void test_gpio_is_open_drain_and_aux_switches_reg50(void)
{
    TEST_ASSERT_TRUE(sim_pl_reg50(bench_pl(), 1));
    TEST_ASSERT_FALSE(sim_pl_aux(bench_pl(), 1));
    TEST_ASSERT_FALSE(sim_pl_gpio(bench_pl(), 1)); /* driven low after reset against the pull-up */
    bench_address(1);
    bench_write(1, 0x31, 0x40);
    TEST_ASSERT_TRUE(sim_pl_gpio(bench_pl(), 1));
    expect("set dev.1.gpio 0", "ok"); /* released: somebody else may pull it low */
    TEST_ASSERT_FALSE(sim_pl_gpio(bench_pl(), 1));
    TEST_ASSERT_EQUAL_HEX8(0x40, bench_read(1, 0x31));
    expect("set dev.1.gpio 1", "ok");
    TEST_ASSERT_EQUAL_HEX8(0x60, bench_read(1, 0x31));
    bench_write(1, 0x31, 0x80);
    TEST_ASSERT_TRUE(sim_pl_aux(bench_pl(), 1));
    TEST_ASSERT_FALSE(sim_pl_gpio(bench_pl(), 1));
    bench_write(1, 0x31, 0x84); /* SLEEP turns REG50 off, and AUX with it */
    TEST_ASSERT_FALSE(sim_pl_reg50(bench_pl(), 1));
    TEST_ASSERT_FALSE(sim_pl_aux(bench_pl(), 1));
    bench_write(1, 0x31, 0x80);
    TEST_ASSERT_TRUE(sim_pl_aux(bench_pl(), 1));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_without_chip_select_nothing_is_heard_and_the_pull_up_answers);
    RUN_TEST(test_conv_is_low_when_open_and_starts_on_its_rising_edge);
    RUN_TEST(test_host_pins_are_active_high_and_stand_for_the_stack);
    RUN_TEST(test_select_clock_data_and_conv_travel_north);
    RUN_TEST(test_data_ready_fault_and_alert_travel_south);
    RUN_TEST(test_cb_outputs_are_high_for_their_bit);
    RUN_TEST(test_gpio_is_open_drain_and_aux_switches_reg50);
    return UNITY_END();
}
