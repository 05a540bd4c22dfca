/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Inside of the bq769x0 driver. As in the bq76PL536 driver, everything on the bus is a job that reads from
 * top to bottom like the procedure it carries out; SEQ_... macros remember in its frame where it goes on.
 * Local variables do not survive a SEQ_ line. The frames form a fixed stack in the instance, called directly:
 * no recursion, no stored function pointer.
 */
#ifndef X0_INTERNAL_H
#define X0_INTERNAL_H

#include "bqhost/bq769x0.h"
#include "bqhost/bq769x0_regs.h"
#include "bqhost/seq.h"

enum { X0_IO_NONE, X0_IO_TRANSFER, X0_IO_WAIT };
enum { X0_STATE_NONE, X0_STATE_READY, X0_STATE_SHIP };

#define X0_TRIES 3u
#define X0_SCAN_MS 250u
#define X0_SCRUB_MS 1000u
#define X0_TEMP_MS 2250u /* until a temperature is of the source selected now (X0-SEQ-43) */
#define X0_WANTED 34u    /* where in d->data the other side of a comparison of up to six registers lies */

#define X0_JOBS(JOB)                                                                                         \
    JOB(READ, read)                                                                                          \
    JOB(WRITE, write)                                                                                        \
    JOB(AGREE, agree) JOB(CLEAR, clear) JOB(SET, set) JOB(START, start) JOB(BOOT, boot)                      \
        JOB(IDENTIFY, identify) JOB(PROBE_CRC, probe_crc) JOB(TRIM, trim) JOB(CONFIGURE, configure)          \
            JOB(FIRST, first) JOB(SCAN, scan) JOB(SCRUB, scrub) JOB(SERVICE, service) JOB(APPLY, apply)      \
                JOB(OFF, off) JOB(SWITCHES, switches) JOB(SHIP, ship) JOB(ONESHOT, oneshot)                  \
                    JOB(COMPARE, compare) JOB(PICTURE, picture) JOB(PAST, past) JOB(RELOAD, reload)          \
                        JOB(FIND, find)

enum x0_job {
#define JOB(NAME, name) X0_JOB_##NAME,
    X0_JOBS(JOB)
#undef JOB
        X0_JOB_COUNT
};
#define JOB(NAME, name) bq_status x0_job_##name(bq769x0 *d, bq769x0_frame *f);
X0_JOBS(JOB)
#undef JOB

#define SEQ_SEND(f, start) SEQ_YIELD(f, start)
#define SEQ_WAIT(d, f, us) SEQ_YIELD(f, x0_wait((d), (us)))
#define SEQ_CALL(d, f, job, reg, n) SEQ_YIELD(f, x0_push((d), (job), (reg), (n)))
#define SEQ_TRY(d, f, job, reg, n)                                                                           \
    do {                                                                                                     \
        SEQ_CALL(d, f, job, reg, n);                                                                         \
        if ((d)->result != BQ_OK) {                                                                          \
            return (d)->result;                                                                              \
        }                                                                                                    \
    } while (0)

bq_status x0_push(bq769x0 *d, uint8_t job, unsigned reg, unsigned n);
bq_status x0_wait(bq769x0 *d, uint32_t us);
bq_status x0_begin(bq769x0 *d, uint8_t job);
void x0_tick(bq769x0 *d);
void x0_bump(uint32_t *counter);

/* transfer.c: one transaction of n registers to or from d->data; d->transfer tells how it ended. */
bq_status x0_send_read(bq769x0 *d, unsigned reg, unsigned n);
bq_status x0_send_write(bq769x0 *d, unsigned reg, unsigned n);
bq_status x0_reply(bq769x0 *d);
void x0_recover(bq769x0 *d);
bool x0_same(unsigned reg, uint8_t read, uint8_t wanted);

/* start.c */
void x0_drive(const bq769x0 *d, bq_line line, bool level);
uint32_t x0_first_ms(const bq769x0 *d);

/* picture.c */
void x0_take_picture(bq769x0 *d, const uint8_t *block);
void x0_take_current(bq769x0 *d, const uint8_t *cc);
int32_t x0_cell_mv(const bq769x0 *d, unsigned input);
void x0_invalidate(bq769x0 *d, uint16_t fault);

/* the six configuration registers 0x06..0x0b as they should be */
void x0_image(const bq769x0 *d, uint8_t image[6]);

static inline uint8_t x0_groups(const bq769x0 *d)
{
    return (uint8_t)(d->config.inputs / 5u);
}

#endif
