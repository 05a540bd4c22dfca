/* SPDX-License-Identifier: Apache-2.0 */
/* Thermistors and die sensors: conversion, broken sensors, the doubtful range, and the change of the source.
 */
#include "bench.h"
#include <math.h>

void setUp(void)
{
}
void tearDown(void)
{
}

/* R(T) of a 10 kohm sensor with beta 3435 */
static double ohms_at(double celsius)
{
    return 10000.0 * exp(3435.0 * (1.0 / (celsius + 273.15) - 1.0 / 298.15));
}

/* proves: X0-TS-01, X0-TS-02, X0-TS-03, X0-TS-05, X0-TS-08, X0-TS-11, X0-PIN-06, X0-AMB-30 */
static void test_each_sensor_over_its_range(void)
{
    int k, t, celsius;
    for (k = 0; k < 15; k++) {
        int sensors = sim_x0_part_at(k)->cells / 5;
        bench_up(sim_x0_part_at(k)->name);
        for (celsius = -20; celsius <= 80; celsius += 10) {
            for (t = 1; t <= sensors; t++)
                (void)sim_x0_set_ts(&b.chip, t, ohms_at(celsius + 3 * t));
            bench_wait(2000); /* temperatures are taken every 2 s */
            TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
            TEST_ASSERT_EQUAL(sensors, b.sample.temp_count);
            for (t = 1; t <= sensors; t++) {
                TEST_ASSERT_EQUAL(BQ_Q_VALID, b.temps[t - 1].quality);
                TEST_ASSERT_INT_WITHIN(2, 10 * (celsius + 3 * t), b.temps[t - 1].dc);
            }
        }
        for (t = 1; t <= sensors; t++) /* the resistor of an unused pin reads as 25 degC */
            (void)sim_x0_set_ts(&b.chip, t, 10000.0);
        bench_wait(2000);
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        for (t = 1; t <= sensors; t++)
            TEST_ASSERT_INT_WITHIN(1, 250, b.temps[t - 1].dc);
        NO_MISUSE();
    }
}

/* proves: X0-TS-07, X0-ADC-09, X0-SEQ-23 */
static void test_broken_and_doubtful_sensors(void)
{
    static const struct {
        double ohms;
        uint8_t must, never;
    } point[] = {
        {INFINITY, BQ_Q_SENSOR, BQ_Q_VALID}, /* code 8639 */
        {1e9, BQ_Q_SENSOR, BQ_Q_VALID},
        {0.0, BQ_Q_SENSOR, BQ_Q_VALID},
        {990.0, BQ_Q_RANGE, 0}, /* below 0.3 V */
        {1010.0, BQ_Q_VALID, BQ_Q_RANGE | BQ_Q_SENSOR},
        {99500.0, BQ_Q_VALID, BQ_Q_RANGE | BQ_Q_SENSOR},
        {101000.0, BQ_Q_RANGE, 0}, /* above 3.0 V */
    };
    int k, t;
    size_t p;
    for (k = 0; k < 15; k++) {
        bench_up(sim_x0_part_at(k)->name);
        for (p = 0; p < sizeof point / sizeof point[0]; p++)
            for (t = 1; t <= b.chip.part->cells / 5; t++) {
                uint8_t q;
                (void)sim_x0_set_ts(&b.chip, t, point[p].ohms);
                bench_wait(2000);
                TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
                q = b.temps[t - 1].quality; /* either word for "doubtful" will do */
                q = (uint8_t)(q & BQ_Q_OUTSIDE ? (q & ~BQ_Q_OUTSIDE) | BQ_Q_RANGE : q);
                TEST_ASSERT_EQUAL_HEX8(point[p].must, q & point[p].must);
                TEST_ASSERT_EQUAL_HEX8(0, q & point[p].never);
                TEST_ASSERT_EQUAL(BQ_Q_VALID, b.cells[0].quality);
                (void)sim_x0_set_ts(&b.chip, t, 10000.0);
            }
        NO_MISUSE();
    }
}

/* proves: X0-DIE-01, X0-DIE-02, X0-TS-01, X0-ADC-09 */
static void test_die_temperature(void)
{
    int k, celsius;
    for (k = 0; k < 15; k++) {
        bench_part(sim_x0_part_at(k)->name, NULL);
        b.cfg.sensors = 0;
        b.cfg.sensor = NULL;
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        for (celsius = -40; celsius <= 140; celsius += 15) {
            (void)sim_x0_set_tdie(&b.chip, celsius);
            bench_wait(2000);
            TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
            TEST_ASSERT_EQUAL(1, b.sample.temp_count);
            TEST_ASSERT_EQUAL(BQ_Q_VALID, b.temps[0].quality);
            TEST_ASSERT_INT_WITHIN(1, 10 * celsius, b.temps[0].dc);
        }
        (void)sim_x0_set_tdie(&b.chip, 245.0); /* 0.276 V */
        bench_wait(2000);
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        TEST_ASSERT_TRUE(b.temps[0].quality & (BQ_Q_RANGE | BQ_Q_OUTSIDE));
        NO_MISUSE();
    }
}

/* A part that measured one kind is taken over by a host that wants the other: until the change is sure to
   have reached the registers no temperature counts and no FET comes on, whatever the phase of the 2 s cycle.
 */
/* proves: X0-SEQ-43, X0-TS-11, X0-TIM-14, X0-AMB-29, X0-SEQ-05, X0-TS-01 */
static void test_change_of_the_source(void)
{
    int k, die, phase;
    for (k = 0; k < 15; k++)
        for (die = 0; die < 2; die++)
            for (phase = 0; phase < 2000; phase += 370) {
                uint64_t changed = 0;
                int n;
                bench_part(sim_x0_part_at(k)->name, NULL);
                (void)sim_x0_set_ts(&b.chip, 1, ohms_at(40));
                (void)sim_x0_set_tdie(&b.chip, 60);
                b.cfg.sensors = (uint8_t)(die ? sim_x0_part_at(k)->cells / 5 : 0);
                TEST_ASSERT_EQUAL(BQ_OK, bench_init());
                TEST_ASSERT_EQUAL(BQ_OK, bench_start());
                bench_wait(3000 + phase);
                b.cfg.sensors = (uint8_t)(die ? 0 : sim_x0_part_at(k)->cells / 5);
                TEST_ASSERT_EQUAL(BQ_OK, bench_init());
                TEST_ASSERT_EQUAL(BQ_OK, bench_start());
                for (n = (int)b.count - 1; n >= 0; n--)
                    if (bench_log((uint64_t)n)->wrote && bench_log((uint64_t)n)->reg == 4) {
                        changed = bench_log((uint64_t)n)->t_ns;
                        break;
                    }
                for (n = 0; n < 12; n++) {
                    bench_serve(250, 250);
                    if (b.temps[0].quality & BQ_Q_VALID)
                        TEST_ASSERT_INT_WITHIN(2, die ? 600 : 400, b.temps[0].dc);
                    else
                        TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
                    if (b.chip.now - changed < 2000 * MS)
                        TEST_ASSERT_FALSE(b.temps[0].quality & BQ_Q_VALID);
                }
                TEST_ASSERT_TRUE(b.temps[0].quality & BQ_Q_VALID);
                TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
                NO_MISUSE();
            }
}

/* The boot pulse on TS1 is over before the limit of a booted part counts, and the sensor reads right after.
 */
/* proves: X0-TS-10, X0-ELEC-07, X0-TIM-09, X0-AMB-34 */
static void test_the_boot_pin_is_a_sensor_again(void)
{
    int k;
    for (k = 0; k < 15; k++) {
        bench_up(sim_x0_part_at(k)->name);
        TEST_ASSERT_FALSE(b.boot_level);
        TEST_ASSERT_TRUE(b.fall_ns - b.rise_ns >= 2 * MS && b.fall_ns - b.rise_ns < 10 * MS);
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        TEST_ASSERT_EQUAL(BQ_Q_VALID, b.temps[0].quality);
        TEST_ASSERT_INT_WITHIN(1, 250, b.temps[0].dc);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_sensor_over_its_range);
    RUN_TEST(test_broken_and_doubtful_sensors);
    RUN_TEST(test_die_temperature);
    RUN_TEST(test_change_of_the_source);
    RUN_TEST(test_the_boot_pin_is_a_sensor_again);
    return UNITY_END();
}
