/* SPDX-License-Identifier: Apache-2.0 */
/* The other readings of ambiguous facts of the bus. Each test runs the same steps under the chosen reading
 * (0) and the other one (1). */
#include "bench.h"

static void quiet(int n, const sim_pl_options *options)
{
    bench_stack_with(n, options);
    bench_address(n);
    bench_shadow(ALL, 0x42, 0x2d);
    bench_write(ALL, 0x20, 0x80);
    bench_write(ALL, 0x20, 0x00);
    bench_write(ALL, 0x21, 0x08);
    bench_write(ALL, 0x21, 0x00);
    expect("get pin.fault", "ok 0");
    expect("get pin.alert", "ok 0");
}

/* proves: PL-AMB-01 */
static void test_crc_error_on_fault_or_on_both_lines(void)
{
    for (int other = 0; other <= 1; other++) {
        const sim_pl_options options = {.amb01_crc_alert = other != 0};

        quiet(2, &options);
        expect("spi 05 30 7d 00", "ok -- -- -- --");
        expect("get pin.fault", "ok 1");
        expect("get pin.alert", other ? "ok 1" : "ok 0");
        TEST_ASSERT_EQUAL_HEX8(0x04, bench_read(2, 0x21));
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(2, 0x20)); /* there is no bit for it in ALERT_STATUS */
        bench_write(2, 0x21, 0x04);
        bench_write(2, 0x21, 0x00);
        expect("get pin.fault", "ok 0");
        expect("get pin.alert", "ok 0");
    }
}

/* proves: PL-AMB-02 */
static void test_crc_flag_sticky_or_of_the_last_packet(void)
{
    for (int other = 0; other <= 1; other++) {
        const sim_pl_options options = {.amb02_crc_last_packet = other != 0};

        quiet(2, &options);
        expect("spi 05 30 7d 00", "ok -- -- -- --");
        TEST_ASSERT_EQUAL_HEX8(0x04, bench_read(2, 0x21)); /* a read changes it under neither */
        TEST_ASSERT_EQUAL_HEX8(0x04, bench_read(2, 0x21));
        bench_write(1, 0x31, 0x00);
        TEST_ASSERT_EQUAL_HEX8(0x04, bench_read(2, 0x21));
        bench_write(2, 0x31, 0x00);
        TEST_ASSERT_EQUAL_HEX8(other ? 0x00 : 0x04, bench_read(2, 0x21));
        expect("get pin.fault", other ? "ok 0" : "ok 1");
    }
}

/* proves: PL-AMB-06, PL-CRC-16 */
static void test_crc_checked_by_the_addressed_or_by_all(void)
{
    for (int other = 0; other <= 1; other++) {
        const sim_pl_options options = {.amb06_all_check = other != 0};

        quiet(3, &options);
        expect("spi 05 30 7d 00", "ok -- -- -- --");
        TEST_ASSERT_EQUAL_HEX8(other ? 0x04 : 0x00, bench_read(1, 0x21));
        TEST_ASSERT_EQUAL_HEX8(0x04, bench_read(2, 0x21));
        TEST_ASSERT_EQUAL_HEX8(other ? 0x04 : 0x00, bench_read(3, 0x21));
        bench_write(2, 0x31, 0x03); /* a good one is executed by its device alone */
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x31));
        TEST_ASSERT_EQUAL_HEX8(0x03, bench_read(2, 0x31));
    }
}

/* proves: PL-AMB-18, PL-AMB-19 */
static void test_broadcast_to_a_device_without_address(void)
{
    for (int other = 0; other <= 1; other++) {
        const sim_pl_options options = {.amb18_addressed_only = other != 0};

        bench_stack_with(3, &options);
        bench_write(0, 0x3b, 1);
        bench_write(ALL, 0x31, 0x03);
        TEST_ASSERT_EQUAL_HEX8(0x03, bench_peek(1, 0x31));
        TEST_ASSERT_EQUAL_HEX8(other ? 0x00 : 0x03, bench_peek(2, 0x31));
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(3, 0x31)); /* blocked under both */
        bench_write(0, 0x31, 0x01);                        /* unicast reaches it under both */
        TEST_ASSERT_EQUAL_HEX8(0x01, bench_peek(2, 0x31));
        bench_write(ALL, 0x3c, 0xa5); /* RESET is heard whatever the address */
        expect("get dev.1.mode", "ok reset");
        expect("get dev.2.mode", "ok reset");
        expect("get dev.3.mode", "ok active");
    }
}

/* proves: PL-AMB-28 */
static void test_address_alert_latched_or_copied(void)
{
    for (int other = 0; other <= 1; other++) {
        const sim_pl_options options = {.amb28_ar_copy = other != 0};

        bench_stack_with(1, &options);
        TEST_ASSERT_EQUAL_HEX8(0x80, bench_read(0, 0x20));
        bench_write(0, 0x3b, 1);
        TEST_ASSERT_EQUAL_HEX8(other ? 0x00 : 0x80, bench_read(1, 0x20));
        expect("get pin.alert", other ? "ok 0" : "ok 1");
        bench_write(1, 0x20, 0x80);
        bench_write(1, 0x20, 0x00);
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x20));
        expect("get pin.alert", "ok 0");
    }
}

/* proves: PL-AMB-99 */
static void test_key_after_a_discarded_write(void)
{
    for (int other = 0; other <= 1; other++) {
        const sim_pl_options options = {.amb99_discarded_cancels = other != 0};

        bench_stack_with(2, &options);
        bench_address(2);
        bench_write(1, 0x3a, 0x35);
        expect("spi 03 31 00 00", "ok -- -- -- --"); /* wrong CRC */
        bench_write(1, 0x48, 0x5a);
        TEST_ASSERT_EQUAL_HEX8(other ? 0x00 : 0x5a, bench_read(1, 0x48));
        bench_write(1, 0x3a, 0x35); /* traffic to another device leaves it under both */
        bench_write(2, 0x31, 0x00);
        bench_write(1, 0x48, 0x5b);
        TEST_ASSERT_EQUAL_HEX8(0x5b, bench_read(1, 0x48));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_crc_error_on_fault_or_on_both_lines);
    RUN_TEST(test_crc_flag_sticky_or_of_the_last_packet);
    RUN_TEST(test_crc_checked_by_the_addressed_or_by_all);
    RUN_TEST(test_broadcast_to_a_device_without_address);
    RUN_TEST(test_address_alert_latched_or_copied);
    RUN_TEST(test_key_after_a_discarded_write);
    return UNITY_END();
}
