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

/* What hal.h allows is refused for want of hardware, what it forbids as a wrong argument. */
static void test_can_is_off(void)
{
    bq_can can = hal_template_can(&h);
    bq_can_frame frame = {.id = 0x7ff, .len = 8};
    TEST_ASSERT_EQUAL_INT(BQ_E_BUS, can.ops->send(can.ctx, &frame));
    frame.id = 0x800;
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, can.ops->send(can.ctx, &frame));
    frame.extended = true;
    TEST_ASSERT_EQUAL_INT(BQ_E_BUS, can.ops->send(can.ctx, &frame));
    frame.id = 0x20000000;
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, can.ops->send(can.ctx, &frame));
    frame = (bq_can_frame){.id = 1, .len = 9};
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, can.ops->send(can.ctx, &frame));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, can.ops->send(can.ctx, NULL));
    TEST_ASSERT_EQUAL_INT(BQ_PENDING, can.ops->receive(can.ctx, &frame));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, can.ops->receive(can.ctx, NULL));
    TEST_ASSERT_EQUAL_INT(BQ_CAN_OFF, can.ops->state(can.ctx));
}

static void test_console_takes_nothing(void)
{
    bq_stream stream = hal_template_stream(&h);
    uint8_t byte = 'x';
    TEST_ASSERT_EQUAL_UINT(0, stream.ops->write(stream.ctx, &byte, 1));
    TEST_ASSERT_EQUAL_UINT(0, stream.ops->read(stream.ctx, &byte, 1));
}

static void test_memory_holds_nothing(void)
{
    bq_nvm nvm = hal_template_nvm(&h);
    uint8_t data[4] = {0};
    TEST_ASSERT_TRUE(nvm.sectors >= 2u && nvm.sector_bytes % nvm.unit_bytes == 0u);
    TEST_ASSERT_EQUAL_INT(BQ_E_BUS, nvm.ops->read(nvm.ctx, 0, 0, data, 4));
    TEST_ASSERT_EQUAL_INT(
        BQ_E_BUS, nvm.ops->program(nvm.ctx, 1, nvm.sector_bytes - nvm.unit_bytes, data, nvm.unit_bytes));
    TEST_ASSERT_EQUAL_INT(BQ_E_BUS, nvm.ops->erase(nvm.ctx, 1));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, nvm.ops->read(nvm.ctx, nvm.sectors, 0, data, 4));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, nvm.ops->read(nvm.ctx, 0, nvm.sector_bytes - 3u, data, 4));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, nvm.ops->read(nvm.ctx, 0, 0, NULL, 4));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, nvm.ops->program(nvm.ctx, 0, 1, data, nvm.unit_bytes));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, nvm.ops->program(nvm.ctx, 0, 0, data, 1));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, nvm.ops->erase(nvm.ctx, nvm.sectors));
}

/* A port that forgot to check its image keeps its outputs off. */
static void test_image_is_not_trusted(void)
{
    bq_mcu mcu = hal_template_mcu(&h);
    TEST_ASSERT_TRUE(mcu.ops->feed && mcu.ops->reset);
    TEST_ASSERT_EQUAL_UINT(UINT32_MAX, mcu.ops->stack_free(mcu.ctx));
    TEST_ASSERT_FALSE(mcu.boot->image_ok);
    TEST_ASSERT_FALSE(mcu.boot->crashed);
    TEST_ASSERT_EQUAL_INT(BQ_RESET_UNKNOWN, mcu.boot->cause);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_operation_exists);
    RUN_TEST(test_spi_sends_nothing);
    RUN_TEST(test_i2c_sends_nothing);
    RUN_TEST(test_no_line_exists);
    RUN_TEST(test_no_current_is_known);
    RUN_TEST(test_can_is_off);
    RUN_TEST(test_console_takes_nothing);
    RUN_TEST(test_memory_holds_nothing);
    RUN_TEST(test_image_is_not_trusted);
    return UNITY_END();
}
