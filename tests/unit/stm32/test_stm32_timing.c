/* SPDX-License-Identifier: Apache-2.0 */
/* I2C_TIMINGR taken apart as RM0091 26.7.5 describes its fields, against standard mode of the I2C
 * specification. */
#include "stm32f0_i2c_timing.h"
#include "unity.h"

#define QUANTUM_NS ((long)((STM32_I2C_TIMINGR >> 28) + 1u) * 125) /* of HSI, 8 MHz */

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_low_and_high(void)
{
    long low = (long)((STM32_I2C_TIMINGR & 0xffu) + 1u) * QUANTUM_NS;
    long high = (long)((STM32_I2C_TIMINGR >> 8 & 0xffu) + 1u) * QUANTUM_NS;
    TEST_ASSERT_EQUAL_INT(125, 1000000000 / (long)STM32_I2C_KERNEL_HZ);
    TEST_ASSERT_TRUE(low >= 4700);
    TEST_ASSERT_TRUE(high >= 4000);
    /* each edge is seen after the analog filter (50 ns or more) and 2 to 3 clocks of the kernel */
    TEST_ASSERT_TRUE(low + high + 2 * (50 + 2 * 125) >= 10000);
    TEST_ASSERT_TRUE(low + high + 2 * (50 + 2 * 125) <= 11000);
}

static void test_data_set_up_and_hold(void)
{
    long hold = (long)(STM32_I2C_TIMINGR >> 16 & 15u) * QUANTUM_NS;
    long set_up = (long)((STM32_I2C_TIMINGR >> 20 & 15u) + 1u) * QUANTUM_NS;
    TEST_ASSERT_TRUE(hold >= 300);           /* the fall of SDA */
    TEST_ASSERT_TRUE(hold + 5 * 125 < 3450); /* longest data valid time, with filter and synchronisation */
    TEST_ASSERT_TRUE(set_up >= 1000 + 250);  /* rise and set-up */
    TEST_ASSERT_TRUE(hold + set_up < 4700);
}

static void test_reserved_bits(void)
{
    TEST_ASSERT_EQUAL_HEX32(0, STM32_I2C_TIMINGR & 0x0f000000u);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_low_and_high);
    RUN_TEST(test_data_set_up_and_hold);
    RUN_TEST(test_reserved_bits);
    return UNITY_END();
}
