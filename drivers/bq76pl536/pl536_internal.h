/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Inside of the bq76PL536 driver.
 *
 * Everything the driver does on the bus is a job. A job is a function that is called again and again; SEQ_...
 * macros remember in its frame where it goes on, so that it reads from top to bottom like the procedure it
 * carries out. A job lets go of the processor at three kinds of points: a packet was started (SEQ_SEND), a
 * time must pass (SEQ_WAIT), or a child job runs (SEQ_CALL). Local variables do not survive these points;
 * what must survive lives in the frame. The frames form a fixed stack in the instance; pl_step() calls the
 * job of the top frame directly, so there is neither recursion nor a stored function pointer, and a job never
 * runs inside another one.
 */
#ifndef PL536_INTERNAL_H
#define PL536_INTERNAL_H

#include "bqhost/bq76pl536.h"
#include "bqhost/bq76pl536_packet.h"
#include "bqhost/bq76pl536_regs.h"
#include "bqhost/seq.h"

enum { PL_IO_NONE, PL_IO_TRANSFER, PL_IO_WAIT };
enum { PL_STATE_NONE, PL_STATE_READY, PL_STATE_ASLEEP };

/* bq76pl536_device.flags */
#define PL_DEV_VALID 0x01u     /* readings of the last update count */
#define PL_DEV_MEASURED 0x02u  /* was measured at least once */
#define PL_DEV_SERVICE 0x04u   /* its status asks for service */
#define PL_DEV_LOCKED 0x08u    /* a conversion did not end */
#define PL_DEV_CB_WRONG 0x10u  /* its outputs were on while it was measured */
#define PL_DEV_DEFECTIVE 0x20u /* a reset did not cure it: a link only */
#define PL_DEV_TSD 0x40u       /* shut down by heat, or asleep because of it */
#define PL_DEV_CB_TIME 0x80u   /* CB_TIME holds the configured period */
#define PL_DEV_WARMING 0x100u  /* conversions before ready_ms do not count */

/* Events of one picture: cleared when the next update begins. */
#define PL_EVENTS (BQ_F_RESET | BQ_F_CONFIG | BQ_F_LOCKUP | BQ_F_BALANCE)

#define PL_TRIES 3u
#define PL_SUPPLY_MIN_MV 7200u      /* PL-ELEC-01 */
#define PL_RESET_US 1000u           /* PL-POR-09 */
#define PL_POWER_UP_MS 70u          /* PL-SEQ-01-02 */
#define PL_FIRST_CONVERSION_MS 120u /* PL-SEQ-01-05 */
#define PL_WARM_UP_MS 50u           /* PL-ADC-19 */
#define PL_ADC_ON_US 1100u          /* PL-TIM-16: more than 1 ms */
#define PL_WAKE_US 1000u            /* PL-SEQ-11-05 */
#define PL_PROBE_MS 70u             /* PL-SEQ-13-03: a reset time between two looks at a lost device */
#define PL_TSD_MS 1000u             /* PL-SEQ-15-03 */
#define PL_POWER_OFF_US 200000u     /* supply off when the board can cycle it */

/* clang-format off */
/* Every job: PL_JOB_<NAME> is its number, pl_job_<name>() its function. */
#define PL_JOBS(JOB) \
    JOB(READ, read) JOB(WRITE, write) JOB(COMMAND, command) JOB(SHADOW, shadow) JOB(CLEAR, clear) \
    JOB(START, start) JOB(COLD, cold) JOB(WARM, warm) JOB(WARM_DEVICE, warm_device) \
    JOB(BRINGUP, bringup) JOB(DISCOVER, discover) JOB(HEIGHT, height) JOB(ASSIGN, assign) \
    JOB(VALIDATE, validate) JOB(CRC_OFF_PASS, crc_off_pass) \
    JOB(CONFIGURE, configure) JOB(BROADCAST, broadcast) JOB(ESTABLISH, establish) \
    JOB(ACKNOWLEDGE, acknowledge) JOB(LINES, lines) JOB(SCAN, scan) JOB(CONVERT, convert) \
    JOB(READ_IN, read_in) JOB(REMEASURE, remeasure) JOB(AFTERCARE, aftercare) JOB(SWEEP, sweep) \
    JOB(SERVICE, service) JOB(MEMORY, memory) JOB(COOLED, cooled) JOB(RESET_DEVICE, reset_device) \
    JOB(RELOCATE, relocate) JOB(ADOPT, adopt) JOB(SELF_TEST, self_test) JOB(CHAIN, chain) \
    JOB(APPLY, apply) JOB(CB_ON, cb_on) JOB(CB_OFF, cb_off) JOB(CB_PAUSE, cb_pause) JOB(SLEEP, sleep) \
    JOB(WAKE, wake) JOB(WIRE_TEST, wire_test) JOB(WIRE_CELL, wire_cell) JOB(RECONFIGURE, reconfigure) \
    JOB(OTP, otp) JOB(OTP_BURN, otp_burn) \
    JOB(FRAMING, framing) JOB(ARRIVAL, arrival)

enum pl_job {
#define JOB(NAME, name) PL_JOB_##NAME,
    PL_JOBS(JOB)
#undef JOB
    PL_JOB_COUNT
};
/* clang-format on */

#define JOB(NAME, name) bq_status pl_job_##name(bq76pl536 *d, bq76pl536_frame *f);
PL_JOBS(JOB)
#undef JOB

/* Starts a packet; afterwards d->transfer tells how it ended. */
#define SEQ_SEND(f, start) SEQ_YIELD(f, start)
/* Lets `us` microseconds pass. */
#define SEQ_WAIT(d, f, us) SEQ_YIELD(f, pl_wait((d), (us)))
/* Runs a child; afterwards d->result is its status and, after a read, pl_data(d) what was read. */
#define SEQ_CALL(d, f, job, dev, reg, val) SEQ_YIELD(f, pl_push((d), (job), (dev), (reg), (val)))
/* The same; the job ends with the status of a child that failed. */
#define SEQ_TRY(d, f, job, dev, reg, val)                                                                    \
    do {                                                                                                     \
        SEQ_CALL(d, f, job, dev, reg, val);                                                                  \
        if ((d)->result != BQ_OK) {                                                                          \
            return (d)->result;                                                                              \
        }                                                                                                    \
    } while (0)

/* ---- engine: seq.c ---- */
bq_status pl_push(bq76pl536 *d, uint8_t job, unsigned dev, unsigned reg, unsigned val);
bq_status pl_wait(bq76pl536 *d, uint32_t us);
/* One packet; always BQ_PENDING, a refusal of the back-end shows in d->transfer. */
bq_status pl_send_read(bq76pl536 *d, unsigned dev, unsigned reg, unsigned count);
bq_status pl_send_write(bq76pl536 *d, unsigned dev, unsigned reg, unsigned val);
bq_status pl_send_raw(bq76pl536 *d, size_t length);
/* Judges the packet that ended last, a read; pl_reply() counts what is wrong with it. */
bq_status pl_answer(const bq76pl536 *d);
bq_status pl_reply(bq76pl536 *d);
bq_status pl_begin(bq76pl536 *d, uint8_t job, unsigned dev);
void pl_tick(bq76pl536 *d);

static inline const uint8_t *pl_data(const bq76pl536 *d)
{
    return d->rx + d->data;
}

static inline bq76pl536_device *pl_dev(bq76pl536 *d, unsigned n)
{
    return &d->devices[n - 1u];
}

/* ---- what the configuration means in registers: image.c ---- */
uint8_t pl_cells(const bq76pl536 *d, unsigned n);
uint8_t pl_image(const bq76pl536 *d, unsigned n, unsigned reg); /* group 3 */
uint8_t pl_adc_control(const bq76pl536 *d, unsigned n);
uint8_t pl_io_control(const bq76pl536 *d);
bool pl_uniform(const bq76pl536 *d);           /* every device has the same number of cells */
uint32_t pl_conversion_us(const bq76pl536 *d); /* worst case of the largest device */
uint32_t pl_longest_delay_us(const bq76pl536 *d);
uint32_t pl_settle_us(const bq76pl536 *d); /* thermistors */

/* ---- lines: seq.c ---- */
bool pl_line(const bq76pl536 *d, bq_line line, bool *level); /* false: the board does not have it */
void pl_drive(const bq76pl536 *d, bq_line line, bool level);

/* ---- readings: burst.c ---- */
/* Judges and takes over a burst of device n from a conversion at `t_ms`; a status other than BQ_OK left
 * everything alone. BQ_E_LOCKED_UP: the conversion has not ended. BQ_OK does not mean that the readings
 * count: PL_DEV_VALID says so. */
bq_status pl_take_burst(bq76pl536 *d, unsigned n, uint32_t t_ms);
void pl_invalidate(bq76pl536_device *dev, uint8_t why, uint16_t fault);
void pl_invalidate_from(bq76pl536 *d, unsigned first, uint8_t why, uint16_t fault);
/* Brick against sum and neighbours against their last good values; returns the sense wires that look open.
 * wires.c */
uint8_t pl_suspect_wires(const bq76pl536 *d, unsigned n, const uint16_t *mv);
bool pl_valid(const bq76pl536 *d, unsigned n);
bool pl_may_balance(const bq76pl536 *d, unsigned n);

#endif
