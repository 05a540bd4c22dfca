/* SPDX-License-Identifier: Apache-2.0 */
/* Codes made by the compiler are those of the functions that know the limits only at run time; temperatures
 * by codes against those by resistances. known_refused.sh: what does not compile. */
#include "bqhost/bq769x0_convert.h"
#include "bqhost/bq769x0_known.h"
#include "bqhost/thermistor.h"
#include "unity.h"
#include <math.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static void same(unsigned ocd, unsigned ms, unsigned scd, unsigned us)
{
    bq769x0_current_limits l;
    bq_status st = bq769x0_current_codes(ocd * 1000u + 999u, (uint16_t)ms, scd * 1000u, (uint16_t)us, &l);
    TEST_ASSERT_EQUAL_INT(st == BQ_OK, BQ769X0_FITS(ocd, ms, scd, us, 1u, 1u));
    if (st == BQ_OK) {
        TEST_ASSERT_EQUAL_HEX8(l.protect1, BQ769X0_PROTECT1_OF(ocd, scd, us));
        TEST_ASSERT_EQUAL_HEX8(l.protect2, BQ769X0_PROTECT2_OF(ocd, ms, scd));
    }
}

/* proves: X0-OCD-11, X0-AMB-47, X0-OCD-04, X0-SCD-02 */
static void test_every_pair_of_current_limits(void)
{
    for (unsigned ocd = 0; ocd <= 130u; ocd++) {
        for (unsigned scd = 0; scd <= 240u; scd++) {
            same(ocd, 320, scd, 100);
        }
    }
    for (unsigned ms = 0; ms < 3000u; ms++) {
        same(17, ms, 44, 70);
    }
    for (unsigned us = 0; us < 1000u; us++) {
        same(17, 8, 44, us);
    }
}

/* proves: X0-OV-04, X0-UV-04 */
static void test_every_pair_of_voltage_delays(void)
{
    for (unsigned ov = 0; ov < 40u; ov++) {
        for (unsigned uv = 0; uv < 40u; uv++) {
            uint8_t reg;
            bq_status st = bq769x0_protect3((uint8_t)ov, (uint8_t)uv, &reg);
            TEST_ASSERT_EQUAL_INT(st == BQ_OK, BQ769X0_FITS(17u, 8u, 44u, 70u, ov, uv));
            if (st == BQ_OK) {
                TEST_ASSERT_EQUAL_HEX8(reg, BQ769X0_PROTECT3_OF(ov, uv));
            }
        }
    }
}

static void test_currents_to_the_voltage_of_the_shunt(void)
{
    static const uint32_t uohm[] = {100, 333, 500, 1000, 4999, 100000};
    for (unsigned i = 0; i < sizeof uohm / sizeof uohm[0]; i++) {
        for (uint32_t ma = 0; ma < 400000u; ma += 997u) {
            TEST_ASSERT_EQUAL_UINT32(bq769x0_shunt_uv(ma, uohm[i]) / 1000u, BQ769X0_SHUNT_MV(ma, uohm[i]));
        }
    }
}

/* proves: X0-CELL-16, X0-CELL-18 */
static void test_inputs_that_carry_cells(void)
{
    for (unsigned groups = 1; groups <= 3u; groups++) {
        unsigned inputs = 5u * groups;
        for (unsigned w = 0; w < 0x8000u; w++) {
            bool fed = w >> inputs == 0u;
            for (unsigned g = 0; g < groups; g++) {
                fed = fed && (w >> (5u * g) & 0x13u) == 0x13u;
            }
            TEST_ASSERT_EQUAL_INT(fed, BQ769X0_WIRED(inputs, w));
        }
    }
    TEST_ASSERT_FALSE(BQ769X0_WIRED(6u, 0x33u));
    TEST_ASSERT_EQUAL_UINT(15, BQ769X0_BITS(0x7fffu));
    TEST_ASSERT_EQUAL_UINT(9, BQ769X0_BITS(0x4e73u));
}

/* What the example of the header makes; the numbers are those of the application example. */
static const bq769x0_known example = {
    BQ769X0_PART(10, 0x02f7u),
    .registers = BQ769X0_REGISTERS(BQ769X0_THERMISTORS, BQ769X0_SHUNT_MV(75000, 1000), 320,
                                   BQ769X0_SHUNT_MV(125000, 1000), 100, 2, 4)};

/* proves: X0-NUM-829 */
static void test_one_part_as_a_constant(void)
{
    static const uint8_t registers[12] = {0, 0, 0, 0, 0x18, 0, 0x8b, 0x5a, 0x50, 0, 0, 0x19};
    TEST_ASSERT_EQUAL_HEX8_ARRAY(registers, example.registers, 12);
    TEST_ASSERT_EQUAL_UINT(15, example.first);
    TEST_ASSERT_EQUAL_UINT(10, example.codes);
    TEST_ASSERT_EQUAL_UINT(2, example.groups);
    TEST_ASSERT_EQUAL_UINT(8, example.cells);
    TEST_ASSERT_EQUAL_HEX16(0x02f7, example.in_use);
}

/* proves: X0-TS-05, X0-NUM-901, X0-NUM-902, X0-NUM-903, X0-NUM-904, X0-NUM-905, X0-NUM-906, X0-NUM-907,
 * X0-NUM-908 */
static void test_codes_of_resistances(void)
{
    static const uint32_t row[][2] = {{0, 0},       {100, 86},     {1000, 785},   {2000, 1440},
                                      {5000, 2880}, {10000, 4319}, {20000, 5759}, {50000, 7199}};
    for (unsigned i = 0; i < sizeof row / sizeof row[0]; i++) {
        TEST_ASSERT_EQUAL_UINT(row[i][1], BQ769X0_TS_CODE(row[i][0]));
    }
}

/* Every code through a table of codes and through the resistances behind it. */
/* proves: X0-TS-05, X0-TS-07 */
static void test_temperatures_by_codes(void)
{
    enum { N = 111 };
    static uint16_t codes[N];
    const bq_thermistor *t = &bq_thermistor_103at;
    bq769x0_code_table table = {codes, N, 0, 0};
    TEST_ASSERT_EQUAL_UINT(N, t->count);
    for (unsigned i = 0; i < N; i++) {
        codes[i] = BQ769X0_TS_CODE(t->ohms[i]);
    }
    table.first_dc = t->first_dc;
    table.step_dc = t->step_dc;
    for (unsigned code = 0; code < 0x4000u; code++) {
        int16_t dc = 7777, other = 0;
        bool good = bq769x0_sensor_codes(&table, (uint16_t)code, &dc);
        TEST_ASSERT_EQUAL_INT(code <= codes[0] && code >= codes[N - 1], good);
        if (good && bq769x0_sensor_thermistor(t, (uint16_t)code, &other)) {
            TEST_ASSERT_INT_WITHIN(1, other, dc);
        }
        if (!good) {
            TEST_ASSERT_EQUAL_INT(7777, dc);
        }
    }
    for (unsigned i = 0; i < N; i++) {
        int16_t dc;
        TEST_ASSERT_TRUE(bq769x0_sensor_codes(&table, codes[i], &dc));
        TEST_ASSERT_EQUAL_INT(-400 + 15 * (int)i, dc);
    }
}

/* The table that comes with it, against the curve. */
static void test_the_usual_sensor_by_codes(void)
{
    for (unsigned code = 454; code < 8304u; code++) {
        double volts = code * 382e-6, ohms = 10000.0 * volts / (3.3 - volts);
        double celsius = 1.0 / (1.0 / 298.15 + log(ohms / 10000.0) / 3435.0) - 273.15;
        int16_t dc;
        TEST_ASSERT_TRUE(bq769x0_sensor_codes(&bq769x0_codes_103at, (uint16_t)code, &dc));
        TEST_ASSERT_TRUE(fabs(dc / 10.0 - celsius) < 0.1);
    }
}

/* proves: X0-DIE-02 */
static void test_the_die(void)
{
    uint32_t v25_uv = 1200000;
    int16_t dc = 0;
    TEST_ASSERT_TRUE(bq769x0_sensor_die(&v25_uv, 3141, &dc)); /* 1.2 V */
    TEST_ASSERT_INT_WITHIN(1, 250, dc);
    TEST_ASSERT_FALSE(bq769x0_sensor_thermistor(&bq_thermistor_103at, 0x3fff, &dc)); /* open */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_pair_of_current_limits);
    RUN_TEST(test_every_pair_of_voltage_delays);
    RUN_TEST(test_currents_to_the_voltage_of_the_shunt);
    RUN_TEST(test_inputs_that_carry_cells);
    RUN_TEST(test_one_part_as_a_constant);
    RUN_TEST(test_codes_of_resistances);
    RUN_TEST(test_temperatures_by_codes);
    RUN_TEST(test_the_usual_sensor_by_codes);
    RUN_TEST(test_the_die);
    return UNITY_END();
}
