/* SPDX-License-Identifier: Apache-2.0 */
/* Undervoltage lockout, resets and thermal shutdown: PL-UVLO, PL-POR, PL-TSD. */
#include "rig.h"

static void vbat(double volts)
{
    TEST_ASSERT_EQUAL_INT(0, sim_pl_set_vbat(&rig, 1, volts));
}

static void die(double celsius)
{
    TEST_ASSERT_EQUAL_INT(0, sim_pl_set_tdie(&rig, 1, celsius));
}

/* proves: PL-UVLO-01, PL-POR-01, PL-POR-03, PL-NUM-40, PL-AMB-92, PL-TIM-18, PL-TIM-20 */
static void thresholds_falling_and_rising(void)
{
    rig_ready(1);
    vbat(5.31);
    rig_s(1);
    MODE(SIM_PL_ACTIVE, 1);
    vbat(5.29);
    rig_us(14);
    MODE(SIM_PL_ACTIVE, 1);
    rig_us(2);
    MODE(SIM_PL_UVLO, 1);
    vbat(5.31); /* hysteresis */
    rig_s(1);
    MODE(SIM_PL_UVLO, 1);
    vbat(4.79);
    rig_s(1);
    MODE(SIM_PL_UVLO, 1);
    vbat(4.77);
    rig_us(14);
    MODE(SIM_PL_UVLO, 1);
    rig_us(2);
    MODE(SIM_PL_OFF, 1);
    vbat(5.27);
    rig_s(1);
    MODE(SIM_PL_OFF, 1);
    vbat(5.29);
    rig_us(1);
    MODE(SIM_PL_RESET, 1);
    rig_us(55990);
    MODE(SIM_PL_RESET, 1);
    rig_us(20);
    MODE(SIM_PL_UVLO, 1);
    vbat(5.66);
    rig_s(1);
    MODE(SIM_PL_UVLO, 1);
    vbat(5.68);
    rig_ms(1);
    MODE(SIM_PL_ACTIVE, 1);
    EXPECT(0x61, 0, R_STATUS);
}

/* proves: PL-AMB-94 */
static void works_from_uvlo_up_to_36_volts(void)
{
    static const double volts[] = {5.31, 6.0, 7.2, 27.0, 30.0, 33.0, 36.0};
    rig_ready(1);
    rig_adc(1, 0x45, 0x40);
    rig_cov(0x2c, 0x01);
    for (size_t i = 0; i < sizeof volts / sizeof volts[0]; i++) {
        vbat(volts[i]);
        sim_pl_set_cell(&rig, 1, 1, 3.6);
        rig_ms(100);
        MODE(SIM_PL_ACTIVE, 1);
        rig_convert(1);
        EXPECT_WORD(0x24dd, 1, R_CELL1);
        sim_pl_set_cell(&rig, 1, 1, 4.3);
        rig_ms(1);
        EXPECT(0x01, 1, R_COV);
        sim_pl_set_cell(&rig, 1, 1, 3.6);
        rig_us(1);
        rig_clear(1, R_FAULT, 0x01);
        EXPECT(0x81, 1, R_STATUS);
    }
}

/* proves: PL-UVLO-01, PL-TIM-20 */
static void a_short_dip_is_not_seen(void)
{
    rig_ready(1);
    for (int i = 0; i < 10; i++) {
        vbat(3.0);
        rig_us(14);
        vbat(20.0);
        rig_us(1);
    }
    MODE(SIM_PL_ACTIVE, 1);
    EXPECT(0x81, 1, R_STATUS);
    EXPECT(0x00, 1, R_FAULT);
}

/* proves: PL-UVLO-02, PL-UVLO-03, PL-AMB-55 */
static void uvlo_keeps_registers_and_raises_no_line(void)
{
    rig_ready(2);
    rig_shadow(1, 0x48, 0x5a);
    rig_write(1, R_ADC, 0x45);
    rig_write(1, R_CBT, 9);
    rig_write(1, R_CB, 0x3f);
    rig_write(1, R_IO, 0x43);
    vbat(5.2);
    rig_us(20);
    EXPECT(0x85, 1, R_STATUS);
    TEST_ASSERT_FALSE(sim_pl_fault_pin(&rig));
    TEST_ASSERT_FALSE(sim_pl_alert_pin(&rig));
    EXPECT(0x5a, 1, 0x48);
    EXPECT(0x45, 1, R_ADC);
    EXPECT(9, 1, R_CBT);
    EXPECT(0, 1, R_CB);
    EXPECT(0x63, 1, R_IO);     /* the released GPIO reads its pull-up */
    EXPECT(0x81, 2, R_STATUS); /* the vertical bus works */
    rig_write(1, 0x30, 0x40);
    EXPECT(0x40, 1, R_ADC);
    vbat(-1.0);
    rig_us(50);
    EXPECT(0x81, 1, R_STATUS); /* live, not latched */
    EXPECT(0x00, 1, R_FAULT);
}

/* proves: PL-POR-02, PL-VB-06, PL-POR-08 */
static void nothing_works_without_supply(void)
{
    rig_ready(3);
    sim_pl_set_supply(&rig, 2, false);
    rig_us(20);
    MODE(SIM_PL_OFF, 2);
    TEST_ASSERT_TRUE(rig_answers(1));
    TEST_ASSERT_FALSE(rig_answers(2));
    TEST_ASSERT_FALSE(rig_answers(3));
    TEST_ASSERT_FALSE(rig_answers(0));
    sim_pl_set_supply(&rig, 2, true);
    rig_ms(55);
    TEST_ASSERT_FALSE(rig_answers(0));
    rig_ms(2);
    EXPECT(0x61, 0, R_STATUS);
    TEST_ASSERT_FALSE(rig_answers(3)); /* still behind an unaddressed device */
    rig_write(0, R_ADDR, 0x82);
    TEST_ASSERT_TRUE(rig_answers(2));
    EXPECT(0x81, 3, R_STATUS); /* kept everything */
}

/* proves: PL-POR-04, PL-POR-05, PL-NUM-41, PL-REG-04, PL-GEN-03, PL-AMB-65 */
static void registers_after_power_on(void)
{
    rig_up(1);
    for (int r = 0; r < 256; r++) {
        int value = r == R_STATUS ? 0x61 : r == R_ALERT ? 0x80 : r == R_FAULT ? 0x09 : r == R_COV ? 0x3f : 0;
        EXPECT(value, 0, r);
        TEST_ASSERT_EQUAL_INT(value, sim_pl_peek(&rig, 1, (uint8_t)r));
    }
    sim_pl_set_otp(&rig, 1, C_COV, 0x80);
    sim_pl_set_otp(&rig, 1, C_CUV, 0x80);
    sim_pl_set_otp(&rig, 1, 0x4b, 0xa5);
    sim_pl_set_supply(&rig, 1, false);
    rig_ms(1);
    sim_pl_set_supply(&rig, 1, true);
    rig_ms(57);
    EXPECT(0x61, 0, R_STATUS);
    EXPECT(0x08, 0, R_FAULT);
    EXPECT(0x00, 0, R_COV);
    EXPECT(0x80, 0, C_COV);
    EXPECT(0x80, 0, C_CUV);
    EXPECT(0xa5, 0, 0x4b);
    rig_address(1);
    rig_write(1, R_ADC, 0x05);
    rig_convert(1); /* converts right after the reset time */
    EXPECT_WORD(0x24dd, 1, R_CELL1);
}

/* proves: PL-NUM-42, PL-FLT-10 */
static void the_first_steps_of_a_host(void)
{
    rig_up(1);
    rig_write(0, R_ADDR, 0x81);
    EXPECT(0xe1, 1, R_STATUS);
    EXPECT(0x81, 1, R_ADDR);
    EXPECT(0x80, 1, R_ALERT);
    rig_clear(1, R_ALERT, 0x80);
    EXPECT(0x00, 1, R_ALERT);
    EXPECT(0xc1, 1, R_STATUS);
    rig_shadow(1, C_COV, 0x2d);
    rig_clear(1, R_FAULT, 0x08);
    EXPECT(0x00, 1, R_FAULT);
    EXPECT(0x81, 1, R_STATUS);
    EXPECT_CLEAN();
}

static void spoil(void)
{
    rig_write(1, R_ADC, 0x7d);
    rig_write(1, R_IO, 0xc7);
    rig_write(1, R_CBT, 0x1e);
    rig_write(1, R_CB, 0x3f);
    rig_shadow(1, C_OTT, 0x12);
    rig_shadow(1, 0x48, 0x34);
    rig_write(1, R_ALERT, 0x10);
    rig_write(1, R_FAULT, 0x10);
    rig_us(1);
}

/* proves: PL-POR-07, PL-POR-04, PL-POR-08, PL-POR-13, PL-AMB-93, PL-TIM-19, PL-REG-04 */
static void the_reset_command_equals_power_on(void)
{
    rig_ready(1);
    for (int value = 0; value < 256; value++) {
        if (value != 0xa5) {
            rig_write(1, R_RESET, value);
        }
    }
    rig_ms(1);
    EXPECT(0x81, 1, R_STATUS);
    spoil();
    rig_write(1, R_RESET, 0xa5);
    MODE(SIM_PL_RESET, 1);
    TEST_ASSERT_FALSE(rig_answers(0));
    TEST_ASSERT_FALSE(rig_answers(1));
    rig_us(499);
    TEST_ASSERT_FALSE(rig_answers(0));
    rig_us(2);
    for (int r = 0; r < 256; r++) {
        int v = r == R_STATUS ? 0x61 : r == R_ALERT ? 0x80 : r == R_FAULT ? 0x09 : r == R_COV ? 0x3f : 0;
        EXPECT(v, 0, r);
    }
    TEST_ASSERT_EQUAL_HEX8(0, sim_pl_cb(&rig, 1));
}

/* proves: PL-POR-08, PL-POR-12 */
static void a_device_in_reset_passes_nothing(void)
{
    const uint8_t tx[4] = {0x03, 0x3c, 0xa5, 0xcb}; /* wrong CRC: no reset */
    uint8_t rx[4];
    rig_ready(3);
    sim_pl_spi(&rig, tx, rx, NULL, 4);
    rig_ms(1);
    TEST_ASSERT_TRUE(rig_answers(1));
    rig_clear(1, R_FAULT, 0x04);
    rig_write(3, R_FAULT, 0x10);
    TEST_ASSERT_TRUE(sim_pl_fault_pin(&rig));
    rig_write(2, R_RESET, 0xa5);
    TEST_ASSERT_FALSE(sim_pl_fault_pin(&rig));
    TEST_ASSERT_FALSE(rig_answers(3));
    sim_pl_set_conv(&rig, true);
    rig_us(50);
    sim_pl_set_conv(&rig, false);
    rig_ms(1);
    TEST_ASSERT_EQUAL_UINT32(0, sim_pl_conversions(&rig, 3));
    TEST_ASSERT_TRUE(sim_pl_fault_pin(&rig));
}

/* proves: PL-POR-13, PL-TEST-01 */
static void reset_ends_sleep_key_and_test_mode(void)
{
    rig_ready(2);
    rig_write(1, R_IO, 0x04);
    rig_us(1);
    MODE(SIM_PL_SLEEP, 1);
    rig_reset(1);
    MODE(SIM_PL_ACTIVE, 1);
    EXPECT(0x80, 0, R_ALERT);
    rig_write(0, R_ADDR, 0x81);
    rig_write(2, R_TEST, 0xa4);
    rig_write(2, R_TEST, 0x25);
    EXPECT(0x25, 2, R_TEST);
    rig_write(2, R_SHDW, 0x35);
    rig_reset(2);
    EXPECT(0x00, 0, R_TEST);
    rig_write(0, 0x48, 0x77); /* the key is gone */
    EXPECT(0x00, 0, 0x48);
}

/* proves: PL-TSD-01, PL-NUM-39, PL-AMB-52 */
static void shutdown_temperatures(void)
{
    rig_ready(1);
    die(141.0);
    rig_ms(1);
    MODE(SIM_PL_ACTIVE, 1);
    die(142.0);
    rig_ms(1);
    MODE(SIM_PL_TSD, 1);
    EXPECT(0x0c, 1, R_ALERT);
    TEST_ASSERT_EQUAL_HEX8(0x00, rig_read(1, R_STATUS) & 0x10);
    die(135.0);
    rig_ms(1);
    MODE(SIM_PL_TSD, 1);
    die(134.0);
    rig_ms(1);
    MODE(SIM_PL_SLEEP, 1);
}

/* proves: PL-TSD-02, PL-AMB-91, PL-AMB-90 */
static void shutdown_and_recovery(void)
{
    rig_ready(1);
    rig_adc(1, 0x45, 0x40);
    rig_write(1, R_IO, 0x83);
    rig_write(1, R_FAULT, 0x10);
    die(150.0);
    rig_us(1);
    EXPECT(0x87, 1, R_IO);
    EXPECT(0x0c, 1, R_ALERT);
    TEST_ASSERT_TRUE(sim_pl_alert_pin(&rig));
    TEST_ASSERT_FALSE(sim_pl_fault_pin(&rig)); /* gated as in SLEEP */
    TEST_ASSERT_FALSE(sim_pl_reg50(&rig, 1));
    TEST_ASSERT_FALSE(sim_pl_aux(&rig, 1));
    rig_clear(1, R_ALERT, 0x0c);
    EXPECT(0x08, 1, R_ALERT); /* hot: TSD does not clear, SLEEP does */
    TEST_ASSERT_FALSE(sim_pl_alert_pin(&rig));
    rig_write(1, R_IO, 0x83);
    EXPECT(0x87, 1, R_IO); /* hot: SLEEP cannot be left */
    MODE(SIM_PL_TSD, 1);
    die(100.0);
    rig_s(1);
    MODE(SIM_PL_SLEEP, 1);
    EXPECT(0x87, 1, R_IO);
    rig_write(1, R_IO, 0x83);
    rig_ms(1);
    MODE(SIM_PL_ACTIVE, 1);
    EXPECT(0x83, 1, R_IO);
    TEST_ASSERT_TRUE(sim_pl_aux(&rig, 1));
    rig_clear(1, R_ALERT, 0x0c);
    EXPECT(0x00, 1, R_ALERT);
    rig_write(1, R_FAULT, 0x00);
    rig_convert(1);
    EXPECT_WORD(0x24dd, 1, R_CELL1);
    EXPECT(0x81, 1, R_STATUS);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(thresholds_falling_and_rising);
    RUN_TEST(works_from_uvlo_up_to_36_volts);
    RUN_TEST(a_short_dip_is_not_seen);
    RUN_TEST(uvlo_keeps_registers_and_raises_no_line);
    RUN_TEST(nothing_works_without_supply);
    RUN_TEST(registers_after_power_on);
    RUN_TEST(the_first_steps_of_a_host);
    RUN_TEST(the_reset_command_equals_power_on);
    RUN_TEST(a_device_in_reset_passes_nothing);
    RUN_TEST(reset_ends_sleep_key_and_test_mode);
    RUN_TEST(shutdown_temperatures);
    RUN_TEST(shutdown_and_recovery);
    return UNITY_END();
}
