/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file sample.h
 * The two structures that cross the line between a monitor driver and the pack controller: bq_sample (what is
 * known) and bq_action (what is wanted). The pack sees nothing else of the world and asks for nothing else.
 */
#ifndef BQHOST_SAMPLE_H
#define BQHOST_SAMPLE_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Quality of one reading. A reading may be used only while BQ_Q_VALID is set; the other bits say why not, or
 * what to doubt. */
#define BQ_Q_VALID 0x01u     /**< measured, checked, fresh as `age_ms` of its module says */
#define BQ_Q_RANGE 0x02u     /**< the converter was at the end of its range: at or beyond the value given */
#define BQ_Q_OPEN_WIRE 0x04u /**< next to a sense wire that is open; never together with VALID */
#define BQ_Q_COMM 0x08u      /**< the module did not answer in the last update */
#define BQ_Q_CHIP 0x10u      /**< the module says or shows that its own measurement cannot be trusted */
#define BQ_Q_SENSOR 0x20u    /**< thermistor open or shorted */
#define BQ_Q_OUTSIDE 0x40u   /**< a warning: outside the range in which the monitor's accuracy is specified */

/** What a monitor says about itself or about its cells; bits of bq_module_reading.faults. */
#define BQ_F_CELL_OV 0x0001u   /**< hardware cell overvoltage */
#define BQ_F_CELL_UV 0x0002u   /**< hardware cell undervoltage */
#define BQ_F_OVERTEMP 0x0004u  /**< hardware sensor overtemperature */
#define BQ_F_DIE_TEMP 0x0008u  /**< thermal shutdown of the monitor */
#define BQ_F_SUPPLY 0x0010u    /**< undervoltage lockout of the monitor */
#define BQ_F_RESET 0x0020u     /**< reset that nobody asked for; cleared once configured again */
#define BQ_F_MEMORY 0x0040u    /**< parity, ECC or internal consistency (bq769x0: DEVICE_XREADY) */
#define BQ_F_DEFECTIVE 0x0080u /**< a reset did not cure it */
#define BQ_F_COMM 0x0100u      /**< does not answer */
#define BQ_F_OPEN_WIRE 0x0200u /**< an open sense wire was found */
#define BQ_F_LOCKUP 0x0400u    /**< a conversion did not end, or the converter stands still */
#define BQ_F_CONFIG 0x0800u    /**< the scrub found a register that differs from the configuration */
#define BQ_F_BALANCE 0x1000u   /**< balancing outputs did not do what was asked */
#define BQ_F_CHAIN 0x2000u /**< FAULT/ALERT chain broken or stuck (bq769x0: ALERT is driven from outside) */
#define BQ_F_OVERCURRENT 0x4000u /**< overcurrent in discharge (bq769x0 OCD) */
#define BQ_F_SHORT 0x8000u       /**< short circuit in discharge (bq769x0 SCD) */

typedef struct bq_cell_reading {
    uint16_t mv;     /**< 0..6250 (bq76PL536), 0..6815 (bq769x0); the last good value when not VALID */
    uint8_t quality; /**< BQ_Q_... */
    uint8_t module;  /**< 0-based index into bq_sample.modules */
} bq_cell_reading;

typedef struct bq_temp_reading {
    int16_t dc;      /**< tenths of a degree Celsius; the last good value when not VALID */
    uint8_t quality; /**< BQ_Q_... */
    uint8_t module;  /**< 0-based index into bq_sample.modules */
} bq_temp_reading;

/** One monitor chip (bq76PL536: one device of the stack; bq769x0: the AFE). */
typedef struct bq_module_reading {
    uint32_t stack_mv; /**< voltage of the module by its own channel, or the sum of its cells where it has
                          none; 0 when not measured */
    uint32_t age_ms;  /**< since the conversion start its readings come from, at most: a chip that converts by
                         itself may  be younger; saturates at UINT32_MAX (never measured) */
    uint16_t faults;  /**< BQ_F_... present now or latched and not yet cleared */
    uint16_t cell_ov; /**< bit n-1 = cell n of this module, hardware overvoltage; 0 where the chip does not
                         tell which */
    uint16_t cell_uv; /**< bit n-1 = cell n, hardware undervoltage; likewise */
    uint16_t open_wire; /**< bit n = sense wire n (0 = bottom of the module) is open; 0 where only
                           BQ_F_OPEN_WIRE is known */
    uint16_t balancing; /**< bit n-1 = the output of cell n was on until this measurement */
    uint8_t sensor_ot;  /**< bit n-1 = sensor n, hardware overtemperature */
    uint8_t quality;    /**< BQ_Q_... of stack_mv */
} bq_module_reading;

/**
 * One picture of the pack. The arrays belong to the caller and are set up once with their capacity; a driver
 * fills them whole or not at all: after a failed update all values are the old ones with a higher age.
 */
typedef struct bq_sample {
    bq_cell_reading *cells;     /**< [cell_capacity], cell 1 of the pack first (lowest potential) */
    bq_temp_reading *temps;     /**< [temp_capacity] */
    bq_module_reading *modules; /**< [module_capacity], base first */
    uint16_t cell_capacity, temp_capacity, module_capacity;
    uint16_t cell_count, temp_count, module_count; /**< what the driver filled */
    uint32_t sequence;                             /**< counts completed updates; unchanged = nothing new */
    uint32_t t_us; /**< clock reading at the start of the conversion of this picture; of a chip that converts
                      by itself, when it was read */
    int32_t current_ma;      /**< pack current, positive charges */
    uint32_t current_age_ms; /**< saturates at UINT32_MAX (never measured) */
    bool current_valid;
} bq_sample;

/** Number of 32-bit words of a balancing mask for the largest pack (62 devices of 6 cells = 372 cells). */
#define BQ_MASK_WORDS 12u

/** What the pack controller wants done until its next step. */
typedef struct bq_action {
    bool charge_on;    /**< charging path may conduct */
    bool discharge_on; /**< discharging path may conduct */
    bool clear_faults; /**< chip faults seen in the sample have been acted on and may be cleared */
    bool sleep;        /**< put the monitors to sleep (bq_afe_ops.sleep; apply does not look at it) */
    bool unlock;       /**< a person has intervened, the request is off: what waits for that may go on */
    uint32_t balance[BQ_MASK_WORDS]; /**< bit (n-1) % 32 of word (n-1) / 32 = bleed cell n */
} bq_action;

static inline bool bq_mask_get(const uint32_t *mask, uint16_t cell)
{
    return ((mask[(unsigned)(cell - 1u) / 32u] >> ((unsigned)(cell - 1u) % 32u)) & 1u) != 0u;
}

static inline void bq_mask_set(uint32_t *mask, uint16_t cell)
{
    mask[(unsigned)(cell - 1u) / 32u] |= (uint32_t)1u << ((unsigned)(cell - 1u) % 32u);
}

#ifdef __cplusplus
}
#endif
#endif
