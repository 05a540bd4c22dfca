/* SPDX-License-Identifier: Apache-2.0 */
/* FETs: what must be known before one comes on, read-back, refusals, both ways of a warm start, calibration.
 */
#include "bench.h"

void setUp(void)
{
}
void tearDown(void)
{
}

static void up(const char *name)
{
    bench_up(name);
    TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
}

/* proves: X0-FET-01, X0-FET-13, X0-SEQ-19 */
static void test_four_states_verified(void)
{
    int k, n;
    for (k = 0; k < 15; k++) {
        up(sim_x0_part_at(k)->name);
        for (n = 0; n < 40; n++) {
            bool chg = bench_random(2), dsg = bench_random(2);
            uint64_t from = b.count, i;
            uint8_t before = sim_x0_peek(&b.chip, 5);
            bool written = false, verified = false;
            TEST_ASSERT_EQUAL(BQ_OK, bench_apply(chg, dsg, 0));
            TEST_ASSERT_EQUAL(chg, sim_x0_chg(&b.chip));
            TEST_ASSERT_EQUAL(dsg, sim_x0_dsg(&b.chip));
            for (i = from; i < b.count; i++) {
                const bench_entry *e = bench_log(i);
                verified = verified || (written && e->wrote == 0 && e->reg <= 5 && e->reg + e->read > 5);
                written = written || (e->wrote > 0 && e->reg == 5);
            }
            if (before != sim_x0_peek(&b.chip, 5))
                TEST_ASSERT_TRUE(written && verified);
        }
        NO_MISUSE();
    }
}

/* proves: X0-SEQ-05, X0-OCD-10, X0-XRDY-04, X0-SEQ-18 */
static void test_nothing_comes_on_before_everything_is_known(void)
{
    int bit;
    bench_part("bq7692003", NULL);
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_E_STATE, bench_apply(true, true, 0)); /* no bring-up */
    TEST_ASSERT_EQUAL(BQ_E_STATE, bq769x0_begin_scan(&b.d));
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    NO_MISUSE();
    for (bit = 0; bit < 6; bit++) { /* a bit from before the bring-up whose cause is still there */
        up("bq7692003");
        if (bit <= 1)
            (void)sim_x0_set_sense(&b.chip, -0.150);
        if (bit == 2 || bit == 3)
            (void)sim_x0_set_cell(&b.chip, 1, bit == 2 ? 4.3 : 2.6);
        if (bit == 4)
            (void)sim_x0_set_alert_ext(&b.chip, true);
        if (bit == 5)
            (void)sim_x0_strike_xready(&b.chip);
        bench_wait(2500);
        TEST_ASSERT_TRUE(b.chip.reg[0] >> bit & 1);
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        (void)bench_start();
        (void)bench_scan();
        (void)bench_apply(true, true, 0);
        if (bit != 3)
            TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
        if (bit != 2)
            TEST_ASSERT_FALSE(sim_x0_dsg(&b.chip));
        NO_MISUSE();
    }
}

static int raise_at;

static void raise_before_read_back(bench *x)
{
    if (--raise_at == 0)
        (void)sim_x0_strike_xready(&x->chip);
}

/* A fault at every moment of a switch-on: the FETs are off at the end and the next scan names it. */
/* proves: X0-FET-13, X0-FET-11, X0-AMB-50 */
static void test_a_fault_at_every_moment_of_switching_on(void)
{
    int k, n;
    for (k = 0; k < 15; k++)
        for (n = 1; n <= 5; n++) {
            up(sim_x0_part_at(k)->name);
            raise_at = n;
            b.hook = raise_before_read_back;
            TEST_ASSERT_EQUAL(BQ_E_VERIFY, bench_apply(true, true, 0x5));
            b.hook = NULL;
            if (raise_at > 0)
                (void)sim_x0_strike_xready(&b.chip);
            TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
            TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
            TEST_ASSERT_EQUAL_HEX16(BQ_F_MEMORY, b.module.faults);
            TEST_ASSERT_EQUAL(BQ_E_STATE, bench_apply(true, true, 0x5));
            TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
            TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&b.chip));
            NO_MISUSE();
        }
}

static void refuse(bench *x)
{
    x->chip.reg[5] &= 0xfc;
}

/* The bit does not stay and no fault bit says why: an error, not a success. */
/* proves: X0-FET-13 */
static void test_a_fet_that_does_not_come_on(void)
{
    up("bq7693003");
    b.hook = refuse;
    TEST_ASSERT_EQUAL(BQ_E_VERIFY, bench_apply(true, true, 0));
    b.hook = NULL;
    TEST_ASSERT_EQUAL(BQ_OK, bench_apply(true, true, 0));
    TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
    NO_MISUSE();
}

/* The host's policy stays the host's: what it does not want does not come on after a recovery. */
/* proves: X0-FET-11, X0-SEQ-29 */
static void test_recovery_follows_the_policy_of_the_host(void)
{
    int policy;
    for (policy = 0; policy < 4; policy++) {
        int n;
        up("bq7692003");
        b.action.charge_on = policy & 1;
        b.action.discharge_on = policy & 2;
        bench_serve(500, 250);
        (void)sim_x0_set_sense(&b.chip, -0.150);
        bench_wait(0.2);
        (void)sim_x0_set_sense(&b.chip, 0);
        for (n = 0; n < 60; n++) {
            bench_serve(250, 250);
            TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) && !(policy & 1));
            TEST_ASSERT_FALSE(sim_x0_dsg(&b.chip) && !(policy & 2));
        }
        TEST_ASSERT_EQUAL((policy & 1) != 0, sim_x0_chg(&b.chip));
        TEST_ASSERT_EQUAL((policy & 2) != 0, sim_x0_dsg(&b.chip));
        NO_MISUSE();
    }
}

/* A host that is reset keeps or drops the FETs; kept ones stay on all the way, also between two writes. */
static bool watched_off;

static void watch(bench *x)
{
    watched_off = watched_off || !sim_x0_chg(&x->chip) || !sim_x0_dsg(&x->chip);
}

/* proves: X0-SEQ-06, X0-MODE-18, X0-MODE-15 */
static void test_warm_start_keeps_or_drops(void)
{
    int k, keep;
    for (k = 0; k < 15; k++)
        for (keep = 0; keep < 2; keep++) {
            up(sim_x0_part_at(k)->name);
            TEST_ASSERT_EQUAL(BQ_OK, bench_apply(true, true, 0x5));
            b.cfg.keep_fets = keep;
            watched_off = false;
            b.hook = watch;
            TEST_ASSERT_EQUAL(BQ_OK, bench_init());
            TEST_ASSERT_EQUAL(BQ_OK, bench_start());
            TEST_ASSERT_EQUAL(!keep, watched_off);
            bench_serve(500, 250);
            if (keep)
                TEST_ASSERT_TRUE(b.cells[0].quality & BQ_Q_VALID);
            b.hook = NULL;
            bench_serve(3000, 250);
            TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
            TEST_ASSERT_EQUAL(1, b.rises); /* never booted again */
            NO_MISUSE();
        }
}

/* proves: X0-SEQ-45, X0-ADC-16, X0-ADC-17, X0-AMB-20, X0-NUM-116 */
static void test_calibration(void)
{
    int k;
    for (k = 0; k < 15; k++) {
        uint32_t sum;
        int n;
        bench_part(sim_x0_part_at(k)->name, NULL);
        b.cfg.cells = (uint8_t)(b.cfg.inputs == 5 ? 4 : b.cfg.inputs - 2); /* in-use cells only */
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        TEST_ASSERT_EQUAL(BQ_E_STALE, bq769x0_calibrate(&b.d, 3600u * b.cfg.cells));
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        TEST_ASSERT_EQUAL(3600, b.cells[0].mv); /* GAIN2 = 1 until told otherwise */
        sum = b.module.stack_mv;
        for (n = 960; n <= 1040; n += 2) {
            uint32_t measured = sum * (uint32_t)n / 1000u;
            uint16_t before = (uint16_t)(bench_picture() == BQ_OK ? b.cells[0].mv : 0);
            bq_status s = bq769x0_calibrate(&b.d, measured);
            if (n >= 971 && n <= 1029) {
                TEST_ASSERT_EQUAL(BQ_OK, s);
                TEST_ASSERT_EQUAL(BQ_OK, bench_picture());
                TEST_ASSERT_INT_WITHIN(1, 3600 * n / 1000, b.cells[0].mv);
                TEST_ASSERT_INT_WITHIN(b.cfg.cells, (int)measured, (int)b.module.stack_mv);
            } else if (n < 970 || n > 1030) {
                TEST_ASSERT_EQUAL(BQ_E_RANGE, s);
                TEST_ASSERT_EQUAL(BQ_OK, bench_picture());
                TEST_ASSERT_EQUAL(before, b.cells[0].mv);
            }
        }
        TEST_ASSERT_EQUAL_HEX8(bq769x0_get_achieved(&b.d)->ov_trip, sim_x0_peek(&b.chip, 9));
        bench_serve(1500, 250); /* thresholds are not corrected by it */
        TEST_ASSERT_EQUAL_HEX8(bq769x0_get_achieved(&b.d)->ov_trip, sim_x0_peek(&b.chip, 9));
        TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
        TEST_ASSERT_EQUAL(BQ_OK, bq769x0_calibrate(&b.d, sum));
        TEST_ASSERT_FALSE(bq769x0_calibration_due(&b.d));
        (void)sim_x0_set_cell(&b.chip, 1, 3.51);
        bench_wait(260);
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        TEST_ASSERT_FALSE(bq769x0_calibration_due(&b.d));
        (void)sim_x0_set_cell(&b.chip, 1, 3.49);
        bench_wait(260);
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        TEST_ASSERT_TRUE(bq769x0_calibration_due(&b.d));
        NO_MISUSE();
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_four_states_verified);
    RUN_TEST(test_nothing_comes_on_before_everything_is_known);
    RUN_TEST(test_a_fault_at_every_moment_of_switching_on);
    RUN_TEST(test_a_fet_that_does_not_come_on);
    RUN_TEST(test_recovery_follows_the_policy_of_the_host);
    RUN_TEST(test_warm_start_keeps_or_drops);
    RUN_TEST(test_calibration);
    return UNITY_END();
}
