/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file emu_can_internal.h
 * What the files of the bxCAN model share (RM0091 chapter 29, RM0090 chapter 32).
 */
#ifndef EMU_CAN_INTERNAL_H
#define EMU_CAN_INTERNAL_H

#include "emu_can.h"

#define EMU_CAN_MAILBOXES 3u
#define EMU_CAN_DEPTH 3u
#define EMU_CAN_BANKS 28u

enum { /* MCR */
       INRQ = 1u << 0,
       SLEEP = 1u << 1,
       TXFP = 1u << 2,
       RFLM = 1u << 3,
       NART = 1u << 4,
       AWUM = 1u << 5,
       ABOM = 1u << 6,
       TTCM = 1u << 7,
       MCR_RESET = 1u << 15,
       DBF = 1u << 16,
       MCR_ALL = 0x000180ffu
};

enum { INAK = 1u << 0, SLAK = 1u << 1, ERRI = 1u << 2, WKUI = 1u << 3, SLAKI = 1u << 4 }; /* MSR */

enum { RQCP = 1u << 0, TXOK = 1u << 1, ALST = 1u << 2, TERR = 1u << 3, ABRQ = 1u << 7 }; /* TSR, mailbox 0 */

enum { FULL = 1u << 3, FOVR = 1u << 4, RFOM = 1u << 5 }; /* RFxR */

enum { /* IER */
       TMEIE = 1u << 0,
       EWGIE = 1u << 8,
       EPVIE = 1u << 9,
       BOFIE = 1u << 10,
       LECIE = 1u << 11,
       ERRIE = 1u << 15,
       WKUIE = 1u << 16,
       SLKIE = 1u << 17,
       IER_ALL = 0x00038f7fu
};

enum { LBKM = 1u << 30, BTR_ALL = 0x437f03ffu }; /* BTR; SILM is bit 31 */
#define EMU_CAN_SILM 0x80000000u

typedef enum emu_can_error {
    LEC_NONE,
    LEC_STUFF,
    LEC_FORM,
    LEC_ACK,
    LEC_RECESSIVE,
    LEC_DOMINANT,
    LEC_CRC
} emu_can_error;

typedef struct emu_can_mailbox {
    uint32_t ir, dtr, dlr, dhr;
    uint32_t status; /* RQCP .. ABRQ */
    bool pending;
    uint32_t order; /* of request */
} emu_can_mailbox;

typedef struct emu_can_fifo {
    struct {
        uint32_t ir, dtr, dlr, dhr;
    } message[EMU_CAN_DEPTH];
    unsigned count;
    bool full, overrun;
} emu_can_fifo;

typedef struct emu_can {
    uint32_t mcr, msr, ier, btr;
    uint32_t fmr, fm1r, fs1r, ffa1r, fa1r, bank[EMU_CAN_BANKS][2];
    emu_can_mailbox mb[EMU_CAN_MAILBOXES];
    emu_can_fifo fifo[2];
    unsigned tec, rec, lec;
    bool bus_off, recovering; /* recovering: counts its 128 times 11 recessive bits */
    bool warned, passive;     /* what ERRI has told */
    int sending;              /* mailbox on the wire; -1 = none */
    uint32_t orders;
    uint64_t sent_at;   /* the frame on the wire ends */
    uint64_t wire_free; /* the next frame may begin */
    uint64_t
        synced_at; /* leaving initialisation or sleep: 11 recessive bits seen; EMU_NEVER = not under way */
    uint64_t recovered_at;
} emu_can;

static inline emu_can *emu_can_of(const emu_periph *p)
{
    return p->state;
}

/* emu_can_wire.c: time, transmission, errors */
uint64_t emu_can_bits_ns(const emu_periph *p, uint64_t bits);
bool emu_can_takes_part(const emu_can *s);
bool emu_can_dominant(emu_periph *p);
uint32_t emu_can_rank(const emu_can *s, const emu_can_mailbox *m); /* lower = sent first */
void emu_can_schedule(emu_periph *p);
void emu_can_error_seen(emu_periph *p, emu_can_error what);
void emu_can_start_recovery(emu_periph *p);
void emu_can_run(emu_periph *p);
uint64_t emu_can_next(const emu_periph *p);

/* emu_can_rx.c: filters and FIFOs */
bool emu_can_in_frame(emu_periph *p, const emu_can_frame *frame);
bool emu_can_store(emu_periph *p, const emu_can_frame *frame);
uint32_t emu_can_fifo_status(const emu_can *s, unsigned n);
void emu_can_fifo_write(emu_periph *p, unsigned n, uint32_t value);
uint32_t emu_can_fifo_read(emu_periph *p, unsigned n, uint32_t offset);
uint32_t emu_can_filter_read(emu_periph *p, uint32_t offset);
void emu_can_filter_write(emu_periph *p, uint32_t offset, uint32_t value);

/* emu_can.c: registers, modes and interrupts */
void emu_can_signals(emu_periph *p);
void emu_can_modes(emu_periph *p); /* requests that the end of a frame allows */

#endif
