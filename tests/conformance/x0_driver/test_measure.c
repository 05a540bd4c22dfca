/* SPDX-License-Identifier: Apache-2.0 */
/* The measurement cycle as it shows on the bus and in time: order, age, doubtful values, what arrives
 * meanwhile. */
#include "bench.h"
#include "rows.h"

void setUp(void)
{
}
void tearDown(void)
{
}

static bool covers(const bench_entry *e, unsigned reg)
{
    return e->read > 0 && e->reg <= reg && reg < (unsigned)e->reg + e->read;
}

/* proves: X0-SEQ-21, X0-SEQ-22, X0-I2C-21, X0-AMB-19, X0-I2C-08, X0-I2C-10, X0-AMB-82, X0-AMB-83, X0-CC-04 */
static void test_order_of_a_cycle(void)
{
    int k, i;
    for (k = 0; k < 15; k++) {
        uint64_t first, n;
        bool fetched = false;
        bench_up(sim_x0_part_at(k)->name);
        for (i = 0; i < 12; i++) {
            unsigned reg;
            bench_serve(260, 260);
            TEST_ASSERT_TRUE(bq769x0_alert_pending(&b.d));
            first = b.count;
            TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
            TEST_ASSERT_EQUAL(0, bench_log(first)->reg);
            TEST_ASSERT_EQUAL(1, bench_log(first)->read);
            for (reg = 0x0c; reg < 0x0c + 2u * b.chip.part->cells; reg++) {
                unsigned hits = 0;
                for (n = first; n < b.count; n++)
                    hits += covers(bench_log(n), reg);
                TEST_ASSERT_EQUAL(1, hits);
            }
            for (n = first, fetched = false; n < b.count; n++) {
                const bench_entry *e = bench_log(n);
                TEST_ASSERT_TRUE(e->read == 0 || e->restart); /* always with its pointer */
                TEST_ASSERT_FALSE(covers(e, 0x0d) && !covers(e, 0x0c));
                fetched = fetched || (covers(e, 0x32) && covers(e, 0x33));
                if (e->wrote > 0 && e->reg == 0) {
                    TEST_ASSERT_EQUAL_HEX8(0x80, e->data[0]);
                    TEST_ASSERT_TRUE(fetched); /* fetch first, clear second */
                }
            }
            TEST_ASSERT_FALSE(bq769x0_alert_pending(&b.d));
        }
        NO_MISUSE();
    }
}

/* A ramp runs while scans come at any phase: what is called valid was true at an instant its age admits, for
   every cell of the picture, also when the part publishes in the middle of the reading. */
/* proves: X0-SCH-11, X0-AMB-18, X0-AMB-19, X0-AMB-100, X0-SEQ-23, X0-TIM-07 */
static void test_age_covers_the_truth(void)
{
    static const char *const name[3] = {"bq7692000", "bq7693003", "bq7694003"};
    int k, n;
    for (k = 0; k < 3; k++) {
        uint64_t t0;
        bench_up(name[k]);
        t0 = b.chip.now;
        for (n = 0; n < 20000; n++) { /* 0.1 mV per ms for 40 s, in steps of 2 ms */
            double ms = (double)(b.chip.now - t0) / 1e6;
            int i;
            for (i = 1; i <= b.chip.part->cells; i++)
                (void)sim_x0_set_cell(&b.chip, i, 3.0 + 1e-5 * ms);
            if (bench_random(40) == 0) {
                TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
                ms = (double)(b.chip.now - t0) / 1e6;
                for (i = 0; i < b.chip.part->cells; i++) {
                    double truth_ms = (b.cells[i].mv - 3000.0) * 100.0;
                    TEST_ASSERT_EQUAL(BQ_Q_VALID, b.cells[i].quality);
                    if (ms > 1000.0)
                        TEST_ASSERT_TRUE(truth_ms < ms + 150.0 && truth_ms > ms - b.module.age_ms - 150.0);
                }
                TEST_ASSERT_TRUE(b.module.age_ms >= 250 && b.module.age_ms < 300);
            }
            bench_wait(2);
        }
        NO_MISUSE();
    }
}

/* proves: X0-ADC-09, X0-ELEC-03, X0-SEQ-23, X0-UV-08, X0-AMB-40 */
static void test_doubtful_and_dead_cells(void)
{
    static const struct {
        double volts;
        uint8_t must, never;
    } point[] = {
        {1.99, BQ_Q_VALID | BQ_Q_RANGE, BQ_Q_OPEN_WIRE},
        {2.01, BQ_Q_VALID, BQ_Q_RANGE},
        {4.99, BQ_Q_VALID, BQ_Q_RANGE},
        {5.01, BQ_Q_VALID | BQ_Q_RANGE, BQ_Q_OPEN_WIRE},
        {0.505, BQ_Q_RANGE, BQ_Q_OPEN_WIRE},
        {0.49, BQ_Q_OPEN_WIRE, BQ_Q_VALID},
        {0.0, BQ_Q_OPEN_WIRE, BQ_Q_VALID},
        {6.5, BQ_Q_RANGE, BQ_Q_VALID},
    };
    int k, i;
    size_t p;
    for (k = 0; k < 15; k++) {
        bench_up(sim_x0_part_at(k)->name);
        for (p = 0; p < sizeof point / sizeof point[0]; p++)
            for (i = 1; i <= b.chip.part->cells; i += 4) {
                uint8_t q;
                (void)sim_x0_set_cell(&b.chip, i, point[p].volts);
                bench_wait(260);
                TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
                q = b.cells[i - 1].quality; /* either word for "doubtful" will do */
                q = (uint8_t)(q & BQ_Q_OUTSIDE ? (q & ~BQ_Q_OUTSIDE) | BQ_Q_RANGE : q);
                TEST_ASSERT_EQUAL_HEX8(point[p].must, q & point[p].must);
                TEST_ASSERT_EQUAL_HEX8(0, q & point[p].never);
                TEST_ASSERT_EQUAL((point[p].must & BQ_Q_OPEN_WIRE) != 0,
                                  (b.module.faults & BQ_F_OPEN_WIRE) != 0);
                (void)sim_x0_set_cell(&b.chip, i, 3.6);
                bench_wait(260);
                TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
                TEST_ASSERT_EQUAL(BQ_Q_VALID, b.cells[i - 1].quality);
            }
        NO_MISUSE();
    }
}

static uint64_t strike_at;
static int strike_kind;

static void strike(bench *x)
{
    if (x->count + 1 != strike_at)
        return;
    if (strike_kind == 0) {
        (void)sim_x0_strike_xready(&x->chip);
    } else if (strike_kind == 1) {
        (void)sim_x0_set_sense(&x->chip, -0.150);
        sim_x0_advance(&x->chip, 200000);
        (void)sim_x0_set_sense(&x->chip, 0);
    } else {
        sim_x0_advance(&x->chip, 240 * MS); /* so that a result of the counter comes as well */
    }
}

/* Whatever comes between two transfers of a cycle stays visible on ALERT, and a few more rounds drain it. */
/* proves: X0-SEQ-24, X0-ALERT-07, X0-AMB-52, X0-AMB-58, X0-BIT-09, X0-CC-09 */
static void test_events_in_the_middle_of_a_cycle(void)
{
    int step;
    for (strike_kind = 0; strike_kind < 3; strike_kind++)
        for (step = 1; step <= 5; step++) {
            int rounds;
            uint32_t missed;
            bench_up("bq7694003");
            bench_serve(2750, 250);
            b.chip.lost_cc = 0;
            missed = bq769x0_get_charge(&b.d)->missed;
            strike_at = b.count + (uint64_t)step;
            b.hook = strike;
            for (rounds = 0; rounds < 4; rounds++)
                TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
            b.hook = NULL;
            if (strike_kind < 2) {
                TEST_ASSERT_EQUAL_HEX16(strike_kind == 0 ? BQ_F_MEMORY : BQ_F_SHORT, b.module.faults);
                TEST_ASSERT_TRUE(bq769x0_alert_pending(&b.d)); /* not cleared unseen */
            } else {
                TEST_ASSERT_FALSE(bq769x0_alert_pending(&b.d));
                bench_wait(250); /* one that was cleared unseen shows by the next */
                TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
                TEST_ASSERT_EQUAL(b.chip.lost_cc, bq769x0_get_charge(&b.d)->missed - missed);
            }
            NO_MISUSE();
        }
}

/* proves: X0-SEQ-27, X0-ALERT-06, X0-CC-05, X0-MODE-15 */
static void test_without_the_counter_alert_means_faults(void)
{
    int k, n;
    for (k = 0; k < 15; k++) {
        uint32_t took;
        bench_part(sim_x0_part_at(k)->name, NULL);
        b.cfg.counter_off = true;
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        bench_cells(3.7);
        for (n = 0; n < 40; n++) {
            bench_wait(250);
            TEST_ASSERT_FALSE(bq769x0_alert_pending(&b.d));
            TEST_ASSERT_EQUAL(BQ_OK, bench_scan()); /* the host's timer, not ALERT */
            TEST_ASSERT_EQUAL(0, b.sample.current_valid);
            TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
        }
        TEST_ASSERT_INT_WITHIN(1, 3700, b.cells[0].mv);
        TEST_ASSERT_EQUAL(BQ_OK, bench_apply(true, true, 0));
        TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
        (void)sim_x0_set_alert_ext(&b.chip, true);
        TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip)); /* never masked: at once */
        TEST_ASSERT_TRUE(bq769x0_alert_pending(&b.d));
        (void)sim_x0_set_alert_ext(&b.chip, false);
        bench_serve(250, 250);
        TEST_ASSERT_EQUAL_HEX16(BQ_F_CHAIN, b.module.faults);
        took = bench_until(true, true, 20000);
        TEST_ASSERT_TRUE(took < 20000);
        NO_MISUSE();
    }
}

/* With the counter on, what hides the override is CC_READY alone, and no longer than one period. */
/* proves: X0-ALERT-06, X0-SEQ-37 */
static void test_the_counter_hides_the_override_for_one_period_only(void)
{
    int phase;
    for (phase = 0; phase < 250; phase += 7) {
        bench_up("bq7693000");
        bench_serve(2750, 250);
        TEST_ASSERT_TRUE(bench_until(true, true, 1000) < 1000);
        bench_wait(phase);
        (void)sim_x0_set_alert_ext(&b.chip, true);
        bench_serve(250, 250);
        TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
        bench_serve(250, 250);
        TEST_ASSERT_EQUAL_HEX16(BQ_F_CHAIN, b.module.faults);
        NO_MISUSE();
    }
}

/* A group that bleeds is measured in short windows: noisier, still true, and named in the picture. */
/* proves: X0-SCH-12, X0-AMB-59, X0-AMB-60, X0-AMB-101, X0-CB-07, X0-SEQ-40 */
static void test_measuring_while_balancing(void)
{
    sim_x0_options o;
    double sum[2][15] = {{0}};
    int n, i, on;
    memset(&o, 0, sizeof o);
    o.noise_uv_rms = 2000;
    for (on = 0; on < 2; on++) {
        bench_part("bq7694003", &o);
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        b.action.balance[0] = on ? 0x0004 : 0; /* one cell of the first group */
        bench_serve(750, 250);                 /* the scan in which it changed is skipped */
        for (n = 0; n < 400; n++) {
            bench_serve(250, 250);
            TEST_ASSERT_EQUAL_HEX16(on ? 0x0004 : 0, b.module.balancing);
            for (i = 0; i < 15; i++) {
                double off = b.cells[i].mv - 3600.0;
                TEST_ASSERT_TRUE(off > -30 && off < 30);
                sum[on][i] += off * off;
            }
        }
        NO_MISUSE();
    }
    for (i = 0; i < 5; i++)
        TEST_ASSERT_TRUE(sum[1][i] > 2 * sum[0][i]); /* all five of the group */
    for (i = 5; i < 15; i++)
        TEST_ASSERT_TRUE(sum[1][i] < 2 * sum[0][i]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_order_of_a_cycle);
    RUN_TEST(test_age_covers_the_truth);
    RUN_TEST(test_doubtful_and_dead_cells);
    RUN_TEST(test_events_in_the_middle_of_a_cycle);
    RUN_TEST(test_without_the_counter_alert_means_faults);
    RUN_TEST(test_the_counter_hides_the_override_for_one_period_only);
    RUN_TEST(test_measuring_while_balancing);
    return UNITY_END();
}
