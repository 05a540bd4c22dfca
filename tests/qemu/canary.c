/* SPDX-License-Identifier: Apache-2.0 */
/* Programs that must not look like success; one that must. Chosen by a CANARY_ macro. */
#include "unity.h"
#include <stdint.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_case(void)
{
#ifdef CANARY_FAULTS
    *(volatile uint32_t *)0xfffffff0u = *(volatile uint32_t *)0x60000000u; /* nothing answers there */
#endif
#ifdef CANARY_HANGS
    for (volatile int i = 0;; i++) {
    }
#endif
#if defined CANARY_FAILS || defined CANARY_MANY
    TEST_ASSERT_EQUAL(1, 2);
#else
    TEST_ASSERT_EQUAL(1, 1);
#endif
}

int main(void)
{
    int times = 1;
#ifdef CANARY_MANY
    times = 256;
#endif
    UNITY_BEGIN();
    for (int i = 0; i < times; i++) {
        RUN_TEST(test_case);
    }
    return UNITY_END();
}
