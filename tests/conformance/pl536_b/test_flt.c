/* SPDX-License-Identifier: Apache-2.0 */
/* Delays, FAULT, ALERT and their recovery: PL-FLT, PL-ALT. */
#include "rig.h"

static void pins(int fault, int alert)
{
    TEST_ASSERT_EQUAL_INT(fault, sim_pl_fault_pin(&rig));
    TEST_ASSERT_EQUAL_INT(alert, sim_pl_alert_pin(&rig));
}

static void bad_packet(int device)
{
    uint8_t tx[4] = {(uint8_t)(device << 1 | 1), R_ADC, 0x45, 0};
    uint8_t rx[4];
    tx[3] = (uint8_t)(rig_crc(tx, 3) ^ 1u);
    sim_pl_spi(&rig, tx, rx, NULL, sizeof tx);
}

/* proves: PL-FLT-10, PL-ALT-03, PL-AMB-54, PL-AMB-35, PL-FLT-16, PL-FLT-09 */
static void after_every_reset_both_lines_are_up(void)
{
    rig_up(3);
    pins(1, 1);
    EXPECT(0x80, 0, R_ALERT);
    EXPECT(0x09, 0, R_FAULT);
    rig_ready(3);
    pins(0, 0);
    rig_reset(2);
    EXPECT(0x80, 0, R_ALERT);
    EXPECT(0x09, 0, R_FAULT);
    pins(1, 1); /* without an address */
    EXPECT(0x81, 1, R_STATUS);
}

/* proves: PL-AMB-54 */
static void option_reset_command_without_por(void)
{
    const sim_pl_options o = {.amb54_reset_no_por = true};
    rig_up_with(1, &o);
    EXPECT(0x09, 0, R_FAULT); /* power-on reset sets it */
    rig_ready_with(1, &o);
    rig_reset(1);
    EXPECT(0x01, 0, R_FAULT);
    sim_pl_set_supply(&rig, 1, false);
    rig_ms(1);
    sim_pl_set_supply(&rig, 1, true);
    rig_ms(60);
    EXPECT(0x09, 0, R_FAULT);
}

/* proves: PL-FLT-06, PL-FLT-07, PL-FLT-08, PL-AMB-36, PL-ALT-01, PL-FLT-17, PL-FLT-13 */
static void force_of_any_device_reaches_the_host(void)
{
    for (int n = 1; n <= 4; n++) {
        rig_ready(4);
        rig_write(n, R_FAULT, 0x10);
        pins(1, 0);
        EXPECT(0x10, n, R_FAULT);
        for (int d = 1; d <= 4; d++) {
            EXPECT(d == n ? 0xc1 : 0x81, d, R_STATUS); /* the bit is local */
        }
        rig_write(n, R_ALERT, 0x10);
        pins(1, 1);
        EXPECT(0xe1, n, R_STATUS);
        rig_write(n, R_FAULT, 0x00);
        pins(0, 1);
        rig_write(n, R_ALERT, 0x00);
        pins(0, 0);
        EXPECT(0x81, n, R_STATUS);
        EXPECT_CLEAN();
    }
}

/* proves: PL-VB-06, PL-FLT-07 */
static void a_dead_device_passes_no_line(void)
{
    rig_ready(3);
    sim_pl_set_supply(&rig, 2, false);
    rig_ms(1);
    pins(0, 0);
    rig_ready(3);
    rig_write(3, R_FAULT, 0x10);
    rig_write(3, R_ALERT, 0x10);
    pins(1, 1);
    sim_pl_set_supply(&rig, 2, false);
    rig_ms(1);
    pins(0, 0);
}

/* proves: PL-FLT-15, PL-ALT-08, PL-FLT-13, PL-FLT-14 */
static void only_force_can_be_set_by_the_host(void)
{
    rig_ready(1);
    rig_write(1, R_FAULT, 0x2f);
    EXPECT(0x00, 1, R_FAULT);
    pins(0, 0);
    rig_write(1, R_ALERT, 0xef);
    EXPECT(0x00, 1, R_ALERT);
    pins(0, 0);
    rig_write(1, R_FAULT, 0xff);
    EXPECT(0x10, 1, R_FAULT);
    pins(1, 0);
    EXPECT_MISUSE("PL-FLT-14", "PL-REG-02");
    sim_misuse_clear(sim_pl_misuse(&rig));
    rig_write(1, R_ALERT, 0xff);
    EXPECT(0x10, 1, R_ALERT);
    pins(1, 1);
    EXPECT_MISUSE("PL-FLT-14");
    rig_write(1, R_FAULT, 0x04);
    EXPECT(0x00, 1, R_FAULT);
    rig_write(1, R_ALERT, 0x04);
    EXPECT(0x00, 1, R_ALERT);
    pins(0, 0);
}

/* proves: PL-FLT-11, PL-FLT-12, PL-FLT-06, PL-FLT-09, PL-AMB-34 */
static void flags_clear_one_by_one(void)
{
    rig_ready(1);
    rig_cov(0x2c, 0x01);
    sim_pl_set_cell(&rig, 1, 2, 4.3);
    rig_us(200);
    bad_packet(1);
    EXPECT(0x05, 1, R_FAULT);
    rig_write(1, R_FAULT, 0x00);
    EXPECT(0x05, 1, R_FAULT);
    rig_clear(1, R_FAULT, 0x04);
    EXPECT(0x01, 1, R_FAULT);
    EXPECT(0xc1, 1, R_STATUS);
    pins(1, 0);
    sim_pl_set_cell(&rig, 1, 2, 3.6);
    rig_us(1);
    rig_write(1, R_FAULT, 0x01);
    EXPECT(0x00, 1, R_FAULT);
    EXPECT(0x81, 1, R_STATUS);
    pins(0, 0);
}

/* proves: PL-AMB-33, PL-FLT-12 */
static void the_one_clears_and_the_zero_does_nothing(void)
{
    rig_ready(1);
    rig_cov(0x2c, 0x0a);
    sim_pl_set_cell(&rig, 1, 1, 4.3);
    rig_ms(2);
    rig_write(1, R_FAULT, 0x01);
    rig_us(999);
    EXPECT(0x00, 1, R_FAULT);
    rig_us(2); /* back without any 0 written */
    EXPECT(0x01, 1, R_FAULT);
}

/* proves: PL-AMB-33 */
static void option_the_latch_is_held_until_the_zero(void)
{
    const sim_pl_options o = {.amb33_hold_until_zero = true};
    rig_ready_with(1, &o);
    EXPECT(0x81, 1, R_STATUS);
    rig_cov(0x2c, 0x0a);
    rig_ot(0x01, 0x01);
    sim_pl_set_cell(&rig, 1, 1, 4.3);
    sim_pl_set_ts_ratio(&rig, 1, 1, 0.3);
    rig_ms(20);
    EXPECT(0x01, 1, R_FAULT);
    EXPECT(0x01, 1, R_ALERT);
    rig_write(1, R_FAULT, 0x01);
    rig_write(1, R_ALERT, 0x01);
    rig_ms(100);
    EXPECT(0x00, 1, R_FAULT);
    EXPECT(0x00, 1, R_ALERT);
    rig_write(1, R_FAULT, 0x00);
    rig_write(1, R_ALERT, 0x00);
    rig_ms(20);
    EXPECT(0x01, 1, R_FAULT);
    EXPECT(0x01, 1, R_ALERT);
}

/* proves: PL-FLT-02, PL-NUM-29, PL-TIM-21, PL-AMB-47 */
static void every_delay_code_of_cov_and_cuv(void)
{
    for (int side = 0; side <= 1; side++) {
        rig_ready(1);
        if (side) {
            rig_cuv(0x15, 0x01);
        } else {
            rig_cov(0x2c, 0x01);
        }
        for (int i = 2; i < 64; i++) {
            int code = (i & 31) | (i & 32 ? 0x80 : 0);
            uint64_t us = (uint64_t)(i & 31) * (i & 32 ? 100000 : 100);
            if ((i & 31) == 0) {
                continue;
            }
            sim_pl_set_cell(&rig, 1, 1, 3.6);
            rig_us(1);
            rig_shadow(1, side ? C_CUVT : C_COVT, code);
            EXPECT(code, 1, side ? C_CUVT : C_COVT);
            rig_clear(1, R_FAULT, 0x03);
            sim_pl_set_cell(&rig, 1, 1, side ? 2.0 : 5.0);
            rig_us(us - 1);
            EXPECT(0x00, 1, R_FAULT);
            rig_us(2);
            EXPECT(side ? 0x02 : 0x01, 1, R_FAULT);
        }
    }
}

/* Time until FAULT rises, in microseconds, to the nearest 2 us. */
static uint64_t trip_time(const sim_pl_options *o, int code)
{
    uint64_t start;
    rig_ready_with(1, o);
    rig_cov(0x2c, code);
    sim_pl_set_cell(&rig, 1, 1, 4.3);
    start = sim_pl_now(&rig);
    for (int i = 0; i < 4000000 && !sim_pl_fault_pin(&rig); i++) {
        uint64_t next = sim_pl_next_event(&rig);
        sim_pl_advance(&rig, next == 0 || next == UINT64_MAX ? 2000 : next);
        if (sim_pl_now(&rig) - start > 5 * SIM_PL_S) {
            break;
        }
    }
    return (sim_pl_now(&rig) - start) / 1000;
}

/* proves: PL-FLT-04, PL-NUM-31, PL-TIM-22 */
static void tolerance_modes_stay_inside_the_windows(void)
{
    static const struct {
        int code;
        uint64_t nominal, low, high;
    } v[] = {
        {0x05, 500, 440, 550},
        {0x1f, 3100, 2728, 3410},
        {0x8a, 1000000, 880000, 1100000},
        {0x9f, 3100000, 2728000, 3410000},
    };
    for (size_t i = 0; i < sizeof v / sizeof v[0]; i++) {
        sim_pl_options o = {.seed = 1};
        TEST_ASSERT_INT_WITHIN(2, v[i].nominal, trip_time(&o, v[i].code));
        o.delay_percent = -12;
        TEST_ASSERT_INT_WITHIN(2, v[i].low, trip_time(&o, v[i].code));
        o.delay_percent = 10;
        TEST_ASSERT_INT_WITHIN(2, v[i].high, trip_time(&o, v[i].code));
        o.delay_percent = 0;
        o.deglitch = true;
        uint64_t t = trip_time(&o, v[i].code);
        TEST_ASSERT_TRUE(t >= v[i].nominal && t <= v[i].nominal + 52);
        TEST_ASSERT_TRUE(t > v[i].nominal + 2);
    }
}

/* proves: PL-ALT-02, PL-ALT-08, PL-ADR-07, PL-AMB-28, PL-AMB-27 */
static void the_address_flag(void)
{
    rig_up(1);
    rig_clear(0, R_ALERT, 0x80); /* without an address it stays */
    EXPECT(0x80, 0, R_ALERT);
    rig_address(1);
    EXPECT(0x80, 1, R_ALERT);
    TEST_ASSERT_TRUE(sim_pl_alert_pin(&rig));
    rig_clear(1, R_ALERT, 0x80);
    EXPECT(0x00, 1, R_ALERT);
    TEST_ASSERT_FALSE(sim_pl_alert_pin(&rig));
}

/* proves: PL-ALT-04, PL-ALT-05, PL-ALT-08, PL-FLT-06 */
static void sleep_and_tsd_flags(void)
{
    rig_ready(1);
    rig_write(1, R_IO, 0x04);
    rig_us(1);
    EXPECT(0x04, 1, R_ALERT);
    pins(0, 1);
    rig_clear(1, R_ALERT, 0x04);
    rig_s(10);
    EXPECT(0x00, 1, R_ALERT);
    rig_ready(1);
    sim_pl_set_tdie(&rig, 1, 143.0);
    rig_us(1);
    EXPECT(0x0c, 1, R_ALERT);
    pins(0, 1);
}

/* proves: PL-ALT-06, PL-ALT-07, PL-ALT-02, PL-FLT-09, PL-FLT-06 */
static void parity_and_ecc_flags(void)
{
    rig_ready(1);
    sim_pl_damage_ram(&rig, 1, C_OTT, 0x01);
    rig_us(1);
    EXPECT(0x40, 1, R_ALERT);
    EXPECT(0xa1, 1, R_STATUS);
    EXPECT(0x80, 1, R_PRES_A);
    pins(0, 1);
    rig_ready(1);
    sim_pl_damage_otp(&rig, 1, 0x48, 0x03);
    rig_write(1, R_SHDW, 0x27);
    rig_us(1);
    TEST_ASSERT_EQUAL_HEX8(0x20, rig_read(1, R_ALERT) & 0x20);
    TEST_ASSERT_EQUAL_HEX8(0x20, rig_read(1, R_FAULT) & 0x20);
    pins(1, 1);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(after_every_reset_both_lines_are_up);
    RUN_TEST(option_reset_command_without_por);
    RUN_TEST(force_of_any_device_reaches_the_host);
    RUN_TEST(a_dead_device_passes_no_line);
    RUN_TEST(only_force_can_be_set_by_the_host);
    RUN_TEST(flags_clear_one_by_one);
    RUN_TEST(the_one_clears_and_the_zero_does_nothing);
    RUN_TEST(option_the_latch_is_held_until_the_zero);
    RUN_TEST(every_delay_code_of_cov_and_cuv);
    RUN_TEST(tolerance_modes_stay_inside_the_windows);
    RUN_TEST(the_address_flag);
    RUN_TEST(sleep_and_tsd_flags);
    RUN_TEST(parity_and_ecc_flags);
    return UNITY_END();
}
