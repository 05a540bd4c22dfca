/* SPDX-License-Identifier: Apache-2.0 */
/* SLEEP: PL-SLEEP and its ambiguities. */
#include "rig.h"

static void pins(int fault, int alert)
{
    TEST_ASSERT_EQUAL_INT(fault, sim_pl_fault_pin(&rig));
    TEST_ASSERT_EQUAL_INT(alert, sim_pl_alert_pin(&rig));
}

static void fall_asleep(int device)
{
    rig_write(device, R_IO, 0x04);
    rig_us(1);
}

/* proves: PL-SLEEP-01, PL-SLEEP-02, PL-SLEEP-04, PL-SLEEP-06, PL-ALT-04, PL-AMB-51 */
static void entry_and_exit(void)
{
    rig_ready(1);
    rig_write(1, R_IO, 0x83);
    fall_asleep(1);
    MODE(SIM_PL_SLEEP, 1);
    EXPECT(0x04, 1, R_ALERT);
    EXPECT(0xa1, 1, R_STATUS);
    pins(0, 1);
    TEST_ASSERT_FALSE(sim_pl_reg50(&rig, 1));
    EXPECT(0x04, 1, R_IO);
    rig_clear(1, R_ALERT, 0x04);
    EXPECT(0x00, 1, R_ALERT);
    pins(0, 0);
    rig_s(60);
    EXPECT(0x00, 1, R_ALERT);
    rig_shadow(1, 0x48, 0x5a); /* the bus works */
    EXPECT(0x5a, 1, 0x48);
    rig_write(1, R_ADC, 0x45);
    EXPECT(0x45, 1, R_ADC);
    rig_write(1, R_IO, 0x00);
    rig_us(1);
    MODE(SIM_PL_ACTIVE, 1);
    TEST_ASSERT_TRUE(sim_pl_reg50(&rig, 1));
    EXPECT(0x00, 1, R_ALERT); /* not on exit */
    EXPECT_CLEAN();
}

/* proves: PL-SLEEP-10 */
static void a_second_entry_raises_no_second_flag(void)
{
    rig_ready(1);
    fall_asleep(1);
    rig_clear(1, R_ALERT, 0x04);
    fall_asleep(1);
    rig_write(1, R_IO, 0x44);
    rig_us(1);
    EXPECT(0x00, 1, R_ALERT);
    pins(0, 0);
    rig_write(1, R_IO, 0x00);
    rig_us(1);
    fall_asleep(1);
    EXPECT(0x04, 1, R_ALERT);
}

/* proves: PL-SLEEP-05 */
static void the_sensor_switches_keep_their_bits(void)
{
    rig_ready(1);
    rig_write(1, R_IO, 0x03);
    rig_write(1, R_IO, 0x07);
    rig_us(1);
    EXPECT(0x07, 1, R_IO);
    sim_pl_set_tdie(&rig, 1, 25);
    rig_write(1, R_IO, 0x03);
    EXPECT(0x03, 1, R_IO);
}

/* proves: PL-SLEEP-02, PL-SLEEP-03, PL-SLEEP-08, PL-AMB-90 */
static void flags_are_kept_and_gated(void)
{
    rig_ready(1);
    rig_cov(0x2c, 0x01);
    sim_pl_set_cell(&rig, 1, 3, 4.5);
    rig_write(1, R_ALERT, 0x10);
    rig_ms(1);
    pins(1, 1);
    fall_asleep(1);
    pins(0, 1); /* only ALERT[SLEEP] */
    EXPECT(0x01, 1, R_FAULT);
    EXPECT(0x04, 1, R_COV);
    EXPECT(0x14, 1, R_ALERT);
    EXPECT(0xe1, 1, R_STATUS);
    rig_write(1, R_ALERT, 0x14); /* SLEEP cleared, FORCE kept */
    EXPECT(0x10, 1, R_ALERT);
    pins(0, 0);
    rig_write(1, R_FAULT, 0x10); /* errors in SLEEP set bits, not the pin */
    EXPECT(0x11, 1, R_FAULT);
    pins(0, 0);
    sim_pl_set_cell(&rig, 1, 3, 3.6);
    rig_s(10);
    rig_write(1, R_IO, 0x00);
    rig_us(1);
    pins(1, 1); /* at once, although the cell is fine by now */
    EXPECT(0x11, 1, R_FAULT);
    EXPECT(0x04, 1, R_COV);
}

/* proves: PL-AMB-90 */
static void a_damaged_packet_in_sleep(void)
{
    const uint8_t tx[4] = {0x03, 0x30, 0x7d, 0x31};
    uint8_t rx[4];
    rig_ready(1);
    fall_asleep(1);
    rig_clear(1, R_ALERT, 0x04);
    sim_pl_spi(&rig, tx, rx, NULL, 4);
    EXPECT(0x04, 1, R_FAULT);
    EXPECT(0xc1, 1, R_STATUS);
    pins(0, 0);
    rig_write(1, R_IO, 0x00);
    rig_us(1);
    pins(1, 0);
}

/* proves: PL-AMB-90 */
static void the_north_passes_through_a_sleeping_device(void)
{
    rig_ready(3);
    rig_adc(ALL, 0x45, 0x40);
    fall_asleep(2);
    rig_clear(2, R_ALERT, 0x04);
    pins(0, 0);
    rig_write(3, R_FAULT, 0x10);
    pins(1, 0);
    rig_write(3, R_ALERT, 0x10);
    pins(1, 1);
    sim_pl_set_conv(&rig, true);
    TEST_ASSERT_FALSE(sim_pl_drdy_pin(&rig));
    rig_ms(1);
    sim_pl_set_conv(&rig, false);
    TEST_ASSERT_TRUE(sim_pl_drdy_pin(&rig));
    TEST_ASSERT_EQUAL_UINT32(1, sim_pl_conversions(&rig, 1));
    TEST_ASSERT_EQUAL_UINT32(0, sim_pl_conversions(&rig, 2));
    TEST_ASSERT_EQUAL_UINT32(1, sim_pl_conversions(&rig, 3));
}

/* proves: PL-SLEEP-08, PL-ADC-18 */
static void the_adc_warms_up_again(void)
{
    rig_ready(1);
    rig_adc(1, 0x45, 0x40);
    fall_asleep(1);
    rig_s(1);
    EXPECT(0x45, 1, R_ADC);
    rig_write(1, R_IO, 0x00);
    rig_us(100);
    rig_write(1, R_CONV, 1);
    rig_us(400 + 41);
    EXPECT(0xa0, 1, R_STATUS);
    rig_us(1);
    EXPECT(0xa1, 1, R_STATUS);
}

/* proves: PL-SLEEP-13, PL-SLEEP-08, PL-AMB-89, PL-COV-13, PL-TIM-24 */
static void delays_start_from_zero_after_the_blanking(void)
{
    rig_ready(1);
    rig_cov(0x2c, 0x0a);
    sim_pl_set_cell(&rig, 1, 1, 4.5);
    rig_us(900);
    fall_asleep(1);
    rig_s(5);
    EXPECT(0x00, 1, R_FAULT);
    rig_write(1, R_IO, 0x00);
    rig_us(1199);
    EXPECT(0x00, 1, R_FAULT);
    rig_us(2);
    EXPECT(0x01, 1, R_FAULT);
    rig_ready(1);
    rig_cov(0x2c, 0x00);
    fall_asleep(1);
    sim_pl_set_cell(&rig, 1, 1, 4.5);
    rig_ms(1);
    EXPECT(0x00, 1, R_COV);
    rig_write(1, R_IO, 0x00);
    rig_us(199);
    EXPECT(0x00, 1, R_COV);
    rig_us(2);
    EXPECT(0x01, 1, R_COV);
}

/* proves: PL-SLEEP-01, PL-SLEEP-12, PL-BCAST-01 */
static void one_broadcast_for_the_stack(void)
{
    rig_ready(4);
    fall_asleep(ALL);
    for (int d = 1; d <= 4; d++) {
        MODE(SIM_PL_SLEEP, d);
    }
    rig_clear(ALL, R_ALERT, 0x04);
    pins(0, 0);
    rig_write(ALL, R_IO, 0x00);
    rig_us(1);
    for (int d = 1; d <= 4; d++) {
        MODE(SIM_PL_ACTIVE, d);
        EXPECT(0x81, d, R_STATUS);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(entry_and_exit);
    RUN_TEST(a_second_entry_raises_no_second_flag);
    RUN_TEST(the_sensor_switches_keep_their_bits);
    RUN_TEST(flags_are_kept_and_gated);
    RUN_TEST(a_damaged_packet_in_sleep);
    RUN_TEST(the_north_passes_through_a_sleeping_device);
    RUN_TEST(the_adc_warms_up_again);
    RUN_TEST(delays_start_from_zero_after_the_blanking);
    RUN_TEST(one_broadcast_for_the_stack);
    return UNITY_END();
}
