/* SPDX-License-Identifier: Apache-2.0 */
/* Every packet of the vector list that a host builds or judges, byte for byte. */
#include "bqhost/bq76pl536_packet.h"
#include "hex.h"
#include "unity.h"
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static void expect_write(uint8_t device, uint8_t reg, uint8_t value, bool crc, const char *text)
{
    uint8_t expected[8], built[BQ76PL536_PACKET_MAX];
    size_t n = hex_bytes(text, expected, sizeof expected), length = 0;
    TEST_ASSERT_EQUAL_INT(BQ_OK,
                          bq76pl536_packet_write(built, sizeof built, device, reg, value, crc, &length));
    TEST_ASSERT_EQUAL_UINT_MESSAGE(n, length, text);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(expected, built, n, text);
}

static void expect_read(uint8_t device, uint8_t first, uint8_t count, bool crc, const char *sent,
                        const char *reply)
{
    uint8_t expected[BQ76PL536_PACKET_MAX], built[BQ76PL536_PACKET_MAX], rx[BQ76PL536_PACKET_MAX];
    size_t n = hex_bytes(sent, expected, sizeof expected), length = 0;
    TEST_ASSERT_EQUAL_INT(BQ_OK,
                          bq76pl536_packet_read(built, sizeof built, device, first, count, crc, &length));
    TEST_ASSERT_EQUAL_UINT_MESSAGE(n, length, sent);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(expected, built, n, sent);

    memset(rx, 0xa7, sizeof rx); /* what arrives during the header counts for nothing */
    TEST_ASSERT_EQUAL_UINT(n - 3u, hex_bytes(reply, rx + 3, sizeof rx - 3u));
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_packet_check(built, rx, length, crc));
    for (size_t bit = 0; crc && bit < 8u * (n - 3u); bit++) {
        rx[3u + bit / 8u] ^= (uint8_t)(1u << bit % 8u);
        TEST_ASSERT_LESS_THAN(BQ_OK, bq76pl536_packet_check(built, rx, length, crc));
        rx[3u + bit / 8u] ^= (uint8_t)(1u << bit % 8u);
    }
}

/* proves: PL-VEC-02, PL-VEC-03, PL-VEC-04, PL-VEC-05, PL-VEC-06, PL-VEC-07, PL-PKT-01, PL-PKT-02, PL-PKT-03,
 * PL-CRC-02, PL-ADR-05 */
static void test_reset_and_addressing_writes(void)
{
    expect_write(0x3f, 0x3c, 0xa5, true, "7f 3c a5 57");
    expect_write(0x01, 0x3c, 0xa5, true, "03 3c a5 ca");
    expect_write(0x00, 0x3c, 0xa5, true, "01 3c a5 1c");
    expect_write(0x00, 0x3b, 0x01, true, "01 3b 01 02");
    expect_write(0x00, 0x3b, 0x02, true, "01 3b 02 0b");
    expect_write(0x00, 0x3b, 0x03, true, "01 3b 03 0c");
    expect_write(0x00, 0x3b, 0x04, true, "01 3b 04 19");
    expect_write(0x00, 0x3b, 0x20, true, "01 3b 20 e5");
    expect_write(0x00, 0x3b, 0x3e, true, "01 3b 3e bf");
    expect_write(0x00, 0x3b, 0x81, true, "01 3b 81 8b");
    expect_write(0x00, 0x3b, 0x82, true, "01 3b 82 82");
    expect_write(0x00, 0x3b, 0xbe, true, "01 3b be 36");
}

/* proves: PL-VEC-12, PL-VEC-13, PL-VEC-14, PL-VEC-15, PL-VEC-16, PL-VEC-17, PL-VEC-18, PL-VEC-19, PL-VEC-20,
 * PL-VEC-21, PL-VEC-23, PL-VEC-24, PL-CONV-09, PL-AMB-110 */
static void test_conversion_and_configuration_writes(void)
{
    expect_write(0x3f, 0x34, 0x01, true, "7f 34 01 8a");
    expect_write(0x01, 0x34, 0x01, true, "03 34 01 17");
    expect_write(0x3f, 0x30, 0x7d, true, "7f 30 7d ad");
    expect_write(0x01, 0x30, 0x7d, true, "03 30 7d 30");
    expect_write(0x3f, 0x30, 0x3d, true, "7f 30 3d 6a");
    expect_write(0x3f, 0x3a, 0x35, true, "7f 3a 35 d0");
    expect_write(0x01, 0x3a, 0x35, true, "03 3a 35 4d");
    expect_write(0x3f, 0x40, 0x50, true, "7f 40 50 cc");
    expect_write(0x01, 0x40, 0x50, true, "03 40 50 51");
    expect_write(0x3f, 0x42, 0x2c, true, "7f 42 2c 95");
    expect_write(0x3f, 0x43, 0x85, true, "7f 43 85 d6");
    expect_write(0x3f, 0x44, 0x15, true, "7f 44 15 44");
    expect_write(0x3f, 0x45, 0x85, true, "7f 45 85 a8");
    expect_write(0x3f, 0x46, 0x55, true, "7f 46 55 a9");
    expect_write(0x3f, 0x47, 0x64, true, "7f 47 64 2b");
    expect_write(0x01, 0x48, 0x5a, true, "03 48 5a cf");
    expect_write(0x3f, 0x3a, 0x27, true, "7f 3a 27 ae");
    expect_write(0x01, 0x3a, 0x27, true, "03 3a 27 33");
}

/* proves: PL-VEC-22, PL-VEC-54, PL-CRC-08 */
static void test_packets_without_crc(void)
{
    expect_write(0x3f, 0x41, 0x01, true, "7f 41 01 69");
    expect_write(0x3f, 0x3a, 0x35, false, "7f 3a 35");
    expect_write(0x3f, 0x41, 0x00, false, "7f 41 00");
    expect_write(0x3f, 0x34, 0x01, false, "7f 34 01");
    expect_read(0x01, 0x03, 2, false, "02 03 02 00 00", "22 4d");
}

/* proves: PL-VEC-25, PL-VEC-26, PL-VEC-27, PL-VEC-28, PL-VEC-29, PL-VEC-30, PL-VEC-31 */
static void test_operation_writes(void)
{
    expect_write(0x3f, 0x31, 0x03, true, "7f 31 03 c5");
    expect_write(0x3f, 0x31, 0x04, true, "7f 31 04 d0");
    expect_write(0x3f, 0x31, 0x00, true, "7f 31 00 cc");
    expect_write(0x3f, 0x20, 0x80, true, "7f 20 80 07");
    expect_write(0x3f, 0x20, 0x04, true, "7f 20 04 92");
    expect_write(0x3f, 0x20, 0x00, true, "7f 20 00 8e");
    expect_write(0x3f, 0x21, 0x08, true, "7f 21 08 a3");
    expect_write(0x3f, 0x21, 0x00, true, "7f 21 00 9b");
    expect_write(0x02, 0x21, 0x04, true, "05 21 04 67");
    expect_write(0x02, 0x21, 0x00, true, "05 21 00 7b");
    expect_write(0x03, 0x21, 0x03, true, "07 21 03 a4");
    expect_write(0x03, 0x21, 0x00, true, "07 21 00 ad");
    expect_write(0x04, 0x21, 0x10, true, "09 21 10 f1");
    expect_write(0x04, 0x21, 0x00, true, "09 21 00 81");
    expect_write(0x04, 0x20, 0x10, true, "09 20 10 e4");
    expect_write(0x04, 0x20, 0x00, true, "09 20 00 94");
    expect_write(0x01, 0x33, 0x1e, true, "03 33 1e 21");
    expect_write(0x01, 0x32, 0x00, true, "03 32 00 6e");
    expect_write(0x01, 0x32, 0x12, true, "03 32 12 10");
    expect_write(0x3f, 0x32, 0x00, true, "7f 32 00 f3");
}

/* proves: PL-VEC-32, PL-OTP-09 */
static void test_programming_has_a_builder_of_its_own(void)
{
    static const uint8_t expected[4] = {0x03, 0x3f, 0x91, 0x79};
    uint8_t built[4] = {0};
    size_t length = 0;
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE,
                          bq76pl536_packet_write(built, sizeof built, 0x01, 0x3f, 0x91, true, &length));
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_packet_program(built, sizeof built, 0x01, true, &length));
    TEST_ASSERT_EQUAL_UINT(4, length);
    TEST_ASSERT_EQUAL_MEMORY(expected, built, 4);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_packet_program(built, 4, 0x3e, true, &length));
    TEST_ASSERT_EQUAL_HEX8(0x7d, built[0]);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_packet_program(built, 3, 0x01, false, &length));
    TEST_ASSERT_EQUAL_UINT(3, length);

    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_program(built, sizeof built, 0x3f, true, &length));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_program(built, sizeof built, 0x00, true, &length));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_program(built, 3, 0x01, true, &length));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_program(NULL, 4, 0x01, true, &length));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_program(built, 4, 0x01, true, NULL));
    TEST_ASSERT_EQUAL_UINT(3, length);
}

/* proves: PL-VEC-08, PL-VEC-09, PL-VEC-10, PL-VEC-11, PL-VEC-33, PL-VEC-34, PL-VEC-35, PL-VEC-36, PL-VEC-37,
 * PL-PKT-04, PL-PKT-06, PL-CRC-03, PL-AMB-05, PL-AMB-13, PL-SPI-09 */
static void test_short_reads(void)
{
    expect_read(0x01, 0x3b, 1, true, "02 3b 01 00 00", "81 ba");
    expect_read(0x02, 0x3b, 1, true, "04 3b 01 00 00", "82 c7");
    expect_read(0x3e, 0x3b, 1, true, "7c 3b 01 00 00", "be f1");
    expect_read(0x00, 0x00, 1, true, "00 00 01 00 00", "61 35");
    expect_read(0x01, 0x00, 1, true, "02 00 01 00 00", "81 b7");
    expect_read(0x01, 0x03, 2, true, "02 03 02 00 00 00", "22 4d 48");
    expect_read(0x01, 0x01, 2, true, "02 01 02 00 00 00", "20 00 aa");
    expect_read(0x01, 0x01, 2, true, "02 01 02 00 00 00", "26 f7 1f");
    expect_read(0x01, 0x0f, 2, true, "02 0f 02 00 00 00", "11 16 e0");
}

/* proves: PL-VEC-38, PL-VEC-39, PL-VEC-40, PL-VEC-41, PL-VEC-42, PL-VEC-43, PL-VEC-44, PL-VEC-45, PL-PKT-07,
 * PL-PKT-08 */
static void test_block_reads(void)
{
    expect_read(0x01, 0x03, 12, true, "02 03 0c 00 00 00 00 00 00 00 00 00 00 00 00 00",
                "24 dd 24 dd 24 dd 24 dd 24 dd 24 dd 92");
    expect_read(0x02, 0x03, 12, true, "04 03 0c 00 00 00 00 00 00 00 00 00 00 00 00 00",
                "1e b8 21 ca 24 dd 25 e3 2a 7e 2b 01 9b");
    expect_read(0x01, 0x01, 18, true, "02 01 12 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00",
                "29 79 24 dd 24 dd 24 dd 24 dd 24 dd 24 dd 11 aa 11 a6 dd");
    expect_read(0x01, 0x20, 6, true, "02 20 06 00 00 00 00 00 00 00", "00 00 00 00 00 00 50");
    expect_read(0x01, 0x20, 6, true, "02 20 06 00 00 00 00 00 00 00", "00 05 04 00 00 00 e5");
    expect_read(0x01, 0x40, 12, true, "02 40 0c 00 00 00 00 00 00 00 00 00 00 00 00 00",
                "50 00 2c 85 15 85 55 64 5a 00 00 00 83");
    expect_read(0x01, 0x32, 2, true, "02 32 02 00 00 00", "12 1e b0");
    expect_read(0x01, 0x13, 4, true, "02 13 04 00 00 00 00 00", "00 00 00 00 d3");
}

/* proves: PL-VEC-55 */
static void test_a_frame_of_real_silicon_is_accepted(void)
{
    static const struct {
        uint8_t reg, value;
    } content[] = {{0x00, 0x61}, {0x20, 0x80}, {0x21, 0x0b}, {0x22, 0x30}, {0x23, 0x0f},
                   {0x40, 0x10}, {0x41, 0x80}, {0x42, 0x31}, {0x43, 0x81}, {0x44, 0x08},
                   {0x45, 0x81}, {0x46, 0x66}, {0x47, 0xff}, {0x48, 0x15}};
    uint8_t tx[BQ76PL536_PACKET_MAX], rx[BQ76PL536_PACKET_MAX] = {0};
    size_t length = 0;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_packet_read(tx, sizeof tx, 0x00, 0x00, 0x4c, true, &length));
    TEST_ASSERT_EQUAL_UINT(80, length);
    for (unsigned i = 0; i < sizeof content / sizeof content[0]; i++) {
        rx[3u + content[i].reg] = content[i].value;
    }
    rx[3 + 0x4c] = 0x9b;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_packet_check(tx, rx, length, true));
    rx[3 + 0x4c] = 0x9a;
    TEST_ASSERT_EQUAL_INT(BQ_E_CRC, bq76pl536_packet_check(tx, rx, length, true));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_reset_and_addressing_writes);
    RUN_TEST(test_conversion_and_configuration_writes);
    RUN_TEST(test_packets_without_crc);
    RUN_TEST(test_operation_writes);
    RUN_TEST(test_programming_has_a_builder_of_its_own);
    RUN_TEST(test_short_reads);
    RUN_TEST(test_block_reads);
    RUN_TEST(test_a_frame_of_real_silicon_is_accepted);
    return UNITY_END();
}
