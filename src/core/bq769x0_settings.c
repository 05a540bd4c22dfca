/* SPDX-License-Identifier: Apache-2.0 */
/* Protection settings of the bq769x0: physical limits to register codes. */
#include "bqhost/bq769x0_convert.h"

/* Thresholds across the shunt in mV, fine and coarse range: the datasheet's figures. */
static const uint8_t ocd_mv[2][16] = {
    {8, 11, 14, 17, 19, 22, 25, 28, 31, 33, 36, 39, 42, 44, 47, 50},
    {17, 22, 28, 33, 39, 44, 50, 56, 61, 67, 72, 78, 83, 89, 94, 100},
};
static const uint8_t scd_mv[2][8] = {{22, 33, 44, 56, 67, 78, 89, 100},
                                     {44, 67, 89, 111, 133, 155, 178, 200}};

uint16_t bq769x0_ov_code(uint8_t trip)
{
    return (uint16_t)(0x2008u + ((unsigned)trip << 4));
}

uint16_t bq769x0_uv_code(uint8_t trip)
{
    return (uint16_t)(0x1000u + ((unsigned)trip << 4));
}

static int32_t above_offset_uv(bq769x0_trim trim, uint16_t mv)
{
    return ((int32_t)mv - trim.offset_mv) * 1000;
}

/* The datasheet: the code, fraction dropped, must lie in the range, and its middle bits are the trip. */
static bq_status trip_of(bq769x0_trim trim, uint16_t mv, int32_t base, uint8_t *trip)
{
    int32_t uv = above_offset_uv(trim, mv), code = uv < 0 ? 0 : uv / (int32_t)trim.gain_uv;
    if (code < base || code > base + 0x0fff) {
        return BQ_E_NO_CODE;
    }
    *trip = (uint8_t)((uint32_t)code >> 4);
    return BQ_OK;
}

bq_status bq769x0_ov_trip_datasheet(bq769x0_trim trim, uint16_t mv, uint8_t *trip)
{
    return trip_of(trim, mv, 0x2000, trip);
}

bq_status bq769x0_uv_trip_datasheet(bq769x0_trim trim, uint16_t mv, uint8_t *trip)
{
    return trip_of(trim, mv, 0x1000, trip);
}

static bq_status safe_trip(bq769x0_trim trim, uint16_t mv, bool under, uint8_t *trip, int32_t *achieved_uv)
{
    unsigned code = bq769x0_trip(trim.gain_uv, mv - trim.offset_mv, under);
    if (code > 0xffu) {
        return BQ_E_NO_CODE;
    }
    *trip = (uint8_t)code;
    *achieved_uv = bq769x0_cell_uv(trim, under ? bq769x0_uv_code(*trip) : bq769x0_ov_code(*trip));
    return BQ_OK;
}

bq_status bq769x0_ov_trip(bq769x0_trim trim, uint16_t mv, uint8_t *trip, int32_t *achieved_uv)
{
    return safe_trip(trim, mv, false, trip, achieved_uv);
}

bq_status bq769x0_uv_trip(bq769x0_trim trim, uint16_t mv, uint8_t *trip, int32_t *achieved_uv)
{
    return safe_trip(trim, mv, true, trip, achieved_uv);
}

/* Index of the largest threshold not above `limit`, or -1. */
static int threshold(const uint8_t *table, int n, uint32_t limit)
{
    do {
        n--;
    } while (n >= 0 && table[n] > limit);
    return n;
}

bq_status bq769x0_current_codes(uint32_t ocd_uv, uint16_t ocd_delay_ms, uint32_t scd_uv,
                                uint16_t scd_delay_us, bq769x0_current_limits *out)
{
    bq769x0_current_limits l;
    uint32_t ocd = ocd_uv / 1000u, scd = scd_uv / 1000u;
    /* the coarse range only when it holds both limits and one of them needs it */
    unsigned range = (ocd > 50u || scd > 100u) && ocd >= 17u && scd >= 44u ? 1u : 0u;
    int o = threshold(ocd_mv[range], 16, ocd), s = threshold(scd_mv[range], 8, scd);
    int od = bq769x0_delay_code(BQ769X0_DELAY_OCD_MS, ocd_delay_ms, &l.ocd_delay_ms);
    int sd = bq769x0_delay_code(BQ769X0_DELAY_SCD_US, scd_delay_us, &l.scd_delay_us);
    if ((o | s | od | sd) < 0) { /* one of them is -1 */
        return BQ_E_NO_CODE;
    }
    l.ocd_mv = ocd_mv[range][o];
    l.scd_mv = scd_mv[range][s];
    if (l.ocd_mv >= l.scd_mv) {
        return BQ_E_CONFIG;
    }
    l.protect1 = (uint8_t)(range << 7 | (unsigned)sd << 3 | (unsigned)s);
    l.protect2 = (uint8_t)((unsigned)od << 4 | (unsigned)o);
    *out = l;
    return BQ_OK;
}

bq_status bq769x0_protect3(uint8_t ov_delay_s, uint8_t uv_delay_s, uint8_t *reg)
{
    uint16_t achieved;
    int o = bq769x0_delay_code(BQ769X0_DELAY_OV_S, ov_delay_s, &achieved);
    int u = bq769x0_delay_code(BQ769X0_DELAY_UV_S, uv_delay_s, &achieved);
    if ((o | u) < 0) {
        return BQ_E_NO_CODE;
    }
    *reg = (uint8_t)((unsigned)u << 6 | (unsigned)o << 4);
    return BQ_OK;
}
