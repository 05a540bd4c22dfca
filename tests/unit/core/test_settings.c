/* SPDX-License-Identifier: Apache-2.0 */
/* Thresholds, delays and control values: every code in both directions, every value
 * without a code refused. */
#include "bqhost/bq76pl536_convert.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

/* All legal values of an encoder below `limit` are first, first + step, ... last; everything else has no code
 * or is out of range, and leaves the output alone. */
static void expect_encoding(bq_status (*encode)(uint32_t, uint8_t *), uint32_t first, uint32_t step,
                            uint32_t last, uint8_t first_code, uint32_t limit)
{
    for (uint32_t value = 0; value < limit; value++) {
        uint8_t code = 0xee;
        bq_status status = encode(value, &code);
        if (value < first || value > last) {
            TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, status);
            TEST_ASSERT_EQUAL_HEX8(0xee, code);
        } else if ((value - first) % step != 0u) {
            TEST_ASSERT_EQUAL_INT(BQ_E_NO_CODE, status);
            TEST_ASSERT_EQUAL_HEX8(0xee, code);
        } else {
            TEST_ASSERT_EQUAL_INT(BQ_OK, status);
            TEST_ASSERT_EQUAL_HEX8(first_code + (value - first) / step, code);
        }
    }
    uint8_t code = 0xee;
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, encode(0xffffffffu, &code));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, encode(first, NULL));
    TEST_ASSERT_EQUAL_HEX8(0xee, code);
}

/* proves: PL-COV-01, PL-NUM-13, PL-NUM-15, PL-ELEC-04 */
static void test_overvoltage_thresholds(void)
{
    expect_encoding(bq76pl536_cov_code, 2000, 50, 5000, 0x00, 10000);
    for (unsigned code = 0; code < 256u; code++) {
        uint16_t mv = 0;
        bool legal = (code & 0x7fu) <= 0x3cu;
        TEST_ASSERT_EQUAL_INT(legal ? BQ_OK : BQ_E_RANGE, bq76pl536_cov_mv((uint8_t)code, &mv));
        TEST_ASSERT_EQUAL_UINT(legal ? 2000u + 50u * (code & 0x7fu) : 0u, mv);
    }
    uint8_t code = 0;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_cov_code(4200, &code));
    TEST_ASSERT_EQUAL_HEX8(0x2c, code);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_cov_code(4250, &code));
    TEST_ASSERT_EQUAL_HEX8(0x2d, code);
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_cov_mv(0, NULL));
}

/* proves: PL-CUV-01, PL-NUM-14, PL-NUM-15, PL-ELEC-04 */
static void test_undervoltage_thresholds(void)
{
    expect_encoding(bq76pl536_cuv_code, 700, 100, 3300, 0x00, 10000);
    for (unsigned code = 0; code < 256u; code++) {
        uint16_t mv = 0;
        bool legal = (code & 0x7fu) <= 0x1au;
        TEST_ASSERT_EQUAL_INT(legal ? BQ_OK : BQ_E_RANGE, bq76pl536_cuv_mv((uint8_t)code, &mv));
        TEST_ASSERT_EQUAL_UINT(legal ? 700u + 100u * (code & 0x7fu) : 0u, mv);
    }
    uint8_t code = 0;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_cuv_code(2800, &code));
    TEST_ASSERT_EQUAL_HEX8(0x15, code);
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_cuv_mv(0, NULL));
}

/* The mistake: volts in binary floating point, truncated. It loses at least a dozen of the 61 codes, so the
 * tests above meet it. */
/* proves: PL-NUM-13 */
static void test_truncated_floating_point_would_be_noticed(void)
{
    unsigned wrong = 0;
    for (unsigned code = 0; code <= 0x3cu; code++) {
        volatile float volts = (float)(2000u + 50u * code) / 1000.0f;
        volatile float steps = (volts - 2.0f) / 0.05f;
        uint8_t exact = 0xff;
        wrong += (unsigned)steps != code;
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_cov_code(2000u + 50u * code, &exact));
        TEST_ASSERT_EQUAL_HEX8(code, exact);
    }
    TEST_ASSERT_GREATER_OR_EQUAL(12, wrong);
}

/* proves: PL-COV-12, PL-NUM-16, PL-ELEC-04 */
static void test_distance_of_the_two_thresholds(void)
{
    TEST_ASSERT_TRUE(bq76pl536_cov_cuv_legal(2000, 1700));
    TEST_ASSERT_FALSE(bq76pl536_cov_cuv_legal(2000, 1800));
    TEST_ASSERT_TRUE(bq76pl536_cov_cuv_legal(3600, 3300));
    TEST_ASSERT_FALSE(bq76pl536_cov_cuv_legal(3550, 3300));
    TEST_ASSERT_FALSE(bq76pl536_cov_cuv_legal(1700, 2000));
    TEST_ASSERT_FALSE(bq76pl536_cov_cuv_legal(0, 65535));
}

/* proves: PL-FLT-02, PL-NUM-29, PL-AMB-47, PL-ELEC-07 */
static void test_voltage_delays(void)
{
    for (uint32_t us = 0; us <= 3300000u; us += us < 110000u ? 1u : 50u) {
        uint8_t code = 0xee;
        bq_status status = bq76pl536_delay_code(us, &code);
        if (us <= 3100u && us % 100u == 0u) {
            TEST_ASSERT_EQUAL_INT(BQ_OK, status);
            TEST_ASSERT_EQUAL_HEX8(us / 100u, code);
        } else if (us >= 100000u && us <= 3100000u && us % 100000u == 0u) {
            TEST_ASSERT_EQUAL_INT(BQ_OK, status);
            TEST_ASSERT_EQUAL_HEX8(0x80u + us / 100000u, code);
        } else {
            TEST_ASSERT_EQUAL_INT(us > 3100000u ? BQ_E_RANGE : BQ_E_NO_CODE, status);
            TEST_ASSERT_EQUAL_HEX8(0xee, code);
        }
    }
    for (unsigned code = 0; code < 256u; code++) {
        uint32_t us = 7;
        bool legal = (code & 0x60u) == 0u;
        TEST_ASSERT_EQUAL_INT(legal ? BQ_OK : BQ_E_RANGE, bq76pl536_delay_us((uint8_t)code, &us));
        TEST_ASSERT_EQUAL_UINT(!legal ? 7u : (code & 0x1fu) * (code >= 0x80u ? 100000u : 100u), us);
    }
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_delay_code(100, NULL));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_delay_code(100000, NULL));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_delay_us(0, NULL));
}

/* proves: PL-FLT-03, PL-NUM-30 */
static void test_temperature_delay(void)
{
    expect_encoding(bq76pl536_ott_code, 0, 10, 2550, 0x00, 4000);
    for (unsigned code = 0; code < 256u; code++) {
        uint16_t ms = 0;
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_ott_ms((uint8_t)code, &ms));
        TEST_ASSERT_EQUAL_UINT(10u * code, ms);
    }
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_ott_ms(0, NULL));
}

/* Each row: code, temperature, resistance and both ADC codes at the set ratio, both ADC codes at the clear
 * ratio. */
/* proves: PL-OT-01, PL-OT-09, PL-NUM-17, PL-NUM-18, PL-NUM-19, PL-NUM-20, PL-NUM-21, PL-NUM-22, PL-NUM-23,
 * PL-NUM-24, PL-NUM-25, PL-NUM-26, PL-NUM-27 */
static void test_overtemperature_trip_points(void)
{
    static const struct {
        uint8_t code, celsius;
        uint32_t set_ppm, clear_ppm, set_ohms, clear_ohms;
        uint16_t set1, set2, clear1, clear2;
    } rows[] = {
        {1, 40, 200000, 176600, 5810, 7016, 0x19cf, 0x19cd, 0x16ca, 0x16c7},
        {2, 45, 224400, 200000, 4821, 5810, 0x1cf6, 0x1cf3, 0x19cf, 0x19cd},
        {3, 50, 248800, 227000, 4025, 4728, 0x201c, 0x201a, 0x1d4b, 0x1d49},
        {4, 55, 271200, 249800, 3421, 3996, 0x2300, 0x22ff, 0x203d, 0x203b},
        {5, 60, 295600, 275000, 2867, 3328, 0x2626, 0x2626, 0x237e, 0x237d},
        {6, 65, 315600, 295600, 2477, 2867, 0x28bb, 0x28bb, 0x2626, 0x2626},
        {7, 70, 335600, 316200, 2133, 2466, 0x2b50, 0x2b51, 0x28cf, 0x28cf},
        {8, 75, 355600, 336800, 1828, 2114, 0x2de5, 0x2de6, 0x2b78, 0x2b78},
        {9, 80, 371200, 352800, 1613, 1869, 0x2fe9, 0x2fea, 0x2d89, 0x2d89},
        {10, 85, 386600, 368800, 1418, 1645, 0x31e6, 0x31e7, 0x2f99, 0x2f9a},
        {11, 90, 400000, 382400, 1260, 1469, 0x33a0, 0x33a2, 0x315b, 0x315c},
    };
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        uint8_t code = 0, celsius = 0;
        uint16_t adc = 0;
        uint32_t ohms = 0;
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_ot_code(rows[i].celsius, &code));
        TEST_ASSERT_EQUAL_HEX8(rows[i].code, code);
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_ot_celsius(rows[i].code, &celsius));
        TEST_ASSERT_EQUAL_UINT(rows[i].celsius, celsius);

        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_ts_code(1, rows[i].set_ppm, &adc));
        TEST_ASSERT_EQUAL_HEX16(rows[i].set1, adc);
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_ts_ohms(1, adc, &ohms));
        TEST_ASSERT_INT_WITHIN(1, rows[i].set_ohms, ohms);
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_ts_code(2, rows[i].set_ppm, &adc));
        TEST_ASSERT_EQUAL_HEX16(rows[i].set2, adc);
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_ts_code(1, rows[i].clear_ppm, &adc));
        TEST_ASSERT_EQUAL_HEX16(rows[i].clear1, adc);
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_ts_ohms(1, adc, &ohms));
        TEST_ASSERT_INT_WITHIN(1, rows[i].clear_ohms, ohms);
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_ts_code(2, rows[i].clear_ppm, &adc));
        TEST_ASSERT_EQUAL_HEX16(rows[i].clear2, adc);
    }
}

/* proves: PL-OT-01, PL-NUM-28, PL-ELEC-06 */
static void test_every_other_trip_temperature_is_refused(void)
{
    for (unsigned celsius = 0; celsius < 256u; celsius++) {
        uint8_t code = 0xee;
        bq_status expected = celsius == 0u                    ? BQ_OK
                             : celsius < 40u || celsius > 90u ? BQ_E_RANGE
                             : celsius % 5u != 0u             ? BQ_E_NO_CODE
                                                              : BQ_OK;
        TEST_ASSERT_EQUAL_INT(expected, bq76pl536_ot_code((uint8_t)celsius, &code));
        TEST_ASSERT_EQUAL_HEX8(expected != BQ_OK ? 0xeeu : celsius == 0u ? 0u : celsius / 5u - 7u, code);
        TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_ot_code((uint8_t)celsius, NULL));
    }
    for (unsigned code = 0; code < 256u; code++) {
        uint8_t celsius = 0xee;
        TEST_ASSERT_EQUAL_INT(code <= 11u ? BQ_OK : BQ_E_RANGE,
                              bq76pl536_ot_celsius((uint8_t)code, &celsius));
        TEST_ASSERT_EQUAL_UINT(code == 0u ? 0u : code <= 11u ? 35u + 5u * code : 0xeeu, celsius);
    }
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_ot_celsius(1, NULL));
}

/* proves: PL-CB-02, PL-NUM-32, PL-ELEC-09, PL-TIM-25 */
static void test_balancing_timer(void)
{
    for (uint32_t s = 0; s < 5000u; s++) {
        uint8_t code = 0xee;
        bq_status status = bq76pl536_cb_time_code(s, &code);
        if (s <= 63u) {
            TEST_ASSERT_EQUAL_INT(BQ_OK, status);
            TEST_ASSERT_EQUAL_HEX8(s, code);
        } else if (s > 3780u || s % 60u != 0u) {
            TEST_ASSERT_EQUAL_INT(s > 3780u ? BQ_E_RANGE : BQ_E_NO_CODE, status);
            TEST_ASSERT_EQUAL_HEX8(0xee, code);
        } else {
            TEST_ASSERT_EQUAL_INT(BQ_OK, status);
            TEST_ASSERT_EQUAL_HEX8(0x80u + s / 60u, code);
        }
    }
    for (unsigned code = 0; code < 256u; code++) {
        uint16_t s = 7;
        bool legal = (code & 0x40u) == 0u;
        TEST_ASSERT_EQUAL_INT(legal ? BQ_OK : BQ_E_RANGE, bq76pl536_cb_time_s((uint8_t)code, &s));
        TEST_ASSERT_EQUAL_UINT(!legal ? 7u : (code & 0x3fu) * (code >= 0x80u ? 60u : 1u), s);
    }
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_cb_time_code(0xffffffffu, &(uint8_t){0}));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_cb_time_code(30, NULL));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_cb_time_code(120, NULL));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_cb_time_s(30, NULL));
}

static uint8_t adc(uint8_t cells, uint8_t sensors, bool gpai, bool on)
{
    uint8_t value = 0xee;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_adc_control(cells, sensors, gpai, on, &value));
    return value;
}

/* proves: PL-NUM-34, PL-ADC-04, PL-ADC-08, PL-REG-25 */
static void test_adc_control(void)
{
    TEST_ASSERT_EQUAL_HEX8(0x7d, adc(6, 3, true, true));
    TEST_ASSERT_EQUAL_HEX8(0x3d, adc(6, 3, true, false));
    TEST_ASSERT_EQUAL_HEX8(0x45, adc(6, 0, false, true));
    TEST_ASSERT_EQUAL_HEX8(0x05, adc(6, 0, false, false));
    TEST_ASSERT_EQUAL_HEX8(0x43, adc(4, 0, false, true));
    TEST_ASSERT_EQUAL_HEX8(0x42, adc(3, 0, false, true));
    TEST_ASSERT_EQUAL_HEX8(0x04, adc(5, 0, false, false));
    TEST_ASSERT_EQUAL_HEX8(0x10, adc(3, 1, false, false) & 0x30u);
    TEST_ASSERT_EQUAL_HEX8(0x20, adc(3, 2, false, false) & 0x30u);
    TEST_ASSERT_EQUAL_HEX8(0x30, adc(3, 3, false, false) & 0x30u);

    static const uint8_t counts[][2] = {{0x7d, 9}, {0x3d, 9}, {0x45, 6}, {0x43, 4}, {0x40, 1},
                                        {0x46, 1}, {0x47, 1}, {0x10, 2}, {0x20, 2}, {0x30, 3}};
    for (unsigned i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        TEST_ASSERT_EQUAL_UINT(counts[i][1], bq76pl536_channels(counts[i][0]));
    }
}

/* proves: PL-NUM-35, PL-REG-37, PL-COV-10, PL-AMB-56, PL-ADC-09, PL-GPAI-02 */
static void test_function_config(void)
{
    static const struct {
        bq76pl536_adct adct;
        uint8_t cells;
        bool brick, reg50;
        uint8_t value;
    } rows[] = {
        {BQ76PL536_ADCT_6US, 6, true, false, 0x50},  {BQ76PL536_ADCT_6US, 6, false, false, 0x40},
        {BQ76PL536_ADCT_6US, 6, false, true, 0x60},  {BQ76PL536_ADCT_6US, 4, true, false, 0x58},
        {BQ76PL536_ADCT_6US, 5, true, false, 0x54},  {BQ76PL536_ADCT_6US, 3, true, false, 0x5c},
        {BQ76PL536_ADCT_3US, 6, false, false, 0x00}, {BQ76PL536_ADCT_12US, 6, true, false, 0x90},
        {BQ76PL536_ADCT_24US, 6, true, false, 0xd0},
    };
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        uint8_t value = 0xee;
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_function_config(rows[i].adct, rows[i].cells, rows[i].brick,
                                                               rows[i].reg50, &value));
        TEST_ASSERT_EQUAL_HEX8(rows[i].value, value);
    }
}

/* proves: PL-GEN-01 */
static void test_impossible_parts_are_refused(void)
{
    uint8_t value = 0xee;
    for (unsigned cells = 0; cells < 256u; cells++) {
        bq_status expected = cells >= 3u && cells <= 6u ? BQ_OK : BQ_E_CELLS;
        uint8_t ignored;
        TEST_ASSERT_EQUAL_INT(expected, bq76pl536_adc_control((uint8_t)cells, 0, true, true, &ignored));
        TEST_ASSERT_EQUAL_INT(
            expected, bq76pl536_function_config(BQ76PL536_ADCT_6US, (uint8_t)cells, true, true, &ignored));
    }
    TEST_ASSERT_EQUAL_INT(BQ_E_CELLS, bq76pl536_adc_control(2, 0, true, true, &value));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_adc_control(6, 4, true, true, &value));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_adc_control(6, 0, true, true, NULL));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_function_config((bq76pl536_adct)4, 6, true, true, &value));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_function_config(BQ76PL536_ADCT_6US, 6, true, true, NULL));
    TEST_ASSERT_EQUAL_HEX8(0xee, value);
}

/* proves: PL-CONV-10, PL-CONV-12, PL-NUM-37, PL-SEQ-06-03, PL-AMB-62, PL-AMB-63 */
static void test_conversion_time(void)
{
    for (uint8_t n = 1; n <= 9u; n++) {
        for (unsigned adct = 0; adct < 4u; adct++) {
            uint16_t nominal = 0, worst = 0;
            unsigned t = 3u << adct, slowest = adct == 0u ? 6u : t;
            TEST_ASSERT_EQUAL_INT(
                BQ_OK, bq76pl536_conversion_us(n, (bq76pl536_adct)adct, true, &nominal, &worst));
            TEST_ASSERT_EQUAL_UINT((n + 1u) * t, nominal);
            TEST_ASSERT_GREATER_OR_EQUAL((n + 1u) * slowest * 11u + 20u, 10u * worst);
            TEST_ASSERT_LESS_THAN((n + 1u) * slowest * 11u + 30u, 10u * worst);
        }
        uint16_t nominal = 0, worst = 0;
        TEST_ASSERT_EQUAL_INT(BQ_OK,
                              bq76pl536_conversion_us(n, BQ76PL536_ADCT_3US, false, &nominal, &worst));
        TEST_ASSERT_EQUAL_UINT((n + 1u) * 3u + 500u, nominal);
        TEST_ASSERT_GREATER_OR_EQUAL((n + 1u) * 66u + 5270u, 10u * worst);
        TEST_ASSERT_LESS_THAN((n + 1u) * 66u + 5280u, 10u * worst);
    }
    uint16_t us = 0;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_conversion_us(6, BQ76PL536_ADCT_3US, true, &us, NULL));
    TEST_ASSERT_EQUAL_UINT(21, us);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_conversion_us(6, BQ76PL536_ADCT_6US, true, &us, NULL));
    TEST_ASSERT_EQUAL_UINT(42, us);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_conversion_us(9, BQ76PL536_ADCT_6US, true, &us, NULL));
    TEST_ASSERT_EQUAL_UINT(60, us);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_conversion_us(9, BQ76PL536_ADCT_6US, true, NULL, &us));
    TEST_ASSERT_EQUAL_UINT(68, us);
}

/* proves: PL-ADC-13, PL-ADC-15 */
static void test_a_conversion_that_locks_up_has_no_duration(void)
{
    uint16_t us = 7;
    for (unsigned adct = 1; adct < 4u; adct++) {
        TEST_ASSERT_EQUAL_INT(BQ_E_CONFIG, bq76pl536_conversion_us(6, (bq76pl536_adct)adct, false, &us, &us));
    }
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_conversion_us(0, BQ76PL536_ADCT_6US, true, &us, &us));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_conversion_us(10, BQ76PL536_ADCT_6US, true, &us, &us));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_conversion_us(6, (bq76pl536_adct)4, true, &us, &us));
    TEST_ASSERT_EQUAL_UINT(7, us);
}

/* proves: PL-TIM-01, PL-TIM-09, PL-TIM-10, PL-NUM-38, PL-ELEC-10 */
static void test_spi_clock_by_stack_size(void)
{
    static const struct {
        uint8_t devices;
        uint32_t max_khz, default_hz;
    } rows[] = {{1, 1000, 250000}, {2, 1000, 250000}, {4, 1000, 250000}, {6, 909, 250000},  {8, 689, 250000},
                {12, 465, 250000}, {16, 350, 250000}, {17, 0, 125000},   {24, 235, 125000}, {32, 176, 125000},
                {33, 0, 62500},    {48, 118, 62500},  {62, 91, 62500}};
    uint32_t hz = 7;
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_spi_max_hz(rows[i].devices, &hz));
        if (rows[i].max_khz != 0u) {
            TEST_ASSERT_EQUAL_UINT(rows[i].max_khz * 1000u, hz);
        }
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_spi_default_hz(rows[i].devices, &hz));
        TEST_ASSERT_EQUAL_UINT(rows[i].default_hz, hz);
    }
    for (uint8_t devices = 1; devices <= 62u; devices++) {
        uint32_t highest = 0;
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_spi_max_hz(devices, &highest));
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_spi_default_hz(devices, &hz));
        TEST_ASSERT_LESS_OR_EQUAL(highest, hz);
        TEST_ASSERT_GREATER_OR_EQUAL(BQ76PL536_SPI_MIN_HZ, hz);
    }
    TEST_ASSERT_EQUAL_UINT(10000, BQ76PL536_SPI_MIN_HZ);
    hz = 7;
    TEST_ASSERT_EQUAL_INT(BQ_E_DEVICES, bq76pl536_spi_max_hz(0, &hz));
    TEST_ASSERT_EQUAL_INT(BQ_E_DEVICES, bq76pl536_spi_max_hz(63, &hz));
    TEST_ASSERT_EQUAL_INT(BQ_E_DEVICES, bq76pl536_spi_default_hz(0, &hz));
    TEST_ASSERT_EQUAL_INT(BQ_E_DEVICES, bq76pl536_spi_default_hz(63, &hz));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_spi_max_hz(1, NULL));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_spi_default_hz(1, NULL));
    TEST_ASSERT_EQUAL_UINT(7, hz);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_overvoltage_thresholds);
    RUN_TEST(test_undervoltage_thresholds);
    RUN_TEST(test_truncated_floating_point_would_be_noticed);
    RUN_TEST(test_distance_of_the_two_thresholds);
    RUN_TEST(test_voltage_delays);
    RUN_TEST(test_temperature_delay);
    RUN_TEST(test_overtemperature_trip_points);
    RUN_TEST(test_every_other_trip_temperature_is_refused);
    RUN_TEST(test_balancing_timer);
    RUN_TEST(test_adc_control);
    RUN_TEST(test_function_config);
    RUN_TEST(test_impossible_parts_are_refused);
    RUN_TEST(test_conversion_time);
    RUN_TEST(test_a_conversion_that_locks_up_has_no_duration);
    RUN_TEST(test_spi_clock_by_stack_size);
    return UNITY_END();
}
