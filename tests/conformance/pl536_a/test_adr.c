/* SPDX-License-Identifier: Apache-2.0 */
/* Section 7, addressing, and PL-AMB-26 to PL-AMB-32. */
#include "bench.h"

/* proves: PL-ADR-01, PL-ADR-04, PL-ADR-05, PL-AMB-27 */
static void test_every_valid_address_can_be_given(void)
{
    for (int n = 0x01; n <= 0x3e; n++) {
        bench_stack(1);
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(0, 0x3b));
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(0, 0x00) & 0x80);
        bench_write(0, 0x3b, n);
        TEST_ASSERT_EQUAL_HEX8(0x80 | n, bench_read(n, 0x3b)); /* from the next packet on, and 1 = assigned */
        TEST_ASSERT_EQUAL_HEX8(0x80, bench_read(n, 0x00) & 0x80);
        TEST_ASSERT_EQUAL_HEX8(0x80, bench_read(n, 0x20)); /* here 1 = was not assigned, latched */
        TEST_ASSERT_TRUE(bench_silent(0));
        TEST_ASSERT_TRUE(bench_silent(n == 1 ? 2 : 1));
        expect_no_misuse();
    }
}

/* proves: PL-ADR-02, PL-AMB-27 */
static void test_every_reset_takes_the_address_and_raises_alert(void)
{
    for (int by_command = 0; by_command <= 1; by_command++) {
        bench_stack(1);
        bench_quiet(1);
        expect("get pin.alert", "ok 0");
        if (by_command) {
            bench_write(1, 0x3c, 0xa5);
            expect("advance 1ms", "ok");
        } else {
            expect("set dev.1.supply off", "ok");
            expect("advance 1ms", "ok");
            expect("set dev.1.supply on", "ok");
            expect("advance 57ms", "ok");
        }
        TEST_ASSERT_TRUE(bench_silent(1));
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(0, 0x3b));
        TEST_ASSERT_EQUAL_HEX8(0x80, bench_read(0, 0x20));
        TEST_ASSERT_EQUAL_HEX8(0x61, bench_read(0, 0x00));
        expect("get pin.alert", "ok 1");
    }
}

/* proves: PL-ADR-03, PL-ADR-08 */
static void test_each_assignment_opens_the_way_to_one_more_device(void)
{
    bench_stack(5);
    for (int k = 1; k <= 5; k++) {
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(0, 0x3b)); /* exactly one device answers, its CRC is right */
        for (int d = 1; d <= 5; d++) {
            TEST_ASSERT_EQUAL_HEX8(d < k ? 0x80 | d : 0x00, bench_peek(d, 0x3b));
        }
        bench_write(0, 0x3b, k);
        for (int d = k + 1; d <= 5; d++) {
            TEST_ASSERT_TRUE(bench_silent(d));
        }
    }
    TEST_ASSERT_TRUE(bench_silent(0));
    for (int k = 1; k <= 5; k++) {
        TEST_ASSERT_EQUAL_HEX8(0x80 | k, bench_read(k, 0x3b));
    }
    expect_no_misuse();
}

/* proves: PL-ADR-07, PL-AMB-28 */
static void test_the_alert_of_a_missing_address_is_latched(void)
{
    expect("get pin.alert", "ok 1");
    bench_write(0, 0x20, 0x80); /* before an address is assigned this has no effect */
    bench_write(0, 0x20, 0x00);
    TEST_ASSERT_EQUAL_HEX8(0x80, bench_read(0, 0x20));
    bench_write(0, 0x3b, 1);
    TEST_ASSERT_EQUAL_HEX8(0x80, bench_read(1, 0x20));
    expect("get pin.alert", "ok 1");
    bench_write(1, 0x20, 0x00); /* a 0 does not clear */
    TEST_ASSERT_EQUAL_HEX8(0x80, bench_read(1, 0x20));
    bench_write(1, 0x20, 0x80);
    bench_write(1, 0x20, 0x00);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x20));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x00) & 0x20);
    expect("get pin.alert", "ok 0");
}

/* proves: PL-ADR-08, PL-ADR-09, PL-BCAST-01 */
static void test_a_lost_address_hides_everything_above(void)
{
    bench_stack(4);
    bench_quiet(4);
    for (int k = 3; k <= 4; k++) {
        bench_write(k, 0x33, 0x10 + k);
    }
    bench_write(2, 0x3c, 0xa5);
    expect("advance 1ms", "ok");
    TEST_ASSERT_EQUAL_HEX8(0x81, bench_read(1, 0x3b));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(0, 0x3b)); /* device 2 */
    TEST_ASSERT_TRUE(bench_silent(2));
    TEST_ASSERT_TRUE(bench_silent(3));
    TEST_ASSERT_TRUE(bench_silent(4));
    bench_write(3, 0x33, 0x3f);
    bench_write(ALL, 0x33, 0x01);
    TEST_ASSERT_EQUAL_HEX8(0x01, bench_peek(1, 0x33));
    TEST_ASSERT_EQUAL_HEX8(0x01, bench_peek(2, 0x33));
    TEST_ASSERT_EQUAL_HEX8(0x13, bench_peek(3, 0x33));
    TEST_ASSERT_EQUAL_HEX8(0x14, bench_peek(4, 0x33));
    bench_write(0, 0x3b, 2);
    TEST_ASSERT_EQUAL_HEX8(0x82, bench_read(2, 0x3b));
    TEST_ASSERT_EQUAL_HEX8(0x83, bench_read(3, 0x3b)); /* kept their addresses and their registers */
    TEST_ASSERT_EQUAL_HEX8(0x84, bench_read(4, 0x3b));
    TEST_ASSERT_EQUAL_HEX8(0x13, bench_read(3, 0x33));
    TEST_ASSERT_EQUAL_HEX8(0x14, bench_read(4, 0x33));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(3, 0x20));
    TEST_ASSERT_EQUAL_HEX8(0x2d, bench_read(4, 0x42));
}

/* The discovery of PL-ADR-11; returns the number of devices it could address, or -1. */
static int discover(int expected)
{
    int n = 0;

    for (int look_for = 1; n < expected; look_for++) {
        bench_write(ALL, 0x3c, 0xa5);
        expect("advance 1ms", "ok");
        for (n = 1; n <= look_for; n++) {
            bench_write(0, 0x3b, n);
            if (bench_silent(n) || bench_read(n, 0x3b) != (0x80 | n)) {
                return -1;
            }
        }
        n = look_for;
    }
    return n;
}

/* proves: PL-ADR-11, PL-AMB-31 */
static void test_the_discovery_algorithm_finds_a_fresh_stack(void)
{
    for (int devices = 1; devices <= 8; devices++) {
        bench_stack(devices);
        TEST_ASSERT_EQUAL(devices, discover(devices));
        TEST_ASSERT_TRUE(bench_silent(0));
        for (int k = 1; k <= devices; k++) {
            TEST_ASSERT_EQUAL_HEX8(0x80 | k, bench_peek(k, 0x3b));
        }
        expect_no_misuse();
        TEST_ASSERT_EQUAL(-1, discover(devices + 1));
    }
}

/* proves: PL-ADR-11, PL-AMB-31 */
static void test_the_discovery_algorithm_cures_stale_addresses(void)
{
    static const int stale[][5] = {{3, 1, 2, 5, 4}, {1, 1, 1, 1, 1}, {5, 4, 3, 2, 1}, {0x3e, 2, 1, 0x20, 2}};

    for (size_t i = 0; i < sizeof stale / sizeof stale[0]; i++) {
        bench_stack(5);
        for (int k = 0; k < 5; k++) {
            bench_write(0, 0x3b, stale[i][k]);
        }
        TEST_ASSERT_EQUAL(5, discover(5));
        for (int k = 1; k <= 5; k++) {
            TEST_ASSERT_EQUAL_HEX8(0x80 | k, bench_peek(k, 0x3b));
            TEST_ASSERT_EQUAL_HEX8(0x80 | k, bench_read(k, 0x3b));
        }
        TEST_ASSERT_TRUE(bench_silent(0));
    }
}

/* proves: PL-ADR-11 */
static void test_each_pass_resets_one_more_device(void)
{
    bench_stack(4);
    bench_address(4);
    bench_write(ALL, 0x30, 0x3d);
    bench_write(ALL, 0x3c, 0xa5); /* all hear it: all were addressed */
    expect("advance 1ms", "ok");
    for (int k = 1; k <= 4; k++) {
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(k, 0x3b));
    }
    for (int pass = 1; pass <= 4; pass++) {
        bench_address(pass - 1);
        bench_write(ALL, 0x30, 0x3d); /* what hears this hears the next RESET as well */
        for (int k = 1; k <= 4; k++) {
            TEST_ASSERT_EQUAL_HEX8(k <= pass ? 0x3d : 0x00, bench_peek(k, 0x30));
        }
        bench_write(ALL, 0x3c, 0xa5);
        expect("advance 1ms", "ok");
        for (int k = 1; k <= 4; k++) {
            TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(k, 0x30));
        }
    }
}

/* proves: PL-AMB-26 */
static void test_bit_7_of_a_written_address_does_not_matter(void)
{
    static const int written[] = {0x01, 0x81, 0x20, 0xa0, 0x3e, 0xbe};

    for (size_t i = 0; i < sizeof written / sizeof written[0]; i++) {
        bench_stack(1);
        bench_write(0, 0x3b, written[i]);
        TEST_ASSERT_EQUAL_HEX8(written[i] | 0x80, bench_read(written[i] & 0x3f, 0x3b));
        TEST_ASSERT_EQUAL_HEX8(0x80, bench_read(written[i] & 0x3f, 0x00) & 0x80);
        expect_no_misuse();
    }
}

/* proves: PL-AMB-26 */
static void test_other_reading_an_address_counts_only_with_bit_7(void)
{
    static const sim_pl_options other = {.amb26_needs_bit7 = true};

    bench_stack_with(2, &other);
    bench_write(0, 0x3b, 0x01);
    TEST_ASSERT_TRUE(bench_silent(1));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(1, 0x00) & 0x80);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(1, 0x3b) & 0x80);
    bench_write(0, 0x3b, 0x81);
    TEST_ASSERT_EQUAL_HEX8(0x81, bench_read(1, 0x3b));
    TEST_ASSERT_EQUAL_HEX8(0x80, bench_read(1, 0x00) & 0x80);
    bench_write(0, 0x3b, 0x82);
    TEST_ASSERT_EQUAL_HEX8(0x82, bench_read(2, 0x3b));
}

/* proves: PL-AMB-29 */
static void test_assigning_00_takes_the_address_away(void)
{
    bench_stack(2);
    bench_quiet(2);
    bench_write(1, 0x3b, 0x00);
    TEST_ASSERT_TRUE(bench_silent(1));
    TEST_ASSERT_TRUE(bench_silent(2)); /* chip select to the north is blocked */
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(0, 0x3b));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(0, 0x00) & 0x80);
    TEST_ASSERT_EQUAL_HEX8(0x80, bench_read(0, 0x20));
    expect("get pin.alert", "ok 1");
    expect_misuse("PL-ADR-15 PL-AMB-29", 1);
}

/* proves: PL-AMB-29 */
static void test_assigning_3f_leaves_a_device_that_hears_only_broadcasts(void)
{
    static const int written[] = {0x3f, 0xbf};

    for (size_t i = 0; i < 2; i++) {
        bench_stack(2);
        bench_quiet(2);
        bench_write(1, 0x3b, written[i]);
        TEST_ASSERT_EQUAL_HEX8(0x3f, bench_peek(1, 0x3b));
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(1, 0x00) & 0x80);
        TEST_ASSERT_EQUAL_HEX8(0x80, bench_peek(1, 0x20));
        TEST_ASSERT_TRUE(bench_silent(0));
        TEST_ASSERT_TRUE(bench_silent(1));
        TEST_ASSERT_TRUE(bench_silent(2));
        TEST_ASSERT_TRUE(bench_silent(0x3f));
        bench_write(ALL, 0x33, 0x1e);
        TEST_ASSERT_EQUAL_HEX8(0x1e, bench_peek(1, 0x33));
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(2, 0x33));
        expect_misuse("PL-ADR-15 PL-AMB-29", 1);
    }
}

/* proves: PL-AMB-30 */
static void test_an_addressed_device_takes_a_new_address(void)
{
    bench_stack(2);
    bench_quiet(2);
    bench_write(2, 0x3b, 0x15);
    TEST_ASSERT_TRUE(bench_silent(2));
    TEST_ASSERT_EQUAL_HEX8(0x95, bench_read(0x15, 0x3b));
    TEST_ASSERT_EQUAL_HEX8(0x81, bench_read(0x15, 0x00)); /* AR stays, no alert */
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(0x15, 0x20));
    bench_write(1, 0x3b, 0x07);
    TEST_ASSERT_EQUAL_HEX8(0x87, bench_read(0x07, 0x3b));
    TEST_ASSERT_EQUAL_HEX8(0x95, bench_read(0x15, 0x3b)); /* still reachable */
}

/* proves: PL-AMB-32 */
static void test_stacks_of_1_to_62_devices_exist(void)
{
    sim_pl *pl = bench_pl();

    TEST_ASSERT_EQUAL(-1, sim_pl_init(pl, 0, NULL));
    TEST_ASSERT_EQUAL(-1, sim_pl_init(pl, 63, NULL));
    TEST_ASSERT_EQUAL(0, sim_pl_init(pl, 62, NULL));
    TEST_ASSERT_EQUAL(0, sim_pl_init(pl, 1, NULL));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_valid_address_can_be_given);
    RUN_TEST(test_every_reset_takes_the_address_and_raises_alert);
    RUN_TEST(test_each_assignment_opens_the_way_to_one_more_device);
    RUN_TEST(test_the_alert_of_a_missing_address_is_latched);
    RUN_TEST(test_a_lost_address_hides_everything_above);
    RUN_TEST(test_the_discovery_algorithm_finds_a_fresh_stack);
    RUN_TEST(test_the_discovery_algorithm_cures_stale_addresses);
    RUN_TEST(test_each_pass_resets_one_more_device);
    RUN_TEST(test_bit_7_of_a_written_address_does_not_matter);
    RUN_TEST(test_other_reading_an_address_counts_only_with_bit_7);
    RUN_TEST(test_assigning_00_takes_the_address_away);
    RUN_TEST(test_assigning_3f_leaves_a_device_that_hears_only_broadcasts);
    RUN_TEST(test_an_addressed_device_takes_a_new_address);
    RUN_TEST(test_stacks_of_1_to_62_devices_exist);
    return UNITY_END();
}
