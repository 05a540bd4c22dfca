/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file ps_mirror.h
 * What a firmware tells on CAN (bqhost/telemetry.h), put together to the picture that the native one shows by
 * itself, so that table, report, live view and judge read both alike.
 */
#ifndef PS_MIRROR_H
#define PS_MIRROR_H

#include "ps_rig.h"

/** One life of a firmware as it is seen from outside. */
typedef struct ps_mirror {
    bq_link_stats stats; /**< bus_errors is the sum of all kinds */
    uint8_t found;
    bool alive;                 /**< a heartbeat was heard */
    uint32_t uptime_ms;         /**< of the last heartbeat */
    uint32_t told;              /**< active faults by the last table, not yet by an event */
    uint32_t sequence, t_us;    /**< of the sample being put together */
    uint16_t mv[SIM_CELLS_MAX]; /**< likewise */
    int frames;                 /**< of it that have come in their order */
    uint32_t periods;           /**< control periods */
    uint64_t heard;             /**< frames */
    uint64_t unknown;           /**< frames that are in no table, or at the wrong moment */
} ps_mirror;

/** A new life: nothing known, state init. */
void ps_mirror_begin(ps_mirror *m, ps_rig *r);
/** One frame. `clock_us`: the clock of the firmware when it came; times of samples are turned into those of
 * the bench. */
void ps_mirror_hear(ps_mirror *m, ps_rig *r, uint32_t id, const uint8_t data[8], uint32_t clock_us);

#endif
