/* SPDX-License-Identifier: Apache-2.0 */
/* The healthy loop: order, period, hints, requests, sleep, time, configuration. */
#include "fake_board.h"
#include "unity.h"
#include <string.h>

static fake_board f;
static bq_app_config config;

void setUp(void)
{
    config = fake_config();
    fake_init(&f, 1000);
    TEST_ASSERT_EQUAL(BQ_OK, fake_start(&f, &config, false));
}

void tearDown(void)
{
}

static const bq_app_counters *counters(void)
{
    return bq_app_get_counters(&f.app);
}

static void test_init_opens_the_lines_and_touches_no_monitor(void)
{
    fake_init(&f, 0);
    f.closed = true; /* as a bootloader may have left it */
    TEST_ASSERT_EQUAL(BQ_OK, fake_start(&f, &config, false));
    TEST_ASSERT_EQUAL_STRING("0P", f.order);
    TEST_ASSERT_FALSE(f.closed);
    TEST_ASSERT_FALSE(bq_app_outputs_on(&f.app));
    TEST_ASSERT_EQUAL(BQ_PACK_INIT, fake_state(&f));
    TEST_ASSERT_EQUAL(0, bq_app_sample(&f.app)->cell_count);
    TEST_ASSERT_EQUAL(0, bq_app_step(&f.app)); /* looks at the monitor */
    TEST_ASSERT_EQUAL(0, bq_app_step(&f.app));
    TEST_ASSERT_EQUAL(1, counters()->steps); /* something to show from the second pass on */
}

static void test_the_way_up_and_the_order_inside_a_period(void)
{
    bq_app_request(&f.app, BQ_REQUEST_ON);
    fake_run(&f, 1000);
    /* a step before anything is known, bring-up, scan + step + apply, self-test + two steps, apply, then one
     * round per period */
    TEST_ASSERT_EQUAL_MEMORY("Pmbsmatmma1smasmasma", f.order, 20);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, fake_state(&f));
    TEST_ASSERT_TRUE(bq_app_action(&f.app)->charge_on);
    TEST_ASSERT_EQUAL(FAKE_CELLS, bq_app_sample(&f.app)->cell_count);
    TEST_ASSERT_EQUAL(1, counters()->bring_ups);
    TEST_ASSERT_EQUAL(0, counters()->bring_up_failures);
    TEST_ASSERT_EQUAL(0, counters()->late_scans);
    TEST_ASSERT_EQUAL(0, counters()->overruns);
    TEST_ASSERT_EQUAL(0, counters()->line_failures);
    TEST_ASSERT_EQUAL(0, counters()->sample_failures);
}

static void test_one_scan_step_and_apply_per_period(void)
{
    fake_run(&f, 1000);
    {
        const uint32_t scans = f.job[BQ_JOB_SCAN].begun, applies = f.job[BQ_JOB_APPLY].begun;
        const uint32_t steps = counters()->steps, periods = counters()->periods;
        fake_run(&f, 10000);
        TEST_ASSERT_EQUAL(scans + 100, f.job[BQ_JOB_SCAN].begun);
        TEST_ASSERT_EQUAL(applies + 100, f.job[BQ_JOB_APPLY].begun);
        TEST_ASSERT_EQUAL(steps + 100, counters()->steps);
        TEST_ASSERT_EQUAL(periods + 100, counters()->periods);
        TEST_ASSERT_EQUAL(1, f.job[BQ_JOB_SELF_TEST].begun);
    }
}

static void test_opening_comes_before_the_monitor_and_closing_after_it(void)
{
    fake_on(&f);
    f.orders = 0;
    f.faults = BQ_F_CELL_OV;
    fake_run(&f, 100);
    TEST_ASSERT_EQUAL_STRING("sm0a", f.order);
    TEST_ASSERT_TRUE(f.applied.clear_faults);
    TEST_ASSERT_FALSE(f.applied.discharge_on);
}

static void test_with_separate_paths_the_contactor_needs_both(void)
{
    config.pack.separate_paths = true;
    TEST_ASSERT_EQUAL(BQ_OK, fake_start(&f, &config, false));
    fake_on(&f);
    f.faults = BQ_F_CELL_OV;
    fake_run(&f, 300);
    TEST_ASSERT_TRUE(f.applied.discharge_on);
    TEST_ASSERT_FALSE(f.applied.charge_on);
    TEST_ASSERT_FALSE(f.closed);
}

static void test_request_off_opens_in_the_next_pass_even_during_a_scan(void)
{
    fake_on(&f);
    f.job[BQ_JOB_SCAN].takes_us = FAKE_HANG;
    fake_run(&f, 100); /* a scan hangs */
    TEST_ASSERT_TRUE(f.closed);
    bq_app_request(&f.app, BQ_REQUEST_OFF);
    (void)bq_app_step(&f.app);
    TEST_ASSERT_FALSE(f.closed);
    TEST_ASSERT_FALSE(bq_app_outputs_on(&f.app));
}

static void test_request_changes_follow_each_other(void)
{
    fake_on(&f);
    bq_app_request(&f.app, BQ_REQUEST_OFF);
    fake_run(&f, 200);
    TEST_ASSERT_FALSE(f.closed);
    bq_app_request(&f.app, BQ_REQUEST_ON);
    fake_run(&f, 200);
    TEST_ASSERT_TRUE(f.closed);
    bq_app_request(&f.app, BQ_REQUEST_OFF); /* taken back before a step saw it */
    bq_app_request(&f.app, BQ_REQUEST_ON);
    fake_run(&f, 200);
    TEST_ASSERT_TRUE(f.closed);
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_app_request(&f.app, (bq_pack_request)3));
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_app_request(NULL, BQ_REQUEST_OFF));
    fake_run(&f, 200);
    TEST_ASSERT_TRUE(f.closed);
}

static void test_an_off_that_comes_while_the_on_is_being_applied_wins(void)
{
    fake_run(&f, 1000);
    f.job[BQ_JOB_APPLY].takes_us = 30000;
    bq_app_request(&f.app, BQ_REQUEST_ON);
    for (int pass = 0; pass < 3; pass++) {
        (void)bq_app_step(&f.app); /* looked, decided: on, the monitor works on it */
    }
    TEST_ASSERT_EQUAL(BQ_PACK_ON, fake_state(&f));
    TEST_ASSERT_FALSE(f.closed);
    f.us += 31000;
    f.passed_us += 31000;
    bq_app_request(&f.app, BQ_REQUEST_OFF);
    f.orders = 0;
    f.order[0] = '\0';
    fake_run(&f, 500);
    TEST_ASSERT_NULL(strchr(f.order, '1'));
    TEST_ASSERT_FALSE(f.closed);
}

static void test_the_hint_is_neither_late_nor_a_busy_loop(void)
{
    uint32_t passes = 0;

    fake_on(&f);
    for (uint32_t t = 0; t < 1000000u; passes++) {
        const uint32_t hint = bq_app_step(&f.app);
        TEST_ASSERT_LESS_OR_EQUAL(100000, hint);
        f.us += hint == 0u ? 1u : hint;
        t += hint == 0u ? 1u : hint;
    }
    TEST_ASSERT_LESS_OR_EQUAL(10 * 12, passes); /* ten periods */
    TEST_ASSERT_EQUAL(0, counters()->overruns);
    TEST_ASSERT_EQUAL(0, counters()->late_scans);
}

static void test_a_null_instance_never_asks_to_be_called(void)
{
    TEST_ASSERT_EQUAL(UINT32_MAX, bq_app_step(NULL));
}

/* ---- sleep ----------------------------------------------------------------------------------- */

static void test_sleep_opens_first_and_wake_tests_again(void)
{
    uint32_t scans;

    fake_on(&f);
    f.orders = 0;
    bq_app_request(&f.app, BQ_REQUEST_SLEEP);
    fake_run(&f, 400);
    TEST_ASSERT_EQUAL_MEMORY("0ma", f.order, 3);
    TEST_ASSERT_NOT_NULL(strchr(f.order, 'z'));
    TEST_ASSERT_EQUAL(BQ_PACK_SLEEP, fake_state(&f));
    TEST_ASSERT_EQUAL(1, f.job[BQ_JOB_SLEEP].begun);
    scans = f.job[BQ_JOB_SCAN].begun;
    fake_run(&f, 3600000); /* an hour */
    TEST_ASSERT_EQUAL(scans, f.job[BQ_JOB_SCAN].begun);
    TEST_ASSERT_EQUAL(1, f.job[BQ_JOB_SLEEP].begun);
    TEST_ASSERT_EQUAL(0, bq_app_pack(&f.app)->faults);
    f.orders = 0;
    bq_app_request(&f.app, BQ_REQUEST_ON);
    fake_run(&f, 1000);
    TEST_ASSERT_EQUAL_MEMORY("mwsmat", f.order, 6);
    TEST_ASSERT_TRUE(f.closed);
    TEST_ASSERT_EQUAL(2, f.job[BQ_JOB_SELF_TEST].begun);
    TEST_ASSERT_EQUAL(1, counters()->bring_ups);
}

static void test_a_failed_sleep_is_repeated_from_bring_up(void)
{
    fake_on(&f);
    f.job[BQ_JOB_SLEEP].fail_next = 2;
    f.job[BQ_JOB_SLEEP].fail_status = BQ_E_VERIFY;
    bq_app_request(&f.app, BQ_REQUEST_SLEEP);
    fake_run(&f, 5000);
    TEST_ASSERT_EQUAL(3, f.job[BQ_JOB_SLEEP].begun);
    TEST_ASSERT_EQUAL(3, counters()->bring_ups);
    TEST_ASSERT_EQUAL(BQ_PACK_SLEEP, fake_state(&f));
    TEST_ASSERT_FALSE(f.closed);
}

static void test_a_failed_wake_is_followed_by_bring_up(void)
{
    fake_on(&f);
    bq_app_request(&f.app, BQ_REQUEST_SLEEP);
    fake_run(&f, 1000);
    f.job[BQ_JOB_WAKE].end = BQ_E_TIMEOUT;
    bq_app_request(&f.app, BQ_REQUEST_ON);
    fake_run(&f, 900);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CONFIG));
    TEST_ASSERT_EQUAL(1, f.job[BQ_JOB_WAKE].begun);
    fake_run(&f, 5000);
    TEST_ASSERT_EQUAL(1, f.job[BQ_JOB_WAKE].begun);
    TEST_ASSERT_EQUAL(2, counters()->bring_ups);
    TEST_ASSERT_TRUE(f.closed);
}

/* ---- time ------------------------------------------------------------------------------------ */

static void test_the_wrap_of_the_clock_is_not_noticed(void)
{
    static fake_board g;
    const uint32_t start = UINT32_MAX - 2500000u; /* wraps after 2.5 s */

    fake_init(&g, start);
    TEST_ASSERT_EQUAL(BQ_OK, fake_start(&g, &config, false));
    fake_on(&g);
    fake_on(&f);
    for (int n = 0; n < 100; n++) {
        fake_run(&f, 50);
        fake_run(&g, 50);
        TEST_ASSERT_EQUAL(BQ_PACK_ON, fake_state(&g));
        TEST_ASSERT_EQUAL(bq_app_now_ms(&f.app), bq_app_now_ms(&g.app));
        TEST_ASSERT_EQUAL_MEMORY(counters(), bq_app_get_counters(&g.app), sizeof *counters());
    }
    TEST_ASSERT_TRUE(g.us < start);
    TEST_ASSERT_EQUAL(0, bq_app_get_counters(&g.app)->overruns);
}

static void test_milliseconds_lose_nothing_over_many_wraps(void)
{
    uint64_t total = 0;

    for (int n = 0; n < 20000; n++) { /* steps of 1.000999 s */
        f.us += 1000999u;
        total += 1000999u;
        (void)bq_app_step(&f.app);
        TEST_ASSERT_EQUAL((uint32_t)(total / 1000u), bq_app_now_ms(&f.app));
    }
    TEST_ASSERT_GREATER_THAN(3, total >> 32);
}

static void test_a_loop_that_stood_still_counts_its_lost_periods_and_judges_the_age(void)
{
    fake_on(&f);
    f.us += 2000000;
    f.passed_us += 2000000;
    (void)bq_app_step(&f.app); /* looks */
    (void)bq_app_step(&f.app); /* judges */
    TEST_ASSERT_EQUAL(1, counters()->overruns);
    TEST_ASSERT_FALSE(f.closed);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_COMM_LOSS));
    fake_run(&f, 2000);
    TEST_ASSERT_TRUE(f.closed);
}

/* ---- configuration --------------------------------------------------------------------------- */

#define REFUSED(status, name, change)                                                                        \
    do {                                                                                                     \
        const char *field = NULL;                                                                            \
        config = fake_config();                                                                              \
        change;                                                                                              \
        TEST_ASSERT_EQUAL_MESSAGE(status, bq_app_config_validate(&config, &field), #change);                 \
        TEST_ASSERT_NOT_NULL(field);                                                                         \
        TEST_ASSERT_EQUAL_STRING(name, field);                                                               \
        TEST_ASSERT_EQUAL(status, fake_start(&f, &config, false));                                           \
    } while (0)

static void test_unusable_configurations_are_refused_by_name(void)
{
    REFUSED(BQ_E_RANGE, "period_ms", config.period_ms = 9);
    REFUSED(BQ_E_RANGE, "period_ms", config.period_ms = 10001);
    REFUSED(BQ_E_RANGE, "retry_ms", config.retry_ms = 99);
    REFUSED(BQ_E_RANGE, "retry_ms", config.retry_ms = 60001);
    REFUSED(BQ_E_CONFIG, "comm_timeout_ms", config.period_ms = 251);
    REFUSED(BQ_E_RANGE, "cells", config.pack.cells = 0);
    config = fake_config();
    config.period_ms = 250; /* two periods fit */
    config.retry_ms = 0;
    TEST_ASSERT_EQUAL(BQ_OK, bq_app_config_validate(&config, NULL));
    config.period_ms = 10;
    config.retry_ms = 100;
    TEST_ASSERT_EQUAL(BQ_OK, bq_app_config_validate(&config, NULL));
    config.pack.comm_timeout_ms = 20000;
    config.period_ms = 10000;
    config.retry_ms = 60000;
    TEST_ASSERT_EQUAL(BQ_OK, bq_app_config_validate(&config, NULL));
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_app_config_validate(NULL, NULL));
}

/* proves: PL-CB-14 */
static void test_the_safety_timer_must_outlast_the_loop(void)
{
    /* 1.25 x 2880 = 3600 = 0.9 x 4000: does not exceed */
    REFUSED(BQ_E_CONFIG, "balance_timer_s",
            (config.pack.comm_timeout_ms = 20000, config.period_ms = 2880, config.balance_timer_s = 4));
    config.period_ms = 2879;
    TEST_ASSERT_EQUAL(BQ_OK, bq_app_config_validate(&config, NULL));
    config.period_ms = 10000;
    config.balance_timer_s = 0; /* none */
    TEST_ASSERT_EQUAL(BQ_OK, bq_app_config_validate(&config, NULL));
}

static bq_status nothing(void *ctx)
{
    (void)ctx;
    return BQ_OK;
}

static void test_missing_parts_are_refused(void)
{
    const bq_afe afe = f.app.afe;
    const bq_gpio gpio = f.app.gpio;
    const bq_clock clock = f.app.clock;
    bq_afe_ops ops = *afe.ops;
    const bq_afe holes = {&ops, &f};
    const bq_afe none = {NULL, &f};
    const bq_gpio no_lines = {NULL, &f};
    const bq_clock no_clock = {NULL, &f};
    const bq_ammeter no_meter = {NULL, &f};
    bq_app *a = &f.app;

#define INIT(ap, af, gp, ck, am, nc, nt, nm)                                                                 \
    bq_app_init(ap, &config, af, gp, ck, am, f.cells, nc, f.temps, nt, f.modules, nm)
    TEST_ASSERT_EQUAL(BQ_E_ARG, INIT(NULL, &afe, &gpio, &clock, NULL, 6, 1, 1));
    TEST_ASSERT_EQUAL(BQ_E_ARG, INIT(a, NULL, &gpio, &clock, NULL, 6, 1, 1));
    TEST_ASSERT_EQUAL(BQ_E_ARG, INIT(a, &none, &gpio, &clock, NULL, 6, 1, 1));
    TEST_ASSERT_EQUAL(BQ_E_ARG, INIT(a, &afe, &no_lines, &clock, NULL, 6, 1, 1));
    TEST_ASSERT_EQUAL(BQ_E_ARG, INIT(a, &afe, &gpio, NULL, NULL, 6, 1, 1));
    TEST_ASSERT_EQUAL(BQ_E_ARG, INIT(a, &afe, &gpio, &no_clock, NULL, 6, 1, 1));
    TEST_ASSERT_EQUAL(BQ_E_ARG, INIT(a, &afe, &gpio, &clock, &no_meter, 6, 1, 1));
    TEST_ASSERT_EQUAL(BQ_E_ARG, INIT(a, &afe, &gpio, &clock, NULL, 5, 1, 1));
    TEST_ASSERT_EQUAL(BQ_E_ARG, INIT(a, &afe, &gpio, &clock, NULL, 6, 0, 1));
    TEST_ASSERT_EQUAL(BQ_E_ARG, INIT(a, &afe, &gpio, &clock, NULL, 6, 1, 0));
    TEST_ASSERT_EQUAL(BQ_E_ARG,
                      bq_app_init(a, &config, &afe, &gpio, &clock, NULL, NULL, 6, f.temps, 1, f.modules, 1));
    TEST_ASSERT_EQUAL(BQ_E_ARG,
                      bq_app_init(a, &config, &afe, &gpio, &clock, NULL, f.cells, 6, NULL, 1, f.modules, 1));
    TEST_ASSERT_EQUAL(BQ_E_ARG,
                      bq_app_init(a, &config, &afe, &gpio, &clock, NULL, f.cells, 6, f.temps, 1, NULL, 1));
    ops.wake = NULL;
    TEST_ASSERT_EQUAL(BQ_E_ARG, INIT(a, &holes, &gpio, &clock, NULL, 6, 1, 1));
    ops.wake = nothing;
    TEST_ASSERT_EQUAL(BQ_OK, INIT(a, &holes, &gpio, &clock, NULL, 6, 1, 1));
    TEST_ASSERT_EQUAL(BQ_E_ARG,
                      bq_app_init(a, NULL, &afe, &gpio, &clock, NULL, f.cells, 6, f.temps, 1, f.modules, 1));
#undef INIT
}

static void test_a_board_without_lines_runs(void)
{
    const bq_afe afe = f.app.afe;
    const bq_clock clock = f.app.clock;

    TEST_ASSERT_EQUAL(
        BQ_OK, bq_app_init(&f.app, &config, &afe, NULL, &clock, NULL, f.cells, 6, f.temps, 1, f.modules, 1));
    f.has_contactor = false;
    bq_app_request(&f.app, BQ_REQUEST_ON);
    fake_run(&f, 1000);
    TEST_ASSERT_TRUE(bq_app_outputs_on(&f.app));
    TEST_ASSERT_EQUAL(0, f.writes - 1u); /* the one of setUp */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_init_opens_the_lines_and_touches_no_monitor);
    RUN_TEST(test_the_way_up_and_the_order_inside_a_period);
    RUN_TEST(test_one_scan_step_and_apply_per_period);
    RUN_TEST(test_opening_comes_before_the_monitor_and_closing_after_it);
    RUN_TEST(test_with_separate_paths_the_contactor_needs_both);
    RUN_TEST(test_request_off_opens_in_the_next_pass_even_during_a_scan);
    RUN_TEST(test_request_changes_follow_each_other);
    RUN_TEST(test_an_off_that_comes_while_the_on_is_being_applied_wins);
    RUN_TEST(test_the_hint_is_neither_late_nor_a_busy_loop);
    RUN_TEST(test_a_null_instance_never_asks_to_be_called);
    RUN_TEST(test_sleep_opens_first_and_wake_tests_again);
    RUN_TEST(test_a_failed_sleep_is_repeated_from_bring_up);
    RUN_TEST(test_a_failed_wake_is_followed_by_bring_up);
    RUN_TEST(test_the_wrap_of_the_clock_is_not_noticed);
    RUN_TEST(test_milliseconds_lose_nothing_over_many_wraps);
    RUN_TEST(test_a_loop_that_stood_still_counts_its_lost_periods_and_judges_the_age);
    RUN_TEST(test_unusable_configurations_are_refused_by_name);
    RUN_TEST(test_the_safety_timer_must_outlast_the_loop);
    RUN_TEST(test_missing_parts_are_refused);
    RUN_TEST(test_a_board_without_lines_runs);
    return UNITY_END();
}
