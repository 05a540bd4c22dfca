/* SPDX-License-Identifier: Apache-2.0 */
#include "bqhost/bq769x0_convert.h"
#include "bqhost/bq769x0_regs.h"

bq769x0_trim bq769x0_trim_from(uint8_t reg50, uint8_t reg51, uint8_t reg59)
{
    bq769x0_trim trim;
    trim.gain_uv = (uint16_t)BQ769X0_GAIN_UV(reg50, reg59);
    trim.offset_mv = (int8_t)reg51;
    return trim;
}

int32_t bq769x0_cell_uv(bq769x0_trim trim, uint16_t code)
{
    return (int32_t)code * (int32_t)trim.gain_uv + (int32_t)trim.offset_mv * 1000;
}

int32_t bq769x0_current_ma(int32_t code, uint32_t shunt_uohm)
{
    int32_t nv = code * 8440;
    uint32_t size = nv < 0 ? (uint32_t)-nv : (uint32_t)nv;
    int32_t ma = (int32_t)((size + shunt_uohm / 2u) / shunt_uohm);
    return nv < 0 ? -ma : ma;
}

bq_status bq769x0_ts_ohms(uint16_t code, uint32_t *ohms)
{
    if (code >= BQ769X0_TS_OPEN) {
        return BQ_E_RANGE;
    }
    /* 10000 x V / (3.3 V - V) with V = 382 uV x code, numerator and denominator halved; divided in two steps,
     * by 1000 and by 10, to stay in 32 bits */
    uint32_t up = 191000u * code, down = 1650000u - 191u * code;
    *ohms = up / down * 10u + (up % down * 10u + down / 2u) / down;
    return BQ_OK;
}

int16_t bq769x0_die_dc(uint16_t code, uint32_t v25_uv)
{
    /* 4.2 mV/K; counted from far below, so that the number that is divided is positive */
    uint32_t above_uv = v25_uv + 62000u * 420u - 382u * code;
    return (int16_t)((int32_t)((above_uv + 210u) / 420u) - 62000 + 250);
}

uint32_t bq769x0_bat_mv(bq769x0_trim trim, uint16_t code, uint8_t inputs)
{
    int32_t mv = (int32_t)((4u * trim.gain_uv * code + 500u) / 1000u) + (int32_t)inputs * trim.offset_mv;
    return mv < 0 ? 0u : (uint32_t)mv;
}

uint16_t bq769x0_wiring(uint8_t inputs, uint8_t cells)
{
    static const uint8_t of_group[3] = {0x13, 0x17, 0x1f}; /* 3, 4, 5 cells */
    unsigned groups = inputs / 5u, mask = 0;
    if (inputs % 5u != 0 || groups < 1u || groups > 3u || cells < 3u * groups || cells > inputs) {
        return 0;
    }
    for (unsigned g = groups; g-- > 0u;) {
        unsigned here = cells / groups + (g < cells % groups ? 1u : 0u);
        mask = mask << 5 | of_group[here - 3u];
    }
    return (uint16_t)mask;
}

bool bq769x0_balance_legal(uint16_t in_use, uint16_t mask, bool across_groups)
{
    bool below = false;
    for (unsigned i = 0; i < 15u; i++) {
        if (i % 5u == 0u && !across_groups) {
            below = false;
        }
        if ((((unsigned)in_use >> i) & 1u) != 0u) {
            bool on = (((unsigned)mask >> i) & 1u) != 0u;
            if (on && below) {
                return false;
            }
            below = on;
        }
    }
    return (mask & ~in_use) == 0;
}
