/* SPDX-License-Identifier: Apache-2.0 */
/* Overcurrent and short circuit in discharge, and the bypass of the delays. */
#include "rig.h"

#define OCD 0x01
#define SCD 0x02
#define CHG 0x01
#define DSG 0x02

static const int ocd_mv[2][16] = {
    {8, 11, 14, 17, 19, 22, 25, 28, 31, 33, 36, 39, 42, 44, 47, 50},
    {17, 22, 28, 33, 39, 44, 50, 56, 61, 67, 72, 78, 83, 89, 94, 100},
};
static const int scd_mv[2][8] = {{22, 33, 44, 56, 67, 78, 89, 100}, {44, 67, 89, 111, 133, 155, 178, 200}};
static const int ocd_ms[8] = {8, 20, 40, 80, 160, 320, 640, 1280};
static const int scd_us[4] = {70, 100, 200, 400};

static void prepare(const char *part, const sim_x0_options *options, int protect1, int protect2)
{
    rig_boot_with(part, options);
    rig_at(900);
    TEST_ASSERT_TRUE(rig_block_write(0x06, (uint8_t[]){(uint8_t)protect1, (uint8_t)protect2}, 2));
    TEST_ASSERT_TRUE(rig_write(0x05, CHG | DSG));
    rig_at(1000);
}

static void discharge(double mv)
{
    TEST_ASSERT_EQUAL(0, sim_x0_set_sense(&chip, -mv / 1000.0));
}

/*
 * proves: X0-NUM-601, X0-NUM-602, X0-NUM-603, X0-NUM-604, X0-NUM-605, X0-NUM-606, X0-NUM-607, X0-NUM-608,
 *     X0-NUM-609, X0-NUM-610, X0-NUM-611, X0-NUM-612, X0-NUM-613, X0-NUM-614, X0-NUM-615, X0-NUM-616,
 *     X0-OCD-03, X0-OCD-05, X0-OCD-09, X0-AMB-47
 */
static void test_overcurrent_thresholds(void)
{
    for (int range = 0; range < 2; range++) {
        for (int code = 0; code < 16; code++) {
            prepare("bq7692003", NULL, range << 7 | 7, code); /* SCD out of the way where it can be */
            discharge(ocd_mv[range][code]);
            rig_wait(5000);
            TEST_ASSERT_EQUAL(0, rig_read(0x00) & OCD); /* not exceeded */
            discharge(ocd_mv[range][code] + 0.01);
            rig_wait(8);
            TEST_ASSERT_EQUAL(OCD, rig_read(0x00) & OCD);
        }
    }
}

/*
 * proves: X0-NUM-625, X0-NUM-626, X0-NUM-627, X0-NUM-628, X0-NUM-629, X0-NUM-630, X0-NUM-631, X0-NUM-632,
 *     X0-SCD-01, X0-SCD-04, X0-OCD-09, X0-AMB-47
 */
static void test_short_circuit_thresholds(void)
{
    for (int range = 0; range < 2; range++) {
        for (int code = 0; code < 8; code++) {
            prepare("bq7692003", NULL, range << 7 | code, 0x7f); /* OCD 1.28 s away */
            discharge(scd_mv[range][code]);
            rig_wait(1000);
            expect_stat(0x00);
            discharge(scd_mv[range][code] + 0.01);
            rig_wait(0.07);
            expect_stat(SCD);
        }
    }
}

/*
 * proves: X0-NUM-617, X0-NUM-618, X0-NUM-619, X0-NUM-620, X0-NUM-621, X0-NUM-622, X0-NUM-623, X0-NUM-624,
 *     X0-OCD-04, X0-OCD-06, X0-OCD-07, X0-FET-05, X0-TIM-11, X0-BIT-07, X0-FET-12
 */
static void test_overcurrent_delays(void)
{
    for (int code = 0; code < 8; code++) {
        prepare("bq7692003", NULL, 0x07, code << 4);
        expect_reg(0x07, code << 4);
        discharge(10);
        rig_wait(ocd_ms[code] - 0.001);
        expect_stat(0x00);
        expect_reg(0x05, CHG | DSG);
        TEST_ASSERT_FALSE(sim_x0_alert(&chip));
        rig_wait(0.001);
        expect_stat(OCD);
        expect_reg(0x05, CHG);
        TEST_ASSERT_TRUE(sim_x0_alert(&chip));
        TEST_ASSERT_FALSE(sim_x0_dsg(&chip));
        TEST_ASSERT_TRUE(sim_x0_chg(&chip));
    }
}

/*
 * proves: X0-NUM-633, X0-NUM-634, X0-NUM-635, X0-NUM-636, X0-SCD-02, X0-SCD-05, X0-FET-06, X0-AMB-48,
 *     X0-TIM-11, X0-TIM-12, X0-BIT-07
 */
static void test_short_circuit_delays(void)
{
    for (int code = 0; code < 4; code++) {
        prepare("bq7692003", NULL, code << 3, 0x7f);
        expect_reg(0x06, code << 3);
        discharge(23);
        rig_wait((scd_us[code] - 1) * 1e-3);
        expect_stat(0x00);
        expect_reg(0x05, CHG | DSG);
        rig_wait(0.001);
        expect_stat(SCD);
        expect_reg(0x05, CHG);
        TEST_ASSERT_TRUE(sim_x0_alert(&chip));
    }
}

/*
 * proves: X0-NUM-637, X0-NUM-638, X0-NUM-639, X0-NUM-640, X0-NUM-641, X0-NUM-642, X0-NUM-643, X0-AMB-01
 */
static void test_protect1_values(void)
{
    static const struct {
        int value, us, mv;
    } c[] = {{0x00, 70, 22},   {0x80, 70, 44},   {0x8b, 100, 111}, {0x8c, 100, 133},
             {0x17, 200, 100}, {0x9f, 400, 200}, {0x1d, 400, 78}};
    for (size_t i = 0; i < sizeof c / sizeof c[0]; i++) {
        prepare("bq7694003", NULL, c[i].value, 0x7f);
        discharge(c[i].mv);
        rig_wait(1000);
        expect_stat(0x00);
        discharge(c[i].mv + 1);
        rig_wait((c[i].us - 1) * 1e-3);
        expect_stat(0x00);
        rig_wait(0.001);
        expect_stat(SCD);
    }
}

/* proves: X0-NUM-644, X0-NUM-645, X0-NUM-646, X0-NUM-647, X0-NUM-648, X0-AMB-02 */
static void test_protect2_values(void)
{
    static const struct {
        int value, ms, mv[2];
    } c[] = {{0x00, 8, {8, 17}},
             {0x5a, 320, {36, 72}},
             {0x5b, 320, {39, 78}},
             {0x7f, 1280, {50, 100}},
             {0x37, 80, {28, 56}}};
    for (size_t i = 0; i < sizeof c / sizeof c[0]; i++) {
        for (int range = 0; range < 2; range++) {
            prepare("bq7694003", NULL, range << 7 | 7, c[i].value);
            discharge(c[i].mv[range]);
            rig_wait(3000);
            expect_stat(0x00);
            discharge(c[i].mv[range] + 1);
            rig_wait(c[i].ms - 0.001);
            expect_stat(0x00);
            rig_wait(0.001);
            expect_stat(OCD);
        }
    }
}

/* proves: X0-OCD-02, X0-AMB-22, X0-SCD-05 */
static void test_charge_current_never_trips(void)
{
    prepare("bq7692000", NULL, 0x00, 0x00);
    discharge(-250);
    rig_wait(10000);
    expect_stat(0x00);
    expect_reg(0x05, CHG | DSG);
}

/* proves: X0-OCD-06, X0-AMB-44, X0-SCD-05 */
static void test_a_dip_restarts_the_counter(void)
{
    prepare("bq7692000", NULL, 0x00, 0x00);
    for (int i = 0; i < 10; i++) {
        discharge(10);
        rig_wait(7.999);
        discharge(8); /* at the threshold is not above it */
        rig_wait(0.001);
    }
    expect_stat(0x00);
    discharge(10);
    rig_wait(8);
    expect_stat(OCD);
    prepare("bq7692000", NULL, 0x00, 0x7f);
    for (int i = 0; i < 10; i++) {
        discharge(30);
        rig_wait(0.069);
        discharge(22);
        rig_wait(0.001);
    }
    expect_stat(0x00);
}

/* proves: X0-OCD-01, X0-MODE-15, X0-SCD-05 */
static void test_the_comparators_need_neither_adc_nor_counter_nor_fets(void)
{
    rig_boot("bq7694006");
    TEST_ASSERT_TRUE(rig_write(0x04, 0x00));
    discharge(30);
    rig_wait(0.070);
    expect_stat(SCD);
    rig_wait(7.930);
    expect_stat(SCD | OCD);
    rig_pulse("bq7694006"); /* from the instant of NORMAL */
    discharge(10);
    rig_at(17.999);
    expect_stat(0x00);
    rig_at(18);
    expect_stat(OCD);
}

/* proves: X0-SCD-06, X0-AMB-45 */
static void test_both_run_independently(void)
{
    prepare("bq7692003", NULL, 0x18, 0x10); /* 400 us, 20 ms */
    discharge(30);
    rig_wait(0.4);
    expect_stat(SCD);
    rig_wait(19.599);
    expect_stat(SCD);
    rig_wait(0.001);
    expect_stat(SCD | OCD);
}

/* proves: X0-OCD-08, X0-SCD-07, X0-AMB-43 */
static void test_cleared_bits_come_back_after_the_delay(void)
{
    sim_x0_options at_once = {.amb43_at_once = true};
    prepare("bq7692003", NULL, 0x18, 0x10);
    discharge(30);
    rig_wait(100);
    rig_clear();
    expect_stat(0x00);
    rig_wait(0.399);
    expect_stat(0x00);
    rig_wait(0.001);
    expect_stat(SCD);
    TEST_ASSERT_TRUE(rig_write(0x00, SCD)); /* does not touch the other counter */
    rig_wait(19.6);
    expect_stat(SCD | OCD);
    discharge(0);
    rig_wait(1000);
    expect_stat(SCD | OCD); /* latched */
    rig_clear();
    rig_wait(1000);
    expect_stat(0x00);
    expect_clean();
    prepare("bq7692003", &at_once, 0x18, 0x10); /* the other reading */
    discharge(30);
    rig_wait(100);
    rig_clear();
    expect_stat(SCD | OCD);
}

/* proves: X0-AMB-46, X0-OCD-09 */
static void test_new_settings_apply_to_the_running_counter(void)
{
    prepare("bq7692003", NULL, 0x07, 0x70);
    discharge(10);
    rig_wait(500);
    TEST_ASSERT_TRUE(rig_write(0x07, 0x40)); /* 160 ms are over */
    expect_stat(OCD);
    prepare("bq7692003", NULL, 0x07, 0x70);
    discharge(10);
    rig_wait(500);
    TEST_ASSERT_TRUE(rig_write(0x06, 0x87)); /* RSNS doubles: 17 mV */
    rig_wait(5000);
    expect_stat(0x00);
}

/* proves: X0-DLY-01, X0-DLY-02, X0-AMB-49, X0-TIM-13 */
static void test_the_bypass(void)
{
    prepare("bq7692003", NULL, 0x1f, 0x7f);
    TEST_ASSERT_TRUE(rig_write(0x08, 0xf0));
    expect_reg(0x05, CHG | DSG);
    TEST_ASSERT_TRUE(rig_write(0x05, 0x83));
    expect_reg(0x05, 0x83);
    discharge(51);
    expect_stat(OCD);
    discharge(101);
    expect_stat(OCD | SCD);
    discharge(0);
    rig_clear();
    (void)sim_x0_set_cell(&chip, 1, 4.3);
    (void)sim_x0_set_cell(&chip, 2, 2.0);
    rig_at(1009.999);
    expect_stat(0x00);
    rig_at(1010);
    expect_stat(0x0c);
    prepare("bq7692003", NULL, 0x1f, 0x7f); /* set while the counters run */
    discharge(101);
    rig_wait(0.1);
    expect_stat(0x00);
    TEST_ASSERT_TRUE(rig_write(0x05, 0x83));
    expect_stat(OCD | SCD);
    expect_reg(0x05, 0x81);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_overcurrent_thresholds);
    RUN_TEST(test_short_circuit_thresholds);
    RUN_TEST(test_overcurrent_delays);
    RUN_TEST(test_short_circuit_delays);
    RUN_TEST(test_protect1_values);
    RUN_TEST(test_protect2_values);
    RUN_TEST(test_charge_current_never_trips);
    RUN_TEST(test_a_dip_restarts_the_counter);
    RUN_TEST(test_the_comparators_need_neither_adc_nor_counter_nor_fets);
    RUN_TEST(test_both_run_independently);
    RUN_TEST(test_cleared_bits_come_back_after_the_delay);
    RUN_TEST(test_new_settings_apply_to_the_running_counter);
    RUN_TEST(test_the_bypass);
    return UNITY_END();
}
