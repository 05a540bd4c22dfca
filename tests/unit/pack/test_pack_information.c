/* SPDX-License-Identifier: Apache-2.0 */
/* Loss of information, the event log, and the worst case. */
#include "rig.h"
#include "unity.h"
#include <string.h>

static rig r;
static bq_pack_config config;

void setUp(void)
{
    config = rig_config();
    rig_init(&r, &config);
    rig_on(&r);
}

void tearDown(void)
{
}

static void only(bq_pack_fault f)
{
    TEST_ASSERT_EQUAL_MESSAGE(1u << f, r.p.faults, bq_pack_fault_name(f));
    TEST_ASSERT_EQUAL(BQ_PACK_FAULT, r.p.state);
    TEST_ASSERT_FALSE(r.a.charge_on || r.a.discharge_on);
}

static void healthy(void)
{
    TEST_ASSERT_EQUAL(0, r.p.faults);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, r.p.state);
    TEST_ASSERT_TRUE(r.a.charge_on && r.a.discharge_on);
}

/* ---- silence --------------------------------------------------------------------------------- */

static void test_silence_trips_exactly_beyond_the_timeout(void)
{
    rig_idle(&r, config.comm_timeout_ms - RIG_AGE); /* the readings are now exactly as old as they may be */
    healthy();
    TEST_ASSERT_EQUAL(config.comm_timeout_ms, r.p.summary.blind_ms);
    TEST_ASSERT_TRUE(r.p.summary.complete);
    rig_idle(&r, 1);
    only(BQ_FAULT_COMM_LOSS);
    TEST_ASSERT_EQUAL(1, r.p.fault[BQ_FAULT_COMM_LOSS].device);
    TEST_ASSERT_EQUAL(501, r.p.fault[BQ_FAULT_COMM_LOSS].value);
}

static void test_frozen_ages_do_not_hide_silence(void)
{
    r.modules[0].age_ms = r.modules[1].age_ms = 0;
    for (unsigned t = 0; t < 500; t += 100) {
        r.now_ms += 100;
        bq_pack_step(&r.p, &r.s, &r.in, r.now_ms, &r.a);
        healthy();
    }
    r.now_ms += 1;
    bq_pack_step(&r.p, &r.s, &r.in, r.now_ms, &r.a);
    only(BQ_FAULT_COMM_LOSS);
}

static void test_ages_grow_while_the_sample_cannot_be_copied(void)
{
    r.in.sample_copied = false;
    for (unsigned t = 0; t < 400; t += 100) {
        r.now_ms += 100;
        r.s.sequence++; /* even if something else seems to move */
        bq_pack_step(&r.p, &r.s, &r.in, r.now_ms, &r.a);
        healthy();
    }
    r.now_ms += 100; /* 505 ms since the last conversion start */
    bq_pack_step(&r.p, &r.s, &r.in, r.now_ms, &r.a);
    only(BQ_FAULT_COMM_LOSS);
}

static void test_no_sample_at_all_is_silence(void)
{
    for (unsigned t = 0; t < 400; t += 100) {
        r.now_ms += 100;
        bq_pack_step(&r.p, NULL, &r.in, r.now_ms, &r.a);
        healthy();
    }
    r.now_ms += 100;
    bq_pack_step(&r.p, NULL, &r.in, r.now_ms, &r.a);
    only(BQ_FAULT_COMM_LOSS);
}

static void test_a_sample_of_another_shape_is_silence(void)
{
    for (int kind = 0; kind < 8; kind++) {
        setUp();
        r.s.cell_count = (uint16_t)(RIG_CELLS - (kind == 0));
        r.s.temp_count = (uint16_t)(RIG_SENSORS - (kind == 1));
        r.s.module_count = (uint16_t)(RIG_MODULES - (kind == 2));
        r.cells[11].module = (uint8_t)(kind == 3 ? 2 : 1); /* no such module */
        r.cells[3].module = (uint8_t)(kind == 4 ? 1 : 0);  /* not in order */
        r.temps[1].module = (uint8_t)(kind == 5 ? 2 : 0);
        r.cells[0].module = (uint8_t)(kind == 6 ? 1 : 0);
        r.temps[0].module = (uint8_t)(kind == 7 ? 2 : 0);
        rig_run(&r, 400);
        healthy();
        TEST_ASSERT_FALSE(r.p.summary.complete);
        rig_scan(&r);
        only(BQ_FAULT_COMM_LOSS);
    }
}

static void test_one_lost_scan_trips_nothing(void)
{
    for (int n = 0; n < 30; n++) {
        rig_lose(&r, 1);
        rig_scan(&r);
        healthy();
        TEST_ASSERT_FALSE(r.p.summary.complete);
        rig_find(&r, 1);
        rig_scan(&r);
        healthy();
        TEST_ASSERT_TRUE(r.p.summary.complete);
    }
}

static void test_modules_lost_in_turn_trip_nothing_while_each_is_seen_in_time(void)
{
    for (int n = 0; n < 60; n++) {
        rig_find(&r, (uint8_t)(n % 2));
        rig_lose(&r, (uint8_t)(1 - n % 2));
        rig_scan(&r); /* never a complete picture, never a module blind for more than 205 ms */
        healthy();
        TEST_ASSERT_LESS_OR_EQUAL(205, r.p.summary.blind_ms);
    }
}

static void test_a_lost_module_is_named_after_the_timeout_and_recovers(void)
{
    rig_lose(&r, 1);
    rig_run(&r, 400);
    healthy();
    rig_scan(&r); /* 505 ms */
    only(BQ_FAULT_COMM_LOSS);
    TEST_ASSERT_EQUAL(2, r.p.fault[BQ_FAULT_COMM_LOSS].device);
    TEST_ASSERT_EQUAL(BQ_HOLD_CONDITION, r.p.fault[BQ_FAULT_COMM_LOSS].hold);
    rig_find(&r, 1);
    rig_run(&r, 1000);
    only(BQ_FAULT_COMM_LOSS);
    TEST_ASSERT_EQUAL(BQ_HOLD_TIME, r.p.fault[BQ_FAULT_COMM_LOSS].hold);
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_STANDBY, r.p.state);
    rig_scan(&r);
    healthy();
}

static void test_readings_marked_as_lost_count_as_silence_of_their_module(void)
{
    for (int i = 6; i < 12; i++) {
        r.cells[i].quality = BQ_Q_COMM;
    }
    rig_run(&r, 500);
    only(BQ_FAULT_COMM_LOSS);
    TEST_ASSERT_EQUAL(2, r.p.fault[BQ_FAULT_COMM_LOSS].device);
}

static void test_of_equal_values_the_lowest_number_is_shown(void)
{
    TEST_ASSERT_EQUAL(1, r.p.summary.cell_max);
    TEST_ASSERT_EQUAL(1, r.p.summary.cell_min);
    TEST_ASSERT_EQUAL(1, r.p.summary.temp_max);
    TEST_ASSERT_EQUAL(1, r.p.summary.temp_min);
    TEST_ASSERT_EQUAL(12 * 3700, r.p.summary.pack_mv);
}

static void test_an_age_beyond_the_timeout_trips_although_marked_valid(void)
{
    r.now_ms += 100;
    r.s.sequence++;
    r.modules[1].age_ms = UINT32_MAX;
    bq_pack_step(&r.p, &r.s, &r.in, r.now_ms, &r.a);
    only(BQ_FAULT_COMM_LOSS);
    TEST_ASSERT_EQUAL(2, r.p.fault[BQ_FAULT_COMM_LOSS].device);
}

/* ---- single readings ------------------------------------------------------------------------- */

static void test_a_cell_without_a_reading_is_named(void)
{
    static const uint8_t kinds[] = {0, BQ_Q_RANGE, BQ_Q_CHIP};

    for (unsigned i = 0; i < sizeof kinds; i++) {
        setUp();
        r.cells[8].quality = kinds[i];
        rig_run(&r, 400);
        healthy();
        rig_scan(&r);
        only(BQ_FAULT_NO_READING);
        TEST_ASSERT_EQUAL(9, r.p.fault[BQ_FAULT_NO_READING].cell);
        TEST_ASSERT_EQUAL(2, r.p.fault[BQ_FAULT_NO_READING].device);
        r.cells[8].quality = BQ_Q_VALID;
        rig_run(&r, 1200);
        healthy();
    }
}

static void test_a_sensor_without_a_reading_is_named(void)
{
    static const uint8_t kinds[] = {0, BQ_Q_SENSOR, BQ_Q_SENSOR | BQ_Q_RANGE};

    for (unsigned i = 0; i < sizeof kinds; i++) {
        setUp();
        r.temps[2].quality = kinds[i];
        rig_run(&r, 400);
        healthy();
        rig_scan(&r);
        only(BQ_FAULT_SENSOR);
        TEST_ASSERT_EQUAL(3, r.p.fault[BQ_FAULT_SENSOR].sensor);
        TEST_ASSERT_EQUAL(2, r.p.fault[BQ_FAULT_SENSOR].device);
        r.temps[2].quality = BQ_Q_VALID;
        rig_run(&r, 1200);
        healthy();
    }
}

static void test_the_reading_named_is_one_of_the_blind_module(void)
{
    for (int n = 0; n < 6;
         n++) { /* cell 9 and sensor 3 are bad all the time, cell 2 and sensor 1 now and then */
        r.cells[8].quality = BQ_Q_RANGE;
        r.temps[2].quality = BQ_Q_SENSOR;
        r.cells[1].quality = n % 2 == 0 ? BQ_Q_VALID : BQ_Q_RANGE;
        r.temps[0].quality = n % 2 == 0 ? BQ_Q_VALID : BQ_Q_SENSOR;
        rig_scan(&r);
    }
    TEST_ASSERT_EQUAL(1u << BQ_FAULT_NO_READING | 1u << BQ_FAULT_SENSOR, r.p.faults);
    TEST_ASSERT_EQUAL(9, r.p.fault[BQ_FAULT_NO_READING].cell);
    TEST_ASSERT_EQUAL(3, r.p.fault[BQ_FAULT_SENSOR].sensor);
}

static void test_a_pack_without_sensors_needs_none(void)
{
    config.sensors = 0;
    rig_init(&r, &config);
    r.s.temp_count = 0;
    rig_on(&r);
    rig_run(&r, 2000);
    healthy();
}

static void test_a_value_never_seen_valid_is_not_judged(void)
{
    config.debounce_ms = 0;
    rig_init(&r, &config);
    r.cells[8].mv = 0; /* what a driver shows before the first good reading */
    r.cells[8].quality = BQ_Q_RANGE;
    r.in.monitor = BQ_MONITOR_UP;
    r.in.self_test = BQ_TEST_PASSED;
    rig_scan(&r); /* the time begins when the monitor is up */
    rig_run(&r, 500);
    TEST_ASSERT_EQUAL(0, r.p.faults);
    TEST_ASSERT_EQUAL(BQ_PACK_INIT, r.p.state);
    rig_scan(&r);
    only(BQ_FAULT_NO_READING);
}

/* ---- log and worst case ----------------------------------------------------------------------- */

static const bq_pack_event *newest(unsigned back)
{
    return &r.p.events[(r.p.event_count - 1u - back) % BQ_PACK_EVENTS];
}

static void test_the_log_tells_the_story_in_order(void)
{
    const uint32_t before = r.p.event_count;

    r.modules[1].faults = BQ_F_MEMORY;
    rig_scan(&r);
    rig_scan(&r); /* nothing new */
    TEST_ASSERT_EQUAL(before + 3u, r.p.event_count);
    TEST_ASSERT_EQUAL(BQ_EVENT_CHIP_FLAGS, newest(2)->kind);
    TEST_ASSERT_EQUAL(2, newest(2)->code);
    TEST_ASSERT_EQUAL(BQ_F_MEMORY, newest(2)->where);
    TEST_ASSERT_EQUAL(BQ_EVENT_FAULT, newest(1)->kind);
    TEST_ASSERT_EQUAL(BQ_FAULT_CHIP, newest(1)->code);
    TEST_ASSERT_EQUAL(2, newest(1)->where);
    TEST_ASSERT_EQUAL(BQ_EVENT_STATE, newest(0)->kind);
    TEST_ASSERT_EQUAL(BQ_PACK_FAULT, newest(0)->code);
    TEST_ASSERT_EQUAL(r.now_ms - RIG_PERIOD, newest(0)->t_ms);
    r.modules[1].faults = 0;
    rig_run(&r, 1100);
    TEST_ASSERT_EQUAL(BQ_EVENT_RECOVERED, newest(1)->kind);
    TEST_ASSERT_EQUAL(BQ_FAULT_CHIP, newest(1)->code);
    TEST_ASSERT_EQUAL(BQ_PACK_STANDBY, newest(0)->code);
}

static void test_the_log_is_bounded_and_counts_stay_right(void)
{
    for (uint16_t n = 1; n <= 100; n++) {
        r.modules[0].faults = BQ_F_CELL_OV;
        rig_scan(&r);
        TEST_ASSERT_EQUAL(n, r.p.fault[BQ_FAULT_CHIP_CELL_OV].count);
        r.modules[0].faults = 0;
        rig_run(&r, 1200);
        healthy();
    }
    TEST_ASSERT_GREATER_THAN(4 * BQ_PACK_EVENTS, r.p.event_count);
}

/* Every pattern of lost and good scans after a cell leaves its limits: the stated worst case holds. */
static void test_worst_case_from_event_to_outputs_off_under_every_loss_pattern(void)
{
    const uint32_t bound = 500u + 300u + 2u * RIG_PERIOD;

    for (unsigned pattern = 0; pattern < 2048u; pattern++) {
        uint32_t event_ms;
        setUp();
        event_ms = r.now_ms - RIG_AGE + 1u; /* just after the last conversion start */
        for (int n = 0; n < 11; n++) {
            if (((pattern >> n) & 1u) != 0u) {
                rig_lose(&r, 1);
            } else {
                rig_find(&r, 1);
                r.cells[8].mv = 4300; /* the first conversion after the event shows it */
            }
            rig_scan(&r);
            if (!r.a.charge_on && !r.a.discharge_on) {
                break;
            }
        }
        TEST_ASSERT_FALSE(r.a.charge_on || r.a.discharge_on);
        TEST_ASSERT_LESS_OR_EQUAL(bound, r.now_ms - event_ms);
    }
}

static void test_worst_case_of_silence_for_every_step_width(void)
{
    for (uint32_t step = 1; step <= 250u; step++) {
        uint32_t last_good_ms;
        setUp();
        last_good_ms = r.now_ms - RIG_AGE;
        while (r.a.charge_on || r.a.discharge_on) {
            rig_idle(&r, step);
        }
        TEST_ASSERT_LESS_OR_EQUAL(500u + step, r.now_ms - last_good_ms);
        TEST_ASSERT_GREATER_THAN(500u, r.now_ms - last_good_ms);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_silence_trips_exactly_beyond_the_timeout);
    RUN_TEST(test_frozen_ages_do_not_hide_silence);
    RUN_TEST(test_ages_grow_while_the_sample_cannot_be_copied);
    RUN_TEST(test_no_sample_at_all_is_silence);
    RUN_TEST(test_a_sample_of_another_shape_is_silence);
    RUN_TEST(test_one_lost_scan_trips_nothing);
    RUN_TEST(test_modules_lost_in_turn_trip_nothing_while_each_is_seen_in_time);
    RUN_TEST(test_a_lost_module_is_named_after_the_timeout_and_recovers);
    RUN_TEST(test_readings_marked_as_lost_count_as_silence_of_their_module);
    RUN_TEST(test_of_equal_values_the_lowest_number_is_shown);
    RUN_TEST(test_an_age_beyond_the_timeout_trips_although_marked_valid);
    RUN_TEST(test_a_cell_without_a_reading_is_named);
    RUN_TEST(test_a_sensor_without_a_reading_is_named);
    RUN_TEST(test_the_reading_named_is_one_of_the_blind_module);
    RUN_TEST(test_a_pack_without_sensors_needs_none);
    RUN_TEST(test_a_value_never_seen_valid_is_not_judged);
    RUN_TEST(test_the_log_tells_the_story_in_order);
    RUN_TEST(test_the_log_is_bounded_and_counts_stay_right);
    RUN_TEST(test_worst_case_from_event_to_outputs_off_under_every_loss_pattern);
    RUN_TEST(test_worst_case_of_silence_for_every_step_width);
    return UNITY_END();
}
