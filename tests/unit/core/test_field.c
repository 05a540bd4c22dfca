/* SPDX-License-Identifier: Apache-2.0 */
/* Fields of structures by table, and words of lists. */
#include "bqhost/field.h"
#include "bqhost/text.h"
#include "unity.h"
#include <stdbool.h>
#include <string.h>

typedef struct object {
    uint8_t before, u8, after;
    bool flag;
    uint16_t u16;
    int16_t i16;
    uint32_t u32;
    int32_t i32;
    int8_t i8;
} object;

static const bq_field u8 = BQ_FIELD(object, u8, BQ_FIELD_UNSIGNED);
static const bq_field i8 = BQ_FIELD(object, i8, BQ_FIELD_SIGNED);
static const bq_field u16 = BQ_FIELD(object, u16, BQ_FIELD_UNSIGNED);
static const bq_field i16 = BQ_FIELD(object, i16, BQ_FIELD_SIGNED);
static const bq_field u32 = BQ_FIELD(object, u32, BQ_FIELD_UNSIGNED);
static const bq_field i32 = BQ_FIELD(object, i32, BQ_FIELD_SIGNED);
static const bq_field flag = BQ_FIELD(object, flag, BQ_FIELD_BOOL);

static object o;

void setUp(void)
{
    memset(&o, 0, sizeof o);
}

void tearDown(void)
{
}

static void test_a_field_is_read_as_its_type(void)
{
    o = (object){1, 200, 2, true, 60000, -2, 4000000000u, -3, -128};
    TEST_ASSERT_EQUAL_UINT32(200, bq_field_load(u8, &o));
    TEST_ASSERT_EQUAL_UINT32(1, bq_field_load(flag, &o));
    TEST_ASSERT_EQUAL_UINT32(60000, bq_field_load(u16, &o));
    TEST_ASSERT_EQUAL_INT32(-2, (int32_t)bq_field_load(i16, &o));
    TEST_ASSERT_EQUAL_UINT32(4000000000u, bq_field_load(u32, &o));
    TEST_ASSERT_EQUAL_INT32(-3, (int32_t)bq_field_load(i32, &o));
    TEST_ASSERT_EQUAL_INT32(-128, (int32_t)bq_field_load(i8, &o));
}

static void test_a_field_is_written_alone(void)
{
    o.before = 1;
    o.after = 2;
    bq_field_store(u8, &o, 0x1ffu);
    TEST_ASSERT_EQUAL(0xff, o.u8);
    TEST_ASSERT_EQUAL(1, o.before);
    TEST_ASSERT_EQUAL(2, o.after);
    bq_field_store(i16, &o, (uint32_t)-5);
    TEST_ASSERT_EQUAL(-5, o.i16);
    TEST_ASSERT_EQUAL(0, o.u16);
    TEST_ASSERT_EQUAL(0, o.u32);
    bq_field_store(i32, &o, (uint32_t)-7);
    TEST_ASSERT_EQUAL(-7, o.i32);
    TEST_ASSERT_EQUAL(0, o.i8);
    bq_field_store(flag, &o, 2);
    TEST_ASSERT_TRUE(o.flag);
}

static void test_what_a_field_can_hold_fits(void)
{
    TEST_ASSERT_EQUAL_UINT32(255, bq_field_fit(u8, 255));
    TEST_ASSERT_EQUAL_UINT32(0, bq_field_fit(u8, 256));
    TEST_ASSERT_EQUAL_UINT32((uint32_t)-128, bq_field_fit(i8, (uint32_t)-128));
    TEST_ASSERT_EQUAL_UINT32((uint32_t)-128, bq_field_fit(i8, 128));
    TEST_ASSERT_EQUAL_UINT32(65535, bq_field_fit(u16, 65535));
    TEST_ASSERT_EQUAL_UINT32(32767, bq_field_fit(i16, 32767));
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, bq_field_fit(u32, UINT32_MAX));
    TEST_ASSERT_EQUAL_UINT32(0x80000000u, bq_field_fit(i32, 0x80000000u));
    TEST_ASSERT_EQUAL_UINT32(1, bq_field_fit(flag, 2));
}

static void test_words_are_counted_from_the_beginning(void)
{
    static const char words[] = "one\0\0three";

    TEST_ASSERT_EQUAL_STRING("one", bq_word(words, 0));
    TEST_ASSERT_EQUAL_STRING("", bq_word(words, 1));
    TEST_ASSERT_EQUAL_STRING("three", bq_word(words, 2));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_field_is_read_as_its_type);
    RUN_TEST(test_a_field_is_written_alone);
    RUN_TEST(test_what_a_field_can_hold_fits);
    RUN_TEST(test_words_are_counted_from_the_beginning);
    return UNITY_END();
}
