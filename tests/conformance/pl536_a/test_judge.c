/* SPDX-License-Identifier: Apache-2.0 */
/* The judge's book: each thing that the requirements forbid on the bus is recorded with an ID, and a correct
 * host has none. */
#include "bench.h"
#include <stdio.h>

/* A quiet stack of two with an empty book. */
static void clean(void)
{
    bench_stack(2);
    bench_quiet(2);
    expect_no_misuse();
}

/* proves: PL-PKT-12 */
static void test_reads_that_are_undefined(void)
{
    clean();
    expect("spi 04 00 00 00", "ok -- -- -- ab");
    expect_misuse("PL-PKT-12 PL-AMB-09", 2);
    expect("spi 04 4b 02 00 00 00", "ok -- -- -- 00 00 48");
    expect_misuse("PL-PKT-14 PL-PKT-12 PL-AMB-10", 2);
    expect("spi 04 3b 01 00 00 00", "ok -- -- -- 82 c7 --");
    expect_misuse("PL-PKT-04 PL-PKT-12 PL-AMB-11", 2);
    expect("spi 04 30 01 00", "ok -- -- -- 00");
    expect_misuse("PL-PKT-04 PL-PKT-11", 2);
    expect("spi 7e 00 01 00 00", "ok -- -- -- -- --");
    expect_misuse("PL-BCAST-02 PL-AMB-17", -1);
    expect("spi 84 00 01 00 00", "ok -- -- -- -- --");
    expect_misuse("PL-PKT-01 PL-AMB-14", -1);
    (void)bench_read(2, 0x4b);
    expect_no_misuse();
}

/* proves: PL-PKT-03, PL-CRC-02 */
static void test_writes_of_wrong_form(void)
{
    clean();
    expect("spi 05 30 05 23", "ok -- -- -- --");
    expect_misuse("PL-CRC-02 PL-CRC-05", 2);
    expect("spi 05 30 05", "ok -- -- --");
    expect_misuse("PL-PKT-03 PL-AMB-07", 2);
    expect("spi 05 30 05 22 00", "ok -- -- -- -- --");
    expect_misuse("PL-PKT-03 PL-AMB-08", 2);
    expect("spi 05 30 05 22", "ok -- -- -- --");
    expect_no_misuse();
}

/* proves: PL-REG-02 */
static void test_writes_where_nothing_may_be_written(void)
{
    static const int reserved[] = {0x13, 0x1f, 0x26, 0x2f, 0x35, 0x39, 0x3e, 0x4c, 0x4f, 0x50, 0xff};
    static const int read_only[] = {0x00, 0x01, 0x0e, 0x12, 0x22, 0x23, 0x24, 0x25};
    static const int undefined_bits[][2] = {{0x21, 0x40}, {0x30, 0x80}, {0x31, 0x08}, {0x31, 0x10},
                                            {0x32, 0x40}, {0x33, 0x40}, {0x34, 0x02}};

    clean();
    for (size_t i = 0; i < sizeof reserved / sizeof reserved[0]; i++) {
        bench_write(2, reserved[i], 0x00);
        expect_misuse("PL-REG-01 PL-AMB-106 PL-AMB-101", 2);
    }
    for (size_t i = 0; i < sizeof read_only / sizeof read_only[0]; i++) {
        bench_write(2, read_only[i], 0x00);
        expect_misuse("PL-REG-03 PL-AMB-106", 2);
    }
    for (size_t i = 0; i < sizeof undefined_bits / sizeof undefined_bits[0]; i++) {
        bench_write(2, undefined_bits[i][0], undefined_bits[i][1]);
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(2, undefined_bits[i][0]));
        expect_misuse("PL-REG-02", 2);
    }
    bench_shadow(2, 0x41, 0x02);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(2, 0x41));
    expect_misuse("PL-REG-02 PL-G3-11", 2);
    bench_write(2, 0x31, 0x20); /* GPIO_IN copied back */
    expect_misuse("PL-GPIO-06 PL-REG-02", 2);
}

/* proves: PL-AMB-15, PL-AMB-29 */
static void test_addressing_rules(void)
{
    clean();
    bench_write(ALL, 0x3b, 5); /* by broadcast */
    expect_misuse("PL-ADR-15", 1);
    clean();
    bench_write(2, 0x3b, 0x00);
    expect_misuse("PL-ADR-15 PL-AMB-29", 2);
    clean();
    bench_write(2, 0x3b, 0x3f);
    expect_misuse("PL-ADR-15 PL-AMB-29", 2);
    bench_stack(2);
    bench_write(0, 0x3b, 1);
    bench_write(0, 0x3b, 1); /* the same address twice */
    expect_misuse("PL-ADR-15 PL-AMB-15 PL-VB-09", 2);
    expect("spi 02 3b 01 00 00", "ok -- -- -- 81 ba");
    expect_misuse("PL-AMB-15 PL-VB-09 PL-ADR-15", -1);
}

/* proves: PL-G3-02 */
static void test_group_3_needs_its_key(void)
{
    clean();
    bench_write(2, 0x48, 0x11);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(2, 0x48));
    expect_misuse("PL-G3-02 PL-G3-04", 2);
    bench_write(2, 0x3a, 0x35);
    bench_write(2, 0x31, 0x00);
    bench_write(2, 0x48, 0x11);
    expect_misuse("PL-G3-02 PL-G3-03 PL-G3-04 PL-AMB-99", 2);
    bench_shadow(2, 0x48, 0x11);
    bench_write(ALL, 0x3a, 0x35);
    bench_write(1, 0x48, 0x12);
    bench_write(2, 0x48, 0x13);
    TEST_ASSERT_EQUAL_HEX8(0x12, bench_read(1, 0x48));
    TEST_ASSERT_EQUAL_HEX8(0x13, bench_read(2, 0x48));
    expect_no_misuse();
}

/* proves: PL-POR-07, PL-TEST-04 */
static void test_codes_of_the_special_registers(void)
{
    clean();
    bench_write(2, 0x3c, 0xa4);
    expect("get dev.2.mode", "ok active");
    expect_misuse("PL-POR-07 PL-REG-33", 2);
    bench_write(2, 0x3a, 0x12);
    expect_misuse("PL-REG-31 PL-G3-02", 2);
    bench_write(2, 0x3f, 0x90);
    expect_misuse("PL-OTP-05 PL-REG-36", 2);
    bench_write(2, 0x3d, 0xa4);
    expect_misuse("PL-TEST-03", 2);
    bench_write(2, 0x3d, 0x00);
    expect_no_misuse();
    bench_write(1, 0x3d, 0xa4);
    expect_misuse("PL-TEST-03", 1);
    bench_write(1, 0x3d, 0x25);
    expect_misuse("PL-TEST-04 PL-AMB-108", 1);
    TEST_ASSERT_TRUE(bench_silent(1));
}

/* proves: PL-OTP-04 */
static void test_programming_rules(void)
{
    clean();
    bench_write(2, 0x3f, 0x91); /* without the voltage */
    expect_misuse("PL-OTP-04 PL-AMB-103", 2);
    expect("advance 10ms", "ok");
    expect("get dev.2.otp.42", "ok 00");
    clean();
    expect("set dev.2.vbat 19.9", "ok"); /* less than 20 V */
    expect("set dev.2.vpp on", "ok");
    bench_write(2, 0x3f, 0x91);
    expect_misuse("PL-OTP-03 PL-ELEC-12", 2);
    clean();
    expect("set dev.2.vpp on", "ok");
    bench_write(2, 0x3f, 0x91);
    bench_advance_us(100);
    (void)bench_read(2, 0x00); /* an access while it runs */
    expect_misuse("PL-OTP-05 PL-AMB-103", 2);
    clean();
    expect("set dev.2.vpp on", "ok");
    bench_write(2, 0x3f, 0x91);
    bench_advance_us(1000);
    expect("set dev.2.vpp off", "ok"); /* before 1.5 ms */
    expect_misuse("PL-OTP-06 PL-AMB-105 PL-TIM-26", 2);
}

/* A host that does everything right: discovery, set-up, measuring, balancing, flags, sleep, programming,
 * reset. */
static void work(int n)
{
    uint8_t block[19];

    bench_write(ALL, 0x3c, 0xa5);
    expect("advance 1ms", "ok");
    bench_quiet(n);
    bench_write(ALL, 0x30, 0x7d);
    expect("advance 1ms", "ok");
    bench_shadow(ALL, 0x40, 0x50);
    bench_write(ALL, 0x31, 0x03);
    for (int cycle = 0; cycle < 3; cycle++) {
        bench_write(ALL, 0x34, 0x01);
        bench_advance_us(70);
        for (int k = 1; k <= n; k++) {
            bench_read_block(k, 0x00, 19, block);
            TEST_ASSERT_EQUAL_HEX8(0x81, block[0]);
            TEST_ASSERT_EQUAL_HEX8(0x24, block[3]);
        }
        bench_write(ALL, 0x33, 0x05);
        bench_write(1, 0x32, 0x00);
        bench_write(1, 0x32, 0x15);
        expect("advance 1s", "ok");
        bench_write(ALL, 0x32, 0x00);
        expect("advance 20ms", "ok");
    }
    expect("set pin.conv 1", "ok");
    bench_advance_us(70);
    expect("set pin.conv 0", "ok");
    bench_write(n, 0x21, 0x10);
    bench_write(n, 0x21, 0x00);
    bench_write(ALL, 0x31, 0x04);
    bench_write(ALL, 0x20, 0x04);
    bench_write(ALL, 0x20, 0x00);
    expect("advance 1h", "ok");
    bench_write(ALL, 0x31, 0x03);
    expect("advance 1ms", "ok");
    bench_write(ALL, 0x34, 0x01);
    bench_advance_us(70);
    bench_read_block(n, 0x00, 19, block);
}

static void test_a_correct_host_has_an_empty_book(void)
{
    static const int heights[] = {1, 2, 5, 62};

    for (size_t i = 0; i < sizeof heights / sizeof heights[0]; i++) {
        bench_stack(heights[i]);
        work(heights[i]);
        expect_no_misuse();
    }
}

static void test_what_the_bus_did_is_not_held_against_the_host(void)
{
    char line[40];

    for (int bit = 0; bit < 32; bit++) {
        clean();
        (void)snprintf(line, sizeof line, "inject mosi %d", bit);
        expect(line, "ok");
        bench_send((const uint8_t[]){0x05, 0x31, 0x00, 0x2c}, 4);
        expect(line, "ok");
        bench_send((const uint8_t[]){0x04, 0x00, 0x01, 0x00, 0x00}, 5);
        expect_no_misuse();
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_reads_that_are_undefined);
    RUN_TEST(test_writes_of_wrong_form);
    RUN_TEST(test_writes_where_nothing_may_be_written);
    RUN_TEST(test_addressing_rules);
    RUN_TEST(test_group_3_needs_its_key);
    RUN_TEST(test_codes_of_the_special_registers);
    RUN_TEST(test_programming_rules);
    RUN_TEST(test_a_correct_host_has_an_empty_book);
    RUN_TEST(test_what_the_bus_did_is_not_held_against_the_host);
    return UNITY_END();
}
