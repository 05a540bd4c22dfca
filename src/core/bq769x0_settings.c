/* SPDX-License-Identifier: Apache-2.0 */
/* Protection settings of the bq769x0: physical limits to register codes. */
#include "bqhost/bq769x0_convert.h"

static const uint8_t ocd_mv[2][16] = {
    {8, 11, 14, 17, 19, 22, 25, 28, 31, 33, 36, 39, 42, 44, 47, 50},
    {17, 22, 28, 33, 39, 44, 50, 56, 61, 67, 72, 78, 83, 89, 94, 100},
};
static const uint8_t scd_mv[2][8] = {{22, 33, 44, 56, 67, 78, 89, 100},
                                     {44, 67, 89, 111, 133, 155, 178, 200}};
static const uint16_t ocd_ms[8] = {8, 20, 40, 80, 160, 320, 640, 1280};
static const uint16_t scd_us[4] = {70, 100, 200, 400};
static const uint16_t ov_s[4] = {1, 2, 4, 8}, uv_s[4] = {1, 4, 8, 16};

uint16_t bq769x0_ov_code(uint8_t trip)
{
    return (uint16_t)(0x2008u + ((unsigned)trip << 4));
}

uint16_t bq769x0_uv_code(uint8_t trip)
{
    return (uint16_t)(0x1000u + ((unsigned)trip << 4));
}

/* Code of a voltage, fraction dropped; -1 when the request lies below the offset. */
static int32_t full_code(bq769x0_trim trim, uint16_t mv)
{
    int32_t uv = ((int32_t)mv - trim.offset_mv) * 1000;
    return uv < 0 ? -1 : uv / (int32_t)trim.gain_uv;
}

static bq_status trip_of(int32_t full, int32_t base, uint8_t *trip)
{
    if (full < base || full > base + 0x0fff) {
        return BQ_E_NO_CODE;
    }
    *trip = (uint8_t)((uint32_t)full >> 4);
    return BQ_OK;
}

bq_status bq769x0_ov_trip_datasheet(bq769x0_trim trim, uint16_t mv, uint8_t *trip)
{
    return trip_of(full_code(trim, mv), 0x2000, trip);
}

bq_status bq769x0_uv_trip_datasheet(bq769x0_trim trim, uint16_t mv, uint8_t *trip)
{
    return trip_of(full_code(trim, mv), 0x1000, trip);
}

bq_status bq769x0_ov_trip(bq769x0_trim trim, uint16_t mv, uint8_t *trip, int32_t *achieved_uv)
{
    int32_t full = full_code(trim, mv);
    bq_status status = trip_of(full - 8, 0x2000, trip); /* largest trip with 0x2008 + 16 trip <= full */
    if (full > 0x2fff) {
        status = BQ_E_NO_CODE;
    }
    if (status == BQ_OK) {
        *achieved_uv = bq769x0_cell_uv(trim, bq769x0_ov_code(*trip));
    }
    return status;
}

bq_status bq769x0_uv_trip(bq769x0_trim trim, uint16_t mv, uint8_t *trip, int32_t *achieved_uv)
{
    /* smallest trip whose threshold is not below the request: codes below it trip */
    int32_t uv = ((int32_t)mv - trim.offset_mv) * 1000;
    int32_t up = uv <= 0 ? -1 : (uv + (int32_t)trim.gain_uv - 1) / (int32_t)trim.gain_uv;
    bq_status status = up < 0x1000 ? BQ_E_NO_CODE : trip_of(up + 15, 0x1000, trip);
    if (status == BQ_OK) {
        *achieved_uv = bq769x0_cell_uv(trim, bq769x0_uv_code(*trip));
    }
    return status;
}

/* Index of the largest entry not above `limit`, or -1. */
static int pick8(const uint8_t *table, int n, uint32_t limit)
{
    while (n > 0 && table[n - 1] > limit) {
        n--;
    }
    return n - 1;
}

static int pick16(const uint16_t *table, int n, uint32_t limit)
{
    while (n > 0 && table[n - 1] > limit) {
        n--;
    }
    return n - 1;
}

bq_status bq769x0_current_codes(uint32_t ocd_uv, uint16_t ocd_delay_ms, uint32_t scd_uv,
                                uint16_t scd_delay_us, bq769x0_current_limits *out)
{
    uint32_t ocd = ocd_uv / 1000u, scd = scd_uv / 1000u;
    /* the coarse range only when it holds both limits and one of them needs it */
    unsigned range = (ocd > 50u || scd > 100u) && ocd >= 17u && scd >= 44u ? 1u : 0u;
    int o = pick8(ocd_mv[range], 16, ocd), s = pick8(scd_mv[range], 8, scd);
    int od = pick16(ocd_ms, 8, ocd_delay_ms), sd = pick16(scd_us, 4, scd_delay_us);
    if (o < 0 || s < 0 || od < 0 || sd < 0) {
        return BQ_E_NO_CODE;
    }
    if (ocd_mv[range][o] >= scd_mv[range][s]) {
        return BQ_E_CONFIG;
    }
    out->protect1 = (uint8_t)(range << 7 | (unsigned)sd << 3 | (unsigned)s);
    out->protect2 = (uint8_t)((unsigned)od << 4 | (unsigned)o);
    out->ocd_mv = ocd_mv[range][o];
    out->scd_mv = scd_mv[range][s];
    out->ocd_delay_ms = ocd_ms[od];
    out->scd_delay_us = scd_us[sd];
    return BQ_OK;
}

bq_status bq769x0_protect3(uint8_t ov_delay_s, uint8_t uv_delay_s, uint8_t *reg)
{
    int o = pick16(ov_s, 4, ov_delay_s), u = pick16(uv_s, 4, uv_delay_s);
    if (o < 0 || u < 0) {
        return BQ_E_NO_CODE;
    }
    *reg = (uint8_t)((unsigned)u << 6 | (unsigned)o << 4);
    return BQ_OK;
}
