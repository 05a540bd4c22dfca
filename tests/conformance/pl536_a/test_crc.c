/* SPDX-License-Identifier: Apache-2.0 */
/* Section 6, CRC, and the ambiguities PL-AMB-01 to PL-AMB-08 and PL-AMB-16. */
#include "bench.h"
#include "sim_pl536_internal.h" /* sim_pl_crc8: the check values cannot all be put on the wire */

/* proves: PL-CRC-01, PL-VEC-01, PL-AMB-04 */
static void test_check_values(void)
{
    static const uint8_t one[] = {0x01}, high[] = {0x80}, full[] = {0xff};

    TEST_ASSERT_EQUAL_HEX8(0xf4, sim_pl_crc8(0, (const uint8_t *)"123456789", 9));
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_crc8(0, one, 0));
    TEST_ASSERT_EQUAL_HEX8(0x07, sim_pl_crc8(0, one, 1));
    TEST_ASSERT_EQUAL_HEX8(0x89, sim_pl_crc8(0, high, 1));
    TEST_ASSERT_EQUAL_HEX8(0xf3, sim_pl_crc8(0, full, 1));
    TEST_ASSERT_EQUAL_HEX8(0xf4, bench_crc((const uint8_t *)"123456789", 9)); /* and of the tests' own */
}

/* proves: PL-CRC-02, PL-CRC-05, PL-REG-05 */
static void test_only_one_of_256_crc_bytes_is_accepted(void)
{
    bench_quiet(1);
    for (int crc = 0; crc < 256; crc++) {
        uint8_t p[4] = {0x03, 0x30, 0x7d, (uint8_t)crc};

        bench_write(1, 0x30, 0x00);
        TEST_ASSERT_TRUE(bench_send(p, 4));
        TEST_ASSERT_EQUAL_HEX8(crc == 0x30 ? 0x7d : 0x00, bench_read(1, 0x30));
        TEST_ASSERT_EQUAL_HEX8(crc == 0x30 ? 0x00 : 0x04, bench_read(1, 0x21));
        bench_write(1, 0x21, 0x04);
        bench_write(1, 0x21, 0x00);
    }
}

/* proves: PL-CRC-03, PL-AMB-05 */
static void test_the_read_crc_covers_header_and_data_but_no_filler(void)
{
    bench_address(1);
    expect("spi 02 3b 01 00 00", "ok -- -- -- 81 ba");
    expect("spi 02 3b 01 ff ff", "ok -- -- -- 81 ba");
    expect("spi 02 3b 01 5a c3", "ok -- -- -- 81 ba");
    expect("inject mosi 23", "ok"); /* length 1 becomes 0: the CRC is over what the device received */
    expect("spi 02 3b 01 00 00", "ok -- -- -- b8 --");
}

/* proves: PL-CRC-05, PL-AMB-01 */
static void test_a_bad_write_sets_the_crc_flag_and_the_fault_line(void)
{
    static const char *const bad[] = {"spi 05 30 7d 00", "spi 05 30 7d",       "spi 05 30",
                                      "spi 05",          "spi 05 30 7d 4d 00", "spi 7f 30 7d 00"};
    static const char *const silence[] = {"ok -- -- -- --", "ok -- -- --",       "ok -- --",
                                          "ok --",          "ok -- -- -- -- --", "ok -- -- -- --"};

    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        bench_stack(2);
        bench_quiet(2);
        expect("get pin.fault", "ok 0");
        expect(bad[i], silence[i]);
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(2, 0x30));
        TEST_ASSERT_EQUAL_HEX8(0x04, bench_read(2, 0x21));
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(2, 0x20)); /* FAULT, not ALERT */
        TEST_ASSERT_EQUAL_HEX8(0xc1, bench_read(2, 0x00));
        expect("get pin.fault", "ok 1");
        expect("get pin.alert", "ok 0");
        expect("advance 10s", "ok"); /* until the host clears it */
        expect("get pin.fault", "ok 1");
        bench_write(ALL, 0x21, 0x04);
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(2, 0x21));
        TEST_ASSERT_EQUAL_HEX8(0x81, bench_read(2, 0x00));
        expect("get pin.fault", "ok 0");
    }
}

/* proves: PL-CRC-05, PL-CRC-04 */
static void test_no_register_and_no_command_acts_on_a_bad_crc(void)
{
    uint8_t before[256], after[256];

    bench_quiet(1);
    bench_write(1, 0x21, 0x00);
    expect("spi 03 30 7d 31", "ok -- -- -- --"); /* the flag is up from here on */
    bench_dump(1, before);
    for (int reg = 0; reg < 256; reg++) {
        uint8_t p[4] = {0x03, (uint8_t)reg, reg == 0x3c ? 0xa5 : reg == 0x3a ? 0x27 : 0x01, 0};

        p[3] = bench_crc(p, 3) ^ 0x80;
        TEST_ASSERT_TRUE(bench_send(p, 4));
        bench_dump(1, after);
        TEST_ASSERT_EQUAL_MEMORY(before, after, 256);
        expect("get dev.1.mode", "ok active");
        expect("get pin.drdy", "ok 1");
    }
}

/* proves: PL-AMB-02 */
static void test_the_crc_flag_is_sticky_and_reads_never_change_it(void)
{
    bench_quiet(1);
    expect("spi 03 30 7d 31", "ok -- -- -- --");
    bench_write(1, 0x30, 0x3d);
    bench_write(1, 0x31, 0x00);
    TEST_ASSERT_EQUAL_HEX8(0x04, bench_read(1, 0x21));
    TEST_ASSERT_EQUAL_HEX8(0x04, bench_read(1, 0x21));
    bench_write(1, 0x21, 0x00); /* writing 0 leaves it */
    TEST_ASSERT_EQUAL_HEX8(0x04, bench_read(1, 0x21));
    bench_write(1, 0x21, 0x04);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x21));
    for (int i = 0; i < 5; i++) { /* cut-off and odd reads do not set it */
        expect("spi 02 00", "ok -- --");
        expect("spi 02", "ok --");
    }
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x21));
}

/* proves: PL-CRC-06 */
static void test_a_damaged_read_request_is_answered_without_a_flag(void)
{
    bench_stack(4);
    bench_quiet(4);
    expect("inject mosi 14", "ok"); /* register 00 becomes 02 */
    expect("spi 02 00 01 00 00", "ok -- -- -- 00 ef");
    expect("inject mosi 5", "ok"); /* device 1 becomes device 3 */
    expect("spi 02 3b 01 00 00", "ok -- -- -- 83 ec");
    expect("inject mosi 4", "ok"); /* device 1 becomes device 5: nobody */
    expect("spi 02 3b 01 00 00", "ok -- -- -- -- --");
    for (int k = 1; k <= 4; k++) {
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(k, 0x21));
    }
}

/* proves: PL-CRC-08, PL-AMB-03, PL-AMB-16 */
static void test_crc_dis_shortens_packets_from_the_next_one_on(void)
{
    bench_stack(2);
    bench_quiet(2);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x41));
    expect("spi 7f 3a 35 d0", "ok -- -- -- --");
    expect("spi 7f 41 01 69", "ok -- -- -- --"); /* checked by the old rule */
    expect("spi 03 30 3d", "ok -- -- --");
    expect("spi 02 30 01 00", "ok -- -- -- 3d");
    expect("spi 02 30 01 00 00", "ok -- -- -- 3d --"); /* no CRC byte is generated */
    expect("spi 04 41 01 00", "ok -- -- -- 01");
    expect("spi 03 30 05 5f", "ok -- -- -- --"); /* four bytes are one too many: ignored, no flag */
    expect("spi 03 30 05 5f 00", "ok -- -- -- -- --");
    expect("spi 03 30", "ok -- --");
    expect("spi 02 30 01 00", "ok -- -- -- 3d");
    expect("spi 02 21 01 00", "ok -- -- -- 00");
    expect("spi 7f 3a 35", "ok -- -- --");
    expect("spi 7f 41 00", "ok -- -- --");
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x41));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(2, 0x41));
    bench_write(1, 0x30, 0x05);
    TEST_ASSERT_EQUAL_HEX8(0x05, bench_read(1, 0x30));
}

/* proves: PL-CRC-08, PL-AMB-16 */
static void test_a_bad_crc_does_not_switch_the_crc_off_and_eprom_can(void)
{
    bench_quiet(1);
    bench_write(1, 0x3a, 0x35);
    expect("spi 03 41 01 00", "ok -- -- -- --");
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x41));
    expect("set dev.1.otp.41 01", "ok");
    expect("spi 03 3a 27 33", "ok -- -- -- --");
    expect("spi 02 41 01 00", "ok -- -- -- 01");
}

/* proves: PL-AMB-03 */
static void test_io_control_has_no_crc_switch(void)
{
    bench_quiet(1);
    for (int bit = 0; bit < 8; bit++) {
        bench_write(1, 0x31, 1 << bit);
        TEST_ASSERT_EQUAL_HEX8(0x81, bench_read(1, 0x3b));
    }
}

/* proves: PL-CRC-16, PL-AMB-06, PL-BCAST-07 */
static void test_only_addressed_devices_check_and_flag(void)
{
    bench_stack(3);
    bench_quiet(3);
    expect("spi 05 30 7d 00", "ok -- -- -- --"); /* device 2 */
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x21));
    TEST_ASSERT_EQUAL_HEX8(0x04, bench_read(2, 0x21));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(3, 0x21));
    expect("spi 09 30 7d 00", "ok -- -- -- --"); /* nobody */
    expect("spi 01 30 7d 00", "ok -- -- -- --"); /* nobody: all have an address */
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x21));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(3, 0x21));
    expect("spi 7f 30 7d 00", "ok -- -- -- --"); /* everybody */
    for (int k = 1; k <= 3; k++) {
        TEST_ASSERT_EQUAL_HEX8(0x04, bench_read(k, 0x21));
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(k, 0x30));
    }
}

/* proves: PL-AMB-08 */
static void test_a_longer_write_is_never_accepted(void)
{
    uint8_t p[12] = {0x03, 0x30, 0x7d, 0x30};

    bench_quiet(1);
    for (size_t n = 5; n <= sizeof p; n++) { /* zeros behind a good write keep the CRC over all of it at 0 */
        TEST_ASSERT_TRUE(bench_send(p, n));
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x30));
        TEST_ASSERT_EQUAL_HEX8(0x04, bench_read(1, 0x21));
        bench_write(1, 0x21, 0x04);
        bench_write(1, 0x21, 0x00);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_check_values);
    RUN_TEST(test_only_one_of_256_crc_bytes_is_accepted);
    RUN_TEST(test_the_read_crc_covers_header_and_data_but_no_filler);
    RUN_TEST(test_a_bad_write_sets_the_crc_flag_and_the_fault_line);
    RUN_TEST(test_no_register_and_no_command_acts_on_a_bad_crc);
    RUN_TEST(test_the_crc_flag_is_sticky_and_reads_never_change_it);
    RUN_TEST(test_a_damaged_read_request_is_answered_without_a_flag);
    RUN_TEST(test_crc_dis_shortens_packets_from_the_next_one_on);
    RUN_TEST(test_a_bad_crc_does_not_switch_the_crc_off_and_eprom_can);
    RUN_TEST(test_io_control_has_no_crc_switch);
    RUN_TEST(test_only_addressed_devices_check_and_flag);
    RUN_TEST(test_a_longer_write_is_never_accepted);
    return UNITY_END();
}
