/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Inside of the bq769x0 driver. Everything on the bus is a job that reads from top to bottom like the
 * procedure it carries out. Local variables do not survive a SEQ_ line; what must survive lives in the job's
 * frame or in the instance. The frames form a fixed stack in the instance.
 *
 * A job is named where it is begun or called and nowhere else, so a linker keeps only the jobs that something
 * in the program can begin. Base set: engine.c, transfer.c, configure.c, measure.c, readings.c,
 * sample.c, balance.c, outputs.c.
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
/* where in d->fresh and d->code, behind the cells: BAT, TS1.., and in d->fresh the coulomb counter */
#define X0_BAT 15u
#define X0_TS 16u
#define X0_CC 19u

/* Points of a job where it lets go of the processor. Each has a number of its own within the job; the
 * compiler refuses doubles. Point 0 is the beginning. */
#define SEQ_BEGIN(f)                                                                                         \
    switch ((f)->at) {                                                                                       \
    default:
#define SEQ_END                                                                                              \
    }                                                                                                        \
    return BQ_E_STATE
/* Goes on when what `start` started has ended. */
#define SEQ_YIELD(point, start)                                                                              \
    do {                                                                                                     \
        (start);                                                                                             \
        return (point);                                                                                      \
    case (point):;                                                                                           \
    } while (0)
/* Runs a child; its failure is the failure of this job too. */
#define SEQ_TRY(point, child) SEQ_YIELD(point, child)
/* Runs a child and goes on whatever came of it: d->result tells. */
#define SEQ_CALL(point, child)                                                                               \
    do {                                                                                                     \
        (child);                                                                                             \
        return (point) + X0_CATCHES;                                                                         \
    case (point):;                                                                                           \
    } while (0)
#define X0_CATCHES 0x80

/* engine.c */
bq_status x0_begin(bq769x0 *d, unsigned least_state, bq769x0_job job);
bq769x0_frame *x0_push(bq769x0 *d, bq769x0_job job, unsigned reg, unsigned n);
void x0_run(bq769x0 *d, bq769x0_job job);
void x0_wait(bq769x0 *d, uint32_t us);
void x0_tick(bq769x0 *d);
void x0_bump(uint32_t *counter);

/* transaction.c: one, as the frame of a transfer describes it */
#define X0_READING 0x80u /* in its n, beside the number of registers */
void x0_send(bq769x0 *d, const bq769x0_frame *f);
bq_status x0_judge(bq769x0 *d, const bq769x0_frame *f);

/* transfer.c: children of a job. Reads arrive in x0_data(), what is written lies in d->want. */
void x0_fetch(bq769x0 *d, unsigned reg, unsigned n);
void x0_put(bq769x0 *d, unsigned reg, unsigned n);
void x0_set(bq769x0 *d, unsigned reg, unsigned n); /* written, read back, compared */
void x0_fetch_stat(bq769x0 *d);
void x0_set_ctrl2(bq769x0 *d);
void x0_set_switches(bq769x0 *d);
bool x0_holds(bq769x0 *d, unsigned reg, unsigned n);
void x0_recover(bq769x0 *d);
int x0_job_transfer(bq769x0 *d, bq769x0_frame *f);
int x0_job_set(bq769x0 *d, bq769x0_frame *f);

/* configure.c */
int x0_job_configure(bq769x0 *d, bq769x0_frame *f);
int x0_job_agree(bq769x0 *d, bq769x0_frame *f);

/* init.c */
bq_status x0_init(bq769x0 *d, const bq769x0_config *config, uint16_t in_use, const bq_i2c *i2c,
                  const bq_clock *clock);
unsigned x0_bits(unsigned mask);

/* measure.c */
int x0_job_measure(bq769x0 *d, bq769x0_frame *f);
int x0_job_picture(bq769x0 *d, bq769x0_frame *f);
void x0_take_current(bq769x0 *d, uint16_t raw);
void x0_invalidate(bq769x0 *d, uint16_t fault);

/* readings.c */
uint32_t x0_cell_mv(const bq769x0 *d, unsigned input);
uint8_t x0_quality(const bq769x0 *d, bool measured, unsigned bad, bool doubtful);
void x0_read_cell(const bq769x0 *d, bq_cell_reading *c, unsigned input);
void x0_read_temp(const bq769x0 *d, bq_temp_reading *t, uint16_t code);

/* sample.c */
uint16_t x0_flags(unsigned events);

/* outputs.c */
unsigned x0_allowed(unsigned events);

/* balance.c */
unsigned x0_choose(const bq769x0 *d, unsigned asked);
void x0_balance(bq769x0 *d, unsigned cells);

/* beyond the base set */
void x0_once(bq769x0 *d, unsigned reg, unsigned n, bool reading);
void x0_drive(const bq769x0 *d, bq_line line, bool level);
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
