/* SPDX-License-Identifier: Apache-2.0 */
/* What the driver refuses before anything is sent: PL-SEQ-03-01, PL-ELEC, and the code tables in both
 * directions. */
#include "bench.h"

static bq_status nothing(void *ctx, const uint8_t *tx, uint8_t *rx, size_t len)
{
    (void)ctx;
    (void)tx;
    (void)rx;
    (void)len;
    TEST_FAIL_MESSAGE("init touched the bus");
    return BQ_E_BUS;
}

static bq_status nothing_to_poll(void *ctx)
{
    (void)ctx;
    return BQ_OK;
}

static uint32_t zero(void *ctx)
{
    (void)ctx;
    return 0;
}

static bq_status init(void)
{
    static const bq_spi_ops ops = {nothing, nothing_to_poll, NULL};
    const bq_spi spi = {&ops, NULL};
    const bq_clock clock = {zero, NULL};
    return bq76pl536_init(&b.driver, &b.config, &spi, NULL, &clock, b.devices, 62);
}

static void usual(void)
{
    bench_up(4, NULL);
}

/* proves: PL-ELEC-04, PL-ELEC-07, PL-ELEC-06, PL-ELEC-09, PL-ELEC-10, PL-ELEC-11, PL-SEQ-03-01, PL-AMB-45,
 * PL-AMB-44, PL-AMB-32, PL-OT-08, PL-ELEC-08, PL-VBAT-07, PL-GEN-01, PL-SPI-10 */
static void each_wrong_field_has_its_refusal(void)
{
#define REFUSED(status, field, value)                                                                        \
    do {                                                                                                     \
        usual();                                                                                             \
        b.config.field = (value);                                                                            \
        TEST_ASSERT_EQUAL_INT_MESSAGE((status), init(), #field " = " #value);                                \
    } while (0)
    usual();
    EXPECT_STATUS(BQ_OK, init());
    REFUSED(BQ_E_DEVICES, devices, 0);
    REFUSED(BQ_E_DEVICES, devices, 63);
    REFUSED(BQ_OK, devices, 62);
    REFUSED(BQ_E_CELLS, cells_per_device, 2);
    REFUSED(BQ_E_CELLS, cells_per_device, 7);
    REFUSED(BQ_OK, cells_per_device, 3);
    REFUSED(BQ_E_RANGE, sensors, 3);
    REFUSED(BQ_E_CONFIG, thermistor, NULL);
    REFUSED(BQ_E_RANGE, balance_timer_s, 64);
    REFUSED(BQ_E_RANGE, wire_limit_mv, 109);
    REFUSED(BQ_OK, wire_limit_mv, 150);
    REFUSED(BQ_E_CLOCK, spi_hz, 9999);
    REFUSED(BQ_E_CLOCK, spi_hz, 1000001);
    REFUSED(BQ_E_UNLATCHED, cov_delay_us, 0);
    REFUSED(BQ_E_UNLATCHED, cuv_delay_us, 0);
    REFUSED(BQ_E_UNLATCHED, ot_delay_ms, 0);
    REFUSED(BQ_E_CONFIG, ot_delay_ms, 10); /* not above the settling of the sensors */
#undef REFUSED
    static const uint16_t ot[] = {35, 39, 41, 42, 91, 95, 100};
    for (size_t i = 0; i < sizeof ot / sizeof ot[0]; i++) {
        usual();
        b.config.ot_c[1] = (uint8_t)ot[i];
        TEST_ASSERT_TRUE(init() == BQ_E_RANGE || init() == BQ_E_NO_CODE);
    }
    usual();
    b.config.sensors = 1; /* a limit without its sensor */
    EXPECT_STATUS(BQ_E_CONFIG, init());
}

/* proves: PL-NUM-13, PL-NUM-14, PL-NUM-16, PL-COV-12, PL-ELEC-04, PL-COV-01, PL-CUV-01 */
static void thresholds_that_no_code_expresses_are_refused(void)
{
    for (unsigned mv = 1; mv <= 6000; mv++) {
        bool legal = mv >= 2000 && mv <= 5000 && mv % 50 == 0;
        usual();
        b.config.cuv_mv = 0;
        b.config.cov_mv = (uint16_t)mv;
        bq_status status = init();
        TEST_ASSERT_EQUAL_INT_MESSAGE(legal, status == BQ_OK, bench_text("COV %u", mv));
        TEST_ASSERT_TRUE(legal || status == BQ_E_RANGE || status == BQ_E_NO_CODE);
        legal = mv >= 700 && mv <= 3300 && mv % 100 == 0;
        usual();
        b.config.cov_mv = 0;
        b.config.cuv_mv = (uint16_t)mv;
        TEST_ASSERT_EQUAL_INT_MESSAGE(legal, init() == BQ_OK, bench_text("CUV %u", mv));
    }
    for (unsigned cov = 2000; cov <= 5000; cov += 50) {
        for (unsigned cuv = 700; cuv <= 3300; cuv += 100) {
            usual();
            b.config.cov_mv = (uint16_t)cov;
            b.config.cuv_mv = (uint16_t)cuv;
            EXPECT_STATUS(cov >= cuv + 300 ? BQ_OK : BQ_E_COV_CUV, init());
        }
    }
}

/* proves: PL-NUM-29, PL-NUM-30, PL-ELEC-07, PL-AMB-44, PL-FLT-02, PL-FLT-03 */
static void delays_that_no_code_expresses_are_refused(void)
{
    for (uint32_t us = 50; us <= 4000000; us += us < 5000 ? 50 : 12500) {
        bool legal = (us % 100 == 0 && us <= 3100) || (us % 100000 == 0 && us <= 3100000);
        usual();
        b.config.cov_delay_us = us;
        TEST_ASSERT_EQUAL_INT_MESSAGE(legal, init() == BQ_OK, bench_text("COVT %u", us));
        usual();
        b.config.cuv_delay_us = us;
        TEST_ASSERT_EQUAL_INT_MESSAGE(legal, init() == BQ_OK, bench_text("CUVT %u", us));
    }
    for (uint32_t ms = 11; ms <= 2700; ms++) {
        usual();
        b.config.ot_delay_ms = (uint16_t)ms;
        TEST_ASSERT_EQUAL_INT(ms % 10 == 0 && ms <= 2550, init() == BQ_OK);
    }
}

/* proves: PL-NUM-38, PL-TIM-09, PL-AMB-21, PL-TIM-01 */
static void the_clock_limit_of_the_stack(void)
{
    static const struct {
        uint8_t devices;
        uint32_t khz;
    } v[] = {{1, 1000}, {2, 1000}, {4, 1000}, {6, 909},  {8, 689}, {12, 465},
             {16, 350}, {24, 235}, {32, 176}, {48, 118}, {62, 91}};
    for (size_t i = 0; i < sizeof v / sizeof v[0]; i++) {
        usual();
        b.config.devices = v[i].devices;
        b.config.spi_hz = v[i].khz * 1000;
        TEST_ASSERT_EQUAL_INT_MESSAGE(BQ_OK, init(), bench_text("%u devices", v[i].devices));
        b.config.spi_hz = v[i].khz * 1000 + (v[i].khz == 1000 ? 1 : 2000);
        TEST_ASSERT_EQUAL_INT_MESSAGE(BQ_E_CLOCK, init(), bench_text("%u devices", v[i].devices));
    }
}

/* proves: PL-NUM-13, PL-NUM-14, PL-NUM-29, PL-NUM-30, PL-COV-01, PL-CUV-01, PL-FLT-02, PL-OT-01 */
static void every_code_arrives_in_the_chip(void)
{
    for (unsigned k = 0; k <= 60; k++) {
        unsigned cuv = k < 27 ? k : 3;
        bool has_cuv = 2000 + 50 * k >= 700 + 100 * cuv + 300;
        unsigned delay = 1 + k % 31, ot = k % 12, ott = 2 + k * 4, unit = k & 1 ? 0x80 : 0;
        bench_up(1, NULL);
        sim_pl_set_cells(&b.pl, 1, (const double[6]){1.9, 1.9, 1.9, 1.9, 1.9, 1.9});
        b.config.cov_mv = (uint16_t)(2000 + 50 * k);
        b.config.cuv_mv = (uint16_t)(has_cuv ? 700 + 100 * cuv : 0);
        b.config.cov_delay_us = delay * (k & 1 ? 100000u : 100u);
        b.config.cuv_delay_us = delay * (k & 1 ? 100u : 100000u);
        b.config.ot_c[0] = (uint8_t)(ot ? 35 + 5 * ot : 0);
        b.config.ot_c[1] = (uint8_t)(ot ? 90 : 40);
        b.config.ot_delay_ms = (uint16_t)(ott * 10);
        bench_init();
        EXPECT_STATUS(BQ_OK, bench_start());
        TEST_ASSERT_EQUAL_HEX8(k, PEEK(1, 0x42));
        TEST_ASSERT_EQUAL_HEX8(delay | unit, PEEK(1, 0x43));
        if (has_cuv) {
            TEST_ASSERT_EQUAL_HEX8(cuv, PEEK(1, 0x44));
            TEST_ASSERT_EQUAL_HEX8(delay | (unit ^ 0x80u), PEEK(1, 0x45));
        } else {
            TEST_ASSERT_EQUAL_HEX8(0x80, PEEK(1, 0x44) & 0x80);
        }
        TEST_ASSERT_EQUAL_HEX8(ot | (ot ? 11u : 1u) << 4, PEEK(1, 0x46));
        TEST_ASSERT_EQUAL_HEX8(ott, PEEK(1, 0x47));
        bench_no_misuse();
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(each_wrong_field_has_its_refusal);
    RUN_TEST(thresholds_that_no_code_expresses_are_refused);
    RUN_TEST(delays_that_no_code_expresses_are_refused);
    RUN_TEST(the_clock_limit_of_the_stack);
    RUN_TEST(every_code_arrives_in_the_chip);
    return UNITY_END();
}
