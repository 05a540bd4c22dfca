/* SPDX-License-Identifier: Apache-2.0 */
/* Everything around the super-loop fails in turn: outputs go off in time, the loop goes on, it recovers. */
#include "fake_board.h"
#include "unity.h"
#include <string.h>

#define OFF_MS (500u + 125u) /* comm_timeout_ms + 1.25 x period_ms */

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

/* Lets the present trouble go on: the contactor opens within the stated time from the last good conversion
 * start. */
static void opens_in_time(bq_pack_fault fault)
{
    const uint64_t good_us = f.passed_us - (f.us - f.conversion_us);

    fake_run(&f, 2000);
    TEST_ASSERT_FALSE(f.closed);
    TEST_ASSERT_TRUE_MESSAGE(fake_active(&f, fault), bq_pack_fault_name(fault));
    TEST_ASSERT_GREATER_THAN(good_us + 500000u, f.opened_us); /* and not before the timeout */
    TEST_ASSERT_LESS_OR_EQUAL(good_us + OFF_MS * 1000u + 20u, f.opened_us);
}

static void comes_back(void)
{
    fake_run(&f, 5000);
    TEST_ASSERT_EQUAL(0, bq_app_pack(&f.app)->faults);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, fake_state(&f));
    TEST_ASSERT_TRUE(f.closed);
}

/* ---- scan, sample ------------------------------------------------------------------------------ */

static void test_lost_scans_within_the_timeout_change_nothing(void)
{
    fake_on(&f);
    for (int n = 0; n < 20; n++) {
        f.job[BQ_JOB_SCAN].fail_next = 3;
        f.job[BQ_JOB_SCAN].fail_status = BQ_E_NO_ANSWER;
        fake_run(&f, 400);
        TEST_ASSERT_TRUE(f.closed);
    }
    TEST_ASSERT_EQUAL(60, counters()->scan_failures);
    TEST_ASSERT_EQUAL(1, counters()->bring_ups);
    TEST_ASSERT_EQUAL(3, bq_app_pack(&f.app)->event_count); /* self-test, standby, on and nothing since */
}

static void test_a_scan_that_keeps_failing_opens_and_leads_to_bring_up(void)
{
    fake_on(&f);
    f.job[BQ_JOB_SCAN].end = BQ_E_NO_ANSWER;
    opens_in_time(BQ_FAULT_COMM_LOSS);
    TEST_ASSERT_EQUAL(2, counters()->bring_ups);
    f.job[BQ_JOB_SCAN].end = BQ_OK;
    comes_back();
    TEST_ASSERT_EQUAL(2, f.job[BQ_JOB_SELF_TEST].begun);
}

static void test_a_scan_that_cannot_begin_opens_and_leads_to_bring_up(void)
{
    static const bq_status reasons[] = {BQ_E_BUSY, BQ_E_STATE, BQ_E_BUS};

    for (unsigned i = 0; i < 3; i++) {
        setUp();
        fake_on(&f);
        f.job[BQ_JOB_SCAN].begin = reasons[i];
        opens_in_time(BQ_FAULT_COMM_LOSS);
        TEST_ASSERT_GREATER_THAN(1, counters()->bring_ups);
        TEST_ASSERT_LESS_OR_EQUAL(4, counters()->bring_ups); /* one per retry_ms */
        f.job[BQ_JOB_SCAN].begin = BQ_OK;
        comes_back();
    }
}

static void test_a_scan_that_hangs_for_ever_opens_in_time(void)
{
    fake_on(&f);
    f.job[BQ_JOB_SCAN].takes_us = FAKE_HANG;
    opens_in_time(BQ_FAULT_COMM_LOSS);
    TEST_ASSERT_GREATER_THAN(3, counters()->late_scans);
    f.job[BQ_JOB_SCAN].takes_us = 3000; /* the driver comes round */
    comes_back();
}

static void test_an_action_that_hangs_for_ever_opens_in_time(void)
{
    fake_on(&f);
    f.job[BQ_JOB_APPLY].takes_us = FAKE_HANG;
    fake_run(&f, 100); /* the next one hangs */
    opens_in_time(BQ_FAULT_COMM_LOSS);
    TEST_ASSERT_GREATER_THAN(5, counters()->overruns);
}

static void test_a_picture_that_cannot_be_copied_opens_in_time(void)
{
    fake_on(&f);
    f.sample_status = BQ_E_ARG;
    fake_run(&f, 2000);
    TEST_ASSERT_FALSE(f.closed);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_COMM_LOSS));
    TEST_ASSERT_GREATER_THAN(10, counters()->sample_failures);
    f.sample_status = BQ_OK;
    comes_back();
}

static void test_a_picture_that_stands_still_opens_in_time(void)
{
    fake_on(&f);
    for (unsigned t = 0; t < OFF_MS + 100u;
         t += 5u) { /* the monitor claims every scan is good and its values are new */
        f.sequence = 1000;
        f.conversion_us = f.us;
        fake_run(&f, 5);
        f.sequence = 999;
    }
    TEST_ASSERT_FALSE(f.closed);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_COMM_LOSS));
}

static void test_slow_scans_cost_steps_but_not_the_contactor(void)
{
    static const uint32_t takes_ms[] = {90, 99, 110, 124, 150, 190, 250};

    for (unsigned i = 0; i < sizeof takes_ms / sizeof takes_ms[0]; i++) {
        setUp();
        fake_on(&f);
        f.job[BQ_JOB_SCAN].takes_us = takes_ms[i] * 1000u;
        fake_run(&f, 10000);
        TEST_ASSERT_TRUE(f.closed);
        TEST_ASSERT_EQUAL(0, bq_app_pack(&f.app)->faults);
        TEST_ASSERT_EQUAL(takes_ms[i] > 97, counters()->overruns > 40); /* the action takes 3 ms more */
        TEST_ASSERT_GREATER_OR_EQUAL(79, counters()->steps);            /* at least one per 125 ms */
    }
}

/* The longest pause between two pack steps, whatever the monitor does. */
static void test_the_pack_step_runs_at_least_every_five_quarters_of_a_period(void)
{
    static const uint32_t takes_us[] = {1, 3000, 60000, 99990, 100010, 126000, 333000, FAKE_HANG};

    for (unsigned i = 0; i < sizeof takes_us / sizeof takes_us[0]; i++) {
        uint64_t last_us;
        uint32_t steps;
        setUp();
        fake_on(&f);
        f.job[BQ_JOB_SCAN].takes_us = takes_us[i];
        f.job[BQ_JOB_APPLY].takes_us = takes_us[(i + 3u) % 8u];
        last_us = f.passed_us;
        steps = counters()->steps;
        for (int n = 0; n < 6000; n++) {
            fake_run(&f, 1);
            if (counters()->steps != steps) {
                steps = counters()->steps;
                last_us = f.passed_us;
            }
            TEST_ASSERT_LESS_OR_EQUAL(126000u, f.passed_us - last_us);
        }
    }
}

/* ---- bring-up, self-test ------------------------------------------------------------------------ */

static void test_bring_up_that_fails_is_repeated_with_pauses(void)
{
    f.job[BQ_JOB_START].fail_next = 5;
    f.job[BQ_JOB_START].fail_status = BQ_E_NOT_FOUND;
    bq_app_request(&f.app, BQ_REQUEST_ON);
    for (int n = 0; n < 5; n++) { /* one attempt per second, plus the 3 ms it takes */
        fake_run(&f, 900);
        TEST_ASSERT_EQUAL(n + 1, counters()->bring_ups);
        TEST_ASSERT_EQUAL(BQ_PACK_FAULT, fake_state(&f));
        TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CONFIG));
        TEST_ASSERT_EQUAL(BQ_E_NOT_FOUND, bq_app_pack(&f.app)->fault[BQ_FAULT_CONFIG].value);
        TEST_ASSERT_FALSE(f.closed);
        fake_run(&f, 103);
    }
    TEST_ASSERT_EQUAL(5, counters()->bring_up_failures);
    comes_back();
    TEST_ASSERT_EQUAL(6, counters()->bring_ups);
}

static void test_the_pause_defaults_to_one_second(void)
{
    config.retry_ms = 0;
    TEST_ASSERT_EQUAL(BQ_OK, fake_start(&f, &config, false));
    f.job[BQ_JOB_START].end = BQ_E_NOT_FOUND;
    fake_run(&f, 9500);
    TEST_ASSERT_EQUAL(10, counters()->bring_ups);
}

static void test_bring_up_that_cannot_begin_counts_as_failed(void)
{
    f.job[BQ_JOB_START].begin = BQ_E_BUSY;
    fake_run(&f, 5500);
    TEST_ASSERT_EQUAL(6, counters()->bring_ups);
    TEST_ASSERT_EQUAL(6, counters()->bring_up_failures);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CONFIG));
}

static void test_bring_up_that_hangs_is_reported(void)
{
    f.job[BQ_JOB_START].takes_us = FAKE_HANG;
    fake_run(&f, 9900);
    TEST_ASSERT_EQUAL(BQ_PACK_INIT, fake_state(&f));
    fake_run(&f, 400);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CONFIG));
    TEST_ASSERT_EQUAL(BQ_E_TIMEOUT, bq_app_pack(&f.app)->fault[BQ_FAULT_CONFIG].value);
    f.job[BQ_JOB_START].takes_us = 0; /* and may yet succeed */
    bq_app_request(&f.app, BQ_REQUEST_ON);
    comes_back();
    TEST_ASSERT_EQUAL(1, counters()->bring_ups);
}

static void test_a_failed_self_test_keeps_the_outputs_off_and_is_repeated(void)
{
    f.job[BQ_JOB_SELF_TEST].fail_next = 3;
    f.job[BQ_JOB_SELF_TEST].fail_status = BQ_E_CHAIN_BROKEN;
    bq_app_request(&f.app, BQ_REQUEST_ON);
    fake_run(&f, 2900);
    TEST_ASSERT_EQUAL(3, counters()->self_test_failures);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_SELF_TEST));
    TEST_ASSERT_EQUAL(BQ_E_CHAIN_BROKEN, bq_app_pack(&f.app)->fault[BQ_FAULT_SELF_TEST].value);
    TEST_ASSERT_FALSE(f.closed);
    TEST_ASSERT_EQUAL(1, counters()->bring_ups);
    comes_back();
    TEST_ASSERT_EQUAL(4, f.job[BQ_JOB_SELF_TEST].begun);
}

static void test_the_self_test_waits_for_a_good_scan_after_every_bring_up(void)
{
    fake_on(&f);
    f.job[BQ_JOB_SCAN].end = BQ_E_NO_ANSWER;
    fake_run(&f, 2000);
    TEST_ASSERT_EQUAL(2, counters()->bring_ups);
    TEST_ASSERT_EQUAL(1, f.job[BQ_JOB_SELF_TEST].begun);
    f.job[BQ_JOB_SCAN].end = BQ_OK;
    comes_back();
}

static void test_the_first_scan_follows_bring_up_at_once(void)
{
    fake_run(&f, 50);
    TEST_ASSERT_EQUAL(1, f.job[BQ_JOB_SCAN].begun);
    TEST_ASSERT_LESS_OR_EQUAL(3050, f.job[BQ_JOB_SCAN].begun_us - f.job[BQ_JOB_START].begun_us);
}

static void test_a_self_test_that_hangs_never_reaches_standby(void)
{
    f.job[BQ_JOB_SELF_TEST].takes_us = FAKE_HANG;
    bq_app_request(&f.app, BQ_REQUEST_ON);
    fake_run(&f, 5000);
    TEST_ASSERT_FALSE(f.closed);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_COMM_LOSS)); /* nothing new arrives meanwhile */
}

/* ---- actions --------------------------------------------------------------------------------- */

static void test_the_contactor_does_not_close_before_an_action_succeeded(void)
{
    fake_run(&f, 1000);
    f.job[BQ_JOB_APPLY].end = BQ_E_VERIFY;
    bq_app_request(&f.app, BQ_REQUEST_ON);
    fake_run(&f, 5000);
    TEST_ASSERT_FALSE(f.closed);
    TEST_ASSERT_EQUAL(0, f.opened_us);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CHIP));
    f.job[BQ_JOB_APPLY].end = BQ_OK;
    comes_back();
}

static void test_actions_that_keep_failing_open_the_contactor(void)
{
    static const int at_begin[] = {0, 1};

    for (unsigned i = 0; i < 2; i++) {
        setUp();
        fake_on(&f);
        if (at_begin[i]) {
            f.job[BQ_JOB_APPLY].begin = BQ_E_BUSY;
        } else {
            f.job[BQ_JOB_APPLY].end = BQ_E_VERIFY;
        }
        fake_run(&f, 500);
        TEST_ASSERT_TRUE(f.closed);
        fake_run(&f, 400);
        TEST_ASSERT_FALSE(f.closed);
        TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CHIP));
        TEST_ASSERT_EQUAL(at_begin[i] ? BQ_E_BUSY : BQ_E_VERIFY,
                          bq_app_pack(&f.app)->fault[BQ_FAULT_CHIP].value);
        TEST_ASSERT_GREATER_THAN(5, counters()->apply_failures);
        f.job[BQ_JOB_APPLY].begin = BQ_OK;
        f.job[BQ_JOB_APPLY].end = BQ_OK;
        comes_back();
    }
}

/* ---- limits through the whole loop ----------------------------------------------------------- */

static void test_a_broken_limit_opens_within_the_stated_time_for_every_phase(void)
{
    /* period + scan + debounce + 1.25 x period */
    const uint64_t bound_us = (100u + 3u + 300u + 125u) * 1000u + 50u;

    for (uint32_t phase = 0; phase < 100u; phase += 3u) {
        uint64_t event_us;
        setUp();
        fake_on(&f);
        fake_run(&f, phase);
        f.mv[2] = 4300;
        event_us = f.passed_us;
        fake_run(&f, 1000);
        TEST_ASSERT_FALSE(f.closed);
        TEST_ASSERT_LESS_OR_EQUAL(event_us + bound_us, f.opened_us);
        TEST_ASSERT_EQUAL(3, bq_app_pack(&f.app)->fault[BQ_FAULT_CELL_OV].cell);
        f.mv[2] = 3700;
        comes_back();
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_lost_scans_within_the_timeout_change_nothing);
    RUN_TEST(test_a_scan_that_keeps_failing_opens_and_leads_to_bring_up);
    RUN_TEST(test_a_scan_that_cannot_begin_opens_and_leads_to_bring_up);
    RUN_TEST(test_a_scan_that_hangs_for_ever_opens_in_time);
    RUN_TEST(test_an_action_that_hangs_for_ever_opens_in_time);
    RUN_TEST(test_a_picture_that_cannot_be_copied_opens_in_time);
    RUN_TEST(test_a_picture_that_stands_still_opens_in_time);
    RUN_TEST(test_slow_scans_cost_steps_but_not_the_contactor);
    RUN_TEST(test_the_pack_step_runs_at_least_every_five_quarters_of_a_period);
    RUN_TEST(test_bring_up_that_fails_is_repeated_with_pauses);
    RUN_TEST(test_the_pause_defaults_to_one_second);
    RUN_TEST(test_bring_up_that_cannot_begin_counts_as_failed);
    RUN_TEST(test_bring_up_that_hangs_is_reported);
    RUN_TEST(test_a_failed_self_test_keeps_the_outputs_off_and_is_repeated);
    RUN_TEST(test_the_self_test_waits_for_a_good_scan_after_every_bring_up);
    RUN_TEST(test_the_first_scan_follows_bring_up_at_once);
    RUN_TEST(test_a_self_test_that_hangs_never_reaches_standby);
    RUN_TEST(test_the_contactor_does_not_close_before_an_action_succeeded);
    RUN_TEST(test_actions_that_keep_failing_open_the_contactor);
    RUN_TEST(test_a_broken_limit_opens_within_the_stated_time_for_every_phase);
    return UNITY_END();
}
