/* SPDX-License-Identifier: Apache-2.0 */
/* How the driver is served: by ALERT or by a timer, on boards that lack a line, polled too often or too late,
 * through bq_afe, for hours; and one job at a time. */
#include "bench.h"

void setUp(void)
{
}
void tearDown(void)
{
}

/* Held back with a reason that the picture names; or both on, but for a fault that no scan has seen yet. */
static void applied(bq_status s)
{
    if (s == BQ_E_STATE)
        TEST_ASSERT_TRUE(b.module.faults != 0);
    else {
        TEST_ASSERT_EQUAL(BQ_OK, s);
        TEST_ASSERT_TRUE((b.chip.reg[0] & 0x3f) != 0 || (sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip)));
    }
}

/* A host that scans only when ALERT is high, looking at it every 5 ms. */
static unsigned by_alert(uint32_t ms)
{
    uint64_t end = b.chip.now + ms * MS;
    unsigned scans = 0;
    while (b.chip.now < end) {
        if (bq769x0_alert_pending(&b.d)) {
            TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
            TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_apply(&b.d, &b.action));
            applied(bench_run(2000));
            scans++;
        }
        bench_wait(5);
    }
    return scans;
}

/* proves: X0-SEQ-21, X0-ALERT-07, X0-AMB-51, X0-AMB-52, X0-CC-04, X0-CC-09 */
static void test_service_by_alert(void)
{
    int k;
    for (k = 0; k < 15; k++) {
        bench_up(sim_x0_part_at(k)->name);
        (void)by_alert(3000);
        b.chip.lost_cc = 0;
        bq769x0_charge_reset(&b.d);
        (void)sim_x0_set_sense(&b.chip, 0.005);
        TEST_ASSERT_INT_WITHIN(1, 80, (int)by_alert(20000)); /* once per result, no more */
        TEST_ASSERT_EQUAL(0, b.chip.lost_cc);
        TEST_ASSERT_EQUAL(0, bq769x0_get_charge(&b.d)->missed);
        TEST_ASSERT_INT_WITHIN(300000, 20000000, (int)bq769x0_get_charge(&b.d)->uas);
        (void)sim_x0_set_sense(&b.chip, 0);
        TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
        (void)sim_x0_set_cell(&b.chip, 2, 4.3);
        (void)by_alert(2500);
        TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, b.module.faults);
        TEST_ASSERT_FALSE(sim_x0_chg(&b.chip));
        (void)sim_x0_set_cell(&b.chip, 2, 3.6);
        (void)by_alert(8000);
        TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
        NO_MISUSE();
    }
}

/* proves: X0-SEQ-21, X0-ALERT-07 */
static void test_a_board_without_the_line_is_polled(void)
{
    bench_part("bq7693003", NULL);
    b.missing = 1u << (unsigned)BQ_LINE_ALERT;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    TEST_ASSERT_TRUE(bq769x0_alert_pending(&b.d)); /* always: poll */
    bench_serve(3000, 250);
    TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
    (void)sim_x0_strike_xready(&b.chip);
    bench_serve(500, 250);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_MEMORY, b.module.faults);
    NO_MISUSE();
}

/* Without the boot line only a part that is awake can be taken over. */
/* proves: X0-SEQ-03, X0-SEQ-06 */
static void test_a_board_without_the_boot_line(void)
{
    bench_part("bq7694003", NULL);
    b.missing = 1u << (unsigned)BQ_LINE_AFE_BOOT;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_TRUE(bench_start() < 0);
    TEST_ASSERT_EQUAL(0, b.rises);
    (void)sim_x0_boot(&b.chip, 3 * MS); /* a person with a button */
    bench_wait(2000);
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    bench_serve(3000, 250);
    TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
    NO_MISUSE();
}

static uint64_t before_poll;

/* The same life, polled every `us`; each poll starts at most one transfer. */
static uint64_t life(uint32_t us)
{
    uint64_t end, start_count;
    bench_part("bq7693000", NULL);
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_start(&b.d));
    start_count = b.count;
    end = b.chip.now + 20000 * MS;
    for (;;) {
        bq_status s;
        before_poll = b.count;
        s = bq769x0_poll(&b.d, NULL); /* no interest in the hint */
        TEST_ASSERT_TRUE(b.count - before_poll <= 1);
        if (s != BQ_PENDING) {
            TEST_ASSERT_EQUAL(BQ_OK, s);
            break;
        }
        TEST_ASSERT_TRUE(b.chip.now < end);
        sim_x0_advance(&b.chip, us * 1000ull);
    }
    TEST_ASSERT_EQUAL(BQ_OK, bq769x0_poll(&b.d, NULL)); /* idle: the last result again, and nothing happens */
    TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
    TEST_ASSERT_INT_WITHIN(1, 3600, b.cells[9].mv);
    NO_MISUSE();
    return b.count - start_count;
}

/* proves: X0-SEQ-01, X0-SEQ-02, X0-SEQ-04 */
static void test_polled_too_often_and_too_late(void)
{
    uint64_t often = life(7), late;
    TEST_ASSERT_TRUE(b.fall_ns - b.rise_ns >= 2 * MS && b.fall_ns - b.rise_ns < 10 * MS);
    late = life(900);
    TEST_ASSERT_TRUE(b.fall_ns - b.rise_ns >= 2 * MS && b.fall_ns - b.rise_ns < 10 * MS);
    TEST_ASSERT_TRUE(late <= often + 2 && often <= late + 60);
}

static void test_one_job_at_a_time(void)
{
    bq_action a;
    memset(&a, 0, sizeof a);
    bench_up("bq7692003");
    TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_scan(&b.d));
    TEST_ASSERT_EQUAL(BQ_E_BUSY, bq769x0_begin_scan(&b.d));
    TEST_ASSERT_EQUAL(BQ_E_BUSY, bq769x0_begin_apply(&b.d, &a));
    TEST_ASSERT_EQUAL(BQ_E_BUSY, bq769x0_begin_start(&b.d));
    TEST_ASSERT_EQUAL(BQ_E_BUSY, bq769x0_begin_self_test(&b.d));
    TEST_ASSERT_EQUAL(BQ_E_BUSY, bq769x0_begin_ship(&b.d));
    TEST_ASSERT_EQUAL(BQ_E_BUSY, bq769x0_begin_oneshot(&b.d));
    TEST_ASSERT_EQUAL(BQ_OK, bench_run(1000));
    TEST_ASSERT_EQUAL(SIM_X0_NORMAL, b.chip.mode);
    b.sample.cell_capacity = 4;
    b.sample.cell_count = 77;
    TEST_ASSERT_EQUAL(BQ_E_ARG, bench_picture());
    TEST_ASSERT_EQUAL(77, b.sample.cell_count); /* nothing written */
    NO_MISUSE();
}

static bq_status finish(const bq_afe *afe)
{
    bq_status s;
    uint32_t wait = 0;
    while ((s = afe->ops->poll(afe->ctx, &wait)) == BQ_PENDING)
        sim_x0_advance(&b.chip, (wait < 20 ? 20 : wait) * 1000ull);
    return s;
}

/* proves: X0-SEQ-47 */
static void test_through_the_interface_of_the_loop(void)
{
    int k;
    for (k = 0; k < 15; k++) {
        bq_afe afe;
        bench_part(sim_x0_part_at(k)->name, NULL);
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        afe = bq769x0_afe(&b.d);
        TEST_ASSERT_EQUAL(0, afe.ops->modules_found(afe.ctx));
        TEST_ASSERT_EQUAL(BQ_E_STATE, afe.ops->scan(afe.ctx));
        TEST_ASSERT_EQUAL(BQ_OK, afe.ops->start(afe.ctx));
        TEST_ASSERT_EQUAL(BQ_OK, finish(&afe));
        TEST_ASSERT_EQUAL(1, afe.ops->modules_found(afe.ctx));
        TEST_ASSERT_EQUAL(BQ_OK, afe.ops->scan(afe.ctx));
        TEST_ASSERT_EQUAL(BQ_OK, finish(&afe));
        TEST_ASSERT_EQUAL(BQ_OK, afe.ops->sample(afe.ctx, &b.sample));
        TEST_ASSERT_INT_WITHIN(1, 3600, b.cells[0].mv);
        TEST_ASSERT_EQUAL(BQ_OK, afe.ops->apply(afe.ctx, &b.action));
        TEST_ASSERT_EQUAL(BQ_OK, finish(&afe));
        TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
        TEST_ASSERT_EQUAL(BQ_OK, afe.ops->self_test(afe.ctx));
        TEST_ASSERT_EQUAL(BQ_OK, finish(&afe));
        TEST_ASSERT_TRUE(afe.ops->stats(afe.ctx)->packets > 0 && afe.ops->stats(afe.ctx)->scans > 0);
        TEST_ASSERT_EQUAL(BQ_OK, afe.ops->sleep(afe.ctx));
        TEST_ASSERT_EQUAL(BQ_OK, finish(&afe));
        TEST_ASSERT_EQUAL(SIM_X0_SHIP, b.chip.mode);
        TEST_ASSERT_EQUAL(BQ_E_STATE, afe.ops->apply(afe.ctx, &b.action));
        TEST_ASSERT_EQUAL(BQ_OK, afe.ops->wake(afe.ctx));
        TEST_ASSERT_EQUAL(BQ_OK, finish(&afe));
        TEST_ASSERT_EQUAL(SIM_X0_NORMAL, b.chip.mode);
        TEST_ASSERT_EQUAL_HEX8(0x19, sim_x0_peek(&b.chip, 0x0b));
        NO_MISUSE();
    }
}

/* Three hours: the microsecond counter wraps twice, nothing else happens. */
/* proves: X0-SEQ-26, X0-SEQ-25, X0-CC-09 */
static void test_three_hours(void)
{
    double ma;
    bench_up("bq7692000");
    bench_serve(3000, 250);
    (void)sim_x0_set_sense(&b.chip, 0.002); /* 0.4 A */
    bench_serve(1000, 250);
    bq769x0_charge_reset(&b.d);
    bench_serve(3u * 3600u * 1000u, 250);
    ma = (double)bq769x0_get_charge(&b.d)->uas / (3.0 * 3600.0 * 1000.0);
    TEST_ASSERT_INT_WITHIN(1, 400, (int)(ma + 0.5));
    TEST_ASSERT_INT_WITHIN(2, 3 * 3600 * 4, bq769x0_get_charge(&b.d)->results);
    TEST_ASSERT_EQUAL(0, bq769x0_get_charge(&b.d)->missed);
    TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
    TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
    TEST_ASSERT_EQUAL(0, bench_stats()->retries);
    NO_MISUSE();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_service_by_alert);
    RUN_TEST(test_a_board_without_the_line_is_polled);
    RUN_TEST(test_a_board_without_the_boot_line);
    RUN_TEST(test_polled_too_often_and_too_late);
    RUN_TEST(test_one_job_at_a_time);
    RUN_TEST(test_through_the_interface_of_the_loop);
    RUN_TEST(test_three_hours);
    return UNITY_END();
}
