/* SPDX-License-Identifier: Apache-2.0 */
/* Limits of the measured current: edges, debounce, what they stop, recovery, and a current that nobody knows. */
#include "rig.h"
#include "unity.h"

static rig r;
static bq_pack_config config;

static void current(int32_t ma)
{
    r.s.current_valid = true;
    r.s.current_age_ms = 0;
    r.s.current_ma = ma;
}

static void start(bool separate_paths)
{
    config = rig_config();
    config.charge_max_ma = 10000;
    config.discharge_max_ma = 40000;
    config.separate_paths = separate_paths;
    rig_init(&r, &config);
    current(0);
    rig_on(&r);
}

void setUp(void)
{
    start(false);
}

void tearDown(void)
{
}

/* proves: X0-FET-18 */
static void test_a_current_up_to_its_limit_is_allowed(void)
{
    current(10000);
    rig_run(&r, 2000);
    TEST_ASSERT_EQUAL(0, r.p.faults);
    current(-40000);
    rig_run(&r, 2000);
    TEST_ASSERT_EQUAL(0, r.p.faults);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, r.p.state);
}

/* proves: X0-FET-18 */
static void test_charge_overcurrent_opens_after_the_debounce_time(void)
{
    current(10001);
    rig_run(&r, 300); /* the first step sees it, debounce is 300 ms */
    TEST_ASSERT_EQUAL(0, r.p.faults);
    rig_scan(&r);
    TEST_ASSERT_TRUE(rig_active(&r, BQ_FAULT_CHARGE_CURRENT));
    TEST_ASSERT_FALSE(r.a.charge_on || r.a.discharge_on);
    TEST_ASSERT_EQUAL(10001, r.p.fault[BQ_FAULT_CHARGE_CURRENT].value);
}

static void test_discharge_overcurrent_opens_after_the_debounce_time(void)
{
    current(-40001);
    rig_run(&r, 300);
    TEST_ASSERT_EQUAL(0, r.p.faults);
    rig_scan(&r);
    TEST_ASSERT_TRUE(rig_active(&r, BQ_FAULT_OVERCURRENT));
    TEST_ASSERT_FALSE(r.a.charge_on || r.a.discharge_on);
    TEST_ASSERT_EQUAL(-40001, r.p.fault[BQ_FAULT_OVERCURRENT].value);
}

static void test_a_short_peak_is_no_fault(void)
{
    for (int i = 0; i < 20; i++) {
        current(-60000);
        rig_run(&r, 200);
        current(0);
        rig_scan(&r);
    }
    TEST_ASSERT_EQUAL(0, r.p.faults);
}

static void test_the_monitor_is_not_debounced_even_while_the_limit_is(void)
{
    current(-40001);
    r.modules[1].faults = BQ_F_OVERCURRENT;
    rig_scan(&r);
    TEST_ASSERT_TRUE(rig_active(&r, BQ_FAULT_OVERCURRENT));
    TEST_ASSERT_EQUAL(2, r.p.fault[BQ_FAULT_OVERCURRENT].device);
}

/* A charger that pushed too much does so again: it takes a person, or whoever asks, to try. */
static void test_charge_overcurrent_waits_for_request_off(void)
{
    current(20000);
    rig_run(&r, 400);
    current(0);
    rig_run(&r, 10000);
    TEST_ASSERT_TRUE(rig_active(&r, BQ_FAULT_CHARGE_CURRENT));
    TEST_ASSERT_EQUAL(BQ_HOLD_REQUEST, r.p.fault[BQ_FAULT_CHARGE_CURRENT].hold);
    r.in.request = BQ_REQUEST_OFF;
    rig_run(&r, 1100);
    TEST_ASSERT_EQUAL(0, r.p.faults);
}

static void test_discharge_overcurrent_recovers_when_the_current_is_gone(void)
{
    current(-50000);
    rig_run(&r, 400);
    TEST_ASSERT_EQUAL(BQ_PACK_FAULT, r.p.state);
    current(0);
    rig_run(&r, 1000);
    TEST_ASSERT_TRUE(rig_active(&r, BQ_FAULT_OVERCURRENT));
    rig_run(&r, 400);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, r.p.state);
}

static void test_with_separate_paths_discharging_goes_on(void)
{
    start(true);
    current(10001);
    rig_run(&r, 400);
    TEST_ASSERT_FALSE(r.a.charge_on);
    TEST_ASSERT_TRUE(r.a.discharge_on);
}

static void test_an_unknown_current_opens_where_it_is_limited(void)
{
    r.s.current_valid = false;
    rig_scan(&r);
    TEST_ASSERT_TRUE(rig_active(&r, BQ_FAULT_SENSOR));
    TEST_ASSERT_FALSE(r.a.charge_on || r.a.discharge_on);
}

static void test_an_old_current_is_unknown(void)
{
    r.s.current_age_ms = 500;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(0, r.p.faults);
    r.s.current_age_ms = 501; /* comm_timeout_ms is 500 */
    rig_scan(&r);
    TEST_ASSERT_TRUE(rig_active(&r, BQ_FAULT_SENSOR));
}

static void test_nothing_goes_on_before_the_current_is_known(void)
{
    rig_init(&r, &config);
    r.in.monitor = BQ_MONITOR_UP;
    r.in.self_test = BQ_TEST_PASSED;
    r.in.request = BQ_REQUEST_ON;
    rig_run(&r, 3000);
    TEST_ASSERT_FALSE(r.a.charge_on || r.a.discharge_on);
    current(0);
    rig_run(&r, 3000);
    TEST_ASSERT_TRUE(r.a.charge_on && r.a.discharge_on);
}

static void test_without_limits_the_current_decides_nothing(void)
{
    config.charge_max_ma = 0;
    config.discharge_max_ma = 0;
    rig_init(&r, &config);
    rig_on(&r);
    current(1000000);
    rig_run(&r, 2000);
    current(-1000000);
    rig_run(&r, 2000);
    r.s.current_valid = false;
    rig_run(&r, 2000);
    TEST_ASSERT_EQUAL(0, r.p.faults);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_current_up_to_its_limit_is_allowed);
    RUN_TEST(test_charge_overcurrent_opens_after_the_debounce_time);
    RUN_TEST(test_discharge_overcurrent_opens_after_the_debounce_time);
    RUN_TEST(test_a_short_peak_is_no_fault);
    RUN_TEST(test_the_monitor_is_not_debounced_even_while_the_limit_is);
    RUN_TEST(test_charge_overcurrent_waits_for_request_off);
    RUN_TEST(test_discharge_overcurrent_recovers_when_the_current_is_gone);
    RUN_TEST(test_with_separate_paths_discharging_goes_on);
    RUN_TEST(test_an_unknown_current_opens_where_it_is_limited);
    RUN_TEST(test_an_old_current_is_unknown);
    RUN_TEST(test_nothing_goes_on_before_the_current_is_known);
    RUN_TEST(test_without_limits_the_current_decides_nothing);
    return UNITY_END();
}
