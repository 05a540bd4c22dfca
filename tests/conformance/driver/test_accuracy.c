/* SPDX-License-Identifier: Apache-2.0 */
/* What the datasheet promises of values, thresholds and delays, as it arrives at the user of the driver. */
#include "bench.h"
#include "bqhost/bq76pl536_convert.h"

static void cells(double volts)
{
    sim_pl_set_cells(&b.pl, 1, (const double[6]){volts, volts, volts, volts, volts, volts});
}

static void measure_only(void)
{
    bench_up(1, NULL);
    b.config.cov_mv = b.config.cuv_mv = 0;
}

static void scan(void)
{
    bench_wait_ms(20);
    EXPECT_STATUS(BQ_OK, bench_scan());
    bench_sample();
}

/* Half a code and half a millivolt are all that the driver adds to the errors of the part. */
/* proves: PL-VCELL-04 */
static void cells_over_the_whole_input_range(void)
{
    measure_only();
    b.config.wire_limit_mv = 65535;
    sim_pl_set_vbat(&b.pl, 1, 21.6); /* its supply, whatever the cells have */
    bench_ready_from();
    for (int mv = 0; mv <= 6000; mv += 7) {
        cells(mv / 1000.0);
        scan();
        for (int c = 1; c <= 6; c++) {
            unsigned wanted = mv < 1000 || mv > 4500 ? BQ_Q_VALID | BQ_Q_OUTSIDE : BQ_Q_VALID;
            TEST_ASSERT_EQUAL_HEX8_MESSAGE(wanted, CELL(1, c)->quality & (BQ_Q_VALID | BQ_Q_OUTSIDE),
                                           bench_text("%d mV", mv));
            TEST_ASSERT_INT_WITHIN(1, mv, CELL(1, c)->mv);
        }
    }
}

/* proves: PL-VCELL-04 */
static void cells_of_a_real_part(void)
{
    const sim_pl_options o = {.seed = 3, .cell_offset_uv_max = 2500.0};
    bench_ready(1, &o);
    for (int mv = 2900; mv <= 4100; mv += 50) {
        cells(mv / 1000.0);
        scan();
        for (int c = 1; c <= 6; c++) { /* 2.5 mV of the part, rounded to whole ones */
            TEST_ASSERT_INT_WITHIN(3, mv, CELL(1, c)->mv);
        }
    }
}

/* proves: PL-GPAI-05 */
static void the_gpai_pins(void)
{
    bq76pl536_flags flags;
    measure_only();
    b.config.gpai_pins = true;
    bench_ready_from();
    for (int mv = 250; mv <= 2500; mv += 3) {
        sim_pl_set_gpai(&b.pl, 1, mv / 1000.0);
        scan();
        EXPECT_STATUS(BQ_OK, bq76pl536_device_flags(&b.driver, 1, &flags));
        TEST_ASSERT_TRUE(flags.gpai_quality & BQ_Q_VALID);
        TEST_ASSERT_INT_WITHIN(1, mv, flags.gpai_mv);
    }
}

/* One step is 2 mV. */
/* proves: PL-VBAT-05 */
static void the_brick(void)
{
    measure_only();
    bench_ready_from();
    for (int mv = 7200; mv <= 30000; mv += 60) {
        cells(mv / 6000.0);
        scan();
        TEST_ASSERT_TRUE(MODULE(1)->quality & BQ_Q_VALID);
        TEST_ASSERT_INT_WITHIN(2, mv, (int)MODULE(1)->stack_mv);
    }
}

/* The temperature of this ratio by the table that was configured: 1.82 kOhm below 1.47 kOhm and the sensor.
 */
static int dc_of(double ratio)
{
    int16_t dc = 0;
    (void)bq_thermistor_dc(&bq_thermistor_103at, (uint32_t)(1820.0 / ratio - 3290.0 + 0.5), &dc);
    return dc;
}

/* proves: PL-TS-10 */
static void the_sensors(void)
{
    measure_only();
    bench_ready_from();
    for (int volts = 25; volts <= 240; volts++) { /* hundredths, at the input; REG50 = 5 V */
        double ratio = volts / 500.0;
        sim_pl_set_ts_ratio(&b.pl, 1, 1, ratio);
        sim_pl_set_ts_ratio(&b.pl, 1, 2, ratio);
        scan();
        for (int t = 0; t < 2;
             t++) { /* 0.7 % are the part's; the driver's own share is a tenth of a degree */
            TEST_ASSERT_TRUE(b.temps[t].dc >= dc_of(ratio * 0.9998) - 1);
            TEST_ASSERT_TRUE(b.temps[t].dc <= dc_of(ratio * 1.0002) + 1);
        }
    }
}

static bool faults_within(uint32_t ms, uint16_t flag)
{
    bench_wait_ms(ms);
    scan();
    return (MODULE(1)->faults & flag) != 0;
}

/* proves: PL-COV-11 */
static void every_overvoltage_threshold(void)
{
    for (int mv = 2000; mv <= 5000; mv += 50) {
        int tolerance = mv >= 3300 && mv <= 4500 ? 50 : 70;
        measure_only();
        b.config.cov_mv = (uint16_t)mv;
        cells(1.9);
        bench_ready_from();
        sim_pl_set_cell(&b.pl, 1, 4, (mv - tolerance) / 1000.0);
        TEST_ASSERT_FALSE_MESSAGE(faults_within(1000, BQ_F_CELL_OV), bench_text("%d mV", mv));
        sim_pl_set_cell(&b.pl, 1, 4, (mv + tolerance) / 1000.0);
        TEST_ASSERT_TRUE_MESSAGE(faults_within(1000, BQ_F_CELL_OV), bench_text("%d mV", mv));
        TEST_ASSERT_EQUAL_HEX16(0x08, MODULE(1)->cell_ov);
    }
}

/* proves: PL-CUV-07 */
static void every_undervoltage_threshold(void)
{
    for (int mv = 700; mv <= 3300; mv += 100) {
        measure_only();
        b.config.cuv_mv = (uint16_t)mv;
        bench_ready_from();
        sim_pl_set_cell(&b.pl, 1, 2, (mv + 100) / 1000.0);
        TEST_ASSERT_FALSE_MESSAGE(faults_within(1000, BQ_F_CELL_UV), bench_text("%d mV", mv));
        sim_pl_set_cell(&b.pl, 1, 2, (mv - 100) / 1000.0);
        TEST_ASSERT_TRUE_MESSAGE(faults_within(1000, BQ_F_CELL_UV), bench_text("%d mV", mv));
        TEST_ASSERT_EQUAL_HEX16(0x02, MODULE(1)->cell_uv);
    }
}

/* Time until the line rises, us, to the nearest 2. */
static uint32_t rise_us(bool (*line)(const sim_pl *))
{
    uint64_t start = sim_pl_now(&b.pl);
    while (!line(&b.pl)) {
        uint64_t next = sim_pl_next_event(&b.pl);
        sim_pl_advance(&b.pl, next == 0 || next > 2000 ? 2000 : next);
        TEST_ASSERT_TRUE(sim_pl_now(&b.pl) - start < 5 * SIM_PL_S);
    }
    return (uint32_t)((sim_pl_now(&b.pl) - start) / 1000);
}

/* proves: PL-TIM-22, PL-NUM-31 */
static void a_delay_lies_in_its_window(void)
{
    static const struct {
        uint32_t asked_us, from_us, to_us;
    } window[] = {
        {500, 440, 550}, {3100, 2728, 3410}, {1000000, 880000, 1100000}, {3100000, 2728000, 3410000}};
    for (size_t i = 0; i < sizeof window / sizeof window[0]; i++) {
        for (int percent = -12; percent <= 10; percent += 11) {
            const sim_pl_options o = {.delay_percent = percent};
            bench_up(1, &o);
            b.config.cov_delay_us = window[i].asked_us;
            bench_ready_from();
            sim_pl_set_cell(&b.pl, 1, 5, 4.3);
            uint32_t took = rise_us(sim_pl_fault_pin);
            TEST_ASSERT_TRUE_MESSAGE(took + 2 >= window[i].from_us && took <= window[i].to_us + 2,
                                     bench_text("%u us", (unsigned)took));
            TEST_ASSERT_TRUE(faults_within(0, BQ_F_CELL_OV));
        }
    }
}

/* proves: PL-NUM-31 */
static void the_longest_delay_of_the_sensors(void)
{
    for (int percent = -12; percent <= 10; percent += 11) {
        const sim_pl_options o = {.delay_percent = percent};
        bench_up(1, &o);
        b.config.ot_delay_ms = 2550;
        bench_ready_from();
        sim_pl_set_ts_ratio(&b.pl, 1, 2, 0.35);
        uint32_t took = rise_us(sim_pl_alert_pin);
        TEST_ASSERT_TRUE_MESSAGE(took + 2 >= 2244000 && took <= 2805002, bench_text("%u us", (unsigned)took));
        TEST_ASSERT_TRUE(faults_within(0, BQ_F_OVERTEMP));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(cells_over_the_whole_input_range);
    RUN_TEST(cells_of_a_real_part);
    RUN_TEST(the_gpai_pins);
    RUN_TEST(the_brick);
    RUN_TEST(the_sensors);
    RUN_TEST(every_overvoltage_threshold);
    RUN_TEST(every_undervoltage_threshold);
    RUN_TEST(a_delay_lies_in_its_window);
    RUN_TEST(the_longest_delay_of_the_sensors);
    return UNITY_END();
}
