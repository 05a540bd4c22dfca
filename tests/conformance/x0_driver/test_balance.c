/* SPDX-License-Identifier: Apache-2.0 */
/* Balancing on physical inputs: every legal wiring, every wish, pauses, limits, and everything that ends it.
 */
#include "bench.h"
#include "rows.h"

void setUp(void)
{
}
void tearDown(void)
{
}

static uint16_t wiring;

static void ready(const char *name, unsigned cells)
{
    bench_part(name, NULL);
    b.cfg.cells = (uint8_t)cells;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    wiring = rows_wiring(b.chip.part->cells, cells);
    TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
}

static uint16_t inputs_of(uint32_t asked)
{
    uint16_t mask = 0;
    unsigned c;
    for (c = 1; c <= b.cfg.cells; c++)
        if (asked >> (c - 1) & 1)
            mask = (uint16_t)(mask | 1u << (rows_input(b.cfg.inputs, b.cfg.cells, c) - 1));
    return mask;
}

static uint16_t apply(uint32_t asked)
{
    unsigned g;
    uint16_t cb;
    TEST_ASSERT_EQUAL(BQ_OK, bench_apply(true, true, asked));
    cb = sim_x0_cb(&b.chip);
    TEST_ASSERT_EQUAL_HEX16(0, cb & ~inputs_of(asked));
    for (g = 0; g < b.cfg.inputs / 5u; g++)
        TEST_ASSERT_TRUE(rows_legal_cellbal(wiring >> (5 * g) & 31u, cb >> (5 * g) & 31u));
    TEST_ASSERT_FALSE((cb & 0x0030) == 0x0030 || (cb & 0x0600) == 0x0600); /* nor across the borders */
    return cb;
}

/* Both sets of a wish, a period apart, serve everybody in it. */
static void wish(uint32_t asked)
{
    uint16_t seen = apply(asked);
    int n;
    for (n = 0; n < 2; n++) {
        bench_wait(4096);
        seen |= apply(asked);
    }
    TEST_ASSERT_EQUAL_HEX16(inputs_of(asked), seen);
}

/* proves: X0-SEQ-39, X0-SEQ-40, X0-CB-02, X0-CB-04, X0-CB-06, X0-CELL-19, X0-CELL-20, X0-CELL-21, X0-AMB-61,
   X0-AMB-62 */
static void test_every_wish_of_every_wiring(void)
{
    static const char *const name[3] = {"bq7692006", "bq7693003", "bq7694000"};
    unsigned k, cells, n;
    for (k = 0; k < 3; k++)
        for (cells = rows_least(5 * k + 5); cells <= 5 * k + 5; cells++) {
            unsigned all = 1u << cells;
            ready(name[k], cells);
            for (n = 0; n < (all < 1024 ? all : 800); n++)
                wish(all <= 1024 ? n : bench_random(all));
            wish(all - 1);
            NO_MISUSE();
        }
}

/* proves: X0-SEQ-42 */
static void test_limit_on_simultaneous_switches(void)
{
    unsigned max, n;
    for (max = 1; max <= 7; max++) {
        bench_part("bq7694003", NULL);
        b.cfg.balance_max = (uint8_t)max;
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        for (n = 0; n < 60; n++) {
            TEST_ASSERT_EQUAL(BQ_OK, bench_apply(true, true, n & 1 ? 0x7fff : bench_random(0x8000)));
            TEST_ASSERT_TRUE((unsigned)__builtin_popcount(sim_x0_cb(&b.chip)) <= max);
            bench_wait(1000);
        }
        NO_MISUSE();
    }
}

/* proves: X0-CB-13, X0-SEQ-41 */
static void test_the_timer_ends_what_nobody_asks_for_any_more(void)
{
    static const uint8_t limit_s[4] = {0, 1, 4, 20};
    int i, k;
    for (k = 0; k < 15; k++)
        for (i = 0; i < 4; i++) {
            uint64_t from;
            uint32_t limit_ms = (limit_s[i] ? limit_s[i] : 4u) * 1000u;
            bench_part(sim_x0_part_at(k)->name, NULL);
            b.cfg.balance_timer_s = limit_s[i];
            TEST_ASSERT_EQUAL(BQ_OK, bench_init());
            TEST_ASSERT_EQUAL(BQ_OK, bench_start());
            TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
            TEST_ASSERT_EQUAL(BQ_OK, bench_apply(true, true, 0x05));
            from = b.chip.now;
            while (sim_x0_cb(&b.chip) && b.chip.now < from + 30000 * MS) {
                bench_wait(200);
                TEST_ASSERT_EQUAL(BQ_OK, bench_scan()); /* scans alone */
            }
            TEST_ASSERT_TRUE(b.chip.now - from >= limit_ms * MS);
            TEST_ASSERT_TRUE(b.chip.now - from < (limit_ms + 500) * MS);
            TEST_ASSERT_TRUE(b.module.faults & BQ_F_BALANCE);
            TEST_ASSERT_EQUAL(BQ_OK, bench_apply(true, true, 0x05)); /* and it can begin again */
            TEST_ASSERT_EQUAL_HEX16(0x05, sim_x0_cb(&b.chip));
            NO_MISUSE();
        }
}

/* A period with the switches open between two with them closed gives readings of whole windows. */
/* proves: X0-SEQ-40, X0-CB-07, X0-AMB-60 */
static void test_pauses(void)
{
    int n;
    ready("bq7694003", 15);
    for (n = 0; n < 20; n++) {
        TEST_ASSERT_EQUAL(BQ_OK, bench_apply(true, true, n & 1 ? 0 : 0x0421));
        TEST_ASSERT_EQUAL_HEX16(n & 1 ? 0 : 0x0421, sim_x0_cb(&b.chip));
        bench_wait(500);
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        TEST_ASSERT_EQUAL_HEX16(n & 1 ? 0 : 0x0421, b.module.balancing);
        TEST_ASSERT_INT_WITHIN(1, 3600, b.cells[0].mv);
    }
    NO_MISUSE();
}

static void end_by(int why)
{
    switch (why) {
    case 0:
        (void)sim_x0_set_cell(&b.chip, 1, 4.3);
        break;
    case 1:
        (void)sim_x0_set_cell(&b.chip, 1, 2.5);
        break;
    case 2:
        (void)sim_x0_set_sense(&b.chip, -0.150);
        bench_wait(0.2);
        (void)sim_x0_set_sense(&b.chip, 0);
        break;
    case 3:
        (void)bench_scan();
        (void)sim_x0_set_alert_ext(&b.chip, true);
        break;
    case 4:
        (void)sim_x0_strike_xready(&b.chip);
        break;
    default:
        b.chip.t_cc_end = UINT64_MAX;
        b.chip.due = 0;
        break;
    }
}

/* proves: X0-SEQ-41, X0-AMB-63, X0-CB-03, X0-SEQ-28 */
static void test_everything_that_ends_it(void)
{
    int k, why, n;
    for (k = 0; k < 15; k++)
        for (why = 0; why < 6; why++) {
            ready(sim_x0_part_at(k)->name, sim_x0_part_at(k)->cells);
            b.action.balance[0] = 0x15;
            bench_serve(2750, 250);
            TEST_ASSERT_EQUAL_HEX16(0x15, sim_x0_cb(&b.chip));
            end_by(why);
            for (n = 0; n < 8 && sim_x0_cb(&b.chip) != 0; n++)
                bench_serve(250, 250);
            TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&b.chip));
            if (why < 5) { /* a counter that stood is started again and is no fault any more */
                bench_serve(500, 250);
                TEST_ASSERT_TRUE(b.module.faults != 0);
                TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&b.chip));
            }
            NO_MISUSE();
        }
}

/* The bits a boot cleared are not assumed: after a bring-up nothing is on, and what is asked then is on. */
/* proves: X0-SEQ-41, X0-CB-03, X0-SEQ-06 */
static void test_nothing_persists_over_a_bring_up(void)
{
    ready("bq7693003", 10);
    TEST_ASSERT_EQUAL(BQ_OK, bench_apply(true, true, 0x21));
    TEST_ASSERT_EQUAL_HEX16(0x21, sim_x0_cb(&b.chip));
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&b.chip));
    TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
    TEST_ASSERT_EQUAL(0, b.module.balancing);
    NO_MISUSE();
}

/* The write does not take: it is said, and nothing else is switched on for it. */
static void drop_balancing(bench *x)
{
    x->chip.reg[1] = 0;
}

/* proves: X0-SEQ-40 */
static void test_switches_that_do_not_close_are_noticed(void)
{
    bq_status s;
    ready("bq7692003", 5);
    b.hook = drop_balancing;
    s = bench_apply(true, true, 0x04);
    b.hook = NULL;
    TEST_ASSERT_EQUAL(BQ_E_VERIFY, s);
    TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
    TEST_ASSERT_EQUAL(BQ_OK, bench_apply(true, true, 0x04));
    TEST_ASSERT_EQUAL_HEX16(0x04, sim_x0_cb(&b.chip));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_wish_of_every_wiring);
    RUN_TEST(test_limit_on_simultaneous_switches);
    RUN_TEST(test_the_timer_ends_what_nobody_asks_for_any_more);
    RUN_TEST(test_pauses);
    RUN_TEST(test_everything_that_ends_it);
    RUN_TEST(test_nothing_persists_over_a_bring_up);
    RUN_TEST(test_switches_that_do_not_close_are_noticed);
    return UNITY_END();
}
