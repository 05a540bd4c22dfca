/* SPDX-License-Identifier: Apache-2.0 */
/* What the builders refuse and how replies are judged when something is wrong. */
#include "bqhost/bq76pl536_packet.h"
#include "bqhost/crc8.h"
#include "unity.h"
#include <string.h>

static uint8_t tx[BQ76PL536_PACKET_MAX], rx[BQ76PL536_PACKET_MAX];
static size_t length;

void setUp(void)
{
    memset(tx, 0xee, sizeof tx);
    memset(rx, 0, sizeof rx);
    length = 999;
}

void tearDown(void)
{
}

static void expect_nothing_written(void)
{
    for (size_t i = 0; i < sizeof tx; i++) {
        TEST_ASSERT_EQUAL_HEX8(0xee, tx[i]);
    }
    TEST_ASSERT_EQUAL_UINT(999, length);
}

static void read_request(uint8_t device, uint8_t first, uint8_t count, bool crc)
{
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_packet_read(tx, sizeof tx, device, first, count, crc, &length));
}

static void answer(uint8_t value, bool crc)
{
    memset(rx, value, sizeof rx);
    if (crc) {
        rx[length - 1u] = bq_crc8(bq_crc8(0, tx, 3), rx + 3, tx[2]);
    }
}

static bq_status check(bool crc)
{
    return bq76pl536_packet_check(tx, rx, length, crc);
}

/* Every device, start and count there is: built exactly when the range ends within the register map. */
/* proves: PL-PKT-12, PL-PKT-14, PL-BCAST-02, PL-AMB-09, PL-AMB-10, PL-AMB-11, PL-AMB-14, PL-AMB-17,
 * PL-VEC-53 */
static void test_reads_stay_within_the_map_and_never_go_to_all(void)
{
    static const uint8_t devices[] = {0x00, 0x01, 0x3e, 0x3f, 0x40, 0x80, 0xff};
    for (unsigned d = 0; d < sizeof devices; d++) {
        for (unsigned first = 0; first < 256u; first++) {
            for (unsigned count = 0; count < 256u; count++) {
                bool legal = devices[d] <= 0x3eu && count >= 1u && first + count - 1u <= 0x4bu;
                bq_status status = bq76pl536_packet_read(tx, sizeof tx, devices[d], (uint8_t)first,
                                                         (uint8_t)count, true, &length);
                TEST_ASSERT_EQUAL_INT(legal ? BQ_OK : BQ_E_ARG, status);
                if (legal) {
                    TEST_ASSERT_EQUAL_UINT(count + 4u, length);
                    TEST_ASSERT_EQUAL_HEX8(0, tx[0] & 0x81u);
                    setUp();
                } else {
                    TEST_ASSERT_EQUAL_UINT(999, length);
                }
            }
        }
    }
    expect_nothing_written();
}

static void test_reads_need_room_and_pointers(void)
{
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_read(tx, 22, 1, 0, 19, true, &length));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_read(tx, 21, 1, 0, 19, false, &length));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_read(NULL, 80, 1, 0, 19, true, &length));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_read(tx, 80, 1, 0, 19, true, NULL));
    expect_nothing_written();
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_packet_read(tx, 23, 1, 0, 19, true, &length));
    TEST_ASSERT_EQUAL_UINT(23, length);
    TEST_ASSERT_EQUAL_HEX8(0xee, tx[23]);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_packet_read(tx, 22, 1, 0, 19, false, &length));
    TEST_ASSERT_EQUAL_UINT(22, length);
}

/* proves: PL-ADR-15, PL-AMB-08, PL-AMB-14, PL-AMB-30 */
static void test_writes_refuse_what_must_not_be_sent(void)
{
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_write(tx, 3, 1, 0x30, 0x7d, true, &length));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_write(tx, 2, 1, 0x30, 0x7d, false, &length));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_write(NULL, 4, 1, 0x30, 0x7d, true, &length));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_write(tx, 4, 1, 0x30, 0x7d, true, NULL));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_write(tx, 4, 0x40, 0x30, 0x7d, true, &length));
    for (unsigned device = 1; device <= 0x3fu; device++) {
        TEST_ASSERT_EQUAL_INT(BQ_E_ARG,
                              bq76pl536_packet_write(tx, 4, (uint8_t)device, 0x3b, 0x81, true, &length));
    }
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_packet_write(tx, 4, 0, 0x3b, 0x00, true, &length));
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_packet_write(tx, 4, 0, 0x3b, 0x3f, true, &length));
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_packet_write(tx, 4, 0, 0x3b, 0xbf, true, &length));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_write(tx, 4, 0x3f, 0x3f, 0x00, true, &length));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_write(tx, 4, 0x01, 0x00, 0x00, true, &length));
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_packet_write(tx, 4, 0x01, 0x32, 0x40, true, &length));
    expect_nothing_written();
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_packet_write(tx, 4, 0x01, 0x3f, 0x00, true, &length));
    TEST_ASSERT_EQUAL_UINT(4, length);
    TEST_ASSERT_EQUAL_HEX8(0xee, tx[4]);
}

/* Every address and every length, header as sent against header as received with any one bit flipped. */
/* proves: PL-CRC-07 */
static void test_a_damaged_request_is_found_by_the_crc_of_its_answer(void)
{
    for (unsigned bit = 0; bit < 24u; bit++) {
        uint8_t received[3];
        read_request(1, 0, 19, true);
        memcpy(received, tx, 3);
        received[bit / 8u] ^= (uint8_t)(0x80u >> bit % 8u);
        memset(rx, 0x12, sizeof rx);
        rx[22] = bq_crc8(bq_crc8(0, received, 3), rx + 3, 19);
        TEST_ASSERT_EQUAL_INT(BQ_E_CRC, check(true));
    }
}

/* proves: PL-VEC-50 */
static void test_a_flipped_data_bit_is_refused(void)
{
    read_request(1, 0x03, 2, true);
    rx[3] = 0x22;
    rx[4] = 0x4c;
    rx[5] = 0x48;
    TEST_ASSERT_EQUAL_INT(BQ_E_CRC, check(true));
    rx[4] = 0x4d;
    TEST_ASSERT_EQUAL_INT(BQ_OK, check(true));
}

/* The dead bus is known for what it is, whatever the request: every legal read there is, both levels. */
/* proves: PL-CRC-12, PL-CRC-13, PL-VEC-51, PL-VEC-52 */
static void test_a_dead_bus_never_passes(void)
{
    for (unsigned device = 0; device <= 0x3eu; device++) {
        for (unsigned first = 0; first <= 0x4bu; first++) {
            for (unsigned count = 1; first + count <= 0x4cu; count++) {
                read_request((uint8_t)device, (uint8_t)first, (uint8_t)count, true);
                memset(rx, 0x00, length);
                TEST_ASSERT_EQUAL_INT(BQ_E_NO_ANSWER, check(true));
                memset(rx, 0xff, length);
                TEST_ASSERT_EQUAL_INT(BQ_E_NO_ANSWER, check(true));
            }
        }
    }
}

/* The listed headers are real aliases: without the rule above they would pass, and the library knows them. */
/* proves: PL-CRC-12, PL-CRC-13 */
static void test_the_known_aliases(void)
{
    static const uint8_t low[][3] = {{0x1e, 0x03, 12}, {0x1e, 0x01, 2}, {0x0b, 0x0f, 4}};
    static const uint8_t high[][3] = {{0x1c, 0x00, 1}, {0x38, 0x00, 0x13}, {0x16, 0x0f, 4},   {0x0d, 0x22, 2},
                                      {0x2e, 0x3b, 1}, {0x20, 0x40, 12},   {0x07, 0x00, 0x4c}};
    for (unsigned i = 0; i < sizeof low / sizeof low[0]; i++) {
        read_request(low[i][0], low[i][1], low[i][2], true);
        answer(0x00, true);
        TEST_ASSERT_EQUAL_HEX8(0x00, rx[length - 1u]);
        TEST_ASSERT_TRUE(bq76pl536_packet_ambiguous(low[i][0], low[i][1], low[i][2]));
    }
    for (unsigned i = 0; i < sizeof high / sizeof high[0]; i++) {
        read_request(high[i][0], high[i][1], high[i][2], true);
        answer(0xff, true);
        TEST_ASSERT_EQUAL_HEX8(0xff, rx[length - 1u]);
        TEST_ASSERT_TRUE(bq76pl536_packet_ambiguous(high[i][0], high[i][1], high[i][2]));
    }
    TEST_ASSERT_FALSE(bq76pl536_packet_ambiguous(0x01, 0x20, 6));
    for (unsigned device = 0; device <= 0x3eu; device++) {
        const uint8_t header[3] = {(uint8_t)(device << 1), 0x00, 0x13};
        TEST_ASSERT_TRUE(bq_crc8(0, header, 3) != 0u);
    }
}

/* proves: PL-CRC-15 */
static void test_a_read_turned_into_a_write_never_has_the_length_of_one(void)
{
    static const uint8_t altered[][3] = {{0x01, 0x01, 0x12}, {0x49, 0x21, 0x01}};
    for (unsigned i = 0; i < 2u; i++) {
        TEST_ASSERT_EQUAL_HEX8(0x00, bq_crc8(0, altered[i], 3));
    }
    for (unsigned count = 1; count <= 0x4cu; count++) {
        read_request(0, 0, (uint8_t)count, true);
        TEST_ASSERT_GREATER_THAN(BQ76PL536_WRITE_BYTES(true), length);
    }
}

/* proves: PL-CRC-14 */
static void test_pairs_of_errors_in_a_burst(void)
{
    unsigned passed = 0;
    read_request(5, 0, 19, true);
    answer(0x2a, true);
    for (unsigned a = 24; a < 184u; a++) {
        for (unsigned b = a + 1u; b < 184u; b++) {
            rx[a / 8u] ^= (uint8_t)(0x80u >> a % 8u);
            rx[b / 8u] ^= (uint8_t)(0x80u >> b % 8u);
            bq_status status = check(true);
            TEST_ASSERT_EQUAL_INT(b - a == 127u ? BQ_OK : BQ_E_CRC, status);
            passed += status == BQ_OK;
            rx[a / 8u] ^= (uint8_t)(0x80u >> a % 8u);
            rx[b / 8u] ^= (uint8_t)(0x80u >> b % 8u);
        }
    }
    TEST_ASSERT_EQUAL_UINT(160u - 127u, passed);
}

/* Without a CRC only the registers themselves can tell: those that cannot be 00 or cannot be ff. */
static void test_without_crc_a_dead_bus_is_known_where_registers_allow(void)
{
    read_request(1, 0x00, 19, false);
    answer(0x00, false);
    TEST_ASSERT_EQUAL_INT(BQ_E_NO_ANSWER, check(false));
    answer(0xff, false);
    TEST_ASSERT_EQUAL_INT(BQ_E_NO_ANSWER, check(false));
    read_request(1, 0x3b, 1, false);
    answer(0x00, false);
    TEST_ASSERT_EQUAL_INT(BQ_E_NO_ANSWER, check(false));
    read_request(1, 0x20, 6, false);
    answer(0x00, false);
    TEST_ASSERT_EQUAL_INT(BQ_OK, check(false));
    answer(0xff, false);
    TEST_ASSERT_EQUAL_INT(BQ_E_NO_ANSWER, check(false));
    read_request(1, 0x3a, 1, false); /* ends just below, begins just above a register that cannot be 00 */
    answer(0x00, false);
    TEST_ASSERT_EQUAL_INT(BQ_OK, check(false));
    read_request(1, 0x3c, 1, false);
    answer(0x00, false);
    TEST_ASSERT_EQUAL_INT(BQ_OK, check(false));
    read_request(1, 0x47, 5, false);
    answer(0xff, false);
    TEST_ASSERT_EQUAL_INT(BQ_OK, check(false));
    read_request(1, 0x46, 6, false);
    answer(0xff, false);
    TEST_ASSERT_EQUAL_INT(BQ_E_NO_ANSWER, check(false));
    read_request(0, 0x00, 1, false);
    answer(0x00, false);
    TEST_ASSERT_EQUAL_INT(BQ_OK, check(false));
}

static void test_check_refuses_packets_that_are_no_replies(void)
{
    read_request(1, 0, 19, true);
    answer(0x2a, true);
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_check(NULL, rx, 23, true));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_check(tx, NULL, 23, true));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_check(tx, rx, 22, true));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_check(tx, rx, 24, true));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_check(tx, rx, 23, false));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_check(tx, rx, 0, true));
    tx[2] = 0;
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_packet_check(tx, rx, 4, true));
}

static const uint8_t good_burst[BQ76PL536_BURST_COUNT] = {0x81, 0x29, 0x79, 0x24, 0xdd, 0x1e, 0xb8,
                                                          0x21, 0xca, 0x24, 0xdd, 0x25, 0xe3, 0x2a,
                                                          0x7e, 0x11, 0xaa, 0x11, 0xa6};

/* proves: PL-VCELL-06, PL-CRC-13, PL-REG-02 */
static void test_a_burst_that_cannot_be_true_is_refused(void)
{
    uint8_t burst[BQ76PL536_BURST_COUNT];
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_burst_check(good_burst));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_burst_check(NULL));
    for (unsigned bit = 0; bit < 8u * sizeof burst; bit++) {
        unsigned byte = bit / 8u, mask = 1u << bit % 8u;
        bool must_refuse =
            byte == 0u ? mask == 0x80u || mask == 0x10u : byte % 2u == 1u && (mask & 0xc0u) != 0u;
        memcpy(burst, good_burst, sizeof burst);
        burst[byte] ^= (uint8_t)mask;
        TEST_ASSERT_EQUAL_INT(must_refuse ? BQ_E_IMPLAUSIBLE : BQ_OK, bq76pl536_burst_check(burst));
    }
    memset(burst, 0x00, sizeof burst);
    TEST_ASSERT_EQUAL_INT(BQ_E_NO_ANSWER, bq76pl536_burst_check(burst));
    memset(burst, 0xff, sizeof burst);
    TEST_ASSERT_EQUAL_INT(BQ_E_NO_ANSWER, bq76pl536_burst_check(burst));
}

/* proves: PL-ADC-01, PL-PKT-05, PL-REG-10, PL-REG-11, PL-REG-12, PL-REG-13 */
static void test_words_are_big_endian_and_in_register_order(void)
{
    static const uint16_t words[BQ76PL536_BURST_WORDS] = {0x2979, 0x24dd, 0x1eb8, 0x21ca, 0x24dd,
                                                          0x25e3, 0x2a7e, 0x11aa, 0x11a6};
    for (uint8_t i = 0; i < BQ76PL536_BURST_WORDS; i++) {
        TEST_ASSERT_EQUAL_HEX16(words[i], bq76pl536_burst_word(good_burst, i));
    }
    TEST_ASSERT_EQUAL_UINT(0, BQ76PL536_BURST_GPAI);
    TEST_ASSERT_EQUAL_UINT(1, BQ76PL536_BURST_CELL1);
    TEST_ASSERT_EQUAL_UINT(7, BQ76PL536_BURST_TS1);
    TEST_ASSERT_EQUAL_UINT(8, BQ76PL536_BURST_TS2);
}

/* 8 clocks of 4 us a byte and 3 us between packets. */
/* proves: PL-TIM-27 */
static void test_packet_times_at_250_khz(void)
{
    static const unsigned reads[][2] = {{1, 163}, {12, 515}, {18, 707}, {19, 739}};
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_packet_write(tx, sizeof tx, 1, 0x30, 0x7d, true, &length));
    TEST_ASSERT_EQUAL_UINT(131, length * 32u + 3u);
    for (unsigned i = 0; i < sizeof reads / sizeof reads[0]; i++) {
        read_request(1, 0, (uint8_t)reads[i][0], true);
        TEST_ASSERT_EQUAL_UINT(reads[i][1], length * 32u + 3u);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_reads_stay_within_the_map_and_never_go_to_all);
    RUN_TEST(test_reads_need_room_and_pointers);
    RUN_TEST(test_writes_refuse_what_must_not_be_sent);
    RUN_TEST(test_a_damaged_request_is_found_by_the_crc_of_its_answer);
    RUN_TEST(test_a_flipped_data_bit_is_refused);
    RUN_TEST(test_a_dead_bus_never_passes);
    RUN_TEST(test_the_known_aliases);
    RUN_TEST(test_a_read_turned_into_a_write_never_has_the_length_of_one);
    RUN_TEST(test_pairs_of_errors_in_a_burst);
    RUN_TEST(test_without_crc_a_dead_bus_is_known_where_registers_allow);
    RUN_TEST(test_check_refuses_packets_that_are_no_replies);
    RUN_TEST(test_a_burst_that_cannot_be_true_is_refused);
    RUN_TEST(test_words_are_big_endian_and_in_register_order);
    RUN_TEST(test_packet_times_at_250_khz);
    return UNITY_END();
}
