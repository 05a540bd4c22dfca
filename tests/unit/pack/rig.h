/* SPDX-License-Identifier: Apache-2.0 */
/* A pack of two modules of six cells and two sensors each, with limits that are easy to reckon with. */
#ifndef PACK_RIG_H
#define PACK_RIG_H

#include "bqhost/pack.h"

#define RIG_CELLS 12
#define RIG_SENSORS 4
#define RIG_MODULES 2
#define RIG_PERIOD 100u /* ms between scans */
#define RIG_AGE 5u      /* ms from conversion start to the step */

typedef struct rig {
    bq_pack p;
    bq_sample s;
    bq_cell_reading cells[RIG_CELLS];
    bq_temp_reading temps[RIG_SENSORS];
    bq_module_reading modules[RIG_MODULES];
    bq_pack_input in;
    bq_action a;
    uint32_t now_ms;
} rig;

bq_pack_config rig_config(void);

/* State init, every reading valid at 3700 mV and 25 C, monitor down, request off, time 0. */
void rig_init(rig *r, const bq_pack_config *c);
/* RIG_PERIOD passes, a new complete picture arrives, the pack steps. */
void rig_scan(rig *r);
/* `ms` pass without a new picture, the pack steps. */
void rig_idle(rig *r, uint32_t ms);
/* Scans until `ms` have passed (a multiple of RIG_PERIOD). */
void rig_run(rig *r, uint32_t ms);
/* Monitor up, self-test passed, scans until standby or on as the request says. */
void rig_standby(rig *r);
void rig_on(rig *r);
/* The module does not answer in the coming scans: readings marked, old values kept, age growing; or answers
 * again. */
void rig_lose(rig *r, uint8_t module);
void rig_find(rig *r, uint8_t module);
void rig_all_cells(rig *r, uint16_t mv);
void rig_all_temps(rig *r, int16_t dc);
int rig_active(const rig *r, bq_pack_fault f);
int rig_bleeding(const rig *r); /* cells in the mask */

#endif
