/* SPDX-License-Identifier: Apache-2.0 */
/* Last good values, a counter that survives a failed one-shot, groups with a supply outside its range. */
#include "bench.h"
#include "rows.h"

void setUp(void)
{
}
void tearDown(void)
{
}

static void put(unsigned reg, unsigned value)
{
    b.chip.reg[reg] = (uint8_t)(value >> 8);
    b.chip.reg[reg + 1] = (uint8_t)value;
}

/* A picture that its own stack code contradicts is refused whole: every reading keeps its last good value. */
/* proves: X0-BAT-05, X0-SEQ-23 */
static void test_a_refused_picture_leaves_the_old_values(void)
{
    unsigned i;
    bench_up("bq7694003");
    bench_serve(2750, 250);
    sim_x0_freeze(&b.chip, true);
    for (i = 0; i < 5; i++)
        put(0x0c + 2 * i, 0x3800);
    put(0x2c, 0x0500);
    (void)bench_scan();
    for (i = 0; i < 15; i++) {
        TEST_ASSERT_FALSE(b.cells[i].quality & BQ_Q_VALID);
        TEST_ASSERT_INT_WITHIN(1, 3600, b.cells[i].mv);
    }
    TEST_ASSERT_INT_WITHIN(1, 250, b.temps[0].dc);
    TEST_ASSERT_INT_WITHIN(15, 15 * 3600, (int)b.module.stack_mv);
    sim_x0_freeze(&b.chip, false);
    bench_wait(500);
    TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
    TEST_ASSERT_EQUAL(BQ_Q_VALID, b.cells[0].quality);
    NO_MISUSE();
}

/* proves: X0-XRDY-04, X0-AMB-66 */
static void test_an_internal_fault_leaves_the_old_values(void)
{
    sim_x0_options o;
    int n, i;
    memset(&o, 0, sizeof o);
    o.amb66_upper_zero = true;
    bench_part("bq7694003", &o);
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    bench_serve(2750, 250);
    (void)sim_x0_strike_xready(&b.chip);
    for (n = 0; n < 8; n++) {
        bench_serve(250, 250);
        for (i = 0; i < 15; i++) {
            TEST_ASSERT_INT_WITHIN(1, 3600, b.cells[i].mv);
            TEST_ASSERT_FALSE(b.cells[i].quality & (BQ_Q_VALID | BQ_Q_COMM));
            TEST_ASSERT_TRUE(b.cells[i].quality & BQ_Q_CHIP); /* it answers; it cannot be trusted */
        }
    }
    NO_MISUSE();
}

/* proves: X0-SEQ-46, X0-SEQ-20 */
static void test_the_counter_runs_again_after_a_failed_one_shot(void)
{
    int n;
    bench_up("bq7692003");
    bench_serve(2750, 250);
    TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_oneshot(&b.d));
    for (n = 0; n < 1000; n++) {
        bq_status s = bq769x0_poll(&b.d, NULL);
        if (s != BQ_PENDING) {
            TEST_ASSERT_EQUAL(BQ_E_TIMEOUT, s);
            break;
        }
        b.chip.t_cc_end = UINT64_MAX;
        b.chip.due = 0;
        bench_wait(10);
    }
    bench_serve(5000, 250);
    TEST_ASSERT_EQUAL_HEX8(0x40, sim_x0_peek(&b.chip, 5) & 0x7c);
    TEST_ASSERT_TRUE(b.sample.current_valid);
    NO_MISUSE();
}

/* proves: X0-ELEC-01, X0-AMB-97 */
static void test_a_group_outside_its_supply_range_is_warned_of(void)
{
    static const struct {
        double volts;
        bool warned;
    } point[4] = {{1.19, true}, {1.21, false}, {4.99, false}, {5.01, true}};
    int k, group, p, i;
    for (k = 0; k < 15; k++)
        for (group = 0; group < sim_x0_part_at(k)->cells / 5; group++)
            for (p = 0; p < 4; p++) {
                bench_part(sim_x0_part_at(k)->name, NULL);
                b.cfg.uv_mv = 1700;
                b.cfg.ov_mv = 4600;
                b.cfg.uv_delay_s = 16;
                b.cfg.ov_delay_s = 8;
                TEST_ASSERT_EQUAL(BQ_OK, bench_init());
                TEST_ASSERT_EQUAL(BQ_OK, bench_start());
                for (i = 1; i <= 5; i++)
                    (void)sim_x0_set_cell(&b.chip, 5 * group + i, point[p].volts);
                bench_wait(500);
                TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
                TEST_ASSERT_EQUAL(point[p].warned, (b.module.quality & BQ_Q_OUTSIDE) != 0);
                NO_MISUSE();
            }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_refused_picture_leaves_the_old_values);
    RUN_TEST(test_an_internal_fault_leaves_the_old_values);
    RUN_TEST(test_the_counter_runs_again_after_a_failed_one_shot);
    RUN_TEST(test_a_group_outside_its_supply_range_is_warned_of);
    return UNITY_END();
}
