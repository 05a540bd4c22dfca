/* SPDX-License-Identifier: Apache-2.0 */
/*
 * One failing assertion per case. `canary list` prints the names; `canary NAME` runs that case and must exit
 * with 1; `canary none` runs no test at all and must exit with 1 too; `canary many` fails 256 times and must
 * not exit with 0.
 */
#include "unity.h"
#include <stdio.h>
#include <string.h>

static int tears;

void setUp(void)
{
}

void tearDown(void)
{
    tears++;
}

static const int here = 1;
static const unsigned char one[4] = {1, 2, 3, 4}, two[4] = {1, 2, 3, 5};

#define CASES(X)                                                                                             \
    X(fail, TEST_FAIL())                                                                                     \
    X(fail_message, TEST_FAIL_MESSAGE("as asked"))                                                           \
    X(assertion, TEST_ASSERT(here == 2))                                                                     \
    X(true_, TEST_ASSERT_TRUE(here == 2))                                                                    \
    X(false_, TEST_ASSERT_FALSE(here == 1))                                                                  \
    X(true_message, TEST_ASSERT_TRUE_MESSAGE(here == 2, "m"))                                                \
    X(false_message, TEST_ASSERT_FALSE_MESSAGE(here == 1, "m"))                                              \
    X(assert_message, TEST_ASSERT_MESSAGE(here == 2, "m"))                                                   \
    X(null, TEST_ASSERT_NULL(&here))                                                                         \
    X(not_null, TEST_ASSERT_NOT_NULL((const int *)0))                                                        \
    X(not_null_message, TEST_ASSERT_NOT_NULL_MESSAGE((const int *)0, "m"))                                   \
    X(equal, TEST_ASSERT_EQUAL(2, here))                                                                     \
    X(equal_message, TEST_ASSERT_EQUAL_MESSAGE(2, here, "m"))                                                \
    X(not_equal, TEST_ASSERT_NOT_EQUAL(1, here))                                                             \
    X(equal_int, TEST_ASSERT_EQUAL_INT(-1, here))                                                            \
    X(equal_int_message, TEST_ASSERT_EQUAL_INT_MESSAGE(-1, here, "m"))                                       \
    X(equal_int16, TEST_ASSERT_EQUAL_INT16(-1, here))                                                        \
    X(equal_int32, TEST_ASSERT_EQUAL_INT32(-1, here))                                                        \
    X(equal_int64, TEST_ASSERT_EQUAL_INT64(0x100000001ll, here))                                             \
    X(equal_uint, TEST_ASSERT_EQUAL_UINT(2, here))                                                           \
    X(equal_uint_message, TEST_ASSERT_EQUAL_UINT_MESSAGE(2, here, "m"))                                      \
    X(equal_uint8, TEST_ASSERT_EQUAL_UINT8(2, here))                                                         \
    X(equal_uint16, TEST_ASSERT_EQUAL_UINT16(2, here))                                                       \
    X(equal_uint32, TEST_ASSERT_EQUAL_UINT32(2, here))                                                       \
    X(equal_uint64, TEST_ASSERT_EQUAL_UINT64(0x100000001ull, here))                                          \
    X(equal_char, TEST_ASSERT_EQUAL_CHAR('a', 'b'))                                                          \
    X(hex8, TEST_ASSERT_EQUAL_HEX8(0x11, here))                                                              \
    X(hex8_message, TEST_ASSERT_EQUAL_HEX8_MESSAGE(0x11, here, "m"))                                         \
    X(hex16, TEST_ASSERT_EQUAL_HEX16(0x101, here))                                                           \
    X(hex16_message, TEST_ASSERT_EQUAL_HEX16_MESSAGE(0x101, here, "m"))                                      \
    X(hex32, TEST_ASSERT_EQUAL_HEX32(0x10000001, here))                                                      \
    X(int_within, TEST_ASSERT_INT_WITHIN(1, 3, here))                                                        \
    X(int_within_below, TEST_ASSERT_INT_WITHIN(1, -1, here))                                                 \
    X(int_within_message, TEST_ASSERT_INT_WITHIN_MESSAGE(1, 3, here, "m"))                                   \
    X(uint_within, TEST_ASSERT_UINT_WITHIN(1, 3, here))                                                      \
    X(greater_than, TEST_ASSERT_GREATER_THAN(1, here))                                                       \
    X(greater_or_equal, TEST_ASSERT_GREATER_OR_EQUAL(2, here))                                               \
    X(less_than, TEST_ASSERT_LESS_THAN(1, here))                                                             \
    X(less_or_equal, TEST_ASSERT_LESS_OR_EQUAL(0, here))                                                     \
    X(string, TEST_ASSERT_EQUAL_STRING("a", "b"))                                                            \
    X(string_null, TEST_ASSERT_EQUAL_STRING("a", (const char *)0))                                           \
    X(string_message, TEST_ASSERT_EQUAL_STRING_MESSAGE("a", "b", "m"))                                       \
    X(memory, TEST_ASSERT_EQUAL_MEMORY(one, two, 4))                                                         \
    X(memory_message, TEST_ASSERT_EQUAL_MEMORY_MESSAGE(one, two, 4, "m"))                                    \
    X(hex8_array, TEST_ASSERT_EQUAL_HEX8_ARRAY(one, two, 4))                                                 \
    X(uint8_array, TEST_ASSERT_EQUAL_UINT8_ARRAY(one, two, 4))                                               \
    X(double_within, TEST_ASSERT_DOUBLE_WITHIN(0.1, 1.0, 1.2))                                               \
    X(double_not_a_number, TEST_ASSERT_DOUBLE_WITHIN(0.1, 1.0, 0.0 * (1e308 * 10.0 * here)))

#define FUNCTION(name, assertion)                                                                            \
    static void case_##name(void)                                                                            \
    {                                                                                                        \
        assertion;                                                                                           \
        printf("went on after a failed assertion\n");                                                        \
    }
CASES(FUNCTION)

static const struct {
    const char *name;
    void (*run)(void);
} cases[] = {
#define ENTRY(name, assertion) {#name, case_##name},
    CASES(ENTRY)};

#define COUNT (sizeof cases / sizeof cases[0])

static int run_case(const char *name)
{
    for (unsigned i = 0; i < COUNT; i++) {
        if (strcmp(cases[i].name, name) == 0) {
            UNITY_BEGIN();
            RUN_TEST(cases[i].run);
            int failures = UNITY_END();
            return tears == 1 ? failures : 99;
        }
    }
    return 98;
}

static int run_many(void)
{
    UNITY_BEGIN();
    for (int i = 0; i < 256; i++) {
        RUN_TEST(case_fail);
    }
    return UNITY_END();
}

int main(int argc, char **argv)
{
    const char *wanted = argc == 2 ? argv[1] : "";
    if (strcmp(wanted, "list") == 0) {
        for (unsigned i = 0; i < COUNT; i++) {
            printf("%s\n", cases[i].name);
        }
        return 0;
    }
    if (strcmp(wanted, "none") == 0) {
        UNITY_BEGIN();
        return UNITY_END();
    }
    return strcmp(wanted, "many") == 0 ? run_many() : run_case(wanted);
}
