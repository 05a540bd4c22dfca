/* SPDX-License-Identifier: Apache-2.0 */
/* What init accepts and refuses. Expected values: PL-NUM-13, -14, -16, -29, -30, -38, PL-TIM-10. */
#include "driver_rig.h"
#include "unity.h"
#include <string.h>

static driver_rig r;
static bq76pl536_config c;

void setUp(void)
{
    c = rig_config(4);
    rig_open(&r, &c, NULL);
}

void tearDown(void)
{
}

static bq_status init(void)
{
    const bq_spi spi = hal_sim_spi(&r.hal);
    const bq_gpio gpio = hal_sim_gpio(&r.hal);
    const bq_clock clock = hal_sim_clock(&r.hal);
    return bq76pl536_init(&r.d, &c, &spi, &gpio, &clock, r.devices, BQ76PL536_MAX_DEVICES);
}

static void refused(bq_status expected)
{
    static driver_rig before;
    memcpy(&before.d, &r.d, sizeof r.d);
    TEST_ASSERT_EQUAL_INT(expected, init());
    TEST_ASSERT_EQUAL_MEMORY(&before.d, &r.d, sizeof r.d);
    TEST_ASSERT_EQUAL_INT(0, r.hal.transfers);
    c = rig_config(4);
}

/* proves: PL-ELEC-10, PL-GEN-01, PL-SEQ-03-01, PL-AMB-32 */
static void refuses_a_stack_that_cannot_exist(void)
{
    static const uint8_t cells[4] = {6, 3, 5, 4};
    static const uint8_t bad[4] = {6, 3, 2, 4};
    c.devices = 0;
    refused(BQ_E_DEVICES);
    c.devices = 63;
    refused(BQ_E_DEVICES);
    c.cells_per_device = 2;
    refused(BQ_E_CELLS);
    c.cells_per_device = 7;
    refused(BQ_E_CELLS);
    c.cells = bad;
    refused(BQ_E_CELLS);
    c.cells = cells;
    c.cells_per_device = 0;
    TEST_ASSERT_EQUAL_INT(BQ_OK, init());
    c.devices = 62;
    c.cells = NULL;
    c.cells_per_device = 3;
    TEST_ASSERT_EQUAL_INT(BQ_OK, init());
}

/* proves: PL-ELEC-04, PL-COV-12, PL-NUM-16, PL-AMB-45 */
static void refuses_thresholds_without_code_or_too_close(void)
{
    c.cov_mv = 4210;
    refused(BQ_E_NO_CODE);
    c.cov_mv = 5050;
    refused(BQ_E_RANGE);
    c.cov_mv = 1950;
    refused(BQ_E_RANGE);
    c.cuv_mv = 2850;
    refused(BQ_E_NO_CODE);
    c.cuv_mv = 3400;
    refused(BQ_E_RANGE);
    c.cuv_mv = 600;
    refused(BQ_E_RANGE);
    c.cov_mv = 2000;
    c.cuv_mv = 1800;
    refused(BQ_E_COV_CUV);
    c.cov_mv = 3550;
    c.cuv_mv = 3300;
    refused(BQ_E_COV_CUV);
    c.cov_mv = 2000;
    c.cuv_mv = 1700;
    TEST_ASSERT_EQUAL_INT(BQ_OK, init());
    c.cov_mv = 3600;
    c.cuv_mv = 3300;
    TEST_ASSERT_EQUAL_INT(BQ_OK, init());
    c.cov_mv = 0; /* off: no distance to keep */
    TEST_ASSERT_EQUAL_INT(BQ_OK, init());
}

/* proves: PL-ELEC-05 */
static void refuses_thresholds_that_normal_cells_never_release(void)
{
    c.cov_mv = 4200;
    c.normal_max_mv = 4150; /* the release level itself */
    refused(BQ_E_CONFIG);
    c.cuv_mv = 2800;
    c.normal_min_mv = 2900;
    refused(BQ_E_CONFIG);
    c.normal_max_mv = 3000;
    c.normal_min_mv = 3001;
    refused(BQ_E_RANGE);
    c.cov_mv = 4200;
    c.normal_max_mv = 4149;
    c.cuv_mv = 2800;
    c.normal_min_mv = 2901;
    TEST_ASSERT_EQUAL_INT(BQ_OK, init());
    c.cov_mv = 0; /* nothing to release */
    c.normal_max_mv = 5000;
    c.cuv_mv = 0;
    c.normal_min_mv = 1200;
    TEST_ASSERT_EQUAL_INT(BQ_OK, init());
}

/* proves: PL-ELEC-03 */
static void refuses_cells_that_could_not_supply_the_smallest_device(void)
{
    static const uint8_t cells[4] = {6, 3, 5, 4};
    c.cuv_mv = 2000;
    c.cells = cells;
    c.normal_min_mv = 2399;
    refused(BQ_E_CONFIG);
    c.cuv_mv = 2000;
    c.cells_per_device = 3;
    c.normal_min_mv = 2399;
    refused(BQ_E_CONFIG);
    c.cuv_mv = 2000;
    c.cells = cells;
    c.normal_min_mv = 2400;
    TEST_ASSERT_EQUAL_INT(BQ_OK, init());
    c.cells = NULL;
    c.normal_min_mv = 2399; /* six of these suffice */
    TEST_ASSERT_EQUAL_INT(BQ_OK, init());
}

/* proves: PL-ELEC-06, PL-ELEC-07, PL-ELEC-08, PL-OT-08, PL-NUM-29, PL-NUM-30 */
static void refuses_delays_that_do_not_latch_or_have_no_code(void)
{
    c.cov_delay_us = 0;
    refused(BQ_E_UNLATCHED);
    c.cuv_delay_us = 0;
    refused(BQ_E_UNLATCHED);
    c.ot_delay_ms = 0;
    refused(BQ_E_UNLATCHED);
    c.cov_delay_us = 150;
    refused(BQ_E_NO_CODE);
    c.cuv_delay_us = 3200;
    refused(BQ_E_NO_CODE);
    c.cuv_delay_us = 3200000;
    refused(BQ_E_RANGE);
    c.ot_delay_ms = 505;
    refused(BQ_E_NO_CODE);
    c.ot_c[0] = 42;
    refused(BQ_E_NO_CODE);
    c.ot_c[1] = 95;
    refused(BQ_E_RANGE);
    c.sensor_settle_ms = 500; /* not shorter than the OT delay */
    refused(BQ_E_CONFIG);
    c.sensors = 1; /* OT2 without its sensor */
    refused(BQ_E_CONFIG);
    c.cov_delay_us = 0;
    c.cuv_delay_us = 0;
    c.ot_delay_ms = 0;
    c.allow_unlatched = true;
    TEST_ASSERT_EQUAL_INT(BQ_OK, init());
}

/* proves: PL-ELEC-11, PL-NUM-38, PL-TIM-01, PL-TIM-09 */
static void refuses_a_clock_beyond_the_limit_of_the_stack(void)
{
    c.spi_hz = 9999;
    refused(BQ_E_CLOCK);
    c.spi_hz = 1000001;
    refused(BQ_E_CLOCK);
    c.spi_hz = 1000000;
    TEST_ASSERT_EQUAL_INT(BQ_OK, init());
    c.spi_hz = 10000;
    TEST_ASSERT_EQUAL_INT(BQ_OK, init());
    c.devices = 32;
    c.spi_hz = 177000;
    refused(BQ_E_CLOCK);
    c.devices = 32;
    c.spi_hz = 176000;
    TEST_ASSERT_EQUAL_INT(BQ_OK, init());
    c.devices = 62;
    c.spi_hz = 92000;
    refused(BQ_E_CLOCK);
    c.devices = 62;
    c.spi_hz = 91000;
    TEST_ASSERT_EQUAL_INT(BQ_OK, init());
}

/* proves: PL-TIM-10, PL-SEQ-01-04 */
static void chooses_the_clock_by_stack_size(void)
{
    static const struct {
        uint8_t devices;
        uint32_t hz;
    } table[] = {{1, 250000}, {16, 250000}, {17, 125000}, {32, 125000}, {33, 62500}, {62, 62500}};
    for (unsigned i = 0; i < sizeof table / sizeof table[0]; i++) {
        bq76pl536_config k = rig_config(table[i].devices);
        rig_up(&r, &k, NULL);
        TEST_ASSERT_EQUAL_UINT(table[i].hz, r.hal.clock_hz);
        TEST_ASSERT_EQUAL_UINT(table[i].hz, bq76pl536_diagnose(&r.d)->spi_hz);
    }
}

/* proves: PL-ELEC-09, PL-VBAT-07 */
static void refuses_other_values_out_of_range(void)
{
    c.balance_timer_s = 64;
    refused(BQ_E_RANGE);
    c.wire_limit_mv = 109;
    refused(BQ_E_RANGE);
    c.sensors = 3;
    refused(BQ_E_RANGE);
    c.thermistor = NULL;
    refused(BQ_E_CONFIG);
    c.balance_timer_s = 63;
    c.wire_limit_mv = 110;
    TEST_ASSERT_EQUAL_INT(BQ_OK, init());
}

static void refuses_missing_parts(void)
{
    const bq_spi spi = hal_sim_spi(&r.hal);
    const bq_spi no_ops = {NULL, NULL};
    const bq_clock clock = hal_sim_clock(&r.hal);
    const bq_clock no_clock = {NULL, NULL};
    const bq_gpio no_lines = {NULL, NULL};
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_init(NULL, &c, &spi, NULL, &clock, r.devices, 62));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_init(&r.d, NULL, &spi, NULL, &clock, r.devices, 62));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_init(&r.d, &c, NULL, NULL, &clock, r.devices, 62));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_init(&r.d, &c, &no_ops, NULL, &clock, r.devices, 62));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_init(&r.d, &c, &spi, &no_lines, &clock, r.devices, 62));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_init(&r.d, &c, &spi, NULL, NULL, r.devices, 62));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_init(&r.d, &c, &spi, NULL, &no_clock, r.devices, 62));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_init(&r.d, &c, &spi, NULL, &clock, NULL, 62));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_init(&r.d, &c, &spi, NULL, &clock, r.devices, 3));
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_init(&r.d, &c, &spi, NULL, &clock, r.devices, 4));
}

static void jobs_are_refused_in_the_wrong_state(void)
{
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_poll(&r.d, NULL));
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, bq76pl536_scan(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, bq76pl536_apply(&r.d, &r.action));
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, bq76pl536_self_test(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, bq76pl536_sleep(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, bq76pl536_wake(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, bq76pl536_wire_test(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_E_STALE, bq76pl536_sample(&r.d, &r.sample));
    TEST_ASSERT_EQUAL_INT(0, r.hal.transfers);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_start(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_E_BUSY, bq76pl536_start(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_E_BUSY, bq76pl536_scan(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(&r, 10));
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, bq76pl536_wake(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_apply(&r.d, NULL));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_poll(NULL, NULL));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_wait(NULL, 1));
}

static void the_blocking_wait_is_bounded(void)
{
    r.hal.tick_ns = 1000;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_start(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_E_TIMEOUT, bq76pl536_wait(&r.d, 50000));
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_wait(&r.d, 2000000));
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_scan(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_wait(&r.d, 100000));
}

/* The memory of a Cortex-M4 with 20 KB for 32 devices. */
static void the_instance_is_small(void)
{
    TEST_ASSERT_TRUE(sizeof(bq76pl536_device) <= 96);
    TEST_ASSERT_TRUE(sizeof(bq76pl536) <= 640);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(refuses_a_stack_that_cannot_exist);
    RUN_TEST(refuses_thresholds_without_code_or_too_close);
    RUN_TEST(refuses_thresholds_that_normal_cells_never_release);
    RUN_TEST(refuses_cells_that_could_not_supply_the_smallest_device);
    RUN_TEST(refuses_delays_that_do_not_latch_or_have_no_code);
    RUN_TEST(refuses_a_clock_beyond_the_limit_of_the_stack);
    RUN_TEST(chooses_the_clock_by_stack_size);
    RUN_TEST(refuses_other_values_out_of_range);
    RUN_TEST(refuses_missing_parts);
    RUN_TEST(jobs_are_refused_in_the_wrong_state);
    RUN_TEST(the_blocking_wait_is_bounded);
    RUN_TEST(the_instance_is_small);
    return UNITY_END();
}
