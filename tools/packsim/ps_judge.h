/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file ps_judge.h
 * Judges the expectations of a scenario while it runs, from what is reported to it; it looks at nothing by
 * itself.
 */
#ifndef PS_JUDGE_H
#define PS_JUDGE_H

#include "ps_scenario.h"

#define PS_FAULTS_KEPT 64

/** What can be looked at at a given moment. */
typedef struct ps_view {
    int state;        /**< bq_pack_state_id */
    int found;        /**< modules the firmware has found */
    bool outputs_on;  /**< level of the contactor line */
    bool healthy;     /**< no fault active, all modules found, every value valid, standby or on */
    double spread_mv; /**< true highest minus lowest cell */
} ps_view;

/** What is known only at the end. */
typedef struct ps_totals {
    double measurement_mv; /**< worst; negative = nothing was measured */
    double soc_percent;    /**< worst; negative = the firmware had no state of charge */
    unsigned long misuse;
    double speed; /**< negative = nobody promised one: an image takes what the emulator takes */
} ps_totals;

typedef struct ps_fault_seen {
    uint64_t t;
    int id, cell, device, sensor;
} ps_fault_seen;

typedef struct ps_verdict {
    bool looked, decided, held;
    char got[96]; /**< what was found instead; empty when held */
} ps_verdict;

typedef struct ps_judge {
    const ps_scenario *s;
    ps_verdict verdict[PS_EXPECTS];
    uint64_t faults; /**< all, also those not kept */
    ps_fault_seen fault[PS_FAULTS_KEPT];
} ps_judge;

void ps_judge_init(ps_judge *j, const ps_scenario *s);
/** The next moment at which ps_judge_look() wants to be called; UINT64_MAX = none. */
uint64_t ps_judge_next(const ps_judge *j);
/** Looks at everything due by `t` and not looked at yet. */
void ps_judge_look(ps_judge *j, uint64_t t, const ps_view *view);
/** A fault became active. */
void ps_judge_fault(ps_judge *j, const ps_fault_seen *f);
/** The contactor line changed. */
void ps_judge_outputs(ps_judge *j, uint64_t t, bool on);
/** Decides the rest. */
void ps_judge_end(ps_judge *j, const ps_totals *totals);
int ps_judge_held(const ps_judge *j);

#endif
