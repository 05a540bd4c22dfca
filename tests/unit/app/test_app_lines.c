/* SPDX-License-Identifier: Apache-2.0 */
/* The contactor line, its feedback contact and the ammeter, healthy and failing. */
#include "fake_board.h"
#include "unity.h"

static fake_board f;
static bq_app_config config;

void setUp(void)
{
    config = fake_config();
    fake_init(&f, UINT32_MAX - 3000000u); /* the clock wraps somewhere in every test */
    TEST_ASSERT_EQUAL(BQ_OK, fake_start(&f, &config, false));
}

void tearDown(void)
{
}

static const bq_app_counters *counters(void)
{
    return bq_app_get_counters(&f.app);
}

static void comes_back(void)
{
    fake_run(&f, 5000);
    TEST_ASSERT_EQUAL(0, bq_app_pack(&f.app)->faults);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, fake_state(&f));
    TEST_ASSERT_TRUE(f.closed);
}

/* ---- contactor ------------------------------------------------------------------------------- */

static void test_a_welded_contactor_is_found_and_blocks_sleep_and_on(void)
{
    fake_on(&f);
    f.welded = true;
    bq_app_request(&f.app, BQ_REQUEST_OFF);
    fake_run(&f, 95);
    TEST_ASSERT_FALSE(fake_active(&f, BQ_FAULT_CONTACTOR));
    fake_run(&f, 10);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CONTACTOR));
    {
        const uint32_t steps = counters()->steps;
        fake_run(&f, 1000);
        TEST_ASSERT_LESS_OR_EQUAL(11, counters()->steps - steps); /* told once, not in every pass */
    }
    TEST_ASSERT_FALSE(f.closed);
    bq_app_request(&f.app, BQ_REQUEST_SLEEP);
    fake_run(&f, 2000);
    TEST_ASSERT_EQUAL(BQ_PACK_FAULT, fake_state(&f));
    TEST_ASSERT_EQUAL(0, f.job[BQ_JOB_SLEEP].begun);
    bq_app_request(&f.app, BQ_REQUEST_ON);
    fake_run(&f, 2000);
    TEST_ASSERT_FALSE(f.closed);
    f.welded = false;
    fake_run(&f, 3000);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CONTACTOR)); /* latched until request off */
    bq_app_request(&f.app, BQ_REQUEST_OFF);
    fake_run(&f, 1300);
    TEST_ASSERT_EQUAL(0, bq_app_pack(&f.app)->faults);
    bq_app_request(&f.app, BQ_REQUEST_ON);
    comes_back();
}

/* Not only the first time, and in the pass after its 100 ms, not a period later. */
static void test_a_contactor_is_found_welded_again_and_again(void)
{
    config.period_ms = 250;
    TEST_ASSERT_EQUAL(BQ_OK, fake_start(&f, &config, false));
    for (uint32_t n = 1; n <= 3u; n++) {
        bq_app_request(&f.app, BQ_REQUEST_ON);
        fake_run(&f, 3000);
        TEST_ASSERT_TRUE(f.closed);
        f.welded = true;
        bq_app_request(&f.app, BQ_REQUEST_OFF);
        fake_run(&f, 102);
        TEST_ASSERT_EQUAL(n, bq_app_pack(&f.app)->fault[BQ_FAULT_CONTACTOR].count);
        f.welded = false;
        fake_run(&f, 2000);
        TEST_ASSERT_EQUAL(0, bq_app_pack(&f.app)->faults);
    }
}

static void test_a_contactor_that_does_not_close_is_found(void)
{
    fake_run(&f, 1000);
    f.stuck_open = true;
    bq_app_request(&f.app, BQ_REQUEST_ON);
    fake_run(&f, 300);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CONTACTOR));
    TEST_ASSERT_FALSE(f.closed);
}

static void test_a_contactor_that_opens_by_itself_is_found(void)
{
    fake_on(&f);
    f.stuck_open = true;
    fake_run(&f, 225); /* noticed at the next pass, told 100 ms later */
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CONTACTOR));
    TEST_ASSERT_FALSE(f.closed);
}

static void test_a_slow_contact_within_its_time_is_no_fault(void)
{
    f.feedback_us = 95000;
    fake_on(&f);
    bq_app_request(&f.app, BQ_REQUEST_OFF);
    fake_run(&f, 1000);
    bq_app_request(&f.app, BQ_REQUEST_ON);
    fake_run(&f, 1000);
    TEST_ASSERT_TRUE(f.closed);
    TEST_ASSERT_EQUAL(0, bq_app_pack(&f.app)->fault[BQ_FAULT_CONTACTOR].count);
}

static void test_a_board_without_feedback_has_no_contactor_fault(void)
{
    f.has_feedback = false;
    fake_on(&f);
    fake_run(&f, 1000);
    TEST_ASSERT_TRUE(f.closed);
    TEST_ASSERT_EQUAL(0, counters()->line_failures);
}

static void test_a_feedback_that_cannot_be_read_opens(void)
{
    fake_on(&f);
    f.feedback_status = BQ_E_BUS;
    fake_run(&f, 225);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CONTACTOR));
    TEST_ASSERT_FALSE(f.closed);
    TEST_ASSERT_GREATER_THAN(0, counters()->line_failures);
}

static void test_a_line_that_cannot_be_written_is_a_contactor_fault_and_tried_again(void)
{
    uint32_t writes;

    f.has_feedback = false;
    fake_on(&f);
    f.line_status = BQ_E_BUS;
    bq_app_request(&f.app, BQ_REQUEST_OFF);
    (void)bq_app_step(&f.app);
    TEST_ASSERT_TRUE(f.closed); /* it did not open */
    writes = f.writes;
    for (int n = 0; n < 300; n++) {
        f.us += 1000;
        (void)bq_app_step(&f.app);
    }
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CONTACTOR));
    TEST_ASSERT_GREATER_THAN(writes, f.writes);
    TEST_ASSERT_EQUAL(f.writes - writes + 1u, counters()->line_failures);
    f.line_status = BQ_OK;
    for (int n = 0; n < 150; n++) {
        f.us += 1000;
        (void)bq_app_step(&f.app);
    }
    TEST_ASSERT_FALSE(f.closed);
    fake_init(&f, 0);
    f.line_status = BQ_E_BUS;
    TEST_ASSERT_EQUAL(BQ_E_BUS, fake_start(&f, &config, false));
}

/* ---- current --------------------------------------------------------------------------------- */

static void test_the_ammeter_reaches_the_sample_with_its_age(void)
{
    const bq_sample *s = bq_app_sample(&f.app);

    TEST_ASSERT_FALSE(s->current_valid);
    fake_init(&f, 0);
    f.ma = -1234;
    f.ammeter_status = BQ_E_STALE; /* no conversion yet */
    TEST_ASSERT_EQUAL(BQ_OK, fake_start(&f, &config, true));
    fake_run(&f, 1000);
    TEST_ASSERT_FALSE(s->current_valid);
    TEST_ASSERT_EQUAL(UINT32_MAX, s->current_age_ms);
    TEST_ASSERT_EQUAL(0, counters()->ammeter_failures);
    f.ammeter_status = BQ_OK;
    fake_run(&f, 1000);
    TEST_ASSERT_TRUE(s->current_valid);
    TEST_ASSERT_EQUAL(-1234, s->current_ma);
    TEST_ASSERT_EQUAL(0, s->current_age_ms);
    f.ammeter_status = BQ_E_STALE;
    f.ma = 99;
    fake_run(&f, 1000);
    TEST_ASSERT_EQUAL(-1234, s->current_ma);
    TEST_ASSERT_INT_WITHIN(100, 1000, s->current_age_ms);
    TEST_ASSERT_EQUAL(0, counters()->ammeter_failures);
    f.ammeter_status = BQ_E_BUS;
    fake_run(&f, 1000);
    TEST_ASSERT_INT_WITHIN(100, 2000, s->current_age_ms);
    TEST_ASSERT_EQUAL(10, counters()->ammeter_failures);
}

static void test_without_an_ammeter_the_current_of_the_monitor_stands(void)
{
    fake_run(&f, 1000);
    TEST_ASSERT_FALSE(bq_app_sample(&f.app)->current_valid);
    TEST_ASSERT_EQUAL(UINT32_MAX, bq_app_sample(&f.app)->current_age_ms);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_welded_contactor_is_found_and_blocks_sleep_and_on);
    RUN_TEST(test_a_contactor_is_found_welded_again_and_again);
    RUN_TEST(test_a_contactor_that_does_not_close_is_found);
    RUN_TEST(test_a_contactor_that_opens_by_itself_is_found);
    RUN_TEST(test_a_slow_contact_within_its_time_is_no_fault);
    RUN_TEST(test_a_board_without_feedback_has_no_contactor_fault);
    RUN_TEST(test_a_feedback_that_cannot_be_read_opens);
    RUN_TEST(test_a_line_that_cannot_be_written_is_a_contactor_fault_and_tried_again);
    RUN_TEST(test_the_ammeter_reaches_the_sample_with_its_age);
    RUN_TEST(test_without_an_ammeter_the_current_of_the_monitor_stands);
    return UNITY_END();
}
