/* SPDX-License-Identifier: Apache-2.0 */
/* Section 35, packet vectors: reads, dead buses, packets without CRC, and the frame of a real part. */
#include "bench.h"
#include "sim_pl536_internal.h" /* sim_pl_crc8 */
#include <stdio.h>

/* proves: PL-VEC-11 */
static void test_probe_for_an_unaddressed_device(void)
{
    bench_stack(2);
    expect("spi 00 00 01 00 00", "ok -- -- -- 61 35");
    bench_quiet(2);
    expect("spi 00 00 01 00 00", "ok -- -- -- -- --");
    expect("spi 7f 3c a5 57", "ok -- -- -- --");
    expect("advance 1ms", "ok");
    expect("spi 00 00 01 00 00", "ok -- -- -- 61 35");
}

/* proves: PL-VEC-33, PL-VEC-41 */
static void test_status_without_faults(void)
{
    bench_quiet(1);
    expect("spi 02 00 01 00 00", "ok -- -- -- 81 b7");
    expect("spi 02 20 06 00 00 00 00 00 00 00", "ok -- -- -- 00 00 00 00 00 00 50");
}

/* proves: PL-VEC-34, PL-VEC-35, PL-VEC-36, PL-VEC-37 */
static void test_worked_examples(void)
{
    bench_address(1);
    bench_write(1, 0x31, 0x03);
    expect("set dev.1.cell.1 3.35", "ok");
    expect("set dev.1.gpai 1.25", "ok");
    expect("set dev.1.vbat 20.295", "ok");
    expect("set dev.1.ts.1 0.13242", "ok");
    bench_convert();
    expect("spi 02 03 02 00 00 00", "ok -- -- -- 22 4d 48");
    expect("spi 02 01 02 00 00 00", "ok -- -- -- 20 00 aa");
    expect("spi 02 0f 02 00 00 00", "ok -- -- -- 11 16 e0");
    bench_shadow(1, 0x40, 0x10);
    expect("advance 10ms", "ok");
    bench_convert();
    expect("spi 02 01 02 00 00 00", "ok -- -- -- 26 f7 1f");
    expect_no_misuse();
}

/* proves: PL-VEC-38, PL-VEC-39 */
static void test_six_cells(void)
{
    bench_stack(2);
    bench_address(2);
    expect("set dev.2.cell.1 3.0", "ok");
    expect("set dev.2.cell.2 3.3", "ok");
    expect("set dev.2.cell.3 3.6", "ok");
    expect("set dev.2.cell.4 3.7", "ok");
    expect("set dev.2.cell.5 4.15", "ok");
    expect("set dev.2.cell.6 4.2", "ok");
    bench_convert();
    expect("spi 02 03 0c 00 00 00 00 00 00 00 00 00 00 00 00 00",
           "ok -- -- -- 24 dd 24 dd 24 dd 24 dd 24 dd 24 dd 92");
    expect("spi 04 03 0c 00 00 00 00 00 00 00 00 00 00 00 00 00",
           "ok -- -- -- 1e b8 21 ca 24 dd 25 e3 2a 7e 2b 01 9b");
    expect_no_misuse();
}

/* proves: PL-VEC-40 */
static void test_all_nine_results(void)
{
    bench_address(1);
    bench_write(1, 0x31, 0x03);
    bench_shadow(1, 0x40, 0x10);
    bench_convert();
    expect("spi 02 01 12 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00",
           "ok -- -- -- 29 79 24 dd 24 dd 24 dd 24 dd 24 dd 24 dd 11 aa 11 a6 dd");
    expect_no_misuse();
}

/* proves: PL-VEC-42 */
static void test_status_with_cov_on_cell_3_and_a_crc_error(void)
{
    bench_quiet(1);
    expect("set dev.1.cell.3 4.3", "ok");
    expect("advance 501ms", "ok");
    expect("spi 03 30 7d 31", "ok -- -- -- --");
    expect("spi 02 20 06 00 00 00 00 00 00 00", "ok -- -- -- 00 05 04 00 00 00 e5");
}

/* proves: PL-VEC-43 */
static void test_group_3_as_configured(void)
{
    static const char *const writes[] = {"spi 7f 40 50 cc", "spi 7f 42 2c 95", "spi 7f 43 85 d6",
                                         "spi 7f 44 15 44", "spi 7f 45 85 a8", "spi 7f 46 55 a9",
                                         "spi 7f 47 64 2b", "spi 03 48 5a cf"};

    bench_address(1);
    expect("spi 7f 30 7d ad", "ok -- -- -- --");
    expect("advance 1ms", "ok");
    for (size_t i = 0; i < sizeof writes / sizeof writes[0]; i++) {
        expect("spi 7f 3a 35 d0", "ok -- -- -- --");
        expect(writes[i], "ok -- -- -- --");
    }
    expect("spi 02 40 0c 00 00 00 00 00 00 00 00 00 00 00 00 00",
           "ok -- -- -- 50 00 2c 85 15 85 55 64 5a 00 00 00 83");
    expect_no_misuse();
}

/* proves: PL-VEC-45 */
static void test_reserved_registers_read_zero(void)
{
    bench_address(1);
    expect("spi 02 13 04 00 00 00 00 00", "ok -- -- -- 00 00 00 00 d3");
}

/* proves: PL-VEC-50 */
static void test_a_flipped_bit_in_a_reply(void)
{
    uint8_t reply[5] = {0x02, 0x03, 0x02, 0x22, 0x4c};

    bench_address(1);
    expect("set dev.1.cell.1 3.35", "ok");
    bench_convert();
    expect("inject miso 39", "ok"); /* the last bit of the second data byte */
    expect("spi 02 03 02 00 00 00", "ok -- -- -- 22 4c 48");
    TEST_ASSERT_NOT_EQUAL(0x48, bench_crc(reply, 5));
    expect("spi 02 03 02 00 00 00", "ok -- -- -- 22 4d 48");
}

static void dead_bus(int kind, const uint8_t *header, uint8_t n, uint8_t level)
{
    uint8_t tx[30] = {header[0], header[1], header[2]}, rx[30], driven[30], sum[30];

    bench_stack(2);
    bench_address(2);
    bench_fault()->dead = kind;
    sim_pl_spi(bench_pl(), tx, rx, driven, n + 4u);
    memcpy(sum, header, 3);
    for (size_t i = 0; i < n + 4u; i++) {
        TEST_ASSERT_EQUAL_HEX8(level, rx[i]);
        TEST_ASSERT_EQUAL(0, driven[i]);
    }
    memcpy(&sum[3], &rx[3], n);
    TEST_ASSERT_EQUAL_HEX8(level, bench_crc(sum, n + 3u)); /* and the CRC matches although nothing answered */
    TEST_ASSERT_EQUAL_HEX8(level, sim_pl_crc8(0, sum, n + 3u));
}

/* proves: PL-VEC-51, PL-VEC-52 */
static void test_dead_buses_that_pass_the_crc(void)
{
    static const uint8_t zeros[3] = {0x3c, 0x03, 0x0c}, ones[3] = {0x70, 0x00, 0x13};

    dead_bus(1, zeros, 0x0c, 0x00);
    dead_bus(2, ones, 0x13, 0xff);
}

/* proves: PL-VEC-54 */
static void test_packets_without_crc(void)
{
    bench_stack(2);
    bench_address(2);
    expect("set dev.1.cell.1 3.35", "ok");
    expect("spi 7f 3a 35 d0", "ok -- -- -- --");
    expect("spi 7f 41 01 69", "ok -- -- -- --");
    expect("spi 7f 34 01", "ok -- -- --");
    expect("advance 1ms", "ok");
    expect("spi 02 03 02 00 00", "ok -- -- -- 22 4d");
    TEST_ASSERT_EQUAL(1, sim_pl_conversions(bench_pl(), 2));
    expect_no_misuse();
}

/* proves: PL-VEC-55, PL-CRC-01, PL-CRC-03, PL-AMB-04, PL-AMB-05 */
static void test_the_frame_of_a_real_part(void)
{
    static const sim_pl_options variant = {.variant_a = true};
    static const uint8_t otp[9] = {0x10, 0x80, 0x31, 0x81, 0x08, 0x81, 0x66, 0xff, 0x15};
    uint8_t frame[3 + 0x4c] = {0x00, 0x00, 0x4c}, data[0x4c], driven[0x4c + 4],
                      tx[0x4c + 4] = {0x00, 0x00, 0x4c}, rx[0x4c + 4];

    frame[3 + 0x00] = 0x61;
    memcpy(&frame[3 + 0x20], "\x80\x0b\x30\x0f", 4);
    memcpy(&frame[3 + 0x40], otp, sizeof otp);
    TEST_ASSERT_EQUAL_HEX8(0x9b, sim_pl_crc8(0, frame, sizeof frame));
    /* The same part simulated: EPROM as read, cells 1 to 4 below 1.5 V, cells 5 and 6 above 4.45 V, both for
     * over 100 ms. */
    bench_stack_with(1, &variant);
    for (uint8_t i = 0; i < sizeof otp; i++) {
        TEST_ASSERT_EQUAL(0, sim_pl_set_otp(bench_pl(), 1, (uint8_t)(0x40 + i), otp[i]));
    }
    for (int c = 1; c <= 6; c++) {
        TEST_ASSERT_EQUAL(0, sim_pl_set_cell(bench_pl(), 1, c, c <= 4 ? 1.2 : 4.6));
    }
    expect("set dev.1.supply off", "ok");
    expect("advance 1ms", "ok");
    expect("set dev.1.supply on", "ok");
    expect("advance 300ms", "ok");
    sim_pl_spi(bench_pl(), tx, rx, driven, sizeof tx);
    memcpy(data, &rx[3], sizeof data);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(&frame[3], data, sizeof data);
    TEST_ASSERT_EQUAL_HEX8(0x9b, rx[3 + 0x4c]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_probe_for_an_unaddressed_device);
    RUN_TEST(test_status_without_faults);
    RUN_TEST(test_worked_examples);
    RUN_TEST(test_six_cells);
    RUN_TEST(test_all_nine_results);
    RUN_TEST(test_status_with_cov_on_cell_3_and_a_crc_error);
    RUN_TEST(test_group_3_as_configured);
    RUN_TEST(test_reserved_registers_read_zero);
    RUN_TEST(test_a_flipped_bit_in_a_reply);
    RUN_TEST(test_dead_buses_that_pass_the_crc);
    RUN_TEST(test_packets_without_crc);
    RUN_TEST(test_the_frame_of_a_real_part);
    return UNITY_END();
}
