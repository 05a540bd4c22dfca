/* SPDX-License-Identifier: Apache-2.0 */
/* Section 35, packet vectors: everything the host writes. The bytes are those of the requirements, sent as
 * they stand. */
#include "bench.h"
#include <stdio.h>

#define WROTE "ok -- -- -- --"

/* proves: PL-VEC-02, PL-VEC-03 */
static void test_resets(void)
{
    bench_stack(2);
    bench_address(2);
    expect("spi 03 3c a5 ca", WROTE);
    expect("get dev.1.mode", "ok reset");
    expect("get dev.2.mode", "ok active");
    expect("advance 1ms", "ok");
    expect("get dev.1.mode", "ok active");
    expect("spi 01 3c a5 1c", WROTE);
    expect("get dev.1.mode", "ok reset");
    expect("advance 1ms", "ok");
    bench_write(0, 0x3b, 1);
    TEST_ASSERT_EQUAL_HEX8(0x82, bench_read(2, 0x3b));
    expect("spi 7f 3c a5 57", WROTE);
    expect("get dev.1.mode", "ok reset");
    expect("get dev.2.mode", "ok reset");
    expect_no_misuse();
}

/* proves: PL-VEC-04, PL-VEC-05, PL-VEC-06, PL-VEC-08, PL-VEC-09, PL-VEC-10 */
static void test_assignments(void)
{
    bench_stack(6);
    expect("spi 01 3b 01 02", WROTE);
    expect("spi 01 3b 02 0b", WROTE);
    expect("spi 01 3b 03 0c", WROTE);
    expect("spi 01 3b 04 19", WROTE);
    expect("spi 01 3b 20 e5", WROTE);
    expect("spi 01 3b 3e bf", WROTE);
    expect("spi 02 3b 01 00 00", "ok -- -- -- 81 ba");
    expect("spi 04 3b 01 00 00", "ok -- -- -- 82 c7");
    TEST_ASSERT_EQUAL_HEX8(0x83, bench_read(3, 0x3b));
    TEST_ASSERT_EQUAL_HEX8(0x84, bench_read(4, 0x3b));
    TEST_ASSERT_EQUAL_HEX8(0xa0, bench_read(0x20, 0x3b));
    expect("spi 7c 3b 01 00 00", "ok -- -- -- be f1");
    expect_no_misuse();
}

/* proves: PL-VEC-07, PL-VEC-10 */
static void test_assignments_with_bit_7(void)
{
    bench_stack(3);
    expect("spi 01 3b 81 8b", WROTE);
    expect("spi 01 3b 82 82", WROTE);
    expect("spi 01 3b be 36", WROTE);
    expect("spi 02 3b 01 00 00", "ok -- -- -- 81 ba");
    expect("spi 04 3b 01 00 00", "ok -- -- -- 82 c7");
    expect("spi 7c 3b 01 00 00", "ok -- -- -- be f1");
    expect_no_misuse();
}

/* proves: PL-VEC-12 */
static void test_conversion_starts(void)
{
    bench_stack(2);
    bench_address(2);
    expect("spi 03 34 01 17", WROTE);
    expect("advance 1ms", "ok");
    TEST_ASSERT_EQUAL(1, sim_pl_conversions(bench_pl(), 1));
    TEST_ASSERT_EQUAL(0, sim_pl_conversions(bench_pl(), 2));
    expect("advance 10ms", "ok");
    expect("spi 7f 34 01 8a", WROTE);
    expect("advance 1ms", "ok");
    TEST_ASSERT_EQUAL(2, sim_pl_conversions(bench_pl(), 1));
    TEST_ASSERT_EQUAL(1, sim_pl_conversions(bench_pl(), 2));
    expect_no_misuse();
}

/* proves: PL-VEC-13 */
static void test_adc_control(void)
{
    bench_stack(2);
    bench_address(2);
    expect("spi 03 30 7d 30", WROTE);
    TEST_ASSERT_EQUAL_HEX8(0x7d, bench_read(1, 0x30));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(2, 0x30));
    expect("spi 7f 30 7d ad", WROTE);
    TEST_ASSERT_EQUAL_HEX8(0x7d, bench_read(2, 0x30));
    expect("spi 7f 30 3d 6a", WROTE);
    TEST_ASSERT_EQUAL_HEX8(0x3d, bench_read(1, 0x30));
    TEST_ASSERT_EQUAL_HEX8(0x3d, bench_read(2, 0x30));
}

/* The key to everybody, then a register: read back from both devices. Without the key the same packet does
 * nothing. */
static void broadcast_pair(const char *packet, int reg, int value)
{
    bench_stack(2);
    bench_address(2);
    bench_write(ALL, 0x30, 0x40); /* ADC_ON first, so that no conversion speed is dangerous */
    expect(packet, WROTE);
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(0x00, bench_read(1, reg), packet);
    sim_misuse_clear(sim_pl_misuse(bench_pl()));
    expect("spi 7f 3a 35 d0", WROTE);
    expect(packet, WROTE);
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(value, bench_read(1, reg), packet);
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(value, bench_read(2, reg), packet);
}

/* proves: PL-VEC-14, PL-VEC-15, PL-VEC-17, PL-VEC-18, PL-VEC-19, PL-VEC-20, PL-VEC-21 */
static void test_broadcast_pairs(void)
{
    broadcast_pair("spi 7f 40 50 cc", 0x40, 0x50);
    broadcast_pair("spi 7f 42 2c 95", 0x42, 0x2c);
    broadcast_pair("spi 7f 43 85 d6", 0x43, 0x85);
    broadcast_pair("spi 7f 44 15 44", 0x44, 0x15);
    broadcast_pair("spi 7f 45 85 a8", 0x45, 0x85);
    broadcast_pair("spi 7f 46 55 a9", 0x46, 0x55);
    broadcast_pair("spi 7f 47 64 2b", 0x47, 0x64);
}

/* proves: PL-VEC-14, PL-VEC-16, PL-VEC-23 */
static void test_pairs_to_device_1(void)
{
    bench_stack(2);
    bench_address(2);
    bench_write(ALL, 0x30, 0x40);
    expect("spi 03 3a 35 4d", WROTE);
    expect("spi 03 40 50 51", WROTE);
    TEST_ASSERT_EQUAL_HEX8(0x50, bench_read(1, 0x40));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(2, 0x40));
    expect("spi 03 3a 35 4d", WROTE);
    expect("spi 03 48 5a cf", WROTE);
    TEST_ASSERT_EQUAL_HEX8(0x5a, bench_read(1, 0x48));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(2, 0x48));
    expect_no_misuse();
}

/* proves: PL-VEC-22 */
static void test_crc_off_and_on_again(void)
{
    bench_stack(2);
    bench_address(2);
    expect("spi 7f 3a 35 d0", WROTE);
    expect("spi 7f 41 01 69", WROTE);
    TEST_ASSERT_EQUAL_HEX8(0x01, bench_peek(1, 0x41));
    TEST_ASSERT_EQUAL_HEX8(0x01, bench_peek(2, 0x41));
    expect("spi 7f 3a 35", "ok -- -- --");
    expect("spi 7f 41 00", "ok -- -- --");
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x41));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(2, 0x41));
    expect_no_misuse();
}

/* proves: PL-VEC-24 */
static void test_reload_of_group_3(void)
{
    bench_stack(2);
    bench_address(2);
    expect("set dev.*.otp.48 77", "ok");
    expect("spi 03 3a 27 33", WROTE);
    TEST_ASSERT_EQUAL_HEX8(0x77, bench_read(1, 0x48));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(2, 0x48));
    bench_shadow(1, 0x48, 0x01);
    expect("spi 7f 3a 27 ae", WROTE);
    TEST_ASSERT_EQUAL_HEX8(0x77, bench_read(1, 0x48));
    TEST_ASSERT_EQUAL_HEX8(0x77, bench_read(2, 0x48));
    expect_no_misuse();
}

/* proves: PL-VEC-25, PL-VEC-26 */
static void test_thermistors_sleep_and_alert_flags(void)
{
    bench_stack(2);
    bench_address(2);
    expect("spi 7f 20 80 07", WROTE);
    expect("spi 7f 20 00 8e", WROTE);
    expect("get pin.alert", "ok 0");
    expect("spi 7f 31 03 c5", WROTE);
    TEST_ASSERT_EQUAL_HEX8(0x03, bench_read(2, 0x31));
    expect("spi 7f 31 04 d0", WROTE);
    expect("get dev.1.mode", "ok sleep");
    expect("get dev.2.mode", "ok sleep");
    expect("get pin.alert", "ok 1");
    TEST_ASSERT_EQUAL_HEX8(0x04, bench_read(2, 0x20));
    expect("spi 7f 20 04 92", WROTE);
    expect("spi 7f 20 00 8e", WROTE);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(2, 0x20));
    expect("get pin.alert", "ok 0");
    expect("spi 7f 31 00 cc", WROTE);
    expect("get dev.2.mode", "ok active");
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(2, 0x31));
    expect("spi 7f 31 04 d0", WROTE);
    expect("spi 7f 31 03 c5", WROTE);
    expect("get dev.1.mode", "ok active");
    TEST_ASSERT_EQUAL_HEX8(0x03, bench_read(1, 0x31));
    expect_no_misuse();
}

/* proves: PL-VEC-27, PL-VEC-28 */
static void test_fault_flags(void)
{
    bench_stack(3);
    bench_address(3);
    for (int reg = 0x42; reg <= 0x45; reg++) {
        static const int value[] = {0x2d, 0x85, 0x15, 0x85};

        bench_shadow(ALL, reg, value[reg - 0x42]);
    }
    TEST_ASSERT_EQUAL_HEX8(0x08, bench_read(3, 0x21));
    expect("spi 7f 21 08 a3", WROTE);
    expect("spi 7f 21 00 9b", WROTE);
    for (int k = 1; k <= 3; k++) {
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(k, 0x21));
    }
    expect("spi 05 30 11 00", WROTE); /* a wrong CRC */
    TEST_ASSERT_EQUAL_HEX8(0x04, bench_read(2, 0x21));
    expect("spi 05 21 04 67", WROTE);
    expect("spi 05 21 00 7b", WROTE);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(2, 0x21));
    expect("set dev.3.cell.1 4.3", "ok");
    expect("set dev.3.cell.2 2.7", "ok");
    expect("advance 501ms", "ok");
    TEST_ASSERT_EQUAL_HEX8(0x03, bench_read(3, 0x21));
    expect("set dev.3.cell.1 3.6", "ok");
    expect("set dev.3.cell.2 3.6", "ok");
    expect("spi 07 21 03 a4", WROTE);
    expect("spi 07 21 00 ad", WROTE);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(3, 0x21));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(3, 0x22));
    expect("get pin.fault", "ok 0");
}

/* proves: PL-VEC-29 */
static void test_self_test_from_the_top_of_four(void)
{
    bench_stack(4);
    bench_quiet(4);
    expect("spi 09 21 10 f1", WROTE);
    expect("get pin.fault", "ok 1");
    expect("get pin.alert", "ok 0");
    expect("spi 09 21 00 81", WROTE);
    expect("get pin.fault", "ok 0");
    expect("spi 09 20 10 e4", WROTE);
    expect("get pin.alert", "ok 1");
    expect("get pin.fault", "ok 0");
    expect("spi 09 20 00 94", WROTE);
    expect("get pin.alert", "ok 0");
    expect_no_misuse();
}

/* proves: PL-VEC-30, PL-VEC-31, PL-VEC-44 */
static void test_balancing(void)
{
    bench_stack(2);
    bench_address(2);
    expect("spi 03 33 1e 21", WROTE);
    expect("spi 03 32 00 6e", WROTE);
    expect("spi 03 32 12 10", WROTE);
    expect("get dev.1.cb", "ok 12");
    expect("get dev.2.cb", "ok 00");
    expect("spi 02 32 02 00 00 00", "ok -- -- -- 12 1e b0");
    expect("advance 29999ms", "ok");
    expect("get dev.1.cb", "ok 12");
    expect("advance 2ms", "ok");
    expect("get dev.1.cb", "ok 00");
    expect("spi 03 32 00 6e", WROTE);
    expect("spi 03 32 12 10", WROTE);
    expect("spi 03 32 00 6e", WROTE);
    expect("get dev.1.cb", "ok 00");
    bench_write(2, 0x33, 0x1e);
    bench_write(2, 0x32, 0x05);
    expect("get dev.2.cb", "ok 05");
    expect("spi 7f 32 00 f3", WROTE);
    expect("get dev.2.cb", "ok 00");
    expect_no_misuse();
}

/* proves: PL-VEC-32 */
static void test_programming(void)
{
    bench_stack(2);
    bench_quiet(2);
    bench_shadow(1, 0x48, 0x5a);
    expect("set dev.1.vpp on", "ok");
    expect("spi 03 3f 91 79", WROTE);
    expect("advance 2500us", "ok");
    expect("set dev.1.vpp off", "ok");
    expect("get dev.1.otp.48", "ok 5a");
    expect("get dev.1.otp.42", "ok 2d");
    expect("get dev.2.otp.42", "ok 00");
    expect_no_misuse();
}

/* proves: PL-VEC-46, PL-VEC-47, PL-VEC-48, PL-VEC-49 */
static void test_discarded_writes(void)
{
    static const char *const bad[][2] = {
        {"spi 03 30 7d 31", WROTE}, {"spi 03 30 7c 30", WROTE}, {"spi 03 30 7d", "ok -- -- --"},
        {"spi 03 30", "ok -- --"},  {"spi 03", "ok --"},        {"spi 03 30 7d 30 00", "ok -- -- -- -- --"},
    };

    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        bench_stack(1);
        bench_quiet(1);
        expect(bad[i][0], bad[i][1]);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(0x00, bench_read(1, 0x30), bad[i][0]);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(0x04, bench_read(1, 0x21), bad[i][0]);
        expect("get pin.fault", "ok 1");
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_resets);
    RUN_TEST(test_assignments);
    RUN_TEST(test_assignments_with_bit_7);
    RUN_TEST(test_conversion_starts);
    RUN_TEST(test_adc_control);
    RUN_TEST(test_broadcast_pairs);
    RUN_TEST(test_pairs_to_device_1);
    RUN_TEST(test_crc_off_and_on_again);
    RUN_TEST(test_reload_of_group_3);
    RUN_TEST(test_thermistors_sleep_and_alert_flags);
    RUN_TEST(test_fault_flags);
    RUN_TEST(test_self_test_from_the_top_of_four);
    RUN_TEST(test_balancing);
    RUN_TEST(test_programming);
    RUN_TEST(test_discarded_writes);
    return UNITY_END();
}
