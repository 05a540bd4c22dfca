/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file bq769x0.h
 * Driver for one bq76920, bq76930 or bq76940 on an I2C bus: boot, identification, configuration in physical
 * units, measurement, coulomb counting, faults and their recovery, FETs, balancing, SHIP.
 *
 * Nothing blocks: each function named "begin" starts one job and returns; bq769x0_poll() advances it and
 * starts at most one transfer per call. One job runs at a time. The instance is the caller's; the driver has
 * no other state.
 */
#ifndef BQHOST_BQ769X0_H
#define BQHOST_BQ769X0_H

#include "bqhost/afe.h"
#include "bqhost/bq769x0_convert.h"
#include "bqhost/field.h"
#include "bqhost/hal.h"
#include "bqhost/thermistor.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum bq769x0_crc { BQ769X0_CRC_PROBE, BQ769X0_CRC_OFF, BQ769X0_CRC_ON } bq769x0_crc;

#define BQ769X0_DIE_NEVER 255u

/** What the user wants. Validated whole by bq769x0_init(). Limits are achieved never looser than asked, see
 * bq769x0_convert.h. */
typedef struct bq769x0_config {
    uint8_t inputs;   /**< size of the part: 5 (bq76920), 10 (bq76930), 15 (bq76940) */
    uint8_t cells;    /**< cells in series: 3..5, 6..10, 9..15 */
    uint16_t wiring;  /**< inputs that carry cells, bit n-1 = VCn; 0 = the datasheet's table */
    uint8_t address7; /**< 0x08, 0x18, or 0 = probe both */
    uint8_t crc;      /**< bq769x0_crc: probe, or what the part number says */
    uint8_t sensors;  /**< thermistors in use, 0..inputs / 5; 0 = die temperature instead */
    const bq_thermistor
        *thermistor;         /**< table; may be NULL only with sensors = 0; must outlive the instance */
    uint32_t shunt_uohm;     /**< 100..100000 */
    bool invert_current;     /**< the shunt is mounted the other way round */
    uint16_t ov_mv;          /**< overvoltage limit of a cell */
    uint16_t uv_mv;          /**< undervoltage limit */
    uint16_t ov_recover_mv;  /**< every cell below: OV may be released; mandatory, below ov_mv */
    uint16_t uv_recover_mv;  /**< every cell above: UV may be released; mandatory, above uv_mv */
    uint8_t ov_delay_s;      /**< 1, 2, 4, 8; others are rounded down */
    uint8_t uv_delay_s;      /**< 1, 4, 8, 16; others are rounded down */
    uint32_t ocd_ma, scd_ma; /**< discharge overcurrent and short-circuit limits */
    uint16_t ocd_delay_ms;   /**< 8..1280 */
    uint16_t scd_delay_us;   /**< 70..400 */
    uint16_t load_settle_ms; /**< CHG off until the first look at LOAD_PRESENT; 0 = 100 (X0-LOAD-05) */
    uint16_t frozen_scans;   /**< identical pictures in a row that count as a stopped converter; 0 = never */
    uint8_t balance_timer_s; /**< a scan ends balancing when no apply came for so long; 0 = 4 (X0-CB-13) */
    uint8_t balance_max;     /**< switches on at the same time; 0 = no limit (X0-SEQ-42) */
    bool counter_off;        /**< leave the coulomb counter off: current by bq769x0_begin_oneshot() alone */
    bool balance_across_groups; /**< allow 5+6 and 10+11 together (X0-AMB-61) */
    bool keep_fets;             /**< warm start: leave the FETs of a running part as they are */
    /* die temperature (X0-SEQ-44, X0-DIE-04, X0-DIE-05), of the hottest of the part's sensors */
    int16_t die_limit_dc; /**< above: no balancing, until it is 10 degrees lower; 1..950; 0 = 850 (85 C) */
    int16_t die_fault_dc; /**< above: BQ_F_DIE_TEMP, until it is 10 degrees lower; 1..1000; 0 = 950 */
    uint8_t die_check_s;  /**< with sensors > 0: seconds between two looks at the die while balancing is asked
                               for or the die is hot; 5..254; 0 = 60; BQ769X0_DIE_NEVER = no look at all */
    uint32_t die_v25_uv;  /**< voltage of the die sensor at 25 C, 1100000..1300000; 0 = 1200000 */
} bq769x0_config;

/** What the chip really does, known after bring-up. */
typedef struct bq769x0_achieved {
    bq769x0_trim trim;
    int32_t ov_uv, uv_uv; /**< thresholds of a cell */
    bq769x0_current_limits current;
    uint8_t protect3, ov_trip, uv_trip;
    uint8_t address7;
    bool crc;
} bq769x0_achieved;

/** Charge counted since init or bq769x0_charge_reset(). Code sums are in coulomb counter codes times
 * milliseconds. */
typedef struct bq769x0_charge {
    int64_t uas; /**< micro-ampere seconds, positive charges, missed windows filled with the mean of their
                    neighbours */
    uint32_t results; /**< windows fetched */
    uint32_t missed;  /**< windows that were lost, by the host's clock (X0-SEQ-26) */
} bq769x0_charge;

#include "bqhost/bq769x0_state.h" /* struct bq769x0: complete, so that the caller can own it; members are private */

/**
 * Checks the whole configuration, then sets up the instance. Touches no bus.
 * BQ_OK; BQ_E_ARG (null pointer); BQ_E_CELLS (count the size cannot have, or a wiring that does not hold it);
 * BQ_E_RANGE (inputs, address, shunt, sensors, recovery thresholds); BQ_E_NO_CODE (a current limit or delay
 * the chip does not offer); BQ_E_CONFIG (limits that contradict each other). Voltage limits depend on the
 * device's trim and are refused by bring-up.
 */
bq_status bq769x0_init(bq769x0 *d, const bq769x0_config *config, const bq_i2c *i2c, const bq_gpio *gpio,
                       const bq_clock *clock);

/** Begins bring-up: boot by BQ_LINE_AFE_BOOT if the part does not answer, probing of address and CRC, trim,
 * configuration, first picture (X0-SEQ-01..20). Ends with BQ_OK; BQ_E_NOT_FOUND; BQ_E_CONFIG (another part
 * than configured, X0-SEQ-10); BQ_E_NO_CODE (a voltage limit this device cannot hold); BQ_E_VERIFY;
 * BQ_E_CELLS (inputs in use or shorted do not match, X0-SEQ-12); BQ_E_STALE (no first picture); a bus error.
 * FETs are off unless keep_fets. */
bq_status bq769x0_begin_start(bq769x0 *d);
/** Begins one update: SYS_STAT, one block of all measurements, write-1-to-clear of CC_READY (three
 * transactions), and every second the scrub; then fault service and recovery when a fault bit is set. */
bq_status bq769x0_begin_scan(bq769x0 *d);
/** Begins to carry out an action: FETs and balancing outputs, verified. Of neighbours that are asked for, one
 * and the other are bled in turns of 4.1 s, and where balance_max is less than asked, the turn goes round:
 * every cell that is asked for gets its share. No cell is bled while a fault stands or the die is too hot. */
bq_status bq769x0_begin_apply(bq769x0 *d, const bq_action *action);
/** Begins a comparison of every configuration register with what it should hold. */
bq_status bq769x0_begin_self_test(bq769x0 *d);
/** Begins SHIP entry; ends with BQ_OK when the part no longer answers, BQ_E_VERIFY if it still does after
 * three tries. */
bq_status bq769x0_begin_ship(bq769x0 *d);
/** Begins one conversion of the coulomb counter (X0-SEQ-46); the result is in the next sample. A counter that
 * runs is stopped for it and runs again afterwards. Ends with BQ_OK, BQ_E_TIMEOUT after three attempts
 * without a result, or a bus error; after an error the next scrub restores the configuration. */
bq_status bq769x0_begin_oneshot(bq769x0 *d);
/** See bq_afe_ops.poll. */
bq_status bq769x0_poll(bq769x0 *d, uint32_t *wait_us);
/** See bq_afe_ops.sample. Ages include the 250 ms that a result may already be old when it is read. Chip
 * faults in modules[0].faults: OCD = BQ_F_OVERCURRENT, SCD = BQ_F_SHORT, OV, UV as named, the ALERT override
 * = BQ_F_CHAIN (what hangs on the ALERT line), die above die_fault_dc = BQ_F_DIE_TEMP, DEVICE_XREADY =
 * BQ_F_MEMORY, and after it came back three times BQ_F_DEFECTIVE, an input below 0x0518 that should carry a
 * cell = BQ_F_OPEN_WIRE. They stand until the release conditions held long enough. */
bq_status bq769x0_sample(bq769x0 *d, bq_sample *sample);

/** GAIN2 calibration (X0-SEQ-45): `stack_mv` was measured by the host at rest; every cell is scaled by it
 * from now on. BQ_OK; BQ_E_RANGE outside 0.97..1.03 of the sum of the cells (nothing changed); BQ_E_STALE
 * without a valid picture. */
bq_status bq769x0_calibrate(bq769x0 *d, uint32_t stack_mv);
/** True when a cell has moved by more than 100 mV since the last calibration (X0-ADC-17). */
bool bq769x0_calibration_due(const bq769x0 *d);

const bq769x0_achieved *bq769x0_get_achieved(const bq769x0 *d);
const bq769x0_charge *bq769x0_get_charge(const bq769x0 *d);
void bq769x0_charge_reset(bq769x0 *d);

/** True while ALERT is high: something in SYS_STAT wants a scan. A level, so a fault that comes while another
 * one is being served is not lost (X0-ALERT-07). Always true on a board without the line: poll every 250 ms
 * then, and back the line up by the same poll. Costs one pin read. */
bool bq769x0_alert_pending(const bq769x0 *d);

/** The die's temperature, hottest sensor, in tenths of a degree C, and its age. With sensors = 0 it is part
 * of every picture. With thermistors the driver switches the source over for about 5 s at a time (X0-SEQ-44):
 * the sample meanwhile repeats the last values of the thermistors, which count for 10 s at most. BQ_OK;
 * BQ_E_STALE: not seen yet, or what was read cannot be a temperature (balancing is then off too). */
bq_status bq769x0_get_die(const bq769x0 *d, int16_t *dc, uint32_t *age_ms);

/** Ends the lock after five short circuits in a row: a person or a charger has intervened (X0-SEQ-32). */
void bq769x0_unlock(bq769x0 *d);

/** The fields of bq769x0_config that a record of the settings holds (settings.h): all but the pointers. */
extern const bq_field_table bq769x0_config_fields;

/* ---- the base set -------------------------------------------------------------------------------
 * For a firmware with little flash: measuring, protecting, balancing. A program that uses only these
 * functions, bq769x0_begin_apply(), bq769x0_poll() and bq769x0_sample() links nothing of bring-up by probing,
 * fault recovery, scrub, die temperature, charge counting, SHIP. What is then left to the caller: the part
 * must be booted; after a fault it is he who decides when to clear; after a reset of the part (BQ_E_... of a
 * scan, or registers at zero: no valid picture) he configures again. FETs stay off while a fault bit stands.
 */

/** As bq769x0_init() for a part whose address, CRC option and wiring are given in `config` and true; the
 * pointers are not null and `inputs` is 5, 10 or 15. Touches no bus. BQ_OK; BQ_E_CELLS, BQ_E_RANGE (shunt,
 * sensors), BQ_E_NO_CODE, BQ_E_CONFIG as there, and the instance is then as before. Not used here: recovery
 * thresholds, settle time, frozen_scans, balance_timer_s, balance_across_groups, keep_fets, die_.... */
bq_status bq769x0_init_known(bq769x0 *d, const bq769x0_config *config, const bq_i2c *i2c,
                             const bq_clock *clock);
/** Begins configuration of a part that is awake: trim, limits in this device's codes, FETs and balancing off,
 * converters on; every register read back. Ends with BQ_OK; BQ_E_NO_CODE (a voltage limit this device cannot
 * hold); BQ_E_VERIFY; BQ_E_IMPLAUSIBLE (the trim reads differently each time); a bus error. Legal in every
 * state; BQ_E_BUSY while a job runs. */
bq_status bq769x0_begin_configure(bq769x0 *d);
/** Begins one measurement in three transactions. The faults that SYS_STAT reports are in the next sample and
 * stand until a later measurement reads them as gone. Ends with BQ_OK or a bus error (the sample is then not
 * valid, with BQ_F_COMM). BQ_E_STATE before configuration. */
bq_status bq769x0_begin_measure(bq769x0 *d);
/** Begins to clear exactly the fault bits that the last measurement read; an event that comes in between is
 * kept. BQ_OK, BQ_E_BUSY, BQ_E_STATE; ends with BQ_OK or a bus error. */
bq_status bq769x0_begin_clear(bq769x0 *d);

/** Fills the interface the super-loop uses. */
bq_afe bq769x0_afe(bq769x0 *d);

#ifdef __cplusplus
}
#endif
#endif
