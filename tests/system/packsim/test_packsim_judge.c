/* SPDX-License-Identifier: Apache-2.0 */
/* Every kind of expectation holds when it should and fails when it should: what judges must be able to say
 * no. */
#include "ps_judge.h"
#include "unity.h"

#include <string.h>

static ps_scenario scenario;
static ps_judge judge;
static ps_error error;

void setUp(void)
{
    memset(&scenario, 0, sizeof scenario);
    memset(&error, 0, sizeof error);
    scenario.devices = 4;
    scenario.cells = 24;
    scenario.duration = 100 * PS_S;
}

void tearDown(void)
{
}

static void expecting(const char *text)
{
    scenario.expects = 1;
    TEST_ASSERT_EQUAL(0, ps_expect_parse(&scenario.expect[0], &scenario, text, (ps_place){"t", 1}, &error));
    ps_judge_init(&judge, &scenario);
}

static bool held(double measurement, double soc, unsigned long misuse, double speed)
{
    ps_totals totals = {measurement, soc, misuse, speed};
    ps_judge_end(&judge, &totals);
    return ps_judge_held(&judge) == 1;
}

static bool held_in(const char *text, uint64_t seconds, const ps_view *view)
{
    expecting(text);
    TEST_ASSERT_EQUAL(seconds * PS_S, ps_judge_next(&judge));
    ps_judge_look(&judge, seconds * PS_S - 1u, &(ps_view){0});
    TEST_ASSERT_EQUAL(seconds * PS_S, ps_judge_next(&judge));
    ps_judge_look(&judge, seconds * PS_S, view);
    TEST_ASSERT_TRUE(ps_judge_next(&judge) == UINT64_MAX);
    return held(0.0, 0.0, 0, 0.0);
}

static void test_state_discovered_spread_recovered(void)
{
    ps_view good = {BQ_PACK_ON, 4, true, true, 4.9}, bad = {BQ_PACK_FAULT, 3, false, false, 5.0};
    TEST_ASSERT_TRUE(held_in("state on at 10 s", 10, &good));
    TEST_ASSERT_FALSE(held_in("state on at 10 s", 10, &bad));
    TEST_ASSERT_TRUE(held_in("discovered 4 at 10 s", 10, &good));
    TEST_ASSERT_FALSE(held_in("discovered 4 at 10 s", 10, &bad));
    TEST_ASSERT_TRUE(held_in("spread below 5 mv at 10 s", 10, &good));
    TEST_ASSERT_FALSE(held_in("spread below 5 mv at 10 s", 10, &bad));
    TEST_ASSERT_TRUE(held_in("recovered at 10 s", 10, &good));
    TEST_ASSERT_FALSE(held_in("recovered at 10 s", 10, &bad));
    expecting("state on at 10 s"); /* never looked at is not held */
    TEST_ASSERT_FALSE(held(0.0, 0.0, 0, 0.0));
}

static bool fault_held(const char *text, int id, int cell, uint64_t ms)
{
    expecting(text);
    ps_fault_seen seen = {ms * PS_MS, id, cell, 2, 0};
    ps_judge_fault(&judge, &seen);
    return held(0.0, 0.0, 0, 0.0);
}

static void test_fault_needs_name_place_and_time(void)
{
    const char *text = "fault cell_ov cell 9 within 600 ms of 20 s";
    TEST_ASSERT_TRUE(fault_held(text, BQ_FAULT_CELL_OV, 9, 20000));
    TEST_ASSERT_TRUE(fault_held(text, BQ_FAULT_CELL_OV, 9, 20600));
    TEST_ASSERT_FALSE(fault_held(text, BQ_FAULT_CELL_OV, 9, 20601));
    TEST_ASSERT_FALSE(fault_held(text, BQ_FAULT_CELL_OV, 9, 19999));
    TEST_ASSERT_FALSE(fault_held(text, BQ_FAULT_CELL_OV, 8, 20100));
    TEST_ASSERT_FALSE(fault_held(text, BQ_FAULT_CELL_UV, 9, 20100));
    TEST_ASSERT_TRUE(fault_held("fault cell_ov within 1 s of 20 s", BQ_FAULT_CELL_OV, 3, 20100));
    TEST_ASSERT_TRUE(fault_held("fault comm_loss device 2 within 1 s of 20 s", BQ_FAULT_COMM_LOSS, 0, 20100));
    TEST_ASSERT_FALSE(
        fault_held("fault comm_loss device 1 within 1 s of 20 s", BQ_FAULT_COMM_LOSS, 0, 20100));
}

static void test_absence_of_faults(void)
{
    TEST_ASSERT_FALSE(fault_held("no faults", BQ_FAULT_CELL_OV, 1, 99000));
    TEST_ASSERT_FALSE(fault_held("no fault before 20 s", BQ_FAULT_CELL_OV, 1, 19999));
    TEST_ASSERT_TRUE(fault_held("no fault before 20 s", BQ_FAULT_CELL_OV, 1, 20000));
    expecting("no faults");
    TEST_ASSERT_TRUE(held(0.0, 0.0, 0, 0.0));
}

static bool outputs_held(bool on_at_start, uint64_t off_ms)
{
    ps_view view = {0};
    view.outputs_on = on_at_start;
    expecting("outputs off within 500 ms of 20 s");
    ps_judge_look(&judge, 20 * PS_S, &view);
    ps_judge_outputs(&judge, off_ms * PS_MS, false);
    return held(0.0, 0.0, 0, 0.0);
}

static void test_outputs_off_in_time(void)
{
    TEST_ASSERT_TRUE(outputs_held(true, 20500));
    TEST_ASSERT_FALSE(outputs_held(true, 20501));
    TEST_ASSERT_FALSE(outputs_held(true, 19000));
    TEST_ASSERT_TRUE(outputs_held(false, 99000));
    expecting("outputs off within 500 ms of 20 s");
    ps_judge_outputs(&judge, 20100 * PS_MS, true); /* switching on is not off */
    TEST_ASSERT_FALSE(held(0.0, 0.0, 0, 0.0));
}

static void test_errors_misuse_and_speed(void)
{
    expecting("measurement error below 2 mv");
    TEST_ASSERT_TRUE(held(1.99, 0.0, 0, 0.0));
    expecting("measurement error below 2 mv");
    TEST_ASSERT_FALSE(held(2.0, 0.0, 0, 0.0));
    expecting("measurement error below 2 mv"); /* nothing was measured */
    TEST_ASSERT_FALSE(held(-1.0, 0.0, 0, 0.0));
    expecting("soc error below 1 percent");
    TEST_ASSERT_TRUE(held(0.0, 0.5, 0, 0.0));
    expecting("soc error below 1 percent");
    TEST_ASSERT_FALSE(held(0.0, 1.0, 0, 0.0));
    expecting("soc error below 1 percent");
    TEST_ASSERT_FALSE(held(0.0, -1.0, 0, 0.0));
    expecting("misuse none");
    TEST_ASSERT_TRUE(held(0.0, 0.0, 0, 0.0));
    expecting("misuse none");
    TEST_ASSERT_FALSE(held(0.0, 0.0, 1, 0.0));
    expecting("speed above 100");
    TEST_ASSERT_TRUE(held(0.0, 0.0, 0, 101.0));
    expecting("speed above 100");
    TEST_ASSERT_FALSE(held(0.0, 0.0, 0, 100.0));
}

static void test_all_faults_are_counted_even_when_not_kept(void)
{
    expecting("misuse none");
    for (int i = 0; i < PS_FAULTS_KEPT + 5; i++) {
        ps_judge_fault(&judge, &(ps_fault_seen){0, 0, 0, 0, 0});
    }
    TEST_ASSERT_EQUAL(PS_FAULTS_KEPT + 5, judge.faults);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_state_discovered_spread_recovered);
    RUN_TEST(test_fault_needs_name_place_and_time);
    RUN_TEST(test_absence_of_faults);
    RUN_TEST(test_outputs_off_in_time);
    RUN_TEST(test_errors_misuse_and_speed);
    RUN_TEST(test_all_faults_are_counted_even_when_not_kept);
    return UNITY_END();
}
