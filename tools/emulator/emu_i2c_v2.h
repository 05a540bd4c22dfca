/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file emu_i2c_v2.h
 * What the two files of the I2C model of the STM32F0 share.
 */
#ifndef EMU_I2C_V2_H
#define EMU_I2C_V2_H

#include "emu_i2c.h"

enum { /* CR1 */
       PE = 1u << 0,
       TXIE = 1u << 1,
       RXIE = 1u << 2,
       NACKIE = 1u << 4,
       STOPIE = 1u << 5,
       TCIE = 1u << 6,
       ERRIE = 1u << 7,
       DNF = 0xf00u,
       ANFOFF = 1u << 12,
       TXDMAEN = 1u << 14,
       RXDMAEN = 1u << 15,
       CR1_ALL = 0x00ffdfffu,
       CR1_MODELLED = PE | 0xfeu | DNF | ANFOFF | TXDMAEN | RXDMAEN
};

enum { /* CR2 */
       RD_WRN = 1u << 10,
       START = 1u << 13,
       STOP = 1u << 14,
       NBYTES = 0xffu << 16,
       RELOAD = 1u << 24,
       AUTOEND = 1u << 25,
       CR2_ALL = 0x07ffffffu,
       CR2_MODELLED = 0x3feu | RD_WRN | START | STOP | NBYTES | RELOAD | AUTOEND
};

enum { /* ISR */
       TXE = 1u << 0,
       TXIS = 1u << 1,
       RXNE = 1u << 2,
       NACKF = 1u << 4,
       STOPF = 1u << 5,
       TC = 1u << 6,
       TCR = 1u << 7,
       BERR = 1u << 8,
       ARLO = 1u << 9,
       TIMEOUT = 1u << 12,
       BUSY = 1u << 15,
       ISR_ERRORS = 0x3f00u
};

/* What the master does with the wires now; it ends at `due`. */
typedef enum emu_i2c_v2_job { NOTHING, STARTING, ADDRESSING, SENDING, RECEIVING, STOPPING } emu_i2c_v2_job;

typedef struct emu_i2c_v2 {
    uint32_t cr1, cr2, oar1, oar2, timingr, timeoutr, isr;
    uint8_t txdr, rxdr, shift;
    emu_i2c_v2_job doing;
    uint64_t due, not_before, low_since, disabled_at; /* not_before: a slave stretches the clock */
    bool master, connected;
    bool active;          /* between the acknowledged address and the end of the bytes */
    bool shift_full;      /* receiver: a byte waits behind RXDR, the clock is held low */
    bool pe_looked_at;    /* CR1 was read since PE was cleared */
    unsigned done, asked; /* bytes of this block: over, and asked for with TXIS */
} emu_i2c_v2;

static inline emu_i2c_v2 *emu_i2c_v2_of(const emu_periph *p)
{
    return p->state;
}

static inline unsigned emu_i2c_v2_nbytes(const emu_i2c_v2 *s)
{
    return s->cr2 >> 16 & 0xffu;
}

static inline bool emu_i2c_v2_reads(const emu_i2c_v2 *s)
{
    return (s->cr2 & RD_WRN) != 0;
}

/* emu_i2c_v2_wires.c: the master on the wires */
uint64_t emu_i2c_v2_scl_cycles(const emu_i2c_v2 *s);
void emu_i2c_v2_signals(emu_periph *p);    /* interrupts and DMA requests */
void emu_i2c_v2_conditions(emu_periph *p); /* START or STOP was asked for and no byte is under way */
void emu_i2c_v2_feed(emu_periph *p);       /* TXDR or the block has changed */
void emu_i2c_v2_take(emu_periph *p);       /* RXDR was read */
void emu_i2c_v2_next_block(emu_periph *p); /* NBYTES was written while TCR was set */
void emu_i2c_v2_release(emu_i2c_v2 *s);
void emu_i2c_v2_run(emu_periph *p);
uint64_t emu_i2c_v2_next(const emu_periph *p);

#endif
