/* SPDX-License-Identifier: Apache-2.0 */
/* State of charge: start value at rest, coulomb counting, validity. */
#include "bqhost/pack.h"
#include "bqhost/soc.h"
#include "unity.h"
#include <string.h>

static const bq_ocv_point curve[] = {{0, 3000}, {500, 3600}, {600, 3600}, {1000, 4200}};
static bq_soc_config c;
static bq_soc s;

void setUp(void)
{
    memset(&c, 0, sizeof c);
    c.ocv = curve;
    c.points = 4;
    c.capacity_mah = 5000;
    c.rest_ma = 100;
    c.rest_ms = 1000;
    c.gap_ms = 2000;
    bq_soc_init(&s);
}

void tearDown(void)
{
}

static void rest_at(uint16_t mv)
{
    bq_soc_init(&s);
    for (int n = 0; n <= 10; n++) {
        bq_soc_step(&s, &c, 100, true, 0, mv);
    }
    TEST_ASSERT_TRUE(s.valid);
}

static void test_the_start_value_is_interpolated_and_held_at_the_ends(void)
{
    static const struct {
        uint16_t mv;
        int16_t permille;
    } points[] = {{2000, 0},   {3000, 0},   {3006, 5},   {3300, 250},  {3599, 499},
                  {3600, 500}, {3660, 640}, {3900, 800}, {4200, 1000}, {5000, 1000}};

    for (unsigned i = 0; i < sizeof points / sizeof points[0]; i++) {
        rest_at(points[i].mv);
        TEST_ASSERT_EQUAL(points[i].permille, bq_soc_permille(&s, &c));
    }
}

static void test_the_start_value_waits_for_rest(void)
{
    TEST_ASSERT_EQUAL(-1, bq_soc_permille(&s, &c));
    for (int n = 0; n < 100; n++) {
        bq_soc_step(&s, &c, 100, true, 101, 3300); /* a current above rest */
    }
    TEST_ASSERT_FALSE(s.valid);
    bq_soc_step(&s, &c, 100, true, -100, 3300);
    for (int n = 0; n < 8; n++) {
        bq_soc_step(&s, &c, 100, true, -100, 3300);
    }
    TEST_ASSERT_FALSE(s.valid);
    bq_soc_step(&s, &c, 100, true, -100, 3300); /* 1000 ms of rest */
    TEST_ASSERT_TRUE(s.valid);
}

static void test_rest_is_interrupted_by_a_load_or_an_unknown_current(void)
{
    for (int n = 0; n < 60; n++) {
        const bool known = n % 9 != 8;
        const int32_t ma = n % 7 == 6 ? -5000 : 0;
        bq_soc_step(&s, &c, 200, known, ma, 3300);
    }
    TEST_ASSERT_FALSE(s.valid);
}

static void test_no_start_value_from_an_unknown_voltage(void)
{
    for (int n = 0; n < 100; n++) {
        bq_soc_step(&s, &c, 100, true, 0, 0);
    }
    TEST_ASSERT_FALSE(s.valid);
}

static void test_one_hour_of_charging_and_discharging_counts_exactly(void)
{
    rest_at(3300);
    bq_soc_step(&s, &c, 0, true, 1000, 3300); /* the current jumps */
    for (int n = 0; n < 36000; n++) {
        bq_soc_step(&s, &c, 100, true, 1000, 3300);
    }
    TEST_ASSERT_EQUAL(450, bq_soc_permille(&s, &c)); /* + 1 Ah of 5 Ah */
    bq_soc_step(&s, &c, 0, true, -2000, 3300);
    for (int n = 0; n < 3600; n++) {
        bq_soc_step(&s, &c, 1000, true, -2000, 3300);
    }
    TEST_ASSERT_EQUAL(50, bq_soc_permille(&s, &c));
}

static void test_a_ramp_is_counted_by_its_mean(void)
{
    rest_at(3300);
    bq_soc_step(&s, &c, 3600000, true, 2000, 3300); /* 0 to 2 A within one hour: 1 Ah */
    TEST_ASSERT_EQUAL(450, bq_soc_permille(&s, &c));
}

static void test_the_value_stays_within_empty_and_full(void)
{
    rest_at(3000);
    bq_soc_step(&s, &c, 0, true, -50000, 3000);
    for (int n = 0; n < 1000; n++) {
        bq_soc_step(&s, &c, 1000, true, -50000, 3000);
    }
    TEST_ASSERT_EQUAL(0, bq_soc_permille(&s, &c));
    bq_soc_step(&s, &c, 0, true, 50000, 3000);
    for (int n = 0; n < 1000; n++) {
        bq_soc_step(&s, &c, 1000, true, 50000, 3000);
    }
    TEST_ASSERT_EQUAL(1000, bq_soc_permille(&s, &c));
}

static void test_the_largest_pack_and_current_do_not_overflow(void)
{
    c.capacity_mah = 4000000;
    rest_at(3600);
    bq_soc_step(&s, &c, 86400000, true, INT32_MAX, 3600);
    bq_soc_step(&s, &c, 86400000, true, INT32_MAX, 3600);
    TEST_ASSERT_EQUAL(1000, bq_soc_permille(&s, &c));
    bq_soc_step(&s, &c, 86400000, true, INT32_MIN, 3600);
    bq_soc_step(&s, &c, 86400000, true, INT32_MIN, 3600);
    TEST_ASSERT_EQUAL(0, bq_soc_permille(&s, &c));
    bq_soc_step(&s, &c, 86400001, true, INT32_MAX, 3600); /* too far apart to be counted */
    TEST_ASSERT_EQUAL(-1, bq_soc_permille(&s, &c));
}

static void test_unknown_current_ends_validity_and_rest_restores_it(void)
{
    rest_at(3300);
    for (int n = 0; n < 20; n++) {
        bq_soc_step(&s, &c, 100, false, 0, 3300);
    }
    TEST_ASSERT_EQUAL(250, bq_soc_permille(&s, &c));
    bq_soc_step(&s, &c, 100, false, 0, 3300);
    TEST_ASSERT_EQUAL(-1, bq_soc_permille(&s, &c));
    for (int n = 0; n < 30; n++) {
        bq_soc_step(&s, &c, 100, true, 0, 3900);
    }
    TEST_ASSERT_EQUAL(800, bq_soc_permille(&s, &c));
    for (int n = 0; n < 19; n++) { /* the allowance is there again */
        bq_soc_step(&s, &c, 100, false, 0, 3900);
    }
    TEST_ASSERT_EQUAL(800, bq_soc_permille(&s, &c));
}

static void test_unusable_tables_are_refused(void)
{
    static const bq_ocv_point back[] = {{0, 3000}, {0, 3600}};
    static const bq_ocv_point falls[] = {{0, 3000}, {500, 2999}};
    static const bq_ocv_point above[] = {{0, 3000}, {1001, 4200}};

    TEST_ASSERT_TRUE(bq_soc_config_ok(&c));
    c.rest_ma = 0;
    c.points = 2;
    c.capacity_mah = 4000000;
    TEST_ASSERT_TRUE(bq_soc_config_ok(&c));
    c.ocv = back;
    TEST_ASSERT_FALSE(bq_soc_config_ok(&c));
    c.ocv = falls;
    TEST_ASSERT_FALSE(bq_soc_config_ok(&c));
    c.ocv = above;
    TEST_ASSERT_FALSE(bq_soc_config_ok(&c));
    c.ocv = NULL;
    TEST_ASSERT_FALSE(bq_soc_config_ok(&c));
    setUp();
    c.points = 1;
    TEST_ASSERT_FALSE(bq_soc_config_ok(&c));
    setUp();
    c.capacity_mah = 0;
    TEST_ASSERT_FALSE(bq_soc_config_ok(&c));
    c.capacity_mah = 4000001;
    TEST_ASSERT_FALSE(bq_soc_config_ok(&c));
    setUp();
    c.rest_ma = -1;
    TEST_ASSERT_FALSE(bq_soc_config_ok(&c));
    TEST_ASSERT_FALSE(bq_soc_config_ok(NULL));
    memset(&c, 0, sizeof c); /* none wanted */
    TEST_ASSERT_TRUE(bq_soc_config_ok(&c));
    bq_soc_step(&s, &c, 100, true, 0, 3300);
    TEST_ASSERT_EQUAL(-1, bq_soc_permille(&s, &c));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_start_value_is_interpolated_and_held_at_the_ends);
    RUN_TEST(test_the_start_value_waits_for_rest);
    RUN_TEST(test_rest_is_interrupted_by_a_load_or_an_unknown_current);
    RUN_TEST(test_no_start_value_from_an_unknown_voltage);
    RUN_TEST(test_one_hour_of_charging_and_discharging_counts_exactly);
    RUN_TEST(test_a_ramp_is_counted_by_its_mean);
    RUN_TEST(test_the_value_stays_within_empty_and_full);
    RUN_TEST(test_the_largest_pack_and_current_do_not_overflow);
    RUN_TEST(test_unknown_current_ends_validity_and_rest_restores_it);
    RUN_TEST(test_unusable_tables_are_refused);
    return UNITY_END();
}
