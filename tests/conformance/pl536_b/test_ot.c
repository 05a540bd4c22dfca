/* SPDX-License-Identifier: Apache-2.0 */
/* Overtemperature comparators: PL-OT, Table 1 in PL-NUM-17 to PL-NUM-28. */
#include "rig.h"

struct row {
    double set, clear;
};

static const struct row table[12] = {
    {0, 0},           {0.2000, 0.1766}, {0.2244, 0.2000}, {0.2488, 0.2270},
    {0.2712, 0.2498}, {0.2956, 0.2750}, {0.3156, 0.2956}, {0.3356, 0.3162},
    {0.3556, 0.3368}, {0.3712, 0.3528}, {0.3866, 0.3688}, {0.4000, 0.3824},
};

static void ratio(int sensor, double value)
{
    TEST_ASSERT_EQUAL_INT(0, sim_pl_set_ts_ratio(&rig, 1, sensor, value));
}

static void expect(int flags)
{
    EXPECT(flags, 1, R_ALERT);
    EXPECT(flags ? 0xa1 : 0x81, 1, R_STATUS);
    EXPECT(0, 1, R_FAULT);
    TEST_ASSERT_EQUAL_INT(flags != 0, sim_pl_alert_pin(&rig));
    TEST_ASSERT_FALSE(sim_pl_fault_pin(&rig));
}

/* Unlatched: the flag shows the comparator, so that both edges of each trip point can be walked. */
static void walk(int code, int sensor)
{
    const double e = 0.00005;
    int flag = sensor;
    rig_ready(1);
    rig_ot(sensor == 1 ? code : code << 4, 0x00);
    ratio(sensor, table[code].set - e);
    rig_us(1);
    expect(0);
    ratio(sensor, table[code].set + e);
    rig_us(1);
    expect(flag);
    ratio(sensor, table[code].clear + e);
    rig_us(1);
    expect(flag);
    ratio(sensor, table[code].clear - e);
    rig_us(1);
    expect(0);
    ratio(sensor, table[code].clear + e); /* inside the band from below */
    rig_us(1);
    expect(0);
    ratio(3 - sensor, 0.49); /* the other sensor is off */
    rig_us(1);
    expect(0);
    EXPECT_CLEAN();
}

/* proves: PL-OT-01, PL-OT-02, PL-OT-03, PL-OT-04, PL-NUM-17, PL-NUM-18, PL-NUM-19, PL-NUM-20, PL-NUM-21,
 * PL-NUM-22, PL-NUM-23, PL-NUM-24, PL-NUM-25, PL-NUM-26, PL-NUM-27, PL-AMB-43, PL-AMB-37, PL-AMB-38, PL-OT-09
 */
static void every_trip_point_of_both_sensors(void)
{
    for (int code = 1; code <= 11; code++) {
        walk(code, 1);
        walk(code, 2);
    }
}

/* proves: PL-NUM-17, PL-NUM-18, PL-NUM-19, PL-NUM-20, PL-NUM-21, PL-NUM-22, PL-NUM-23, PL-NUM-24, PL-NUM-25,
 * PL-NUM-26, PL-NUM-27 */
static void adc_codes_at_the_trip_points(void)
{
    static const int codes[12][4] = {
        {0, 0, 0, 0},
        {0x19cf, 0x19cd, 0x16ca, 0x16c7},
        {0x1cf6, 0x1cf3, 0x19cf, 0x19cd},
        {0x201c, 0x201a, 0x1d4b, 0x1d49},
        {0x2300, 0x22ff, 0x203d, 0x203b},
        {0x2626, 0x2626, 0x237e, 0x237d},
        {0x28bb, 0x28bb, 0x2626, 0x2626},
        {0x2b50, 0x2b51, 0x28cf, 0x28cf},
        {0x2de5, 0x2de6, 0x2b78, 0x2b78},
        {0x2fe9, 0x2fea, 0x2d89, 0x2d89},
        {0x31e6, 0x31e7, 0x2f99, 0x2f9a},
        {0x33a0, 0x33a2, 0x315b, 0x315c},
    };
    rig_ready(1);
    rig_write(1, R_IO, 0x03);
    rig_adc(1, 0x70, 0x40);
    for (int code = 1; code <= 11; code++) {
        ratio(1, table[code].set);
        ratio(2, table[code].set);
        rig_convert(1);
        EXPECT_WORD(codes[code][0], 1, R_TEMP1);
        EXPECT_WORD(codes[code][1], 1, R_TEMP2);
        ratio(1, table[code].clear);
        ratio(2, table[code].clear);
        rig_convert(1);
        EXPECT_WORD(codes[code][2], 1, R_TEMP1);
        EXPECT_WORD(codes[code][3], 1, R_TEMP2);
    }
}

/* proves: PL-NUM-28, PL-AMB-45, PL-OT-01 */
static void zero_and_illegal_codes_never_trip(void)
{
    static const int off[5] = {0, 12, 13, 14, 15};
    for (int i = 0; i < 5; i++) {
        rig_ready(1);
        rig_ot(off[i] << 4 | off[i], 0x01);
        ratio(1, 0.99);
        ratio(2, 0.99);
        rig_s(1);
        expect(0);
        if (off[i] == 0) {
            EXPECT_CLEAN();
        } else {
            EXPECT_MISUSE("PL-AMB-45", "PL-OT-01", "PL-NUM-28");
        }
    }
}

/* proves: PL-OT-02, PL-OT-05, PL-OT-07, PL-FLT-03, PL-FLT-11, PL-AMB-38, PL-AMB-41 */
static void a_latched_alert_waits_for_the_host(void)
{
    rig_ready(1);
    rig_ot(0x51, 0x0a); /* 100 ms for both sensors */
    ratio(1, 0.3);
    rig_ms(60);
    ratio(2, 0.3);
    rig_us(39999);
    expect(0);
    rig_us(2);
    expect(0x01);
    rig_us(59997);
    expect(0x01);
    rig_us(2);
    expect(0x03);
    ratio(1, 0.1);
    rig_s(1);
    expect(0x03);
    rig_write(1, R_FAULT, 0x00);
    rig_clear(1, R_ALERT, 0x01);
    expect(0x02);
    rig_s(1);
    expect(0x02);
    for (int again = 0; again < 3; again++) {
        rig_clear(1, R_ALERT, 0x02); /* the cause remains: back after the delay */
        rig_us(99999);
        expect(0);
        rig_us(2);
        expect(0x02);
    }
    ratio(2, 0.28); /* between clear and set: not gone */
    rig_clear(1, R_ALERT, 0x02);
    rig_ms(101);
    expect(0x02);
    ratio(2, 0.27);
    rig_clear(1, R_ALERT, 0x02);
    rig_s(1);
    expect(0);
}

/* proves: PL-OT-02 */
static void a_short_excess_does_not_count(void)
{
    rig_ready(1);
    rig_ot(0x01, 0x01);
    for (int i = 0; i < 20; i++) {
        ratio(1, 0.3);
        rig_us(9900);
        ratio(1, 0.1);
        rig_us(10);
    }
    expect(0);
}

/* proves: PL-OT-06, PL-TS-05, PL-AMB-76 */
static void a_sensor_without_its_switch_does_not_trip(void)
{
    rig_ready(1);
    rig_ot(0x11, 0x01);
    ratio(1, 0.3);
    ratio(2, 0.3);
    for (int io = 0; io < 4; io++) {
        rig_write(1, R_IO, io);
        rig_clear(1, R_ALERT, 0x03);
        rig_ms(50);
        expect(io);
    }
    rig_shadow(1, C_OTT, 0x00);
    rig_clear(1, R_ALERT, 0x03);
    rig_us(1);
    expect(0x03);
    rig_write(1, R_IO, 0x01);
    rig_us(1);
    expect(0x01);
}

/* proves: PL-FLT-03, PL-NUM-30, PL-TIM-21 */
static void every_delay_code(void)
{
    rig_ready(1);
    for (int code = 1; code <= 255; code++) {
        ratio(1, 0.1);
        rig_us(1);
        rig_ot(0x01, code);
        rig_clear(1, R_ALERT, 0x01);
        ratio(1, 0.3);
        rig_us((uint64_t)code * 10000 - 1);
        EXPECT(0x00, 1, R_ALERT);
        rig_us(2);
        EXPECT(0x01, 1, R_ALERT);
    }
}

/* proves: PL-COV-13, PL-SLEEP-13 */
static void off_in_sleep_and_from_zero_afterwards(void)
{
    rig_ready(1);
    rig_ot(0x01, 0x0a);
    ratio(1, 0.3);
    rig_ms(90);
    rig_write(1, R_IO, 0x07);
    rig_s(1);
    EXPECT(0x04, 1, R_ALERT);
    rig_clear(1, R_ALERT, 0x04);
    rig_write(1, R_IO, 0x03);
    rig_ms(99);
    expect(0);
    rig_us(1210); /* 200 us blanked, then the whole delay */
    expect(0x01);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(every_trip_point_of_both_sensors);
    RUN_TEST(adc_codes_at_the_trip_points);
    RUN_TEST(zero_and_illegal_codes_never_trip);
    RUN_TEST(a_latched_alert_waits_for_the_host);
    RUN_TEST(a_short_excess_does_not_count);
    RUN_TEST(a_sensor_without_its_switch_does_not_trip);
    RUN_TEST(every_delay_code);
    RUN_TEST(off_in_sleep_and_from_zero_afterwards);
    return UNITY_END();
}
