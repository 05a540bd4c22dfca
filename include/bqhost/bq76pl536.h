/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file bq76pl536.h
 * Driver for a stack of bq76PL536 (or bq76PL536A) monitors on one SPI port.
 *
 * Use: fill a bq76pl536_config, call bq76pl536_init(), begin a job (first bq76pl536_start()), and call
 * bq76pl536_poll() until it no longer returns BQ_PENDING. One job runs at a time. The pack controller drives
 * the same functions through bq76pl536_afe().
 *
 * - Nothing blocks. Each poll starts at most one bus transfer and does a bounded amount of work; all waiting
 * is told to the caller as a number of microseconds. Only bq76pl536_wait() blocks, for those who want it.
 * - The caller owns the instance and the array of devices; nothing is allocated, nothing is global. Functions
 * are not re-entrant for one instance and must not be called from interrupts.
 * - Every access is checked and repeated a bounded number of times (3); every write that can be read back is.
 * Counters of all that went wrong are in bq76pl536_stats(), findings about the wiring in
 * bq76pl536_diagnose().
 * - Devices count from 1 at the base; device k has address k (PL-ADR-16).
 * - No function writes TEST_SELECT (PL-TEST-03). EPROM programming needs the build option BQHOST_OTP and a
 * guard value.
 *
 * Errors of a job reach the caller through poll. Besides those named at each function any job can end with
 * BQ_E_BUS, BQ_E_TIMEOUT (back-end), BQ_E_NO_ANSWER, BQ_E_CRC, BQ_E_IMPLAUSIBLE (a device, after 3 tries) and
 * BQ_E_VERIFY (a write that did not stick in 3 tries).
 */
#ifndef BQHOST_BQ76PL536_H
#define BQHOST_BQ76PL536_H

#include "bqhost/afe.h"
#include "bqhost/field.h"
#include "bqhost/hal.h"
#include "bqhost/thermistor.h"

#ifdef __cplusplus
extern "C" {
#endif

#define BQ76PL536_MAX_DEVICES 62u
#define BQ76PL536_MAX_CELLS 6u

typedef struct bq76pl536_config {
    uint8_t devices;          /**< 1..62, base first (above 32: beyond the datasheet's 192 cells, allowed) */
    uint8_t cells_per_device; /**< 3..6, when `cells` is NULL */
    const uint8_t *cells; /**< NULL, or [devices] cell counts 3..6, base first; must outlive the instance */
    bool variant_a;       /**< the parts are bq76PL536A */
    bool crc_off;         /**< run the link without CRC (not advised, PL-CRC-09) */
    bool use_conv_pin;    /**< start conversions with BQ_LINE_CONV instead of a broadcast */
    bool allow_unlatched; /**< permits protection delays of 0 */
    uint8_t sensors;      /**< thermistors per device, 0..2 */
    const bq_thermistor *thermistor; /**< table for ratio to temperature; NULL only with sensors = 0 */
    uint16_t sensor_settle_ms;       /**< 5 time constants of the sensor network; 0 = 10 ms */
    uint16_t cov_mv;                 /**< overvoltage trip 2000..5000 in steps of 50; 0 = comparator off */
    uint16_t cuv_mv;                 /**< undervoltage trip 700..3300 in steps of 100; 0 = comparator off */
    uint16_t normal_max_mv;          /**< highest cell voltage of normal operation; 0 = not checked */
    uint16_t normal_min_mv; /**< lowest; the smallest device must reach 7.2 V with it; 0 = not checked */
    uint32_t cov_delay_us;  /**< 100..3100 in steps of 100, or 100000..3100000 in steps of 100000 */
    uint32_t cuv_delay_us;  /**< same */
    uint8_t ot_c[2];        /**< sensor 1, 2: 40..90 degrees C in steps of 5; 0 = off */
    uint16_t ot_delay_ms;   /**< 10..2550 in steps of 10 */
    uint32_t spi_hz; /**< 0 = by stack size (PL-TIM-10); otherwise 10000..1000000 and within PL-NUM-38 */
    uint8_t balance_timer_s;    /**< safety timer 1..63 s; 0 = 4 s */
    uint16_t balance_settle_ms; /**< wait after balancing off before a conversion; 0 = 10 ms */
    uint16_t scrub_period_ms;   /**< every so often one device's configuration is read back; 0 = 1000 */
    uint16_t wire_limit_mv;     /**< brick minus sum of cells that counts as an open wire; 0 = 200 */
    uint8_t user[4];            /**< content of USER1..USER4 */
    bool allow_partial; /**< a stack that ends early is used up to the break; false: start fails, nothing is
                           measured */
    bool gpai_pins; /**< measure the GPAI pins instead of the brick voltage (no check of the brick then) */
    uint8_t frozen_scans; /**< identical results of one device in so many scans count as stopped; 0 = not
                             watched */
    bool warm_start; /**< the first start may adopt a stack that still runs instead of resetting it; false:
                        never. Without effect together with crc_off */
} bq76pl536_config;

/** What became of the attempt to adopt a running stack (config.warm_start). */
typedef enum bq76pl536_warm {
    BQ76PL536_WARM_NONE,       /**< there was none */
    BQ76PL536_WARM_ADOPTED,    /**< adopted: nothing was reset */
    BQ76PL536_WARM_UNHEARD,    /**< a device gave no sound answer at its own address */
    BQ76PL536_WARM_STRANGER,   /**< something answers at address 0 or above the top device */
    BQ76PL536_WARM_SETTINGS,   /**< a register of a device does not hold what the configuration wants */
    BQ76PL536_WARM_UNFINISHED, /**< a device lacks the mark of a bring-up that came to its end */
    BQ76PL536_WARM_BALANCING,  /**< outputs of a device could not be switched off by broadcast */
    BQ76PL536_WARM_FLAGS,      /**< a device has flags, a parity result, or is not ready */
    BQ76PL536_WARM_SELF_TEST   /**< the self-test behind the adoption failed */
} bq76pl536_warm;

/** What the driver learned about the stack beyond a bq_sample. Device numbers count from 1; 0 = none. */
typedef struct bq76pl536_diagnosis {
    uint8_t broken_hop; /**< first device that was not reached: the break lies between it and the one below */
    uint8_t fault_chain_break; /**< lowest device whose forced FAULT does not reach the host */
    uint8_t alert_chain_break; /**< lowest device whose forced ALERT does not reach the host */
    uint8_t line_above;    /**< a line is high without a flag: lowest clean device, the source is above it */
    uint8_t ecc_corrected; /**< device that last reported a corrected EPROM error */
    bool fault_line_stuck; /**< FAULT stays high, or does not fall after the self-test */
    bool alert_line_stuck; /**< ALERT likewise */
    bool alert_silent;     /**< ALERT was low right after a reset, when every device asserts it */
    bool extra_device;     /**< something answered at address 0 after all devices were addressed */
    bool user_readonly;    /**< USER1..USER4 do not keep what is written (PL-AMB-100) */
    bool chain_skipped;    /**< the last self-test left out a chain: line missing or already high */
    uint32_t spi_hz;       /**< clock in use */
    bq76pl536_warm warm;   /**< how the attempt went; every value but NONE and ADOPTED led to a bring-up with
                                resets */
    uint8_t warm_device;   /**< the device that decided it; 0 = none, or address 0 */
} bq76pl536_diagnosis;

/* struct bq76pl536 and bq76pl536_device: complete, so that the caller can own them; members are private */
#include "bqhost/bq76pl536_state.h"

/** Status registers of one device as read last (PL-SEQ-08-02), for logs and tools. */
typedef struct bq76pl536_flags {
    uint8_t device_status, alert_status, fault_status, cov_fault, cuv_fault;
    uint8_t balancing;    /**< outputs on, bit n-1 = cell n */
    uint8_t gpai_quality; /**< BQ_Q_... */
    uint16_t gpai_mv;     /**< brick voltage, or the GPAI pins while they are selected (then 0..2500) */
} bq76pl536_flags;

/* ---- set-up ---------------------------------------------------------------------------------- */

/**
 * Validates the whole configuration, then sets up the instance. Touches no bus and no line (PL-SEQ-03-01).
 * `config`, `spi`, `gpio` and `clock` are copied; what they point to (cells, thermistor, ops, contexts) must
 * outlive the instance. `gpio` may be NULL: the board has no lines; then waits are computed, chains are not
 * tested. `devices` has room for `device_capacity` >= config->devices elements. May be called again while no
 * transfer runs; all knowledge is lost. BQ_OK, or with nothing changed: BQ_E_ARG: null pointer, incomplete
 * ops, too few devices in the array; BQ_E_DEVICES, BQ_E_CELLS: stack (PL-ELEC-10, PL-GEN-01); BQ_E_RANGE,
 * BQ_E_NO_CODE: a threshold or delay outside the register or between two codes (PL-ELEC-04, -06, -07),
 * BQ_E_RANGE also for sensors > 2, balance_timer_s > 63 (PL-ELEC-09), wire_limit_mv 1..109 (PL-VBAT-07),
 * normal_max_mv below normal_min_mv;
 * BQ_E_COV_CUV: closer than 300 mV (PL-COV-12); BQ_E_UNLATCHED: delay 0 of an armed comparator without
 * allow_unlatched; BQ_E_CLOCK: spi_hz outside 10 kHz .. PL-NUM-38 at 40 % duty; BQ_E_CONFIG: sensors without
 * a table, an OT limit without its sensor, an OT delay not above sensor_settle_ms (PL-OT-08), normal_max_mv
 * not below cov_mv - 50 or normal_min_mv not above cuv_mv + 100: the fault would never be released
 * (PL-ELEC-05), or so low that a device with few cells would be without its supply of 7.2 V (PL-ELEC-03).
 */
bq_status bq76pl536_init(bq76pl536 *d, const bq76pl536_config *config, const bq_spi *spi, const bq_gpio *gpio,
                         const bq_clock *clock, bq76pl536_device *devices, uint8_t device_capacity);

/* ---- progress -------------------------------------------------------------------------------- */

/**
 * Advances the running job; see bq_afe_ops.poll. `wait_us` (may be NULL) gets the time until the next call is
 * of use, 0 = now. BQ_PENDING; BQ_OK or a negative status: no job runs, this is how the last one ended (BQ_OK
 * before the first). BQ_E_ARG: `d` is NULL.
 */
bq_status bq76pl536_poll(bq76pl536 *d, uint32_t *wait_us);

/** Blocks: polls until the job ends or `timeout_us` (below 2^31) have passed. The status of the job, or
 * BQ_E_TIMEOUT; the job then still runs and may be polled on. */
bq_status bq76pl536_wait(bq76pl536 *d, uint32_t timeout_us);

/* ---- jobs: each returns BQ_OK (begun), BQ_E_BUSY (another job runs), BQ_E_STATE (not in this state) or
 * BQ_E_ARG ------------- */

/**
 * Bring-up from any state: lines, power-up time, discovery, configuration, self-test of the chains
 * (PL-SEQ-01, -02, -03, -04, -09). Takes 120 ms at least and the longest protection delay. All readings lose
 * their validity until the next scan; balancing is off. Ends with BQ_OK: scan, apply, self_test and sleep are
 * legal. BQ_E_NOT_FOUND: the stack ends below config.devices and allow_partial is false; diagnosis.broken_hop
 * names the first device missing. BQ_E_EXTRA_DEVICE: more devices than configured (PL-SEQ-02-08).
 * BQ_E_CRC_OFF: devices answer only without CRC (PL-SEQ-02-11). BQ_E_CLOCK: the back-end refuses the clock.
 * BQ_E_DEFECTIVE: parity that neither rewriting nor refreshing cures. Broken or stuck FAULT/ALERT chains are
 * reported (BQ_F_CHAIN, diagnosis) without failing. If nothing answers and the board has BQ_LINE_AFE_POWER,
 * it is cycled once. After a failure only start is legal.
 *
 * With config.warm_start the first start after init looks first whether the stack still runs as an earlier
 * life of the host left it: the supply of the devices does not depend on the host, and a reset of all
 * devices, the discovery and one protection delay cost a stack of 32 more than a second without protection by
 * the host. Balancing outputs are switched off by broadcast before anything else. Then every device must
 * answer at its own address, hold all 12 registers of group 3, ADC_CONTROL and IO_CONTROL as configured, have
 * its outputs off, carry the mark of a complete bring-up (the balancing period in CB_TIME), show no flag in
 * ALERT_STATUS, FAULT_STATUS, COV_FAULT, CUV_FAULT and PRESULT_A/B (a CRC flag alone is cleared) and be
 * ready; and nothing may answer at address 0 or above the top device (PL-SEQ-02-08, -08-02, -13-06, -13-07).
 * Nothing is read again: a damaged answer counts as a deviation. If all fits, only the self-test of the
 * chains follows, and if that fails too, nothing was adopted. That is 44 bytes per device instead of the
 * resets, waits and assignments. Any deviation leads to the bring-up described above, from its beginning;
 * diagnosis.warm and warm_device tell which. Every later start, SLEEP, a device that was taken in again in
 * service without having balanced since, a cut-off programming of the EPROM and other settings lead there
 * too. With warm_start a bring-up of all devices ends with one broadcast more, the mark.
 */
bq_status bq76pl536_start(bq76pl536 *d);

/**
 * One update (PL-SEQ-06, -07): outputs off and settled if any was on, convert everywhere, one burst per
 * device, then what the bursts ask for: service of flags (PL-SEQ-08, -15), lock-up recovery (-05), lost
 * devices (-13), and every scrub_period_ms the configuration of one device. With nothing to do: N + 1
 * packets, 23 N + 4 bytes. Balancing outputs stay off until the next apply (PL-SEQ-10-04). A device that was
 * lost in service is looked for in every scan (70 ms apart) and taken in again by itself; one that bring-up
 * did not find needs another start. Ends with BQ_OK when at least one device gave fresh readings: look at the
 * quality of each. BQ_E_NO_ANSWER: none did. BQ_E_BUS, BQ_E_TIMEOUT: the start could not be sent, the old
 * picture stays.
 */
bq_status bq76pl536_scan(bq76pl536 *d);

/**
 * Carries out an action (PL-SEQ-10): balancing outputs of devices with fresh sound readings and no flag in
 * FAULT_STATUS, open wire or fault of the chip itself (an overtemperature alert is left to the caller),
 * each switched on with the full safety timer and proved by read-back and CBT; every other output off,
 * verified. clear_faults clears the comparator flags seen in the last picture (PL-SEQ-08-06), at most once
 * per protection delay. charge_on, discharge_on and sleep are not for this chip. `action` is copied. Ends
 * with BQ_OK or BQ_E_VERIFY (outputs did not do what was asked: BQ_F_BALANCE; they were switched off again).
 */
bq_status bq76pl536_apply(bq76pl536 *d, const bq_action *action);

/**
 * Proves the FAULT and ALERT chains by forcing the top device (PL-SEQ-09). A chain whose line the board does
 * not have, or that is high for a reason, is left out (diagnosis.chain_skipped). Ends with BQ_OK,
 * BQ_E_CHAIN_BROKEN (diagnosis names the lowest device that is not heard), BQ_E_LINE_STUCK. It takes about 21
 * bytes per device, and no more where a chain is broken: the place is found by halving. The readings age
 * meanwhile: the time a pack allows for that has to exceed a scan and a self-test together (360 ms with 62
 * devices at 62.5 kHz).
 */
bq_status bq76pl536_self_test(bq76pl536 *d);

/**
 * Active test of every sense wire (PL-SEQ-14-04): a scan, then one balancing output at a time for 40 ms.
 * About 6 x 50 ms; the cells are loaded by the balancing resistors only. Wires found open are in the sample
 * (open_wire, BQ_Q_OPEN_WIRE) until the next scan judges passively again. Outputs are off afterwards,
 * verified.
 */
bq_status bq76pl536_wire_test(bq76pl536 *d);

/** Measures the GPAI pins (true) or the brick voltage (false) from the next scan on (PL-GPAI-06); until then
 * there is no reading of either. Ends with BQ_OK; after an error the choice stands and the scrub carries it
 * on, device by device. */
bq_status bq76pl536_select_gpai(bq76pl536 *d, bool pins);

/**
 * SLEEP of the whole stack (PL-SEQ-11): balancing off, ADC off, thermistors off, the SLEEP flags cleared, all
 * verified. Cells are neither measured nor protected afterwards. The readings lose their validity. Only wake
 * and start are legal afterwards, also after a failure once the command was sent. BQ_E_LINE_STUCK: ALERT
 * stays high.
 */
bq_status bq76pl536_sleep(bq76pl536 *d);

/** Out of SLEEP up to verified configuration; a device that was reset meanwhile is configured again. Flags
 * from before SLEEP are kept. After a failure: start. */
bq_status bq76pl536_wake(bq76pl536 *d);

/** The value that bq76pl536_program_otp() wants as proof of intent. */
#define BQ76PL536_OTP_GUARD 0x4f545021ul

/**
 * Programs the EPROM of one device: IRREVERSIBLE, ONCE PER PART (PL-SEQ-12). Exists only in builds with
 * BQHOST_OTP. `image` [12] is the complete content of 0x40..0x4b; it must stay valid until the job has ended.
 * Needs BQ_LINE_VPP (7 V), the brick voltage selected, a started stack and no other traffic. While it runs
 * poll must be called at least every 10 ms: the 7 V are removed 2.5 ms after the command. Returns
 * BQ_E_UNSUPPORTED (build, line, or an image that switches CRC off), BQ_E_ARG (guard, device, NULL),
 * BQ_E_RANGE, BQ_E_COV_CUV, BQ_E_UNLATCHED (image), BQ_E_BUSY, BQ_E_STATE. Ends with BQ_OK: the image
 * survived a reset. BQ_E_VOLTAGE: VBAT below 20 V or no 7 V; BQ_E_NOT_BLANK; BQ_E_VERIFY: the shadow
 * registers did not take the image, or the part is still blank; in these three cases nothing was programmed.
 * BQ_E_DEFECTIVE: reject the part.
 */
bq_status bq76pl536_program_otp(bq76pl536 *d, uint8_t device, const uint8_t *image, uint32_t guard);

/* ---- looking ---------------------------------------------------------------------------------- */

/**
 * Copies the picture; see bq_afe_ops.sample. Cells of the base device first. A module that is lost keeps its
 * last values with BQ_Q_COMM, without BQ_Q_VALID. Readings at the end of the converter carry BQ_Q_RANGE;
 * cells outside 1.0..4.5 V and bricks outside 7.2..27 V are measured and valid, and carry BQ_Q_OUTSIDE
 * (PL-ELEC-01). Current fields are not touched. BQ_OK; BQ_E_ARG: null pointer or too little room (nothing
 * written); BQ_E_STALE: no update yet; BQ_E_BUSY: a scan is exchanging the picture at this moment (nothing
 * written).
 */
bq_status bq76pl536_sample(bq76pl536 *d, bq_sample *sample);

/** Devices 1..n that answer; 0 before discovery. */
uint8_t bq76pl536_modules_found(const bq76pl536 *d);
/** Link statistics since init. */
const bq_link_stats *bq76pl536_stats(const bq76pl536 *d);
/** Findings about the stack. */
const bq76pl536_diagnosis *bq76pl536_diagnose(const bq76pl536 *d);
/** Status registers of device 1..config.devices. BQ_OK or BQ_E_ARG. */
bq_status bq76pl536_device_flags(const bq76pl536 *d, uint8_t device, bq76pl536_flags *flags);

/** The fields of bq76pl536_config that a record of the settings holds (settings.h): all but the pointers. */
extern const bq_field_table bq76pl536_config_fields;

/** Fills the interface the super-loop uses. `d` must outlive it. */
bq_afe bq76pl536_afe(bq76pl536 *d);

#ifdef __cplusplus
}
#endif
#endif
