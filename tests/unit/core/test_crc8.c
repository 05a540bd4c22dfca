/* SPDX-License-Identifier: Apache-2.0 */
#include "bqhost/crc8.h"
#include "unity.h"
#include <string.h>

#define BURST_BYTES 23u /* header 3, data 19, CRC 1 */
#define BURST_BITS (8u * BURST_BYTES)

void setUp(void)
{
}

void tearDown(void)
{
}

/* The definition itself, one message bit at a time into a shift register: nothing in common with the code
 * under test. */
static uint8_t by_definition(const uint8_t *data, unsigned n)
{
    unsigned shift = 0;
    for (unsigned i = 0; i < 8u * (n + 1u); i++) {
        unsigned bit = i < 8u * n ? (unsigned)data[i / 8u] >> (7u - i % 8u) & 1u : 0u;
        shift = shift << 1 | bit;
        if ((shift & 0x100u) != 0u) {
            shift ^= 0x107u;
        }
    }
    return (uint8_t)shift;
}

/* proves: PL-CRC-01, PL-VEC-01, PL-AMB-04 */
static void test_published_values(void)
{
    static const struct {
        const char *bytes;
        unsigned n;
        uint8_t crc;
    } vectors[] = {
        {"123456789", 9, 0xf4}, {"", 0, 0x00}, {"\x01", 1, 0x07}, {"\x80", 1, 0x89}, {"\xff", 1, 0xf3}};
    for (unsigned i = 0; i < sizeof vectors / sizeof vectors[0]; i++) {
        const uint8_t *data = (const uint8_t *)vectors[i].bytes;
        TEST_ASSERT_EQUAL_HEX8(vectors[i].crc, bq_crc8_bitwise(0, data, vectors[i].n));
        TEST_ASSERT_EQUAL_HEX8(vectors[i].crc, bq_crc8_table16(0, data, vectors[i].n));
        TEST_ASSERT_EQUAL_HEX8(vectors[i].crc, bq_crc8_table256(0, data, vectors[i].n));
        TEST_ASSERT_EQUAL_HEX8(vectors[i].crc, bq_crc8(0, data, vectors[i].n));
    }
}

/* All one-byte inputs from every start value (this reaches every entry of both tables), all two-byte inputs
 * from zero. */
/* proves: PL-CRC-01 */
static void test_all_forms_agree_with_the_definition(void)
{
    for (unsigned first = 0; first < 256u; first++) {
        for (unsigned second = 0; second < 256u; second++) {
            const uint8_t data[2] = {(uint8_t)first, (uint8_t)second};
            uint8_t expected = by_definition(data, 2);
            TEST_ASSERT_EQUAL_HEX8(expected, bq_crc8_bitwise(0, data, 2));
            TEST_ASSERT_EQUAL_HEX8(expected, bq_crc8_table16(0, data, 2));
            TEST_ASSERT_EQUAL_HEX8(expected, bq_crc8_table256(0, data, 2));
            TEST_ASSERT_EQUAL_HEX8(expected, bq_crc8(0, data, 2));

            uint8_t start = by_definition(data, 1);
            TEST_ASSERT_EQUAL_HEX8(expected, bq_crc8_bitwise(start, data + 1, 1));
            TEST_ASSERT_EQUAL_HEX8(expected, bq_crc8_table16(start, data + 1, 1));
            TEST_ASSERT_EQUAL_HEX8(expected, bq_crc8_table256(start, data + 1, 1));
        }
    }
}

static void test_no_bytes_leave_the_crc_alone_and_null_is_legal(void)
{
    for (unsigned start = 0; start < 256u; start++) {
        TEST_ASSERT_EQUAL_HEX8(start, bq_crc8_bitwise((uint8_t)start, NULL, 0));
        TEST_ASSERT_EQUAL_HEX8(start, bq_crc8_table16((uint8_t)start, NULL, 0));
        TEST_ASSERT_EQUAL_HEX8(start, bq_crc8_table256((uint8_t)start, NULL, 0));
        TEST_ASSERT_EQUAL_HEX8(start, bq_crc8((uint8_t)start, NULL, 0));
    }
}

/* Syndromes of all single-bit errors of a packet of `bytes`; the CRC is linear, so they stand for every error
 * pattern. */
static void syndromes(uint8_t *out, unsigned bytes)
{
    uint8_t error[BURST_BYTES];
    for (unsigned bit = 0; bit < 8u * bytes; bit++) {
        memset(error, 0, sizeof error);
        error[bit / 8u] = (uint8_t)(0x80u >> bit % 8u);
        out[bit] = (uint8_t)(bq_crc8(0, error, bytes - 1u) ^ error[bytes - 1u]);
    }
}

/* proves: PL-CRC-14 */
static void test_up_to_three_errors_are_seen_in_127_bits(void)
{
    uint8_t s[BURST_BITS];
    syndromes(s, 15);
    for (unsigned a = 0; a < 120u; a++) {
        TEST_ASSERT_TRUE(s[a] != 0u);
        for (unsigned b = a + 1u; b < 120u; b++) {
            TEST_ASSERT_TRUE((s[a] ^ s[b]) != 0);
            for (unsigned c = b + 1u; c < 120u; c++) {
                TEST_ASSERT_TRUE((s[a] ^ s[b] ^ s[c]) != 0);
            }
        }
    }
}

/* proves: PL-CRC-14 */
static void test_in_a_burst_exactly_the_pairs_127_bits_apart_pass(void)
{
    uint8_t s[BURST_BITS];
    unsigned unseen = 0;
    syndromes(s, BURST_BYTES);
    for (unsigned a = 0; a < BURST_BITS; a++) {
        for (unsigned b = a + 1u; b < BURST_BITS; b++) {
            TEST_ASSERT_EQUAL_INT(b - a == 127u, s[a] == s[b]);
            unseen += s[a] == s[b];
        }
    }
    TEST_ASSERT_EQUAL_UINT(BURST_BITS - 127u, unseen);
}

/* proves: PL-CRC-14 */
static void test_odd_numbers_and_short_bursts_are_always_seen(void)
{
    uint8_t s[BURST_BITS];
    syndromes(s, BURST_BYTES);
    for (unsigned bit = 0; bit < BURST_BITS; bit++) {
        unsigned ones = 0;
        for (unsigned i = 0; i < 8u; i++) {
            ones += (unsigned)s[bit] >> i & 1u;
        }
        /* Each syndrome has odd weight, so the sum of an odd number of them has, and cannot be zero. */
        TEST_ASSERT_EQUAL_UINT(1, ones & 1u);
    }
    for (unsigned start = 0; start + 8u <= BURST_BITS; start++) {
        for (unsigned pattern = 1; pattern < 256u; pattern++) {
            uint8_t sum = 0;
            for (unsigned i = 0; i < 8u; i++) {
                sum ^= (pattern >> i & 1u) != 0u ? s[start + i] : 0u;
            }
            TEST_ASSERT_TRUE(sum != 0u);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_published_values);
    RUN_TEST(test_all_forms_agree_with_the_definition);
    RUN_TEST(test_no_bytes_leave_the_crc_alone_and_null_is_legal);
    RUN_TEST(test_up_to_three_errors_are_seen_in_127_bits);
    RUN_TEST(test_in_a_burst_exactly_the_pairs_127_bits_apart_pass);
    RUN_TEST(test_odd_numbers_and_short_bursts_are_always_seen);
    return UNITY_END();
}
