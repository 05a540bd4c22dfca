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
    bench_up(name);
    bench_serve(1000, 250);
    bq769x0_charge_reset(&b.d);
    b.chip.lost_cc = 0; /* the model counts those of the bring-up too */
    TEST_ASSERT_EQUAL(0, bq769x0_get_charge(&b.d)->uas);
    TEST_ASSERT_EQUAL(0, bq769x0_get_charge(&b.d)->results);
    TEST_ASSERT_EQUAL(0, bq769x0_get_charge(&b.d)->missed);
}

/* proves: X0-SEQ-26, X0-AMB-99 */
static void test_missed_windows_are_counted_and_filled_with_the_mean_of_their_neighbours(void)
{
    int lost;
    for (lost = 2; lost < 40; lost++) {
        int64_t before;
        running("bq7692003");
        (void)sim_x0_set_sense(&b.chip, 0.005); /* 1 A */
        bench_serve(1000, 250);
        bq769x0_charge_reset(&b.d);
        bench_serve(250, 250);
        before = bq769x0_get_charge(&b.d)->uas;
        TEST_ASSERT_INT_WITHIN(5000, 250000, (int)before);
        (void)sim_x0_set_sense(&b.chip, 0.015); /* 3 A at the other end of the gap */
        bench_wait(250.0 * lost);
        bench_serve(250, 250);
        TEST_ASSERT_EQUAL(lost, bq769x0_get_charge(&b.d)->missed);
        /* lost windows at 2 A, the fetched one at 3 A */
        TEST_ASSERT_INT_WITHIN(60000 + 4000 * lost, 500000 * lost + 750000,
                               (int)(bq769x0_get_charge(&b.d)->uas - before));
        NO_MISUSE();
    }
}

/* proves: X0-CC-03, X0-PIN-05, X0-AMB-21, X0-AMB-22 */
static void test_sign(void)
{
    int inverted;
    for (inverted = 0; inverted < 2; inverted++) {
        bench_part("bq7693003", NULL);
        b.cfg.invert_current = inverted;
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        (void)sim_x0_set_sense(&b.chip, 0.190); /* a charge pulse beyond every limit is no overcurrent */
        bench_serve(1000, 250);
        TEST_ASSERT_INT_WITHIN(2, inverted ? -38000 : 38000, b.sample.current_ma);
        TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
        (void)sim_x0_set_sense(&b.chip, -0.030);
        bench_serve(1000, 250);
        TEST_ASSERT_INT_WITHIN(2, inverted ? 6000 : -6000, b.sample.current_ma);
        NO_MISUSE();
    }
}

/* A pulse shorter than a window is its mean, wherever the window lies against the scan of the cells. */
/* proves: X0-CC-02, X0-AMB-27, X0-SCH-11 */
static void test_a_result_is_the_mean_of_its_window(void)
{
    int phase;
    for (phase = 0; phase < 250; phase += 23) {
        bench_up("bq7693000");
        bench_wait(phase);
        TEST_ASSERT_EQUAL(BQ_OK, bench_start()); /* the counter begins anew, at another phase */
        bench_serve(500, 250);
        sim_x0_advance(&b.chip, b.chip.t_cc_end - b.chip.now);
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        sim_x0_advance(&b.chip, b.chip.t_cc_end - b.chip.now);
        (void)sim_x0_set_sense(&b.chip, 0.010);
        bench_wait(100);
        (void)sim_x0_set_sense(&b.chip, -0.002);
        bench_wait(150);
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        TEST_ASSERT_INT_WITHIN(2, 560, b.sample.current_ma); /* (100 x 2 A - 150 x 0.4 A) / 250 */
        TEST_ASSERT_INT_WITHIN(1, 3600, b.cells[0].mv);
        NO_MISUSE();
    }
}

/* proves: X0-CC-11, X0-AMB-23 */
static void test_saturation_is_no_current(void)
{
    static const struct {
        double code;
        bool valid;
    } point[] = {{31989, true},  {31991, false},  {40000, false},
                 {-31989, true}, {-31991, false}, {-40000, false}};
    size_t p;
    for (p = 0; p < sizeof point / sizeof point[0]; p++) {
        bench_up("bq7692003");
        (void)sim_x0_set_sense(&b.chip, point[p].code * 8.44e-6);
        bench_serve(1000, 250);
        TEST_ASSERT_EQUAL(point[p].valid, b.sample.current_valid);
    }
}

/* proves: X0-SEQ-25, X0-AMB-15 */
static void test_a_counter_that_stands_is_a_fault_with_the_fets_off(void)
{
    int k;
    for (k = 0; k < 15; k++) {
        uint64_t from;
        bool seen = false;
        bench_up(sim_x0_part_at(k)->name);
        bench_serve(2750, 250);
        TEST_ASSERT_TRUE(bench_until(true, true, 1000) < 1000);
        bench_serve(250, 250);
        b.chip.t_cc_end = UINT64_MAX; /* no result will ever come of this window */
        b.chip.due = 0;
        b.chip.reg[0] &= 0x7f;
        from = b.chip.now;
        while (!seen && b.chip.now < from + 1200 * MS) {
            bench_wait(50);
            TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
            seen = (b.module.faults & BQ_F_LOCKUP) != 0;
            TEST_ASSERT_FALSE(seen && b.chip.now < from + 350 * MS);
        }
        TEST_ASSERT_TRUE(seen);
        TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
        TEST_ASSERT_TRUE(bench_until(true, true, 10000) < 10000); /* it was started again */
        TEST_ASSERT_EQUAL_HEX8(0x43, sim_x0_peek(&b.chip, 0x05));
        NO_MISUSE();
    }
}

/* proves: X0-SEQ-25 */
static void test_a_converter_that_stands_is_found_and_a_quiet_pack_is_not_taken_for_one(void)
{
    sim_x0_options o;
    bool seen = false;
    int n;
    memset(&o, 0, sizeof o);
    o.noise_uv_rms = 300;
    bench_part("bq7694003", &o);
    b.cfg.frozen_scans = 20;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    for (n = 0; n < 2000; n++) {
        bench_serve(250, 250);
        TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
    }
    sim_x0_freeze(&b.chip, true);
    for (n = 0; n < 25 && !seen; n++) {
        bench_serve(250, 250);
        seen = (b.module.faults & BQ_F_LOCKUP) != 0;
    }
    TEST_ASSERT_TRUE(seen && n >= 15);
    TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
    TEST_ASSERT_FALSE(b.cells[0].quality & BQ_Q_VALID);
    NO_MISUSE();
}

/* proves: X0-SEQ-46, X0-CC-05, X0-AMB-24 */
static void test_one_conversion_at_a_time(void)
{
    int k, n;
    for (k = 0; k < 15; k++) {
        bench_part(sim_x0_part_at(k)->name, NULL);
        b.cfg.counter_off = true;
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        TEST_ASSERT_EQUAL(BQ_OK, bench_apply(true, true, 0));
        for (n = -3; n <= 3; n++) {
            uint64_t from = b.chip.now;
            (void)sim_x0_set_sense(&b.chip, n * 0.010);
            TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_oneshot(&b.d));
            TEST_ASSERT_EQUAL(BQ_OK, bench_run(2000));
            TEST_ASSERT_TRUE(b.chip.now - from >= 250 * MS && b.chip.now - from < 600 * MS);
            TEST_ASSERT_EQUAL(BQ_OK, bench_picture());
            TEST_ASSERT_TRUE(b.sample.current_valid);
            TEST_ASSERT_INT_WITHIN(2, n * 2000, b.sample.current_ma);
            TEST_ASSERT_EQUAL_HEX8(0x03,
                                   sim_x0_peek(&b.chip, 0x05)); /* FETs as before, everything else off */
            TEST_ASSERT_EQUAL_HEX8(0x00, sim_x0_peek(&b.chip, 0x00));
        }
        NO_MISUSE();
    }
}

/* proves: X0-SEQ-46 */
static void test_one_shot_that_never_ends_is_given_up_after_three_attempts(void)
{
    uint64_t from, n;
    unsigned attempts = 0;
    bench_part("bq7692003", NULL);
    b.cfg.counter_off = true;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    b.chip.reg[0] |= 0x80; /* a result that nobody asked for must not pass as the answer */
    b.hook = NULL;
    n = from = b.count;
    TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_oneshot(&b.d));
    TEST_ASSERT_EQUAL(BQ_OK, bench_run(3000));
    TEST_ASSERT_TRUE(bench_writes(from, 0, NULL) >= 2);
    from = b.count;
    TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_oneshot(&b.d));
    for (n = 0; n < 400; n++) {
        bq_status s = bq769x0_poll(&b.d, NULL);
        if (s != BQ_PENDING) {
            TEST_ASSERT_EQUAL(BQ_E_TIMEOUT, s);
            break;
        }
        b.chip.t_cc_end = UINT64_MAX; /* whatever was begun never ends */
        b.chip.due = 0;
        bench_wait(10);
    }
    for (n = from; n < b.count; n++)
        attempts += bench_log(n)->wrote == 1 && bench_log(n)->reg == 5 && (bench_log(n)->data[0] & 0x20);
    TEST_ASSERT_EQUAL(3, attempts);
}

/* A FET may be switched off at any time while a conversion runs: the part does it by itself, and the job
 * ends. */
/* proves: X0-SEQ-46 */
static void test_a_short_circuit_during_one_conversion(void)
{
    bench_part("bq7693003", NULL);
    b.cfg.counter_off = true;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
    TEST_ASSERT_EQUAL(BQ_OK, bench_apply(true, true, 0));
    TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_oneshot(&b.d));
    (void)bq769x0_poll(&b.d, NULL);
    (void)sim_x0_set_sense(&b.chip, -0.150);
    bench_wait(0.3);
    (void)sim_x0_set_sense(&b.chip, 0);
    (void)bench_run(5000);
    TEST_ASSERT_FALSE(sim_x0_dsg(&b.chip)); /* and the driver did not turn it on again */
    TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
    TEST_ASSERT_EQUAL_HEX16(BQ_F_SHORT, b.module.faults);
    TEST_ASSERT_FALSE(sim_x0_chg(&b.chip));
    NO_MISUSE();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_missed_windows_are_counted_and_filled_with_the_mean_of_their_neighbours);
    RUN_TEST(test_sign);
    RUN_TEST(test_a_result_is_the_mean_of_its_window);
    RUN_TEST(test_saturation_is_no_current);
    RUN_TEST(test_a_counter_that_stands_is_a_fault_with_the_fets_off);
    RUN_TEST(test_a_converter_that_stands_is_found_and_a_quiet_pack_is_not_taken_for_one);
    RUN_TEST(test_one_conversion_at_a_time);
    RUN_TEST(test_one_shot_that_never_ends_is_given_up_after_three_attempts);
    RUN_TEST(test_a_short_circuit_during_one_conversion);
    return UNITY_END();
}
