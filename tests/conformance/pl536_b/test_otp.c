/* SPDX-License-Identifier: Apache-2.0 */
/* EPROM programming: PL-OTP and its ambiguities. */
#include "rig.h"

static const uint8_t image[12] = {0x50, 0x00, 0x2c, 0x85, 0x15, 0x85, 0x55, 0x64, 0x5a, 0xa5, 0x0f, 0xf0};

static void load(void)
{
    rig_ready(2);
    rig_write(1, R_ADC, 0x40);
    rig_ms(1);
    for (int i = 0; i < 12; i++) {
        rig_shadow(1, C_FUNC + i, image[i]);
        EXPECT(image[i], 1, C_FUNC + i);
    }
}

static void program(void)
{
    sim_pl_set_vpp(&rig, 1, true);
    rig_write(1, R_EEN, 0x91);
    rig_us(2500);
    sim_pl_set_vpp(&rig, 1, false);
    rig_ms(1);
}

static void expect_otp(bool programmed)
{
    for (int i = 0; i < 12; i++) {
        TEST_ASSERT_EQUAL_HEX8(programmed ? image[i] : 0x00, sim_pl_otp(&rig, 1, (uint8_t)(C_FUNC + i)));
    }
}

/* proves: PL-OTP-01, PL-OTP-02, PL-OTP-04, PL-AMB-102, PL-AMB-103, PL-REG-36 */
static void a_blank_part_takes_the_image(void)
{
    load();
    expect_otp(false);
    program();
    expect_otp(true);
    EXPECT(0x00, 1, R_EEN);
    rig_write(1, R_SHDW, 0x27);
    for (int i = 0; i < 12; i++) {
        EXPECT(image[i], 1, C_FUNC + i);
    }
    EXPECT_CLEAN();
    TEST_ASSERT_EQUAL_HEX8(0x00, rig_read(1, R_STATUS) & 0x08);
    TEST_ASSERT_EQUAL_HEX8(0x00, rig_read(1, R_ALERT) & 0x60);
    rig_reset(1);
    EXPECT(0x50, 0, C_FUNC);
    EXPECT(0xf0, 0, 0x4b);
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_otp(&rig, 2, 0x40)); /* the neighbour is untouched */
}

/* proves: PL-AMB-104 */
static void the_voltage_may_come_first(void)
{
    rig_ready(1);
    sim_pl_set_vpp(&rig, 1, true);
    rig_shadow(1, 0x48, 0x5a);
    rig_write(1, R_EEN, 0x91);
    rig_us(2000);
    sim_pl_set_vpp(&rig, 1, false);
    TEST_ASSERT_EQUAL_HEX8(0x5a, sim_pl_otp(&rig, 1, 0x48));
}

/* proves: PL-OTP-04, PL-AMB-103 */
static void without_the_voltage_nothing_happens(void)
{
    load();
    rig_write(1, R_EEN, 0x91);
    rig_ms(10);
    expect_otp(false);
    sim_pl_set_vpp(&rig, 1, true); /* too late */
    rig_ms(10);
    sim_pl_set_vpp(&rig, 1, false);
    expect_otp(false);
    EXPECT_MISUSE("PL-OTP-04", "PL-AMB-103", "PL-OTP-03");
}

/* proves: PL-OTP-03 */
static void below_20_volts_nothing_happens(void)
{
    load();
    sim_pl_set_vbat(&rig, 1, 19.9);
    program();
    expect_otp(false);
    EXPECT_MISUSE("PL-OTP-03");
    load();
    sim_pl_set_vbat(&rig, 1, 20.1);
    program();
    expect_otp(true);
}

/* proves: PL-OTP-04 */
static void other_values_do_nothing(void)
{
    static const int values[] = {0x00, 0x01, 0x90, 0x11, 0xff};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        load();
        sim_pl_set_vpp(&rig, 1, true);
        rig_write(1, R_EEN, values[i]);
        rig_ms(3);
        sim_pl_set_vpp(&rig, 1, false);
        expect_otp(false);
        if (values[i] != 0) {
            EXPECT_MISUSE("PL-OTP-05", "PL-REG-36", "PL-REG-02");
        }
    }
}

/* proves: PL-OTP-05, PL-PKT-13, PL-AMB-103 */
static void any_access_closes_the_window(void)
{
    for (int kind = 0; kind < 3; kind++) {
        load();
        sim_pl_set_vpp(&rig, 1, true);
        rig_write(1, R_EEN, 0x91);
        rig_us(1000);
        if (kind == 0) {
            rig_read(1, R_STATUS);
        } else if (kind == 1) {
            rig_write(1, R_CB, 0x00);
        } else {
            rig_write(ALL, R_CB, 0x00);
        }
        rig_us(2000);
        sim_pl_set_vpp(&rig, 1, false);
        expect_otp(false);
        EXPECT_MISUSE("PL-OTP-05", "PL-AMB-103");
    }
}

/* proves: PL-OTP-05, PL-AMB-103 */
static void access_to_another_device_does_not(void)
{
    load();
    sim_pl_set_vpp(&rig, 1, true);
    rig_write(1, R_EEN, 0x91);
    rig_us(1000);
    rig_read(2, R_STATUS);
    rig_us(1000);
    sim_pl_set_vpp(&rig, 1, false);
    expect_otp(true);
}

/* proves: PL-AMB-103, PL-AMB-105 */
static void the_voltage_must_stay(void)
{
    load();
    sim_pl_set_vpp(&rig, 1, true);
    rig_write(1, R_EEN, 0x91);
    rig_us(1400);
    sim_pl_set_vpp(&rig, 1, false);
    rig_ms(5);
    expect_otp(false);
    load();
    sim_pl_set_vpp(&rig, 1, true);
    rig_write(1, R_EEN, 0x91);
    rig_us(1510);
    sim_pl_set_vpp(&rig, 1, false);
    expect_otp(true);
    EXPECT_CLEAN();
    load();
    sim_pl_set_vpp(&rig, 1, true);
    rig_write(1, R_EEN, 0x91);
    rig_ms(51);
    sim_pl_set_vpp(&rig, 1, false);
    rig_ms(1);
    EXPECT_MISUSE("PL-AMB-105", "PL-OTP-06", "PL-TIM-26");
}

/* proves: PL-OTP-12, PL-OTP-02, PL-AMB-111, PL-OTP-01 */
static void a_second_run_is_refused_and_reported(void)
{
    load();
    program();
    EXPECT_CLEAN();
    rig_shadow(1, 0x48, 0xff);
    program();
    expect_otp(true);
    EXPECT_MISUSE("PL-OTP-12", "PL-AMB-111", "PL-OTP-02");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_blank_part_takes_the_image);
    RUN_TEST(the_voltage_may_come_first);
    RUN_TEST(without_the_voltage_nothing_happens);
    RUN_TEST(below_20_volts_nothing_happens);
    RUN_TEST(other_values_do_nothing);
    RUN_TEST(any_access_closes_the_window);
    RUN_TEST(access_to_another_device_does_not);
    RUN_TEST(the_voltage_must_stay);
    RUN_TEST(a_second_run_is_refused_and_reported);
    return UNITY_END();
}
