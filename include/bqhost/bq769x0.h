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
#include "bqhost/bq769x0_known.h"
#include "bqhost/field.h"
#include "bqhost/hal.h"

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
    uint16_t wiring;  /**< inputs that carry cells, bit n-1 = VCn; 0 = the datasheet's table. Bottom, second
                         and  top input of each group of five carry one (X0-CELL-16) */
    uint8_t address7; /**< 0x08, 0x18, or 0 = probe both; no part at 0x18 has CRC */
    uint8_t crc;      /**< bq769x0_crc: probe, or what the part number says */
    uint8_t sensors;  /**< thermistors in use, 0..inputs / 5; 0 = die temperature instead */
    bq769x0_sensor sensor;   /**< their conversion, for example bq769x0_sensor_codes (bq769x0_known.h) ... */
    const void *sensor_ctx;  /**< ... and what it is given, for example &bq769x0_codes_103at. Must know 10
                                kOhm; may be  NULL only with sensors = 0; both must outlive the instance */
    uint32_t shunt_uohm;     /**< 100..100000 */
    bool invert_current;     /**< the shunt is mounted the other way round */
    uint16_t ov_mv;          /**< overvoltage limit of a cell */
    uint16_t uv_mv;          /**< undervoltage limit */
    uint16_t ov_recover_mv;  /**< every cell below: OV may be released; mandatory, above uv_mv, below ov_mv */
    uint16_t uv_recover_mv;  /**< every cell above: UV may be released; mandatory, above uv_mv, below ov_mv */
    uint8_t ov_delay_s;      /**< 1, 2, 4, 8; others are rounded down, 0 is refused (BQ_E_NO_CODE) */
    uint8_t uv_delay_s;      /**< 1, 4, 8, 16; likewise */
    uint32_t ocd_ma, scd_ma; /**< discharge overcurrent and short-circuit limits; what lies above the largest
                                code (100 and 200 mV across the shunt) becomes the largest */
    uint16_t ocd_delay_ms;   /**< 8..1280; longer ones become 1280, shorter ones are refused (BQ_E_NO_CODE) */
    uint16_t scd_delay_us;   /**< 70..400; likewise */
    uint16_t load_settle_ms; /**< CHG off until the first look at LOAD_PRESENT; 0 = 100 (X0-LOAD-05) */
    uint16_t frozen_scans;   /**< identical pictures in a row, one each 250 ms however often the host looks,
                                that count as a stopped converter; 0 = never */
    uint8_t balance_timer_s; /**< a scan ends balancing when no apply came for so long; 0 = 4 (X0-CB-13) */
    uint8_t balance_max;     /**< switches on at the same time; 0 = no limit (X0-SEQ-42) */
    bool counter_off;        /**< leave the coulomb counter off: current by bq769x0_begin_oneshot() alone */
    bool balance_across_groups; /**< allow 5+6 and 10+11 together (X0-AMB-61) */
    bool balance_external;      /**< cells are bled by external FETs, which the part only switches; changes
                                   nothing but bq769x0_config_warnings() */
    bool keep_fets;             /**< warm start: leave the FETs of a running part as they are */
    /* die temperature (X0-SEQ-44, X0-DIE-04, X0-DIE-05), of the hottest of the part's sensors */
    int16_t die_limit_dc; /**< above: no balancing, until it is 10 degrees lower; 1..950; 0 = 850 (85 C) */
    int16_t die_fault_dc; /**< above: BQ_F_DIE_TEMP, until it is 10 degrees lower; 1..1000; 0 = 950 */
    uint8_t die_check_s;  /**< with sensors > 0: seconds between two looks at the die while balancing is asked
                               for or the die is hot; 5..254; 0 = 60; BQ769X0_DIE_NEVER = no look at all */
    uint32_t die_v25_uv;  /**< voltage of the die sensor at 25 C, 1100000..1300000; 0 = 1200000 */
} bq769x0_config;

/** What the chip really does, known after bring-up; `current` is of bq769x0_init(). */
typedef struct bq769x0_achieved {
    bq769x0_trim trim;
    int32_t ov_uv, uv_uv; /**< thresholds of a cell */
    bq769x0_current_limits current;
    uint8_t protect3, ov_trip, uv_trip;
    uint8_t address7;
    bool crc;
} bq769x0_achieved;

/** Charge counted since init or bq769x0_charge_reset(). A window counts as 250 ms (X0-AMB-99). From the loss
 * of the part to its next configuration nothing is counted, nor is it in `missed`. */
typedef struct bq769x0_charge {
    int64_t uas; /**< micro-ampere seconds, positive charges, missed windows filled with the mean of their
                    neighbours */
    uint32_t results; /**< windows fetched */
    uint32_t missed;  /**< windows that were lost, by the host's clock (X0-SEQ-26) */
} bq769x0_charge;

#include "bqhost/bq769x0_state.h" /* struct bq769x0: complete, so that the caller can own it; members are private */

/**
 * Checks the whole configuration, then sets up the instance. Touches no bus. `i2c`, `gpio` and `clock` are
 * copied; the operations and contexts they point to must outlive the instance. `gpio` may be NULL: the part
 * is then booted by the board, and ALERT is not read. BQ_OK; after all others the instance is as before:
 * BQ_E_ARG (null pointer, also of an operation that is not optional: start and poll of the bus, read and
 * write of the lines, the clock); BQ_E_CELLS (count the size cannot have, or a wiring that does not hold it);
 * BQ_E_RANGE (inputs, address, shunt, sensors, recovery thresholds, die); BQ_E_NO_CODE (a current limit or
 * delay below what the chip offers); BQ_E_CONFIG (limits that contradict each other, a sensor whose table
 * does not know 10 kOhm). Voltage limits depend on the device's trim and are refused by bring-up.
 */
bq_status bq769x0_init(bq769x0 *d, const bq769x0_config *config, const bq_i2c *i2c, const bq_gpio *gpio,
                       const bq_clock *clock);

/** What a legal configuration should be looked at for. */
#define BQ769X0_WARN_BALANCE                                                                                 \
    0x01u /**< bq76930 and bq76940 bleed 5 mA internally: external FETs (X0-AMB-64) */
#define BQ769X0_WARN_SHUNT                                                                                   \
    0x02u /**< shunt x scd_ma above 300 mV, the absolute maximum of SRP-SRN (X0-ELEC-14) */
/** Warnings about a configuration that bq769x0_init() accepts; 0 = none. */
unsigned bq769x0_config_warnings(const bq769x0_config *config);

/* Functions that begin a job return BQ_OK, or BQ_E_BUSY (one runs already) or BQ_E_STATE (not started, in
 * SHIP), and then nothing changed. How the job ended is told by bq769x0_poll(). A bus error is BQ_E_NACK,
 * BQ_E_CRC, BQ_E_TIMEOUT, BQ_E_BUS, BQ_E_ARBITRATION or whatever else the back-end says, BQ_E_BUSY included.
 */

/** Begins bring-up: boot by BQ_LINE_AFE_BOOT if the part does not answer, probing of address and CRC, trim,
 * configuration, first picture (X0-SEQ-01..20). Legal in every state. Ends with BQ_OK; BQ_E_NOT_FOUND;
 * BQ_E_CONFIG (another part than configured, X0-SEQ-10); BQ_E_NO_CODE (a voltage limit this device cannot
 * hold); BQ_E_VERIFY; BQ_E_IMPLAUSIBLE (the trim is never the same twice, or nothing but zeros after three
 * boots); BQ_E_CELLS (inputs in use or shorted do not match, X0-SEQ-12); BQ_E_STALE (no first picture); a bus
 * error. FETs are off unless keep_fets, and after a failure even then. A fault that a running part has
 * flagged stands afterwards and is released as any other: a start releases nothing. */
bq_status bq769x0_begin_start(bq769x0 *d);
/** Begins one update: SYS_STAT, one block of all measurements, write-1-to-clear of CC_READY (three
 * transactions), and every second the scrub; then fault service and recovery when a fault bit is set.
 * Ends with BQ_OK, also when the picture was refused (its readings are then not valid, with BQ_Q_CHIP);
 * BQ_E_VERIFY (a register does not hold what was written); BQ_E_DEFECTIVE (an internal fault came back three
 * times: the part is in SHIP, only start is legal); a bus error (readings carry BQ_Q_COMM, the module
 * BQ_F_COMM). After 1 s without a good picture the scan itself turns both FETs and all balancing off, and
 * where the part answers, BQ_F_LOCKUP is set until there is one (X0-SEQ-25). */
bq_status bq769x0_begin_scan(bq769x0 *d);
/** Begins to carry out an action: FETs and balancing outputs, verified; `action` is copied, its clear_faults
 * and sleep are ignored. Before a FET comes on the configuration is read and compared (X0-SEQ-05). Of
 * neighbours that are asked for, one and the other are bled in turns of 4.1 s, and where balance_max is less
 * than asked, the turn goes round: every cell that is asked for gets its share. No cell is bled while a fault
 * stands, the die is too hot or a temperature is not known. Returns also BQ_E_ARG (NULL).
 * Ends with BQ_OK only if every FET that was asked for is commanded on. BQ_E_STATE: one had to stay off (a
 * fault stands, no valid picture, a temperature not known); the sample tells which. All else was carried out,
 * FETs that may be on are on. BQ_E_VERIFY: the registers do not hold their values, or the part took a FET
 * back (a fault the next scan will show); FETs are off or as they were. A bus error: unknown; apply again. */
bq_status bq769x0_begin_apply(bq769x0 *d, const bq_action *action);
/** Begins a comparison of every configuration register with what it should hold. Ends with BQ_OK, BQ_E_VERIFY
 * (the next scrub repairs it) or a bus error. */
bq_status bq769x0_begin_self_test(bq769x0 *d);
/** Begins SHIP entry; FETs and balancing go off first. Ends with BQ_OK when the part no longer answers: its
 * configuration is lost and only start is legal. BQ_E_VERIFY: it still answers after three tries; FETs are
 * off. A bus error: FETs could not be turned off, nothing else was done. */
bq_status bq769x0_begin_ship(bq769x0 *d);
/** Begins one conversion of the coulomb counter (X0-SEQ-46); the result is in the next sample. A counter that
 * runs is stopped for it and runs again afterwards, whatever came of it. Ends with BQ_OK, BQ_E_TIMEOUT after
 * three attempts without a result, BQ_E_VERIFY or a bus error (the next scrub then repairs SYS_CTRL2). */
bq_status bq769x0_begin_oneshot(bq769x0 *d);
/** See bq_afe_ops.poll. During a transfer `wait_us` is what is left of it at 100 kHz, and 50 us once it
 * should have ended. A transfer that has not ended 200 ms later counts as BQ_E_TIMEOUT. BQ_E_ARG: `d` is
 * NULL. */
bq_status bq769x0_poll(bq769x0 *d, uint32_t *wait_us);
/** See bq_afe_ops.sample. BQ_OK; BQ_E_ARG (`sample` NULL or a capacity too small); BQ_E_STALE before the
 * first good picture; never BQ_E_BUSY: what is copied is always of one whole picture. A picture that is
 * refused leaves all values as they were.
 * - age_ms includes the 250 ms that a result may already be old when it is read; current_age_ms does not.
 *   t_us is when the picture was read.
 * - stack_mv is the sum of the cells in use. Its quality has BQ_Q_OUTSIDE when the cells of a group of five
 * add up to less than 6 V or more than 25 V, where nothing is promised of the part (X0-ELEC-01, X0-AMB-97); a
 *   cell has it outside 2 to 5 V, a thermistor outside 0.3 to 3 V. All are still VALID.
 * - Readings not VALID: BQ_Q_COMM, the part did not answer; BQ_Q_CHIP, it did, but what it says contradicts
 *   itself, is not there yet (temperatures, 2.25 s after the source is selected) or comes with DEVICE_XREADY.
 * - Flags in modules[0].faults that stand until their release: OCD = BQ_F_OVERCURRENT, SCD = BQ_F_SHORT, OV,
 * UV as named, the ALERT override = BQ_F_CHAIN (what hangs on the ALERT line), DEVICE_XREADY = BQ_F_MEMORY,
 * and after it came back three times BQ_F_DEFECTIVE. As long as it is so: die above die_fault_dc =
 *   BQ_F_DIE_TEMP, an input below 0x0518 that should carry a cell = BQ_F_OPEN_WIRE, no good picture for 1 s =
 *   BQ_F_LOCKUP. For one scan: BQ_F_COMM; BQ_F_RESET and BQ_F_CONFIG, found by the scrub and repaired;
 *   BQ_F_LOCKUP, a converter or counter that stood and was started again; BQ_F_BALANCE, balancing ended
 * because no apply came.
 * - cell_ov, cell_uv and open_wire are 0: the part does not tell which.
 * - current_valid is false beyond +-31990 codes (270 mV), where the counter saturates. */
bq_status bq769x0_sample(bq769x0 *d, bq_sample *sample);

/** True when the current of the last sample lies beyond +-200 mV across the shunt, the range for which the
 * coulomb counter is specified (X0-CC-11). */
bool bq769x0_current_outside(const bq769x0 *d);

/** GAIN2 calibration (X0-SEQ-45): `stack_mv` was measured by the host at rest; every cell is scaled by it
 * from now on, also after another start; only init forgets it. BQ_OK; BQ_E_RANGE outside 0.97..1.03 of the
 * sum of the cells or above 110 V (nothing changed); BQ_E_STALE without a valid picture. */
bq_status bq769x0_calibrate(bq769x0 *d, uint32_t stack_mv);
/** True when a cell has moved by more than 100 mV since the last calibration (X0-ADC-17). */
bool bq769x0_calibration_due(const bq769x0 *d);

const bq769x0_achieved *bq769x0_get_achieved(bq769x0 *d);
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

/** Ends the lock after five short circuits in a row: a person or a charger has intervened (X0-SEQ-32). An
 * action with `unlock` does the same. Another start does not end it: FETs stay off after it. */
void bq769x0_unlock(bq769x0 *d);

/** The fields of bq769x0_config that a record of the settings holds (settings.h): all but the pointers. */
extern const bq_field_table bq769x0_config_fields;

/* ---- the base set -------------------------------------------------------------------------------
 * For a firmware with little flash: measuring, protecting, balancing. A program that uses only these
 * functions and bq769x0_poll() links nothing of bring-up by probing, fault recovery, scrub, die temperature
 * beside thermistors, charge counting, SHIP, samples for the pack controller, if it is compiled with
 * -ffunction-sections and linked with --gc-sections. Configure; then measure every 250 ms, look, command the
 * outputs: see tools/bench/image_afe.c. What is then left to the caller:
 * - The part must be booted, and its first measurements not be looked at before 250, 400 or 800 ms after that
 *   (5, 10, 15 inputs; X0-ADC-14). No FET comes on until temperatures are known, 2.25 s after configuration.
 * - That part and size are the configured ones, and that no cell is an open wire: a cell that is not VALID in
 *   a valid picture keeps no FET off. Nor does a converter that stands (the same codes for ever).
 * - After a fault it is he who decides when to clear. FETs stay off while a fault bit stands.
 * - After a reset of the part (bus errors, no valid picture, BQ_E_VERIFY of outputs that ask for FETs) he
 *   configures again.
 */

/** Sets up the instance for a part that is known (bq769x0_known.h). `known`, `i2c` and `clock` are copied;
 * what they point to must outlive the instance. Touches no bus. Nothing is checked here: what the macros of
 * bq769x0_known.h made was checked by the compiler, and all else must be there. No pointer is null. What is
 * not in this set needs bq769x0_init(). */
void bq769x0_init_known(bq769x0 *d, const bq769x0_known *known, const bq_i2c *i2c, const bq_clock *clock);
/** Describes a part by a configuration in physical units, for limits that the compiler does not know.
 * `inputs` is 5, 10 or 15; address, CRC option and wiring are given and true; with sensors = 0 `config` must
 * outlive the instance. BQ_OK; BQ_E_CELLS, BQ_E_RANGE (shunt, sensors), BQ_E_NO_CODE,
 * BQ_E_CONFIG as bq769x0_init(), and `*known` is then as before. Not used: recovery thresholds, settle time,
 * frozen_scans, balance_timer_s, balance_max, balance_across_groups, keep_fets, the other die_.... */
bq_status bq769x0_known_of(const bq769x0_config *config, bq769x0_known *known);
/** Begins configuration of a part that is awake: trim, limits in this device's codes, FETs and balancing off,
 * converters on; every register read back. Ends with BQ_OK; BQ_E_NO_CODE (a voltage limit this device cannot
 * hold); BQ_E_VERIFY; BQ_E_IMPLAUSIBLE (the trim reads differently each time); a bus error. Legal in every
 * state; BQ_E_BUSY while a job runs. BQ_E_CONFIG: `known` lacks its registers (without converter nothing
 * protects), the shunt or the sensor; nothing was begun, and nothing else is legal. */
bq_status bq769x0_begin_configure(bq769x0 *d);
/** Begins one measurement: three transactions, four on parts of less than 15 inputs. The faults that SYS_STAT
 * reports stand until a later measurement reads them as gone. Ends with BQ_OK, also when the picture was
 * refused (readings carry BQ_Q_CHIP), or a bus error (BQ_Q_COMM). BQ_E_STATE before configuration. */
bq_status bq769x0_begin_measure(bq769x0 *d);
/** Begins to clear exactly the fault bits that the last measurement read; an event that comes in between is
 * kept. BQ_OK, BQ_E_BUSY, BQ_E_STATE; ends with BQ_OK or a bus error. */
bq_status bq769x0_begin_clear(bq769x0 *d);
/** Begins to switch FETs (BQ769X0_CTRL2_CHG_ON, BQ769X0_CTRL2_DSG_ON) and balancing outputs (`cells`, bit n-1
 * = cell n, none above the last), verified; ends as bq769x0_begin_apply(). Of neighbours that are asked for,
 * one and the other are bled in turns of 4.1 s. Nothing is bled and no FET comes on without a valid picture
 * and a known temperature, nor while a fault stands, but the FET that leads out of OV or UV. BQ_OK,
 * BQ_E_BUSY, BQ_E_STATE. */
bq_status bq769x0_begin_outputs(bq769x0 *d, unsigned fets, unsigned cells);

/** Cell `cell`, counted from 0 at the lowest potential and not above the last: mV, quality, module 0. Not
 * VALID, and `mv` is the last good value: BQ_Q_COMM, BQ_Q_CHIP, or no bit at all before the first picture.
 * Not VALID: BQ_Q_RANGE, the end of the converter; BQ_Q_OPEN_WIRE, below 0x0518, where the part itself
 * ignores an input. VALID with BQ_Q_OUTSIDE: not within 2 to 5 V. */
void bq769x0_read_cell(const bq769x0 *d, unsigned cell, bq_cell_reading *c);
/** Sensor `sensor`, from 0 on, one for each group of five inputs, by the function in bq769x0_known. Not
 * VALID: BQ_Q_COMM, BQ_Q_CHIP (also for the first 2.25 s after configuration), BQ_Q_SENSOR when that function
 * says so. VALID with BQ_Q_OUTSIDE: not within 0.3 to 3 V. */
void bq769x0_read_temp(const bq769x0 *d, unsigned sensor, bq_temp_reading *t);

/** What is read beside cells and temperatures. */
typedef struct bq769x0_reading {
    uint32_t age_ms;         /**< of the picture, at most */
    uint32_t current_age_ms; /**< UINT32_MAX: never measured */
    int32_t current_ma;      /**< positive charges */
    bool current_valid; /**< younger than 600 ms, and within +-31990 codes, where the counter saturates */
    uint8_t events;     /**< fault bits of SYS_STAT (BQ769X0_STAT_...) that stand */
    uint16_t balancing; /**< bit n-1: cell n was bled until this picture */
} bq769x0_reading;
/** Reads the clock, not the bus. */
void bq769x0_read(bq769x0 *d, bq769x0_reading *reading);

/** Fills the interface the super-loop uses. Its sleep is SHIP: the part forgets its configuration, and a host
 * that lives on REGOUT loses its supply. Its wake is the same as start. */
bq_afe bq769x0_afe(bq769x0 *d);

#ifdef __cplusplus
}
#endif
#endif
