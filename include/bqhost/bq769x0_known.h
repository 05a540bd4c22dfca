/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file bq769x0_known.h
 * What the base set of the bq769x0 driver is told: a part that is known and limits in its own codes, made by
 * the compiler from physical units, so that neither the arithmetic nor its tables cost flash:
 *
 *     static const bq769x0_known known = {
 *         BQ769X0_PART(15, 0x7fff), .address7 = 0x08, .crc = true,
 *         .registers = BQ769X0_REGISTERS(BQ769X0_THERMISTORS, BQ769X0_SHUNT_MV(50000, 1000), 320,
 *                                        BQ769X0_SHUNT_MV(100000, 1000), 100, 2, 4),
 *         .counter = BQ769X0_CTRL2_CC_EN, .ov_mv = 4250, .uv_mv = 2800, .shunt_uohm = 1000,
 *         .sensor = bq769x0_sensor_codes, .sensor_ctx = &table};
 *
 * The macros take integer constants. They round as bq769x0_current_codes() and bq769x0_protect3() do, never
 * looser than asked; what those refuse the compiler refuses, as a bit-field of negative width whose name says
 * what must hold, for example `ocd_mv_is_8_or_more`. All other members are taken as they stand: one that is
 * left out is 0.
 */
#ifndef BQHOST_BQ769X0_KNOWN_H
#define BQHOST_BQ769X0_KNOWN_H

#include "bqhost/bq769x0_regs.h"
#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- temperatures ------------------------------------------------------------------------------ */

/** From a code of TS1..TS3 to tenths of a degree C. False: the sensor is open, shorted or outside its table,
 * and `*dc` may be as before. */
typedef bool (*bq769x0_sensor)(const void *ctx, uint16_t code, int16_t *dc);

/** A thermistor by the codes that it gives at equally spaced temperatures: the smallest way. */
typedef struct bq769x0_code_table {
    const uint16_t *codes; /**< [count], strictly falling; BQ769X0_TS_CODE() makes one of a resistance */
    uint16_t count;        /**< 2 or more */
    int16_t first_dc;      /**< temperature of codes[0] */
    int16_t step_dc;       /**< distance of two points, > 0 */
} bq769x0_code_table;

/** Code of a resistance of 1 to 300000 ohms (X0-TS-05), rounded to the nearest; a constant expression. */
#define BQ769X0_TS_CODE(ohms) ((uint16_t)(((ohms) * 8638743ull / ((ohms) + 10000ull) + 500u) / 1000u))

/** `table` is a bq769x0_code_table: linear between two points, rounded to the nearest. One search from the
 * cold end, one division. */
bool bq769x0_sensor_codes(const void *table, uint16_t code, int16_t *dc);
/** 10 kOhm at 25 C, beta 3435 (103AT type), -40..125 C; at most 0.1 degree off the beta curve, rounding
 * included. Made by tools/thermistor.py --codes, as a table for any other sensor. */
extern const bq769x0_code_table bq769x0_codes_103at;
/** `thermistor` is a bq_thermistor (thermistor.h), which serves other monitors too: by way of the resistance.
 */
bool bq769x0_sensor_thermistor(const void *thermistor, uint16_t code, int16_t *dc);
/** Voltage of the die's sensor at 25 degrees C where nobody measured it. */
#define BQ769X0_DIE_V25_UV 1200000u
/** The die (X0-DIE-02), for BQ769X0_DIE; `v25_uv` is a uint32_t: BQ769X0_DIE_V25_UV, or as measured in
 * production. Always true. */
bool bq769x0_sensor_die(const void *v25_uv, uint16_t code, int16_t *dc);

/* ---- limits as codes --------------------------------------------------------------------------- */

/* What must hold: 0 to be added to a number, or no compilation; and the same as part of a condition. */
#define BQ769X0_MUST(name, condition) +0u * sizeof(struct { int name : (condition) ? 1 : -1; })
#define BQ769X0_ALSO(name, condition) &&(condition)

/** Voltage across the shunt in whole mV, fraction dropped. */
#define BQ769X0_SHUNT_MV(ma, uohm) ((unsigned)((unsigned long long)(ma) * (uohm) / 1000000u))

/* The steps of a table, each by its value and how much it lies above the one before: how many are not above
 * `v`, and which is the largest of them. */
#define BQ769X0_ONE(v, value, more) ((v) >= (value) ? 1u : 0u)
#define BQ769X0_SUM(v, value, more) ((v) >= (value) ? (more) : 0u)
#define BQ769X0_OCD_FINE(of, v)                                                                              \
    (of(v, 8u, 8u) + of(v, 11u, 3u) + of(v, 14u, 3u) + of(v, 17u, 3u) + of(v, 19u, 2u) + of(v, 22u, 3u) +    \
     of(v, 25u, 3u) + of(v, 28u, 3u) + of(v, 31u, 3u) + of(v, 33u, 2u) + of(v, 36u, 3u) + of(v, 39u, 3u) +   \
     of(v, 42u, 3u) + of(v, 44u, 2u) + of(v, 47u, 3u) + of(v, 50u, 3u))
#define BQ769X0_OCD_COARSE(of, v)                                                                            \
    (of(v, 17u, 17u) + of(v, 22u, 5u) + of(v, 28u, 6u) + of(v, 33u, 5u) + of(v, 39u, 6u) + of(v, 44u, 5u) +  \
     of(v, 50u, 6u) + of(v, 56u, 6u) + of(v, 61u, 5u) + of(v, 67u, 6u) + of(v, 72u, 5u) + of(v, 78u, 6u) +   \
     of(v, 83u, 5u) + of(v, 89u, 6u) + of(v, 94u, 5u) + of(v, 100u, 6u))
#define BQ769X0_SCD_FINE(of, v)                                                                              \
    (of(v, 22u, 22u) + of(v, 33u, 11u) + of(v, 44u, 11u) + of(v, 56u, 12u) + of(v, 67u, 11u) +               \
     of(v, 78u, 11u) + of(v, 89u, 11u) + of(v, 100u, 11u))
#define BQ769X0_SCD_COARSE(of, v)                                                                            \
    (of(v, 44u, 44u) + of(v, 67u, 23u) + of(v, 89u, 22u) + of(v, 111u, 22u) + of(v, 133u, 22u) +             \
     of(v, 155u, 22u) + of(v, 178u, 23u) + of(v, 200u, 22u))
#define BQ769X0_OCD_DELAYS(v)                                                                                \
    (((v) >= 8u ? 1u : 0u) + ((v) >= 20u ? 1u : 0u) + ((v) >= 40u ? 1u : 0u) + ((v) >= 80u ? 1u : 0u) +      \
     ((v) >= 160u ? 1u : 0u) + ((v) >= 320u ? 1u : 0u) + ((v) >= 640u ? 1u : 0u) + ((v) >= 1280u ? 1u : 0u))
#define BQ769X0_SCD_DELAYS(v)                                                                                \
    (((v) >= 70u ? 1u : 0u) + ((v) >= 100u ? 1u : 0u) + ((v) >= 200u ? 1u : 0u) + ((v) >= 400u ? 1u : 0u))
#define BQ769X0_OV_DELAYS(v)                                                                                 \
    (((v) >= 1u ? 1u : 0u) + ((v) >= 2u ? 1u : 0u) + ((v) >= 4u ? 1u : 0u) + ((v) >= 8u ? 1u : 0u))
#define BQ769X0_UV_DELAYS(v)                                                                                 \
    (((v) >= 1u ? 1u : 0u) + ((v) >= 4u ? 1u : 0u) + ((v) >= 8u ? 1u : 0u) + ((v) >= 16u ? 1u : 0u))

/* One range for both limits: the coarse one only where one needs it and it holds both. */
#define BQ769X0_COARSE(ocd, scd) (((ocd) > 50u || (scd) > 100u) && (ocd) >= 17u && (scd) >= 44u)
#define BQ769X0_OCD(of, ocd, scd)                                                                            \
    (BQ769X0_COARSE(ocd, scd) ? BQ769X0_OCD_COARSE(of, ocd) : BQ769X0_OCD_FINE(of, ocd))
#define BQ769X0_SCD(of, ocd, scd)                                                                            \
    (BQ769X0_COARSE(ocd, scd) ? BQ769X0_SCD_COARSE(of, scd) : BQ769X0_SCD_FINE(of, scd))

/* The part has codes for all of it: thresholds in mV across the shunt, delays in ms, us and s; and the OCD
 * threshold is below the SCD threshold as they will be. */
#define BQ769X0_LIMITS(rule, ocd_mv, ocd_ms, scd_mv, scd_us, ov_s, uv_s)                                     \
    rule(ocd_mv_is_8_or_more, (ocd_mv) >= 8u) rule(scd_mv_is_22_or_more, (scd_mv) >= 22u)                    \
        rule(ocd_ms_is_8_or_more, (ocd_ms) >= 8u) rule(scd_us_is_70_or_more, (scd_us) >= 70u)                \
            rule(ov_s_is_1_or_more, (ov_s) >= 1u) rule(uv_s_is_1_or_more, (uv_s) >= 1u)                      \
                rule(ocd_is_below_scd_in_one_range,                                                          \
                     BQ769X0_OCD(BQ769X0_SUM, ocd_mv, scd_mv) < BQ769X0_SCD(BQ769X0_SUM, ocd_mv, scd_mv))
/** Whether it is so. */
#define BQ769X0_FITS(ocd_mv, ocd_ms, scd_mv, scd_us, ov_s, uv_s)                                             \
    (true BQ769X0_LIMITS(BQ769X0_ALSO, ocd_mv, ocd_ms, scd_mv, scd_us, ov_s, uv_s))
#define BQ769X0_PROTECT1_OF(ocd_mv, scd_mv, scd_us)                                                          \
    (uint8_t)((BQ769X0_COARSE(ocd_mv, scd_mv) ? 0x80u : 0u) | (BQ769X0_SCD_DELAYS(scd_us) - 1u) << 3 |       \
              (BQ769X0_SCD(BQ769X0_ONE, ocd_mv, scd_mv) - 1u))
#define BQ769X0_PROTECT2_OF(ocd_mv, ocd_ms, scd_mv)                                                          \
    (uint8_t)((BQ769X0_OCD_DELAYS(ocd_ms) - 1u) << 4 | (BQ769X0_OCD(BQ769X0_ONE, ocd_mv, scd_mv) - 1u))
#define BQ769X0_PROTECT3_OF(ov_s, uv_s)                                                                      \
    (uint8_t)((BQ769X0_UV_DELAYS(uv_s) - 1u) << 6 | (BQ769X0_OV_DELAYS(ov_s) - 1u) << 4)

/** Initialiser of bq769x0_known.registers; `source` is the temperature's: BQ769X0_THERMISTORS or BQ769X0_DIE,
 * and bq769x0_known.sensor converts the one or the other. */
#define BQ769X0_REGISTERS(source, ocd_mv, ocd_ms, scd_mv, scd_us, ov_s, uv_s)                                \
    {0,                                                                                                      \
     0,                                                                                                      \
     0,                                                                                                      \
     0,                                                                                                      \
     (source)BQ769X0_MUST(source_is_thermistors_or_die,                                                      \
                          (source) == BQ769X0_THERMISTORS || (source) == BQ769X0_DIE),                       \
     0,                                                                                                      \
     BQ769X0_PROTECT1_OF(ocd_mv, scd_mv, scd_us),                                                            \
     BQ769X0_PROTECT2_OF(ocd_mv, ocd_ms, scd_mv),                                                            \
     BQ769X0_PROTECT3_OF(ov_s, uv_s)                                                                         \
         BQ769X0_LIMITS(BQ769X0_MUST, ocd_mv, ocd_ms, scd_mv, scd_us, ov_s, uv_s),                           \
     0,                                                                                                      \
     0,                                                                                                      \
     BQ769X0_CC_CFG_VALUE}
#define BQ769X0_THERMISTORS (BQ769X0_CTRL1_ADC_EN | BQ769X0_CTRL1_TEMP_SEL)
#define BQ769X0_DIE BQ769X0_CTRL1_ADC_EN

#define BQ769X0_BITS(w)                                                                                      \
    (((w) & 1u) + ((w) >> 1 & 1u) + ((w) >> 2 & 1u) + ((w) >> 3 & 1u) + ((w) >> 4 & 1u) + ((w) >> 5 & 1u) +  \
     ((w) >> 6 & 1u) + ((w) >> 7 & 1u) + ((w) >> 8 & 1u) + ((w) >> 9 & 1u) + ((w) >> 10 & 1u) +              \
     ((w) >> 11 & 1u) + ((w) >> 12 & 1u) + ((w) >> 13 & 1u) + ((w) >> 14 & 1u))
#define BQ769X0_FED(inputs) (0x4e73u & ((1u << (inputs)) - 1u))

/** Whether a size has these inputs: bottom, second and top input of each group carry a cell (X0-CELL-16); the
 * datasheet's table for each number of cells: X0-CELL-01 to -15, or bq769x0_wiring(). */
#define BQ769X0_WIRED(inputs, wiring)                                                                        \
    (((inputs) == 5u || (inputs) == 10u || (inputs) == 15u) && (wiring) >> (inputs) == 0u &&                 \
     ((wiring) & BQ769X0_FED(inputs)) == BQ769X0_FED(inputs))

/** Initialisers of what follows from the size of the part, 5, 10 or 15 inputs, and from those that carry
 * cells, bit n-1 = VCn, as in bq769x0_config.wiring, but never 0. */
#define BQ769X0_PART(inputs, wiring)                                                                         \
    .first = (inputs) == 15u ? 0u : 15u, .codes = (inputs) == 15u ? 20u : (inputs), .groups = (inputs) / 5u, \
    .cells = BQ769X0_BITS(wiring),                                                                           \
    .in_use = (wiring)BQ769X0_MUST(wiring_is_of_this_size, BQ769X0_WIRED(inputs, wiring))

/** A part that is known. Copied by bq769x0_init_known(). */
typedef struct bq769x0_known {
    uint8_t registers[12]; /**< 0x00..0x0b: BQ769X0_REGISTERS(); all 0, a part that neither measures nor
                              sees OV and UV, is refused by configuration. The trips depend on the device's
                              trim and are set by configuration */
    uint8_t address7;
    bool crc;
    uint8_t first, codes; /**< BQ769X0_PART(): first register of the block of cells, counted from VC1, and its
                             length; 15: the other measurements are fetched apart */
    uint8_t groups, cells;
    bool invert_current;    /**< the shunt is mounted the other way round */
    uint8_t counter;        /**< BQ769X0_CTRL2_CC_EN, or 0: coulomb counter off */
    uint16_t in_use;        /**< BQ769X0_PART() */
    uint16_t apart;         /**< 0; cells whose lower neighbour may be bled together with them */
    uint16_t ov_mv, uv_mv;  /**< limits of a cell */
    uint32_t shunt_uohm;    /**< 1..100000, as given to BQ769X0_SHUNT_MV(); it is divided by */
    bq769x0_sensor sensor;  /**< never NULL */
    const void *sensor_ctx; /**< for `sensor`; both must outlive the instance */
} bq769x0_known;

#ifdef __cplusplus
}
#endif
#endif
