/* SPDX-License-Identifier: Apache-2.0 */
/* Thresholds, delays and control values of the bq76PL536 as register codes and back. */
#include "bqhost/bq76pl536_convert.h"

/* value = base + step * code, for codes 0..max. */
static bq_status encode(uint32_t value, uint32_t base, uint32_t step, uint32_t max, uint8_t *code)
{
    if (code == NULL) {
        return BQ_E_ARG;
    }
    if (value < base || value > base + step * max) {
        return BQ_E_RANGE;
    }
    uint32_t nearest = (value - base) / step;
    if (base + nearest * step != value) {
        return BQ_E_NO_CODE;
    }
    *code = (uint8_t)nearest;
    return BQ_OK;
}

bq_status bq76pl536_cov_code(uint32_t mv, uint8_t *code)
{
    return encode(mv, 2000, 50, BQ76PL536_COV_CODE_MAX, code);
}

bq_status bq76pl536_cov_mv(uint8_t code, uint16_t *mv)
{
    unsigned field = code & (uint8_t)~BQ76PL536_COV_DISABLE;
    if (mv == NULL) {
        return BQ_E_ARG;
    }
    if (field > BQ76PL536_COV_CODE_MAX) {
        return BQ_E_RANGE;
    }
    *mv = (uint16_t)(2000u + 50u * field);
    return BQ_OK;
}

bq_status bq76pl536_cuv_code(uint32_t mv, uint8_t *code)
{
    return encode(mv, 700, 100, BQ76PL536_CUV_CODE_MAX, code);
}

bq_status bq76pl536_cuv_mv(uint8_t code, uint16_t *mv)
{
    unsigned field = code & (uint8_t)~BQ76PL536_CUV_DISABLE;
    if (mv == NULL) {
        return BQ_E_ARG;
    }
    if (field > BQ76PL536_CUV_CODE_MAX) {
        return BQ_E_RANGE;
    }
    *mv = (uint16_t)(700u + 100u * field);
    return BQ_OK;
}

bq_status bq76pl536_delay_code(uint32_t us, uint8_t *code)
{
    if (us <= 3100u) {
        return encode(us, 0, 100, BQ76PL536_DELAY_CODE, code);
    }
    uint8_t field;
    bq_status status = code == NULL ? BQ_E_ARG : encode(us, 0, 100000, BQ76PL536_DELAY_CODE, &field);
    if (status == BQ_OK) {
        *code = (uint8_t)(BQ76PL536_DELAY_MS | field);
    }
    return status;
}

bq_status bq76pl536_delay_us(uint8_t code, uint32_t *us)
{
    if (us == NULL) {
        return BQ_E_ARG;
    }
    if ((code & 0x60u) != 0u) {
        return BQ_E_RANGE;
    }
    *us = (uint32_t)(code & BQ76PL536_DELAY_CODE) * ((code & BQ76PL536_DELAY_MS) != 0u ? 100000u : 100u);
    return BQ_OK;
}

bq_status bq76pl536_ot_code(uint8_t celsius, uint8_t *code)
{
    if (celsius != 0u) {
        /* Code 1 is 40 degrees; the encoder would let 35 pass as 0, which is "off". */
        return celsius < 40u ? (code == NULL ? BQ_E_ARG : BQ_E_RANGE)
                             : encode(celsius, 35, 5, BQ76PL536_OT_CODE_MAX, code);
    }
    if (code == NULL) {
        return BQ_E_ARG;
    }
    *code = 0;
    return BQ_OK;
}

bq_status bq76pl536_ot_celsius(uint8_t code, uint8_t *celsius)
{
    if (celsius == NULL) {
        return BQ_E_ARG;
    }
    if (code > BQ76PL536_OT_CODE_MAX) {
        return BQ_E_RANGE;
    }
    *celsius = (uint8_t)(code == 0u ? 0u : 35u + 5u * code);
    return BQ_OK;
}

bq_status bq76pl536_ott_code(uint32_t ms, uint8_t *code)
{
    return encode(ms, 0, 10, 255, code);
}

bq_status bq76pl536_ott_ms(uint8_t code, uint16_t *ms)
{
    if (ms == NULL) {
        return BQ_E_ARG;
    }
    *ms = (uint16_t)(10u * code);
    return BQ_OK;
}

bq_status bq76pl536_cb_time_code(uint32_t seconds, uint8_t *code)
{
    if (seconds <= BQ76PL536_CB_DURATION) {
        return encode(seconds, 0, 1, BQ76PL536_CB_DURATION, code);
    }
    uint8_t field;
    bq_status status = code == NULL ? BQ_E_ARG : encode(seconds, 0, 60, BQ76PL536_CB_DURATION, &field);
    if (status == BQ_OK) {
        *code = (uint8_t)(BQ76PL536_CB_MINUTES | field);
    }
    return status;
}

bq_status bq76pl536_cb_time_s(uint8_t code, uint16_t *seconds)
{
    if (seconds == NULL) {
        return BQ_E_ARG;
    }
    if ((code & 0x40u) != 0u) {
        return BQ_E_RANGE;
    }
    *seconds = (uint16_t)((code & BQ76PL536_CB_DURATION) * ((code & BQ76PL536_CB_MINUTES) != 0u ? 60u : 1u));
    return BQ_OK;
}

static bq_status cells_legal(uint8_t cells, const uint8_t *value)
{
    if (value == NULL) {
        return BQ_E_ARG;
    }
    return cells < 3u || cells > 6u ? BQ_E_CELLS : BQ_OK;
}

bq_status bq76pl536_adc_control(uint8_t cells, uint8_t sensors, bool gpai, bool adc_on, uint8_t *value)
{
    bq_status status = sensors > 3u ? BQ_E_ARG : cells_legal(cells, value);
    if (status == BQ_OK) {
        *value = (uint8_t)((adc_on ? BQ76PL536_ADC_ON : 0u) | (unsigned)sensors << 4 |
                           (gpai ? BQ76PL536_ADC_GPAI : 0u) | (cells - 1u));
    }
    return status;
}

uint8_t bq76pl536_channels(uint8_t adc_control)
{
    unsigned selected = adc_control & BQ76PL536_ADC_CELL_SEL;
    unsigned n = selected > 5u ? 1u : selected + 1u;
    n += (adc_control & BQ76PL536_ADC_TS1) != 0u;
    n += (adc_control & BQ76PL536_ADC_TS2) != 0u;
    n += (adc_control & BQ76PL536_ADC_GPAI) != 0u;
    return (uint8_t)n;
}

bq_status bq76pl536_function_config(bq76pl536_adct adct, uint8_t cells, bool brick, bool reg50,
                                    uint8_t *value)
{
    bq_status status = (unsigned)adct > BQ76PL536_ADCT_24US ? BQ_E_ARG : cells_legal(cells, value);
    if (status == BQ_OK) {
        *value =
            (uint8_t)((unsigned)adct << BQ76PL536_FUNC_ADCT_SHIFT | (reg50 ? BQ76PL536_FUNC_GPAI_REF : 0u) |
                      (brick ? BQ76PL536_FUNC_GPAI_SRC : 0u) | (6u - cells) << BQ76PL536_FUNC_CN_SHIFT);
    }
    return status;
}

bq_status bq76pl536_conversion_us(uint8_t channels, bq76pl536_adct adct, bool adc_on, uint16_t *nominal_us,
                                  uint16_t *worst_us)
{
    if (channels < 1u || channels > 9u || (unsigned)adct > BQ76PL536_ADCT_24US) {
        return BQ_E_ARG;
    }
    if (!adc_on && adct != BQ76PL536_ADCT_3US) {
        return BQ_E_CONFIG;
    }
    unsigned slots = channels + 1u;
    unsigned slowest_us = adct == BQ76PL536_ADCT_3US ? 6u : 3u << (unsigned)adct; /* PL-AMB-62 */
    if (nominal_us != NULL) {
        *nominal_us = (uint16_t)(slots * (3u << (unsigned)adct) + (adc_on ? 0u : 500u));
    }
    if (worst_us != NULL) {
        *worst_us = (uint16_t)((slots * slowest_us * 11u + 9u) / 10u + (adc_on ? 0u : 525u) + 2u);
    }
    return BQ_OK;
}

static bq_status devices_legal(uint8_t devices, const uint32_t *hz)
{
    if (hz == NULL) {
        return BQ_E_ARG;
    }
    return devices < BQ76PL536_ADDR_FIRST || devices > BQ76PL536_ADDR_LAST ? BQ_E_DEVICES : BQ_OK;
}

bq_status bq76pl536_spi_max_hz(uint8_t devices, uint32_t *hz)
{
    bq_status status = devices_legal(devices, hz);
    if (status == BQ_OK) {
        uint32_t khz = 400000u / (20u + 70u * devices); /* delay in ns; a single device is far beyond the limit */
        *hz = (khz > 1000u ? 1000u : khz) * 1000u;
    }
    return status;
}

bq_status bq76pl536_spi_default_hz(uint8_t devices, uint32_t *hz)
{
    bq_status status = devices_legal(devices, hz);
    if (status == BQ_OK) {
        *hz = devices <= 16u ? 250000u : devices <= 32u ? 125000u : 62500u;
    }
    return status;
}
