/* SPDX-License-Identifier: Apache-2.0 */
/* The register map, 0x26 to 0xff, PL-REG: one test per row, through the bus alone. */
#include "rig_reg.h"

/* proves: PL-REG-24, PL-REG-01 */
static void reserved_26_to_2f(void)
{
    reserved(0x26, 0x2f);
}

/* proves: PL-REG-25, PL-REG-50, PL-REG-02 */
static void adc_control_30(void)
{
    read_write(0x30, 0x7f, 0x00, 0x00);
    reserved_bits(0x30, 0x7f);
}

/* proves: PL-REG-26, PL-REG-50, PL-REG-02 */
static void io_control_31(void)
{
    read_write(0x31, 0xc7, 0x00, 0x00);
    reserved_bits(0x31, 0xc7 | 0x20);
    rig_ready(1);
    rig_write(1, 0x31, 0x5f);
    EXPECT(0x67, 1, 0x31);
    rig_write(1, 0x31, 0x18);
    EXPECT(0x00, 1, 0x31);
}

/* proves: PL-REG-27, PL-REG-50, PL-REG-02, PL-CB-17 */
static void cb_ctrl_32(void)
{
    read_write(0x32, 0x3f, 0x00, 0x00);
    reserved_bits(0x32, 0x3f);
}

/* proves: PL-REG-28, PL-REG-50, PL-REG-02, PL-CB-17 */
static void cb_time_33(void)
{
    read_write(0x33, 0xbf, 0x00, 0x00);
    reserved_bits(0x33, 0xbf);
}

/* proves: PL-REG-29, PL-REG-50, PL-CONV-08 */
static void adc_convert_34(void)
{
    rig_ready(1);
    for (int value = 0; value < 256; value++) {
        uint32_t before = sim_pl_conversions(&rig, 1);
        rig_write(1, 0x34, value);
        EXPECT(0x00, 1, 0x34);
        rig_ms(1);
        TEST_ASSERT_EQUAL_UINT32(before + (uint32_t)(value & 1), sim_pl_conversions(&rig, 1));
    }
    reserved_bits(0x34, 0x01);
}

/* proves: PL-REG-30, PL-REG-01 */
static void reserved_35_to_39(void)
{
    reserved(0x35, 0x39);
}

/* proves: PL-REG-31, PL-REG-50, PL-G3-05 */
static void shdw_ctrl_3a(void)
{
    rig_ready(1);
    for (int value = 0; value < 256; value++) {
        rig_write(1, 0x3a, value);
        EXPECT(0x00, 1, 0x3a);
    }
}

/* proves: PL-REG-32, PL-REG-50, PL-AMB-26, PL-AMB-29 */
static void address_control_3b(void)
{
    for (int value = 0; value < 256; value++) {
        int address = value & 0x3f;
        rig_ready(1);
        rig_write(1, 0x3b, value);
        bool valid = address != 0 && address != 0x3f;
        TEST_ASSERT_EQUAL_HEX8((valid ? 0x80 : 0x00) | address, sim_pl_peek(&rig, 1, 0x3b));
        if (valid) {
            EXPECT(0x80 | address, address, 0x3b);
        }
    }
    rig_reset(0x3f);
    EXPECT(0x00, 0, 0x3b);
}

/* proves: PL-REG-33, PL-REG-50, PL-AMB-107 */
static void reset_3c(void)
{
    rig_ready(1);
    for (int value = 0; value < 256; value++) {
        if (value != 0xa5) {
            rig_write(1, 0x3c, value);
            EXPECT(0x00, 1, 0x3c);
            EXPECT(0x81, 1, 0x00);
        }
    }
    rig_reset(1);
    EXPECT(0x61, 0, 0x00);
}

/* proves: PL-REG-34, PL-REG-50, PL-AMB-107 */
static void test_select_3d(void)
{
    read_write(0x3d, 0xff, 0x00, 0x00);
}

/* proves: PL-REG-35, PL-REG-01 */
static void reserved_3e(void)
{
    reserved(0x3e, 0x3e);
}

/* proves: PL-REG-36, PL-REG-50, PL-AMB-107 */
static void e_en_3f(void)
{
    rig_ready(1);
    for (int value = 0; value < 256; value++) {
        rig_write(1, 0x3f, value);
        EXPECT(0x00, 1, 0x3f);
    }
}

/* proves: PL-REG-37, PL-REG-50, PL-G3-11, PL-REG-02 */
static void function_config_40(void)
{
    read_write(0x40, 0xfc, 0x00, 0x00);
    reserved_bits(0x40, 0xfc);
}

/* proves: PL-REG-39, PL-REG-50, PL-G3-11, PL-REG-02 */
static void config_cov_42(void)
{
    read_write(0x42, 0xbf, 0x00, 0x00);
    reserved_bits(0x42, 0xbf);
}

/* proves: PL-REG-40, PL-REG-50, PL-G3-11, PL-REG-02 */
static void config_covt_43(void)
{
    read_write(0x43, 0x9f, 0x00, 0x00);
    reserved_bits(0x43, 0x9f);
}

/* proves: PL-REG-41, PL-REG-50, PL-G3-11, PL-REG-02 */
static void config_cuv_44(void)
{
    read_write(0x44, 0x9f, 0x00, 0x00);
    reserved_bits(0x44, 0x9f);
}

/* proves: PL-REG-42, PL-REG-50, PL-G3-11, PL-REG-02 */
static void config_cuvt_45(void)
{
    read_write(0x45, 0x9f, 0x00, 0x00);
    reserved_bits(0x45, 0x9f);
}

/* proves: PL-REG-38, PL-REG-50, PL-G3-11, PL-CRC-08 */
static void io_config_41(void)
{
    for (int value = 0; value < 256; value++) {
        rig_ready(1);
        rig_shadow(1, 0x41, value);
        TEST_ASSERT_EQUAL_HEX8(value & 1, sim_pl_peek(&rig, 1, 0x41));
        TEST_ASSERT_EQUAL_INT((value & 1) == 0, rig_answers(1));
    }
    reserved_bits(0x41, 0x01);
}

/* proves: PL-REG-43, PL-REG-50 */
static void config_ot_46(void)
{
    read_write(0x46, 0xff, 0x00, 0x00);
}

/* proves: PL-REG-44, PL-REG-50 */
static void config_ott_47(void)
{
    read_write(0x47, 0xff, 0x00, 0x00);
}

/* proves: PL-REG-45, PL-REG-50 */
static void user1_48(void)
{
    read_write(0x48, 0xff, 0x00, 0x00);
}

/* proves: PL-REG-46, PL-REG-50 */
static void user2_49(void)
{
    read_write(0x49, 0xff, 0x00, 0x00);
}

/* proves: PL-REG-47, PL-REG-50 */
static void user3_4a(void)
{
    read_write(0x4a, 0xff, 0x00, 0x00);
}

/* proves: PL-REG-48, PL-REG-50 */
static void user4_4b(void)
{
    read_write(0x4b, 0xff, 0x00, 0x00);
}

/* proves: PL-REG-49, PL-REG-01 */
static void reserved_4c_to_ff(void)
{
    reserved(0x4c, 0xff);
}

/* proves: PL-REG-06, PL-AMB-109 */
static void the_map_has_47_addresses(void)
{
    int found = 0;
    rig_up(1);
    for (int reg = 0; reg < 256; reg++) { /* all others are the reserved ranges above */
        bool gap = (reg >= 0x13 && reg <= 0x1f) || (reg >= 0x26 && reg <= 0x2f) ||
                   (reg >= 0x35 && reg <= 0x39) || reg == 0x3e || reg >= 0x4c;
        found += !gap;
        EXPECT(sim_pl_peek(&rig, 1, (uint8_t)reg), 0, reg);
        if (gap) {
            EXPECT(0x00, 0, reg);
        }
    }
    TEST_ASSERT_EQUAL_INT(47, found);
}

/* proves: PL-REG-05, PL-SPI-06 */
static void a_write_counts_only_when_whole_and_right(void)
{
    const uint8_t good[4] = {0x03, 0x30, 0x7d, 0x30};
    uint8_t rx[4];
    for (size_t n = 0; n < 4; n++) {
        rig_ready(1);
        sim_pl_spi(&rig, good, rx, NULL, n);
        EXPECT(0x00, 1, R_ADC);
    }
    for (size_t bit = 0; bit < 32; bit++) {
        uint8_t tx[4] = {0x03, 0x30, 0x7d, 0x30};
        rig_ready(1);
        tx[bit / 8] = (uint8_t)(tx[bit / 8] ^ 0x80u >> bit % 8);
        sim_pl_spi(&rig, tx, rx, NULL, 4);
        EXPECT(0x00, 1, R_ADC);
    }
    rig_ready(1);
    sim_pl_spi(&rig, good, rx, NULL, 4);
    EXPECT(0x7d, 1, R_ADC);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(reserved_26_to_2f);
    RUN_TEST(adc_control_30);
    RUN_TEST(io_control_31);
    RUN_TEST(cb_ctrl_32);
    RUN_TEST(cb_time_33);
    RUN_TEST(adc_convert_34);
    RUN_TEST(reserved_35_to_39);
    RUN_TEST(shdw_ctrl_3a);
    RUN_TEST(address_control_3b);
    RUN_TEST(reset_3c);
    RUN_TEST(test_select_3d);
    RUN_TEST(reserved_3e);
    RUN_TEST(e_en_3f);
    RUN_TEST(function_config_40);
    RUN_TEST(config_cov_42);
    RUN_TEST(config_covt_43);
    RUN_TEST(config_cuv_44);
    RUN_TEST(config_cuvt_45);
    RUN_TEST(io_config_41);
    RUN_TEST(config_ot_46);
    RUN_TEST(config_ott_47);
    RUN_TEST(user1_48);
    RUN_TEST(user2_49);
    RUN_TEST(user3_4a);
    RUN_TEST(user4_4b);
    RUN_TEST(reserved_4c_to_ff);
    RUN_TEST(the_map_has_47_addresses);
    RUN_TEST(a_write_counts_only_when_whole_and_right);
    return UNITY_END();
}
