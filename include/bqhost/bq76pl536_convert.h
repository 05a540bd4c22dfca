/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file bq76pl536_convert.h
 * Codes of the bq76PL536 to physical units and back, in exact integer arithmetic.
 *
 * Common to all functions: pure, nothing blocks. Results are the exact rational value rounded to the nearest
 * unit, halves upward, unless stated otherwise. They return BQ_OK, or an error with `*out` unchanged:
 * BQ_E_ARG (null pointer, no such sensor), BQ_E_RANGE (a code or value outside what the register can hold),
 * BQ_E_NO_CODE (inside the range, but between two codes). Nothing is ever clamped.
 */
#ifndef BQHOST_BQ76PL536_CONVERT_H
#define BQHOST_BQ76PL536_CONVERT_H

#include "bqhost/bq76pl536_regs.h"
#include "bqhost/status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Highest result of the 14-bit converter. */
#define BQ76PL536_CODE_MAX 0x3fffu

/* Sensor network of PL-TS-08, ohms: ratio = R_B / (R_B + R_T + R_TH). */
#define BQ76PL536_R_B_OHMS 1820u
#define BQ76PL536_R_T_OHMS 1470u

/* ---- measurements --------------------------------------------------------------------------- */

/** True for the codes at the ends of the converter, which say "at or beyond" (PL-SEQ-06-07). */
static inline bool bq76pl536_code_clipped(uint16_t code)
{
    return code == 0u || code >= BQ76PL536_CODE_MAX;
}

/** Cell voltage in mV = code x 6250 / 16383 (PL-VCELL-01, -05). BQ_E_RANGE above 0x3fff (PL-VCELL-06). `mv`
 * must not be NULL.
 *  Inline and free of division: this is the scan path. */
static inline bq_status bq76pl536_cell_mv(uint16_t code, uint16_t *mv)
{
    if (code > BQ76PL536_CODE_MAX) {
        return BQ_E_RANGE;
    }
    /* x / (2^14 - 1) = (x + x / 2^14 + 1) / 2^14, exact for every x that occurs here. */
    uint32_t x = (uint32_t)code * 6250u + 8191u;
    *mv = (uint16_t)((x + (x >> 14) + 1u) >> 14);
    return BQ_OK;
}

/** Brick voltage in mV = code x 33333 / 16384 (PL-VBAT-01, PL-AMB-58). BQ_E_RANGE above 0x3fff. `mv` must
 * not be NULL. */
static inline bq_status bq76pl536_brick_mv(uint16_t code, uint16_t *mv)
{
    if (code > BQ76PL536_CODE_MAX) {
        return BQ_E_RANGE;
    }
    *mv = (uint16_t)(((uint32_t)code * 33333u + 8192u) >> 14);
    return BQ_OK;
}

/** Cell voltage in uV (PL-VCELL-01). */
bq_status bq76pl536_cell_uv(uint16_t code, uint32_t *uv);
/** Nearest cell code of 0..6250000 uV. */
bq_status bq76pl536_cell_code(uint32_t uv, uint16_t *code);

/** Nearest brick code of 0..33331 mV; BQ_E_RANGE where the nearest code would exceed 0x3fff. */
bq_status bq76pl536_brick_code(uint32_t mv, uint16_t *code);

/** GPAI voltage in uV = code x 2500000 / 16383, internal reference (PL-GPAI-01). */
bq_status bq76pl536_gpai_uv(uint16_t code, uint32_t *uv);
/** Nearest GPAI code of 0..2500000 uV. */
bq_status bq76pl536_gpai_code(uint32_t uv, uint16_t *code);
/** GPAI as parts per million of REG50 = code / 32766, REG50 as reference; uncalibrated (PL-GPAI-03,
 * PL-AMB-57). */
bq_status bq76pl536_gpai_ratio_ppm(uint16_t code, uint32_t *ppm);

/** Temperature input `sensor` (1 or 2) in parts per million of REG50: (code + 2) / 33046, (code + 9) / 33068
 * (PL-TS-01, -02). */
bq_status bq76pl536_ts_ratio_ppm(uint8_t sensor, uint16_t code, uint32_t *ppm);
/** Nearest code of a ratio in parts per million; BQ_E_RANGE where it would lie outside 0..0x3fff. */
bq_status bq76pl536_ts_code(uint8_t sensor, uint32_t ppm, uint16_t *code);

/** Thermistor resistance of a code of `sensor` (1 or 2): 1820 / ratio - 3290 ohms (PL-TS-09). One 32-bit
 * division.
 *  BQ_E_RANGE for 0 (open), 0x3fff (shorted) and impossible codes. */
bq_status bq76pl536_ts_ohms(uint8_t sensor, uint16_t code, uint32_t *ohms);
/** Nearest code of a resistance in that network; BQ_E_RANGE where it would be clipped (0 or 0x3fff and
 * beyond). */
bq_status bq76pl536_ts_code_of_ohms(uint8_t sensor, uint32_t ohms, uint16_t *code);

/* ---- protection settings -------------------------------------------------------------------- */

/** CONFIG_COV: 2000..5000 mV in steps of 50 (PL-COV-01). The code has DISABLE clear. */
bq_status bq76pl536_cov_code(uint32_t mv, uint8_t *code);
/** Threshold of a CONFIG_COV value; DISABLE is ignored. BQ_E_RANGE for bit 6 or a code above 0x3c. */
bq_status bq76pl536_cov_mv(uint8_t code, uint16_t *mv);

/** CONFIG_CUV: 700..3300 mV in steps of 100 (PL-CUV-01). The code has DISABLE clear. */
bq_status bq76pl536_cuv_code(uint32_t mv, uint8_t *code);
/** Threshold of a CONFIG_CUV value; DISABLE is ignored. BQ_E_RANGE for bits 6..5 or a code above 0x1a. */
bq_status bq76pl536_cuv_mv(uint8_t code, uint16_t *mv);

/** Smallest legal distance of the two thresholds, mV (PL-COV-12). */
#define BQ76PL536_COV_CUV_MIN_MV 300u

/** True if the pair keeps COV - CUV at 300 mV or more (PL-COV-12, PL-NUM-16). */
static inline bool bq76pl536_cov_cuv_legal(uint16_t cov_mv, uint16_t cuv_mv)
{
    return cov_mv >= (uint32_t)cuv_mv + BQ76PL536_COV_CUV_MIN_MV;
}

/** CONFIG_COVT, CONFIG_CUVT: 0 (no delay, not latched), 100..3100 us in steps of 100, 100000..3100000 us in
 * steps of 100000 (PL-FLT-02). Between 3100 and 100000 us: BQ_E_NO_CODE. */
bq_status bq76pl536_delay_code(uint32_t us, uint8_t *code);
/** Delay of a CONFIG_COVT/CUVT value in us; BQ_E_RANGE for bits 6..5. 0x00 and 0x80 are 0. */
bq_status bq76pl536_delay_us(uint8_t code, uint32_t *us);

/** One nibble of CONFIG_OT: 40..90 degrees C in steps of 5 are 1..11, 0 is off (PL-OT-01, PL-NUM-17..28). */
bq_status bq76pl536_ot_code(uint8_t celsius, uint8_t *code);
/** Nominal trip temperature of a nibble, 0 for off; BQ_E_RANGE above 11. */
bq_status bq76pl536_ot_celsius(uint8_t code, uint8_t *celsius);

/** CONFIG_OTT: 0 (no delay, not latched), 10..2550 ms in steps of 10 (PL-FLT-03). */
bq_status bq76pl536_ott_code(uint32_t ms, uint8_t *code);
/** Delay of a CONFIG_OTT value in ms. */
bq_status bq76pl536_ott_ms(uint8_t code, uint16_t *ms);

/* ---- operation ------------------------------------------------------------------------------ */

/** CB_TIME: 0 (off), 1..63 s, or whole minutes up to 63 (PL-CB-02). Up to 63 s the code in seconds is
 * chosen. */
bq_status bq76pl536_cb_time_code(uint32_t seconds, uint8_t *code);
/** Period of a CB_TIME value in seconds; BQ_E_RANGE for bit 6. 0x00 and 0x80 are 0. */
bq_status bq76pl536_cb_time_s(uint8_t code, uint16_t *seconds);

/** ADC_CONTROL for `cells` 3..6 (lower ones never alone: a part has 3 cells), `sensors` as bits (1 = TS1, 2
 * = TS2), GPAI or brick channel, ADC_ON (PL-REG-25, PL-ADC-08). BQ_E_CELLS, BQ_E_ARG. */
bq_status bq76pl536_adc_control(uint8_t cells, uint8_t sensors, bool gpai, bool adc_on, uint8_t *value);
/** Number of channels, 1..9, that an ADC_CONTROL value converts (PL-ADC-04). */
uint8_t bq76pl536_channels(uint8_t adc_control);

/** Time per channel: ADCT field of FUNCTION_CONFIG. */
typedef enum bq76pl536_adct {
    BQ76PL536_ADCT_3US,
    BQ76PL536_ADCT_6US, /**< the one all specifications hold for */
    BQ76PL536_ADCT_12US,
    BQ76PL536_ADCT_24US
} bq76pl536_adct;

/** FUNCTION_CONFIG for `cells` 3..6, brick voltage or GPAI pins, REG50 or band-gap (PL-REG-37). BQ_E_CELLS,
 * BQ_E_ARG. */
bq_status bq76pl536_function_config(bq76pl536_adct adct, uint8_t cells, bool brick, bool reg50,
                                    uint8_t *value);

/** Nominal and worst duration of a conversion of `channels` 1..9 (PL-CONV-10, -12, PL-SEQ-06-03). The worst case
 *  holds the +10 % of the converter, 6 us per channel also at the 3 us setting (PL-AMB-62), the wake-up in automatic
 *  mode and 2 us of stack skew, rounded up. Either pointer may be NULL.
 *  BQ_E_ARG: no such number of channels or setting; BQ_E_CONFIG: automatic mode with another time than 3 us, which
 *  locks the part up (PL-ADC-12). */
bq_status bq76pl536_conversion_us(uint8_t channels, bq76pl536_adct adct, bool adc_on, uint16_t *nominal_us,
                                  uint16_t *worst_us);

/** Highest SPI clock for a stack of 1..62 devices at 40 % duty, slower delay model, at most 1 MHz, rounded
 * down to whole kHz (PL-NUM-38). BQ_E_DEVICES. */
bq_status bq76pl536_spi_max_hz(uint8_t devices, uint32_t *hz);
/** Default SPI clock: 250 kHz up to 16 devices, 125 kHz up to 32, 62.5 kHz up to 62 (PL-TIM-10).
 * BQ_E_DEVICES. */
bq_status bq76pl536_spi_default_hz(uint8_t devices, uint32_t *hz);
/** Lowest legal SPI clock (PL-TIM-01). */
#define BQ76PL536_SPI_MIN_HZ 10000u

#ifdef __cplusplus
}
#endif
#endif
