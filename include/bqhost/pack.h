/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file pack.h
 * The pack controller: one step from (configuration, state, sample, input, time) to an action. It calls
 * nothing, reads no clock and keeps no state outside bq_pack: the same inputs in the same order give the same
 * actions on every platform.
 *
 * Rules
 * - Safe direction first. Outputs go on only on entering the state "on", which needs: request on, self-test
 *   passed, no fault, no limit being broken, and a valid, fresh reading of every configured cell and sensor.
 *   Any fault ends it (with separate_paths, one direction may stay on, see there).
 * - A value stands until a newer valid one of the same cell or sensor replaces it: a reading that breaks a
 *   limit and is then lost keeps the debounce time running.
 * - The time for which a module could not be judged is counted from the conversion start of its last
 *   complete, valid set of readings ("blind time"). Above comm_timeout_ms the outputs go off, whatever the
 *   reason was. A lost scan within comm_timeout_ms trips nothing; it only pauses balancing.
 * - Worst cases, from the physical event to the action with outputs off, when bq_pack_step() is called at
 *   least every STEP ms, PERIOD ms lie between two conversions, and readings arrive S ms after their start:
 *     nothing valid arrives any more                 comm_timeout_ms + STEP
 *     a limit is broken and no reading is lost       PERIOD + S + debounce_ms + STEP
 *     a limit is broken, whatever the link does      comm_timeout_ms + debounce_ms + 2 STEP
 *   (bq_app guarantees STEP = 1.25 x its period, see app.h.)
 *
 * States
 *     from       to         when (the first line that applies)
 *     sleep      init       request is not sleep
 *     any other  sleep      request is sleep, the outputs were off in the step before, the contactor agrees
 *     any other  fault      a fault is active
 *     fault      standby    no fault is active, monitor up, self-test passed
 *     fault      init       no fault is active otherwise
 *     init       self-test  monitor up and a complete picture has arrived since it is up
 *     self-test  init       monitor not up
 *     self-test  standby    self-test passed and the picture is complete
 *     standby    init       monitor not up, or self-test not passed (again)
 *     standby    on         request on, picture complete, no cause of a fault present, the contactor agrees
 *     on         standby    request is not on
 * One line per step. In the state "on" a monitor that is no longer up matters only through what it then fails
 * to deliver: the blind time. In the state "sleep" nothing is judged and active faults are kept.
 */
#ifndef BQHOST_PACK_H
#define BQHOST_PACK_H

#include "bqhost/sample.h"
#include "bqhost/soc.h"
#include "bqhost/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define BQ_PACK_MAX_CELLS 372u
#define BQ_PACK_MAX_SENSORS 128u
#define BQ_PACK_MAX_MODULES 62u
#define BQ_PACK_EVENTS 32u       /**< length of the event log; the oldest entry is overwritten */
#define BQ_PACK_MISMATCH_MS 100u /**< time a contactor may take to follow its command */

typedef enum bq_pack_state_id {
    BQ_PACK_INIT,      /**< "init": waiting for the monitor and the first complete picture */
    BQ_PACK_SELF_TEST, /**< "self-test": waiting for its result */
    BQ_PACK_STANDBY,   /**< "standby": healthy, outputs off */
    BQ_PACK_ON,        /**< "on": outputs on */
    BQ_PACK_FAULT,     /**< "fault": outputs off because of a fault */
    BQ_PACK_SLEEP      /**< "sleep": outputs off, monitors asleep, nothing is judged */
} bq_pack_state_id;

/** Pack faults; bit numbers of bq_pack.faults. The names returned by bq_pack_fault_name() are those of the
 *  scenario language. */
typedef enum bq_pack_fault {
    BQ_FAULT_CELL_OV,       /**< "cell_ov" */
    BQ_FAULT_CELL_UV,       /**< "cell_uv" */
    BQ_FAULT_OVERTEMP,      /**< "overtemp" */
    BQ_FAULT_UNDERTEMP,     /**< "undertemp" */
    BQ_FAULT_IMBALANCE,     /**< "imbalance" */
    BQ_FAULT_COMM_LOSS,     /**< "comm_loss": a module has been blind for too long because it or the link is
                                 silent */
    BQ_FAULT_CHIP,          /**< "chip": a monitor reports itself unusable, or cannot be controlled */
    BQ_FAULT_CHIP_CELL_OV,  /**< "chip_cell_ov": hardware comparator */
    BQ_FAULT_CHIP_CELL_UV,  /**< "chip_cell_uv" */
    BQ_FAULT_CHIP_OVERTEMP, /**< "chip_overtemp" */
    BQ_FAULT_OPEN_WIRE,     /**< "open_wire" */
    BQ_FAULT_SENSOR,    /**< "sensor": no valid temperature where one is configured, or no current although it
                             is limited */
    BQ_FAULT_SELF_TEST, /**< "self_test" */
    BQ_FAULT_CONFIG,    /**< "config": bring-up or configuration of the monitors failed */
    BQ_FAULT_CONTACTOR, /**< "contactor": the feedback contact contradicts the command; latched until
                             request off */
    BQ_FAULT_NO_READING,  /**< "no_reading": a cell has no valid reading although its module answers */
    BQ_FAULT_OVERCURRENT, /**< "overcurrent": a monitor reports overcurrent or short circuit, or the measured
                               discharge current exceeds discharge_max_ma */
    BQ_FAULT_CHARGE_CURRENT, /**< "charge_overcurrent": the measured charge current exceeds charge_max_ma
                                  (X0-FET-18); latched until request off */
    BQ_FAULT_COUNT
} bq_pack_fault;

typedef enum bq_pack_request { BQ_REQUEST_OFF, BQ_REQUEST_ON, BQ_REQUEST_SLEEP } bq_pack_request;

/** Why a fault has not cleared. */
typedef enum bq_pack_hold {
    BQ_HOLD_NONE,       /**< "none": not active */
    BQ_HOLD_CONDITION,  /**< "condition": the cause is present */
    BQ_HOLD_HYSTERESIS, /**< "hysteresis": not beyond the trip limit, not yet beyond the release limit */
    BQ_HOLD_UNKNOWN,    /**< "unknown": not every configured value is valid and fresh */
    BQ_HOLD_REQUEST,    /**< "request": latched, waits for request off */
    BQ_HOLD_TIME        /**< "time": cleared, recover_ms has not passed yet */
} bq_pack_hold;

/** All limits. bq_pack_config_nmc() and _lfp() give a complete set; bq_pack_config_validate() states what is
 *  refused. */
typedef struct bq_pack_config {
    uint16_t cells;                         /**< cells in series, 1..372 */
    uint16_t sensors;                       /**< temperature sensors, 0..128 */
    uint16_t modules;                       /**< monitor chips, 1..62, not more than cells */
    uint16_t cell_ov_mv, cell_ov_clear_mv;  /**< trip above, release below; 1000..4500 (PL-VCELL-07), clear <
                                                 trip */
    uint16_t cell_uv_mv, cell_uv_clear_mv;  /**< trip below, release above; 1000..4500, trip < clear <
                                                 cell_ov_clear_mv */
    int16_t overtemp_dc, overtemp_clear_dc; /**< trip above, release below; -400..1250, clear < trip */
    int16_t undertemp_dc, undertemp_clear_dc;  /**< trip below, release above; -400..1250, trip < clear <
                                                    overtemp_clear_dc */
    uint16_t imbalance_mv, imbalance_clear_mv; /**< highest minus lowest cell, up to 4500, 1 <= clear < trip;
                                                    both 0 = off */
    int32_t charge_max_ma;     /**< charge current that trips when exceeded, 0..1000000; 0 = not limited */
    int32_t discharge_max_ma;  /**< likewise for the discharge current, a positive number */
    uint16_t debounce_ms;      /**< a limit must be broken this long, by every sample in it; 0..10000; 0 = at
                                         once */
    uint16_t recover_ms;       /**< ... and kept this long before a fault clears by itself, 100..65535 */
    uint16_t comm_timeout_ms;  /**< oldest value that may still decide; older = outputs off; 20..30000 */
    uint16_t balance_start_mv; /**< spread that starts balancing, up to 1000; 0 = never balance */
    uint16_t balance_stop_mv;  /**< a cell is bled while above the lowest by more than this;
                                    1..balance_start_mv, 1..1000 with balance_start_mv = 0 */
    uint16_t balance_min_cell_mv; /**< no bleeding of a cell below; 1000..4500 */
    int16_t balance_max_temp_dc;  /**< no bleeding while any sensor is above; -400..1250 */
    int32_t balance_rest_ma;  /**< |current| up to this counts as rest, 0..1000000; bleeding at rest or while
                                   charging only. Where nobody measures the current, rest = outputs off */
    uint16_t balance_rest_ms; /**< rest must have lasted this long */
    uint8_t balance_duty_percent;   /**< share of steps in which bleeding is allowed, 1..100 */
    uint8_t balance_max_per_module; /**< cells bled at once in one module, the highest first; 0 = all */
    bool separate_paths; /**< charging and discharging are switched separately: a fault that forbids only one
                              direction leaves the other as it is (never switches it on). false = one
                              contactor: every fault forbids both. */
    bq_soc_config soc;   /**< points = 0: no state of charge */
} bq_pack_config;

/** Monitor as seen by whoever calls the step. */
typedef enum bq_pack_monitor {
    BQ_MONITOR_DOWN,  /**< not started, bring-up under way, or asleep */
    BQ_MONITOR_UP,    /**< brought up */
    BQ_MONITOR_FAILED /**< bring-up failed; monitor_status says why */
} bq_pack_monitor;

typedef enum bq_pack_test { BQ_TEST_NONE, BQ_TEST_PASSED, BQ_TEST_FAILED } bq_pack_test;

/** Everything but the sample. All zero = request off, nothing known. */
typedef struct bq_pack_input {
    bq_pack_request request;
    bq_pack_monitor monitor;
    bq_status monitor_status;   /**< of the last bring-up, recorded with fault "config" */
    bq_pack_test self_test;     /**< of the self-test since the last bring-up */
    bq_status self_test_status; /**< recorded with fault "self_test" */
    bq_status apply_status; /**< of the last attempt to carry out an action; negative for comm_timeout_ms =
                                 fault "chip", but for BQ_E_STATE: held back by a fault the sample names */
    bool sample_copied;     /**< the sample was copied from the monitor for this step; false = its ages are
                                 those of an earlier step */
    bool balance_off;       /**< the user wants no cell bled */
    uint32_t contactor_mismatch_ms; /**< for how long the contactor has contradicted its command; 0 = agrees
                                         or no feedback */
} bq_pack_input;

/** One fault: what happened, where, and why it is still there. Times are values of `now_ms`. */
typedef struct bq_pack_fault_record {
    uint32_t count;    /**< times it became active, saturating; 0 = never: nothing else has a meaning then */
    uint32_t first_ms; /**< when it became active for the first time */
    uint32_t trip_ms;  /**< when it became active for the last time */
    uint32_t last_ms;  /**< when its cause was last present */
    int32_t value;     /**< what tripped: mV, tenths of a degree C, BQ_F_ flags, blind ms, or a bq_status */
    uint16_t cell;     /**< 1-based cell of the pack, 0 = none; open wire: the cell above the wire (below, for
                            a top wire) */
    uint8_t device;    /**< 1-based module, 0 = none */
    uint8_t sensor;    /**< 1-based sensor of the pack, 0 = none */
    int8_t wire;       /**< sense wire of the device (0 = bottom), -1 = none */
    bool active;
    bq_pack_hold hold; /**< why it is still active */
    uint32_t since_ms; /**< private: debounce or recovery time began */
} bq_pack_fault_record;

typedef enum bq_pack_event_kind {
    BQ_EVENT_STATE,     /**< code = bq_pack_state_id entered */
    BQ_EVENT_FAULT,     /**< code = bq_pack_fault, where = cell, sensor or device (whichever the record has,
                             in this order) */
    BQ_EVENT_RECOVERED, /**< code = bq_pack_fault */
    BQ_EVENT_CHIP_FLAGS /**< code = device, where = BQ_F_ flags that were not there in the step before */
} bq_pack_event_kind;

typedef struct bq_pack_event {
    uint32_t t_ms;
    uint16_t where;
    uint8_t kind; /**< bq_pack_event_kind */
    uint8_t code;
} bq_pack_event;

/** What the last step saw; for display and telemetry. Only values that may decide count; fields without any
 *  are 0. */
typedef struct bq_pack_summary {
    uint32_t pack_mv; /**< sum of the cells whose value may decide */
    uint16_t cell_min_mv, cell_max_mv;
    uint16_t cell_min, cell_max; /**< their 1-based numbers, 0 = none */
    int16_t temp_min_dc, temp_max_dc;
    uint8_t temp_min, temp_max; /**< their 1-based numbers, 0 = none */
    uint32_t blind_ms;          /**< longest blind time of any module */
    int16_t soc_permille;       /**< 0..1000, -1 = not valid */
    uint16_t balancing;         /**< cells asked to bleed */
    bool complete;              /**< every configured value is valid and fresh */
} bq_pack_summary;

/** One pack controller, about 1.6 KB. Caller-owned; read any field, write none. */
typedef struct bq_pack {
    bq_pack_state_id state;
    bool stepped, have_sequence, started, resting, balancing; /* private */
    uint8_t drives;                                           /* private: the directions that are on */
    uint16_t duty;                                            /* private */
    /* what is used most lies near the beginning: only that is one instruction away on a Cortex-M0 */
    bq_pack_config config;
    uint32_t state_ms;    /**< `now_ms` at which the state was entered */
    uint32_t faults;      /**< bit n = bq_pack_fault n is active */
    uint32_t pending;     /**< bit n = its cause is present, debounce time running or over */
    uint32_t last_ms;     /**< `now_ms` of the last step */
    uint32_t event_count; /**< events ever logged, wraps; the newest is at (event_count - 1) %
                               BQ_PACK_EVENTS */
    uint32_t clearing, sequence, copy_age_ms, sequence_age_ms, rest_ms; /* private */
    bq_pack_summary summary;
    bq_soc soc;
    bq_pack_fault_record fault[BQ_FAULT_COUNT];
    bq_pack_event events[BQ_PACK_EVENTS];
    /* private */
    uint32_t cell_seen[BQ_MASK_WORDS], sensor_seen[BQ_PACK_MAX_SENSORS / 32u];
    uint32_t blind_ms[BQ_PACK_MAX_MODULES];
    uint16_t flags[BQ_PACK_MAX_MODULES];
} bq_pack;

/**
 * Complete limits for NMC and for LFP cells, without state of charge. The numbers are ordinary ones for the
 * chemistry, not those of any cell's datasheet: check them against the cell in use.
 */
bq_pack_config bq_pack_config_nmc(uint16_t cells, uint16_t sensors, uint16_t modules);
bq_pack_config bq_pack_config_lfp(uint16_t cells, uint16_t sensors, uint16_t modules);

/**
 * Checks every field against the ranges above and against each other. BQ_OK; BQ_E_RANGE (a value outside its
 * range); BQ_E_CONFIG (fields that contradict each other); BQ_E_ARG (`config` NULL). `field` may be NULL;
 * otherwise `*field` is set to the name of the first offending field, NULL with BQ_OK and BQ_E_ARG.
 */
bq_status bq_pack_config_validate(const bq_pack_config *config, const char **field);

/**
 * Sets or reads one integer field by its name, for example "cell_ov_mv" (every field above except
 * `separate_paths` and `soc`). BQ_OK; BQ_E_ARG (null pointer or no such field); BQ_E_RANGE (outside the
 * field's own range; nothing changed). Contradictions between fields are found by bq_pack_config_validate().
 */
bq_status bq_pack_config_set(bq_pack_config *config, const char *name, int32_t value);
bq_status bq_pack_config_get(const bq_pack_config *config, const char *name, int32_t *value);

/** Name of the n-th field for the two functions above, n from 0; NULL past the end. */
const char *bq_pack_config_field(uint16_t n);

/** Validates and copies the configuration, state "init", nothing recorded. The statuses of
 *  bq_pack_config_validate(); BQ_E_ARG if `p` is NULL. After an error `*p` is unchanged. */
bq_status bq_pack_init(bq_pack *p, const bq_pack_config *config);

/**
 * One control step. `s` is the present picture, NULL = none yet; its counts must equal the configured ones,
 * otherwise no module is judged by it. `now_ms` may wrap; two steps must lie less than 2^32 ms apart. `*a` is
 * filled completely; it holds until the next step. Never blocks, never fails, calls nothing; its cost grows
 * linearly with the cells. `p`, `in` and `a` must not be NULL; the step does nothing if one is, except that a
 * given `*a` is set to everything off. The pack's share of PL-TSD-03, PL-UVLO-04, PL-SLEEP-07, PL-SEQ-08-06,
 * PL-SEQ-10-01, PL-SEQ-10-07, PL-ELEC-14.
 */
void bq_pack_step(bq_pack *p, const bq_sample *s, const bq_pack_input *in, uint32_t now_ms, bq_action *a);

/** The active fault to show first: loss of protection, then hazards of the cells, then loss of information.
 *  BQ_FAULT_COUNT = none. */
bq_pack_fault bq_pack_cause(const bq_pack *p);

/** What a fault forbids with separate_paths (without, both are true for every fault). False for values
 *  outside the list. */
bool bq_pack_fault_stops_charge(bq_pack_fault fault);
bool bq_pack_fault_stops_discharge(bq_pack_fault fault);

/** Names as in the comments above; never NULL, "?" for values outside the list. */
const char *bq_pack_fault_name(bq_pack_fault fault);
const char *bq_pack_state_name(bq_pack_state_id state);
const char *bq_pack_hold_name(bq_pack_hold hold);

#ifdef __cplusplus
}
#endif
#endif
