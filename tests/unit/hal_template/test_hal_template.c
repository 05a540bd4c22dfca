/* SPDX-License-Identifier: Apache-2.0 */
/* The empty port refuses everything, so that a place that was forgotten when filling it in is noticed. */
#include "hal_template.h"
#include "unity.h"

static hal_template h;

void setUp(void)
{
    TEST_ASSERT_EQUAL_INT(BQ_OK, hal_template_init(&h));
}

void tearDown(void)
{
}

/* The five operations a driver needs of a board are there (the waits follow from the clock).
 * proves: PL-SPI-13 */
static void test_every_operation_exists(void)
{
    bq_spi spi = hal_template_spi(&h);
    bq_i2c i2c = hal_template_i2c(&h);
    bq_gpio gpio = hal_template_gpio(&h);
    TEST_ASSERT_TRUE(spi.ops->start && spi.ops->poll && spi.ops->set_clock);
    TEST_ASSERT_TRUE(i2c.ops->start && i2c.ops->poll && i2c.ops->recover);
    TEST_ASSERT_TRUE(gpio.ops->read && gpio.ops->write);
    TEST_ASSERT_TRUE(hal_template_clock(&h).now_us);
    TEST_ASSERT_TRUE(hal_template_ammeter(&h).read);
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, hal_template_init(NULL));
}

static void test_spi_sends_nothing(void)
{
    bq_spi spi = hal_template_spi(&h);
    uint8_t tx[4] = {0}, rx[4] = {0};
    TEST_ASSERT_EQUAL_INT(BQ_E_BUS, spi.ops->start(spi.ctx, tx, rx, sizeof tx));
    TEST_ASSERT_TRUE(spi.ops->poll(spi.ctx) < 0);
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, spi.ops->set_clock(spi.ctx, 1000000));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, spi.ops->start(spi.ctx, NULL, rx, 4));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, spi.ops->start(spi.ctx, tx, NULL, 4));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, spi.ops->start(spi.ctx, tx, rx, 0));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, spi.ops->start(spi.ctx, tx, rx, 257));
}

static void test_i2c_sends_nothing(void)
{
    bq_i2c i2c = hal_template_i2c(&h);
    uint8_t byte = 0;
    bq_i2c_segment segment = {&byte, 1, false, true};
    TEST_ASSERT_EQUAL_INT(BQ_E_ARBITRATION, i2c.ops->start(i2c.ctx, 0x08, &segment, 1));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, i2c.ops->start(i2c.ctx, 0x08, NULL, 1));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, i2c.ops->start(i2c.ctx, 0x08, &segment, 0));
    TEST_ASSERT_TRUE(i2c.ops->poll(i2c.ctx) < 0);
    TEST_ASSERT_EQUAL_INT(BQ_E_ARBITRATION, i2c.ops->recover(i2c.ctx));
}

static void test_no_line_exists(void)
{
    bq_gpio gpio = hal_template_gpio(&h);
    bool level = true;
    for (int line = 0; line < BQ_LINE_COUNT; line++) {
        TEST_ASSERT_EQUAL_INT(BQ_E_UNSUPPORTED, gpio.ops->read(gpio.ctx, (bq_line)line, &level));
        TEST_ASSERT_EQUAL_INT(BQ_E_UNSUPPORTED, gpio.ops->write(gpio.ctx, (bq_line)line, true));
    }
    TEST_ASSERT_TRUE(level);
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, gpio.ops->read(gpio.ctx, BQ_LINE_COUNT, &level));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, gpio.ops->write(gpio.ctx, BQ_LINE_COUNT, true));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, gpio.ops->read(gpio.ctx, BQ_LINE_FAULT, NULL));
}

static void test_no_current_is_known(void)
{
    bq_ammeter ammeter = hal_template_ammeter(&h);
    int32_t ma = 77;
    TEST_ASSERT_EQUAL_INT(BQ_E_STALE, ammeter.read(ammeter.ctx, &ma));
    TEST_ASSERT_EQUAL_INT(77, ma);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_operation_exists);
    RUN_TEST(test_spi_sends_nothing);
    RUN_TEST(test_i2c_sends_nothing);
    RUN_TEST(test_no_line_exists);
    RUN_TEST(test_no_current_is_known);
    return UNITY_END();
}
