/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file telemetry.h
 * What the firmware tells on CAN. Standard frames of 8 bytes, identifiers from BQ_TELEMETRY_ID on, numbers
 * with the least significant byte first; docs/can.md shows the same as a table with examples.
 *
 *     +0 heartbeat     every period    u8 bq_pack_state_id; u8 bits 0 charge allowed, 1 discharge allowed,
 *                                      2 contactor line on, 3 picture complete, 4 self-test passed,
 *                                      5 request on; u8 bq_pack_cause(), 0xff = none; u8 number of active
 *                                      faults; u32 uptime in ms
 *     +1 pack          every period    u32 pack voltage in mV; i32 current in mA, positive charges
 *     +2 cells         every period    u16 lowest, u16 highest cell in mV; u16, u16 their numbers, 0 = none
 *     +3 temperatures  every period    i16 lowest, i16 highest in 0.1 C; i16 state of charge in permille,
 *                                      -1 = not valid; u16 cells balancing
 *     +4 faults        every period    u32 active faults, bit n = bq_pack_fault n; u8 modules found;
 *                                      i8 status of the last bring-up; u8 bq_reset_cause, bit 7 = a crash
 *                                      record is there; u8 age of the current in 10 ms, 255 = older or
 *                                      never measured
 *     +5 fault event   each event      u8 bq_pack_fault; u8 1 = became active, 0 = cleared; u16 cell;
 *                                      u8 device; u8 sensor (0 = none); i8 wire (-1 = none); u8 running
 *                                      number: a gap = events were lost
 *     +6 cell voltages each sample     u8 index; u8 low byte of the sample's sequence; 3 x u16 mV of the
 *                                      cells 3 x index + 1 and following, 0xffff = no valid value or no
 *                                      such cell
 *     +7 sample        each sample     u32 sequence; u32 clock in us at the conversion start; before its +6
 *     +8 counters      every period    u32 control periods begun; u32 link errors of all kinds
 *     +9 boot          at start, 5 s   u8 bq_reset_cause; u8 bits 0 crash, 1 crystal failed, 2 image ok;
 *                                      u16 kind and u32 program counter of the crash, 0 without
 *
 * Rules
 * - Content is made when the controller takes the frame, so it is never older than that. A controller without
 *   room postpones; what is still due when its next moment comes is sent once, with the newest values.
 * - Urgent first: boot, the frames of the period, fault events, then the sample.
 * - A new sample ends the output of the one before it, wherever that stands: the +6 frames of one sequence
 *   byte always belong to one conversion.
 * - Bus-off and a missing controller change nothing but that nothing is sent. Fault events wait, up to
 *   BQ_PACK_EVENTS entries of the pack's log.
 * - A firmware that refused its configuration sends heartbeat (state "fault", cause "config"), faults (with
 *   the reason as the status) and boot, every 100 ms.
 */
#ifndef BQHOST_TELEMETRY_H
#define BQHOST_TELEMETRY_H

#include "bqhost/app.h"
#include "bqhost/hal.h"

#ifdef __cplusplus
extern "C" {
#endif

#define BQ_TELEMETRY_ID 0x100u
#define BQ_TELEMETRY_FRAMES 3u /**< most frames handed to the controller in one pass */
#define BQ_TELEMETRY_BOOT_MS 5000u
#define BQ_TELEMETRY_BUSY_US 500u  /**< the controller had no room: the next try */
#define BQ_TELEMETRY_OFF_US 20000u /**< bus-off: the next try */

typedef enum bq_telemetry_id {
    BQ_FRAME_HEARTBEAT,
    BQ_FRAME_PACK,
    BQ_FRAME_CELLS,
    BQ_FRAME_TEMPERATURES,
    BQ_FRAME_FAULTS,
    BQ_FRAME_EVENT,
    BQ_FRAME_VOLTAGES,
    BQ_FRAME_SAMPLE,
    BQ_FRAME_COUNTERS,
    BQ_FRAME_BOOT
} bq_telemetry_id;

/** What is told. Owned by the caller, read in each step. */
typedef struct bq_telemetry_source {
    const bq_app *app;   /**< NULL = the configuration was refused */
    const bq_boot *boot; /**< NULL = nothing known */
    bq_status refused;   /**< why, without app */
    uint32_t now_ms;     /**< since start; bq_app_now_ms() where there is an app */
    uint32_t period_ms;
} bq_telemetry_source;

/** One sender. Caller-owned; read the counters, write nothing. */
typedef struct bq_telemetry {
    uint32_t sent;    /**< frames taken by the controller */
    uint32_t busy;    /**< attempts that found no room or bus-off */
    uint32_t refused; /**< frames the controller called wrong; they are dropped */
    /* private */
    uint32_t due; /* bit n = bq_telemetry_id n */
    uint8_t running;
    bool started, have_sample;
    uint32_t index;
    uint32_t period_ms, boot_ms; /* when they were due last */
    uint32_t sequence, events;
    bq_can can;
} bq_telemetry;

/** Everything of the first period is due. `can->ops` NULL, or `can` NULL: no controller, nothing is ever
 *  sent. `can` is copied. */
void bq_telemetry_init(bq_telemetry *t, const bq_can *can);

/**
 * One pass: hands at most BQ_TELEMETRY_FRAMES frames to the controller and returns. The result is the time in
 * us until the next call is of use: 0 = at once, there is more to send and room for it. Never blocks.
 */
uint32_t bq_telemetry_step(bq_telemetry *t, const bq_telemetry_source *source);

/** Fills the frame `id` from the source, +6 for the given index, +5 for the pack's event of that number.
 *  False: there is nothing to tell (no app, no such cell, not an event of a fault). */
bool bq_telemetry_frame(const bq_telemetry_source *source, bq_telemetry_id id, uint32_t index,
                        bq_can_frame *frame);

#ifdef __cplusplus
}
#endif
#endif
