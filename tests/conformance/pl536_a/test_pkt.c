/* SPDX-License-Identifier: Apache-2.0 */
/* Section 5, packets. */
#include "bench.h"

static void expect_unchanged(int device, const uint8_t before[256])
{
    uint8_t after[256];

    bench_dump(device, after);
    TEST_ASSERT_EQUAL_MEMORY(before, after, 256);
}

/* proves: PL-PKT-01, PL-PKT-02 */
static void test_first_byte_is_address_and_direction_second_the_register(void)
{
    bench_stack(5);
    bench_quiet(5);
    expect("spi 0b 33 15 41", "ok -- -- -- --"); /* device 5: 5 x 2 + 1 */
    TEST_ASSERT_EQUAL_HEX8(0x15, bench_peek(5, 0x33));
    for (int k = 1; k <= 4; k++) {
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(k, 0x33));
    }
    expect("spi 0a 33 01 00 00", "ok -- -- -- 15 be"); /* the same with bit 0 = 0 reads */
    TEST_ASSERT_EQUAL_HEX8(0x15, bench_peek(5, 0x33));
    expect_no_misuse();
}

/* proves: PL-PKT-01, PL-AMB-14 */
static void test_bit_7_of_the_first_byte_matches_nobody(void)
{
    uint8_t before[256];
    static const int first[] = {0x82, 0x83, 0x80, 0x81, 0xff, 0xfe};

    bench_quiet(1);
    bench_dump(1, before);
    for (size_t i = 0; i < sizeof first / sizeof first[0]; i++) {
        uint8_t write[4] = {(uint8_t)first[i], 0x30, 0x7d, 0},
                read[5] = {(uint8_t)first[i], 0x00, 0x01, 0, 0};

        write[3] = bench_crc(write, 3);
        TEST_ASSERT_TRUE(bench_send(write, 4));
        TEST_ASSERT_TRUE(bench_send(read, 5));
        TEST_ASSERT_TRUE(bench_send(write, 3));
    }
    expect_unchanged(1, before); /* no flag either: the packet is not for this device */
}

/* proves: PL-PKT-03 */
static void test_a_write_is_four_bytes_and_changes_one_register(void)
{
    uint8_t before[256], after[256];

    bench_quiet(1);
    bench_dump(1, before);
    bench_write(1, 0x30, 0x7d);
    bench_dump(1, after);
    for (int reg = 0; reg < 256; reg++) {
        TEST_ASSERT_EQUAL_HEX8(reg == 0x30 ? 0x7d : before[reg], after[reg]);
    }
    expect("spi 03 30 11 22 77", "ok -- -- -- -- --"); /* two data bytes do not exist */
    TEST_ASSERT_EQUAL_HEX8(0x7d, bench_read(1, 0x30));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x31));
}

/* proves: PL-PKT-04, PL-PKT-05 */
static void test_a_read_gives_n_consecutive_registers_and_the_crc(void)
{
    uint8_t all[256], block[0x4c];

    bench_quiet(1);
    expect("set dev.1.cell.1 3.35", "ok");
    expect("set dev.1.cell.5 4.15", "ok");
    bench_convert();
    bench_write(1, 0x33, 0x1e);
    bench_write(1, 0x32, 0x12);
    bench_dump(1, all);
    for (int first = 0; first <= 0x4b; first++) {
        for (int n = 1; first + n <= 0x4c; n += 7) {
            bench_read_block(1, first, n, block);
            TEST_ASSERT_EQUAL_HEX8_ARRAY(&all[first], block, n);
        }
    }
    expect_no_misuse();
}

/* proves: PL-PKT-07 */
static void test_six_cells_take_sixteen_bytes(void)
{
    uint8_t block[12];
    static const uint8_t expected[12] = {0x1e, 0xb8, 0x21, 0xca, 0x24, 0xdd,
                                         0x25, 0xe3, 0x2a, 0x7e, 0x2b, 0x01};

    bench_address(1);
    expect("set dev.1.cell.1 3.0", "ok");
    expect("set dev.1.cell.2 3.3", "ok");
    expect("set dev.1.cell.3 3.6", "ok");
    expect("set dev.1.cell.4 3.7", "ok");
    expect("set dev.1.cell.5 4.15", "ok");
    expect("set dev.1.cell.6 4.2", "ok");
    bench_convert();
    expect("spi 02 03 0c 00 00 00 00 00 00 00 00 00 00 00 00 00",
           "ok -- -- -- 1e b8 21 ca 24 dd 25 e3 2a 7e 2b 01 2c");
    bench_read_block(1, 0x03, 12, block);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, block, 12);
}

/* proves: PL-PKT-08 */
static void test_status_and_all_results_come_in_one_packet(void)
{
    uint8_t block[0x4c];
    static const uint8_t expected[19] = {0x81, 0x29, 0x79, 0x24, 0xdd, 0x24, 0xdd, 0x24, 0xdd, 0x24,
                                         0xdd, 0x24, 0xdd, 0x24, 0xdd, 0x11, 0xaa, 0x11, 0xa6};

    bench_quiet(1);
    bench_shadow(1, 0x40, 0x10);
    bench_write(1, 0x31, 0x03);
    bench_convert();
    bench_read_block(1, 0x00, 19, block);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, block, 19);
    bench_read_block(1, 0x00, 0x4c, block); /* reserved addresses included */
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, block, 19);
    for (int reg = 0x13; reg <= 0x1f; reg++) {
        TEST_ASSERT_EQUAL_HEX8(0x00, block[reg]);
    }
    TEST_ASSERT_EQUAL_HEX8(0x3d, block[0x30]);
    TEST_ASSERT_EQUAL_HEX8(0x2d, block[0x42]);
    expect_no_misuse();
}

/* proves: PL-PKT-09 */
static void test_others_do_nothing_with_a_packet_but_pass_it_on(void)
{
    uint8_t before[3][256];

    bench_stack(4);
    bench_quiet(4);
    bench_dump(1, before[0]);
    bench_dump(2, before[1]);
    bench_dump(4, before[2]);
    bench_write(3, 0x30, 0x3d);
    bench_shadow(3, 0x40, 0x10);
    bench_write(3, 0x33, 0x05);
    bench_write(3, 0x32, 0x05);
    (void)bench_read(3, 0x00);
    expect("spi 07 30 11 00", "ok -- -- -- --"); /* wrong CRC: the business of device 3 alone */
    TEST_ASSERT_EQUAL_HEX8(0x04, bench_read(3, 0x21));
    expect_unchanged(1, before[0]);
    expect_unchanged(2, before[1]);
    expect_unchanged(4, before[2]);
    TEST_ASSERT_EQUAL_HEX8(0x3d, bench_peek(3, 0x30));
}

/* proves: PL-PKT-10, PL-AMB-07 */
static void test_a_write_cut_short_at_any_bit_changes_nothing(void)
{
    static const uint8_t write[5] = {0x03, 0x30, 0x7d, 0x30, 0x00};

    bench_quiet(1);
    for (size_t bits = 0; bits < 40; bits++) {
        uint8_t before[256], rx[5];

        bench_dump(1, before);
        sim_pl_spi_bits(bench_pl(), write, rx, NULL, bits);
        if (bits == 32) {
            TEST_ASSERT_EQUAL_HEX8(0x7d, bench_read(1, 0x30));
            bench_write(1, 0x30, 0x00);
        } else if (bits < 8) { /* byte 1 has not arrived: nothing at all */
            expect_unchanged(1, before);
        } else {
            TEST_ASSERT_EQUAL_HEX8_MESSAGE(0x04, bench_read(1, 0x21), "missing CRC");
            TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x30));
            bench_write(1, 0x21, 0x04);
            bench_write(1, 0x21, 0x00);
            expect_unchanged(1, before);
        }
    }
}

/* proves: PL-PKT-10, PL-AMB-07, PL-AMB-16 */
static void test_without_crc_a_cut_write_leaves_no_flag(void)
{
    static const uint8_t write[4] = {0x03, 0x30, 0x7d, 0x30};

    bench_quiet(1);
    bench_shadow(1, 0x41, 0x01);
    for (size_t bits = 0; bits <= 32; bits++) {
        uint8_t before[256], rx[4];

        bench_dump(1, before);
        sim_pl_spi_bits(bench_pl(), write, rx, NULL, bits);
        if (bits != 24) {
            expect_unchanged(1, before);
        } else {
            TEST_ASSERT_EQUAL_HEX8(0x7d, bench_peek(1, 0x30));
        }
    }
}

/* proves: PL-PKT-11 */
static void test_a_read_cut_short_at_any_bit_has_no_effect(void)
{
    static const uint8_t read[16] = {0x02, 0x03, 0x0c};
    uint8_t before[256], rx[16];

    bench_quiet(1);
    bench_convert();
    bench_dump(1, before);
    for (size_t bits = 0; bits <= 128; bits++) {
        sim_pl_spi_bits(bench_pl(), read, rx, NULL, bits);
        expect_unchanged(1, before);
        TEST_ASSERT_EQUAL_HEX8(0x24, bench_read(1, 0x03));
    }
}

/* proves: PL-PKT-12, PL-AMB-09 */
static void test_length_0_gives_the_crc_of_the_header(void)
{
    bench_address(1);
    expect("spi 02 00 00 00", "ok -- -- -- d6");
    expect("spi 02 30 00 00", "ok -- -- -- 2f");
    expect("spi 02 30 00 00 00 00", "ok -- -- -- 2f -- --");
    expect_misuse("PL-PKT-12 PL-AMB-09", -1);
}

/* proves: PL-PKT-12, PL-AMB-10 */
static void test_reads_past_the_last_register(void)
{
    uint8_t data[255];

    bench_address(1);
    bench_shadow(1, 0x4b, 0x77);
    bench_read_block(1, 0x4b, 0x40, data);
    TEST_ASSERT_EQUAL_HEX8(0x77, data[0]);
    for (int i = 1; i < 0x40; i++) {
        TEST_ASSERT_EQUAL_HEX8(0x00, data[i]);
    }
    bench_read_block(1, 0x80, 0x7f, data);
    for (int i = 0; i < 0x7f; i++) {
        TEST_ASSERT_EQUAL_HEX8(0x00, data[i]);
    }
    bench_read_block(1, 0xfe, 5, data); /* fe, ff, then 00 again */
    TEST_ASSERT_EQUAL_HEX8(0x00, data[0]);
    TEST_ASSERT_EQUAL_HEX8(0x00, data[1]);
    TEST_ASSERT_EQUAL_HEX8(bench_peek(1, 0x00), data[2]);
    TEST_ASSERT_NOT_EQUAL(0, data[2]);
    bench_read_block(1, 0x30, 255, data);
    TEST_ASSERT_EQUAL_HEX8(0x81, data[0x3b - 0x30]);
    TEST_ASSERT_EQUAL_HEX8(bench_peek(1, 0x20), data[0x120 - 0x30]);
    expect_misuse("PL-PKT-12 PL-PKT-14 PL-AMB-10", -1);
}

/* proves: PL-PKT-12, PL-AMB-11 */
static void test_after_the_crc_the_device_stops_driving(void)
{
    bench_address(1);
    expect("spi 02 3b 01 00 00 00 00 00", "ok -- -- -- 81 ba -- -- --");
    expect("spi 02 3b 01 00 00", "ok -- -- -- 81 ba");
}

/* proves: PL-PKT-13 */
static void test_reads_have_no_side_effect_on_any_register(void)
{
    uint8_t before[256];

    bench_stack(2);
    bench_quiet(2);
    bench_convert();
    bench_write(1, 0x33, 0x1e);
    bench_write(1, 0x32, 0x05);
    bench_write(1, 0x21, 0x10);
    expect("set dev.1.cell.2 4.4", "ok");
    expect("advance 600ms", "ok");
    bench_dump(1, before);
    for (int first = 0; first < 256; first++) {
        (void)bench_read(1, first);
        expect_unchanged(1, before);
    }
}

/* proves: PL-PKT-13 */
static void test_a_read_closes_the_programming_window_and_spares_the_key(void)
{
    bench_address(1);
    bench_write(1, 0x3a, 0x35);
    (void)bench_read(1, 0x48);
    (void)bench_read(1, 0x3a);
    bench_write(1, 0x48, 0x5a);
    TEST_ASSERT_EQUAL_HEX8(0x5a, bench_read(1, 0x48));
    expect("set dev.1.vpp on", "ok");
    bench_write(1, 0x3f, 0x91);
    bench_advance_us(100);
    (void)bench_read(1, 0x48);
    expect("advance 2ms", "ok");
    expect("set dev.1.vpp off", "ok");
    expect("get dev.1.otp.48", "ok 00");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_first_byte_is_address_and_direction_second_the_register);
    RUN_TEST(test_bit_7_of_the_first_byte_matches_nobody);
    RUN_TEST(test_a_write_is_four_bytes_and_changes_one_register);
    RUN_TEST(test_a_read_gives_n_consecutive_registers_and_the_crc);
    RUN_TEST(test_six_cells_take_sixteen_bytes);
    RUN_TEST(test_status_and_all_results_come_in_one_packet);
    RUN_TEST(test_others_do_nothing_with_a_packet_but_pass_it_on);
    RUN_TEST(test_a_write_cut_short_at_any_bit_changes_nothing);
    RUN_TEST(test_without_crc_a_cut_write_leaves_no_flag);
    RUN_TEST(test_a_read_cut_short_at_any_bit_has_no_effect);
    RUN_TEST(test_length_0_gives_the_crc_of_the_header);
    RUN_TEST(test_reads_past_the_last_register);
    RUN_TEST(test_after_the_crc_the_device_stops_driving);
    RUN_TEST(test_reads_have_no_side_effect_on_any_register);
    RUN_TEST(test_a_read_closes_the_programming_window_and_spares_the_key);
    return UNITY_END();
}
