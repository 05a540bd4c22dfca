/* SPDX-License-Identifier: Apache-2.0 */
/* The harness lets through what is true; that it stops what is false is proved by the canary program beside
 * this file. */
#include "unity.h"

static int set_ups, tear_downs;

void setUp(void)
{
    set_ups++;
}

void tearDown(void)
{
    tear_downs++;
}

static void test_true_assertions_pass(void)
{
    static const unsigned char bytes[3] = {1, 2, 3}, same[3] = {1, 2, 3};
    const char *text = "abc";
    TEST_ASSERT(1);
    TEST_ASSERT_TRUE(2);
    TEST_ASSERT_FALSE(0);
    TEST_ASSERT_NULL((void *)0);
    TEST_ASSERT_NOT_NULL(text);
    TEST_ASSERT_EQUAL(-5, -5);
    TEST_ASSERT_NOT_EQUAL(5, -5);
    TEST_ASSERT_EQUAL_UINT32(0xffffffffu, 0xffffffffu);
    TEST_ASSERT_EQUAL_UINT64(0xffffffffffffffffull, 0xffffffffffffffffull);
    TEST_ASSERT_EQUAL_HEX8(0xfe, -2);
    TEST_ASSERT_EQUAL_HEX16(0xfffe, -2);
    TEST_ASSERT_EQUAL_HEX32(0xfffffffe, -2);
    TEST_ASSERT_INT_WITHIN(2, 10, 8);
    TEST_ASSERT_INT_WITHIN(2, 10, 12);
    TEST_ASSERT_GREATER_THAN(1, 2);
    TEST_ASSERT_GREATER_OR_EQUAL(2, 2);
    TEST_ASSERT_LESS_THAN(2, 1);
    TEST_ASSERT_LESS_OR_EQUAL(2, 2);
    TEST_ASSERT_EQUAL_STRING("abc", text);
    TEST_ASSERT_EQUAL_STRING((const char *)0, (const char *)0);
    TEST_ASSERT_EQUAL_MEMORY(bytes, same, 3);
    TEST_ASSERT_EQUAL_MEMORY(bytes, "xyz", 0);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 1.0, 1.05);
}

static void test_each_test_is_set_up_and_torn_down_once(void)
{
    TEST_ASSERT_EQUAL_INT(2, set_ups);
    TEST_ASSERT_EQUAL_INT(1, tear_downs);
}

static void test_ignored(void)
{
    TEST_IGNORE_MESSAGE("an ignored test ends here and is no failure");
    TEST_FAIL();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_true_assertions_pass);
    RUN_TEST(test_each_test_is_set_up_and_torn_down_once);
    RUN_TEST(test_ignored);
    return UNITY_END() != 0 || set_ups != 3 || tear_downs != 3;
}
