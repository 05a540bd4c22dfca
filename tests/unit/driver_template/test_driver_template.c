/* SPDX-License-Identifier: Apache-2.0 */
/* The empty driver below the super-loop: it refuses, it says why, and nothing is ever switched on. */
#include "fake_board.h"
#include "monitor_template.h"
#include "unity.h"
#include <string.h>

static struct {
    monitor_template driver;
    monitor_template_config config;
    bq_app app;
    bq_cell_reading cells[FAKE_CELLS];
    bq_temp_reading temps[FAKE_SENSORS];
    bq_module_reading modules[1];
    uint32_t us, transfers, closings;
    bool closed;
} t;

static uint32_t now_us(void *ctx)
{
    (void)ctx;
    return t.us;
}

static bq_status bus_start(void *ctx, uint8_t address7, const bq_i2c_segment *segments, size_t count)
{
    (void)ctx;
    (void)address7;
    (void)segments;
    (void)count;
    t.transfers++;
    return BQ_E_BUS;
}

static bq_status bus_poll(void *ctx)
{
    (void)ctx;
    return BQ_E_BUS;
}

static bq_status read_line(void *ctx, bq_line line, bool *level)
{
    (void)ctx;
    (void)line;
    (void)level;
    return BQ_E_UNSUPPORTED;
}

static bq_status write_line(void *ctx, bq_line line, bool level)
{
    (void)ctx;
    if (level && (line == BQ_LINE_CONTACTOR || line == BQ_LINE_PRECHARGE)) {
        t.closings++;
    }
    t.closed = line == BQ_LINE_CONTACTOR ? level : t.closed;
    return BQ_OK;
}

static const bq_i2c_ops bus_ops = {bus_start, bus_poll, NULL};
static const bq_gpio_ops line_ops = {read_line, write_line};
static const bq_i2c bus = {&bus_ops, NULL};
static const bq_gpio lines = {&line_ops, NULL};
static const bq_clock the_clock = {now_us, NULL};

void setUp(void)
{
    memset(&t, 0, sizeof t);
    t.us = 0xfff00000u; /* wraps soon */
    t.config.cells = FAKE_CELLS;
    TEST_ASSERT_EQUAL_INT(BQ_OK, monitor_template_init(&t.driver, &t.config, &bus, &lines, &the_clock));
}

void tearDown(void)
{
}

static void test_every_operation_is_there_and_refuses(void)
{
    bq_afe afe = monitor_template_afe(&t.driver);
    const bq_afe_ops *ops = afe.ops;
    bq_sample sample = {
        .cells = t.cells, .modules = t.modules, .cell_capacity = FAKE_CELLS, .module_capacity = 1};
    bq_action action;
    uint32_t wait_us = 77;
    memset(&action, 0, sizeof action);
    TEST_ASSERT_EQUAL_INT(BQ_OK, ops->poll(afe.ctx, NULL));
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, ops->scan(afe.ctx));
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, ops->apply(afe.ctx, &action));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, ops->apply(afe.ctx, NULL));
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, ops->self_test(afe.ctx));
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, ops->sleep(afe.ctx));
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, ops->wake(afe.ctx));
    TEST_ASSERT_EQUAL_INT(BQ_E_STALE, ops->sample(afe.ctx, &sample));
    TEST_ASSERT_EQUAL_UINT(0, sample.cell_count);
    sample.cell_capacity = FAKE_CELLS - 1;
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, ops->sample(afe.ctx, &sample));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, ops->sample(afe.ctx, NULL));
    TEST_ASSERT_EQUAL_UINT(0, ops->modules_found(afe.ctx));
    TEST_ASSERT_EQUAL_UINT(0, ops->stats(afe.ctx)->packets);

    TEST_ASSERT_EQUAL_INT(BQ_OK, ops->start(afe.ctx));
    TEST_ASSERT_EQUAL_INT(BQ_E_BUSY, ops->start(afe.ctx));
    TEST_ASSERT_EQUAL_INT(BQ_E_BUSY, ops->scan(afe.ctx));
    TEST_ASSERT_EQUAL_INT(BQ_E_BUSY, ops->wake(afe.ctx));
    TEST_ASSERT_EQUAL_INT(BQ_PENDING, ops->poll(afe.ctx, &wait_us));
    TEST_ASSERT_EQUAL_INT(BQ_PENDING, ops->poll(afe.ctx, &wait_us));
    TEST_ASSERT_EQUAL_UINT(1000, wait_us);
    t.us += wait_us;
    TEST_ASSERT_EQUAL_INT(BQ_E_UNSUPPORTED, ops->poll(afe.ctx, &wait_us));
    TEST_ASSERT_EQUAL_INT(BQ_E_UNSUPPORTED, ops->poll(afe.ctx, NULL)); /* and stays so */
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, ops->scan(afe.ctx));
    TEST_ASSERT_EQUAL_UINT(0, t.transfers);
}

static void test_what_init_refuses(void)
{
    bq_i2c none = {NULL, NULL};
    bq_clock stopped = {NULL, NULL};
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, monitor_template_init(NULL, &t.config, &bus, NULL, &the_clock));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, monitor_template_init(&t.driver, NULL, &bus, NULL, &the_clock));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, monitor_template_init(&t.driver, &t.config, NULL, NULL, &the_clock));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, monitor_template_init(&t.driver, &t.config, &none, NULL, &the_clock));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, monitor_template_init(&t.driver, &t.config, &bus, NULL, NULL));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, monitor_template_init(&t.driver, &t.config, &bus, NULL, &stopped));
    t.config.cells = 0;
    TEST_ASSERT_EQUAL_INT(BQ_E_CELLS, monitor_template_init(&t.driver, &t.config, &bus, NULL, &the_clock));
    t.config.cells = MONITOR_TEMPLATE_CELLS + 1;
    TEST_ASSERT_EQUAL_INT(BQ_E_CELLS, monitor_template_init(&t.driver, &t.config, &bus, NULL, &the_clock));
    t.config.cells = MONITOR_TEMPLATE_CELLS;
    TEST_ASSERT_EQUAL_INT(BQ_OK, monitor_template_init(&t.driver, &t.config, &bus, NULL, &the_clock));
}

static void run(uint32_t ms, bq_pack_request request)
{
    for (uint32_t us = 0; us < ms * 1000u;) {
        uint32_t hint;
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq_app_request(&t.app, request));
        hint = bq_app_step(&t.app);
        hint = hint == 0 ? 10 : hint > 50000 ? 50000 : hint;
        t.us += hint;
        us += hint;
        TEST_ASSERT_FALSE(t.closed);
        TEST_ASSERT_FALSE(bq_app_outputs_on(&t.app));
    }
}

static void test_the_loop_runs_on_it_and_never_switches_on(void)
{
    bq_app_config config = fake_config();
    bq_afe afe = monitor_template_afe(&t.driver);
    const bq_pack *pack;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq_app_init(&t.app, &config, &afe, &lines, &the_clock, NULL, t.cells,
                                             FAKE_CELLS, t.temps, FAKE_SENSORS, t.modules, 1));
    pack = bq_app_pack(&t.app);
    run(5000, BQ_REQUEST_OFF);
    run(20000, BQ_REQUEST_ON);
    run(5000, BQ_REQUEST_OFF); /* whatever is latched by a request could go now */
    run(30000, BQ_REQUEST_ON);
    TEST_ASSERT_EQUAL_UINT(0, t.closings);
    TEST_ASSERT_EQUAL_INT(BQ_PACK_FAULT, pack->state);
    TEST_ASSERT_TRUE((pack->faults >> BQ_FAULT_CONFIG & 1u) != 0); /* the reason, with its status */
    TEST_ASSERT_EQUAL_INT(BQ_E_UNSUPPORTED, pack->fault[BQ_FAULT_CONFIG].value);
    TEST_ASSERT_EQUAL_UINT(0, afe.ops->modules_found(afe.ctx));
    TEST_ASSERT_UINT_WITHIN(5, 59, bq_app_get_counters(&t.app)->bring_ups); /* once per retry_ms, no more */
    TEST_ASSERT_EQUAL_UINT(bq_app_get_counters(&t.app)->bring_ups,
                           bq_app_get_counters(&t.app)->bring_up_failures);
    run(5000, BQ_REQUEST_SLEEP);
    TEST_ASSERT_EQUAL_UINT(0, t.closings);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_operation_is_there_and_refuses);
    RUN_TEST(test_what_init_refuses);
    RUN_TEST(test_the_loop_runs_on_it_and_never_switches_on);
    return UNITY_END();
}
