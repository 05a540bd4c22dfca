/* SPDX-License-Identifier: Apache-2.0 */
/* The coulomb counter: codes, its own 250 ms grid, one-shot and always-on, and their corners. */
#include "rig.h"

#define READY 0x80
#define ON 0x40
#define SHOT 0x20

/* The OCD and SCD bits belong to another test. */
static int ready(void)
{
    return rig_read(0x00) & READY;
}

static void prepare(const char *part, const sim_x0_options *options)
{
    rig_boot_with(part, options);
    rig_at(1000);
    TEST_ASSERT_TRUE(rig_write(0x0b, 0x19));
}

static int code_of(double volts)
{
    prepare("bq7692000", NULL);
    (void)sim_x0_set_sense(&chip, volts);
    TEST_ASSERT_TRUE(rig_write(0x05, ON));
    rig_wait(250);
    TEST_ASSERT_EQUAL_HEX8(READY, ready());
    return rig_read16(0x32);
}

/*
 * proves: X0-NUM-201, X0-NUM-202, X0-NUM-203, X0-NUM-204, X0-NUM-205, X0-NUM-206, X0-NUM-207, X0-NUM-208,
 *     X0-NUM-209, X0-NUM-210, X0-NUM-211, X0-NUM-212, X0-NUM-213, X0-NUM-214, X0-CC-01, X0-CC-03, X0-CC-11,
 *     X0-AMB-21, X0-AMB-23, X0-PIN-05
 */
static void test_codes(void)
{
    static const struct {
        double uv;
        int code;
    } c[] = {{8.44, 0x0001},       {84400.0, 0x2710},  {270080.0, 0x7d00}, {-270080.0, 0x8300},
             {-131123.84, 0xc350}, {-8.44, 0xffff},    {0.0, 0x0000},      {276553.48, 0x7fff},
             {-276561.92, 0x8000}, {-50000.0, 0xe8dc}, {50000.0, 0x1724},  {-10000.0, 0xfb5f},
             {-200000.0, 0xa36f},  {1000.0, 0x0076},   {400000.0, 0x7fff}, {-400000.0, 0x8000}};
    for (size_t i = 0; i < sizeof c / sizeof c[0]; i++) {
        TEST_ASSERT_EQUAL_HEX16(c[i].code, code_of(c[i].uv * 1e-6));
    }
}

static void runs_without_gaps(const rig_part *p)
{
    prepare(p->name, NULL);
    (void)sim_x0_set_sense(&chip, 0.010);
    TEST_ASSERT_FALSE(sim_x0_alert(&chip));
    rig_at(1017); /* its own grid, from the moment of enabling */
    TEST_ASSERT_TRUE(rig_write(0x05, ON));
    for (int n = 1; n <= 5; n++) {
        rig_at(1017 + 250 * n - 0.001);
        expect_stat(0x00);
        TEST_ASSERT_FALSE(sim_x0_alert(&chip));
        rig_at(1017 + 250 * n);
        expect_stat(READY);
        TEST_ASSERT_TRUE(sim_x0_alert(&chip));
        TEST_ASSERT_EQUAL(1185, rig_read16(0x32));
        TEST_ASSERT_TRUE(rig_write(0x00, READY));
        expect_stat(0x00);
        TEST_ASSERT_FALSE(sim_x0_alert(&chip));
        expect_reg(0x05, ON);
    }
    expect_clean();
}

/* proves: X0-CC-04, X0-SCH-10, X0-AMB-27, X0-TIM-06, X0-BIT-05, X0-AMB-26, X0-AMB-99 */
static void test_always_on(void)
{
    rig_each(runs_without_gaps);
}

/* proves: X0-CC-02, X0-SCH-09 */
static void test_the_code_is_the_mean_of_the_window(void)
{
    prepare("bq7692003", NULL);
    TEST_ASSERT_TRUE(rig_write(0x05, ON));
    (void)sim_x0_set_sense(&chip, 0.100);
    rig_wait(25);
    (void)sim_x0_set_sense(&chip, -0.010);
    rig_wait(125);
    (void)sim_x0_set_sense(&chip, 0.001);
    rig_wait(100);
    /* (0.1 x 25 - 0.01 x 125 + 0.001 x 100) / 250 = 5.4 mV = 639.8 */
    TEST_ASSERT_EQUAL(640, rig_read16(0x32));
    (void)sim_x0_set_sense(&chip, 0.0); /* nothing leaks into the next window */
    rig_wait(250);
    TEST_ASSERT_EQUAL(0, rig_read16(0x32));
}

/* proves: X0-CC-05, X0-BIT-14, X0-AMB-24 */
static void test_one_shot(void)
{
    prepare("bq7692003", NULL);
    (void)sim_x0_set_sense(&chip, 0.010);
    TEST_ASSERT_TRUE(rig_write(0x05, SHOT));
    rig_wait(249.999);
    expect_reg(0x05, SHOT);
    expect_stat(0x00);
    TEST_ASSERT_EQUAL(0, rig_read16(0x32));
    rig_wait(0.001);
    expect_reg(0x05, 0x00);
    expect_stat(READY);
    TEST_ASSERT_EQUAL(1185, rig_read16(0x32));
    TEST_ASSERT_TRUE(rig_write(0x00, READY));
    (void)sim_x0_set_sense(&chip, 0.020);
    rig_wait(5000); /* off again */
    expect_stat(0x00);
    TEST_ASSERT_EQUAL(1185, rig_read16(0x32));
    TEST_ASSERT_TRUE(rig_write(0x05, SHOT));
    rig_wait(250);
    TEST_ASSERT_EQUAL(2370, rig_read16(0x32));
    expect_clean();
}

/* proves: X0-CC-06, X0-AMB-25 */
static void test_one_shot_while_always_on_has_no_effect(void)
{
    prepare("bq7692003", NULL);
    TEST_ASSERT_TRUE(rig_write(0x05, ON));
    rig_wait(100);
    TEST_ASSERT_TRUE(rig_write(0x05, ON | SHOT));
    expect_reg(0x05, ON);
    rig_wait(150);
    expect_stat(READY); /* the grid was not disturbed */
    rig_clear();
    rig_wait(250);
    expect_stat(READY);
    expect_reg(0x05, ON);
    rig_clear();
    TEST_ASSERT_TRUE(
        rig_write(0x05, SHOT)); /* CC_EN still was 1 when this came: it only turns the counter off */
    expect_reg(0x05, 0x00);
    rig_wait(1000);
    expect_stat(0x00);
}

/* proves: X0-CC-07, X0-AMB-25 */
static void test_one_shot_while_ready_is_set(void)
{
    sim_x0_options ignored = {.amb25_ready_ignored = true};
    for (int other = 0; other < 2; other++) {
        prepare("bq7692003", other ? &ignored : NULL);
        TEST_ASSERT_TRUE(rig_write(0x05, SHOT));
        rig_wait(250);
        expect_stat(READY);
        (void)sim_x0_set_sense(&chip, 0.010);
        TEST_ASSERT_TRUE(rig_write(0x05, SHOT));
        expect_reg(0x05, other ? SHOT : 0x00);
        rig_wait(300);
        TEST_ASSERT_EQUAL(other ? 1185 : 0, rig_read16(0x32));
    }
}

/* proves: X0-CC-08 */
static void test_an_uncleared_result_is_replaced(void)
{
    prepare("bq7692003", NULL);
    (void)sim_x0_set_sense(&chip, 0.010);
    TEST_ASSERT_TRUE(rig_write(0x05, ON));
    rig_wait(250);
    expect_stat(READY);
    TEST_ASSERT_TRUE(rig_write(0x00, 0x00)); /* writing 0 clears nothing */
    (void)sim_x0_set_sense(&chip, 0.020);
    rig_wait(250);
    expect_stat(READY);
    TEST_ASSERT_EQUAL(2370, rig_read16(0x32));
    TEST_ASSERT_TRUE(rig_write(0x00, READY));
    expect_stat(0x00); /* one clear for both */
}

/* proves: X0-AMB-26, X0-CC-14 */
static void test_aborted_windows(void)
{
    prepare("bq7692003", NULL);
    (void)sim_x0_set_sense(&chip, 0.010);
    TEST_ASSERT_TRUE(rig_write(0x05, ON));
    rig_wait(250);
    rig_clear();
    (void)sim_x0_set_sense(&chip, 0.020);
    rig_wait(249);
    TEST_ASSERT_TRUE(rig_write(0x05, 0x00)); /* CC_EN 0: no result */
    rig_wait(1000);
    expect_stat(0x00);
    TEST_ASSERT_EQUAL(1185, rig_read16(0x32)); /* the last code stays */
    TEST_ASSERT_TRUE(rig_write(0x05, SHOT));
    rig_wait(200);
    TEST_ASSERT_TRUE(rig_write(0x05, SHOT)); /* again: no effect */
    expect_reg(0x05, SHOT);
    rig_wait(50);
    expect_stat(READY);
    rig_clear();
    TEST_ASSERT_TRUE(rig_write(0x05, SHOT));
    rig_wait(200);
    TEST_ASSERT_TRUE(rig_write(0x05, 0x00)); /* 0 aborts */
    rig_wait(1000);
    expect_stat(0x00);
    TEST_ASSERT_TRUE(rig_write(0x05, SHOT));
    rig_wait(200);
    TEST_ASSERT_TRUE(rig_write(0x05, ON)); /* always-on drops it and starts a grid */
    expect_reg(0x05, ON);
    rig_wait(249);
    expect_stat(0x00);
    rig_wait(1);
    expect_stat(READY);
}

/* proves: X0-AMB-26 */
static void test_a_window_that_finishes_in_the_other_reading(void)
{
    sim_x0_options finishes = {.amb26_finishes = true};
    prepare("bq7692003", &finishes);
    (void)sim_x0_set_sense(&chip, 0.010);
    TEST_ASSERT_TRUE(rig_write(0x05, ON));
    rig_wait(100);
    TEST_ASSERT_TRUE(rig_write(0x05, 0x00));
    rig_wait(150);
    expect_stat(READY);
    TEST_ASSERT_EQUAL(1185, rig_read16(0x32));
    rig_clear();
    rig_wait(1000);
    expect_stat(0x00);
}

/* proves: X0-CC-15, X0-CC-14 */
static void test_the_counter_off_is_silent(void)
{
    rig_boot("bq7692003");
    (void)sim_x0_set_sense(&chip, 0.010);
    for (int i = 0; i < 40; i++) {
        rig_wait(250);
        expect_stat(0x00);
        TEST_ASSERT_FALSE(sim_x0_alert(&chip));
    }
    TEST_ASSERT_EQUAL(0, rig_read16(0x32));
    expect_clean(); /* CC_CFG does not matter while the counter is unused */
}

/* proves: X0-CC-10, X0-AMB-28 */
static void test_cc_cfg_must_be_programmed(void)
{
    rig_boot("bq7692003");
    (void)sim_x0_set_sense(&chip, 0.010);
    TEST_ASSERT_TRUE(rig_write(0x05, ON));
    rig_wait(250);
    TEST_ASSERT_EQUAL(1185, rig_read16(0x32)); /* converts ideally all the same */
    expect_misuse("X0-CC-10");
    TEST_ASSERT_TRUE(rig_write(0x0b, 0x18));
    rig_wait(250);
    expect_misuse("X0-CC-10");
    TEST_ASSERT_TRUE(rig_write(0x0b, 0x19));
    rig_wait(1000);
    expect_clean();
}

/* proves: X0-MODE-15, X0-AMB-16 */
static void test_the_counter_runs_without_the_converter(void)
{
    prepare("bq7692003", NULL);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x00));
    (void)sim_x0_set_sense(&chip, 0.010);
    TEST_ASSERT_TRUE(rig_write(0x05, ON));
    rig_wait(250);
    expect_stat(READY);
    TEST_ASSERT_EQUAL(1185, rig_read16(0x32));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_codes);
    RUN_TEST(test_always_on);
    RUN_TEST(test_the_code_is_the_mean_of_the_window);
    RUN_TEST(test_one_shot);
    RUN_TEST(test_one_shot_while_always_on_has_no_effect);
    RUN_TEST(test_one_shot_while_ready_is_set);
    RUN_TEST(test_an_uncleared_result_is_replaced);
    RUN_TEST(test_aborted_windows);
    RUN_TEST(test_a_window_that_finishes_in_the_other_reading);
    RUN_TEST(test_the_counter_off_is_silent);
    RUN_TEST(test_cc_cfg_must_be_programmed);
    RUN_TEST(test_the_counter_runs_without_the_converter);
    return UNITY_END();
}
