/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file ps_scenario.h
 * A scenario with every value checked: what is simulated, what happens, what is expected. Filled before
 * anything runs.
 */
#ifndef PS_SCENARIO_H
#define PS_SCENARIO_H

#include "bqhost/app.h"
#include "bqhost/bq769x0.h"
#include "bqhost/bq76pl536.h"
#include "ps_ini.h"
#include "sim_cells.h"
#include "sim_cells_load.h"
#include "sim_x0.h"

#define PS_EVENTS 256
#define PS_EXPECTS 128
#define PS_EVENT_TEXT 64
#define PS_EXPECT_TEXT PS_INI_TEXT

typedef enum ps_action_kind {
    PS_ACT_CELL_VOLTS,
    PS_ACT_CELL_FREE,
    PS_ACT_SENSOR,
    PS_ACT_CURRENT,
    PS_ACT_CURRENT_FILE,
    PS_ACT_REQUEST, /**< on */
    PS_ACT_BREAK,
    PS_ACT_MEND,
    PS_ACT_DEVICE,   /**< on */
    PS_ACT_WIRE,     /**< on = open */
    PS_ACT_FLIP,     /**< bits of the bus, SPI or I2C */
    PS_ACT_BUS_DEAD, /**< on = ff */
    PS_ACT_BUS_FREE,
    PS_ACT_MCU_RESET,
    PS_ACT_WELD,
    PS_ACT_XREADY,
    PS_ACT_ALERT
} ps_action_kind;

typedef struct ps_event {
    uint64_t t;
    ps_place at;
    ps_action_kind kind;
    int n;
    bool on;
    double value;
    char text[PS_EVENT_TEXT]; /**< the action, for people */
} ps_event;

typedef enum ps_expect_kind {
    PS_EXP_STATE, /**< state at t */
    PS_EXP_FAULT, /**< fault (item) within t of t0 */
    PS_EXP_NO_FAULT_BEFORE,
    PS_EXP_NO_FAULTS,
    PS_EXP_DISCOVERED, /**< n devices at t */
    PS_EXP_SPREAD,     /**< below value mV at t */
    PS_EXP_SOC,
    PS_EXP_MEASUREMENT,
    PS_EXP_OUTPUTS_OFF, /**< within t of t0 */
    PS_EXP_RECOVERED,   /**< at t */
    PS_EXP_MISUSE_NONE,
    PS_EXP_SPEED
} ps_expect_kind;

/** What a fault is tied to. */
typedef enum ps_item { PS_ITEM_ANY, PS_ITEM_CELL, PS_ITEM_DEVICE, PS_ITEM_SENSOR } ps_item;

typedef struct ps_expect {
    ps_expect_kind kind;
    ps_place at;
    char text[PS_EXPECT_TEXT];
    int id; /**< state or fault number, device count */
    ps_item item;
    int n;
    uint64_t t, t0;
    double value;
} ps_expect;

typedef struct ps_scenario {
    const sim_x0_part *part; /**< NULL = a stack of bq76PL536 */
    int devices, cells, sensors;
    double shunt_ohm;
    uint64_t
        adc_freeze; /**< bq769x0: the converter stops here until it is switched off; UINT64_MAX = never */
    sim_cells_config world;
    sim_ocv ocv;
    sim_cells_load load;
    bool has_load_file;
    bool request_on;
    bool eprom_fast; /**< FUNCTION_CONFIG in the EPROM selects 6 us conversions; otherwise blank */
    bq_app_config app;
    bq76pl536_config driver;
    bq769x0_config afe;
    bq_ocv_point soc_points[SIM_OCV_POINTS]; /**< the curve as the firmware is told it */
    uint8_t cells_of[BQ76PL536_MAX_DEVICES];
    ps_place pack_at; /**< for errors that concern the whole configuration */
    uint64_t duration, period;
    uint64_t seed;
    int events;
    ps_event event[PS_EVENTS];
    int expects;
    ps_expect expect[PS_EXPECTS];
    int expects_cut; /**< expectations beyond a run that the command line shortened */
} ps_scenario;

/** Where files named in a scenario are looked for, in this order; NULL entries are skipped. */
typedef struct ps_search {
    char scenario_dir[PS_PATH];
    char data_dir[PS_PATH];
} ps_search;

/** What the command line overrides. */
typedef struct ps_override {
    uint64_t duration; /**< 0 = as the scenario says */
    const char *current_file;
    bool has_seed;
    uint64_t seed;
} ps_override;

/** Interprets all of `ini`. 0, or -1 with the error recorded. */
int ps_scenario_build(ps_scenario *s, ps_ini *ini, const ps_search *search, const ps_override *override,
                      ps_error *e);

/** One event `key = value`, one expectation line. 0 or -1. */
int ps_event_parse(ps_event *v, const ps_scenario *s, const char *time, const char *action, ps_place at,
                   ps_error *e);
int ps_expect_parse(ps_expect *x, const ps_scenario *s, const char *text, ps_place at, ps_error *e);

/** The latest moment an expectation looks at; 0 for those judged at the end. */
uint64_t ps_expect_deadline(const ps_expect *x);

/** Defaults of a chemistry for the pack controller and the driver; all of [pack] and s->period are set. */
void ps_limits_default(ps_scenario *s, bool lfp);
/** All of [limits], then checks the whole configuration with the firmware's own validators. 0, or -1 naming
 * the field. */
int ps_limits_build(ps_scenario *s, ps_ini *ini, ps_error *e);
/** The same for a bq769x0: defaults of the driver, and its validator. */
void ps_afe_default(ps_scenario *s, bool lfp);
bq_status ps_afe_check(const ps_scenario *s);
/** Name of key i of [limits] for help; NULL past the end. */
const char *ps_limit_name(int i);
/** Fields of the firmware that follow from [pack] and cannot be given in [limits]. */
bool ps_limit_follows(const char *key);

/** Numbers of the firmware's names; -1 when unknown. */
int ps_state_number(const char *name);
int ps_fault_number(const char *name);

#endif
