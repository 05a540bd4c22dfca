/* SPDX-License-Identifier: Apache-2.0 */
/* The edges of the release of a fault (X0-SEQ-29..36): a threshold that is just met, how long a cleared bit
 * is watched, when waits that grew are short again. */
#include "bench.h"

#define PERIOD 100 /* ms between two scans: finer than the part's own times */

void setUp(void)
{
}
void tearDown(void)
{
}

static void on_duty(const char *name, uint16_t ocd_delay_ms)
{
    bench_part(name, NULL);
    b.cfg.ocd_delay_ms = ocd_delay_ms;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    bench_serve(2750, 250);
    TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
}

static uint32_t until_on(uint32_t limit)
{
    return bench_until_on(limit, PERIOD);
}

static void strike(double volts, double ms)
{
    (void)sim_x0_set_sense(&b.chip, volts);
    bench_wait(ms);
    (void)sim_x0_set_sense(&b.chip, 0);
    bench_serve(2 * PERIOD, PERIOD);
    TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
}

/* Below, or above, the recovery threshold; not at it. */
/* proves: X0-SEQ-30, X0-SEQ-31 */
static void test_a_cell_at_its_recovery_threshold_releases_nothing(void)
{
    static const struct {
        double bad, edge;
        int edge_mv;
        uint8_t bit;
    } side[2] = {{4.3, 4.1, 4100, 0x04}, {2.7, 3.0, 3000, 0x08}};
    for (int i = 0; i < 2; i++) {
        on_duty("bq7692003", 320);
        (void)sim_x0_set_cell(&b.chip, 4, side[i].bad);
        bench_serve(3000, PERIOD);
        TEST_ASSERT_TRUE(b.chip.reg[0] & side[i].bit);
        (void)sim_x0_set_cell(&b.chip, 4, side[i].edge);
        TEST_ASSERT_EQUAL(20000, until_on(20000));
        TEST_ASSERT_EQUAL(side[i].edge_mv, b.cells[3].mv);
        TEST_ASSERT_TRUE(b.chip.reg[0] & side[i].bit);
        (void)sim_x0_set_cell(&b.chip, 4, side[i].edge + (i == 0 ? -0.001 : 0.001));
        TEST_ASSERT_TRUE(until_on(20000) < 5000);
        NO_MISUSE();
    }
}

/* Any cell may be the one, also the lowest and the highest. */
/* proves: X0-SEQ-30, X0-SEQ-31 */
static void test_every_cell_counts(void)
{
    for (int under = 0; under < 2; under++)
        for (int cell = 1; cell <= 10; cell++) {
            on_duty("bq7693003", 320);
            (void)sim_x0_set_cell(&b.chip, cell, under ? 2.7 : 4.3);
            bench_serve(3000, PERIOD);
            (void)sim_x0_set_cell(&b.chip, cell, under ? 2.95 : 4.15);
            TEST_ASSERT_EQUAL(6000, until_on(6000));
            (void)sim_x0_set_cell(&b.chip, cell, 3.6);
            TEST_ASSERT_TRUE(until_on(20000) < 5000);
            NO_MISUSE();
        }
}

/* A release looks at what is held and at nothing else: a cell between the recovery threshold and the limit of
 * the other side, or of a fault that is not held, keeps nobody waiting. */
/* proves: X0-SEQ-30, X0-SEQ-31, X0-SEQ-32 */
static void test_what_is_not_held_holds_nothing(void)
{
    for (int kind = 0; kind < 3; kind++) {
        on_duty("bq7692003", 320);
        if (kind == 0) {
            (void)sim_x0_set_cell(&b.chip, 1, 4.3);
            (void)sim_x0_set_cell(&b.chip, 2, 2.9);
            bench_serve(3000, PERIOD);
        } else if (kind == 1) {
            (void)sim_x0_set_cell(&b.chip, 1, 2.7);
            (void)sim_x0_set_cell(&b.chip, 2, 4.15);
            bench_serve(3000, PERIOD);
        } else {
            (void)sim_x0_set_cell(&b.chip, 1, 4.15);
            (void)sim_x0_set_cell(&b.chip, 2, 2.9);
            bench_serve(3000, PERIOD);
            strike(-0.150, 0.2);
        }
        TEST_ASSERT_EQUAL_HEX8(kind == 0 ? 0x04 : kind == 1 ? 0x08 : 0x02, b.chip.reg[0] & 0x3f);
        if (kind < 2)
            (void)sim_x0_set_cell(&b.chip, 1, 3.6);
        TEST_ASSERT_TRUE(until_on(20000) < 5000);
        NO_MISUSE();
    }
}

/* When `reg` is next written with one of `bits`, in ns; 0 = not. */
static uint64_t written(uint64_t *n, uint8_t reg, uint8_t bits)
{
    for (; *n < b.count; (*n)++) {
        const bench_entry *e = bench_log(*n);
        if (reg >= e->reg && reg < e->reg + e->wrote && (e->data[reg - e->reg] & bits) != 0)
            return e->t_ns;
    }
    return 0;
}

/* Looks for a load between the log's entries `from` and `to`. */
static unsigned looks(uint64_t from, uint64_t to)
{
    unsigned seen = 0;
    for (; from < to; from++)
        seen += bench_log(from)->read == 1 && bench_log(from)->reg == 4;
    return seen;
}

/* Four times no load, also where there never was one. Then the delay that could bring the bit back, and 500
 * ms.
 */
/* proves: X0-SEQ-29, X0-SEQ-32 */
static void test_a_cleared_overcurrent_is_watched_for_its_own_delay(void)
{
    static const uint16_t delay[3] = {8, 320, 1280};
    for (int i = 0; i < 3; i++) {
        uint64_t n, struck, cleared, on;
        on_duty("bq7693003", delay[i]);
        struck = n = b.count;
        strike(-0.045, delay[i] + 20.0);
        TEST_ASSERT_TRUE(until_on(20000) < 20000);
        cleared = written(&n, 0, 0x01);
        TEST_ASSERT_EQUAL(4, looks(struck, n));
        on = written(&n, 5, 0x02);
        TEST_ASSERT_TRUE(cleared != 0 && on >= cleared + (delay[i] + 500u) * MS);
        TEST_ASSERT_TRUE(on <= cleared + (delay[i] + 500u + 3u * PERIOD) * MS);
        NO_MISUSE();
    }
}

/* Cleared after 3 s, looked at again after 1 s, whatever the delay of the overcurrent is; then the whole
 * configuration, and a scan and 2 s more before a FET comes on. */
/* proves: X0-SEQ-35 */
static void test_a_cleared_internal_fault_is_watched_for_a_second(void)
{
    static const uint16_t delay[2] = {8, 1280};
    for (int i = 0; i < 2; i++) {
        uint64_t n, struck, cleared, configured, on;
        on_duty("bq7693003", delay[i]);
        n = b.count;
        struck = b.chip.now;
        (void)sim_x0_strike_xready(&b.chip);
        TEST_ASSERT_TRUE(until_on(20000) < 20000);
        cleared = written(&n, 0, 0x20);
        configured = written(&n, 6, 0xff);
        TEST_ASSERT_TRUE(cleared >= struck + 3000 * MS && cleared <= struck + (3000 + 4 * PERIOD) * MS);
        TEST_ASSERT_TRUE(configured >= cleared + 1000 * MS);
        TEST_ASSERT_TRUE(configured <= cleared + (1000 + 3 * PERIOD) * MS);
        on = written(&n, 5, 0x03);
        TEST_ASSERT_TRUE(on >= configured + (2000 + 250) * MS);
        NO_MISUSE();
    }
}

/* CHG needs 100 ms to fall before the first look, unless the board says otherwise. */
/* proves: X0-LOAD-05 */
static void test_the_first_look_waits_for_the_pin(void)
{
    static const uint16_t settle[3] = {0, 60, 400};
    for (int i = 0; i < 3; i++) {
        uint64_t n, struck, wait = settle[i] != 0 ? settle[i] : 100;
        bench_part("bq7692003", NULL);
        b.cfg.load_settle_ms = settle[i];
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        bench_serve(2750, 250);
        (void)sim_x0_set_sense(&b.chip, -0.150);
        bench_wait(0.2);
        (void)sim_x0_set_sense(&b.chip, 0);
        n = b.count;
        struck = b.chip.now;
        bench_serve(800, 10);
        while (n < b.count && looks(n, n + 1) == 0)
            n++;
        TEST_ASSERT_TRUE(n < b.count);
        TEST_ASSERT_TRUE(bench_log(n)->t_ns >= struck + wait * MS);
        TEST_ASSERT_TRUE(bench_log(n)->t_ns <= struck + (wait + 50) * MS);
        NO_MISUSE();
    }
}

/* Every 250 ms for a host that scans so often, and only while an overcurrent is held. */
/* proves: X0-SEQ-32, X0-LOAD-05 */
static void test_looks_come_with_every_scan(void)
{
    uint64_t n, cleared, last = 0;
    on_duty("bq7692003", 320);
    (void)sim_x0_set_chgpin(&b.chip, 3.0);
    strike(-0.150, 0.2);
    n = b.count;
    bench_serve(5000, 250);
    TEST_ASSERT_INT_WITHIN(1, 20, (int)looks(n, b.count));
    for (; n < b.count; n++)
        if (looks(n, n + 1) != 0) {
            TEST_ASSERT_TRUE(last == 0 || bench_log(n)->t_ns - last <= 300 * MS);
            last = bench_log(n)->t_ns;
        }
    (void)sim_x0_set_chgpin(&b.chip, 0.0);
    last = b.chip.now;
    bench_serve(2000, 250);
    cleared = written(&n, 0, 0x02);
    TEST_ASSERT_TRUE(cleared != 0 && cleared <= last + 1250 * MS); /* four looks, and 250 ms of quiet */
    on_duty("bq7692003", 320);
    (void)sim_x0_set_cell(&b.chip, 1, 4.3);
    bench_serve(2500, 250);
    n = b.count;
    bench_serve(5000, 250);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, b.module.faults);
    TEST_ASSERT_EQUAL(0, looks(n, b.count));
    NO_MISUSE();
}

/* What is on probation is held still: another fault adds to it, and both are released together. */
/* proves: X0-SEQ-36, X0-SEQ-29 */
static void test_a_fault_during_a_probation_adds_to_it(void)
{
    uint64_t n;
    bench_part("bq7692003", NULL);
    b.cfg.ov_delay_s = 8;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    bench_serve(2750, 250);
    (void)sim_x0_set_cell(&b.chip, 1, 4.3);
    bench_serve(9500, PERIOD);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, b.module.faults);
    (void)sim_x0_set_cell(&b.chip, 1, 3.6);
    n = b.count;
    bench_serve(4000, PERIOD);
    TEST_ASSERT_TRUE(written(&n, 0, 0x04) != 0); /* cleared, for 8.5 s on probation */
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, b.module.faults);
    strike(-0.150, 0.2);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV | BQ_F_SHORT, b.module.faults);
    TEST_ASSERT_TRUE(until_on(20000) >= 2000 + 8500);
    NO_MISUSE();
}

/* The register byte of a read is under no CRC: with one bit of it wrong another register answers, and what it
 * holds looks like faults.
 * Nothing goes off for that. */
/* proves: X0-I2C-16, X0-SEQ-28 */
static void test_another_register_in_place_of_the_status(void)
{
    for (int bit = 8; bit < 16; bit++) {
        on_duty("bq7692003", 320);
        b.spoil_at = b.count + 1; /* a scan begins with SYS_STAT */
        b.spoil_kind = SPOIL_FLIP;
        b.flip_bit = bit;
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        TEST_ASSERT_EQUAL(0x00, bench_log(b.spoil_at - 1)->reg);
        TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
        TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
        bench_serve(1000, 250);
        TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
        TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
    }
}

/* FETs that cannot be switched off on the bus are not passed over in silence. */
/* proves: X0-SEQ-28, X0-FET-13 */
static void test_a_fet_that_cannot_be_written_is_told(void)
{
    on_duty("bq7692003", 320);
    (void)sim_x0_set_sense(&b.chip, -0.150);
    bench_wait(0.2);
    (void)sim_x0_set_sense(&b.chip, 0);
    b.spoil_writes = true;
    b.spoil_reg = 5;
    b.spoil_seen = 0;
    b.spoil_at = 1;
    b.spoil_count = 100;
    b.spoil_kind = SPOIL_NACK;
    TEST_ASSERT_TRUE(bench_scan() < 0);
    TEST_ASSERT_TRUE(sim_x0_chg(&b.chip)); /* the part has switched off DSG, CHG is the driver's */
    b.spoil_at = 0;
    bench_serve(500, 250);
    TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
    TEST_ASSERT_EQUAL_HEX16(BQ_F_SHORT, b.module.faults);
    TEST_ASSERT_TRUE(until_on(20000) < 20000);
}

/* No reading counts from the fault to a scan and 2 s after the configuration, also while the bit reads as
 * clear.
 */
/* proves: X0-SEQ-35, X0-XRDY-04, X0-AMB-66 */
static void test_an_internal_fault_ends_the_use_of_readings(void)
{
    uint64_t struck;
    on_duty("bq7693003", 320);
    (void)sim_x0_strike_xready(&b.chip);
    struck = b.chip.now;
    while (b.chip.now < struck + (3000 + 1000 + 2250) * MS) {
        bench_serve(PERIOD, PERIOD);
        TEST_ASSERT_FALSE(b.cells[0].quality & BQ_Q_VALID);
        TEST_ASSERT_FALSE(b.cells[9].quality & BQ_Q_VALID);
    }
    bench_serve(1000, PERIOD);
    TEST_ASSERT_EQUAL(BQ_Q_VALID, b.cells[9].quality);
    NO_MISUSE();
}

/* A person has looked: the short circuits before do not count any more. */
/* proves: X0-SEQ-32 */
static void test_unlocking_begins_anew(void)
{
    on_duty("bq7692003", 320);
    for (int n = 0; n < 5; n++) {
        strike(-0.150, 0.2);
        TEST_ASSERT_TRUE(until_on(30000) < 30000);
    }
    strike(-0.150, 0.2);
    TEST_ASSERT_EQUAL(60000, until_on(60000));
    bq769x0_unlock(&b.d);
    TEST_ASSERT_TRUE(until_on(30000) < 30000);
    strike(-0.150, 0.2); /* within 10 s: again, but the first repetition */
    TEST_ASSERT_TRUE(until_on(30000) < 3000);
    NO_MISUSE();
}

/* proves: X0-SEQ-32 */
static void test_a_short_circuit_within_ten_seconds_waits_longer(void)
{
    uint32_t first;
    on_duty("bq7692003", 320);
    strike(-0.150, 0.2);
    first = until_on(20000);
    bench_serve(8500, 250);
    strike(-0.150, 0.2);
    TEST_ASSERT_TRUE(until_on(20000) >= first + 200);
    NO_MISUSE();
}

/* Only short circuits lock. */
/* proves: X0-SEQ-32 */
static void test_overcurrents_never_lock(void)
{
    on_duty("bq7692003", 320);
    for (int n = 0; n < 9; n++) {
        strike(-0.045, 400);
        TEST_ASSERT_TRUE(until_on(20000) < 20000);
    }
    NO_MISUSE();
}

/* proves: X0-SEQ-32 */
static void test_after_ten_quiet_seconds_a_short_circuit_is_the_first_again(void)
{
    uint32_t first, third = 0;
    on_duty("bq7692003", 320);
    strike(-0.150, 0.2);
    first = until_on(20000);
    for (int n = 0; n < 3; n++) {
        strike(-0.150, 0.2);
        third = until_on(20000);
    }
    TEST_ASSERT_TRUE(third > first + 750);
    bench_serve(10500, 250);
    strike(-0.150, 0.2);
    TEST_ASSERT_INT_WITHIN(2 * PERIOD, (int)first, (int)until_on(20000));
    NO_MISUSE();
}

/* Short circuits pull the supply down: an internal fault after many of them is still the first of its kind,
 * and gets its 3 s and its two repetitions before the part is given up. */
/* proves: X0-SEQ-35 */
static void test_an_internal_fault_after_short_circuits_is_the_first_of_its_kind(void)
{
    uint64_t n, struck, cleared;
    on_duty("bq7692003", 320);
    for (int k = 0; k < 4; k++) {
        strike(-0.150, 0.2);
        TEST_ASSERT_TRUE(until_on(20000) < 20000);
    }
    n = b.count;
    struck = b.chip.now;
    (void)sim_x0_strike_xready(&b.chip);
    TEST_ASSERT_TRUE(until_on(20000) < 20000);
    TEST_ASSERT_EQUAL(SIM_X0_NORMAL, b.chip.mode);
    cleared = written(&n, 0, 0x20);
    TEST_ASSERT_TRUE(cleared >= struck + 3000 * MS && cleared <= struck + (3000 + 4 * PERIOD) * MS);
    NO_MISUSE();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_cell_at_its_recovery_threshold_releases_nothing);
    RUN_TEST(test_every_cell_counts);
    RUN_TEST(test_what_is_not_held_holds_nothing);
    RUN_TEST(test_a_cleared_overcurrent_is_watched_for_its_own_delay);
    RUN_TEST(test_a_cleared_internal_fault_is_watched_for_a_second);
    RUN_TEST(test_the_first_look_waits_for_the_pin);
    RUN_TEST(test_looks_come_with_every_scan);
    RUN_TEST(test_a_fault_during_a_probation_adds_to_it);
    RUN_TEST(test_another_register_in_place_of_the_status);
    RUN_TEST(test_a_fet_that_cannot_be_written_is_told);
    RUN_TEST(test_an_internal_fault_ends_the_use_of_readings);
    RUN_TEST(test_unlocking_begins_anew);
    RUN_TEST(test_a_short_circuit_within_ten_seconds_waits_longer);
    RUN_TEST(test_overcurrents_never_lock);
    RUN_TEST(test_after_ten_quiet_seconds_a_short_circuit_is_the_first_again);
    RUN_TEST(test_an_internal_fault_after_short_circuits_is_the_first_of_its_kind);
    return UNITY_END();
}
