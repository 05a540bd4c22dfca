/* SPDX-License-Identifier: Apache-2.0 */
#include "stm32_ring.h"
#include "unity.h"
#include <string.h>

static uint8_t data[8];
static stm32_ring ring;

void setUp(void)
{
    memset(data, 0, sizeof data);
    stm32_ring_init(&ring, data, sizeof data);
}

void tearDown(void)
{
}

static void test_empty_at_first(void)
{
    uint8_t byte = 0x5a;
    TEST_ASSERT_EQUAL_UINT(0, stm32_ring_used(&ring));
    TEST_ASSERT_EQUAL_UINT(8, stm32_ring_room(&ring));
    TEST_ASSERT_FALSE(stm32_ring_get(&ring, &byte));
    TEST_ASSERT_EQUAL_HEX8(0x5a, byte);
}

/* All places are usable; one byte more is refused and changes nothing. */
static void test_full(void)
{
    uint8_t byte;
    for (unsigned i = 0; i < 8u; i++) {
        TEST_ASSERT_TRUE(stm32_ring_put(&ring, (uint8_t)(i + 1u)));
    }
    TEST_ASSERT_FALSE(stm32_ring_put(&ring, 99));
    TEST_ASSERT_EQUAL_UINT(8, stm32_ring_used(&ring));
    TEST_ASSERT_EQUAL_UINT(0, stm32_ring_room(&ring));
    for (unsigned i = 0; i < 8u; i++) {
        TEST_ASSERT_TRUE(stm32_ring_get(&ring, &byte));
        TEST_ASSERT_EQUAL_UINT(i + 1u, byte);
    }
    TEST_ASSERT_FALSE(stm32_ring_get(&ring, &byte));
}

/* 70000 bytes carry the 16-bit indices over their end; the filling level changes all the time. */
static void test_order_over_the_wrap_of_the_indices(void)
{
    unsigned in = 0, out = 0;
    uint8_t byte;
    while (out < 70000u) {
        for (unsigned n = in % 7u + 1u; n > 0u && stm32_ring_put(&ring, (uint8_t)(in * 31u)); n--) {
            in++;
        }
        for (unsigned n = out % 5u + 1u; n > 0u && stm32_ring_get(&ring, &byte); n--) {
            TEST_ASSERT_EQUAL_HEX8((uint8_t)(out * 31u), byte);
            out++;
        }
        TEST_ASSERT_EQUAL_UINT(in - out, stm32_ring_used(&ring));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_empty_at_first);
    RUN_TEST(test_full);
    RUN_TEST(test_order_over_the_wrap_of_the_indices);
    return UNITY_END();
}
