/* SPDX-License-Identifier: Apache-2.0 */
/* Conversion of measurements, off the scan path: exactness before speed. */
#include "bqhost/bq76pl536_convert.h"

/* a * b / c, nearest, halves upward; exact for a <= c < 2^31 and a result below 2^31. Long division, bit by
 * bit: no 64-bit arithmetic. After each bit of b the invariant is: (bits of b so far) * a = quotient * c +
 * rest, rest < c. */
static uint32_t scale(uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t quotient = 0;
    uint32_t rest = 0;
    for (uint32_t bit = (uint32_t)1 << 22; bit != 0u; bit >>= 1) {
        quotient <<= 1;
        rest <<= 1;
        if (rest >= c) {
            rest -= c;
            quotient++;
        }
        if ((b & bit) != 0u) {
            rest += a;
            if (rest >= c) {
                rest -= c;
                quotient++;
            }
        }
    }
    return rest * 2u >= c ? quotient + 1u : quotient;
}

static bq_status from_code(uint16_t code, uint32_t full_scale, uint32_t *out)
{
    if (out == NULL) {
        return BQ_E_ARG;
    }
    if (code > BQ76PL536_CODE_MAX) {
        return BQ_E_RANGE;
    }
    *out = scale(code, full_scale, BQ76PL536_CODE_MAX);
    return BQ_OK;
}

static bq_status to_code(uint32_t value, uint32_t full_scale, uint16_t *code)
{
    if (code == NULL) {
        return BQ_E_ARG;
    }
    if (value > full_scale) {
        return BQ_E_RANGE;
    }
    *code = (uint16_t)scale(value, BQ76PL536_CODE_MAX, full_scale);
    return BQ_OK;
}

bq_status bq76pl536_cell_uv(uint16_t code, uint32_t *uv)
{
    return from_code(code, 6250000u, uv);
}

bq_status bq76pl536_cell_code(uint32_t uv, uint16_t *code)
{
    return to_code(uv, 6250000u, code);
}

bq_status bq76pl536_gpai_uv(uint16_t code, uint32_t *uv)
{
    return from_code(code, 2500000u, uv);
}

bq_status bq76pl536_gpai_code(uint32_t uv, uint16_t *code)
{
    return to_code(uv, 2500000u, code);
}

bq_status bq76pl536_gpai_ratio_ppm(uint16_t code, uint32_t *ppm)
{
    return from_code(code, 500000u, ppm);
}

bq_status bq76pl536_brick_code(uint32_t mv, uint16_t *code)
{
    if (code == NULL) {
        return BQ_E_ARG;
    }
    if (mv > 33333u) {
        return BQ_E_RANGE;
    }
    uint32_t nearest = scale(mv, 16384u, 33333u);
    if (nearest > BQ76PL536_CODE_MAX) {
        return BQ_E_RANGE;
    }
    *code = (uint16_t)nearest;
    return BQ_OK;
}

/* ratio = (code + offset) / divisor (PL-TS-01, PL-TS-02) */
static const struct {
    uint16_t offset, divisor;
} channels[] = {{2, 33046}, {9, 33068}};

static bool no_sensor(uint8_t sensor)
{
    return sensor < 1u || sensor > 2u;
}

bq_status bq76pl536_ts_ratio_ppm(uint8_t sensor, uint16_t code, uint32_t *ppm)
{
    if (ppm == NULL || no_sensor(sensor)) {
        return BQ_E_ARG;
    }
    if (code > BQ76PL536_CODE_MAX) {
        return BQ_E_RANGE;
    }
    *ppm = scale((uint32_t)code + channels[sensor - 1u].offset, 1000000u, channels[sensor - 1u].divisor);
    return BQ_OK;
}

bq_status bq76pl536_ts_code(uint8_t sensor, uint32_t ppm, uint16_t *code)
{
    if (code == NULL || no_sensor(sensor)) {
        return BQ_E_ARG;
    }
    if (ppm > 1000000u) {
        return BQ_E_RANGE;
    }
    uint32_t offset = channels[sensor - 1u].offset;
    uint32_t nearest = scale(ppm, channels[sensor - 1u].divisor, 1000000u);
    if (nearest < offset || nearest - offset > BQ76PL536_CODE_MAX) {
        return BQ_E_RANGE;
    }
    *code = (uint16_t)(nearest - offset);
    return BQ_OK;
}

bq_status bq76pl536_ts_ohms(uint8_t sensor, uint16_t code, uint32_t *ohms)
{
    if (ohms == NULL || no_sensor(sensor)) {
        return BQ_E_ARG;
    }
    if (bq76pl536_code_clipped(code)) {
        return BQ_E_RANGE;
    }
    uint32_t divisor = (uint32_t)code + channels[sensor - 1u].offset;
    uint32_t dividend = (uint32_t)BQ76PL536_R_B_OHMS * channels[sensor - 1u].divisor;
    *ohms = (dividend + divisor / 2u) / divisor - (BQ76PL536_R_B_OHMS + BQ76PL536_R_T_OHMS);
    return BQ_OK;
}

bq_status bq76pl536_ts_code_of_ohms(uint8_t sensor, uint32_t ohms, uint16_t *code)
{
    if (code == NULL || no_sensor(sensor)) {
        return BQ_E_ARG;
    }
    if (ohms > 100000000u) {
        return BQ_E_RANGE;
    }
    uint32_t total = ohms + BQ76PL536_R_B_OHMS + BQ76PL536_R_T_OHMS;
    uint32_t dividend = (uint32_t)BQ76PL536_R_B_OHMS * channels[sensor - 1u].divisor;
    uint32_t nearest = (dividend + total / 2u) / total;
    uint32_t offset = channels[sensor - 1u].offset;
    if (nearest <= offset || nearest - offset >= BQ76PL536_CODE_MAX) {
        return BQ_E_RANGE;
    }
    *code = (uint16_t)(nearest - offset);
    return BQ_OK;
}
