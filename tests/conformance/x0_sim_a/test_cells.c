/* SPDX-License-Identifier: Apache-2.0 */
/* Cell and stack codes, gain and offset, and when they are published. */
#include "rig.h"

/* A first publication with these trims; every input at `volts`. */
static void publish(const char *part, int gain, int offset, double volts)
{
    rig_pulse(part);
    TEST_ASSERT_EQUAL(0, sim_x0_set_gain(&chip, gain));
    TEST_ASSERT_EQUAL(0, sim_x0_set_offset(&chip, offset));
    for (int i = 1; i <= chip.part->cells; i++) {
        TEST_ASSERT_EQUAL(0, sim_x0_set_cell(&chip, i, volts));
    }
    rig_at(rig_first_ms());
}

static void gives(int gain, int offset, int mv, int code, double back_mv)
{
    publish("bq7692000", gain, offset, mv * 1e-3);
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL(code, rig_read16(0x0c + 2 * i));
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.0005, back_mv, code * gain * 1e-3 + offset); /* X0-ADC-02 */
    TEST_ASSERT_DOUBLE_WITHIN(gain * 0.5e-3 + 1e-6, mv, back_mv);
}

/* proves: X0-NUM-101, X0-NUM-102, X0-ADC-02 */
static void test_the_worked_examples(void)
{
    publish("bq7692000", 380, 30, 2.36472);
    TEST_ASSERT_EQUAL_HEX16(0x1800, rig_read16(0x0c));
    publish("bq7692000", 380, 30, 3.05176);
    TEST_ASSERT_EQUAL_HEX16(0x1f10, rig_read16(0x0c));
}

/* proves: X0-NUM-103, X0-NUM-104, X0-NUM-105, X0-NUM-106, X0-ADC-07, X0-ADC-08, X0-ADC-09 */
static void test_ideal_codes(void)
{
    static const struct {
        int gain, offset;
        struct {
            int mv, code;
            double back;
        } row[8];
    } set[4] = {
        {382,
         0,
         {{2000, 5236, 2000.152},
          {2500, 6545, 2500.19},
          {3000, 7853, 2999.846},
          {3600, 9424, 3599.968},
          {3650, 9555, 3650.01},
          {4200, 10995, 4200.09},
          {4300, 11257, 4300.174},
          {5000, 13089, 4999.998}}},
        {380,
         30,
         {{2000, 5184, 1999.92},
          {2500, 6500, 2500},
          {3000, 7816, 3000.08},
          {3600, 9395, 3600.1},
          {3650, 9526, 3649.88},
          {4200, 10974, 4200.12},
          {4300, 11237, 4300.06},
          {5000, 13079, 5000.02}}},
        {365,
         -128,
         {{2000, 5830, 1999.95},
          {2500, 7200, 2500},
          {3000, 8570, 3000.05},
          {3600, 10214, 3600.11},
          {3650, 10351, 3650.115},
          {4200, 11858, 4200.17},
          {4300, 12132, 4300.18},
          {5000, 14049, 4999.885}}},
        {396,
         127,
         {{2000, 4730, 2000.08},
          {2500, 5992, 2499.832},
          {3000, 7255, 2999.98},
          {3600, 8770, 3599.92},
          {3650, 8896, 3649.816},
          {4200, 10285, 4199.86},
          {4300, 10538, 4300.048},
          {5000, 12306, 5000.176}}},
    };
    for (int s = 0; s < 4; s++) {
        for (int i = 0; i < 8; i++) {
            gives(set[s].gain, set[s].offset, set[s].row[i].mv, set[s].row[i].code, set[s].row[i].back);
        }
    }
}

/* proves: X0-NUM-107, X0-NUM-108, X0-ADC-07, X0-UV-06 */
static void test_the_ends_of_the_range(void)
{
    static const struct {
        int gain, offset, shorted;
        double minqual_mv;
    } c[] = {{382, 0, 0, 498.128}, {380, 30, 0, 525.52}, {365, -128, 351, 347.96}, {396, 127, 0, 643.384}};
    for (int i = 0; i < 4; i++) {
        publish("bq7692000", c[i].gain, c[i].offset, 0.0);
        TEST_ASSERT_EQUAL(c[i].shorted, rig_read16(0x0c));
        publish("bq7692000", c[i].gain, c[i].offset, c[i].minqual_mv * 1e-3);
        TEST_ASSERT_EQUAL_HEX16(0x0518, rig_read16(0x0c));
        publish("bq7692000", c[i].gain, c[i].offset, 9.0);
        TEST_ASSERT_EQUAL_HEX16(0x3fff, rig_read16(0x0c));
        publish("bq7692000", c[i].gain, c[i].offset, -9.0);
        TEST_ASSERT_EQUAL_HEX16(0x0000, rig_read16(0x0c));
    }
    publish("bq7692000", 382, 0, 16382 * 382e-6);
    TEST_ASSERT_EQUAL_HEX16(0x3ffe, rig_read16(0x0c));
}

/* proves: X0-NUM-109, X0-NUM-110, X0-NUM-111, X0-NUM-112, X0-BAT-01, X0-BAT-02, X0-BAT-03, X0-AMB-08 */
static void test_stack_codes(void)
{
    static const struct {
        const char *part;
        int gain, offset, code;
        double volts, mv;
    } c[] = {{"bq7692003", 380, 30, 0x26d4, 3.05176, 15258.8},
             {"bq7692003", 382, 0, 0x2e04, 3.6, 17999.84},
             {"bq7693003", 382, 0, 0x5c08, 3.6, 35999.68},
             {"bq7694003", 382, 0, 0x8a0c, 3.6, 53999.52}};
    for (int i = 0; i < 4; i++) {
        publish(c[i].part, c[i].gain, c[i].offset, c[i].volts);
        TEST_ASSERT_EQUAL_HEX16(c[i].code, rig_read16(0x2a));
        TEST_ASSERT_DOUBLE_WITHIN(0.005, c[i].mv,
                                  4e-3 * c[i].gain * c[i].code + chip.part->cells * c[i].offset);
    }
}

/* proves: X0-NUM-113, X0-BAT-03, X0-AMB-10 */
static void test_the_stack_code_drops_its_fraction(void)
{
    sim_x0_options rounds = {.amb10_bat_rounds = true};
    publish("bq7692000", 382, 0, 9423 * 382e-6);
    TEST_ASSERT_EQUAL(9423, rig_read16(0x0c));
    TEST_ASSERT_EQUAL_HEX16(0x2e02, rig_read16(0x2a));
    rig_pulse_with("bq7692000", &rounds); /* the other reading: one code more */
    for (int i = 1; i <= 5; i++) {
        (void)sim_x0_set_cell(&chip, i, 9423 * 382e-6);
    }
    rig_at(260);
    TEST_ASSERT_EQUAL_HEX16(0x2e03, rig_read16(0x2a));
    publish("bq7694000", 382, 0, 9.0);
    TEST_ASSERT_EQUAL(61436, rig_read16(0x2a));
}

/* proves: X0-BAT-03, X0-AMB-09, X0-NUM-107 */
static void test_shorted_inputs_count_in_the_stack_code(void)
{
    static const struct {
        int gain, offset, code;
    } c[] = {{365, -128, 20603}, {380, 30, 18790}};
    for (int i = 0; i < 2; i++) {
        rig_pulse("bq7693000");
        (void)sim_x0_set_gain(&chip, c[i].gain);
        (void)sim_x0_set_offset(&chip, c[i].offset);
        (void)sim_x0_set_cell(&chip, 4, 0.0);
        (void)sim_x0_set_cell(&chip, 9, 0.0);
        rig_at(410);
        TEST_ASSERT_EQUAL(c[i].code, rig_read16(0x2a));
    }
}

static void set_all(double volts)
{
    for (int i = 1; i <= chip.part->cells; i++) {
        (void)sim_x0_set_cell(&chip, i, volts);
    }
}

/* Before the first publication 0; then the value at each 250 ms instant, all inputs at once. */
static void publishes_on_time(const rig_part *p)
{
    double first;
    rig_pulse(p->name);
    first = rig_first_ms();
    for (int n = 0; n < 6; n++) {
        int before = n == 0 ? 0 : 5000 + 100 * (n - 1), after = 5000 + 100 * n;
        rig_at(first + 250 * n - 1);
        set_all(after * 382e-6);
        for (int i = 0; i < p->inputs; i++) {
            TEST_ASSERT_EQUAL(before, sim_x0_peek(&chip, (uint8_t)(0x0c + 2 * i)) << 8 |
                                          sim_x0_peek(&chip, (uint8_t)(0x0d + 2 * i)));
        }
        TEST_ASSERT_EQUAL(before * p->inputs / 4, sim_x0_peek(&chip, 0x2a) << 8 | sim_x0_peek(&chip, 0x2b));
        rig_at(first + 250 * n);
        for (int i = 0; i < p->inputs; i++) {
            TEST_ASSERT_EQUAL(after, rig_read16(0x0c + 2 * i));
        }
        TEST_ASSERT_EQUAL(after * p->inputs / 4, rig_read16(0x2a));
        set_all(4.0); /* between publications nothing shows */
        rig_at(first + 250 * n + 100);
        TEST_ASSERT_EQUAL(after, rig_read16(0x0c));
    }
    expect_clean();
}

/*
 * proves: X0-ADC-13, X0-ADC-14, X0-ADC-15, X0-SCH-01, X0-SCH-05, X0-SCH-07, X0-SCH-08, X0-SCH-09, X0-BAT-04,
 *     X0-TIM-01, X0-TIM-05, X0-TIM-07, X0-AMB-17, X0-AMB-18, X0-AMB-100, X0-AMB-99
 */
static void test_every_part_publishes_every_250_ms(void)
{
    rig_each(publishes_on_time);
}

/* proves: X0-ADC-12, X0-ADC-11, X0-BIT-11, X0-AMB-16 */
static void test_the_converter_off_and_on_again(void)
{
    rig_boot("bq7694000");
    TEST_ASSERT_TRUE(rig_write(0x04, 0x08));
    expect_reg(0x04, 0x08);
    set_all(4.0);
    (void)sim_x0_set_tdie(&chip, 60.0);
    rig_at(5000);
    TEST_ASSERT_EQUAL(9424, rig_read16(0x0c));
    TEST_ASSERT_EQUAL(9424, rig_read16(0x28));
    TEST_ASSERT_EQUAL_HEX16(0x8a0c, rig_read16(0x2a));
    TEST_ASSERT_EQUAL_HEX16(0x0c45, rig_read16(0x2c));
    TEST_ASSERT_TRUE(rig_write(0x04, 0x10));
    rig_at(5249);
    TEST_ASSERT_EQUAL(9424, rig_read16(0x0c));
    rig_at(5250);
    TEST_ASSERT_EQUAL(10471, rig_read16(0x0c));        /* 4.0 V */
    TEST_ASSERT_EQUAL_HEX16(0x0ac5, rig_read16(0x2c)); /* temperatures with the first one */
    expect_clean();
}

/* proves: X0-AMB-16 */
static void test_the_converter_on_again_in_the_other_reading(void)
{
    sim_x0_options like_boot = {.amb16_like_boot = true};
    rig_boot_with("bq7694000", &like_boot);
    TEST_ASSERT_EQUAL(9424, rig_read16(0x0c));
    TEST_ASSERT_TRUE(rig_write(0x04, 0x00));
    rig_at(1000);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x10));
    expect_clean();
    TEST_ASSERT_EQUAL(0, rig_read16(0x0c));
    expect_misuse("X0-ADC-14");
    rig_at(1799);
    TEST_ASSERT_EQUAL(0, rig_read16(0x0c));
    sim_misuse_clear(sim_x0_misuse(&chip));
    rig_at(1800);
    TEST_ASSERT_EQUAL(9424, rig_read16(0x0c));
    expect_clean();
}

/* proves: X0-ADC-14, X0-AMB-17 */
static void test_data_read_before_the_first_scan_is_misuse(void)
{
    rig_pulse("bq7693003");
    rig_at(409);
    TEST_ASSERT_EQUAL(0, rig_read16(0x0c));
    expect_misuse("X0-ADC-14");
    rig_at(410);
    TEST_ASSERT_EQUAL(9424, rig_read16(0x0c));
    expect_clean();
    rig_pulse("bq7693003"); /* the converter was stopped before it had published anything */
    rig_at(100);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x00));
    rig_at(600);
    (void)rig_read16(0x0c);
    expect_misuse("X0-ADC-14");
    TEST_ASSERT_TRUE(rig_write(0x04, 0x10));
    rig_at(849);
    (void)rig_read16(0x0c);
    expect_misuse("X0-ADC-14");
    rig_at(850);
    TEST_ASSERT_EQUAL(9424, rig_read16(0x0c));
    expect_clean();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_worked_examples);
    RUN_TEST(test_ideal_codes);
    RUN_TEST(test_the_ends_of_the_range);
    RUN_TEST(test_stack_codes);
    RUN_TEST(test_the_stack_code_drops_its_fraction);
    RUN_TEST(test_shorted_inputs_count_in_the_stack_code);
    RUN_TEST(test_every_part_publishes_every_250_ms);
    RUN_TEST(test_the_converter_off_and_on_again);
    RUN_TEST(test_the_converter_on_again_in_the_other_reading);
    RUN_TEST(test_data_read_before_the_first_scan_is_misuse);
    return UNITY_END();
}
