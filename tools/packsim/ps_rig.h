/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file ps_rig.h
 * The bench: firmware (super-loop, pack controller, driver), back-end, simulated monitor and the world of
 * cells, wired together. ps_rig.c knows the world, ps_stack.c and ps_afe.c one kind of monitor each.
 */
#ifndef PS_RIG_H
#define PS_RIG_H

#include "bqhost/bq769x0.h"
#include "bqhost/bq76pl536.h"
#include "bqhost/firmware.h"
#include "hal_sim.h"
#include "hal_sim_x0.h"
#include "ps_scenario.h"
#include "sim_cells_pl.h"
#include "sim_cells_x0.h"
#include "sim_pl536.h"
#include "sim_vcd.h"

#define PS_TRUTHS 16

/** Paths of the pack current. A bq769x0's two FETs are in series and each has a body diode: discharging needs
 * DSG, charging needs CHG, and with one of them on alone the current in its direction passes through the
 * diode of the other. */
#define PS_CHARGE 1u
#define PS_DISCHARGE 2u

/** Everything a microcontroller loses in a reset. */
typedef struct ps_firmware {
    bq_firmware firmware;
    union {
        bq76pl536 driver;
        bq769x0 afe;
    };
    bq76pl536_device devices[BQ76PL536_MAX_DEVICES];
    bq_cell_reading cells[SIM_CELLS_MAX];
    bq_temp_reading temps[SIM_CELLS_MODULES * SIM_CELLS_SENSORS];
    bq_module_reading modules[SIM_CELLS_MODULES];
} ps_firmware;

/** Cell voltages that were true from a moment on. */
typedef struct ps_truth {
    uint64_t t;
    double volts[SIM_CELLS_MAX];
} ps_truth;

struct ps_rig;

/** One kind of monitor on the bench. */
typedef struct ps_monitor {
    uint64_t world_step;                 /**< longest step of the world */
    uint32_t age_slack_ms;               /**< what the driver adds to the age of what it has just read */
    bool measures_current;               /**< otherwise the board has an ammeter */
    int (*build)(struct ps_rig *r);      /**< chips and back-end; 0, or -1 when refused */
    bq_status (*init)(struct ps_rig *r); /**< the driver, after a reset; fills r->afe */
    void (*release)(struct ps_rig *r);   /**< the pins, in a reset */
    bq_gpio (*gpio)(struct ps_rig *r);
    bq_clock (*clock)(struct ps_rig *r);
    uint64_t (*now)(const struct ps_rig *r);
    void (*advance)(struct ps_rig *r, uint64_t ns);
    uint64_t (*due)(const struct ps_rig *r); /**< time until the chips do something by themselves that moves a
                                                  path; NULL = they never do */
    unsigned (*paths)(const struct ps_rig *r); /**< switched on by the firmware: PS_CHARGE, PS_DISCHARGE */
    void (*feed)(struct ps_rig *r);            /**< shows the world to the chips */
    bool (*observe)(struct ps_rig *r, double dt_s); /**< books the balancing outputs; true if any is on */
    uint64_t (*conversion)(const struct ps_rig *r, uint64_t read_t); /**< when what was read at read_t was
                                                   converted; UINT64_MAX = cannot be told */
    void (*act)(struct ps_rig *r, const ps_event *v); /**< events of the chips and of the bus */
    uint64_t (*bytes)(const struct ps_rig *r);        /**< on the bus so far */
    sim_misuse *(*misuse)(struct ps_rig *r);
    void (*record)(struct ps_rig *r, sim_vcd *vcd); /**< NULL = stop */
} ps_monitor;

extern const ps_monitor ps_stack, ps_afe;

/** What plays the firmware: compiled natively, or the image of a board in the emulator. */
typedef struct ps_player {
    int (*begin)(struct ps_rig *r, ps_error *e);   /**< powers up; 0, or -1 with the error recorded */
    void (*end)(struct ps_rig *r);                 /**< after ps_rig_init(), also a failed one */
    uint64_t (*pass)(struct ps_rig *r);            /**< lets it act; ns until it wants to act again */
    void (*elapse)(struct ps_rig *r, uint64_t ns); /**< lets simulated time pass, or less of it */
    void (*request)(struct ps_rig *r);             /**< r->request has changed */
    void (*reset)(struct ps_rig *r);               /**< by the reset pin */
    bool (*restarted)(struct ps_rig *r);           /**< by itself since this was called last */
    sim_misuse *(*misuse)(struct ps_rig *r);       /**< of the microcontroller; NULL = it has no judge */
} ps_player;

extern const ps_player ps_native, ps_image;

typedef struct ps_rig {
    ps_scenario *s;
    const ps_monitor *monitor;
    const ps_player *player; /**< NULL = ps_native; set before ps_rig_init(), as the next two */
    const char *image;       /**< file, for ps_image */
    const char *board;       /**< name; NULL = the one that fits the monitor */
    FILE *costs;             /**< what the image cost goes there at the end; NULL = not wanted */
    uint32_t loop;           /**< address that its main loop comes by in each pass; 0 = not known */
    struct ps_emulation *emulation;
    ps_firmware fw; /**< with ps_image: what it has told on CAN, in the shape of the native one */
    bq_afe afe;
    hal_sim hal; /**< a stack ... */
    sim_pl pl;
    hal_sim_x0 hal_x0; /**< ... or a bq769x0 */
    sim_x0 x0;
    uint64_t alert_until; /**< somebody else holds ALERT high until then; UINT64_MAX = nobody */
    bool froze;           /**< adc_freeze has struck */
    bool stretch;         /**< a slave may stretch the clock now: behind the address */
    sim_cells world;
    sim_vcd vcd;
    bool recording;
    uint64_t step;           /**< of the world */
    uint64_t world_t;        /**< moment the world stands at */
    uint64_t bled_t;         /**< when an output was last seen on */
    uint64_t observed_t;     /**< balancing outputs booked up to here */
    double world_a;          /**< current at world_t */
    unsigned paths;          /**< switched on, as the world knows it */
    bool welded, moved;      /**< moved: the paths changed since ps_rig_sync() */
    uint64_t moved_t;        /**< when the paths changed last */
    bq_pack_request request; /**< what the user wants, over firmware resets */
    ps_truth truth[PS_TRUTHS];
    unsigned truths;
    bq_boot boot;       /**< what the present life of the firmware is told about its start */
    bool reset_asked;   /**< by the firmware itself */
    uint64_t fed_t;     /**< when the watchdog was fed last */
    uint64_t fed_gap;   /**< longest time between two feedings */
    bq_can can;         /**< ops NULL = none; set before ps_rig_init() */
    bq_stream console;  /**< likewise */
    bq_link_stats lost; /**< of firmware lives that ended in a reset */
} ps_rig;

/** Builds everything, firmware initialised, simulated time 0. r->can, r->console and what chooses the player
 * are kept, all else is new. 0; or -1 with the error recorded. */
int ps_rig_init(ps_rig *r, ps_scenario *s, ps_error *e);
/** Records the host port's lines. 0, or -1 with errno set. */
int ps_rig_record(ps_rig *r, const char *path);
/** Ends what ps_rig_init() began, also a failed one. 0, or -1 if the waveform could not be written. */
int ps_rig_close(ps_rig *r);

uint64_t ps_rig_now(const ps_rig *r);
/** Lets simulated time pass, the world stepping on its grid. */
void ps_rig_advance(ps_rig *r, uint64_t ns);
/** To be called after the firmware ran: brings moved outputs into the world. Returns true when they have
 * moved since the last call; r->moved_t is the moment. */
bool ps_rig_sync(ps_rig *r);
/** The same from inside: outputs have moved just now. */
void ps_rig_follow(ps_rig *r);
/** True while the contactor line, or any FET, is on. */
bool ps_rig_outputs_on(const ps_rig *r);
/** Current that flows at a moment through paths that stand as they do now, and what the load or charger asks
 * for. */
double ps_rig_current_at(const ps_rig *r, uint64_t t);
double ps_rig_asked_at(const ps_rig *r, uint64_t t);
/** To be passed to the back-end: the world moves while the bus is busy. `ctx` is the ps_rig. */
void ps_rig_advance_hook(void *ctx, uint64_t ns);
/** Carries out an event. */
void ps_rig_act(ps_rig *r, const ps_event *v);
/** Cell voltages in force at a moment; NULL when too long ago. */
const double *ps_rig_truth(const ps_rig *r, uint64_t t);
/** Errors on the link the firmware has counted, over all its lives. */
uint64_t ps_rig_bus_errors(const ps_rig *r);

#endif
