/* SPDX-License-Identifier: Apache-2.0 */
/* Codes of the converter: every code in both directions against the formulas, and every worked example. */
#include "bqhost/bq76pl536_convert.h"
#include "unity.h"
#include <math.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static uint16_t cell_mv(unsigned code)
{
    uint16_t mv = 0xffff;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_cell_mv((uint16_t)code, &mv));
    return mv;
}

static uint32_t cell_uv(unsigned code)
{
    uint32_t uv = 0xffffffff;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_cell_uv((uint16_t)code, &uv));
    return uv;
}

static uint16_t cell_code(uint32_t uv)
{
    uint16_t code = 0xffff;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_cell_code(uv, &code));
    return code;
}

static uint16_t brick_mv(unsigned code)
{
    uint16_t mv = 0xffff;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_brick_mv((uint16_t)code, &mv));
    return mv;
}

static uint16_t brick_code(uint32_t mv)
{
    uint16_t code = 0xffff;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_brick_code(mv, &code));
    return code;
}

static uint32_t gpai_uv(unsigned code)
{
    uint32_t uv = 0xffffffff;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_gpai_uv((uint16_t)code, &uv));
    return uv;
}

static uint16_t gpai_code(uint32_t uv)
{
    uint16_t code = 0xffff;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_gpai_code(uv, &code));
    return code;
}

static uint32_t ts_ppm(uint8_t sensor, unsigned code)
{
    uint32_t ppm = 0xffffffff;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_ts_ratio_ppm(sensor, (uint16_t)code, &ppm));
    return ppm;
}

static uint16_t ts_code(uint8_t sensor, uint32_t ppm)
{
    uint16_t code = 0xffff;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_ts_code(sensor, ppm, &code));
    return code;
}

static long nearest(long double value)
{
    return (long)floorl(value + 0.5L);
}

/* proves: PL-VCELL-01, PL-VCELL-03, PL-VCELL-05, PL-AMB-60 */
static void test_every_cell_code_both_ways(void)
{
    for (unsigned code = 0; code <= 0x3fffu; code++) {
        TEST_ASSERT_EQUAL_INT(nearest(code * 6250.0L / 16383.0L), cell_mv(code));
        TEST_ASSERT_EQUAL_INT(nearest(code * 6250000.0L / 16383.0L), cell_uv(code));
        TEST_ASSERT_EQUAL_HEX16(code, cell_code(cell_uv(code)));
    }
    for (uint32_t mv = 0; mv <= 6250u; mv++) {
        TEST_ASSERT_EQUAL_INT(nearest(mv * 16383.0L / 6250.0L), cell_code(mv * 1000u));
        TEST_ASSERT_EQUAL_INT(mv, cell_mv(cell_code(mv * 1000u)));
    }
}

/* proves: PL-NUM-01, PL-NUM-07, PL-NUM-08 */
static void test_cell_examples(void)
{
    static const struct {
        uint32_t mv;
        unsigned code;
        double back_mv;
    } rows[] = {{0, 0x0000, 0.00},       {700, 0x072b, 700.04},   {1000, 0x0a3d, 999.89},
                {1200, 0x0c4a, 1200.18}, {2000, 0x147b, 2000.17}, {2500, 0x1999, 2499.92},
                {3000, 0x1eb8, 3000.06}, {3300, 0x21ca, 3299.91}, {3350, 0x224d, 3349.89},
                {3600, 0x24dd, 3600.15}, {3700, 0x25e3, 3700.10}, {4150, 0x2a7e, 4149.88},
                {4200, 0x2b01, 4199.86}, {4500, 0x2e14, 4500.09}, {5000, 0x3332, 4999.85},
                {6000, 0x3d70, 6000.12}, {6250, 0x3fff, 6250.00}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        TEST_ASSERT_EQUAL_HEX16(rows[i].code, cell_code(rows[i].mv * 1000u));
        TEST_ASSERT_DOUBLE_WITHIN(0.0051, rows[i].back_mv, cell_uv(rows[i].code) / 1000.0);
    }
    TEST_ASSERT_EQUAL_UINT(3349890, cell_uv(0x224d));
}

/* proves: PL-GPAI-01, PL-GPAI-03, PL-AMB-57 */
static void test_every_gpai_code_both_ways(void)
{
    for (unsigned code = 0; code <= 0x3fffu; code++) {
        uint32_t ppm = 0;
        TEST_ASSERT_EQUAL_INT(nearest(code * 2500000.0L / 16383.0L), gpai_uv(code));
        TEST_ASSERT_EQUAL_HEX16(code, gpai_code(gpai_uv(code)));
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_gpai_ratio_ppm((uint16_t)code, &ppm));
        TEST_ASSERT_EQUAL_INT(nearest(code * 1000000.0L / 32766.0L), ppm);
    }
}

/* 1.25 V lies exactly between two codes: halves go up. */
/* proves: PL-NUM-02, PL-NUM-07, PL-NUM-09 */
static void test_gpai_examples(void)
{
    static const struct {
        uint32_t mv;
        unsigned code;
        double back_mv;
    } rows[] = {{0, 0x0000, 0.00},       {250, 0x0666, 249.95},   {500, 0x0ccd, 500.06},
                {1000, 0x1999, 999.97},  {1250, 0x2000, 1250.08}, {2000, 0x3332, 1999.94},
                {2400, 0x3d70, 2400.05}, {2500, 0x3fff, 2500.00}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        TEST_ASSERT_EQUAL_HEX16(rows[i].code, gpai_code(rows[i].mv * 1000u));
        TEST_ASSERT_DOUBLE_WITHIN(0.0051, rows[i].back_mv, gpai_uv(rows[i].code) / 1000.0);
    }
    TEST_ASSERT_EQUAL_UINT(1250076, gpai_uv(0x2000));
}

/* proves: PL-VBAT-01, PL-AMB-58, PL-AMB-60 */
static void test_every_brick_code_both_ways(void)
{
    for (unsigned code = 0; code <= 0x3fffu; code++) {
        TEST_ASSERT_EQUAL_INT(nearest(code * 33333.0L / 16384.0L), brick_mv(code));
        TEST_ASSERT_EQUAL_HEX16(code, brick_code(brick_mv(code)));
    }
    for (uint32_t mv = 0; mv <= 33331u; mv++) {
        TEST_ASSERT_EQUAL_INT(nearest(mv * 16384.0L / 33333.0L), brick_code(mv));
    }
}

/* proves: PL-NUM-03, PL-NUM-06, PL-NUM-07, PL-NUM-10 */
static void test_brick_examples(void)
{
    static const struct {
        uint32_t mv;
        unsigned code, back_mv;
    } rows[] = {{0, 0x0000, 0},         {7200, 0x0dd3, 7200},   {10800, 0x14bc, 10799},
                {14400, 0x1ba6, 14400}, {18000, 0x228f, 17999}, {20000, 0x2666, 19999},
                {20295, 0x26f7, 20294}, {21600, 0x2979, 21600}, {25200, 0x3062, 25199},
                {27000, 0x33d7, 27000}, {30000, 0x399a, 30001}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        TEST_ASSERT_EQUAL_HEX16(rows[i].code, brick_code(rows[i].mv));
        TEST_ASSERT_EQUAL_UINT(rows[i].back_mv, brick_mv(rows[i].code));
    }
    TEST_ASSERT_EQUAL_UINT(33331, brick_mv(0x3fff));
}

/* proves: PL-TS-01, PL-TS-02 */
static void test_every_temperature_code_both_ways(void)
{
    for (unsigned code = 0; code <= 0x3fffu; code++) {
        TEST_ASSERT_EQUAL_INT(nearest((code + 2u) * 1000000.0L / 33046.0L), ts_ppm(1, code));
        TEST_ASSERT_EQUAL_INT(nearest((code + 9u) * 1000000.0L / 33068.0L), ts_ppm(2, code));
        TEST_ASSERT_EQUAL_HEX16(code, ts_code(1, ts_ppm(1, code)));
        TEST_ASSERT_EQUAL_HEX16(code, ts_code(2, ts_ppm(2, code)));
    }
}

/* proves: PL-NUM-04, PL-NUM-05, PL-NUM-07, PL-NUM-11, PL-AMB-75 */
static void test_temperature_examples(void)
{
    static const struct {
        uint32_t ppm;
        unsigned ts1, ts2;
    } rows[] = {{50000, 0x0672, 0x066c},  {100000, 0x0ce7, 0x0ce2}, {136900, 0x11aa, 0x11a6},
                {200000, 0x19cf, 0x19cd}, {250000, 0x2044, 0x2042}, {300000, 0x26b8, 0x26b7},
                {400000, 0x33a0, 0x33a2}, {480000, 0x3df4, 0x3df8}};
    uint16_t code;
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        TEST_ASSERT_EQUAL_HEX16(rows[i].ts1, ts_code(1, rows[i].ppm));
        TEST_ASSERT_EQUAL_HEX16(rows[i].ts2, ts_code(2, rows[i].ppm));
    }
    TEST_ASSERT_EQUAL_UINT(132421, ts_ppm(1, 0x1116));
    TEST_ASSERT_EQUAL_HEX16(0x110f, ts_code(1, 132200));
    TEST_ASSERT_EQUAL_HEX16(0x1115, ts_code(1, 132400));
    TEST_ASSERT_EQUAL_HEX16(0x1116, ts_code(1, 132420));
    TEST_ASSERT_EQUAL_HEX16(0x0001, ts_code(1, 100));
    TEST_ASSERT_EQUAL_UINT(61, ts_ppm(1, 0));
    TEST_ASSERT_EQUAL_UINT(272, ts_ppm(2, 0));
    TEST_ASSERT_EQUAL_UINT(495824, ts_ppm(1, 0x3fff)); /* 0.49582 */
    TEST_ASSERT_EQUAL_UINT(495706, ts_ppm(2, 0x3fff)); /* 0.49571 */
    /* A chip clips here; the host's encoder refuses. */
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_ts_code(1, 0, &code));
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_ts_code(2, 100, &code));
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_ts_code(1, 500000, &code));
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_ts_code(2, 600000, &code));
}

/* proves: PL-TS-08, PL-TS-09 */
static void test_every_temperature_code_as_resistance(void)
{
    for (unsigned code = 1; code < 0x3fffu; code++) {
        uint32_t ohms1 = 0, ohms2 = 0;
        uint16_t back = 0;
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_ts_ohms(1, (uint16_t)code, &ohms1));
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_ts_ohms(2, (uint16_t)code, &ohms2));
        TEST_ASSERT_EQUAL_INT(nearest(1820.0L * 33046.0L / (code + 2u)) - 3290, ohms1);
        TEST_ASSERT_EQUAL_INT(nearest(1820.0L * 33068.0L / (code + 9u)) - 3290, ohms2);
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_ts_code_of_ohms(1, ohms1, &back));
        TEST_ASSERT_INT_WITHIN(code < 7700u ? 0 : 3, code, back); /* beyond, one ohm spans several codes */
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_ts_code_of_ohms(2, ohms2, &back));
        TEST_ASSERT_INT_WITHIN(code < 7700u ? 0 : 3, code, back);
    }
}

/* The printed codes belong to the printed ratio of five digits; 10000 ohms exactly give 4523.49 and 4519.50,
 * one code less. */
/* proves: PL-NUM-12 */
static void test_thermistor_at_25_degrees(void)
{
    uint16_t code = 0;
    TEST_ASSERT_EQUAL_HEX16(0x11ac, ts_code(1, 136950));
    TEST_ASSERT_EQUAL_HEX16(0x11a8, ts_code(2, 136950));
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_ts_code_of_ohms(1, 10000, &code));
    TEST_ASSERT_EQUAL_HEX16(0x11ab, code);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_ts_code_of_ohms(2, 10000, &code));
    TEST_ASSERT_EQUAL_HEX16(0x11a7, code);
}

/* proves: PL-TS-09, PL-SEQ-06-07 */
static void test_open_and_shorted_sensors_are_no_resistances(void)
{
    uint32_t ohms = 4711;
    uint16_t code = 4711;
    for (uint8_t sensor = 1; sensor <= 2u; sensor++) {
        TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_ts_ohms(sensor, 0x0000, &ohms));
        TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_ts_ohms(sensor, 0x3fff, &ohms));
        TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_ts_ohms(sensor, 0x4000, &ohms));
        TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_ts_code_of_ohms(sensor, 0, &code));
        TEST_ASSERT_EQUAL_INT(BQ_E_RANGE,
                              bq76pl536_ts_code_of_ohms(sensor, sensor == 1u ? 30000000u : 6684000u, &code));
        TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_ts_code_of_ohms(sensor, 100000000, &code));
        TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_ts_code_of_ohms(sensor, 0xffffffff, &code));
    }
    TEST_ASSERT_EQUAL_UINT(4711, ohms);
    TEST_ASSERT_EQUAL_UINT(4711, code);
    TEST_ASSERT_TRUE(bq76pl536_code_clipped(0));
    TEST_ASSERT_FALSE(bq76pl536_code_clipped(1));
    TEST_ASSERT_FALSE(bq76pl536_code_clipped(0x3ffe));
    TEST_ASSERT_TRUE(bq76pl536_code_clipped(0x3fff));
}

/* proves: PL-VCELL-06 */
static void test_impossible_codes_and_values_are_refused(void)
{
    uint32_t value = 4711;
    uint16_t narrow = 4711;
    for (uint32_t code = 0x4000; code <= 0xffffu; code++) {
        TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_cell_mv((uint16_t)code, &narrow));
        TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_brick_mv((uint16_t)code, &narrow));
    }
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_cell_uv(0x4000, &value));
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_gpai_uv(0x4000, &value));
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_gpai_ratio_ppm(0x8000, &value));
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_ts_ratio_ppm(1, 0x4000, &value));
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_cell_code(6250001, &narrow));
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_cell_code(0xffffffff, &narrow));
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_gpai_code(2500001, &narrow));
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_brick_code(33332, &narrow));
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_brick_code(33333, &narrow));
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_brick_code(0xffffffff, &narrow));
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_ts_code(1, 0xffffffff, &narrow));
    TEST_ASSERT_EQUAL_UINT(4711, value);
    TEST_ASSERT_EQUAL_UINT(4711, narrow);
}

static void test_missing_pointers_and_sensors_are_refused(void)
{
    uint32_t value;
    uint16_t narrow;
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_cell_uv(1, NULL));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_cell_code(1, NULL));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_brick_code(1, NULL));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_gpai_uv(1, NULL));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_gpai_code(1, NULL));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_gpai_ratio_ppm(1, NULL));
    for (uint8_t sensor = 0; sensor < 4u; sensor++) {
        bool exists = sensor == 1u || sensor == 2u;
        TEST_ASSERT_EQUAL_INT(exists ? BQ_OK : BQ_E_ARG, bq76pl536_ts_ratio_ppm(sensor, 1000, &value));
        TEST_ASSERT_EQUAL_INT(exists ? BQ_OK : BQ_E_ARG, bq76pl536_ts_code(sensor, 1000, &narrow));
        TEST_ASSERT_EQUAL_INT(exists ? BQ_OK : BQ_E_ARG, bq76pl536_ts_ohms(sensor, 1000, &value));
        TEST_ASSERT_EQUAL_INT(exists ? BQ_OK : BQ_E_ARG, bq76pl536_ts_code_of_ohms(sensor, 1000, &narrow));
        TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_ts_ratio_ppm(sensor, 1000, NULL));
        TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_ts_code(sensor, 1000, NULL));
        TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_ts_ohms(sensor, 1000, NULL));
        TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_ts_code_of_ohms(sensor, 1000, NULL));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_cell_code_both_ways);
    RUN_TEST(test_cell_examples);
    RUN_TEST(test_every_gpai_code_both_ways);
    RUN_TEST(test_gpai_examples);
    RUN_TEST(test_every_brick_code_both_ways);
    RUN_TEST(test_brick_examples);
    RUN_TEST(test_every_temperature_code_both_ways);
    RUN_TEST(test_temperature_examples);
    RUN_TEST(test_every_temperature_code_as_resistance);
    RUN_TEST(test_thermistor_at_25_degrees);
    RUN_TEST(test_open_and_shorted_sensors_are_no_resistances);
    RUN_TEST(test_impossible_codes_and_values_are_refused);
    RUN_TEST(test_missing_pointers_and_sensors_are_refused);
    return UNITY_END();
}
