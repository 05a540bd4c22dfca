/* SPDX-License-Identifier: Apache-2.0 */
/* Measurement by firmware start and by pin, lock-up: PL-SEQ-05 to PL-SEQ-07, and the conversion formulas. */
#include "bench.h"

/* proves: PL-SEQ-06-01, PL-SEQ-06-02, PL-SEQ-06-03, PL-SEQ-06-04, PL-CONV-09, PL-CONV-12, PL-TIM-11,
 * PL-PKT-06, PL-PKT-08, PL-PKT-15, PL-NUM-37, PL-AMB-71, PL-CONV-01 */
static void one_broadcast_and_one_burst_each(void)
{
    for (int devices = 1; devices <= 62; devices += devices == 1 ? 3 : 29) {
        bench_ready(devices, NULL);
        bench_wait_ms(1);
        bench_mark();
        EXPECT_STATUS(BQ_OK, bench_scan());
        TEST_ASSERT_EQUAL_INT(devices + 1, b.packets);
        TEST_ASSERT_EQUAL_UINT(23 * devices + 4, b.bytes);
        TEST_ASSERT_EQUAL_MEMORY("\x7f\x34\x01\x8a", b.log[0].tx, 4);
        TEST_ASSERT_TRUE(b.log[1].t_us - b.log[0].t_us >=
                         68 + 23 * 8 * 1000000ull / b.hz); /* 66 us, 2 us skew */
        for (int d = 1; d <= devices; d++) {
            TEST_ASSERT_EQUAL_HEX8(RD(d), b.log[d].tx[0]);
            TEST_ASSERT_EQUAL_HEX8(0x00, b.log[d].tx[1]);
            TEST_ASSERT_EQUAL_HEX8(0x13, b.log[d].tx[2]);
        }
        bench_judge_packets();
        bench_no_misuse();
    }
}

/* proves: PL-SEQ-06-07, PL-VCELL-01, PL-VCELL-05, PL-VBAT-01, PL-TS-01, PL-TS-02, PL-TS-09, PL-NUM-01,
 * PL-NUM-03, PL-NUM-08, PL-NUM-10, PL-AMB-58, PL-AMB-75, PL-TS-12 */
static void numbers_out_of_the_chip(void)
{
    static const double volts[] = {0.7, 1.0, 1.2,  2.0, 2.5, 3.0, 3.3, 3.35,
                                   3.6, 3.7, 4.15, 4.2, 4.5, 5.0, 6.0};
    static const double brick[] = {7.2, 10.8, 14.4, 18.0, 20.0, 20.295, 21.6, 25.2, 27.0, 30.0};
    bench_ready(2, NULL);
    for (size_t i = 0; i < sizeof volts / sizeof volts[0]; i++) {
        sim_pl_set_cell(&b.pl, 2, 4, volts[i]);
        sim_pl_set_vbat(&b.pl, 1, brick[i % 10]);
        EXPECT_STATUS(BQ_OK, bench_scan());
        bench_sample();
        TEST_ASSERT_INT_WITHIN(0, (int)(volts[i] * 1000 + 0.5), CELL(2, 4)->mv);
        TEST_ASSERT_INT_WITHIN(2, (int)(brick[i % 10] * 1000 + 0.5), MODULE(1)->stack_mv);
    }
    for (int c = -300; c <= 900;
         c += 50) { /* the table of the sensor is proven elsewhere: here the whole way */
        int index = (c - bq_thermistor_103at.first_dc) / bq_thermistor_103at.step_dc;
        int at = bq_thermistor_103at.first_dc + index * bq_thermistor_103at.step_dc;
        double ratio = 1820.0 / (3290.0 + bq_thermistor_103at.ohms[index]);
        sim_pl_set_ts_ratio(&b.pl, 1, 1, ratio);
        sim_pl_set_ts_ratio(&b.pl, 2, 2, ratio);
        EXPECT_STATUS(BQ_OK, bench_scan());
        bench_sample();
        TEST_ASSERT_INT_WITHIN(2, at, b.temps[0].dc);
        TEST_ASSERT_INT_WITHIN(2, at, b.temps[3].dc);
    }
}

/* proves: PL-SEQ-06-07, PL-TS-09, PL-ADC-11, PL-AMB-75 */
static void ends_of_the_range_are_marked(void)
{
    bench_ready(1, NULL);
    sim_pl_set_vbat(&b.pl, 1, 4 * 3.6 + 6.25); /* what the cells add up to as measured: no open wire */
    sim_pl_set_cell(&b.pl, 1, 2, 0.0);
    sim_pl_set_cell(&b.pl, 1, 5, 7.0);
    sim_pl_set_ts_ratio(&b.pl, 1, 1, 0.0);
    sim_pl_set_ts_ratio(&b.pl, 1, 2, 0.553);
    EXPECT_STATUS(BQ_OK, bench_scan());
    bench_sample();
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_RANGE, CELL(1, 2)->quality & BQ_Q_RANGE);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_RANGE, CELL(1, 5)->quality & BQ_Q_RANGE);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_SENSOR, b.temps[0].quality & (BQ_Q_SENSOR | BQ_Q_VALID));
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_SENSOR, b.temps[1].quality & (BQ_Q_SENSOR | BQ_Q_VALID));
}

/* proves: PL-SEQ-06-09, PL-AMB-77, PL-DRDY-04 */
static void one_time_stamp_for_all(void)
{
    bench_ready(5, NULL);
    uint32_t before = (uint32_t)(sim_pl_now(&b.pl) / 1000);
    EXPECT_STATUS(BQ_OK, bench_scan());
    bench_sample();
    TEST_ASSERT_TRUE(b.sample.t_us >= before && b.sample.t_us <= before + 500);
    bench_wait_ms(1234);
    bench_sample();
    for (int d = 1; d <= 5; d++) {
        TEST_ASSERT_EQUAL_UINT32(MODULE(1)->age_ms, MODULE(d)->age_ms);
        TEST_ASSERT_TRUE(MODULE(d)->age_ms >= 1234 && MODULE(d)->age_ms < 1250);
    }
}

/* proves: PL-SEQ-07-01, PL-SEQ-07-02, PL-SEQ-07-03, PL-SEQ-07-04, PL-CONV-05, PL-DRDY-06 */
static void the_pin_starts_once_and_falls_again(void)
{
    bench_up(3, NULL);
    b.config.use_conv_pin = true;
    bench_ready_from();
    bench_mark();
    for (int i = 0; i < 5; i++) {
        uint32_t edges = b.conv_edges, done = sim_pl_conversions(&b.pl, 3);
        EXPECT_STATUS(BQ_OK, bench_scan());
        TEST_ASSERT_EQUAL_UINT32(edges + 1, b.conv_edges);
        TEST_ASSERT_EQUAL_UINT32(done + 1, sim_pl_conversions(&b.pl, 3));
        TEST_ASSERT_FALSE(sim_pl_conv(&b.pl));
    }
    TEST_ASSERT_EQUAL_INT(0, bench_count(0x7f, 0x34));
    bench_no_misuse();
}

/* proves: PL-SEQ-07-02, PL-DRDY-04, PL-AMB-79 */
static void a_stuck_drdy_line_costs_nothing_but_time(void)
{
    bench_up(3, NULL);
    b.config.use_conv_pin = true;
    b.stuck_drdy = true;
    bench_ready_from();
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, (bench_sample(), CELL(3, 6)->quality));
}

/* proves: PL-SEQ-07-05, PL-ADC-14, PL-SEQ-04-03, PL-SEQ-08-05, PL-POR-11 */
static void a_programmed_device_that_was_reset_is_found_before_the_pulse(void)
{
    bench_up(3, NULL);
    b.config.use_conv_pin = true;
    for (int d = 1; d <= 3; d++) {
        static const uint8_t eprom[12] = {0x50, 0, 0x2c, 0x85, 0x15, 0x85, 0, 0, 0, 0, 0, 0};
        for (int r = 0; r < 12; r++) {
            sim_pl_set_otp(&b.pl, d, (uint8_t)(0x40 + r), eprom[r]);
        }
    }
    bench_power_cycle();
    bench_wait_ms(60);
    bench_ready_from();
    sim_pl_set_supply(&b.pl, 2, false);
    bench_wait_ms(1);
    sim_pl_set_supply(&b.pl, 2, true);
    bench_wait_ms(200);
    for (int i = 0; i < 4; i++) {
        bench_scan();
        bench_wait_ms(100);
    }
    bench_sample();
    TEST_ASSERT_EQUAL_INT(0, sim_misuse_of(sim_pl_misuse(&b.pl), "PL-ADC-12"));
    TEST_ASSERT_EQUAL_INT(SIM_PL_ACTIVE, sim_pl_get_mode(&b.pl, 2));
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(2, 1)->quality);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(3, 1)->quality);
}

static void lock_device(int device)
{
    bench_raw_write(device, 0x30, 0x3d); /* ADC_ON lost behind the driver's back */
}

/* proves: PL-SEQ-05-01, PL-SEQ-05-02, PL-SEQ-05-03, PL-SEQ-05-05, PL-SEQ-06-06, PL-AMB-66, PL-DRDY-01,
 * PL-AMB-80 */
static void a_lock_up_is_reported_and_recovered(void)
{
    for (int mask = 1; mask < 8; mask++) {
        bench_ready(3, NULL);
        for (int d = 1; d <= 3; d++) {
            if (mask >> (d - 1) & 1) {
                lock_device(d);
            }
            sim_pl_set_cells(&b.pl, d, (const double[6]){3.3, 3.3, 3.3, 3.3, 3.3, 3.3});
        }
        bench_scan();
        bq_status sampled = b.afe.ops->sample(b.afe.ctx, &b.sample);
        TEST_ASSERT_EQUAL_INT(BQ_OK, sampled);
        for (int d = 1; d <= 3; d++) {
            if (mask >> (d - 1) & 1) {
                TEST_ASSERT_EQUAL_HEX16_MESSAGE(BQ_F_LOCKUP, MODULE(d)->faults & BQ_F_LOCKUP,
                                                bench_text("mask %d device %d", mask, d));
                /* invalid, or measured again after the recovery; the old value never passes for a new one */
                TEST_ASSERT_TRUE((CELL(d, 1)->quality & BQ_Q_VALID) == 0 || CELL(d, 1)->mv == 3300);
            }
        }
        for (int i = 0; i < 6; i++) {
            bench_wait_ms(200);
            bench_scan();
        }
        bench_sample();
        for (int d = 1; d <= 3; d++) {
            TEST_ASSERT_EQUAL_INT(SIM_PL_ACTIVE, sim_pl_get_mode(&b.pl, d));
            TEST_ASSERT_EQUAL_HEX8(0x7d, PEEK(d, 0x30));
            TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(d, 6)->quality);
        }
    }
}

/* proves: PL-SEQ-06-06, PL-UVLO-04, PL-AMB-55 */
static void uvlo_makes_readings_invalid(void)
{
    bench_ready(2, NULL);
    sim_pl_set_vbat(&b.pl, 2, 5.2);
    bench_wait_ms(10);
    bench_scan();
    bench_sample();
    TEST_ASSERT_EQUAL_HEX16(BQ_F_SUPPLY, MODULE(2)->faults & BQ_F_SUPPLY);
    for (int c = 1; c <= 6; c++) {
        TEST_ASSERT_EQUAL_HEX8(0, CELL(2, c)->quality & BQ_Q_VALID);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(1, c)->quality);
    }
    sim_pl_set_vbat(&b.pl, 2, -1);
    bench_wait_ms(100);
    for (int i = 0; i < 3; i++) {
        bench_scan();
        bench_wait_ms(100);
    }
    bench_sample();
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(2, 1)->quality);
    TEST_ASSERT_EQUAL_HEX16(0, MODULE(2)->faults & BQ_F_SUPPLY);
}

/* proves: PL-GPAI-06, PL-GPAI-01, PL-NUM-02, PL-NUM-09, PL-AMB-56, PL-AMB-61 */
static void gpai_and_brick_in_turn(void)
{
    bq76pl536_flags flags;
    bench_ready(2, NULL);
    sim_pl_set_gpai(&b.pl, 2, 1.25);
    EXPECT_STATUS(BQ_OK, bench_run(bq76pl536_select_gpai(&b.driver, true)));
    EXPECT_STATUS(BQ_OK, bench_scan());
    EXPECT_STATUS(BQ_OK, bq76pl536_device_flags(&b.driver, 2, &flags));
    TEST_ASSERT_INT_WITHIN(1, 1250, flags.gpai_mv);
    TEST_ASSERT_EQUAL_HEX8(0x40, PEEK(2, 0x40));
    EXPECT_STATUS(BQ_OK, bench_run(bq76pl536_select_gpai(&b.driver, false)));
    EXPECT_STATUS(BQ_OK, bench_scan());
    TEST_ASSERT_INT_WITHIN(2, 21600, (bench_sample(), MODULE(2)->stack_mv));
    bench_no_misuse();
    bench_judge_packets();
}

/* proves: PL-AMB-76, PL-TS-05, PL-TS-06, PL-TS-07 */
static void only_powered_sensors_are_read(void)
{
    for (uint8_t sensors = 0; sensors <= 2; sensors++) {
        bench_up(2, NULL);
        b.config.sensors = sensors;
        for (int t = sensors; t < 2; t++) {
            b.config.ot_c[t] = 0;
        }
        bench_ready_from();
        bench_sample();
        TEST_ASSERT_EQUAL_INT(2 * sensors, b.sample.temp_count);
        TEST_ASSERT_EQUAL_HEX8((1 << sensors) - 1, PEEK(2, 0x31));
        TEST_ASSERT_EQUAL_HEX8(((1 << sensors) - 1) << 4, PEEK(2, 0x30) & 0x30);
        for (int t = 0; t < b.sample.temp_count; t++) {
            TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, b.temps[t].quality);
            TEST_ASSERT_INT_WITHIN(2, 250, b.temps[t].dc);
        }
        bench_no_misuse();
    }
}

/* proves: PL-SEQ-00-03, PL-CONV-12, PL-AMB-67, PL-SEQ-06-08 */
static void a_start_reported_as_failed_is_not_repeated_into_itself(void)
{
    bench_up(1, NULL);
    b.config.spi_hz = 1000000; /* a packet is shorter than the conversion */
    bench_ready_from();
    bench_mark();
    b.fail_after = 1;
    b.eager = true;
    EXPECT_STATUS(BQ_OK, bench_scan());
    bench_no_misuse();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(one_broadcast_and_one_burst_each);
    RUN_TEST(numbers_out_of_the_chip);
    RUN_TEST(ends_of_the_range_are_marked);
    RUN_TEST(one_time_stamp_for_all);
    RUN_TEST(the_pin_starts_once_and_falls_again);
    RUN_TEST(a_stuck_drdy_line_costs_nothing_but_time);
    RUN_TEST(a_programmed_device_that_was_reset_is_found_before_the_pulse);
    RUN_TEST(a_lock_up_is_reported_and_recovered);
    RUN_TEST(uvlo_makes_readings_invalid);
    RUN_TEST(gpai_and_brick_in_turn);
    RUN_TEST(only_powered_sensors_are_read);
    RUN_TEST(a_start_reported_as_failed_is_not_repeated_into_itself);
    return UNITY_END();
}
