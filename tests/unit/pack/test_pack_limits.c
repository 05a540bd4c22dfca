/* SPDX-License-Identifier: Apache-2.0 */
/* The five software limits: edges, debounce, hysteresis, recovery. */
#include "rig.h"
#include "unity.h"
#include <stdbool.h>

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

/* One limit: a value exactly at the trip limit, one step beyond, exactly at the release limit, one step
 * inside. */
typedef struct limit {
    bq_pack_fault fault;
    int at_trip, beyond, at_clear, inside;
    bool stops_charge, stops_discharge; /* with separate paths */
} limit;

static const limit limits[] = {
    {BQ_FAULT_CELL_OV, 4200, 4201, 4100, 4099, true, false},
    {BQ_FAULT_CELL_UV, 3000, 2999, 3200, 3201, false, true},
    {BQ_FAULT_OVERTEMP, 600, 601, 550, 549, true, true},
    {BQ_FAULT_UNDERTEMP, 0, -1, 50, 51, true, false},
    {BQ_FAULT_IMBALANCE, 300, 301, 200, 199, true, true},
};

#define LIMITS (sizeof limits / sizeof limits[0])

/* Cell 9 and sensor 3 (both of device 2) carry the value; an imbalance is cell 9 lying that much below the
 * rest. */
static void put(const limit *l, int value)
{
    switch (l->fault) {
    case BQ_FAULT_CELL_OV:
    case BQ_FAULT_CELL_UV:
        r.cells[8].mv = (uint16_t)value;
        break;
    case BQ_FAULT_IMBALANCE:
        r.cells[8].mv = (uint16_t)(3700 - value);
        break;
    default:
        r.temps[2].dc = (int16_t)value;
        break;
    }
}

static void start(const limit *l)
{
    if (l->fault == BQ_FAULT_IMBALANCE) {
        config.imbalance_mv = 300;
        config.imbalance_clear_mv = 200;
    }
    rig_init(&r, &config);
    rig_on(&r);
}

static void trips(const limit *l)
{
    put(l, l->beyond);
    rig_run(&r, config.debounce_ms + RIG_PERIOD);
    TEST_ASSERT_EQUAL_MESSAGE(1u << l->fault, r.p.faults, bq_pack_fault_name(l->fault));
    TEST_ASSERT_EQUAL(BQ_PACK_FAULT, r.p.state);
    TEST_ASSERT_FALSE(r.a.charge_on);
    TEST_ASSERT_FALSE(r.a.discharge_on);
}

static void test_a_value_at_the_limit_never_trips(void)
{
    for (unsigned i = 0; i < LIMITS; i++) {
        start(&limits[i]);
        put(&limits[i], limits[i].at_trip);
        rig_run(&r, 5000);
        TEST_ASSERT_EQUAL_MESSAGE(0, r.p.faults, bq_pack_fault_name(limits[i].fault));
        TEST_ASSERT_EQUAL(BQ_PACK_ON, r.p.state);
    }
}

static void test_a_value_beyond_trips_exactly_after_the_debounce_time(void)
{
    for (unsigned i = 0; i < LIMITS; i++) {
        const char *name = bq_pack_fault_name(limits[i].fault);
        start(&limits[i]);
        put(&limits[i], limits[i].beyond);
        rig_scan(&r); /* first sight: debounce begins */
        rig_run(&r, config.debounce_ms - RIG_PERIOD);
        TEST_ASSERT_EQUAL_MESSAGE(BQ_PACK_ON, r.p.state, name);
        TEST_ASSERT_EQUAL(1u << limits[i].fault, r.p.pending);
        TEST_ASSERT_TRUE(r.a.charge_on && r.a.discharge_on);
        rig_scan(&r);
        TEST_ASSERT_EQUAL_MESSAGE(BQ_PACK_FAULT, r.p.state, name);
        TEST_ASSERT_FALSE(r.a.charge_on);
        TEST_ASSERT_FALSE(r.a.discharge_on);
        TEST_ASSERT_EQUAL(r.now_ms, r.p.fault[limits[i].fault].trip_ms);
    }
}

static void test_one_good_sample_restarts_the_debounce_time(void)
{
    for (unsigned i = 0; i < LIMITS; i++) {
        start(&limits[i]);
        for (int n = 0; n < 20; n++) {
            put(&limits[i], limits[i].beyond);
            rig_run(&r, config.debounce_ms);
            put(&limits[i], limits[i].at_trip);
            rig_scan(&r);
        }
        TEST_ASSERT_EQUAL_MESSAGE(0, r.p.faults, bq_pack_fault_name(limits[i].fault));
    }
}

static void test_debounce_zero_trips_in_the_step_that_sees_it(void)
{
    config.debounce_ms = 0;
    for (unsigned i = 0; i < LIMITS; i++) {
        start(&limits[i]);
        put(&limits[i], limits[i].beyond);
        rig_scan(&r);
        TEST_ASSERT_EQUAL_MESSAGE(BQ_PACK_FAULT, r.p.state, bq_pack_fault_name(limits[i].fault));
        TEST_ASSERT_FALSE(r.a.discharge_on);
    }
}

static void test_the_record_names_place_value_and_times(void)
{
    for (unsigned i = 0; i < LIMITS; i++) {
        const bq_pack_fault f = limits[i].fault;
        const bq_pack_fault_record *rec = &r.p.fault[f];
        start(&limits[i]);
        TEST_ASSERT_EQUAL(0, rec->count);
        trips(&limits[i]);
        TEST_ASSERT_EQUAL(1, rec->count);
        TEST_ASSERT_TRUE(rec->active);
        TEST_ASSERT_EQUAL(limits[i].beyond, rec->value);
        TEST_ASSERT_EQUAL(2, rec->device);
        TEST_ASSERT_EQUAL(-1, rec->wire);
        TEST_ASSERT_EQUAL(f == BQ_FAULT_OVERTEMP || f == BQ_FAULT_UNDERTEMP ? 0 : 9, rec->cell);
        TEST_ASSERT_EQUAL(f == BQ_FAULT_OVERTEMP || f == BQ_FAULT_UNDERTEMP ? 3 : 0, rec->sensor);
        TEST_ASSERT_EQUAL(r.now_ms, rec->first_ms);
        TEST_ASSERT_EQUAL(r.now_ms, rec->last_ms);
        rig_scan(&r);
        TEST_ASSERT_EQUAL(r.now_ms - RIG_PERIOD, rec->first_ms);
        TEST_ASSERT_EQUAL(r.now_ms - RIG_PERIOD, rec->trip_ms);
        TEST_ASSERT_EQUAL(r.now_ms, rec->last_ms);
        TEST_ASSERT_EQUAL(f, bq_pack_cause(&r.p));
    }
}

static void test_hysteresis_holds_and_says_so(void)
{
    for (unsigned i = 0; i < LIMITS; i++) {
        const bq_pack_fault_record *rec = &r.p.fault[limits[i].fault];
        start(&limits[i]);
        trips(&limits[i]);
        TEST_ASSERT_EQUAL(BQ_HOLD_CONDITION, rec->hold);
        put(&limits[i], limits[i].at_trip);
        rig_run(&r, 5000);
        TEST_ASSERT_EQUAL_MESSAGE(BQ_HOLD_HYSTERESIS, rec->hold, bq_pack_fault_name(limits[i].fault));
        put(&limits[i], limits[i].at_clear);
        rig_run(&r, 5000);
        TEST_ASSERT_TRUE(rec->active);
        TEST_ASSERT_EQUAL(BQ_HOLD_HYSTERESIS, rec->hold);
        TEST_ASSERT_FALSE(r.a.charge_on || r.a.discharge_on);
    }
}

static void test_recovery_takes_exactly_the_recovery_time(void)
{
    for (unsigned i = 0; i < LIMITS; i++) {
        const bq_pack_fault_record *rec = &r.p.fault[limits[i].fault];
        start(&limits[i]);
        trips(&limits[i]);
        put(&limits[i], limits[i].inside);
        rig_scan(&r); /* recovery begins */
        rig_run(&r, config.recover_ms - RIG_PERIOD);
        TEST_ASSERT_TRUE(rec->active);
        TEST_ASSERT_EQUAL_MESSAGE(BQ_HOLD_TIME, rec->hold, bq_pack_fault_name(limits[i].fault));
        rig_scan(&r);
        TEST_ASSERT_FALSE(rec->active);
        TEST_ASSERT_EQUAL(BQ_HOLD_NONE, rec->hold);
        TEST_ASSERT_EQUAL(0, r.p.faults);
        TEST_ASSERT_EQUAL(BQ_PACK_STANDBY, r.p.state);
        TEST_ASSERT_FALSE(r.a.charge_on);
        rig_scan(&r); /* the request is still there */
        TEST_ASSERT_EQUAL(BQ_PACK_ON, r.p.state);
        TEST_ASSERT_EQUAL(1, rec->count);
    }
}

static void test_a_relapse_restarts_the_recovery_time(void)
{
    for (unsigned i = 0; i < LIMITS; i++) {
        start(&limits[i]);
        trips(&limits[i]);
        for (int n = 0; n < 5; n++) {
            put(&limits[i], limits[i].inside);
            rig_run(&r, config.recover_ms);
            put(&limits[i], limits[i].at_clear);
            rig_scan(&r);
        }
        TEST_ASSERT_TRUE(rig_active(&r, limits[i].fault));
        TEST_ASSERT_EQUAL(1, r.p.fault[limits[i].fault].count);
    }
}

static void test_recovery_waits_for_a_complete_picture(void)
{
    for (unsigned i = 0; i < LIMITS; i++) {
        const bq_pack_fault_record *rec = &r.p.fault[limits[i].fault];
        start(&limits[i]);
        trips(&limits[i]);
        put(&limits[i], limits[i].inside);
        rig_run(&r, config.recover_ms / 2);
        rig_lose(&r, 0); /* one scan lost in between: not a fault, but the time begins again */
        rig_scan(&r);
        TEST_ASSERT_EQUAL_MESSAGE(BQ_HOLD_UNKNOWN, rec->hold, bq_pack_fault_name(limits[i].fault));
        rig_find(&r, 0);
        rig_run(&r, config.recover_ms);
        TEST_ASSERT_TRUE(rec->active);
        rig_scan(&r);
        TEST_ASSERT_FALSE(rec->active);
    }
}

static void test_recovery_needs_a_new_picture(void)
{
    config.comm_timeout_ms = 5000;
    for (unsigned i = 0; i < LIMITS; i++) {
        start(&limits[i]);
        trips(&limits[i]);
        put(&limits[i], limits[i].inside);
        rig_scan(&r);
        for (int n = 0; n < 40; n++) {
            rig_idle(&r, 100);
        }
        TEST_ASSERT_EQUAL_MESSAGE(1u << limits[i].fault, r.p.faults, bq_pack_fault_name(limits[i].fault));
        rig_scan(&r);
        TEST_ASSERT_EQUAL(0, r.p.faults);
    }
}

static void test_the_value_stands_while_its_module_is_lost_every_second_scan(void)
{
    for (unsigned i = 0; i < LIMITS; i++) {
        start(&limits[i]);
        put(&limits[i], limits[i].beyond);
        rig_scan(&r);
        rig_lose(&r, 1);
        rig_scan(&r);
        rig_find(&r, 1);
        rig_scan(&r);
        rig_lose(&r, 1);
        rig_scan(&r); /* 300 ms after first sight */
        TEST_ASSERT_EQUAL_MESSAGE(1u << limits[i].fault, r.p.faults, bq_pack_fault_name(limits[i].fault));
        TEST_ASSERT_FALSE(r.a.charge_on || r.a.discharge_on);
    }
}

static void test_debounce_goes_on_without_new_pictures(void)
{
    for (unsigned i = 0; i < LIMITS; i++) {
        start(&limits[i]);
        put(&limits[i], limits[i].beyond);
        rig_scan(&r);
        rig_idle(&r, 299);
        TEST_ASSERT_EQUAL(0, r.p.faults);
        rig_idle(&r, 1);
        TEST_ASSERT_EQUAL_MESSAGE(1u << limits[i].fault, r.p.faults, bq_pack_fault_name(limits[i].fault));
    }
}

static void test_separate_paths_stop_only_what_the_table_says(void)
{
    config.separate_paths = true;
    for (unsigned i = 0; i < LIMITS; i++) {
        start(&limits[i]);
        put(&limits[i], limits[i].beyond);
        rig_run(&r, config.debounce_ms + RIG_PERIOD);
        TEST_ASSERT_EQUAL(BQ_PACK_FAULT, r.p.state);
        TEST_ASSERT_EQUAL_MESSAGE(!limits[i].stops_charge, r.a.charge_on,
                                  bq_pack_fault_name(limits[i].fault));
        TEST_ASSERT_EQUAL_MESSAGE(!limits[i].stops_discharge, r.a.discharge_on,
                                  bq_pack_fault_name(limits[i].fault));
        TEST_ASSERT_EQUAL(limits[i].stops_charge, bq_pack_fault_stops_charge(limits[i].fault));
        TEST_ASSERT_EQUAL(limits[i].stops_discharge, bq_pack_fault_stops_discharge(limits[i].fault));
        r.in.request = BQ_REQUEST_OFF;
        rig_scan(&r);
        TEST_ASSERT_FALSE(r.a.charge_on || r.a.discharge_on);
        r.in.request = BQ_REQUEST_ON; /* inside a fault nothing comes back */
        rig_scan(&r);
        TEST_ASSERT_FALSE(r.a.charge_on || r.a.discharge_on);
    }
}

static void test_separate_paths_never_switch_a_direction_back_on_in_a_fault(void)
{
    config.separate_paths = true;
    rig_init(&r, &config);
    rig_on(&r);
    r.cells[8].mv = 2999; /* discharge stops */
    rig_run(&r, 400);
    TEST_ASSERT_TRUE(r.a.charge_on && !r.a.discharge_on);
    r.temps[2].dc = -1; /* charge stops too */
    rig_run(&r, 400);
    TEST_ASSERT_FALSE(r.a.charge_on || r.a.discharge_on);
    r.cells[8].mv = 3700; /* the reason against discharge goes away, the fault state stays */
    rig_run(&r, 2000);
    TEST_ASSERT_EQUAL(1u << BQ_FAULT_UNDERTEMP, r.p.faults);
    TEST_ASSERT_FALSE(r.a.charge_on || r.a.discharge_on);
}

static void test_separate_paths_open_before_sleep(void)
{
    config.separate_paths = true;
    rig_init(&r, &config);
    rig_on(&r);
    r.cells[8].mv = 2999;
    rig_run(&r, 400);
    TEST_ASSERT_TRUE(r.a.charge_on && !r.a.discharge_on);
    r.in.request = BQ_REQUEST_SLEEP;
    rig_scan(&r);
    TEST_ASSERT_FALSE(r.a.charge_on || r.a.sleep);
    rig_scan(&r);
    TEST_ASSERT_TRUE(r.a.sleep);
}

static void test_imbalance_off_ignores_any_spread(void)
{
    rig_init(&r, &config);
    rig_on(&r);
    r.cells[0].mv = 3000;
    r.cells[11].mv = 4200;
    rig_run(&r, 2000);
    TEST_ASSERT_EQUAL(0, r.p.faults);
}

/* proves: PL-VCELL-07 */
static void test_cells_outside_the_recommended_range_are_always_flagged(void)
{
    const char *field;

    config.cell_ov_mv = 4501;
    TEST_ASSERT_EQUAL(BQ_E_RANGE, bq_pack_config_validate(&config, &field));
    config.cell_ov_mv = 4500;
    config.cell_uv_mv = 999;
    TEST_ASSERT_EQUAL(BQ_E_RANGE, bq_pack_config_validate(&config, &field));
    config.cell_uv_mv = 1000;
    TEST_ASSERT_EQUAL(BQ_OK, bq_pack_config_validate(&config, &field));
    rig_init(&r, &config); /* the widest limits there are */
    rig_on(&r);
    r.cells[8].mv = 4501;
    rig_run(&r, 400);
    TEST_ASSERT_TRUE(rig_active(&r, BQ_FAULT_CELL_OV));
    TEST_ASSERT_EQUAL(4501, r.p.summary.cell_max_mv); /* valid as a number */
    r.cells[8].mv = 999;
    rig_run(&r, 400);
    TEST_ASSERT_TRUE(rig_active(&r, BQ_FAULT_CELL_UV));
    TEST_ASSERT_EQUAL(999, r.p.summary.cell_min_mv);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_value_at_the_limit_never_trips);
    RUN_TEST(test_a_value_beyond_trips_exactly_after_the_debounce_time);
    RUN_TEST(test_one_good_sample_restarts_the_debounce_time);
    RUN_TEST(test_debounce_zero_trips_in_the_step_that_sees_it);
    RUN_TEST(test_the_record_names_place_value_and_times);
    RUN_TEST(test_hysteresis_holds_and_says_so);
    RUN_TEST(test_recovery_takes_exactly_the_recovery_time);
    RUN_TEST(test_a_relapse_restarts_the_recovery_time);
    RUN_TEST(test_recovery_waits_for_a_complete_picture);
    RUN_TEST(test_recovery_needs_a_new_picture);
    RUN_TEST(test_the_value_stands_while_its_module_is_lost_every_second_scan);
    RUN_TEST(test_debounce_goes_on_without_new_pictures);
    RUN_TEST(test_separate_paths_stop_only_what_the_table_says);
    RUN_TEST(test_separate_paths_never_switch_a_direction_back_on_in_a_fault);
    RUN_TEST(test_separate_paths_open_before_sleep);
    RUN_TEST(test_imbalance_off_ignores_any_spread);
    RUN_TEST(test_cells_outside_the_recommended_range_are_always_flagged);
    return UNITY_END();
}
