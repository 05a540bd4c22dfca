/* SPDX-License-Identifier: Apache-2.0 */
/* CRC arithmetic of the bq769x0, and what the rules that are nearly right would give. */
#include "bqhost/crc8.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static uint8_t crc(const char *bytes, unsigned n)
{
    return bq_crc8(0, (const uint8_t *)bytes, n);
}

/* proves: X0-NUM-801, X0-I2C-11 */
static void test_check_values(void)
{
    TEST_ASSERT_EQUAL_HEX8(0xf4, crc("123456789", 9));
    TEST_ASSERT_EQUAL_HEX8(0x00, crc("", 0));
    TEST_ASSERT_EQUAL_HEX8(0x00, crc("\x00", 1));
    TEST_ASSERT_EQUAL_HEX8(0x07, crc("\x01", 1));
    TEST_ASSERT_EQUAL_HEX8(0x89, crc("\x80", 1));
    TEST_ASSERT_EQUAL_HEX8(0xf3, crc("\xff", 1));
    TEST_ASSERT_EQUAL_HEX8(0x4f, crc("\x19", 1));
}

/* proves: X0-NUM-802 */
static void test_prefixes(void)
{
    TEST_ASSERT_EQUAL_HEX8(0x70, crc("\x10", 1));
    TEST_ASSERT_EQUAL_HEX8(0x77, crc("\x11", 1));
    TEST_ASSERT_EQUAL_HEX8(0x90, crc("\x30", 1));
    TEST_ASSERT_EQUAL_HEX8(0x97, crc("\x31", 1));
    TEST_ASSERT_EQUAL_HEX8(0x66, crc("\x10\x0b", 2));
    TEST_ASSERT_EQUAL_HEX8(0x4b, crc("\x10\x04", 2));
}

/* proves: X0-NUM-858, X0-AMB-77 */
static void test_wrong_rules_give_other_values(void)
{
    TEST_ASSERT_EQUAL_HEX8(0x7a, crc("\x10\x0b\x19", 3));
    TEST_ASSERT_EQUAL_HEX8(0xd8, crc("\x0b\x19", 2));
    TEST_ASSERT_EQUAL_HEX8(0x4f, crc("\x19", 1));
    TEST_ASSERT_EQUAL_HEX8(0x89, crc("\x08\x0b\x19", 3));
    TEST_ASSERT_EQUAL_HEX8(0x0a, crc("\x11\x18", 2));
    TEST_ASSERT_EQUAL_HEX8(0xc6, crc("\x10\x04\x11\x18", 4));
    TEST_ASSERT_EQUAL_HEX8(0x1f, crc("\x10\x18", 2));
    TEST_ASSERT_EQUAL_HEX8(0xe0, crc("\x08\x18", 2));
    TEST_ASSERT_EQUAL_HEX8(0x48, crc("\x18", 1));
}

/* proves: X0-NUM-859, X0-NUM-860, X0-NUM-861, X0-NUM-862, X0-NUM-863, X0-NUM-864, X0-NUM-865, X0-NUM-866 */
static void test_arithmetic_at_the_other_address(void)
{
    TEST_ASSERT_EQUAL_HEX8(0x39, crc("\x30\x0b\x19", 3));
    TEST_ASSERT_EQUAL_HEX8(0x6e, crc("\x30\x05\x43", 3));
    TEST_ASSERT_EQUAL_HEX8(0x68, crc("\x30\x00\x80", 3));
    TEST_ASSERT_EQUAL_HEX8(0x27, crc("\x30\x06\x8b", 3));
    TEST_ASSERT_EQUAL_HEX8(0x81, crc("\x5a", 1));
    TEST_ASSERT_EQUAL_HEX8(0xb7, crc("\x50", 1));
    TEST_ASSERT_EQUAL_HEX8(0x34, crc("\xbf", 1));
    TEST_ASSERT_EQUAL_HEX8(0xc6, crc("\x99", 1));
    TEST_ASSERT_EQUAL_HEX8(0x65, crc("\x31\x80", 2));
    TEST_ASSERT_EQUAL_HEX8(0x9c, crc("\x31\x10", 2));
    TEST_ASSERT_EQUAL_HEX8(0x10, crc("\x31\x24", 2));
    TEST_ASSERT_EQUAL_HEX8(0x3e, crc("\xd0", 1));
    TEST_ASSERT_EQUAL_HEX8(0xfc, crc("\x24", 1));
    TEST_ASSERT_EQUAL_HEX8(0xf0, crc("\x31\x04", 2));
    TEST_ASSERT_EQUAL_HEX8(0x5a, crc("\x1e", 1));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_check_values);
    RUN_TEST(test_prefixes);
    RUN_TEST(test_wrong_rules_give_other_values);
    RUN_TEST(test_arithmetic_at_the_other_address);
    return UNITY_END();
}
