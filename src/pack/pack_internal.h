/* SPDX-License-Identifier: Apache-2.0 */
/* What the files of the pack controller share; see include/bqhost/pack.h for the rules. */
#ifndef PACK_INTERNAL_H
#define PACK_INTERNAL_H

#include "bqhost/pack.h"
#include <stddef.h>

/* What is wrong with the readings of one module. */
#define BQ_MODULE_OLD 0x01u       /* older than comm_timeout_ms */
#define BQ_MODULE_SILENT 0x02u    /* no answer in the last update */
#define BQ_MODULE_NO_CELL 0x04u   /* a cell has no valid reading */
#define BQ_MODULE_NO_TEMP 0x08u   /* a sensor has no valid reading */
#define BQ_MODULE_DISCARDED 0x10u /* supply lockout: nothing it says counts (PL-UVLO-04) */

/* One look at the sample. Extremes cover values that may still decide; a number of 0 means there is none. */
typedef struct bq_picture {
    const bq_sample *s; /* NULL when there is none or its shape is not the configured one */
    const bq_pack_input *in;
    uint32_t dt_ms;                      /* since the step before */
    uint16_t open_cell;                  /* first cell next to an open wire */
    uint8_t any;                         /* BQ_MODULE_... of all modules */
    bool fresh;                          /* this step brought a new update */
    bool live;                           /* the monitor has been brought up: the sample may be judged */
    bool current_known;                  /* current_ma of the sample is measured and fresh */
    uint8_t module[BQ_PACK_MAX_MODULES]; /* BQ_MODULE_... */
} bq_picture;

/* What the readings of cells and of sensors have in common lies at the same places. */
static inline const bq_cell_reading *bq_reading(const bq_sample *s, bool sensor, unsigned i)
{
    return sensor ? (const bq_cell_reading *)(const void *)&s->temps[i] : &s->cells[i];
}

/* Whether a fault's cause is present now, and where. */
typedef struct bq_condition {
    bool broken;          /* present */
    bool clear;           /* of a limit: gone, hysteresis included */
    uint16_t debounce_ms; /* how long it must be present, of those that have none of the pack's */
    int32_t value;
    uint16_t cell;
    uint8_t device, sensor; /* no device: that of the cell or the sensor */
    int8_t wire;            /* + 1; 0 = none */
} bq_condition;

uint32_t bq_pack_add_ms(uint32_t a, uint32_t b); /* saturating */
/* Logs what happened in this step, the one at p->last_ms. */
void bq_pack_log(bq_pack *p, bq_pack_event_kind kind, unsigned code, unsigned where);

/* picture.c: advances ages, fills the picture, p->summary and p->blind_ms. */
void bq_pack_look(bq_pack *p, const bq_sample *s, bq_picture *v);

/* judge.c: fills c[BQ_FAULT_COUNT]. */
void bq_pack_judge(const bq_pack *p, const bq_picture *v, bq_condition *c);

/* faults.c: debounce, record, recover. */
void bq_pack_update_faults(bq_pack *p, const bq_picture *v, const bq_condition *c);
static inline bool bq_pack_limits_current(const bq_pack_config *k)
{
    return (k->charge_max_ma | k->discharge_max_ma) != 0;
}

#define BQ_DRIVES_CHARGE 1u
#define BQ_DRIVES_DISCHARGE 2u
uint8_t bq_pack_stopped(const bq_pack *p); /* the directions that active faults forbid */

/* balance.c: fills a->balance. */
void bq_pack_balance(bq_pack *p, const bq_picture *v, bq_action *a);

#endif
