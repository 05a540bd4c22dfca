/* SPDX-License-Identifier: Apache-2.0 */
/* Thermistors, die sensors, their 2 s rhythm; gain and offset tables. */
#include "rig.h"
#include <math.h>

static int first_code(bool thermistors, double ohms, double celsius)
{
    rig_pulse("bq7694003");
    for (int i = 1; i <= 3; i++) {
        TEST_ASSERT_EQUAL(0, sim_x0_set_ts(&chip, i, ohms));
    }
    TEST_ASSERT_EQUAL(0, sim_x0_set_tdie(&chip, celsius));
    rig_at(20);
    TEST_ASSERT_TRUE(rig_write(0x04, thermistors ? 0x18 : 0x10));
    rig_at(810);
    TEST_ASSERT_EQUAL(rig_read16(0x2c), rig_read16(0x2e));
    TEST_ASSERT_EQUAL(rig_read16(0x2c), rig_read16(0x30));
    return rig_read16(0x2c);
}

/*
 * proves: X0-NUM-901, X0-NUM-902, X0-NUM-903, X0-NUM-904, X0-NUM-905, X0-NUM-906, X0-NUM-907, X0-NUM-908,
 *     X0-NUM-909, X0-NUM-910, X0-TS-01, X0-TS-03, X0-TS-05, X0-TS-06, X0-AMB-31, X0-AMB-32, X0-PIN-06
 */
static void test_thermistor_codes(void)
{
    static const struct {
        double ohms;
        int code;
        double back;
    } c[] = {{0, 0, 0.0},
             {100, 86, 100.6},
             {1000, 785, 999.5},
             {2000, 1440, 2000.3},
             {5000, 2880, 5001.1},
             {10000, 4319, 9998.3},
             {20000, 5759, 19998.3},
             {50000, 7199, 50002.0},
             {100000, 7853, 99943.6}};
    for (size_t i = 0; i < sizeof c / sizeof c[0]; i++) {
        double volts = c[i].code * 382e-6;
        TEST_ASSERT_EQUAL(c[i].code, first_code(true, c[i].ohms, -40.0));
        TEST_ASSERT_DOUBLE_WITHIN(0.05, c[i].back, 10000.0 * volts / (3.3 - volts));
    }
    TEST_ASSERT_EQUAL(8639, first_code(true, (double)INFINITY, 25.0));
}

/*
 * proves: X0-NUM-911, X0-NUM-912, X0-NUM-913, X0-NUM-914, X0-NUM-915, X0-NUM-916, X0-NUM-917, X0-DIE-01,
 *     X0-DIE-02, X0-DIE-03
 */
static void test_die_codes(void)
{
    static const struct {
        double celsius;
        int code;
        double back;
    } c[] = {{-40, 3856, -40.00}, {0, 3416, 0.02},    {25, 3141, 25.03},  {60, 2757, 59.96},
             {85, 2482, 84.97},   {100, 2317, 99.98}, {125, 2042, 124.99}};
    for (size_t i = 0; i < sizeof c / sizeof c[0]; i++) {
        TEST_ASSERT_EQUAL(c[i].code, first_code(false, 1234.0, c[i].celsius));
        TEST_ASSERT_DOUBLE_WITHIN(0.006, c[i].back, 25.0 - (c[i].code * 382e-6 - 1.2) / 0.0042);
    }
}

/* proves: X0-AMB-31, X0-TS-05, X0-DIE-02 */
static void test_gain_and_offset_do_not_touch_temperatures(void)
{
    rig_pulse("bq7692000");
    (void)sim_x0_set_gain(&chip, 396);
    (void)sim_x0_set_offset(&chip, 127);
    rig_at(260);
    TEST_ASSERT_EQUAL(3141, rig_read16(0x2c));
}

static void changes_every_2_s(const rig_part *p)
{
    double first;
    rig_pulse(p->name);
    first = rig_first_ms();
    rig_at(first - 1);
    TEST_ASSERT_EQUAL_HEX8(0, sim_x0_peek(&chip, 0x2c));
    rig_at(first);
    TEST_ASSERT_EQUAL(3141, rig_read16(0x2c));
    (void)sim_x0_set_tdie(&chip, 85.0);
    rig_at(first + 1999);
    TEST_ASSERT_EQUAL(3141, rig_read16(0x2c));
    rig_at(first + 2000);
    for (int i = 0; i < p->inputs / 5; i++) {
        TEST_ASSERT_EQUAL(2482, rig_read16(0x2c + 2 * i));
    }
    TEST_ASSERT_TRUE(rig_write(0x04, 0x18)); /* the new source shows with the next publication */
    rig_at(first + 3999);
    TEST_ASSERT_EQUAL(2482, rig_read16(0x2c));
    rig_at(first + 4000);
    for (int i = 0; i < p->inputs / 5; i++) {
        TEST_ASSERT_EQUAL(4319, rig_read16(0x2c + 2 * i));
    }
    TEST_ASSERT_TRUE(rig_write(0x04, 0x10)); /* it is looked at when published, not before */
    rig_at(first + 5000);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x18));
    rig_at(first + 6000);
    TEST_ASSERT_EQUAL(4319, rig_read16(0x2c));
}

/*
 * proves: X0-TS-11, X0-SCH-06, X0-SCH-07, X0-TIM-04, X0-TIM-14, X0-AMB-29, X0-AMB-30, X0-BIT-12, X0-TS-01,
 *     X0-DIE-01
 */
static void test_temperatures_are_published_every_2_s(void)
{
    rig_each(changes_every_2_s);
}

/* proves: X0-TS-02, X0-TS-01 */
static void test_each_sensor_has_its_own_code(void)
{
    rig_pulse("bq7694000");
    (void)sim_x0_set_ts(&chip, 1, 5000);
    (void)sim_x0_set_ts(&chip, 2, 20000);
    (void)sim_x0_set_ts(&chip, 3, 50000);
    rig_at(20);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x18));
    rig_at(810);
    TEST_ASSERT_EQUAL(2880, rig_read16(0x2c));
    TEST_ASSERT_EQUAL(5759, rig_read16(0x2e));
    TEST_ASSERT_EQUAL(7199, rig_read16(0x30));
}

/* proves: X0-TS-01, X0-SCH-07 */
static void test_temperatures_do_not_disturb_cells(void)
{
    rig_boot("bq7692000");
    for (int n = 0; n < 20; n++) {
        (void)sim_x0_set_cell(&chip, 1, (5000 + n) * 382e-6);
        rig_wait(250);
        TEST_ASSERT_EQUAL(5000 + n, rig_read16(0x0c));
    }
}

/*
 * proves: X0-NUM-301, X0-NUM-302, X0-NUM-303, X0-NUM-304, X0-NUM-305, X0-NUM-306, X0-NUM-307, X0-NUM-308,
 *     X0-NUM-309, X0-NUM-310, X0-NUM-311, X0-NUM-312, X0-NUM-313, X0-NUM-314, X0-NUM-315, X0-NUM-316,
 *     X0-NUM-317, X0-NUM-318, X0-NUM-319, X0-NUM-320, X0-NUM-321, X0-NUM-322, X0-NUM-323, X0-NUM-324,
 *     X0-NUM-325, X0-NUM-326, X0-NUM-327, X0-NUM-328, X0-NUM-329, X0-NUM-330, X0-NUM-331, X0-NUM-332,
 *     X0-ADC-03
 */
static void test_the_gain_table(void)
{
    rig_boot("bq7693003");
    for (int g = 0; g < 32; g++) {
        static const int low[8] = {0x00, 0x20, 0x40, 0x60, 0x80, 0xa0, 0xc0, 0xe0};
        static const int high[4] = {0x00, 0x04, 0x08, 0x0c};
        TEST_ASSERT_EQUAL(0, sim_x0_set_gain(&chip, 365 + g));
        expect_reg(0x50, high[g / 8]);
        expect_reg(0x59, low[g % 8]);
    }
    TEST_ASSERT_EQUAL(-1, sim_x0_set_gain(&chip, 364));
    TEST_ASSERT_EQUAL(-1, sim_x0_set_gain(&chip, 397));
    expect_reg(0x50, 0x0c);
    expect_reg(0x59, 0xe0);
}

/*
 * proves: X0-NUM-401, X0-NUM-402, X0-NUM-403, X0-NUM-404, X0-NUM-405, X0-NUM-406, X0-NUM-407, X0-NUM-408,
 *     X0-NUM-409, X0-ADC-05
 */
static void test_the_offset_table(void)
{
    static const struct {
        int byte, mv;
    } c[] = {{0x00, 0},  {0x01, 1},  {0x7f, 127}, {0x80, -128}, {0x81, -127},
             {0xff, -1}, {0x1e, 30}, {0x30, 48},  {0xc4, -60}};
    for (size_t i = 0; i < sizeof c / sizeof c[0]; i++) {
        rig_pulse("bq7692003");
        TEST_ASSERT_EQUAL(0, sim_x0_set_offset(&chip, c[i].mv));
        rig_at(260);
        expect_reg(0x51, c[i].byte);
        /* and the codes are made with it: 3.82 V is 10000 codes above the offset */
        (void)sim_x0_set_cell(&chip, 1, 3.82 + c[i].mv * 1e-3);
        rig_at(510);
        TEST_ASSERT_EQUAL(10000, rig_read16(0x0c));
    }
    TEST_ASSERT_EQUAL(-1, sim_x0_set_offset(&chip, -129));
    TEST_ASSERT_EQUAL(-1, sim_x0_set_offset(&chip, 128));
}

static void test_inputs_that_make_no_sense_are_refused(void)
{
    const double not_a_number = (double)NAN;
    rig_boot("bq7692000");
    TEST_ASSERT_EQUAL(-1, sim_x0_set_tdie(&chip, not_a_number));
    TEST_ASSERT_EQUAL(-1, sim_x0_set_ts(&chip, 1, -1.0));
    TEST_ASSERT_EQUAL(-1, sim_x0_set_ts(&chip, 1, not_a_number));
    TEST_ASSERT_EQUAL(-1, sim_x0_set_cell(&chip, 1, (double)INFINITY));
    TEST_ASSERT_EQUAL(-1, sim_x0_set_sense(&chip, not_a_number));
    TEST_ASSERT_EQUAL(-1, sim_x0_set_chgpin(&chip, not_a_number));
    rig_wait(2000);
    TEST_ASSERT_EQUAL(3141, rig_read16(0x2c));
    TEST_ASSERT_EQUAL(9424, rig_read16(0x0c));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_thermistor_codes);
    RUN_TEST(test_die_codes);
    RUN_TEST(test_gain_and_offset_do_not_touch_temperatures);
    RUN_TEST(test_temperatures_are_published_every_2_s);
    RUN_TEST(test_each_sensor_has_its_own_code);
    RUN_TEST(test_temperatures_do_not_disturb_cells);
    RUN_TEST(test_the_gain_table);
    RUN_TEST(test_the_offset_table);
    RUN_TEST(test_inputs_that_make_no_sense_are_refused);
    return UNITY_END();
}
