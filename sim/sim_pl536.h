/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file sim_pl536.h
 * A register-accurate stack of bq76PL536 monitors. Two doors: the bus (bytes and pins, what a host sees) and
 * the world (volts, ohms, degrees, supply, wires: what a test sets). All state lives in one caller-owned
 * sim_pl; nothing is global. Simulated time moves only with sim_pl_advance(); transfers take none. Devices
 * count from 1 (the base, host side). Functions that can refuse return 0 when done and -1 when refused; a
 * refused call changes nothing.
 */
#ifndef SIM_PL536_H
#define SIM_PL536_H

#include "sim_misuse.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define SIM_PL_MAX_DEVICES 62
#define SIM_PL_US 1000ull /**< nanoseconds in a microsecond */
#define SIM_PL_MS 1000000ull
#define SIM_PL_S 1000000000ull

typedef enum sim_pl_mode {
    SIM_PL_OFF,   /**< supply below the POR threshold */
    SIM_PL_RESET, /**< reset time running */
    SIM_PL_ACTIVE,
    SIM_PL_SLEEP,
    SIM_PL_TSD,
    SIM_PL_UVLO,
    SIM_PL_LOCKED /**< ADC lock-up (PL-ADC-12) */
} sim_pl_mode;

/** Non-ideal behaviour and the other readings of ambiguous facts. All zero = the ideal, documented part. */
typedef struct sim_pl_options {
    bool variant_a;      /**< bq76PL536A: 6 us fixed, ADCT reserved, no lock-up, IO_CONFIG bit 7 = CRCNOFLT */
    uint32_t seed;       /**< of everything random below */
    double noise_uv_rms; /**< ADC noise of the cell channels; brick noise is 6 times, others 0.6 times this */
    double cell_offset_uv_max;  /**< each cell channel gets a fixed offset, uniform within +- this */
    double delay_percent;       /**< protection delays and timers scaled by (1 + this/100), -12..10 */
    bool deglitch;              /**< add the 50 us start-up deglitch to protection delays (PL-FLT-04) */
    bool strict_timing;         /**< judge bus timing given with sim_pl_spi_timed() (PL-SPI-12) */
    bool amb01_crc_alert;       /**< PL-AMB-01: a CRC error asserts the ALERT line as well */
    bool amb02_crc_last_packet; /**< PL-AMB-02: the next good write to the device clears FAULT_STATUS[CRC] */
    bool amb06_all_check;       /**< PL-AMB-06: every device that sees a damaged write flags it */
    bool amb12_idle_ff;         /**< PL-AMB-12: an undriven byte reads 0xff while CS is low */
    bool amb18_addressed_only;  /**< PL-AMB-18: a device at 0x00 executes no broadcast but RESET */
    bool amb26_needs_bit7;      /**< PL-AMB-26: an address write counts only with bit 7 set */
    bool amb28_ar_copy; /**< PL-AMB-28: ALERT_STATUS[AR] is the inverted copy of ADDRESS_CONTROL[AR] */
    bool amb33_hold_until_zero; /**< PL-AMB-33: latch held cleared until the 0 is written */
    bool amb40_sticky_cells;    /**< PL-AMB-40: COV_FAULT/CUV_FAULT clear only when the comparator releases */
    bool amb48_ecc_alert; /**< PL-AMB-48: a corrected EPROM error sets DEVICE_STATUS[ALERT] and the line */
    bool amb49_no_ifault; /**< PL-AMB-49: ECC error sets ECC_ERR only */
    bool amb51_sleep_on_exit;  /**< PL-AMB-51: leaving SLEEP sets ALERT_STATUS[SLEEP] too */
    bool amb54_reset_no_por;   /**< PL-AMB-54: RESET command does not set FAULT_STATUS[POR] */
    bool amb62_six_us;         /**< PL-AMB-62: ADCT = 00b takes 6 us per channel */
    bool amb68_conv_reads_one; /**< PL-AMB-68: ADC_CONVERT[CONV] reads 1 until the cycle ends */
    bool amb78_drdy_zero;      /**< PL-AMB-78: DRDY is 0 until the first conversion */
    bool amb79_drdy_base_only; /**< PL-AMB-79: DRDY_H shows the base device only */
    bool amb83_any_rise;       /**< PL-AMB-83: any 0-to-1 change in CB_CTRL restarts the timer */
    bool amb84_clear_cbctrl;   /**< PL-AMB-84: expiry clears CB_CTRL */
    bool amb85_time_restarts;  /**< PL-AMB-85: writing CB_TIME restarts a running period with the new value */
    bool amb86_sleep_stops_cb; /**< PL-AMB-86: SLEEP and TSD stop balancing */
    uint32_t amb93_reset_us;   /**< PL-AMB-93: duration of RESET; 0 = 500 us */
    bool amb99_discarded_cancels; /**< PL-AMB-99: a write discarded for its CRC cancels the key */
    bool amb100_user_readonly;    /**< PL-AMB-100: USERn cannot be written */
    double reg50_v;               /**< REG50 as GPAI reference (PL-AMB-57); 0 = 5.0 V */
    double wire_drift;            /**< how far an open sense wire drifts, see sim_pl536_analog.c; 0 = 0.5 */
    bool wire_field_pattern; /**< open wires as seen on real hardware: the lower cell reads 0, the sum is too
                                low */
} sim_pl_options;

/* struct sim_pl: complete, so that a caller can own it; its members are private */
#include "sim_pl536_state.h"

/* ---- life ---------------------------------------------------------------------------------- */

/** Sets up `devices` (1..62) powered devices past power-on reset, EPROM blank, inputs at the bqsim defaults.
 * `options` NULL = ideal. Refuses a wrong number of devices and options out of range. */
int sim_pl_init(sim_pl *s, int devices, const sim_pl_options *options);
/** Lets `ns` nanoseconds pass; cheap when nothing is due. */
void sim_pl_advance(sim_pl *s, uint64_t ns);
uint64_t sim_pl_now(const sim_pl *s);
/** Nanoseconds until the next internal event; UINT64_MAX when none is pending. */
uint64_t sim_pl_next_event(const sim_pl *s);
/** Everything the host did that the datasheet forbids. */
sim_misuse *sim_pl_misuse(sim_pl *s);

/* ---- bus door ------------------------------------------------------------------------------ */

/**
 * One packet: CS_H low around exactly n bytes. rx gets what the host sees on SDO_H; driven (may be NULL) gets
 * 1 for each byte that a device drives and 0 otherwise (rx then holds the idle level of PL-AMB-12). Goes
 * through the fault interception point.
 */
void sim_pl_spi(sim_pl *s, const uint8_t *tx, uint8_t *rx, uint8_t *driven, size_t n);
/** The same, ending after `bits` clocks (not necessarily on a byte boundary). */
void sim_pl_spi_bits(sim_pl *s, const uint8_t *tx, uint8_t *rx, uint8_t *driven, size_t bits);
/** What a packet looks like in time, for sim_pl_spi_timed(). */
typedef struct sim_pl_spi_timing {
    uint32_t clock_hz;         /**< 0 = as before */
    uint32_t duty_percent;     /**< high phase of the clock */
    uint32_t cs_high_ns;       /**< CS_H high before this packet */
    uint32_t cs_lead_ns;       /**< CS_H low to the first clock edge */
    uint32_t cs_lag_ns;        /**< last clock edge to CS_H high */
    uint32_t longest_pause_ns; /**< between two bytes */
} sim_pl_spi_timing;
/** As sim_pl_spi(); with the option strict_timing the timing is judged (PL-SPI-12, PL-AMB-20), never the
 * packet's effect changed. */
void sim_pl_spi_timed(sim_pl *s, const uint8_t *tx, uint8_t *rx, uint8_t *driven, size_t n,
                      const sim_pl_spi_timing *timing);
/**
 * The same packet as hardware sends it. sim_pl_spi_select(): CS_H falls now. sim_pl_spi_byte(): eight clocks at
 * the rate of sim_pl_set_spi_clock() end now; returns what the host received, `driven` (may be NULL) whether a
 * device drove it (SDO_H floats otherwise: the value is then the idle level of PL-AMB-12, with CS_H high ff).
 * sim_pl_spi_release(): CS_H rises now and a write takes effect (PL-SPI-06). Let simulated time pass between
 * the calls: with strict_timing the times between them are judged as those of sim_pl_spi_timed().
 * Effects, answers and injected faults are those of sim_pl_spi(), with these differences: a read is answered
 * from the registers as they are when its third byte ends; until the answer begins, and in a write, a random
 * flip towards the host is not shown; a packet longer than 1023 bytes is cut off there. Selecting twice or
 * releasing twice does nothing.
 */
void sim_pl_spi_select(sim_pl *s);
uint8_t sim_pl_spi_byte(sim_pl *s, uint8_t tx, bool *driven);
void sim_pl_spi_release(sim_pl *s);
bool sim_pl_spi_selected(const sim_pl *s);
/** The clock, for waveforms and (with strict_timing) for the judge, which then also wants 3 us of simulated
 * time between packets. */
void sim_pl_set_spi_clock(sim_pl *s, uint32_t hz);
/** The mode (0..3) the host uses; only judged, with strict_timing (PL-SPI-01). Initially 1. */
void sim_pl_set_spi_mode(sim_pl *s, int mode);
/** CONV_H. */
void sim_pl_set_conv(sim_pl *s, bool level);
bool sim_pl_conv(const sim_pl *s);
bool sim_pl_fault_pin(const sim_pl *s);
bool sim_pl_alert_pin(const sim_pl *s);
bool sim_pl_drdy_pin(const sim_pl *s);

/* ---- world door (device 1..N, cell 1..6, sensor 1..2) --------------------------------------- */

int sim_pl_set_cell(sim_pl *s, int device, int cell, double volts);
/** All six at once; the fast path of a cell model. */
int sim_pl_set_cells(sim_pl *s, int device, const double volts[6]);
double sim_pl_cell(const sim_pl *s, int device, int cell);
/** Brick voltage; a negative value means the sum of the cells. */
int sim_pl_set_vbat(sim_pl *s, int device, double volts);
double sim_pl_vbat(const sim_pl *s, int device);
int sim_pl_set_ts_ratio(sim_pl *s, int device, int sensor, double ratio);
double sim_pl_ts_ratio(const sim_pl *s, int device, int sensor);
int sim_pl_set_gpai(sim_pl *s, int device, double volts);
double sim_pl_gpai(const sim_pl *s, int device);
int sim_pl_set_gpio(sim_pl *s, int device, bool external_level);
bool sim_pl_gpio(const sim_pl *s, int device); /**< level of the pin */
int sim_pl_set_tdie(sim_pl *s, int device, double celsius);
double sim_pl_tdie(const sim_pl *s, int device);
int sim_pl_set_supply(sim_pl *s, int device, bool on);
bool sim_pl_supply(const sim_pl *s, int device);
/** EPROM content, reg 0x40..0x4b, loaded at the next reset or refresh; ECC is made to fit. */
int sim_pl_set_otp(sim_pl *s, int device, uint8_t reg, uint8_t value);
uint8_t sim_pl_otp(const sim_pl *s, int device, uint8_t reg);
/** Damages an EPROM register: `bits` set bits are flipped without new ECC. One bit is corrected, more are
 * detected (PL-ECC). */
int sim_pl_damage_otp(sim_pl *s, int device, uint8_t reg, uint8_t bits);
/** Flips bits of the RAM copy behind the parity's back (PL-G3-08). */
int sim_pl_damage_ram(sim_pl *s, int device, uint8_t reg, uint8_t bits);
int sim_pl_set_vpp(sim_pl *s, int device, bool on);
bool sim_pl_vpp(const sim_pl *s, int device);
/** Sense wire 0..6 of a device (0 = VC0) open or closed. What the inputs then see is documented in
 * sim_pl536_analog.c. */
int sim_pl_set_wire(sim_pl *s, int device, int wire, bool open);
/** Inter-device link above device k (1..N-1) broken or whole: nothing crosses in either direction. */
int sim_pl_set_link(sim_pl *s, int device, bool broken);
uint8_t sim_pl_cb(const sim_pl *s, int device); /**< CB6..CB1 outputs */
bool sim_pl_aux(const sim_pl *s, int device);
bool sim_pl_reg50(const sim_pl *s, int device);
sim_pl_mode sim_pl_get_mode(const sim_pl *s, int device);
/** A register's value without any side effect; -1 for a device that does not exist. */
int sim_pl_peek(const sim_pl *s, int device, uint8_t reg);
/** Number of conversion cycles a device completed: lets a test see that a scan really converted. */
uint32_t sim_pl_conversions(const sim_pl *s, int device);

/* ---- faults on the bus: one interception point, see sim_bus_fault.h --------------------------- */

struct sim_bus_fault *sim_pl_bus_fault(sim_pl *s);

/* ---- waveform: see sim_vcd.h ------------------------------------------------------------------ */

struct sim_vcd;
/** Records CS, SCLK, SDI, SDO, CONV, DRDY, FAULT and ALERT of the host port; NULL ends it. */
void sim_pl_record(sim_pl *s, struct sim_vcd *vcd);

#endif
