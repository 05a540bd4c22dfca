/* SPDX-License-Identifier: Apache-2.0 */
/* The state machine, latched faults, determinism and time. */
#include "rig.h"
#include "unity.h"
#include <string.h>

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

static void off(void)
{
    TEST_ASSERT_FALSE(r.a.charge_on);
    TEST_ASSERT_FALSE(r.a.discharge_on);
}

static void test_the_way_up_takes_every_state_in_turn(void)
{
    r.in.request = BQ_REQUEST_ON;
    for (int n = 0; n < 20; n++) { /* for as long as the monitor is down */
        rig_scan(&r);
        TEST_ASSERT_EQUAL(BQ_PACK_INIT, r.p.state);
        off();
    }
    TEST_ASSERT_EQUAL(0, r.p.faults);
    r.in.monitor = BQ_MONITOR_UP;
    for (int n = 0; n < 20; n++) { /* for as long as the test has no result */
        rig_scan(&r);
        TEST_ASSERT_EQUAL(BQ_PACK_SELF_TEST, r.p.state);
        off();
    }
    r.in.self_test = BQ_TEST_PASSED;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_STANDBY, r.p.state);
    off();
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, r.p.state);
    TEST_ASSERT_TRUE(r.a.charge_on && r.a.discharge_on);
    TEST_ASSERT_FALSE(r.a.unlock);
    TEST_ASSERT_EQUAL(r.now_ms, r.p.state_ms);
    r.in.request = BQ_REQUEST_OFF;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_STANDBY, r.p.state);
    TEST_ASSERT_TRUE(r.a.unlock); /* a person has intervened */
    off();
}

static void test_init_waits_for_the_first_complete_picture_but_not_for_ever(void)
{
    r.in.monitor = BQ_MONITOR_UP;
    rig_lose(&r, 0);
    r.modules[0].age_ms = UINT32_MAX; /* never measured */
    r.now_ms += 100;
    bq_pack_step(&r.p, &r.s, &r.in, r.now_ms, &r.a);
    for (int n = 0; n < 5; n++) {
        TEST_ASSERT_EQUAL(BQ_PACK_INIT, r.p.state);
        r.now_ms += 100;
        bq_pack_step(&r.p, &r.s, &r.in, r.now_ms, &r.a);
    }
    TEST_ASSERT_EQUAL(0, r.p.faults);
    r.now_ms += 1;
    bq_pack_step(&r.p, &r.s, &r.in, r.now_ms, &r.a);
    TEST_ASSERT_EQUAL(1u << BQ_FAULT_COMM_LOSS, r.p.faults);
    TEST_ASSERT_EQUAL(1, r.p.fault[BQ_FAULT_COMM_LOSS].device);
}

static void test_failed_bring_up_is_a_config_fault_with_its_status(void)
{
    r.in.monitor = BQ_MONITOR_FAILED;
    r.in.monitor_status = BQ_E_NOT_FOUND;
    bq_pack_step(&r.p, NULL, &r.in, 100, &r.a);
    TEST_ASSERT_EQUAL(BQ_PACK_FAULT, r.p.state);
    TEST_ASSERT_EQUAL(1u << BQ_FAULT_CONFIG, r.p.faults);
    TEST_ASSERT_EQUAL(BQ_E_NOT_FOUND, r.p.fault[BQ_FAULT_CONFIG].value);
    r.now_ms = 100;
    r.in.monitor = BQ_MONITOR_UP;
    rig_run(&r, 1000);
    TEST_ASSERT_EQUAL(BQ_HOLD_TIME, r.p.fault[BQ_FAULT_CONFIG].hold);
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_INIT, r.p.state); /* the self-test has not passed */
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_SELF_TEST, r.p.state);
}

static void test_failed_self_test_is_a_fault_until_it_passes(void)
{
    r.in.monitor = BQ_MONITOR_UP;
    r.in.self_test = BQ_TEST_FAILED;
    r.in.self_test_status = BQ_E_CHAIN_BROKEN;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_FAULT, r.p.state);
    TEST_ASSERT_EQUAL(BQ_E_CHAIN_BROKEN, r.p.fault[BQ_FAULT_SELF_TEST].value);
    rig_run(&r, 3000);
    TEST_ASSERT_EQUAL(1u << BQ_FAULT_SELF_TEST, r.p.faults);
    r.in.self_test = BQ_TEST_PASSED;
    rig_run(&r, 1100);
    TEST_ASSERT_EQUAL(BQ_PACK_STANDBY, r.p.state);
}

static void test_on_is_refused_while_a_limit_is_being_broken(void)
{
    rig_standby(&r);
    r.cells[0].mv = 4300;
    rig_scan(&r);
    r.in.request = BQ_REQUEST_ON;
    rig_scan(&r); /* debounce time still running */
    TEST_ASSERT_EQUAL(BQ_PACK_STANDBY, r.p.state);
    off();
}

static void test_on_is_refused_without_a_complete_picture(void)
{
    rig_standby(&r);
    rig_lose(&r, 0);
    rig_scan(&r);
    r.in.request = BQ_REQUEST_ON;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_STANDBY, r.p.state);
    off();
    rig_find(&r, 0);
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, r.p.state);
}

static void test_on_is_refused_while_the_contactor_disagrees(void)
{
    rig_standby(&r);
    r.in.request = BQ_REQUEST_ON;
    r.in.contactor_mismatch_ms = 1;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_STANDBY, r.p.state);
    off();
}

static void test_standby_falls_back_when_monitor_or_self_test_are_lost(void)
{
    rig_standby(&r);
    r.in.self_test = BQ_TEST_NONE;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_INIT, r.p.state);
    rig_standby(&r);
    r.in.monitor = BQ_MONITOR_DOWN;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_INIT, r.p.state);
    r.in.monitor = BQ_MONITOR_UP;
    r.in.self_test = BQ_TEST_NONE;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_SELF_TEST, r.p.state);
    r.in.monitor = BQ_MONITOR_DOWN;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_INIT, r.p.state);
}

static void test_on_survives_a_short_restart_of_the_monitor_but_not_a_long_one(void)
{
    rig_on(&r);
    r.in.monitor = BQ_MONITOR_DOWN;
    r.in.self_test = BQ_TEST_NONE;
    rig_idle(&r, 400);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, r.p.state);
    rig_idle(&r, 100);
    TEST_ASSERT_EQUAL(1u << BQ_FAULT_COMM_LOSS, r.p.faults);
    off();
}

/* ---- contactor ------------------------------------------------------------------------------- */

static void test_a_contactor_that_disagrees_for_100_ms_is_a_latched_fault(void)
{
    rig_on(&r);
    r.in.contactor_mismatch_ms = 99;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, r.p.state);
    r.in.contactor_mismatch_ms = 100;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(1u << BQ_FAULT_CONTACTOR, r.p.faults);
    off();
    r.in.contactor_mismatch_ms = 0;
    rig_run(&r, 5000);
    TEST_ASSERT_EQUAL(1u << BQ_FAULT_CONTACTOR, r.p.faults);
    TEST_ASSERT_EQUAL(BQ_HOLD_REQUEST, r.p.fault[BQ_FAULT_CONTACTOR].hold);
    r.in.request = BQ_REQUEST_OFF;
    rig_run(&r, 1000);
    TEST_ASSERT_EQUAL(BQ_HOLD_TIME, r.p.fault[BQ_FAULT_CONTACTOR].hold);
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_STANDBY, r.p.state);
}

/* ---- sleep ----------------------------------------------------------------------------------- */

/* proves: PL-SLEEP-07 */
static void test_sleep_is_asked_for_only_after_the_outputs_were_off(void)
{
    rig_on(&r);
    r.in.request = BQ_REQUEST_SLEEP;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_STANDBY, r.p.state);
    off();
    TEST_ASSERT_FALSE(r.a.sleep);
    r.in.contactor_mismatch_ms = 20; /* the contact is still closed */
    rig_scan(&r);
    TEST_ASSERT_FALSE(r.a.sleep);
    r.in.contactor_mismatch_ms = 0;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_SLEEP, r.p.state);
    TEST_ASSERT_TRUE(r.a.sleep);
    off();
}

static void test_a_long_sleep_is_not_a_fault_and_waking_starts_again(void)
{
    rig_standby(&r);
    r.in.request = BQ_REQUEST_SLEEP;
    rig_scan(&r);
    r.in.monitor = BQ_MONITOR_DOWN;
    r.in.self_test = BQ_TEST_NONE;
    r.cells[0].mv = 2000; /* whatever the old picture shows */
    for (int n = 0; n < 100; n++) {
        rig_idle(&r, 60000);
        TEST_ASSERT_EQUAL(BQ_PACK_SLEEP, r.p.state);
        TEST_ASSERT_TRUE(r.a.sleep);
    }
    r.in.request = BQ_REQUEST_ON;
    rig_idle(&r, 100);
    TEST_ASSERT_EQUAL(BQ_PACK_INIT, r.p.state);
    TEST_ASSERT_FALSE(r.a.sleep);
    rig_idle(&r, 5000); /* waking takes its time */
    r.in.monitor = BQ_MONITOR_UP;
    rig_idle(&r, 400);
    TEST_ASSERT_EQUAL(0, r.p.faults);
    TEST_ASSERT_EQUAL(BQ_PACK_INIT, r.p.state);
    r.cells[0].mv = 3700;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_SELF_TEST, r.p.state);
    off();
}

static void test_silence_right_after_waking_trips_after_the_timeout(void)
{
    rig_standby(&r);
    r.in.request = BQ_REQUEST_SLEEP;
    rig_scan(&r);
    rig_idle(&r, 3600000);
    r.in.request = BQ_REQUEST_ON;
    rig_idle(&r, 100); /* the monitor claims to be up all the time */
    rig_idle(&r, 500);
    TEST_ASSERT_EQUAL(0, r.p.faults);
    rig_idle(&r, 1);
    TEST_ASSERT_EQUAL(1u << BQ_FAULT_COMM_LOSS, r.p.faults);
}

static void test_debounce_begins_again_after_sleep(void)
{
    rig_standby(&r);
    r.cells[0].mv = 2900;
    rig_run(&r, 200);
    r.in.request = BQ_REQUEST_SLEEP;
    rig_scan(&r); /* 200 of 300 ms */
    TEST_ASSERT_EQUAL(BQ_PACK_SLEEP, r.p.state);
    r.in.request = BQ_REQUEST_ON;
    rig_scan(&r);
    rig_run(&r, 300);
    TEST_ASSERT_EQUAL(0, r.p.faults);
    rig_scan(&r);
    TEST_ASSERT_EQUAL(1u << BQ_FAULT_CELL_UV, r.p.faults);
}

static void test_recovery_begins_again_after_sleep(void)
{
    rig_on(&r);
    r.modules[0].faults = BQ_F_MEMORY;
    rig_scan(&r);
    r.modules[0].faults = 0;
    rig_run(&r, 900); /* 800 of 1000 ms */
    r.in.request = BQ_REQUEST_SLEEP;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_SLEEP, r.p.state);
    r.in.request = BQ_REQUEST_ON;
    rig_scan(&r);
    rig_run(&r, 1000);
    TEST_ASSERT_EQUAL(1u << BQ_FAULT_CHIP, r.p.faults);
    rig_scan(&r);
    TEST_ASSERT_EQUAL(0, r.p.faults);
}

static void test_a_fault_survives_sleep(void)
{
    rig_on(&r);
    r.cells[0].mv = 2900;
    rig_run(&r, 400);
    TEST_ASSERT_EQUAL(BQ_PACK_FAULT, r.p.state);
    r.in.request = BQ_REQUEST_SLEEP;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_SLEEP, r.p.state);
    r.in.request = BQ_REQUEST_ON;
    rig_scan(&r);
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_PACK_FAULT, r.p.state);
    TEST_ASSERT_EQUAL(1u << BQ_FAULT_CELL_UV, r.p.faults);
}

/* ---- names, arguments ------------------------------------------------------------------------ */

static void test_names(void)
{
    static const char *const faults[BQ_FAULT_COUNT] = {
        "cell_ov",   "cell_uv",      "overtemp",     "undertemp",     "imbalance",   "comm_loss",
        "chip",      "chip_cell_ov", "chip_cell_uv", "chip_overtemp", "open_wire",   "sensor",
        "self_test", "config",       "contactor",    "no_reading",    "overcurrent", "charge_overcurrent"};
    static const char *const states[] = {"init", "self-test", "standby", "on", "fault", "sleep"};
    static const char *const holds[] = {"none", "condition", "hysteresis", "unknown", "request", "time"};

    for (int i = 0; i < BQ_FAULT_COUNT; i++) {
        TEST_ASSERT_EQUAL_STRING(faults[i], bq_pack_fault_name((bq_pack_fault)i));
    }
    for (int i = 0; i < 6; i++) {
        TEST_ASSERT_EQUAL_STRING(states[i], bq_pack_state_name((bq_pack_state_id)i));
        TEST_ASSERT_EQUAL_STRING(holds[i], bq_pack_hold_name((bq_pack_hold)i));
    }
    TEST_ASSERT_EQUAL_STRING("?", bq_pack_fault_name(BQ_FAULT_COUNT));
    TEST_ASSERT_EQUAL_STRING("?", bq_pack_state_name((bq_pack_state_id)6));
    TEST_ASSERT_EQUAL_STRING("?", bq_pack_hold_name((bq_pack_hold)6));
    TEST_ASSERT_FALSE(bq_pack_fault_stops_charge(BQ_FAULT_COUNT));
    TEST_ASSERT_FALSE(bq_pack_fault_stops_discharge(BQ_FAULT_COUNT));
}

/* Only these leave one direction alone, everything else forbids both. */
static void test_the_directions_of_every_fault(void)
{
    static const uint32_t charge_stays = 1u << BQ_FAULT_CELL_UV | 1u << BQ_FAULT_CHIP_CELL_UV;
    static const uint32_t discharge_stays = 1u << BQ_FAULT_CELL_OV | 1u << BQ_FAULT_CHIP_CELL_OV |
                                            1u << BQ_FAULT_UNDERTEMP | 1u << BQ_FAULT_CHARGE_CURRENT;

    for (int f = 0; f < BQ_FAULT_COUNT; f++) {
        const char *name = bq_pack_fault_name((bq_pack_fault)f);
        TEST_ASSERT_EQUAL_MESSAGE((charge_stays >> f & 1u) == 0u,
                                  bq_pack_fault_stops_charge((bq_pack_fault)f), name);
        TEST_ASSERT_EQUAL_MESSAGE((discharge_stays >> f & 1u) == 0u,
                                  bq_pack_fault_stops_discharge((bq_pack_fault)f), name);
    }
}

static void test_the_cause_is_the_most_serious_active_fault(void)
{
    static const bq_pack_fault order[] = {
        BQ_FAULT_CHIP,         BQ_FAULT_CONTACTOR,  BQ_FAULT_OVERCURRENT,   BQ_FAULT_CHARGE_CURRENT,
        BQ_FAULT_CHIP_CELL_OV, BQ_FAULT_CELL_OV,    BQ_FAULT_CHIP_OVERTEMP, BQ_FAULT_OVERTEMP,
        BQ_FAULT_CHIP_CELL_UV, BQ_FAULT_CELL_UV,    BQ_FAULT_UNDERTEMP,     BQ_FAULT_OPEN_WIRE,
        BQ_FAULT_COMM_LOSS,    BQ_FAULT_NO_READING, BQ_FAULT_SENSOR,        BQ_FAULT_SELF_TEST,
        BQ_FAULT_CONFIG,       BQ_FAULT_IMBALANCE};
    const int n = (int)(sizeof order / sizeof order[0]);

    TEST_ASSERT_EQUAL(BQ_FAULT_COUNT, n);
    TEST_ASSERT_EQUAL(BQ_FAULT_COUNT, bq_pack_cause(&r.p));
    for (int i = n - 1; i >= 0; i--) { /* one more serious fault after the other joins */
        r.p.fault[order[i]].active = true;
        r.p.faults |= (uint32_t)1 << order[i];
        TEST_ASSERT_EQUAL(order[i], bq_pack_cause(&r.p));
    }
}

static void test_bad_arguments_switch_everything_off(void)
{
    rig_on(&r);
    bq_pack_step(NULL, &r.s, &r.in, r.now_ms, &r.a);
    off();
    memset(&r.a, 0xff, sizeof r.a);
    bq_pack_step(&r.p, &r.s, NULL, r.now_ms, &r.a);
    off();
    TEST_ASSERT_EQUAL(0, rig_bleeding(&r));
    bq_pack_step(&r.p, &r.s, &r.in, r.now_ms, NULL);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, r.p.state);
}

/* ---- determinism and time -------------------------------------------------------------------- */

static uint32_t lot;

static uint32_t draw(uint32_t n)
{
    lot = lot * 1664525u + 1013904223u;
    return (lot >> 8) % n;
}

/* One step of a random walk: fifteen steps of everything that can happen, then a calm time to recover. */
static void live(rig *x, int n)
{
    const uint32_t trouble = n % 100 < 15 ? 1u : 0u;

    rig_all_temps(x, (int16_t)(250u + trouble * draw(400)));
    x->in.monitor = trouble * draw(9) == 8u ? BQ_MONITOR_DOWN : BQ_MONITOR_UP;
    x->in.self_test = trouble * draw(30) == 29u ? BQ_TEST_FAILED : BQ_TEST_PASSED;
    x->in.request = draw(40) == 0u || n % 400 < 60 ? BQ_REQUEST_OFF : BQ_REQUEST_ON;
    x->in.sample_copied = trouble * draw(9) != 8u;
    x->in.contactor_mismatch_ms = trouble * draw(30) == 29u ? 150u : 0u;
    x->cells[draw(RIG_CELLS)].mv = (uint16_t)(3700u + draw(100) + trouble * draw(600));
    if (trouble == 0u && x->p.summary.cell_max > 0u && x->p.summary.cell_max_mv > 3800u) {
        x->cells[x->p.summary.cell_max - 1u].mv = 3700;
    }
    x->modules[draw(RIG_MODULES)].faults = (uint16_t)(trouble * draw(4) == 3u ? 1u << draw(16) : 0u);
    x->s.current_valid = true;
    x->s.current_age_ms = 0;
    x->s.current_ma = (int32_t)draw(410) - 205;
    if (draw(5) != 0u) {
        rig_scan(x);
    } else {
        rig_idle(x, 1u + draw(200));
    }
}

/* Two instances, the clock of one of them wrapping in the middle: equal actions, equal state but for the time
 * stamps. */
static void test_same_inputs_same_outputs_also_across_the_wrap_of_time(void)
{
    static rig other;
    int on = 0, faults = 0, balanced = 0;

    rig_init(&other, &config);
    other.now_ms = UINT32_MAX - 30000u;
    for (int n = 0; n < 20000; n++) {
        const uint32_t seed = (uint32_t)n * 7919u;
        lot = seed;
        live(&r, n);
        lot = seed;
        live(&other, n);
        TEST_ASSERT_EQUAL_MEMORY(&r.a, &other.a, sizeof r.a);
        TEST_ASSERT_EQUAL(r.p.state, other.p.state);
        TEST_ASSERT_EQUAL(r.p.faults, other.p.faults);
        TEST_ASSERT_EQUAL_MEMORY(&r.p.summary, &other.p.summary, sizeof r.p.summary);
        on += r.a.charge_on ? 1 : 0;
        faults += r.p.faults != 0u ? 1 : 0;
        balanced += r.p.summary.balancing != 0u ? 1 : 0;
        TEST_ASSERT_TRUE(r.a.charge_on == (r.p.state == BQ_PACK_ON) && r.a.charge_on == r.a.discharge_on);
        TEST_ASSERT_FALSE(r.p.faults != 0u && (r.a.charge_on || rig_bleeding(&r) != 0));
    }
    TEST_ASSERT_TRUE(other.now_ms < r.now_ms); /* it wrapped */
    TEST_ASSERT_TRUE(on > 2000 && faults > 2000 && balanced > 1000);
}

static void test_the_first_step_at_any_time_sees_no_time_passed(void)
{
    r.now_ms = 4000000000u;
    r.in.monitor = BQ_MONITOR_UP;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(0, r.p.faults);
    TEST_ASSERT_EQUAL(RIG_AGE, r.p.summary.blind_ms);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_way_up_takes_every_state_in_turn);
    RUN_TEST(test_init_waits_for_the_first_complete_picture_but_not_for_ever);
    RUN_TEST(test_failed_bring_up_is_a_config_fault_with_its_status);
    RUN_TEST(test_failed_self_test_is_a_fault_until_it_passes);
    RUN_TEST(test_on_is_refused_while_a_limit_is_being_broken);
    RUN_TEST(test_on_is_refused_without_a_complete_picture);
    RUN_TEST(test_on_is_refused_while_the_contactor_disagrees);
    RUN_TEST(test_standby_falls_back_when_monitor_or_self_test_are_lost);
    RUN_TEST(test_on_survives_a_short_restart_of_the_monitor_but_not_a_long_one);
    RUN_TEST(test_a_contactor_that_disagrees_for_100_ms_is_a_latched_fault);
    RUN_TEST(test_sleep_is_asked_for_only_after_the_outputs_were_off);
    RUN_TEST(test_a_long_sleep_is_not_a_fault_and_waking_starts_again);
    RUN_TEST(test_silence_right_after_waking_trips_after_the_timeout);
    RUN_TEST(test_debounce_begins_again_after_sleep);
    RUN_TEST(test_recovery_begins_again_after_sleep);
    RUN_TEST(test_a_fault_survives_sleep);
    RUN_TEST(test_names);
    RUN_TEST(test_the_directions_of_every_fault);
    RUN_TEST(test_the_cause_is_the_most_serious_active_fault);
    RUN_TEST(test_bad_arguments_switch_everything_off);
    RUN_TEST(test_same_inputs_same_outputs_also_across_the_wrap_of_time);
    RUN_TEST(test_the_first_step_at_any_time_sees_no_time_passed);
    return UNITY_END();
}
