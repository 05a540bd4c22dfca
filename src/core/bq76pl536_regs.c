/* SPDX-License-Identifier: Apache-2.0 */
#include "bqhost/bq76pl536_regs.h"

/* Highest address of the table below is USER4; group 1 lies below its start. */
#define FIRST BQ76PL536_ALERT_STATUS

/* For each register from ALERT_STATUS on: the bits that keep a 1, and the bits a host may set at all. */
static const struct {
    uint8_t keeps, may_set;
} masks[] = {
    [BQ76PL536_ALERT_STATUS - FIRST] = {0x10, 0xff},
    [BQ76PL536_FAULT_STATUS - FIRST] = {0x10, 0x3f},
    [BQ76PL536_ADC_CONTROL - FIRST] = {0x7f, 0x7f},
    [BQ76PL536_IO_CONTROL - FIRST] = {0xc7, 0xc7},
    [BQ76PL536_CB_CTRL - FIRST] = {0x3f, 0x3f},
    [BQ76PL536_CB_TIME - FIRST] = {0xbf, 0xbf},
    [BQ76PL536_ADC_CONVERT - FIRST] = {0x00, 0x01},
    [BQ76PL536_SHDW_CTRL - FIRST] = {0x00, 0x37},
    [BQ76PL536_ADDRESS_CONTROL - FIRST] = {0x3f, 0xbf},
    [BQ76PL536_RESET - FIRST] = {0x00, 0xa5},
    [BQ76PL536_TEST_SELECT - FIRST] = {0xff, 0x00},
    [BQ76PL536_FUNCTION_CONFIG - FIRST] = {0xfc, 0xfc},
    [BQ76PL536_IO_CONFIG - FIRST] = {0x01, 0x01},
    [BQ76PL536_CONFIG_COV - FIRST] = {0xbf, 0xbf},
    [BQ76PL536_CONFIG_COVT - FIRST] = {0x9f, 0x9f},
    [BQ76PL536_CONFIG_CUV - FIRST] = {0x9f, 0x9f},
    [BQ76PL536_CONFIG_CUVT - FIRST] = {0x9f, 0x9f},
    [BQ76PL536_CONFIG_OT - FIRST] = {0xff, 0xff},
    [BQ76PL536_CONFIG_OTT - FIRST] = {0xff, 0xff},
    [BQ76PL536_USER1 - FIRST] = {0xff, 0xff},
    [BQ76PL536_USER1 + 1u - FIRST] = {0xff, 0xff},
    [BQ76PL536_USER1 + 2u - FIRST] = {0xff, 0xff},
    [BQ76PL536_USER4 - FIRST] = {0xff, 0xff},
};

uint8_t bq76pl536_readback_mask(uint8_t reg)
{
    if (reg < FIRST || reg > BQ76PL536_REG_LAST) {
        return 0;
    }
    return masks[reg - FIRST].keeps;
}

static bool writable(uint8_t reg)
{
    if (reg < FIRST || reg > BQ76PL536_REG_LAST) {
        return false;
    }
    /* Two registers of which only the value 0 may be written have an empty mask like a reserved address. */
    return masks[reg - FIRST].may_set != 0u || reg == BQ76PL536_TEST_SELECT || reg == BQ76PL536_E_EN;
}

/* Codes that fit the mask of their register but have no meaning, or a meaning nobody may ask for. */
static bool code_legal(uint8_t reg, uint8_t value)
{
    switch (reg) {
    case BQ76PL536_ALERT_STATUS:
    case BQ76PL536_FAULT_STATUS:
        return (value & BQ76PL536_FAULT_FORCE) == 0u || value == BQ76PL536_FAULT_FORCE;
    case BQ76PL536_SHDW_CTRL:
        return value == BQ76PL536_SHDW_KEY || value == BQ76PL536_SHDW_REFRESH || value == 0u;
    case BQ76PL536_ADDRESS_CONTROL:
        return (value & BQ76PL536_ADDRESS_MASK) >= BQ76PL536_ADDR_FIRST &&
               (value & BQ76PL536_ADDRESS_MASK) <= BQ76PL536_ADDR_LAST;
    case BQ76PL536_RESET:
        return value == BQ76PL536_RESET_CODE;
    case BQ76PL536_CONFIG_COV:
        return (value & 0x3fu) <= BQ76PL536_COV_CODE_MAX;
    case BQ76PL536_CONFIG_CUV:
        return (value & 0x1fu) <= BQ76PL536_CUV_CODE_MAX;
    case BQ76PL536_CONFIG_OT:
        return (value & 0x0fu) <= BQ76PL536_OT_CODE_MAX && (unsigned)(value >> 4) <= BQ76PL536_OT_CODE_MAX;
    default:
        return true;
    }
}

bq_status bq76pl536_write_check(uint8_t reg, uint8_t value)
{
    if (!writable(reg)) {
        return BQ_E_ARG;
    }
    if ((value & (uint8_t)~masks[reg - FIRST].may_set) != 0u || !code_legal(reg, value)) {
        return BQ_E_RANGE;
    }
    return BQ_OK;
}
