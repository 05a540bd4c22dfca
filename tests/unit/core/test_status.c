/* SPDX-License-Identifier: Apache-2.0 */
#include "bqhost/status.h"
#include "unity.h"
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_every_status_has_its_own_name(void)
{
#define NAMED(s)                                                                                             \
    do {                                                                                                     \
        TEST_ASSERT_EQUAL_STRING(#s, bq_status_name(s));                                                     \
        TEST_ASSERT_EQUAL_STRING(&#s[(s) < 0 ? strlen("BQ_E_") : strlen("BQ_")], bq_status_word(s));         \
    } while (0)
    NAMED(BQ_OK);
    NAMED(BQ_PENDING);
    NAMED(BQ_E_ARG);
    NAMED(BQ_E_STATE);
    NAMED(BQ_E_BUSY);
    NAMED(BQ_E_UNSUPPORTED);
    NAMED(BQ_E_RANGE);
    NAMED(BQ_E_NO_CODE);
    NAMED(BQ_E_COV_CUV);
    NAMED(BQ_E_DEVICES);
    NAMED(BQ_E_CELLS);
    NAMED(BQ_E_UNLATCHED);
    NAMED(BQ_E_CLOCK);
    NAMED(BQ_E_CONFIG);
    NAMED(BQ_E_BUS);
    NAMED(BQ_E_TIMEOUT);
    NAMED(BQ_E_NO_ANSWER);
    NAMED(BQ_E_CRC);
    NAMED(BQ_E_IMPLAUSIBLE);
    NAMED(BQ_E_NACK);
    NAMED(BQ_E_ARBITRATION);
    NAMED(BQ_E_VERIFY);
    NAMED(BQ_E_NOT_FOUND);
    NAMED(BQ_E_EXTRA_DEVICE);
    NAMED(BQ_E_LOCKED_UP);
    NAMED(BQ_E_DEFECTIVE);
    NAMED(BQ_E_LINE_STUCK);
    NAMED(BQ_E_CHAIN_BROKEN);
    NAMED(BQ_E_PERSISTS);
    NAMED(BQ_E_NOT_BLANK);
    NAMED(BQ_E_VOLTAGE);
    NAMED(BQ_E_STALE);
    NAMED(BQ_E_CRC_OFF);
}

static void test_unknown_values_have_a_name_too(void)
{
    TEST_ASSERT_EQUAL_STRING("BQ_E_?", bq_status_name((bq_status)-5));
    TEST_ASSERT_EQUAL_STRING("BQ_E_?", bq_status_name((bq_status)-42));
    TEST_ASSERT_EQUAL_STRING("BQ_E_?", bq_status_name((bq_status)2));
    TEST_ASSERT_EQUAL_STRING("BQ_E_?", bq_status_name((bq_status)-128));
    TEST_ASSERT_EQUAL_STRING("?", bq_status_word((bq_status)-5));
    TEST_ASSERT_EQUAL_STRING("?", bq_status_word((bq_status)2));
    if (sizeof(bq_status) >
        1u) { /* a compiler may give the type a single byte, as Arm's rules for bare metal do */
        TEST_ASSERT_EQUAL_STRING("BQ_E_?", bq_status_name((bq_status)-2147483647));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_status_has_its_own_name);
    RUN_TEST(test_unknown_values_have_a_name_too);
    return UNITY_END();
}
