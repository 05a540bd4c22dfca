/* SPDX-License-Identifier: Apache-2.0 */
/* Fault service and release (X0-SEQ-28..37): what is done at once, what must have been true and for how long
 * until the FETs come back, and what never brings them back. Times are measured on the pins. */
#include "bench.h"

#define PERIOD 100 /* ms between two scans: finer than the part's own times */

void setUp(void)
{
}
void tearDown(void)
{
}

static const char *const three[3] = {"bq7692000", "bq7693003", "bq7694006"};

static void on_duty(const char *name)
{
    bench_up(name);
    bench_serve(2750, 250);
    b.action.balance[0] = 1;
    bench_serve(500, 250);
    TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
    TEST_ASSERT_EQUAL_HEX16(1, sim_x0_cb(&b.chip));
}

/* ms until both pins are on, at PERIOD; `limit` if never */
static uint32_t until_on(uint32_t limit)
{
    return bench_until_on(limit, PERIOD);
}

static uint32_t until_set(uint8_t bit, uint32_t limit)
{
    uint64_t from = b.chip.now;
    while ((b.chip.reg[0] & bit) == 0 && b.chip.now < from + limit * MS)
        bench_serve(PERIOD, PERIOD);
    bench_serve(2 * PERIOD, PERIOD);
    TEST_ASSERT_TRUE(b.chip.reg[0] & bit);
    return (uint32_t)((b.chip.now - from) / MS);
}

/* At once: SYS_CTRL2 agrees with what the part did, balancing is off, the bit is still set. */
static void served(uint16_t flag, uint8_t ctrl2)
{
    TEST_ASSERT_EQUAL_HEX16(flag, b.module.faults);
    TEST_ASSERT_EQUAL_HEX8(ctrl2, sim_x0_peek(&b.chip, 0x05));
    TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&b.chip));
}

/* proves: X0-SEQ-28, X0-SEQ-29, X0-SEQ-30, X0-OV-05, X0-AMB-38, X0-AMB-41, X0-AMB-42, X0-FET-11 */
static void test_ov(void)
{
    int k;
    for (k = 0; k < 3; k++) {
        uint32_t took;
        on_duty(three[k]);
        (void)sim_x0_set_cell(&b.chip, 2, 4.21);
        took = until_set(0x04, 3000);
        TEST_ASSERT_TRUE(took >= 700 && took <= 1750 + 250 + 2 * PERIOD);
        served(BQ_F_CELL_OV, 0x42);
        (void)sim_x0_set_cell(&b.chip, 2, 4.11); /* below the limit, above the recovery threshold */
        TEST_ASSERT_EQUAL(30000, until_on(30000));
        TEST_ASSERT_TRUE(sim_x0_dsg(&b.chip)); /* discharging helps */
        TEST_ASSERT_TRUE(b.chip.reg[0] & 0x04);
        (void)sim_x0_set_cell(&b.chip, 2, 4.09);
        took = until_on(20000); /* 250 ms to be seen, 2 s inside, 1 s delay + 500 ms */
        TEST_ASSERT_TRUE(took >= 3500 && took <= 4500);
        bench_serve(PERIOD, PERIOD);
        TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
        TEST_ASSERT_EQUAL_HEX8(0x43, sim_x0_peek(&b.chip, 0x05));
        NO_MISUSE();
    }
}

/* The cell looks good for less than 2 s again and again: no release. */
/* proves: X0-SEQ-30, X0-SEQ-31, X0-SEQ-29 */
static void test_a_cell_that_comes_and_goes_is_not_released(void)
{
    int n, under;
    for (under = 0; under < 2; under++) {
        on_duty("bq7693003");
        (void)sim_x0_set_cell(&b.chip, 2, under ? 2.7 : 4.3);
        until_set(under ? 0x08 : 0x04, 3000);
        for (n = 0; n < 10; n++) {
            (void)sim_x0_set_cell(&b.chip, 2, 3.6);
            bench_serve(1600, PERIOD);
            (void)sim_x0_set_cell(&b.chip, 2, under ? 2.9 : 4.15);
            bench_serve(600, PERIOD);
            TEST_ASSERT_TRUE(b.chip.reg[0] & (under ? 0x08 : 0x04));
        }
        (void)sim_x0_set_cell(&b.chip, 2, 3.6);
        TEST_ASSERT_TRUE(until_on(20000) < 6000);
        NO_MISUSE();
    }
}

/* proves: X0-SEQ-31, X0-UV-05, X0-UV-08, X0-AMB-39, X0-AMB-40, X0-FET-11 */
static void test_uv(void)
{
    int k;
    for (k = 0; k < 3; k++) {
        uint32_t took;
        on_duty(three[k]);
        (void)sim_x0_set_cell(&b.chip, 3, 2.79);
        took = until_set(0x08, 3000);
        TEST_ASSERT_TRUE(took >= 700 && took <= 1750 + 250 + 2 * PERIOD);
        served(BQ_F_CELL_UV, 0x41);             /* charging may go on */
        (void)sim_x0_set_cell(&b.chip, 3, 0.4); /* the part ignores it now, the driver must not */
        TEST_ASSERT_EQUAL(20000, until_on(20000));
        TEST_ASSERT_TRUE(b.module.faults & BQ_F_OPEN_WIRE);
        TEST_ASSERT_TRUE(b.module.faults & BQ_F_CELL_UV);
        (void)sim_x0_set_cell(&b.chip, 3, 2.99);
        TEST_ASSERT_EQUAL(20000, until_on(20000));
        (void)sim_x0_set_cell(&b.chip, 3, 3.01);
        took = until_on(20000);
        TEST_ASSERT_TRUE(took >= 3500 && took <= 4500);
        NO_MISUSE();
    }
}

/* proves: X0-SEQ-32, X0-SEQ-33, X0-LOAD-03, X0-LOAD-04, X0-LOAD-05, X0-SCD-08, X0-AMB-57, X0-AMB-45 */
static void test_overcurrent_waits_for_the_load_to_go(void)
{
    static const struct {
        double volts, ms;
        uint8_t bits;
        uint16_t flags;
    } kind[3] = {{-0.045, 400, 0x01, BQ_F_OVERCURRENT},
                 {-0.150, 0.2, 0x02, BQ_F_SHORT},
                 {-0.150, 400, 0x03, BQ_F_OVERCURRENT | BQ_F_SHORT}};
    int k, i;
    for (k = 0; k < 3; k++)
        for (i = 0; i < 3; i++) {
            uint32_t took;
            uint64_t n, off;
            unsigned looks = 0;
            on_duty(three[k]);
            (void)sim_x0_set_chgpin(&b.chip, 3.0); /* the load */
            (void)sim_x0_set_sense(&b.chip, kind[i].volts);
            bench_wait(kind[i].ms);
            (void)sim_x0_set_sense(&b.chip, 0);
            n = b.count;
            bench_serve(2 * PERIOD, PERIOD);
            served(kind[i].flags, 0x40); /* CHG off as well: only then the detector works */
            TEST_ASSERT_EQUAL(60000, until_on(60000));
            TEST_ASSERT_EQUAL_HEX8(kind[i].bits, b.chip.reg[0] & 0x3f); /* never cleared against a load */
            (void)sim_x0_set_chgpin(&b.chip, 0.0);
            off = b.chip.now;
            took = until_on(20000);
            TEST_ASSERT_TRUE(took >= 750 + 320 && took < 5000);
            for (; n < b.count; n++) {
                const bench_entry *e = bench_log(n);
                looks += e->read == 1 && e->reg == 4 && e->t_ns >= off;
            }
            TEST_ASSERT_TRUE(looks >= 4);
            NO_MISUSE();
        }
}

/* The first look at the load comes after the settle time, and one glitch among the looks starts them anew. */
/* proves: X0-LOAD-05, X0-SEQ-32 */
static void test_settle_time_and_four_looks_in_a_row(void)
{
    static const uint16_t settle[3] = {0, 300, 1500};
    int i;
    for (i = 0; i < 3; i++) {
        uint64_t n, struck, first = 0;
        bench_part("bq7692003", NULL);
        b.cfg.load_settle_ms = settle[i];
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        TEST_ASSERT_TRUE(until_on(5000) < 5000);
        n = b.count;
        (void)sim_x0_set_sense(&b.chip, -0.150);
        bench_wait(0.2);
        (void)sim_x0_set_sense(&b.chip, 0);
        struck = b.chip.now;
        until_on(20000);
        for (; n < b.count && first == 0; n++)
            if (bench_log(n)->read == 1 && bench_log(n)->reg == 4)
                first = bench_log(n)->t_ns;
        TEST_ASSERT_TRUE(first >= struck + (settle[i] ? settle[i] : 100) * MS);
        TEST_ASSERT_TRUE(first < struck + ((settle[i] ? settle[i] : 100u) + 3 * PERIOD) * MS);
        NO_MISUSE();
    }
    on_duty("bq7692003");
    (void)sim_x0_set_sense(&b.chip, -0.150);
    bench_wait(0.2);
    (void)sim_x0_set_sense(&b.chip, 0);
    for (i = 0; i < 20; i++) { /* free for 700 ms, which is less than four looks, then a load again */
        (void)sim_x0_set_chgpin(&b.chip, 0.0);
        bench_serve(700, PERIOD);
        (void)sim_x0_set_chgpin(&b.chip, 3.0);
        bench_serve(400, PERIOD);
        TEST_ASSERT_FALSE(sim_x0_dsg(&b.chip));
        TEST_ASSERT_TRUE(b.chip.reg[0] & 0x02);
    }
    NO_MISUSE();
}

/* proves: X0-SEQ-32 */
static void test_repeated_short_circuits(void)
{
    int k, n;
    for (k = 0; k < 3; k++) {
        uint32_t took[6] = {0};
        on_duty(three[k]);
        for (n = 0; n < 5; n++) {
            (void)sim_x0_set_sense(&b.chip, -0.150);
            bench_wait(0.2);
            (void)sim_x0_set_sense(&b.chip, 0);
            took[n] = until_on(60000);
            TEST_ASSERT_TRUE(took[n] < 60000);
        }
        for (n = 2; n < 5;
             n++) /* doubled each time, beside the looks and the probation, which stay the same */
            TEST_ASSERT_TRUE(took[n] > took[n - 1]);
        TEST_ASSERT_TRUE(took[4] - took[3] >= took[3] - took[2]);
        (void)sim_x0_set_sense(&b.chip, -0.150);
        bench_wait(0.2);
        (void)sim_x0_set_sense(&b.chip, 0);
        TEST_ASSERT_EQUAL(300000, until_on(300000)); /* locked */
        TEST_ASSERT_TRUE(b.module.faults & BQ_F_SHORT);
        bq769x0_unlock(&b.d);
        TEST_ASSERT_TRUE(until_on(60000) < 60000);
        bench_serve(11000, 250); /* quiet for more than 10 s: a single one again */
        (void)sim_x0_set_sense(&b.chip, -0.150);
        bench_wait(0.2);
        (void)sim_x0_set_sense(&b.chip, 0);
        TEST_ASSERT_INT_WITHIN(2 * PERIOD, took[0], until_on(60000));
        NO_MISUSE();
    }
}

/* proves: X0-SEQ-34, X0-ALERT-09, X0-AMB-53, X0-AMB-54 */
static void test_override(void)
{
    int k;
    for (k = 0; k < 3; k++) {
        uint32_t took;
        unsigned clears;
        uint64_t n;
        on_duty(three[k]);
        (void)bench_scan();
        (void)sim_x0_set_alert_ext(&b.chip, true);
        bench_serve(2 * PERIOD, PERIOD);
        served(BQ_F_CHAIN, 0x40);
        n = b.count;
        TEST_ASSERT_EQUAL(60000, until_on(60000));
        clears = bench_writes(n, 0, NULL);
        TEST_ASSERT_TRUE(clears >= 10); /* tried every 5 s ... */
        clears = 0;
        for (; n < b.count; n++)
            clears += bench_log(n)->wrote == 1 && bench_log(n)->reg == 0 && (bench_log(n)->data[0] & 0x10);
        TEST_ASSERT_TRUE(clears >= 9 && clears <= 14); /* ... and not more often */
        (void)sim_x0_set_alert_ext(&b.chip, false);
        took = until_on(20000);
        TEST_ASSERT_TRUE(took >= 2000 && took <= 8000);
        NO_MISUSE();
    }
}

/* A single spike of noise: off for 1 s and 2 s more, then on again. */
/* proves: X0-SEQ-34, X0-ALERT-09 */
static void test_a_spike_on_alert(void)
{
    uint32_t took;
    on_duty("bq7694003");
    (void)bench_scan();
    (void)sim_x0_set_alert_ext(&b.chip, true);
    (void)sim_x0_set_alert_ext(&b.chip, false);
    took = until_on(20000);
    TEST_ASSERT_TRUE(took >= 3000 && took <= 4000);
    NO_MISUSE();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_ov);
    RUN_TEST(test_a_cell_that_comes_and_goes_is_not_released);
    RUN_TEST(test_uv);
    RUN_TEST(test_overcurrent_waits_for_the_load_to_go);
    RUN_TEST(test_settle_time_and_four_looks_in_a_row);
    RUN_TEST(test_repeated_short_circuits);
    RUN_TEST(test_override);
    RUN_TEST(test_a_spike_on_alert);
    return UNITY_END();
}
