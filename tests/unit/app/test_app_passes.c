/* SPDX-License-Identifier: Apache-2.0 */
/* What one pass does, and the user's wishes besides the request. */
#include "fake_board.h"
#include "unity.h"
#include <string.h>

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

static uint32_t begun(void)
{
    uint32_t sum = 0;

    for (int job = 0; job < FAKE_JOBS; job++) {
        sum += f.job[job].begun;
    }
    return sum;
}

/* Copying, deciding and beginning a job are three passes, so that none of them takes long. */
static void test_a_pass_does_one_thing(void)
{
    bq_app_request(&f.app, BQ_REQUEST_ON);
    for (int pass = 0; pass < 3000; pass++) {
        const uint32_t steps = counters()->steps, jobs = begun();
        f.orders = 0;
        f.order[0] = '\0';
        f.us += bq_app_step(&f.app);
        TEST_ASSERT_LESS_OR_EQUAL(1, (strchr(f.order, 'm') != NULL) + (counters()->steps - steps) +
                                         (begun() - jobs));
    }
    TEST_ASSERT_TRUE(f.closed);
    TEST_ASSERT_GREATER_THAN(100, counters()->steps);
}

/* Passes until the loop has looked at the monitor. */
static void until_it_looks(void)
{
    do {
        f.orders = 0;
        f.order[0] = '\0';
        f.us += 10;
        f.passed_us += 10;
        (void)bq_app_step(&f.app);
    } while (strchr(f.order, 'm') == NULL);
}

/* A scan that ends in the pass of a step that could not wait for it is stepped with next. */
static void test_a_scan_that_ends_behind_a_late_step_gets_its_own(void)
{
    uint32_t steps;

    fake_on(&f);
    while (f.running != BQ_JOB_SCAN) {
        f.us += bq_app_step(&f.app);
    }
    f.job[BQ_JOB_SCAN].takes_us = FAKE_HANG;
    until_it_looks(); /* 1.25 periods after the last step */
    steps = counters()->steps;
    f.job[BQ_JOB_SCAN].takes_us = 3000;
    f.ends_us = f.us;
    (void)bq_app_step(&f.app); /* ends the scan, judges what was there before */
    TEST_ASSERT_EQUAL(steps + 1u, counters()->steps);
    (void)bq_app_step(&f.app);
    (void)bq_app_step(&f.app);
    TEST_ASSERT_EQUAL(steps + 2u, counters()->steps);
    TEST_ASSERT_EQUAL(f.sequence, bq_app_sample(&f.app)->sequence);
}

/* A caller that comes late between the copy and the step: the ages are taken again. */
static void test_a_late_caller_does_not_make_values_younger(void)
{
    fake_on(&f);
    f.job[BQ_JOB_SCAN].takes_us = FAKE_HANG;
    until_it_looks();
    f.us += 2000000; /* between the two */
    f.passed_us += 2000000;
    (void)bq_app_step(&f.app);
    TEST_ASSERT_FALSE(f.closed);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_COMM_LOSS));
}

/* The contactor does not wait for the step when it is no longer wanted. */
static void test_a_request_off_opens_in_the_very_next_pass(void)
{
    fake_on(&f);
    bq_app_request(&f.app, BQ_REQUEST_OFF);
    (void)bq_app_step(&f.app);
    TEST_ASSERT_FALSE(f.closed);
    fake_run(&f, 1000);
    bq_app_request(&f.app, BQ_REQUEST_ON);
    fake_run(&f, 1000);
    TEST_ASSERT_TRUE(f.closed);
    bq_app_request(&f.app, BQ_REQUEST_SLEEP);
    (void)bq_app_step(&f.app);
    TEST_ASSERT_FALSE(f.closed);
}

/* Runs until the self-test of the first way up has ended; the clock stands still in between. */
static void until_tested(void)
{
    while (bq_app_input(&f.app)->self_test == BQ_TEST_NONE) {
        f.us += bq_app_step(&f.app);
    }
}

/* A test that passed is acted on at once: two steps, not two periods. */
static void test_the_way_up_does_not_wait_for_another_scan(void)
{
    uint32_t scans, steps, passed = 0, hint = 0;

    bq_app_request(&f.app, BQ_REQUEST_ON);
    until_tested();
    scans = f.job[BQ_JOB_SCAN].begun;
    steps = counters()->steps;
    while (!f.closed) {
        passed += hint;
        f.us += hint;
        hint = bq_app_step(&f.app);
    }
    TEST_ASSERT_EQUAL(BQ_PACK_ON, fake_state(&f));
    TEST_ASSERT_EQUAL(scans, f.job[BQ_JOB_SCAN].begun);
    TEST_ASSERT_EQUAL(steps + 2u, counters()->steps);
    TEST_ASSERT_LESS_OR_EQUAL(3100, passed); /* what the action takes */
    TEST_ASSERT_EQUAL(0, counters()->late_scans);
    TEST_ASSERT_EQUAL(0, counters()->overruns);
}

/* Nobody asks for the outputs, or the test failed: no step is repeated for ever. */
static void test_the_extra_steps_are_few(void)
{
    uint32_t steps;

    until_tested();
    steps = counters()->steps;
    for (int pass = 0; pass < 20; pass++) {
        (void)bq_app_step(&f.app);
    }
    TEST_ASSERT_EQUAL(BQ_PACK_STANDBY, fake_state(&f));
    TEST_ASSERT_EQUAL(steps + 2u, counters()->steps);

    fake_init(&f, 0);
    f.job[BQ_JOB_SELF_TEST].end = BQ_E_CHAIN_BROKEN;
    TEST_ASSERT_EQUAL(BQ_OK, fake_start(&f, &config, false));
    bq_app_request(&f.app, BQ_REQUEST_ON);
    until_tested();
    steps = counters()->steps;
    for (int pass = 0; pass < 20; pass++) {
        (void)bq_app_step(&f.app);
    }
    TEST_ASSERT_EQUAL(steps, counters()->steps);
    TEST_ASSERT_FALSE(f.closed);
}

/* The two steps judge what there is: a picture that is not complete any more does not become one. */
static void test_the_extra_steps_do_not_close_on_doubt(void)
{
    bq_app_request(&f.app, BQ_REQUEST_ON);
    f.job[BQ_JOB_SELF_TEST].takes_us = 50000;
    while (f.running != BQ_JOB_SELF_TEST) {
        f.us += bq_app_step(&f.app);
    }
    f.faults = BQ_F_CELL_OV; /* seen by the copy that belongs to the step */
    until_tested();
    for (int pass = 0; pass < 20; pass++) {
        f.us += bq_app_step(&f.app) == 0u ? 10u : 0u;
    }
    TEST_ASSERT_FALSE(f.closed);
    TEST_ASSERT_TRUE(fake_state(&f) != BQ_PACK_ON);
}

/* ---- the user's wishes ----------------------------------------------------------------------- */

static void test_balancing_can_be_switched_off_and_on(void)
{
    config.pack.balance_rest_ms = 0;
    config.pack.balance_duty_percent = 100; /* every step, however many there were */
    TEST_ASSERT_EQUAL(BQ_OK, fake_start(&f, &config, true));
    f.mv[2] = 3800;
    fake_on(&f);
    TEST_ASSERT_EQUAL(1, bq_app_pack(&f.app)->summary.balancing);
    TEST_ASSERT_TRUE(bq_mask_get(f.applied.balance, 3));
    TEST_ASSERT_EQUAL(BQ_OK, bq_app_balance(&f.app, false));
    fake_run(&f, 210);
    TEST_ASSERT_TRUE(bq_app_input(&f.app)->balance_off);
    TEST_ASSERT_EQUAL(0, bq_app_pack(&f.app)->summary.balancing);
    TEST_ASSERT_FALSE(bq_mask_get(f.applied.balance, 3));
    fake_run(&f, 5000);
    TEST_ASSERT_EQUAL(0, bq_app_pack(&f.app)->summary.balancing);
    TEST_ASSERT_EQUAL(BQ_OK, bq_app_balance(&f.app, true));
    fake_run(&f, 510);
    TEST_ASSERT_TRUE(bq_mask_get(f.applied.balance, 3));
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_app_balance(NULL, true));
}

static void test_a_self_test_can_be_asked_for_while_outputs_are_off(void)
{
    uint32_t tests;

    TEST_ASSERT_EQUAL(BQ_E_STATE, bq_app_self_test(&f.app)); /* the monitor is not up */
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_app_self_test(NULL));
    fake_run(&f, 1000);
    TEST_ASSERT_EQUAL(BQ_PACK_STANDBY, fake_state(&f));
    tests = f.job[BQ_JOB_SELF_TEST].begun;
    TEST_ASSERT_EQUAL(BQ_OK, bq_app_self_test(&f.app));
    TEST_ASSERT_EQUAL(BQ_TEST_NONE, bq_app_input(&f.app)->self_test);
    fake_run(&f, 400);
    TEST_ASSERT_EQUAL(tests + 1u, f.job[BQ_JOB_SELF_TEST].begun);
    TEST_ASSERT_EQUAL(BQ_TEST_PASSED, bq_app_input(&f.app)->self_test);
    fake_run(&f, 400);
    TEST_ASSERT_EQUAL(BQ_PACK_STANDBY, fake_state(&f));
    f.job[BQ_JOB_SELF_TEST].end = BQ_E_CHAIN_BROKEN;
    TEST_ASSERT_EQUAL(BQ_OK, bq_app_self_test(&f.app));
    fake_run(&f, 400);
    TEST_ASSERT_EQUAL(BQ_TEST_FAILED, bq_app_input(&f.app)->self_test);
    TEST_ASSERT_EQUAL(BQ_E_CHAIN_BROKEN, bq_app_input(&f.app)->self_test_status);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_SELF_TEST));
}

static void test_no_self_test_while_an_output_is_on_or_asleep(void)
{
    fake_on(&f);
    TEST_ASSERT_EQUAL(BQ_E_STATE, bq_app_self_test(&f.app));
    TEST_ASSERT_EQUAL(BQ_TEST_PASSED, bq_app_input(&f.app)->self_test);
    fake_run(&f, 1000);
    TEST_ASSERT_TRUE(f.closed);
    bq_app_request(&f.app, BQ_REQUEST_SLEEP);
    fake_run(&f, 1000);
    TEST_ASSERT_EQUAL(BQ_E_STATE, bq_app_self_test(&f.app));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_pass_does_one_thing);
    RUN_TEST(test_a_scan_that_ends_behind_a_late_step_gets_its_own);
    RUN_TEST(test_a_late_caller_does_not_make_values_younger);
    RUN_TEST(test_a_request_off_opens_in_the_very_next_pass);
    RUN_TEST(test_the_way_up_does_not_wait_for_another_scan);
    RUN_TEST(test_the_extra_steps_are_few);
    RUN_TEST(test_the_extra_steps_do_not_close_on_doubt);
    RUN_TEST(test_balancing_can_be_switched_off_and_on);
    RUN_TEST(test_a_self_test_can_be_asked_for_while_outputs_are_off);
    RUN_TEST(test_no_self_test_while_an_output_is_on_or_asleep);
    return UNITY_END();
}
