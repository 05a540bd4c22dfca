/* SPDX-License-Identifier: Apache-2.0 */
/* The division of a core that has none, against that of the PC. */
#include "stm32f0_divide.h"
#include "unity.h"

static const uint32_t corners[] = {
    0,     1,     2,           3,           7,           9,           10,          999,        1000,
    65535, 65536, 0x7ffffffeu, 0x7fffffffu, 0x80000000u, 0x80000001u, 0xfffffffeu, 0xffffffffu};
#define CORNERS (sizeof corners / sizeof corners[0])

void setUp(void)
{
}

void tearDown(void)
{
}

static void same(uint32_t n, uint32_t d)
{
    uint64_t both = stm32f0_divide(n, d);
    TEST_ASSERT_EQUAL_UINT(n / d, (uint32_t)both);
    TEST_ASSERT_EQUAL_UINT(n % d, (uint32_t)(both >> 32));
}

static void same_signed(int32_t n, int32_t d)
{
    uint64_t both = stm32f0_divide_signed(n, d);
    TEST_ASSERT_EQUAL_INT((int32_t)((int64_t)n / d), (int32_t)(uint32_t)both);
    TEST_ASSERT_EQUAL_INT((int32_t)((int64_t)n % d), (int32_t)(uint32_t)(both >> 32));
}

static void test_corners(void)
{
    for (unsigned i = 0; i < CORNERS; i++) {
        for (unsigned k = 1; k < CORNERS; k++) {
            same(corners[i], corners[k]);
            if (corners[i] != 0x80000000u || corners[k] != 0xffffffffu) { /* no such number */
                same_signed((int32_t)corners[i], (int32_t)corners[k]);
            }
        }
    }
}

static void test_many(void)
{
    uint32_t n = 1, d = 99;
    for (unsigned i = 0; i < 20000u; i++) {
        n = n * 1664525u + 1013904223u;
        d = d * 22695477u + 1u;
        same(n, (d >> (i % 32u)) | 1u);
        same_signed((int32_t)n >> i % 13u, (int32_t)(d | 1u) >> i % 29u | 1);
    }
}

/* Undefined to the language; here it must not hang. */
static void test_by_zero(void)
{
    TEST_ASSERT_EQUAL_UINT(0, (uint32_t)stm32f0_divide(17, 0));
    TEST_ASSERT_EQUAL_UINT(17, (uint32_t)(stm32f0_divide(17, 0) >> 32));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_corners);
    RUN_TEST(test_many);
    RUN_TEST(test_by_zero);
    return UNITY_END();
}
