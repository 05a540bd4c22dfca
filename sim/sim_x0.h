/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file sim_x0.h
 * A register-accurate bq769x0 analog front end (bq76920, bq76930, bq76940 in their 15 part variants). Two
 * doors: the bus (I2C bytes or line levels, the ALERT, CHG and DSG pins) and the world (volts, ohms, degrees,
 * supply). All state lives in one caller-owned sim_x0; nothing is global. Simulated time moves only with
 * sim_x0_advance(); transfers take none. Functions that can refuse return 0 when done and -1 when refused; a
 * refused call changes nothing.
 */
#ifndef SIM_X0_H
#define SIM_X0_H

#include "sim_misuse.h"
#include <stdbool.h>
#include <stdint.h>

#define SIM_X0_CELLS 15
#define SIM_X0_SENSORS 3
#define SIM_X0_REGS 0x60

typedef enum sim_x0_mode {
    SIM_X0_OFF, /**< supply below the shutdown voltage */
    SIM_X0_SHIP,
    SIM_X0_BOOT, /**< boot signal seen, NORMAL not yet reached */
    SIM_X0_NORMAL
} sim_x0_mode;

/** One of the 15 orderable parts (X0-VAR-01..15). */
typedef struct sim_x0_part {
    char name[12];
    uint8_t cells;    /**< inputs: 5, 10 or 15 */
    uint8_t address7; /**< 0x08 or 0x18 */
    bool crc;
    uint16_t ldo_mv; /**< 2500 or 3300 */
} sim_x0_part;

/** Non-ideal behaviour and other readings of ambiguous facts. All zero = the ideal, documented part. */
typedef struct sim_x0_options {
    uint32_t seed;       /**< of everything random below */
    double noise_uv_rms; /**< of the cell channels in 50 ms windows; doubled in 12.5 ms windows (X0-SCH-03) */
    double cc_noise_uv_rms;   /**< of the coulomb counter */
    bool amb10_bat_rounds;    /**< X0-AMB-10: BAT is rounded to the nearest code, not down */
    bool amb16_like_boot;     /**< X0-AMB-16: after ADC_EN 0 -> 1 the registers read 0 until a first scan as
                                 long as after boot */
    bool amb25_ready_ignored; /**< X0-AMB-25: a one-shot starts although CC_READY is set */
    bool amb26_finishes;      /**< X0-AMB-26: CC_EN 0 lets the running window finish, with CC_READY */
    bool amb42_full_delay;    /**< X0-AMB-42: a cleared OV or UV comes back after the whole delay, not at the
                                 next scan */
    bool amb43_at_once;       /**< X0-AMB-43: a cleared OCD or SCD comes back at once */
    bool amb50_write_sticks;  /**< X0-AMB-50: a FET bit may be set while its fault bit is set */
    bool amb53_edge;          /**< X0-AMB-53: only a rising outside level sets OVRD_ALERT */
    bool amb63_faults_clear_cb; /**< X0-AMB-63: every fault clears the CELLBAL registers */
    bool amb65_config_lost;     /**< X0-AMB-65: XREADY loads the defaults of 0x06..0x0b */
    bool amb66_upper_zero;      /**< X0-AMB-66: while XREADY is set the upper groups read 0 V */
    bool amb69_i2c_at_boot;     /**< X0-AMB-69: I2C answers only when the boot is complete */
    bool amb71_needs_00;        /**< X0-AMB-71: the SHIP pattern arms only after 00 */
    bool amb72_shut_reads_0;    /**< X0-AMB-72: SHUT_A and SHUT_B read back 0 */
    bool amb83_pointer_lost;    /**< X0-AMB-83: a STOP sets the register pointer to 0 */
    bool amb86_nack;            /**< X0-AMB-86: a write to a read-only register is not acknowledged */
    bool amb88_nibble_reads_8;  /**< X0-AMB-88: PROTECT3 bits 3..0 come up as 1000 */
    bool field_zero_boot;       /**< field: after the next boot everything reads zero until SHIP */
    bool field_nibble_offset; /**< field: PROTECT3's low nibble written to 0 over another value and then read
                                 shifts the current */
    bool field_alert_high;    /**< field: ALERT is high although SYS_STAT reads 0 */
} sim_x0_options;

/** Faults injected on the I2C bus, the one point where they touch it. All zero = none. */
typedef struct sim_x0_bus_fault {
    double flip_probability; /**< each data or address bit, either direction */
    int stuck_clocks;        /**< SDA is held low until so many clocks were given; -1 = for ever; 0 = free. A
                                transfer        tried meanwhile goes as with dead = 1. */
    int dead; /**< 1 = the wires read 00 (every byte seems acknowledged), 2 = they read ff; the device hears
                 nothing */
    uint32_t nack_bytes;   /**< so many bytes from now are not acknowledged and not taken */
    uint32_t stretch_us;   /**< the device stretches the clock by this in every transaction */
    uint64_t flips, bytes; /**< counted */
} sim_x0_bus_fault;

typedef struct sim_x0_i2c {
    uint8_t state;      /**< private: what the next byte is */
    bool selected_read; /**< the device is the transmitter */
    uint8_t pointer;    /**< register pointer; survives STOP (X0-I2C-24) */
    uint8_t data;       /**< data byte that waits for its CRC */
    uint8_t crc;        /**< running CRC of the present byte group */
    bool crc_next;      /**< read: the CRC byte follows */
    bool low_frozen;    /**< the low half belongs to the high byte just sent (X0-AMB-19) */
    uint8_t low;
    uint8_t low_pointer;
    int flip_bit;  /**< 1 + bit to flip in the next transaction, 0 = none */
    int bit_count; /**< bits since the first START of this transaction */
    bool in_transaction;
    bool damaged; /**< a fault touched this transaction: nothing in it is the host's misuse */
    /* line level decoder */
    bool scl, sda; /**< last levels seen */
    uint8_t shift, bits;
    bool ack_phase, drive_low, host_nack, active;
} sim_x0_i2c;

typedef struct sim_x0 {
    const sim_x0_part *part;
    sim_x0_options options;
    sim_misuse misuse;
    uint64_t now, rng;
    sim_x0_mode mode;
    uint8_t reg[SIM_X0_REGS];
    uint64_t t_i2c, t_normal;      /**< after the boot signal; UINT64_MAX = none */
    uint64_t t_scan;               /**< next publication */
    uint32_t scans;                /**< publications since the converter started */
    uint64_t t_valid;              /**< first publication after NORMAL; data before it is not valid */
    uint64_t t_cc_end;             /**< end of the coulomb counter window */
    uint64_t t_cc_mark;            /**< until where cc_sum is integrated */
    double cc_sum;                 /**< volt nanoseconds in this window */
    uint64_t ov_since, uv_since;   /**< first bad publication; UINT64_MAX = none */
    uint64_t ocd_since, scd_since; /**< since when over the threshold; UINT64_MAX = not */
    uint64_t due;                  /**< next internal event as last looked up; 0 = look it up again */
    uint64_t t_ship;               /**< when SHIP was entered; an earlier rise of TS1 boots nothing */
    uint64_t raised_at;            /**< when the SYS_STAT bits `raised` became 1 (X0-BIT-08) */
    uint8_t raised, stat_seen;     /**< stat_seen: SYS_STAT bits the host has read as 1 */
    uint8_t short_groups;          /**< groups that this scan converts in 12.5 ms windows (X0-AMB-101) */
    bool ship_armed, frozen, zero_boot, nibble_shift, nibble_armed;
    double cell[SIM_X0_CELLS], ts_ohm[SIM_X0_SENSORS];
    double tdie, sense, chgpin;
    bool alert_ext, supply;
    int gain_uv, offset_mv;
    uint8_t rsvd50, rsvd59; /**< what the reserved bits of 0x50 and 0x59 read (X0-ADC-04) */
    sim_x0_i2c i2c;
    sim_x0_bus_fault bus;
    uint32_t lost_cc; /**< results replaced before the host cleared CC_READY */
    struct sim_vcd *vcd;
    int vcd_signal[5];
    uint64_t vcd_time; /**< how far the waveform got */
} sim_x0;

/** Looks a part up by its base name, for example "bq7694003"; NULL for any other name (X0-VAR-21). */
const sim_x0_part *sim_x0_find_part(const char *name);
/** The n-th part, 0..14; NULL beyond. */
const sim_x0_part *sim_x0_part_at(int n);

/** Sets up the part, powered and in SHIP, inputs at the bqsim defaults. `options` NULL = ideal. */
int sim_x0_init(sim_x0 *s, const sim_x0_part *part, const sim_x0_options *options);
void sim_x0_advance(sim_x0 *s, uint64_t ns);
/** Nanoseconds until the next internal event; UINT64_MAX when none is pending. */
uint64_t sim_x0_next_event(const sim_x0 *s);
sim_misuse *sim_x0_misuse(sim_x0 *s);

/* ---- bus door: bytes ------------------------------------------------------------------------ */

void sim_x0_i2c_start(sim_x0 *s);
/** The host sends a byte; true = acknowledged. The first byte after a START is the address byte. */
bool sim_x0_i2c_write(sim_x0 *s, uint8_t byte);
/** The host reads a byte and acknowledges it or not; 0xff when no device drives the bus. */
uint8_t sim_x0_i2c_read(sim_x0 *s, bool ack);
void sim_x0_i2c_stop(sim_x0 *s);
/** Flips data or address bit `bit` (0 = first after START, ACK bits not counted) of the next transaction. */
int sim_x0_flip_sda(sim_x0 *s, int bit);

/** Whether SDA is high while nobody sends: false while a stuck device holds it. */
bool sim_x0_sda_free(const sim_x0 *s);
/** One clock of a bus recovery, SDA released. */
void sim_x0_recovery_clock(sim_x0 *s);
sim_x0_bus_fault *sim_x0_bus(sim_x0 *s);

/* ---- bus door: line levels ------------------------------------------------------------------ */

/** The levels the host puts on SCL and SDA (true = released); returns the level SDA then has on the wire. */
bool sim_x0_lines(sim_x0 *s, bool scl, bool sda);

/* ---- pins ----------------------------------------------------------------------------------- */

bool sim_x0_alert(const sim_x0 *s);
bool sim_x0_chg(const sim_x0 *s);
bool sim_x0_dsg(const sim_x0 *s);

/* ---- world door ------------------------------------------------------------------------------ */

int sim_x0_set_cell(sim_x0 *s, int input, double volts); /**< input 1..15 of the part; 0 V = shorted */
int sim_x0_set_ts(sim_x0 *s, int sensor, double ohms);   /**< 1..3 of the part */
int sim_x0_set_tdie(sim_x0 *s, double celsius);
int sim_x0_set_sense(sim_x0 *s, double volts); /**< V(SRP) - V(SRN), positive charges */
int sim_x0_set_chgpin(sim_x0 *s, double volts);
int sim_x0_set_alert_ext(sim_x0 *s, bool level);
int sim_x0_set_gain(sim_x0 *s, int gain_uv);     /**< 365..396 */
int sim_x0_set_offset(sim_x0 *s, int offset_mv); /**< -128..127 */
int sim_x0_set_supply(sim_x0 *s, bool on);
/** A pulse of this length above the boot threshold on TS1, starting now. */
int sim_x0_boot(sim_x0 *s, uint64_t pulse_ns);
/** The same for a pulse that rose at `rise_ns` (simulated time) and ends now. */
int sim_x0_boot_ended(sim_x0 *s, uint64_t rise_ns);
/** The internal fault strikes once. */
int sim_x0_strike_xready(sim_x0 *s);
/** Field quirk: the converter stops updating although ADC_EN reads as set; false lets it go on. */
void sim_x0_freeze(sim_x0 *s, bool frozen);
/** CB15..CB1 as commanded. */
uint16_t sim_x0_cb(const sim_x0 *s);
/** CB15..CB1 as they really conduct now: open for 75 ms of every 250 ms in a balancing group (X0-SCH-04). */
uint16_t sim_x0_cb_conducting(const sim_x0 *s);
/** A register's value without any side effect; 0 for addresses that hold nothing. */
uint8_t sim_x0_peek(const sim_x0 *s, uint8_t reg);

/* ---- waveform: see sim_vcd.h ------------------------------------------------------------------ */

struct sim_vcd;
/** Records SCL, SDA, ALERT, CHG and DSG from now on; NULL stops. Bytes take 100 kHz bit times in the waveform
 * although they take no simulated time; what follows at the same instant is drawn behind them. */
void sim_x0_record(sim_x0 *s, struct sim_vcd *vcd);

#endif
