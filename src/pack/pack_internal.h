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
    const bq_sample *s;                  /* NULL when there is none or its shape is not the configured one */
    uint8_t module[BQ_PACK_MAX_MODULES]; /* BQ_MODULE_... */
    uint16_t open_cell;                  /* first cell next to an open wire */
    bool untrusted;     /* some module is old or discarded: its valid readings do not count */
    bool fresh;         /* this step brought a new update */
    bool live;          /* the monitor has been brought up: the sample may be judged */
    bool current_known; /* current_ma of the sample is measured and fresh */
} bq_picture;

/* Whether a fault's cause is present now, and where. */
typedef struct bq_condition {
    bool broken;          /* present */
    bool clear;           /* gone, hysteresis included */
    uint16_t debounce_ms; /* how long it must be present */
    int32_t value;
    uint16_t cell;
    uint8_t device, sensor;
    int8_t wire;
} bq_condition;

uint32_t bq_pack_add_ms(uint32_t a, uint32_t b); /* saturating */
void bq_pack_log(bq_pack *p, uint32_t now_ms, bq_pack_event_kind kind, uint8_t code, uint16_t where);

/* picture.c: advances ages by dt_ms, fills the picture, p->summary and p->blind_ms. */
void bq_pack_look(bq_pack *p, const bq_sample *s, const bq_pack_input *in, uint32_t dt_ms, bq_picture *v);

/* judge.c: fills c[BQ_FAULT_COUNT]. */
void bq_pack_judge(const bq_pack *p, const bq_picture *v, const bq_pack_input *in, bq_condition *c);

/* faults.c: debounce, record, recover. */
void bq_pack_update_faults(bq_pack *p, const bq_picture *v, const bq_pack_input *in, const bq_condition *c,
                           uint32_t now_ms, uint32_t dt_ms);
static inline bool bq_pack_limits_current(const bq_pack_config *k)
{
    return (k->charge_max_ma | k->discharge_max_ma) != 0;
}

bool bq_pack_stops(const bq_pack *p, bool charge); /* an active fault forbids this direction */
bool bq_pack_pending(const bq_pack *p);            /* some cause is present */

/* balance.c: fills a->balance. */
void bq_pack_balance(bq_pack *p, const bq_picture *v, const bq_pack_input *in, uint32_t dt_ms, bq_action *a);

#endif
