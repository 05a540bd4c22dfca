/* SPDX-License-Identifier: Apache-2.0 */
/* The coulomb counter: every window counted once, windows that were lost reported and filled, signs, limits,
 * a counter that stands, one conversion at a time. */
#include "bench.h"
#include <stdlib.h>

void setUp(void)
{
}
void tearDown(void)
{
}

static void running(const char *name)
{
    int n;
    bench_up(name);
    for (n = 0; n < 60; n++) { /* time to find out when the windows end */
        bench_wait(1 + (int)bench_random(200));
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
    }
    bq769x0_charge_reset(&b.d);
    b.chip.lost_cc = 0; /* the model counts those of the bring-up too */
    TEST_ASSERT_EQUAL(0, bq769x0_get_charge(&b.d)->uas);
    TEST_ASSERT_EQUAL(0, bq769x0_get_charge(&b.d)->results);
    TEST_ASSERT_EQUAL(0, bq769x0_get_charge(&b.d)->missed);
}

/* Charge that flowed up to the end of the last window that was fetched, in uAs, by the world. */
static double flowed, volts, fetched_flow;

static void flow(double ms)
{
    flowed += volts / 5000e-6 * ms * 1e3; /* A ms = 1e3 uAs */
    bench_wait(ms);
}

/* proves: X0-SEQ-26, X0-CC-02, X0-CC-04, X0-CC-09, X0-CC-13, X0-AMB-27, X0-AMB-99 */
static void test_no_window_is_lost_under_a_wild_current(void)
{
    int k, n;
    for (k = 0; k < 15; k++) {
        uint64_t end;
        running(sim_x0_part_at(k)->name);
        flowed = volts = 0;
        end = b.chip.now + 60000 * MS;
        while (b.chip.now < end) {
            int steps = 1 + (int)bench_random(5);
            for (n = 0; n < steps; n++) {                            /* 5..175 ms between two scans */
                volts = ((double)bench_random(2000) - 1000) * 25e-6; /* -25..25 mV = -5..5 A */
                (void)sim_x0_set_sense(&b.chip, volts);
                flow(5 + (int)bench_random(31));
            }
            volts = 0; /* transfers take their own time */
            (void)sim_x0_set_sense(&b.chip, 0);
            TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        }
        for (n = 0; n < 3; n++) { /* two windows of nothing */
            bench_wait(200);
            TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        }
        TEST_ASSERT_INT_WITHIN(3, 242, bq769x0_get_charge(&b.d)->results);
        TEST_ASSERT_EQUAL(0, b.chip.lost_cc);
        TEST_ASSERT_EQUAL(0, bq769x0_get_charge(&b.d)->missed);
        fetched_flow = (double)bq769x0_get_charge(&b.d)->uas;
        /* half a code a window, and the host measures windows to a millisecond or two: 240 x 0.4 mAs */
        TEST_ASSERT_INT_WITHIN(300000 + 60000, (int)flowed, (int)fetched_flow);
        NO_MISUSE();
    }
}

/* Scans at their leisure, but never so late that a result is replaced: nothing is missed, ever. */
/* proves: X0-SEQ-26, X0-SEQ-21, X0-CC-09 */
static void test_nothing_is_missed_when_the_host_is_in_time(void)
{
    static const char *const name[3] = {"bq7692000", "bq7693003", "bq7694003"};
    int k, n;
    for (k = 0; k < 3; k++) {
        running(name[k]);
        for (n = 0; n < 4000; n++) {
            bench_wait(1 + (int)bench_random(220));
            TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        }
        TEST_ASSERT_EQUAL(0, b.chip.lost_cc);
        TEST_ASSERT_EQUAL(0, bq769x0_get_charge(&b.d)->missed);
        NO_MISUSE();
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_no_window_is_lost_under_a_wild_current);
    RUN_TEST(test_nothing_is_missed_when_the_host_is_in_time);
    return UNITY_END();
}
