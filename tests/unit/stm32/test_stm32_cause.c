/* SPDX-License-Identifier: Apache-2.0 */
/* RCC_CSR after each kind of reset: bits 26 pin, 27 power-on, 28 software, 29 and 30 watchdogs
 * (RM0091 6.4.10). The pin flag comes with every internal reset, because each of them pulls the pin. */
#include "stm32_life.h"
#include "unity.h"

#define PIN (1u << 26)
#define POWER (1u << 27)
#define SOFTWARE (1u << 28)
#define IWDG (1u << 29)
#define WWDG (1u << 30)
#define BROWN_OUT (1u << 25) /* RM0090 7.3.21; on the F0 that bit is the option byte loader's */

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_each_reset(void)
{
    TEST_ASSERT_EQUAL_INT(BQ_RESET_POWER, stm32_reset_cause(POWER | PIN, 0, false, false));
    TEST_ASSERT_EQUAL_INT(BQ_RESET_PIN, stm32_reset_cause(PIN, 0, true, false));
    TEST_ASSERT_EQUAL_INT(BQ_RESET_SOFTWARE, stm32_reset_cause(SOFTWARE | PIN, 0, true, false));
    TEST_ASSERT_EQUAL_INT(BQ_RESET_WATCHDOG, stm32_reset_cause(IWDG | PIN, 0, true, false));
    TEST_ASSERT_EQUAL_INT(BQ_RESET_WATCHDOG, stm32_reset_cause(WWDG | PIN, 0, true, false));
    TEST_ASSERT_EQUAL_INT(BQ_RESET_CRASH, stm32_reset_cause(SOFTWARE | PIN, 0, true, true));
    TEST_ASSERT_EQUAL_INT(BQ_RESET_UNKNOWN, stm32_reset_cause(0, 0, true, false));
}

/* A supply that came back before RAM lost its content was a dip; the F4 has a flag for it, which also comes
 * with every power-on. */
static void test_brown_out(void)
{
    TEST_ASSERT_EQUAL_INT(BQ_RESET_BROWN_OUT, stm32_reset_cause(POWER | PIN, 0, true, false));
    TEST_ASSERT_EQUAL_INT(BQ_RESET_BROWN_OUT, stm32_reset_cause(BROWN_OUT | PIN, BROWN_OUT, true, false));
    TEST_ASSERT_EQUAL_INT(BQ_RESET_POWER,
                          stm32_reset_cause(BROWN_OUT | POWER | PIN, BROWN_OUT, false, false));
    TEST_ASSERT_EQUAL_INT(BQ_RESET_PIN, stm32_reset_cause(BROWN_OUT | PIN, 0, true, false));
}

/* A crash that was followed by a loss of power is not why this life began. */
static void test_power_ends_a_crash(void)
{
    TEST_ASSERT_EQUAL_INT(BQ_RESET_BROWN_OUT, stm32_reset_cause(POWER | PIN, 0, true, true));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_reset);
    RUN_TEST(test_brown_out);
    RUN_TEST(test_power_ends_a_crash);
    return UNITY_END();
}
