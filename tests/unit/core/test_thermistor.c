/* SPDX-License-Identifier: Apache-2.0 */
#include "bqhost/bq76pl536_convert.h"
#include "bqhost/thermistor.h"
#include "unity.h"
#include <math.h>

void setUp(void)
{
}

void tearDown(void)
{
}

/* The curve of the sensor: R25 = 10 kOhm, beta = 3435. */
static double celsius_of(double ohms)
{
    return 1.0 / (1.0 / 298.15 + log(ohms / 10000.0) / 3435.0) - 273.15;
}

static double ohms_of(double celsius)
{
    return 10000.0 * exp(3435.0 * (1.0 / (celsius + 273.15) - 1.0 / 298.15));
}

/* Every whole number of ohms of the range. */
/* proves: PL-TS-08 */
static void test_every_resistance_lies_within_a_tenth_of_the_curve(void)
{
    uint32_t last = (uint32_t)ceil(ohms_of(125.0)), first = (uint32_t)floor(ohms_of(-40.0));
    int16_t before = 32767;
    for (uint32_t ohms = last; ohms <= first; ohms++) {
        int16_t dc = 0;
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq_thermistor_dc(&bq_thermistor_103at, ohms, &dc));
        TEST_ASSERT_TRUE(fabs(dc / 10.0 - celsius_of(ohms)) < 0.1);
        TEST_ASSERT_LESS_OR_EQUAL(before, dc);
        before = dc;
    }
}

static void test_known_points(void)
{
    static const struct {
        uint32_t ohms;
        int16_t dc;
    } points[] = {{10000, 250}, {248277, -400}, {554, 1250}};
    for (unsigned i = 0; i < sizeof points / sizeof points[0]; i++) {
        int16_t dc = 0;
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq_thermistor_dc(&bq_thermistor_103at, points[i].ohms, &dc));
        TEST_ASSERT_EQUAL_INT(points[i].dc, dc);
    }
}

/* From the converter code of either input to a temperature: the whole path, every code inside the range of
 * the table. */
/* proves: PL-TS-01, PL-TS-02, PL-TS-09 */
static void test_from_code_to_temperature(void)
{
    for (unsigned code = 1; code < 0x3fffu; code++) {
        uint32_t ohms1 = 0, ohms2 = 0;
        int16_t dc = 0;
        double exact1 = 1820.0 * 33046.0 / (code + 2.0) - 3290.0,
               exact2 = 1820.0 * 33068.0 / (code + 9.0) - 3290.0;
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_ts_ohms(1, (uint16_t)code, &ohms1));
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_ts_ohms(2, (uint16_t)code, &ohms2));
        if (bq_thermistor_dc(&bq_thermistor_103at, ohms1, &dc) == BQ_OK) {
            TEST_ASSERT_DOUBLE_WITHIN(0.15, celsius_of(exact1), dc / 10.0);
        }
        if (bq_thermistor_dc(&bq_thermistor_103at, ohms2, &dc) == BQ_OK) {
            TEST_ASSERT_DOUBLE_WITHIN(0.15, celsius_of(exact2), dc / 10.0);
        }
    }
}

static void test_outside_the_table_the_nearest_end_is_given_with_an_error(void)
{
    int16_t dc = 0;
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq_thermistor_dc(&bq_thermistor_103at, 553, &dc));
    TEST_ASSERT_EQUAL_INT(1250, dc);
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq_thermistor_dc(&bq_thermistor_103at, 0, &dc));
    TEST_ASSERT_EQUAL_INT(1250, dc);
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq_thermistor_dc(&bq_thermistor_103at, 248278, &dc));
    TEST_ASSERT_EQUAL_INT(-400, dc);
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq_thermistor_dc(&bq_thermistor_103at, 0xffffffff, &dc));
    TEST_ASSERT_EQUAL_INT(-400, dc);
}

/* The largest numbers the types allow do not overflow inside. */
static void test_a_table_of_two_extreme_points(void)
{
    static const uint32_t ohms[2] = {0xffffffff, 0};
    static const bq_thermistor wide = {ohms, 2, 0, 32767};
    int16_t dc = 0;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq_thermistor_dc(&wide, 0xffffffff, &dc));
    TEST_ASSERT_EQUAL_INT(0, dc);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq_thermistor_dc(&wide, 0, &dc));
    TEST_ASSERT_EQUAL_INT(32767, dc);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq_thermistor_dc(&wide, 0x80000000, &dc));
    TEST_ASSERT_INT_WITHIN(1, 16384, dc);
}

static void test_the_finest_table(void)
{
    static const uint32_t ohms[3] = {30, 20, 10};
    static const bq_thermistor fine = {ohms, 3, 250, 1};
    int16_t dc = 0;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq_thermistor_dc(&fine, 16, &dc));
    TEST_ASSERT_EQUAL_INT(251, dc);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq_thermistor_dc(&fine, 15, &dc));
    TEST_ASSERT_EQUAL_INT(252, dc);
}

static void test_impossible_tables_are_refused(void)
{
    static const uint32_t ohms[2] = {2000, 1000};
    const bq_thermistor none = {NULL, 2, 0, 10}, one = {ohms, 1, 0, 10}, still = {ohms, 2, 0, 0},
                        back = {ohms, 2, 0, -10};
    int16_t dc = 4711;
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq_thermistor_dc(NULL, 1500, &dc));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq_thermistor_dc(&none, 1500, &dc));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq_thermistor_dc(&one, 1500, &dc));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq_thermistor_dc(&still, 1500, &dc));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq_thermistor_dc(&back, 1500, &dc));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq_thermistor_dc(&bq_thermistor_103at, 1500, NULL));
    TEST_ASSERT_EQUAL_INT(4711, dc);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_resistance_lies_within_a_tenth_of_the_curve);
    RUN_TEST(test_known_points);
    RUN_TEST(test_from_code_to_temperature);
    RUN_TEST(test_outside_the_table_the_nearest_end_is_given_with_an_error);
    RUN_TEST(test_a_table_of_two_extreme_points);
    RUN_TEST(test_the_finest_table);
    RUN_TEST(test_impossible_tables_are_refused);
    return UNITY_END();
}
