/* SPDX-License-Identifier: Apache-2.0 */
#include "bqhost/bq76pl536_regs.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

/* What PL-REG-50 lists; everything else keeps nothing. */
static unsigned listed_mask(unsigned reg)
{
    switch (reg) {
    case 0x20: case 0x21: return 0x10;
    case 0x30: return 0x7f;
    case 0x31: return 0xc7;
    case 0x32: case 0x3b: return 0x3f;
    case 0x33: case 0x42: return 0xbf;
    case 0x3d: case 0x46: case 0x47: case 0x48: case 0x49: case 0x4a: case 0x4b: return 0xff;
    case 0x40: return 0xfc;
    case 0x41: return 0x01;
    case 0x43: case 0x44: case 0x45: return 0x9f;
    default: return 0x00;
    }
}

/* proves: PL-REG-50 */
static void test_readback_masks(void)
{
    for (unsigned reg = 0; reg < 256u; reg++) {
        TEST_ASSERT_EQUAL_HEX8(listed_mask(reg), bq76pl536_readback_mask((uint8_t)reg));
    }
}

/* Bits a host may set, by the register descriptions; -1 = nothing may be written there. */
static int may_set(unsigned reg)
{
    switch (reg) {
    case 0x20: return 0xff;
    case 0x21: return 0x3f;
    case 0x34: return 0x01;
    case 0x3a: return 0x37; /* 0x35 and 0x27, see the codes below */
    case 0x3b: return 0xbf;
    case 0x3c: return 0xa5;
    case 0x3d: case 0x3f: return 0x00;
    default: return reg >= 0x30u && listed_mask(reg) != 0u ? (int)listed_mask(reg) : -1;
    }
}

static bool legal_code(unsigned reg, unsigned value)
{
    switch (reg) {
    case 0x20: case 0x21: return (value & 0x10u) == 0u || value == 0x10u;
    case 0x3a: return value == 0x35u || value == 0x27u || value == 0x00u;
    case 0x3b: return (value & 0x3fu) != 0u && (value & 0x3fu) != 0x3fu;
    case 0x3c: return value == 0xa5u;
    case 0x42: return (value & 0x3fu) <= 0x3cu;
    case 0x44: return (value & 0x1fu) <= 0x1au;
    case 0x46: return (value & 0x0fu) <= 11u && value >> 4 <= 11u;
    default: return true;
    }
}

/* Every register, every value. */
/* proves: PL-REG-01, PL-REG-02, PL-REG-17, PL-REG-24, PL-REG-30, PL-REG-35, PL-REG-49, PL-TEST-03,
 * PL-FLT-14, PL-G3-14, PL-AMB-45, PL-AMB-82, PL-AMB-101, PL-AMB-106, PL-AMB-108, PL-NUM-28, PL-ADR-15 */
static void test_what_may_be_written(void)
{
    for (unsigned reg = 0; reg < 256u; reg++) {
        int mask = may_set(reg);
        for (unsigned value = 0; value < 256u; value++) {
            bool legal = mask >= 0 && (value & ~(unsigned)mask) == 0u && legal_code(reg, value);
            bq_status expected = mask < 0 ? BQ_E_ARG : legal ? BQ_OK : BQ_E_RANGE;
            TEST_ASSERT_EQUAL_INT(expected, bq76pl536_write_check((uint8_t)reg, (uint8_t)value));
        }
    }
}

/* The mistake of clearing with 0xff, which forces the line, and the rule against it. */
/* proves: PL-FLT-14 */
static void test_force_never_joins_a_clearing_write(void)
{
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_write_check(BQ76PL536_FAULT_STATUS, 0xff));
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_write_check(BQ76PL536_ALERT_STATUS, 0xff));
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_write_check(BQ76PL536_ALERT_STATUS, 0xef));
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_write_check(BQ76PL536_FAULT_STATUS, 0x2f));
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_write_check(BQ76PL536_FAULT_STATUS, BQ76PL536_FAULT_FORCE));
}

/* proves: PL-TEST-03, PL-OTP-09 */
static void test_test_mode_and_programming_cannot_be_asked_for(void)
{
    for (unsigned value = 1; value < 256u; value++) {
        TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_write_check(BQ76PL536_TEST_SELECT, (uint8_t)value));
        TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq76pl536_write_check(BQ76PL536_E_EN, (uint8_t)value));
    }
}

/* The header's addresses and bits are those of the register list, written out here once more. */
/* proves: PL-REG-07, PL-REG-08, PL-REG-09, PL-REG-10, PL-REG-11, PL-REG-12, PL-REG-13, PL-REG-14,
 * PL-REG-15, PL-REG-16, PL-REG-18, PL-REG-19, PL-REG-20, PL-REG-21,
 * PL-REG-22, PL-REG-23, PL-REG-25, PL-REG-26, PL-REG-27, PL-REG-28, PL-REG-29, PL-REG-31, PL-REG-32,
 * PL-REG-33, PL-REG-34, PL-REG-36, PL-REG-37, PL-REG-38, PL-REG-39, PL-REG-40, PL-REG-41, PL-REG-42, PL-REG-43,
 * PL-REG-44, PL-REG-45, PL-REG-46, PL-REG-47, PL-REG-48, PL-GEN-08 */
static void test_addresses_and_bits(void)
{
    static const uint8_t pairs[][2] = {
        {BQ76PL536_DEVICE_STATUS, 0x00}, {BQ76PL536_GPAI, 0x01}, {BQ76PL536_VCELL1, 0x03},
        {BQ76PL536_VCELL1 + 2, 0x05}, {BQ76PL536_VCELL1 + 4, 0x07}, {BQ76PL536_VCELL1 + 6, 0x09},
        {BQ76PL536_VCELL1 + 8, 0x0b}, {BQ76PL536_VCELL1 + 10, 0x0d}, {BQ76PL536_TEMPERATURE1, 0x0f},
        {BQ76PL536_TEMPERATURE2, 0x11}, {BQ76PL536_ALERT_STATUS, 0x20}, {BQ76PL536_FAULT_STATUS, 0x21},
        {BQ76PL536_COV_FAULT, 0x22}, {BQ76PL536_CUV_FAULT, 0x23}, {BQ76PL536_PRESULT_A, 0x24},
        {BQ76PL536_PRESULT_B, 0x25}, {BQ76PL536_ADC_CONTROL, 0x30}, {BQ76PL536_IO_CONTROL, 0x31},
        {BQ76PL536_CB_CTRL, 0x32}, {BQ76PL536_CB_TIME, 0x33}, {BQ76PL536_ADC_CONVERT, 0x34},
        {BQ76PL536_SHDW_CTRL, 0x3a}, {BQ76PL536_ADDRESS_CONTROL, 0x3b}, {BQ76PL536_RESET, 0x3c},
        {BQ76PL536_TEST_SELECT, 0x3d}, {BQ76PL536_E_EN, 0x3f}, {BQ76PL536_FUNCTION_CONFIG, 0x40},
        {BQ76PL536_IO_CONFIG, 0x41}, {BQ76PL536_CONFIG_COV, 0x42}, {BQ76PL536_CONFIG_COVT, 0x43},
        {BQ76PL536_CONFIG_CUV, 0x44}, {BQ76PL536_CONFIG_CUVT, 0x45}, {BQ76PL536_CONFIG_OT, 0x46},
        {BQ76PL536_CONFIG_OTT, 0x47}, {BQ76PL536_USER1, 0x48}, {BQ76PL536_USER1 + 1, 0x49},
        {BQ76PL536_USER1 + 2, 0x4a}, {BQ76PL536_USER4, 0x4b}, {BQ76PL536_REG_LAST, 0x4b},
        {BQ76PL536_GROUP3_FIRST + BQ76PL536_GROUP3_COUNT - 1, 0x4b}, {BQ76PL536_DS_AR, 1 << 7},
        {BQ76PL536_DS_FAULT, 1 << 6}, {BQ76PL536_DS_ALERT, 1 << 5}, {BQ76PL536_DS_ZERO, 1 << 4},
        {BQ76PL536_DS_ECC_COR, 1 << 3}, {BQ76PL536_DS_UVLO, 1 << 2}, {BQ76PL536_DS_CBT, 1 << 1},
        {BQ76PL536_DS_DRDY, 1 << 0}, {BQ76PL536_ALERT_AR, 1 << 7}, {BQ76PL536_ALERT_PARITY, 1 << 6},
        {BQ76PL536_ALERT_ECC_ERR, 1 << 5}, {BQ76PL536_ALERT_FORCE, 1 << 4}, {BQ76PL536_ALERT_TSD, 1 << 3},
        {BQ76PL536_ALERT_SLEEP, 1 << 2}, {BQ76PL536_ALERT_OT2, 1 << 1}, {BQ76PL536_ALERT_OT1, 1 << 0},
        {BQ76PL536_FAULT_I_FAULT, 1 << 5}, {BQ76PL536_FAULT_FORCE, 1 << 4}, {BQ76PL536_FAULT_POR, 1 << 3},
        {BQ76PL536_FAULT_CRC, 1 << 2}, {BQ76PL536_FAULT_CUV, 1 << 1}, {BQ76PL536_FAULT_COV, 1 << 0},
        {BQ76PL536_ADC_ON, 1 << 6}, {BQ76PL536_ADC_TS2, 1 << 5}, {BQ76PL536_ADC_TS1, 1 << 4},
        {BQ76PL536_ADC_GPAI, 1 << 3}, {BQ76PL536_ADC_CELL_SEL, 7}, {BQ76PL536_IO_AUX, 1 << 7},
        {BQ76PL536_IO_GPIO_OUT, 1 << 6}, {BQ76PL536_IO_GPIO_IN, 1 << 5}, {BQ76PL536_IO_SLEEP, 1 << 2},
        {BQ76PL536_IO_TS2, 1 << 1}, {BQ76PL536_IO_TS1, 1 << 0}, {BQ76PL536_CB_MASK, 0x3f},
        {BQ76PL536_CB_MINUTES, 1 << 7}, {BQ76PL536_CB_DURATION, 0x3f}, {BQ76PL536_CONVERT_START, 1},
        {BQ76PL536_SHDW_KEY, 0x35}, {BQ76PL536_SHDW_REFRESH, 0x27}, {BQ76PL536_ADDRESS_AR, 1 << 7},
        {BQ76PL536_ADDRESS_MASK, 0x3f}, {BQ76PL536_RESET_CODE, 0xa5}, {BQ76PL536_E_EN_PROGRAM, 0x91},
        {BQ76PL536_FUNC_ADCT, 3 << 6}, {BQ76PL536_FUNC_ADCT_6US, 1 << 6}, {BQ76PL536_FUNC_GPAI_REF, 1 << 5},
        {BQ76PL536_FUNC_GPAI_SRC, 1 << 4}, {BQ76PL536_FUNC_CN, 3 << 2}, {BQ76PL536_IOC_CRC_DIS, 1},
        {BQ76PL536_COV_DISABLE, 1 << 7}, {BQ76PL536_CUV_DISABLE, 1 << 7}, {BQ76PL536_COV_CODE_MAX, 0x3c},
        {BQ76PL536_CUV_CODE_MAX, 0x1a}, {BQ76PL536_DELAY_MS, 1 << 7}, {BQ76PL536_DELAY_CODE, 31},
        {BQ76PL536_OT_CODE_MAX, 11}, {BQ76PL536_RESET_DEVICE_STATUS, 0x61},
        {BQ76PL536_RESET_ALERT_STATUS, 0x80}, {BQ76PL536_RESET_FAULT_STATUS, 0x08},
    };
    for (unsigned i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        TEST_ASSERT_EQUAL_HEX8(pairs[i][1], pairs[i][0]);
    }
}

/* proves: PL-ADR-01 */
static void test_device_addresses(void)
{
    TEST_ASSERT_EQUAL_HEX8(0x00, BQ76PL536_ADDR_NONE);
    TEST_ASSERT_EQUAL_HEX8(0x01, BQ76PL536_ADDR_FIRST);
    TEST_ASSERT_EQUAL_HEX8(0x3e, BQ76PL536_ADDR_LAST);
    TEST_ASSERT_EQUAL_HEX8(0x3f, BQ76PL536_ADDR_BROADCAST);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_readback_masks);
    RUN_TEST(test_what_may_be_written);
    RUN_TEST(test_force_never_joins_a_clearing_write);
    RUN_TEST(test_test_mode_and_programming_cannot_be_asked_for);
    RUN_TEST(test_addresses_and_bits);
    RUN_TEST(test_device_addresses);
    return UNITY_END();
}
