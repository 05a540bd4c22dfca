/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file emu_i2c_v1.h
 * What the two files of the I2C model of the STM32F4 share.
 */
#ifndef EMU_I2C_V1_H
#define EMU_I2C_V1_H

#include "emu_i2c.h"

enum {
    CR1 = 0x00,
    CR2 = 0x04,
    OAR1 = 0x08,
    OAR2 = 0x0c,
    DR = 0x10,
    SR1 = 0x14,
    SR2 = 0x18,
    CCR = 0x1c,
    TRISE = 0x20
};

enum { /* CR1 */
       PE = 1u << 0,
       START = 1u << 8,
       STOP = 1u << 9,
       ACK = 1u << 10,
       POS = 1u << 11,
       SWRST = 1u << 15,
       CR1_ALL = 0xbffbu,
       CR1_MODELLED = PE | START | STOP | ACK | POS | SWRST
};

enum { /* CR2 */
       ITERREN = 1u << 8,
       ITEVTEN = 1u << 9,
       ITBUFEN = 1u << 10,
       DMAEN = 1u << 11,
       CR2_ALL = 0x1f3fu
};

enum { /* SR1 */
       SB = 1u << 0,
       ADDR = 1u << 1,
       BTF = 1u << 2,
       RXNE = 1u << 6,
       TXE = 1u << 7,
       BERR = 1u << 8,
       ARLO = 1u << 9,
       AF = 1u << 10,
       SR1_ERRORS = 0xdf00u
};

enum { MSL = 1u << 0, BUSY = 1u << 1, TRA = 1u << 2 }; /* SR2 */

/* What the master does with the wires now; it ends at `due`. */
typedef enum emu_i2c_v1_job { NOTHING, STARTING, ADDRESSING, SENDING, RECEIVING, STOPPING } emu_i2c_v1_job;

typedef struct emu_i2c_v1 {
    uint32_t cr1, cr2, oar1, oar2, sr1, ccr, trise;
    uint8_t dr, shift;
    emu_i2c_v1_job doing;
    uint64_t due, not_before; /* not_before: a slave stretches the clock */
    bool master, transmits, connected;
    bool dr_full;     /* transmitter: a byte waits behind the shift register */
    bool shift_full;  /* receiver: a byte waits behind DR, the clock is held low */
    bool ack_latched; /* POS: what the byte under way will be answered */
    bool last_ack;    /* receiver: the last byte was acknowledged */
    bool refused;     /* NACK: only STOP or START help */
    bool sr1_read;    /* since SB or ADDR was set */
} emu_i2c_v1;

static inline emu_i2c_v1 *emu_i2c_v1_of(const emu_periph *p)
{
    return p->state;
}

/* emu_i2c_v1_wires.c: the master on the wires */
void emu_i2c_v1_signals(emu_periph *p);    /* interrupts and DMA requests */
void emu_i2c_v1_conditions(emu_periph *p); /* START or STOP was asked for and no byte is under way */
void emu_i2c_v1_send(emu_periph *p, uint8_t byte);
void emu_i2c_v1_send_address(emu_periph *p, uint8_t byte);
void emu_i2c_v1_receive(emu_periph *p);
void emu_i2c_v1_go_on_receiving(emu_periph *p);
void emu_i2c_v1_into_dr(emu_i2c_v1 *s); /* the byte leaves the shift register */
void emu_i2c_v1_release(emu_i2c_v1 *s);
void emu_i2c_v1_run(emu_periph *p);
uint64_t emu_i2c_v1_next(const emu_periph *p);

#endif
