/* SPDX-License-Identifier: Apache-2.0 */
#include "stm32_i2c.h"
#include "unity.h"

static uint8_t data[80];

void setUp(void)
{
}

void tearDown(void)
{
}

/* hal.h: an empty write is legal, an empty read is not; data may be missing only where there is no length. */
static void test_arguments(void)
{
    bq_i2c_segment write = {data, 1, false, false}, read = {data, 80, true, true};
    bq_i2c_segment empty_write = {NULL, 0, false, true}, empty_read = {data, 0, true, true};
    bq_i2c_segment nowhere = {NULL, 1, true, true}, nothing = {NULL, 1, false, true};
    bq_i2c_segment both[2];
    both[0] = write;
    both[1] = read;
    TEST_ASSERT_TRUE(stm32_i2c_legal(0x08, both, 2));
    TEST_ASSERT_TRUE(stm32_i2c_legal(0x7f, &empty_write, 1));
    TEST_ASSERT_FALSE(stm32_i2c_legal(0x08, &empty_read, 1));
    TEST_ASSERT_FALSE(stm32_i2c_legal(0x08, &nowhere, 1));
    TEST_ASSERT_FALSE(stm32_i2c_legal(0x08, &nothing, 1));
    both[1] = nowhere;
    TEST_ASSERT_FALSE(stm32_i2c_legal(0x08, both, 2));
    TEST_ASSERT_FALSE(stm32_i2c_legal(0x80, &write, 1));
    TEST_ASSERT_FALSE(stm32_i2c_legal(0x08, &write, 0));
    TEST_ASSERT_FALSE(stm32_i2c_legal(0x08, NULL, 1));
    TEST_ASSERT_FALSE(stm32_i2c_legal(0x08, &write, 256));
}

/* The longest read of a bq769x0 takes 83 bytes of 90 us at 100 kHz, and 10 ms of stretching must be tolerated
 * on top (hal.h); with much more than that a transaction would hold up the control period. */
static void test_limit(void)
{
    bq_i2c_segment read[2] = {{data, 1, false, false}, {data, 80, true, true}};
    uint32_t limit = stm32_i2c_limit_us(read, 2);
    TEST_ASSERT_TRUE(limit > 83u * 90u + 10000u);
    TEST_ASSERT_TRUE(limit < 83u * 90u * 2u + 11000u);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_arguments);
    RUN_TEST(test_limit);
    return UNITY_END();
}
