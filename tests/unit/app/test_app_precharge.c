/* SPDX-License-Identifier: Apache-2.0 */
/* Closing through a precharge path: its times, what ends it, and what must never close. */
#include "fake_board.h"
#include "unity.h"
#include <string.h>

static fake_board f;
static bq_app_config config;

void setUp(void)
{
    config = fake_config();
    config.precharge_ms = 450;
    config.precharge_end_ma = 2000;
    fake_init(&f, UINT32_MAX - 3000000u); /* the clock wraps somewhere in every test */
    f.has_path = true;
}

void tearDown(void)
{
}

/* In standby, with the request just made. */
static void requested(void)
{
    TEST_ASSERT_EQUAL(BQ_OK, fake_start(&f, &config, true));
    bq_app_use_precharge(&f.app);
    fake_run(&f, 1000);
    TEST_ASSERT_EQUAL(BQ_PACK_STANDBY, fake_state(&f));
    TEST_ASSERT_FALSE(f.path);
    TEST_ASSERT_EQUAL(BQ_OK, bq_app_request(&f.app, BQ_REQUEST_ON));
}

/* Runs until `*what` is `level`, at most `ms`; how long it took. */
static uint32_t until(const bool *what, bool level, uint32_t ms)
{
    uint32_t passed = 0;
    for (; *what != level && passed < ms; passed++) {
        fake_run(&f, 1);
    }
    TEST_ASSERT_EQUAL(level, *what);
    return passed;
}

static void never_closes(uint32_t ms)
{
    for (uint32_t i = 0; i < ms; i++) {
        fake_run(&f, 1);
        TEST_ASSERT_FALSE(f.closed);
    }
}

static uint32_t failures(void)
{
    return bq_app_get_counters(&f.app)->precharge_failures;
}

static void test_the_path_closes_first_and_opens_after_the_contactor(void)
{
    requested();
    TEST_ASSERT_LESS_OR_EQUAL(125, until(&f.path, true, 1000)); /* one step and its action */
    TEST_ASSERT_FALSE(f.closed);
    TEST_ASSERT_FALSE(bq_app_outputs_on(&f.app));
    /* 450 ms, rounded up to a control period */
    TEST_ASSERT_INT_WITHIN(60, 500, (int)until(&f.closed, true, 1000));
    TEST_ASSERT_TRUE(f.path);
    TEST_ASSERT_INT_WITHIN(60, 150, (int)until(&f.path, false, 1000));
    fake_run(&f, 3000);
    TEST_ASSERT_TRUE(f.closed);
    TEST_ASSERT_FALSE(f.path);
    TEST_ASSERT_EQUAL(0, bq_app_pack(&f.app)->fault[BQ_FAULT_CONTACTOR].count);
    TEST_ASSERT_EQUAL(0, failures());
}

static void test_every_closing_is_precharged(void)
{
    requested();
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_GREATER_OR_EQUAL(450, until(&f.closed, true, 1500));
        bq_app_request(&f.app, BQ_REQUEST_OFF);
        fake_run(&f, 500);
        TEST_ASSERT_FALSE(f.closed);
        TEST_ASSERT_FALSE(f.path);
        bq_app_request(&f.app, BQ_REQUEST_ON);
    }
}

/* Withdrawn at any time, it opens within a step of the loop, and nothing closes later. */
static void test_a_request_withdrawn_opens_the_path(void)
{
    for (uint32_t ms = 1; ms < 900u; ms += 37u) {
        setUp();
        requested();
        fake_run(&f, ms);
        bq_app_request(&f.app, BQ_REQUEST_OFF);
        fake_run(&f, 2);
        TEST_ASSERT_FALSE(f.path);
        TEST_ASSERT_FALSE(f.closed);
        never_closes(600);
        TEST_ASSERT_FALSE(f.path);
        TEST_ASSERT_EQUAL(0, failures());
    }
}

static void test_a_fault_opens_the_path(void)
{
    requested();
    (void)until(&f.path, true, 1000);
    f.faults = BQ_F_DIE_TEMP;
    (void)until(&f.path, false, 125);
    never_closes(1000);
    TEST_ASSERT_FALSE(f.path);
}

/* Not charged: the contactor stays open, the path opens, nothing is tried again while the request stands. */
static void not_charged(void)
{
    (void)until(&f.path, true, 1000);
    never_closes(800);
    TEST_ASSERT_FALSE(f.path);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CONTACTOR));
    TEST_ASSERT_EQUAL(1, failures());
    f.orders = 0;
    memset(f.order, 0, sizeof f.order);
    never_closes(5000);
    TEST_ASSERT_NULL(strchr(f.order, 'p'));
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CONTACTOR));
}

static void test_a_load_that_does_not_charge_keeps_the_contactor_open(void)
{
    requested();
    f.ma = -2001;
    not_charged();
    f.ma = 0;
    bq_app_request(&f.app, BQ_REQUEST_OFF);
    fake_run(&f, 2000);
    TEST_ASSERT_EQUAL(0, bq_app_pack(&f.app)->faults);
    bq_app_request(&f.app, BQ_REQUEST_ON);
    TEST_ASSERT_GREATER_OR_EQUAL(450, until(&f.closed, true, 1500));
}

static void test_a_current_into_the_pack_counts_too(void)
{
    requested();
    f.ma = 2001;
    not_charged();
}

static void test_just_enough_is_charged(void)
{
    requested();
    f.ma = -2000;
    (void)until(&f.closed, true, 1500);
    TEST_ASSERT_EQUAL(0, failures());
}

static void test_an_unknown_current_is_no_charged_load(void)
{
    requested();
    (void)until(&f.path, true, 1000);
    f.ammeter_status = BQ_E_BUS; /* the last value is older than the precharge when it ends */
    never_closes(1000);
    TEST_ASSERT_EQUAL(1, failures());
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CONTACTOR));
}

static void test_without_a_limit_the_time_alone_decides(void)
{
    config.precharge_end_ma = 0;
    requested();
    f.ma = -50000;
    f.ammeter_status = BQ_E_BUS;
    TEST_ASSERT_GREATER_OR_EQUAL(450, until(&f.closed, true, 1500));
}

static void test_a_path_that_cannot_be_closed_keeps_the_contactor_open(void)
{
    requested();
    f.path_status = BQ_E_BUS;
    never_closes(3000);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CONTACTOR));
    TEST_ASSERT_EQUAL(0, failures());
}

static void test_a_path_that_cannot_be_opened_again_is_a_contactor_fault(void)
{
    requested();
    (void)until(&f.closed, true, 1500);
    f.path_status = BQ_E_BUS;
    fake_run(&f, 600);
    TEST_ASSERT_FALSE(f.closed);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CONTACTOR));
}

/* Its resistor must bear what the header states. */
static void test_a_monitor_lost_meanwhile_bounds_the_time_of_the_path(void)
{
    requested();
    (void)until(&f.path, true, 1000);
    f.job[BQ_JOB_APPLY].takes_us = FAKE_HANG;
    f.job[BQ_JOB_SCAN].takes_us = FAKE_HANG;
    TEST_ASSERT_LESS_OR_EQUAL(500 + 250, until(&f.path, false, 2000));
    never_closes(1000);
}

/* A program that forgot to tell of the path; a board that has none, which is found before anything is asked.
 */
static void test_what_is_to_be_precharged_never_closes_without_a_path(void)
{
    TEST_ASSERT_EQUAL(BQ_OK, fake_start(&f, &config, true));
    fake_run(&f, 1000);
    bq_app_request(&f.app, BQ_REQUEST_ON);
    never_closes(2000);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CONTACTOR));
    setUp();
    f.has_path = false;
    TEST_ASSERT_EQUAL(BQ_OK, fake_start(&f, &config, true));
    bq_app_use_precharge(&f.app);
    fake_run(&f, 1000);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CONTACTOR));
    bq_app_request(&f.app, BQ_REQUEST_ON);
    never_closes(2000);
}

static void test_without_a_time_the_contactor_closes_directly(void)
{
    config.precharge_ms = 0;
    config.precharge_end_ma = 0;
    requested();
    TEST_ASSERT_LESS_OR_EQUAL(125, until(&f.closed, true, 1000));
    TEST_ASSERT_NULL(strchr(f.order, 'p'));
}

static void test_configuration_that_is_refused(void)
{
    const char *field = NULL;

    config.precharge_ms = 10001;
    TEST_ASSERT_EQUAL(BQ_E_RANGE, bq_app_config_validate(&config, &field));
    TEST_ASSERT_EQUAL_STRING("precharge_ms", field);
    config.precharge_ms = 0;
    TEST_ASSERT_EQUAL(BQ_E_RANGE, bq_app_config_validate(&config, &field));
    TEST_ASSERT_EQUAL_STRING("precharge_ms", field);
    config.precharge_end_ma = 0;
    TEST_ASSERT_EQUAL(BQ_OK, bq_app_config_validate(&config, &field));
    config.precharge_ms = 10000;
    TEST_ASSERT_EQUAL(BQ_OK, bq_app_config_validate(&config, &field));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_path_closes_first_and_opens_after_the_contactor);
    RUN_TEST(test_every_closing_is_precharged);
    RUN_TEST(test_a_request_withdrawn_opens_the_path);
    RUN_TEST(test_a_fault_opens_the_path);
    RUN_TEST(test_a_load_that_does_not_charge_keeps_the_contactor_open);
    RUN_TEST(test_a_current_into_the_pack_counts_too);
    RUN_TEST(test_just_enough_is_charged);
    RUN_TEST(test_an_unknown_current_is_no_charged_load);
    RUN_TEST(test_without_a_limit_the_time_alone_decides);
    RUN_TEST(test_a_path_that_cannot_be_closed_keeps_the_contactor_open);
    RUN_TEST(test_a_path_that_cannot_be_opened_again_is_a_contactor_fault);
    RUN_TEST(test_a_monitor_lost_meanwhile_bounds_the_time_of_the_path);
    RUN_TEST(test_what_is_to_be_precharged_never_closes_without_a_path);
    RUN_TEST(test_without_a_time_the_contactor_closes_directly);
    RUN_TEST(test_configuration_that_is_refused);
    return UNITY_END();
}
