/* SPDX-License-Identifier: Apache-2.0 */
/* GPIO and AUX, protected registers, ECC and TEST mode: PL-GPIO, PL-G3, PL-ECC, PL-TEST. */
#include "rig.h"

/* proves: PL-GPIO-01, PL-GPIO-02, PL-AMB-97, PL-PIN-10 */
static void gpio_is_open_drain(void)
{
    rig_ready(1);
    TEST_ASSERT_FALSE(sim_pl_gpio(&rig, 1)); /* low after reset */
    EXPECT(0x00, 1, R_IO);
    rig_write(1, R_IO, 0x40);
    TEST_ASSERT_TRUE(sim_pl_gpio(&rig, 1));
    EXPECT(0x60, 1, R_IO);
    sim_pl_set_gpio(&rig, 1, false);
    TEST_ASSERT_FALSE(sim_pl_gpio(&rig, 1));
    EXPECT(0x40, 1, R_IO);
    sim_pl_set_gpio(&rig, 1, true);
    EXPECT(0x60, 1, R_IO);
    rig_write(1, R_IO, 0x00);
    TEST_ASSERT_FALSE(sim_pl_gpio(&rig, 1));
    EXPECT(0x00, 1, R_IO);
    EXPECT_CLEAN();
    rig_write(1, R_IO, 0x20); /* GPIO_IN is read-only */
    EXPECT(0x00, 1, R_IO);
}

/* proves: PL-GPIO-04, PL-GPIO-05 */
static void aux_follows_reg50(void)
{
    rig_ready(1);
    TEST_ASSERT_FALSE(sim_pl_aux(&rig, 1));
    rig_write(1, R_IO, 0x80);
    TEST_ASSERT_TRUE(sim_pl_aux(&rig, 1));
    rig_write(1, R_IO, 0x84);
    rig_us(1);
    TEST_ASSERT_FALSE(sim_pl_aux(&rig, 1));
    rig_write(1, R_IO, 0x80);
    rig_us(1);
    TEST_ASSERT_TRUE(sim_pl_aux(&rig, 1));
    rig_write(1, R_IO, 0x00);
    TEST_ASSERT_FALSE(sim_pl_aux(&rig, 1));
}

/* proves: PL-G3-02, PL-G3-04, PL-G3-05, PL-G3-13, PL-AMB-100, PL-BCAST-06 */
static void a_key_opens_one_write(void)
{
    static const uint8_t mask[12] = {0xfc, 0x00, 0xbf, 0x9f, 0x9f, 0x9f, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff};
    for (int r = C_FUNC; r <= 0x4b; r++) {
        rig_ready(1);
        int before = rig_read(1, r);
        int value = 0x15 & mask[r - C_FUNC];
        if (r == C_IO) {
            continue; /* CRC_DIS has its own tests */
        }
        rig_write(1, r, value);
        EXPECT(before, 1, r);
        EXPECT(0x81, 1, R_STATUS); /* and no flag */
        EXPECT_MISUSE("PL-G3-04", "PL-G3-02");
        rig_write(1, R_SHDW, 0x35);
        EXPECT(0x00, 1, R_SHDW);
        rig_write(1, r, value);
        EXPECT(value, 1, r);
        rig_write(1, r, 0x00);
        EXPECT(value, 1, r);
        rig_write(ALL, R_SHDW, 0x35); /* broadcast key, unicast register and the reverse */
        rig_write(1, r, 0x00);
        EXPECT(0x00, 1, r);
        rig_write(1, R_SHDW, 0x35);
        rig_write(ALL, r, value);
        EXPECT(value, 1, r);
    }
}

/* proves: PL-G3-03, PL-AMB-99, PL-AMB-106, PL-AMB-101, PL-G3-14 */
static void what_uses_up_the_key(void)
{
    static const uint8_t cancel[][2] = {{R_CB, 0x00},   {R_FAULT, 0x00}, {R_ALERT, 0x00}, {R_STATUS, 0x00},
                                        {0x13, 0x00},   {0x4c, 0x00},    {0x4f, 0x00},    {R_SHDW, 0x00},
                                        {R_SHDW, 0x34}, {R_TEST, 0x00},  {R_EEN, 0x00},   {R_RESET, 0x00}};
    for (size_t i = 0; i < sizeof cancel / sizeof cancel[0]; i++) {
        rig_ready(2);
        rig_write(1, R_SHDW, 0x35);
        rig_write(1, cancel[i][0], cancel[i][1]);
        rig_write(1, 0x48, 0x5a);
        EXPECT(0x00, 1, 0x48);
        EXPECT_MISUSE("PL-G3-03", "PL-G3-02", "PL-G3-04", "PL-AMB-99");
    }
}

/* proves: PL-G3-03, PL-AMB-99 */
static void what_leaves_the_key_alone(void)
{
    const uint8_t bad[4] = {0x03, 0x30, 0x7d, 0x31};
    uint8_t rx[4], block[16];
    rig_ready(2);
    rig_write(1, R_SHDW, 0x35);
    rig_read_block(1, R_STATUS, block, 16);
    rig_read_block(1, C_FUNC, block, 12);
    rig_write(1, 0x48, 0x11);
    EXPECT(0x11, 1, 0x48);
    rig_write(1, R_SHDW, 0x35);
    sim_pl_spi(&rig, bad, rx, NULL, 4); /* discarded */
    rig_write(1, 0x48, 0x22);
    EXPECT(0x22, 1, 0x48);
    rig_write(1, R_SHDW, 0x35);
    rig_write(2, R_CB, 0x00); /* to another device */
    rig_write(1, 0x48, 0x33);
    EXPECT(0x33, 1, 0x48);
    rig_write(1, R_SHDW, 0x35);
    rig_write(1, R_SHDW, 0x35);
    rig_write(1, 0x48, 0x44);
    EXPECT(0x44, 1, 0x48);
}

/* proves: PL-AMB-101, PL-G3-14 */
static void the_key_range_ends_at_4b(void)
{
    for (int r = 0x4c; r <= 0x4f; r++) {
        rig_ready(1);
        rig_shadow(1, r, 0xff);
        EXPECT(0x00, 1, r);
        rig_write(1, 0x48, 0xff);
        EXPECT(0x00, 1, 0x48);
        EXPECT_MISUSE("PL-AMB-101", "PL-REG-01");
    }
}

/* proves: PL-AMB-100 */
static void option_user_registers_cannot_be_written(void)
{
    const sim_pl_options o = {.amb100_user_readonly = true};
    rig_ready_with(1, &o);
    for (int r = 0x48; r <= 0x4b; r++) {
        rig_shadow(1, r, 0x5a);
        EXPECT(0x00, 1, r);
    }
    rig_shadow(1, C_OTT, 0x5a);
    EXPECT(0x5a, 1, C_OTT);
    EXPECT(0x81, 1, R_STATUS);
}

/* proves: PL-G3-01, PL-G3-06, PL-G3-07, PL-REG-31, PL-AMB-110 */
static void refresh_reloads_everything(void)
{
    rig_ready(1);
    for (int r = C_FUNC; r <= 0x4b; r++) {
        if (r != C_IO) {
            sim_pl_set_otp(&rig, 1, (uint8_t)r, r == C_COV || r == C_CUV ? 0x80 : 0x0c);
        }
    }
    for (int r = 0x46; r <= 0x4b; r++) {
        rig_shadow(1, r, 0x03);
        EXPECT(0x03, 1, r); /* works from the RAM copy */
    }
    rig_write(1, R_SHDW, 0x27);
    EXPECT(0x00, 1, R_SHDW);
    for (int r = C_FUNC; r <= 0x4b; r++) {
        EXPECT(r == C_IO ? 0 : r == C_COV || r == C_CUV ? 0x80 : 0x0c, 1, r);
    }
    rig_shadow(1, 0x48, 0x55);
    rig_reset(1);
    EXPECT(0x0c, 0, 0x48);
}

/* proves: PL-G3-08, PL-AMB-53, PL-REG-22, PL-REG-23, PL-ALT-06 */
static void parity_of_every_register(void)
{
    for (int r = C_FUNC; r <= 0x4b; r++) {
        int a = r < 0x48 ? 1 << (r - C_FUNC) : 0;
        int b = r < 0x48 ? 0 : 1 << (r - 0x48);
        rig_ready(1);
        TEST_ASSERT_EQUAL_INT(0, sim_pl_damage_ram(&rig, 1, (uint8_t)r, r == C_IO ? 0x01 : 0x04));
        rig_us(1);
        if (r == C_IO) { /* the damage switches CRC off: look without the bus */
            TEST_ASSERT_EQUAL_INT(a, sim_pl_peek(&rig, 1, R_PRES_A));
            TEST_ASSERT_EQUAL_INT(0x40, sim_pl_peek(&rig, 1, R_ALERT));
            continue;
        }
        EXPECT(a, 1, R_PRES_A);
        EXPECT(b, 1, R_PRES_B);
        EXPECT(0x40, 1, R_ALERT);
        TEST_ASSERT_TRUE(sim_pl_alert_pin(&rig));
        if (r & 1) { /* a refresh cures as well */
            rig_write(1, R_SHDW, 0x27);
            rig_shadow(1, C_COV, 0x80);
            rig_clear(1, R_FAULT, 0x01);
        } else {
            rig_shadow(1, r, r == C_COV || r == C_CUV ? 0x80 : 0x00);
        }
        EXPECT(0x00, 1, R_PRES_A);
        EXPECT(0x00, 1, R_PRES_B);
        EXPECT(0x40, 1, R_ALERT); /* latched */
        rig_clear(1, R_ALERT, 0x40);
        EXPECT(0x00, 1, R_ALERT);
    }
}

/* proves: PL-ECC-01, PL-ECC-02, PL-ECC-04, PL-AMB-48, PL-AMB-50, PL-G3-06 */
static void one_wrong_bit_is_corrected(void)
{
    for (int r = C_FUNC; r <= 0x4b; r++) {
        for (int bit = 0; bit < 8; bit++) {
            int value = r == C_COV || r == C_CUV ? 0x80 : r == C_IO ? 0x00 : 0x14;
            rig_ready(1);
            sim_pl_set_otp(&rig, 1, C_COV, 0x80);
            sim_pl_set_otp(&rig, 1, C_CUV, 0x80);
            sim_pl_set_otp(&rig, 1, (uint8_t)r, (uint8_t)value);
            TEST_ASSERT_EQUAL_INT(0, sim_pl_damage_otp(&rig, 1, (uint8_t)r, (uint8_t)(1 << bit)));
            EXPECT(0x81, 1, R_STATUS); /* seen only by a load */
            rig_write(1, R_SHDW, 0x27);
            EXPECT(value, 1, r);
            EXPECT(0x89, 1, R_STATUS);
            EXPECT(0x00, 1, R_ALERT);
            EXPECT(0x00, 1, R_FAULT);
            TEST_ASSERT_FALSE(sim_pl_alert_pin(&rig));
            sim_pl_set_otp(&rig, 1, (uint8_t)r, (uint8_t)value); /* healed: the next load clears the bit */
            rig_write(1, R_SHDW, 0x27);
            EXPECT(0x81, 1, R_STATUS);
        }
    }
}

/* proves: PL-ECC-01, PL-ECC-02 */
static void correction_at_reset_and_power_on(void)
{
    rig_ready(1);
    sim_pl_set_otp(&rig, 1, 0x48, 0x3c);
    sim_pl_damage_otp(&rig, 1, 0x48, 0x10);
    rig_reset(1);
    EXPECT(0x69, 0, R_STATUS);
    EXPECT(0x3c, 0, 0x48);
    sim_pl_set_supply(&rig, 1, false);
    rig_ms(1);
    sim_pl_set_supply(&rig, 1, true);
    rig_ms(60);
    EXPECT(0x69, 0, R_STATUS);
}

/* proves: PL-ECC-01, PL-ECC-03, PL-AMB-49, PL-AMB-50 */
static void two_wrong_bits_are_detected(void)
{
    for (int option = 0; option <= 1; option++) {
        const sim_pl_options o = {.amb49_no_ifault = option != 0};
        rig_ready_with(1, &o);
        sim_pl_set_otp(&rig, 1, C_COV, 0x80);
        sim_pl_set_otp(&rig, 1, C_CUV, 0x80);
        sim_pl_damage_otp(&rig, 1, 0x4a, 0x81);
        rig_write(1, R_SHDW, 0x27);
        EXPECT(0x20, 1, R_ALERT);
        EXPECT(option ? 0x00 : 0x20, 1, R_FAULT);
        EXPECT(option ? 0xa1 : 0xe1, 1, R_STATUS);
        TEST_ASSERT_TRUE(sim_pl_alert_pin(&rig));
        TEST_ASSERT_EQUAL_INT(!option, sim_pl_fault_pin(&rig));
        rig_clear(1, R_ALERT, 0x20);
        rig_clear(1, R_FAULT, 0x20);
        EXPECT(0x81, 1, R_STATUS);
        rig_reset(1); /* every load finds it again */
        EXPECT(0xa0, 0, R_ALERT);
        EXPECT(option ? 0x08 : 0x28, 0, R_FAULT);
    }
}

static void test_mode(int device)
{
    rig_write(device, R_TEST, 0xa4);
    rig_write(device, R_TEST, 0x25);
}

/* proves: PL-TEST-04, PL-TEST-01, PL-AMB-108, PL-TEST-02 */
static void test_mode_of_the_base_cuts_the_host_off(void)
{
    rig_ready(2);
    test_mode(1);
    EXPECT_MISUSE("PL-TEST-04", "PL-TEST-03", "PL-AMB-108");
    TEST_ASSERT_FALSE(rig_answers(1));
    TEST_ASSERT_FALSE(rig_answers(2));
    rig_reset(ALL);
    rig_write(1, R_TEST, 0x00);
    rig_ms(100);
    TEST_ASSERT_FALSE(rig_answers(0));
    TEST_ASSERT_FALSE(rig_answers(1));
    sim_pl_set_supply(&rig, 1, false);
    rig_ms(1);
    sim_pl_set_supply(&rig, 1, true);
    rig_ms(60);
    EXPECT(0x61, 0, R_STATUS);
}

/* proves: PL-TEST-01, PL-AMB-108, PL-AMB-107, PL-REG-34 */
static void test_mode_elsewhere_and_broken_sequences(void)
{
    rig_ready(3);
    test_mode(2);
    EXPECT(0x25, 2, R_TEST);
    EXPECT(0x81, 3, R_STATUS); /* no effect on the stack */
    rig_write(2, R_TEST, 0x00);
    EXPECT(0x00, 2, R_TEST);
    EXPECT_MISUSE("PL-TEST-03", "PL-TEST-01", "PL-TEST-04");
    rig_ready(1);
    rig_write(1, R_TEST, 0xa4);
    EXPECT(0xa4, 1, R_TEST);
    rig_write(1, R_CB, 0x00); /* a write in between voids it */
    rig_write(1, R_TEST, 0x25);
    TEST_ASSERT_TRUE(rig_answers(1));
    rig_write(1, R_TEST, 0x25);
    TEST_ASSERT_TRUE(rig_answers(1));
    rig_write(1, R_TEST, 0xa4);
    EXPECT(0xa4, 1, R_TEST); /* a read is no write */
    rig_write(1, R_TEST, 0x25);
    TEST_ASSERT_FALSE(rig_answers(1));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(gpio_is_open_drain);
    RUN_TEST(aux_follows_reg50);
    RUN_TEST(a_key_opens_one_write);
    RUN_TEST(what_uses_up_the_key);
    RUN_TEST(what_leaves_the_key_alone);
    RUN_TEST(the_key_range_ends_at_4b);
    RUN_TEST(option_user_registers_cannot_be_written);
    RUN_TEST(refresh_reloads_everything);
    RUN_TEST(parity_of_every_register);
    RUN_TEST(one_wrong_bit_is_corrected);
    RUN_TEST(correction_at_reset_and_power_on);
    RUN_TEST(two_wrong_bits_are_detected);
    RUN_TEST(test_mode_of_the_base_cuts_the_host_off);
    RUN_TEST(test_mode_elsewhere_and_broken_sequences);
    return UNITY_END();
}
