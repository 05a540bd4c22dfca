/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file bq769x0_convert.h
 * Codes of the bq769x0 to physical units and back, in integers. Pure functions, no state, nothing blocks.
 *
 * Rounding of protection settings: never looser than asked. An overvoltage or current limit is the highest
 * one the chip offers that does not exceed the request, an undervoltage limit the lowest one not below it, a
 * delay the longest one not above it. What the chip will really do is reported beside the code. A request the
 * chip cannot meet is refused.
 */
#ifndef BQHOST_BQ769X0_CONVERT_H
#define BQHOST_BQ769X0_CONVERT_H

#include "bqhost/status.h"
#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The factory trim of one device (X0-ADC-03, X0-ADC-05). */
typedef struct bq769x0_trim {
    uint16_t gain_uv; /**< 365..396 uV per code */
    int8_t offset_mv; /**< two's complement */
} bq769x0_trim;

/** Gain from ADCGAIN1 (0x50) and ADCGAIN2 (0x59); reserved bits are ignored (X0-ADC-04). */
#define BQ769X0_GAIN_UV(reg50, reg59) (365u + (((reg50) & 0x0cu) << 1) + ((unsigned)(reg59) >> 5))

/** Trim from ADCGAIN1 (0x50), ADCOFFSET (0x51) and ADCGAIN2 (0x59); reserved bits are ignored (X0-ADC-04). */
bq769x0_trim bq769x0_trim_from(uint8_t reg50, uint8_t reg51, uint8_t reg59);

/** Cell voltage in uV of a 14-bit code (X0-ADC-02); negative values are possible near 0 with a negative
 * offset. */
int32_t bq769x0_cell_uv(bq769x0_trim trim, uint16_t code);

/** The threshold code behind OV_TRIP or UV_TRIP (X0-OV-01, X0-UV-01). */
uint16_t bq769x0_ov_code(uint8_t trip);
uint16_t bq769x0_uv_code(uint8_t trip);

/** The datasheet's own procedure (X0-OV-12, X0-UV-12), which may end looser than asked: OV by up to 3.2 mV,
 * UV by up to 6.4 mV. BQ_OK or
 * BQ_E_NO_CODE. */
bq_status bq769x0_ov_trip_datasheet(bq769x0_trim trim, uint16_t mv, uint8_t *trip);
bq_status bq769x0_uv_trip_datasheet(bq769x0_trim trim, uint16_t mv, uint8_t *trip);

/** OV_TRIP or UV_TRIP for this device, never looser than `mv`; `*achieved_uv` is the real threshold.
 *  BQ_OK; BQ_E_NO_CODE when the chip cannot meet it (nothing written). */
bq_status bq769x0_ov_trip(bq769x0_trim trim, uint16_t mv, uint8_t *trip, int32_t *achieved_uv);
bq_status bq769x0_uv_trip(bq769x0_trim trim, uint16_t mv, uint8_t *trip, int32_t *achieved_uv);

/** The same with one function: the trip code of an OV limit, or of a UV limit (`under`) that lies `above_mv`
 * above the offset; above 255: no code. */
unsigned bq769x0_trip(uint32_t gain_uv, int32_t above_mv, bool under);

/** Delays of the protections: in the unit of the name. */
typedef enum bq769x0_delay {
    BQ769X0_DELAY_OCD_MS, /**< 8, 20, 40 .. 1280 (X0-OCD-04) */
    BQ769X0_DELAY_SCD_US, /**< 70, 100, 200, 400 (X0-SCD-02) */
    BQ769X0_DELAY_OV_S,   /**< 1, 2, 4, 8 (X0-OV-04) */
    BQ769X0_DELAY_UV_S    /**< 1, 4, 8, 16 (X0-UV-04) */
} bq769x0_delay;

/** Code of the longest delay not above `limit`, and that delay; -1: none, nothing written. */
int bq769x0_delay_code(bq769x0_delay kind, unsigned limit, uint16_t *achieved);

/** Voltage in uV of a current across the shunt, fraction dropped; UINT32_MAX above 4 kA. `shunt_uohm` is at
 * most 100000. */
uint32_t bq769x0_shunt_uv(uint32_t ma, uint32_t shunt_uohm);

/** Current limits in the chip's terms. */
typedef struct bq769x0_current_limits {
    uint8_t protect1, protect2; /**< register values; one RSNS bit serves both tables */
    uint8_t ocd_mv, scd_mv;     /**< achieved thresholds across the shunt */
    uint16_t ocd_delay_ms, scd_delay_us;
} bq769x0_current_limits;

/**
 * PROTECT1 and PROTECT2 from limits in uV across the shunt (whole mV count). The range (RSNS) is decided
 * once for both: the coarse one only when a limit exceeds the fine one and both have a code in it (X0-OCD-11,
 * X0-AMB-47). BQ_OK; BQ_E_NO_CODE: a limit or delay below the smallest the chip offers; BQ_E_CONFIG: the
 * achieved OCD threshold is not below the SCD threshold, also because the two need different ranges (OCD 60
 * mV with SCD 40 mV: in the fine range OCD is 50 mV). Nothing is written after an error.
 */
bq_status bq769x0_current_codes(uint32_t ocd_uv, uint16_t ocd_delay_ms, uint32_t scd_uv,
                                uint16_t scd_delay_us, bq769x0_current_limits *out);

/** PROTECT3 from delays in s, never longer than asked: OV 1, 2, 4, 8; UV 1, 4, 8, 16 (X0-OV-04, X0-UV-04).
 * BQ_E_NO_CODE for 0. */
bq_status bq769x0_protect3(uint8_t ov_s, uint8_t uv_s, uint8_t *reg);

/** Current in mA of a coulomb counter code: code x 8.44 uV / shunt, rounded to the nearest (X0-CC-13).
 * `shunt_uohm` is not 0. */
int32_t bq769x0_current_ma(int32_t code, uint32_t shunt_uohm);

/** Thermistor resistance in ohms of a code (X0-TS-05). BQ_OK; BQ_E_RANGE for an open input (code 8639 and
 * above). */
bq_status bq769x0_ts_ohms(uint16_t code, uint32_t *ohms);

/** Die temperature in tenths of a degree C (X0-DIE-02). `v25_uv` = 1200000, or a value measured in production
 * (X0-DIE-04). */
int16_t bq769x0_die_dc(uint16_t code, uint32_t v25_uv);

/** Stack voltage in mV of a BAT code; `inputs` = number of inputs that add their offset (X0-BAT-02,
 * X0-AMB-09). */
uint32_t bq769x0_bat_mv(bq769x0_trim trim, uint16_t code, uint8_t inputs);

/** Inputs that carry cells, bit n-1 = VCn, by the datasheet's connection tables (X0-CELL-01..15); 0 for a
 * count the size cannot have. `inputs` is 5, 10 or 15. */
uint16_t bq769x0_wiring(uint8_t inputs, uint8_t cells);

/** True if no two cells of `mask` (inputs, bit n-1 = VCn) are neighbours: next to each other among the inputs
 * in use. Group borders (5+6, 10+11) count as neighbours when `across_groups` (X0-CB-04, X0-CB-06,
 * X0-AMB-61). */
bool bq769x0_balance_legal(uint16_t in_use, uint16_t mask, bool across_groups);

#ifdef __cplusplus
}
#endif
#endif
