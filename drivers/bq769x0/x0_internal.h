/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Inside of the bq769x0 driver. Everything on the bus is a job that reads from top to bottom like the
 * procedure it carries out. Local variables do not survive a SEQ_ line; what must survive lives in the job's
 * frame or in the instance. The frames form a fixed stack in the instance.
 *
 * A job is named where it is begun or called and nowhere else, so a linker keeps only the jobs that something
 * in the program can begin. Base set: engine.c, transfer.c, configure.c, measure.c, readings.c,
 * outputs.c, balance.c.
 */
#ifndef X0_INTERNAL_H
#define X0_INTERNAL_H

#include "bqhost/bq769x0.h"
#include "bqhost/bq769x0_regs.h"

enum { X0_STATE_NONE, X0_STATE_SHIP, X0_STATE_READY };

#define X0_TRIES 3u
#define X0_SCAN_MS 250u
#define X0_SCRUB_MS 1000u
#define X0_TEMP_MS 2250u /* until a temperature is of the source selected now (X0-SEQ-43) */
/* where in d->fresh, behind the inputs: BAT, TS1.., the coulomb counter */
#define X0_BAT 15u
#define X0_TS 16u
#define X0_CC 19u

/* What a job waits for beside the point where it goes on: a transfer of `n` registers from `reg` on. */
#define X0_CATCH 0x100 /* goes on whatever came of it: d->result tells */
#define X0_READ 0x200
#define X0_CHECK 0x400 /* written, read back, compared */
#define X0_ONCE 0x800  /* one try only */
#define X0_PUT(reg, n) ((int)((unsigned)(n) << 24 | (reg) << 16))
#define X0_FETCH(reg, n) (X0_PUT(reg, n) | X0_READ)
#define X0_SET(reg, n) (X0_PUT(reg, n) | X0_CHECK)
#define X0_FETCH_STAT X0_FETCH(BQ769X0_SYS_STAT, 1)
#define X0_SET_CTRL2 X0_SET(BQ769X0_SYS_CTRL2, 1)
#define X0_SET_SWITCHES(d) X0_SET(BQ769X0_CELLBAL1, (d)->known.groups)

/* Points of a job where it lets go of the processor. Each has a number of its own within the job; the
 * compiler refuses doubles. Point 0 is the beginning. */
#define SEQ_BEGIN(f)                                                                                         \
    switch ((f)->at) {                                                                                       \
    default:
#define SEQ_END                                                                                              \
    }                                                                                                        \
    return BQ_E_STATE
/* Goes on when the transfer, the child or the wait has ended; a failure is the failure of this job too. */
#define SEQ_TRY(point, what) SEQ_GO(point, (what) | (point))
#define SEQ_GO(point, next)                                                                                  \
    do {                                                                                                     \
        return next;                                                                                         \
    case (point):;                                                                                           \
    } while (0)
/* The same, and goes on whatever came of it: d->result tells. */
#define SEQ_CALL(point, what) SEQ_TRY(point, (what) | X0_CATCH)
/* The same with a job as the child. */
#define SEQ_RUN(point, child) SEQ_GO(point, x0_push(d, child, point))
#define SEQ_RUN_CALL(point, child) SEQ_GO(point, x0_push(d, child, (point) | X0_CATCH))

/* engine.c */
bq_status x0_begin(bq769x0 *d, unsigned least_state, bq769x0_job job);
int x0_push(bq769x0 *d, bq769x0_job job, int op);
void x0_pause(bq769x0 *d, uint32_t us);
void x0_tick(bq769x0 *d);
void x0_bump(uint32_t *counter);

/* transfer.c: reads arrive in x0_data(), what is written lies in d->known.registers. */
bool x0_holds(bq769x0 *d, unsigned reg, unsigned n);
void x0_recover(bq769x0 *d);
int x0_job_transfer(bq769x0 *d, bq769x0_frame *f);

/* configure.c */
int x0_job_configure(bq769x0 *d, bq769x0_frame *f);

/* measure.c */
int x0_job_measure(bq769x0 *d, bq769x0_frame *f);
int x0_job_picture(bq769x0 *d, bq769x0_frame *f);
void x0_take_current(bq769x0 *d, uint16_t raw);

/* outputs.c */
unsigned x0_allowed(unsigned events);
void x0_balance(bq769x0 *d, unsigned cells);
bq_status x0_begin_outputs(bq769x0 *d, unsigned fets, unsigned cells);

/* beyond the base set */
uint32_t x0_cell_mv(const bq769x0 *d, unsigned cell);
bq_status x0_known_of(const bq769x0_config *c, unsigned in_use, bq769x0_known *known,
                      bq769x0_current_limits *current);
bq769x0_trim x0_trim(const bq769x0 *d);
unsigned x0_bits(unsigned mask);
bool x0_like_new(const uint8_t *ctrl1);
void x0_rescale(bq769x0 *d);
void x0_configured(bq769x0 *d);
void x0_count_picture(bq769x0 *d);
void x0_drive(const bq769x0 *d, bool level);
uint32_t x0_first_ms(const bq769x0 *d);
void x0_count_charge(bq769x0 *d);
void x0_look_for_charge(bq769x0 *d);
void x0_die_reset(bq769x0 *d);
void x0_die_before_picture(bq769x0 *d);
void x0_die_after_picture(bq769x0 *d);
int x0_job_start(bq769x0 *d, bq769x0_frame *f);
int x0_job_boot(bq769x0 *d, bq769x0_frame *f);
int x0_job_scan(bq769x0 *d, bq769x0_frame *f);
int x0_job_oneshot(bq769x0 *d, bq769x0_frame *f);
int x0_job_service(bq769x0 *d, bq769x0_frame *f);
int x0_job_off(bq769x0 *d, bq769x0_frame *f);
int x0_job_compare(bq769x0 *d, bq769x0_frame *f);
int x0_job_scrub(bq769x0 *d, bq769x0_frame *f);
int x0_job_reload(bq769x0 *d, bq769x0_frame *f);
int x0_job_ship(bq769x0 *d, bq769x0_frame *f);
int x0_job_die(bq769x0 *d, bq769x0_frame *f);

#define X0_TURN_BITS 12u /* a set of cells is bled for 4.1 s, then another one */

/* Neighbours of these cells, whatever inputs are shorted between them (X0-CB-06). */
static inline unsigned x0_beside(unsigned cells, unsigned apart)
{
    return (cells << 1 & ~apart) | (cells & ~apart) >> 1;
}

/* A child of a job that is nothing but time. */
static inline int x0_wait(bq769x0 *d, uint32_t us)
{
    x0_pause(d, us);
    return 0;
}

static inline void x0_invalidate(bq769x0 *d, unsigned quality)
{
    d->quality = d->temp_quality = (uint8_t)quality;
}

static inline bool x0_valid(const bq769x0 *d)
{
    return d->quality == BQ_Q_VALID;
}

/* Events of SYS_STAT that stand: not released, or just read. */
static inline unsigned x0_events(const bq769x0 *d)
{
    return (unsigned)(d->held | d->stat) & BQ769X0_STAT_FAULTS;
}

/* The registers read last. */
static inline uint8_t *x0_data(bq769x0 *d)
{
    return d->bus + 2;
}

/* True once the clock has reached `ms`. */
static inline bool x0_reached(const bq769x0 *d, uint32_t ms)
{
    return (int32_t)(d->now_ms - ms) >= 0;
}

#endif
