/* SPDX-License-Identifier: Apache-2.0 */
/* The balancing scheduler. */
#include "rig.h"
#include "unity.h"

static rig r;
static bq_pack_config config;

void setUp(void)
{
    config = rig_config();
    rig_init(&r, &config);
}

void tearDown(void)
{
}

static void current(int32_t ma)
{
    r.s.current_valid = true;
    r.s.current_age_ms = 0;
    r.s.current_ma = ma;
}

/* At rest for long enough, cells 2 and 9 higher than the rest. */
static void start(void)
{
    rig_init(&r, &config);
    current(0);
    rig_on(&r);
    rig_run(&r, 1100);
    TEST_ASSERT_EQUAL(0, rig_bleeding(&r));
    r.cells[1].mv = 3720;
    r.cells[8].mv = 3740;
}

static void bleeds_2_and_9(void)
{
    TEST_ASSERT_EQUAL(2, rig_bleeding(&r));
    TEST_ASSERT_TRUE(bq_mask_get(r.a.balance, 2) && bq_mask_get(r.a.balance, 9));
    TEST_ASSERT_EQUAL(2, r.p.summary.balancing);
}

static void test_bleeds_the_cells_above_the_lowest(void)
{
    start();
    rig_scan(&r);
    bleeds_2_and_9();
    TEST_ASSERT_TRUE(r.a.charge_on); /* the pack stays on */
    r.in.request = BQ_REQUEST_OFF;
    rig_scan(&r);
    bleeds_2_and_9(); /* standby too */
}

static void test_starts_at_the_start_spread_and_not_below(void)
{
    start();
    r.cells[1].mv = 3700;
    r.cells[8].mv = 3719;
    rig_run(&r, 500);
    TEST_ASSERT_EQUAL(0, rig_bleeding(&r));
    r.cells[8].mv = 3720;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(1, rig_bleeding(&r));
}

static void test_goes_on_down_to_the_stop_spread_then_needs_the_start_spread(void)
{
    start();
    rig_scan(&r);
    r.cells[1].mv = 3705; /* exactly stop: not bled */
    r.cells[8].mv = 3706;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(1, rig_bleeding(&r));
    TEST_ASSERT_TRUE(bq_mask_get(r.a.balance, 9));
    r.cells[8].mv = 3705;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(0, rig_bleeding(&r));
    r.cells[8].mv = 3719;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(0, rig_bleeding(&r));
}

static void test_never_bleeds_a_cell_below_the_minimum(void)
{
    start();
    rig_all_cells(&r, 3370);
    r.cells[1].mv = 3399;
    r.cells[8].mv = 3400;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(1, rig_bleeding(&r));
    TEST_ASSERT_TRUE(bq_mask_get(r.a.balance, 9));
}

static void test_never_bleeds_above_the_temperature_limit(void)
{
    start();
    r.temps[3].dc = 450;
    rig_scan(&r);
    bleeds_2_and_9();
    r.temps[3].dc = 451;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(0, rig_bleeding(&r));
}

static void test_rest_must_have_lasted(void)
{
    current(0);
    r.cells[1].mv = 3720;
    r.cells[8].mv = 3740;
    current(-1000);
    rig_on(&r);
    current(-200); /* at the limit of rest */
    rig_scan(&r);
    rig_run(&r, 900);
    TEST_ASSERT_EQUAL(0, rig_bleeding(&r));
    rig_scan(&r);
    bleeds_2_and_9();
    current(-201);
    rig_scan(&r);
    TEST_ASSERT_EQUAL(0, rig_bleeding(&r));
    current(200);
    rig_run(&r, 1000); /* the time begins again */
    TEST_ASSERT_EQUAL(0, rig_bleeding(&r));
    rig_scan(&r);
    bleeds_2_and_9();
}

static void test_charging_needs_no_rest(void)
{
    r.cells[1].mv = 3720;
    r.cells[8].mv = 3740;
    current(201);
    rig_on(&r);
    bleeds_2_and_9();
}

static void test_an_old_current_is_no_rest(void)
{
    start();
    r.s.current_age_ms = config.comm_timeout_ms;
    rig_scan(&r);
    bleeds_2_and_9();
    r.s.current_age_ms = config.comm_timeout_ms + 1u;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(0, rig_bleeding(&r));
}

static void test_without_any_ammeter_rest_is_outputs_off(void)
{
    r.cells[1].mv = 3720;
    r.cells[8].mv = 3740;
    rig_standby(&r);
    rig_run(&r, 1100);
    bleeds_2_and_9();
    r.in.contactor_mismatch_ms = 1; /* a contact that may be closed */
    rig_scan(&r);
    TEST_ASSERT_EQUAL(0, rig_bleeding(&r));
    r.in.contactor_mismatch_ms = 0;
    rig_run(&r, 1100);
    bleeds_2_and_9();
    r.in.request = BQ_REQUEST_ON;
    rig_run(&r, 5000);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, r.p.state);
    TEST_ASSERT_EQUAL(0, rig_bleeding(&r));
}

static void test_duty_is_kept_over_any_hundred_steps(void)
{
    static const uint8_t duties[] = {1, 10, 33, 50, 90, 99, 100};

    for (unsigned i = 0; i < sizeof duties; i++) {
        int on = 0;
        config.balance_duty_percent = duties[i];
        start();
        for (int n = 0; n < 1000; n++) {
            rig_scan(&r);
            on += rig_bleeding(&r) != 0 ? 1 : 0;
        }
        TEST_ASSERT_EQUAL(10 * duties[i], on);
    }
}

static void test_the_highest_cells_of_a_module_come_first(void)
{
    config.balance_max_per_module = 2;
    start();
    r.cells[0].mv = 3730; /* module 1: 3730 3750 3740 3750 3700 3700 */
    r.cells[1].mv = 3750;
    r.cells[2].mv = 3740;
    r.cells[3].mv = 3750;
    r.cells[8].mv = 3740; /* module 2: equal ones, the lower numbers win */
    r.cells[9].mv = 3740;
    r.cells[10].mv = 3740;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(4, rig_bleeding(&r));
    TEST_ASSERT_TRUE(bq_mask_get(r.a.balance, 2) && bq_mask_get(r.a.balance, 4));
    TEST_ASSERT_TRUE(bq_mask_get(r.a.balance, 9) && bq_mask_get(r.a.balance, 10));
}

static void test_the_limit_per_module_is_no_quota(void)
{
    config.balance_max_per_module = 5;
    start();
    rig_scan(&r);
    bleeds_2_and_9();
}

static void test_a_start_spread_of_zero_never_balances(void)
{
    config.balance_start_mv = 0;
    start();
    r.cells[8].mv = 4000;
    rig_run(&r, 2000);
    TEST_ASSERT_EQUAL(0, rig_bleeding(&r));
}

static void stops_at_once(void)
{
    TEST_ASSERT_EQUAL(0, rig_bleeding(&r));
    TEST_ASSERT_EQUAL(0, r.p.summary.balancing);
}

/* proves: PL-SEQ-10-01, PL-SEQ-10-07 */
static void test_stops_at_once_for_every_doubt(void)
{
    static const uint16_t flags[] = {BQ_F_CELL_OV, BQ_F_CELL_UV,  BQ_F_OVERTEMP, BQ_F_DIE_TEMP,
                                     BQ_F_SUPPLY,  BQ_F_RESET,    BQ_F_MEMORY,   BQ_F_COMM,
                                     BQ_F_LOCKUP,  BQ_F_OPEN_WIRE};

    for (unsigned i = 0; i < sizeof flags / sizeof flags[0]; i++) {
        start();
        rig_scan(&r);
        bleeds_2_and_9();
        r.modules[0].faults = flags[i];
        rig_scan(&r);
        stops_at_once();
    }
    start();
    rig_scan(&r);
    r.cells[5].quality = BQ_Q_RANGE; /* a voltage that is not valid */
    rig_scan(&r);
    stops_at_once();
    start();
    rig_scan(&r);
    r.temps[0].quality = BQ_Q_SENSOR;
    rig_scan(&r);
    stops_at_once();
    start();
    rig_scan(&r);
    rig_idle(&r, config.comm_timeout_ms); /* voltages that are not fresh */
    stops_at_once();
    start();
    rig_scan(&r);
    r.cells[0].mv = 4300; /* a limit being broken, debounce time not over */
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, r.p.state);
    stops_at_once();
    start();
    rig_scan(&r);
    r.in.monitor = BQ_MONITOR_DOWN;
    rig_scan(&r);
    stops_at_once();
    start();
    r.in.request = BQ_REQUEST_OFF;
    rig_scan(&r);
    bleeds_2_and_9();
    r.in.request = BQ_REQUEST_SLEEP;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_SLEEP, r.p.state);
    stops_at_once();
}

static void test_a_lost_scan_only_pauses(void)
{
    start();
    rig_scan(&r);
    r.cells[1].mv = 3710; /* below the start spread by now */
    r.cells[8].mv = 3710;
    rig_lose(&r, 0);
    rig_scan(&r);
    stops_at_once();
    rig_find(&r, 0);
    rig_scan(&r);
    bleeds_2_and_9();
}

static void test_a_fault_makes_it_start_anew(void)
{
    start();
    rig_scan(&r);
    r.cells[1].mv = 3710;
    r.cells[8].mv = 3710;
    r.modules[0].faults = BQ_F_MEMORY;
    rig_scan(&r);
    r.modules[0].faults = 0;
    rig_run(&r, 3000);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, r.p.state);
    TEST_ASSERT_EQUAL(0, rig_bleeding(&r));
}

/* The state of charge takes the mean cell voltage at rest and the current of the sample. */
static void test_the_state_of_charge_comes_with_the_step(void)
{
    static const bq_ocv_point curve[] = {{0, 3000}, {1000, 4000}};

    config.soc = (bq_soc_config){curve, 2, 1000, 100, 500, 1000};
    rig_init(&r, &config);
    TEST_ASSERT_EQUAL(-1, r.p.summary.soc_permille);
    current(-50);
    rig_all_cells(&r, 3400);
    for (int i = 0; i < 6; i++) {
        r.cells[i].mv = 3600;
    }
    rig_on(&r);
    rig_run(&r, 1000);
    TEST_ASSERT_EQUAL(500, r.p.summary.soc_permille);
    current(36000); /* 10 s = 0.1 Ah of 1 Ah */
    rig_idle(&r, 0);
    rig_run(&r, 10000);
    TEST_ASSERT_EQUAL(600, r.p.summary.soc_permille);
    r.s.current_age_ms = config.comm_timeout_ms + 1u; /* no longer known */
    rig_run(&r, 1100);
    TEST_ASSERT_EQUAL(-1, r.p.summary.soc_permille);
    current(0);
    r.cells[3].quality = BQ_Q_RANGE; /* no start value from an incomplete picture */
    rig_run(&r, 2000);
    TEST_ASSERT_EQUAL(-1, r.p.summary.soc_permille);
    r.cells[3].quality = BQ_Q_VALID;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(500, r.p.summary.soc_permille);
}

static void test_works_without_sensors(void)
{
    config.sensors = 0;
    rig_init(&r, &config);
    r.s.temp_count = 0;
    current(0);
    rig_on(&r);
    r.cells[1].mv = 3720;
    r.cells[8].mv = 3740;
    rig_run(&r, 1200);
    bleeds_2_and_9();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_bleeds_the_cells_above_the_lowest);
    RUN_TEST(test_starts_at_the_start_spread_and_not_below);
    RUN_TEST(test_goes_on_down_to_the_stop_spread_then_needs_the_start_spread);
    RUN_TEST(test_never_bleeds_a_cell_below_the_minimum);
    RUN_TEST(test_never_bleeds_above_the_temperature_limit);
    RUN_TEST(test_rest_must_have_lasted);
    RUN_TEST(test_charging_needs_no_rest);
    RUN_TEST(test_an_old_current_is_no_rest);
    RUN_TEST(test_without_any_ammeter_rest_is_outputs_off);
    RUN_TEST(test_duty_is_kept_over_any_hundred_steps);
    RUN_TEST(test_the_highest_cells_of_a_module_come_first);
    RUN_TEST(test_the_limit_per_module_is_no_quota);
    RUN_TEST(test_a_start_spread_of_zero_never_balances);
    RUN_TEST(test_stops_at_once_for_every_doubt);
    RUN_TEST(test_a_lost_scan_only_pauses);
    RUN_TEST(test_a_fault_makes_it_start_anew);
    RUN_TEST(test_the_state_of_charge_comes_with_the_step);
    RUN_TEST(test_works_without_sensors);
    return UNITY_END();
}
