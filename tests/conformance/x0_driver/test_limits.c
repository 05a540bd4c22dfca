/* SPDX-License-Identifier: Apache-2.0 */
/* Limits in physical units: each step and each delay the part offers, proven by what trips and what does not.
 */
#include "bench.h"
#include "rows.h"

void setUp(void)
{
}
void tearDown(void)
{
}

/* 1 mohm: an ampere is a millivolt */
static void asked(uint32_t ocd_mv, uint32_t scd_mv, uint16_t ocd_ms, uint16_t scd_us)
{
    bench_part("bq7692003", NULL);
    b.cfg.shunt_uohm = 1000;
    b.cfg.ocd_ma = ocd_mv * 1000u;
    b.cfg.scd_ma = scd_mv * 1000u;
    b.cfg.ocd_delay_ms = ocd_ms;
    b.cfg.scd_delay_us = scd_us;
}

static void up(void)
{
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
    TEST_ASSERT_EQUAL(BQ_OK, bench_apply(true, true, 0));
    TEST_ASSERT_TRUE(sim_x0_dsg(&b.chip));
}

/* Largest value of a table row that is not above the wish; 0 if none. */
static unsigned best(const uint8_t *table, unsigned n, unsigned wish)
{
    unsigned found = 0;
    while (n-- > 0)
        if (table[n] <= wish && table[n] > found)
            found = table[n];
    return found;
}

static unsigned ocd_now(void)
{
    return rows_ocd_mv[sim_x0_peek(&b.chip, 6) >> 7][sim_x0_peek(&b.chip, 7) & 15];
}

static unsigned scd_now(void)
{
    return rows_scd_mv[sim_x0_peek(&b.chip, 6) >> 7][sim_x0_peek(&b.chip, 6) & 7];
}

static bool trips(double mv, double ms, uint8_t bit)
{
    (void)sim_x0_set_sense(&b.chip, -mv * 1e-3);
    bench_wait(ms);
    (void)sim_x0_set_sense(&b.chip, 0);
    return (b.chip.reg[0] & bit) != 0;
}

/* proves: X0-OCD-03, X0-OCD-11, X0-SCD-01, X0-REG-06, X0-REG-07, X0-ELEC-14, X0-AMB-05, X0-AMB-06, X0-AMB-47
 */
static void test_every_threshold(void)
{
    unsigned wish, scd;
    for (wish = 8; wish <= 120; wish++)
        for (scd = 22; scd <= 320; scd += 7) {
            unsigned fine_o = best(rows_ocd_mv[0], 16, wish), fine_s = best(rows_scd_mv[0], 8, scd);
            unsigned coarse_o = best(rows_ocd_mv[1], 16, wish), coarse_s = best(rows_scd_mv[1], 8, scd);
            bq_status s;
            asked(wish, scd, 8, 70);
            s = bench_init();
            if (s != BQ_OK) { /* refused only when no range has both, one below the other */
                TEST_ASSERT_TRUE(fine_o >= fine_s || !fine_s || (wish > 50 && coarse_o >= coarse_s) ||
                                 (scd > 100 && coarse_o >= coarse_s));
                continue;
            }
            if (bench_random(20) != 0)
                continue;
            up();
            TEST_ASSERT_TRUE(ocd_now() <= wish && scd_now() <= scd && ocd_now() < scd_now());
            TEST_ASSERT_TRUE(ocd_now() == fine_o || ocd_now() == coarse_o);
            TEST_ASSERT_TRUE(scd_now() == fine_s || scd_now() == coarse_s);
            TEST_ASSERT_TRUE(ocd_now() <= 100 && scd_now() <= 200); /* whatever was asked (X0-ELEC-14) */
            TEST_ASSERT_EQUAL(ocd_now(), bq769x0_get_achieved(&b.d)->current.ocd_mv);
            TEST_ASSERT_EQUAL(scd_now(), bq769x0_get_achieved(&b.d)->current.scd_mv);
            TEST_ASSERT_FALSE(trips(ocd_now() - 1.0, 2000, 0x03)); /* a mV away (X0-AMB-47) */
            TEST_ASSERT_FALSE(trips(scd_now() - 1.0, 1, 0x02));
            TEST_ASSERT_TRUE(trips(scd_now() + 1.0, 0.2, 0x02));
            TEST_ASSERT_FALSE(sim_x0_dsg(&b.chip));
            NO_MISUSE();
        }
}

/* What was programmed trips where the part's tolerance says it must, and never below where it may: 10 % and
 * 2.5 mV to each side of the nominal threshold. */
/* proves: X0-OCD-05, X0-SCD-04 */
static void test_the_window_of_every_threshold(void)
{
    int range, i;
    for (range = 0; range < 2; range++) {
        for (i = 0; i < 16; i++) {
            double t = rows_ocd_mv[range][i];
            if (range == 1 && t <= 50)
                continue; /* the fine range has these */
            asked((unsigned)t, range == 0 ? 100 : 200, 8, 70);
            up();
            TEST_ASSERT_EQUAL((unsigned)t, ocd_now());
            TEST_ASSERT_FALSE(trips(0.9 * t - 2.5, 2000, 0x01));
            TEST_ASSERT_TRUE(trips(1.1 * t + 2.5, 12, 0x01));
        }
        for (i = 0; i < 8; i++) {
            double t = rows_scd_mv[range][i];
            if (range == 1 && t <= 100)
                continue;
            asked(range == 0 ? 8 : 56, (unsigned)t, 1280, 70);
            up();
            TEST_ASSERT_EQUAL((unsigned)t, scd_now());
            TEST_ASSERT_FALSE(trips(0.9 * t - 2.5, 1, 0x02));
            TEST_ASSERT_TRUE(trips(1.1 * t + 2.5, 0.2, 0x02));
        }
    }
    NO_MISUSE();
}

/* proves: X0-OCD-04, X0-SCD-02, X0-AMB-48, X0-AMB-44, X0-TIM-13 */
static void test_every_delay(void)
{
    static const uint16_t from_us[4] = {35, 50, 140, 280}, to_us[4] = {105, 150, 260, 520};
    int i, more;
    for (i = 0; i < 8; i++)
        for (more = 0; more < 2; more++) { /* a wish in between is rounded down */
            asked(39, 78, (uint16_t)(rows_ocd_ms[i] + (more ? rows_ocd_ms[i] / 2 : 0)), 400);
            up();
            TEST_ASSERT_EQUAL(i, sim_x0_peek(&b.chip, 7) >> 4);
            TEST_ASSERT_FALSE(trips(45, rows_ocd_ms[i] * 0.8 - 1, 1));
            TEST_ASSERT_FALSE(trips(45, rows_ocd_ms[i] * 0.8 - 1, 1)); /* a gap begins it anew */
            TEST_ASSERT_TRUE(trips(45, rows_ocd_ms[i] * 1.2, 1));
            NO_MISUSE();
        }
    for (i = 0; i < 4; i++)
        for (more = 0; more < 2; more++) {
            asked(39, 78, 1280, (uint16_t)(rows_scd_us[i] + (more ? 20 : 0)));
            up();
            TEST_ASSERT_EQUAL(i, sim_x0_peek(&b.chip, 6) >> 3 & 3);
            TEST_ASSERT_FALSE(trips(90, from_us[i] * 1e-3, 2));
            TEST_ASSERT_TRUE(trips(90, to_us[i] * 1e-3, 2));
            NO_MISUSE();
        }
}

/* proves: X0-OV-04, X0-OV-05, X0-UV-04, X0-UV-05, X0-REG-08, X0-AMB-41 */
static void test_every_voltage_delay(void)
{
    static const uint8_t ov_s[4] = {1, 2, 4, 8}, uv_s[4] = {1, 4, 8, 16};
    static const double ov_from[4] = {0.7, 1.6, 3.5, 7}, ov_to[4] = {1.75, 2.75, 5, 10};
    static const double uv_from[4] = {0.7, 3.5, 7, 14}, uv_to[4] = {1.75, 5, 10, 20};
    int i, under;
    for (i = 0; i < 4; i++)
        for (under = 0; under < 2; under++) {
            double from = under ? uv_from[i] : ov_from[i], to = under ? uv_to[i] : ov_to[i];
            uint8_t bit = under ? 0x08 : 0x04;
            uint64_t t0;
            bench_part("bq7693000", NULL);
            b.cfg.ov_delay_s = under ? 1 : ov_s[i];
            b.cfg.uv_delay_s = under ? uv_s[i] : 1;
            up();
            TEST_ASSERT_EQUAL_HEX8(under ? i << 6 : i << 4, sim_x0_peek(&b.chip, 8));
            (void)sim_x0_set_cell(&b.chip, 9, under ? 2.7 : 4.3);
            t0 = b.chip.now;
            while (!(b.chip.reg[0] & bit) && b.chip.now < t0 + 30000 * MS)
                bench_wait(10);
            TEST_ASSERT_TRUE((double)(b.chip.now - t0) >= from * 1e9 - 1);
            TEST_ASSERT_TRUE((double)(b.chip.now - t0) <= (to + 0.26) * 1e9);
            NO_MISUSE();
        }
}

/* proves: X0-OV-01, X0-OV-02, X0-UV-01, X0-UV-02, X0-REG-09, X0-REG-0A, X0-OV-14, X0-ELEC-13, X0-AMB-03,
   X0-AMB-04, X0-AMB-07, X0-AMB-12, X0-AMB-37 */
static void test_voltage_limits_over_the_range_and_the_trims(void)
{
    int n, refused = 0;
    for (n = 0; n < 600; n++) {
        int gain = 365 + (int)bench_random(32), offset = (int)bench_random(256) - 128;
        int ov = 3000 + (int)bench_random(1900), uv = 1500 + (int)bench_random(1700);
        bq_status s;
        bench_part("bq7692000", NULL);
        (void)sim_x0_set_gain(&b.chip, gain);
        (void)sim_x0_set_offset(&b.chip, offset);
        b.cfg.ov_mv = (uint16_t)ov;
        b.cfg.uv_mv = (uint16_t)uv;
        b.cfg.ov_recover_mv = (uint16_t)(ov - 50);
        b.cfg.uv_recover_mv = (uint16_t)(uv + 50);
        s = bench_init();
        if (s != BQ_OK) { /* limits or recovery thresholds that cross */
            TEST_ASSERT_TRUE(uv + 50 >= ov - 50);
            continue;
        }
        bench_cells((ov + uv) / 2e3);
        s = bench_start();
        if (s != BQ_OK) {
            int lowest_ov = (0x2008 * gain) / 1000 + offset, highest_ov = (0x2ff8 * gain) / 1000 + offset;
            int lowest_uv = (0x1000 * gain) / 1000 + offset, highest_uv = (0x1ff0 * gain) / 1000 + offset;
            TEST_ASSERT_EQUAL(BQ_E_NO_CODE, s);
            TEST_ASSERT_TRUE(ov <= lowest_ov || ov >= highest_ov || uv <= lowest_uv || uv >= highest_uv);
            TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
            refused++;
            continue;
        }
        {
            int32_t o = (0x2000 + 16 * sim_x0_peek(&b.chip, 9) + 8) * gain + 1000 * offset;
            int32_t u = (0x1000 + 16 * sim_x0_peek(&b.chip, 10)) * gain + 1000 * offset;
            TEST_ASSERT_TRUE(o <= ov * 1000 && o > ov * 1000 - 16 * gain);
            TEST_ASSERT_TRUE(u >= uv * 1000 && u < uv * 1000 + 16 * gain);
        }
        NO_MISUSE();
    }
    TEST_ASSERT_TRUE(refused > 20 && refused < 500);
}

/* Shorted inputs of a part whose offset makes them read as something: still shorted, never a cell. */
/* proves: X0-NUM-107, X0-SEQ-12, X0-AMB-09, X0-UV-08 */
static void test_shorted_inputs_under_every_trim(void)
{
    static const int trim[3][2] = {{382, 0}, {380, 30}, {365, -128}};
    static const uint16_t code[3] = {0, 0, 351};
    int t;
    for (t = 0; t < 3; t++) {
        bench_part("bq7694003", NULL);
        (void)sim_x0_set_gain(&b.chip, trim[t][0]);
        (void)sim_x0_set_offset(&b.chip, trim[t][1]);
        b.cfg.cells = 9;
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        bench_serve(500, 250);
        TEST_ASSERT_EQUAL(code[t], sim_x0_peek(&b.chip, 0x10) << 8 | sim_x0_peek(&b.chip, 0x11));
        TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
        TEST_ASSERT_INT_WITHIN(9, 9 * 3600, (int)b.module.stack_mv);
        NO_MISUSE();
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_threshold);
    RUN_TEST(test_the_window_of_every_threshold);
    RUN_TEST(test_every_delay);
    RUN_TEST(test_every_voltage_delay);
    RUN_TEST(test_voltage_limits_over_the_range_and_the_trims);
    RUN_TEST(test_shorted_inputs_under_every_trim);
    return UNITY_END();
}
