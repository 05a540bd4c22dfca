/* SPDX-License-Identifier: Apache-2.0 */
/* SHIP: the pattern, nothing between its writes, silence as the proof, and what happens when it fails. */
#include "bench.h"

void setUp(void)
{
}
void tearDown(void)
{
}

static void on_duty(const char *name, const sim_x0_options *options)
{
    bench_part(name, options);
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    b.action.balance[0] = 1;
    bench_serve(3000, 250);
    TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
}

static bq_status ship(void)
{
    TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_ship(&b.d));
    return bench_run(5000);
}

/* Number of the first of three writes 00, 01, 10 in a row with the other bits kept; the log's end if none. */
static uint64_t pattern_from(uint64_t n)
{
    for (; n + 2 < b.count; n++) {
        unsigned i;
        for (i = 0; i < 3; i++) {
            const bench_entry *e = bench_log(n + i);
            if (e->wrote != 1 || e->reg != 4 || e->data[0] != (0x18u | i))
                break;
        }
        if (i == 3)
            return n;
    }
    return b.count;
}

/* proves: X0-SEQ-47, X0-MODE-13, X0-AMB-73, X0-SEQ-41, X0-BIT-04 */
static void test_ship(void)
{
    int k;
    for (k = 0; k < 15; k++) {
        uint64_t from, at, n;
        uint8_t fets = 0xff, balance = 0xff;
        on_duty(sim_x0_part_at(k)->name, NULL);
        from = b.count;
        TEST_ASSERT_EQUAL(BQ_OK, ship());
        TEST_ASSERT_EQUAL(SIM_X0_SHIP, b.chip.mode);
        at = pattern_from(from);
        TEST_ASSERT_TRUE(at < b.count);
        TEST_ASSERT_TRUE(bench_writes(from, 5, &fets) >= 1 && bench_writes(from, 1, &balance) >= 1);
        TEST_ASSERT_EQUAL_HEX8(0, fets);
        TEST_ASSERT_EQUAL_HEX8(0, balance);
        for (n = from; n < at; n++) /* off before the pattern, verified */
            TEST_ASSERT_EQUAL(BQ_OK, bench_log(n)->status);
        TEST_ASSERT_TRUE(at + 3 < b.count); /* asked whether it is silent, after 10 ms */
        TEST_ASSERT_EQUAL(BQ_E_NACK, bench_log(b.count - 1)->status);
        TEST_ASSERT_TRUE(bench_log(b.count - 1)->t_ns >= bench_log(at + 2)->t_ns + 10 * MS);
        TEST_ASSERT_FALSE(b.boot_level);
        TEST_ASSERT_EQUAL(BQ_E_STATE, bq769x0_begin_scan(&b.d));
        TEST_ASSERT_EQUAL(1, b.rises); /* nobody woke it */
        NO_MISUSE();
    }
}

/* proves: X0-SEQ-47, X0-AMB-71, X0-AMB-72 */
static void test_ship_under_both_readings(void)
{
    int k, way;
    for (k = 0; k < 15; k++)
        for (way = 0; way < 4; way++) {
            sim_x0_options o;
            memset(&o, 0, sizeof o);
            o.amb71_needs_00 = way & 1;
            o.amb72_shut_reads_0 = way & 2;
            on_duty(sim_x0_part_at(k)->name, &o);
            TEST_ASSERT_EQUAL(BQ_OK, ship());
            TEST_ASSERT_EQUAL(SIM_X0_SHIP, b.chip.mode);
            NO_MISUSE();
        }
}

static void disarm(bench *x)
{
    x->chip.ship_armed = false; /* the part that does not listen */
}

/* proves: X0-SEQ-47, X0-AMB-73 */
static void test_a_part_that_does_not_go(void)
{
    int k;
    for (k = 0; k < 15; k++) {
        uint64_t from, n;
        unsigned patterns = 0;
        on_duty(sim_x0_part_at(k)->name, NULL);
        from = b.count;
        b.hook = disarm;
        TEST_ASSERT_EQUAL(BQ_E_VERIFY, ship());
        b.hook = NULL;
        TEST_ASSERT_EQUAL(SIM_X0_NORMAL, b.chip.mode);
        for (n = from; (n = pattern_from(n)) < b.count; n += 3)
            patterns++;
        TEST_ASSERT_EQUAL(3, patterns);
        TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip)); /* all that could be done was done */
        TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&b.chip));
        TEST_ASSERT_EQUAL(BQ_OK, bench_start()); /* and it can be taken into service again */
        bench_serve(3000, 250);
        TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
        NO_MISUSE();
    }
}

static unsigned wake_ups;

static void wake_again(bench *x)
{
    if (x->chip.mode == SIM_X0_SHIP && wake_ups > 0 && x->chip.now > x->chip.t_ship) {
        wake_ups--; /* TS1 still high: up again, and complete when the driver looks */
        (void)sim_x0_boot_ended(&x->chip, x->chip.t_ship);
        sim_x0_advance(&x->chip, 12 * MS);
    }
}

/* proves: X0-SEQ-47, X0-AMB-75 */
static void test_a_part_that_comes_up_again_is_sent_again(void)
{
    static const char *const three[3] = {"bq7692003", "bq7693000", "bq7694006"};
    int k;
    for (k = 0; k < 3; k++)
        for (wake_ups = 1; wake_ups <= 2;) {
            unsigned asked = wake_ups;
            on_duty(three[k], NULL);
            b.hook = wake_again;
            TEST_ASSERT_EQUAL(BQ_OK, ship());
            b.hook = NULL;
            TEST_ASSERT_EQUAL(0, wake_ups);
            TEST_ASSERT_EQUAL(SIM_X0_SHIP, b.chip.mode);
            wake_ups = asked + 1;
        }
}

/* Every transaction of the entry fails once, in every way: the part sleeps all the same, or the driver says
   so. A pattern whose answer was lost is begun anew: 01 written twice would disarm (X0-MODE-11). */
/* proves: X0-SEQ-47, X0-SEQ-50, X0-SEQ-49 */
static void test_every_transaction_of_the_entry_fails_once(void)
{
    static const char *const two[2] = {"bq7692000", "bq7694003"};
    int k, kind;
    for (k = 0; k < 2; k++) {
        uint64_t n, all;
        on_duty(two[k], NULL);
        all = b.count;
        TEST_ASSERT_EQUAL(BQ_OK, ship());
        all = b.count - all;
        for (n = 1; n <= all; n++)
            for (kind = SPOIL_LOST; kind < SPOIL_KINDS; kind++) {
                bq_status s;
                if (kind == SPOIL_FLIP && k == 0)
                    continue; /* without CRC a flipped write is carried out */
                on_duty(two[k], NULL);
                b.spoil_at = b.count + n;
                b.spoil_kind = (spoil)kind;
                b.flip_bit = (int)(8 + bench_random(16));
                s = ship();
                b.spoil_at = 0;
                TEST_ASSERT_FALSE(s == BQ_OK && b.chip.mode != SIM_X0_SHIP);
                if (kind != SPOIL_BROWNOUT) /* a part that is silent before its time is an error of the bus */
                    TEST_ASSERT_EQUAL(BQ_OK, s);
                TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
                if (kind != SPOIL_FLIP)
                    NO_MISUSE();
            }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_ship);
    RUN_TEST(test_ship_under_both_readings);
    RUN_TEST(test_a_part_that_does_not_go);
    RUN_TEST(test_a_part_that_comes_up_again_is_sent_again);
    RUN_TEST(test_every_transaction_of_the_entry_fails_once);
    return UNITY_END();
}
