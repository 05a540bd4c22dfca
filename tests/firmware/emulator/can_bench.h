/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file can_bench.h
 * bxCAN of either family, brought up by single register accesses.
 */
#ifndef CAN_BENCH_H
#define CAN_BENCH_H

#include "emu_can.h"
#include "outside.h"

#define CAN 0x40006400u
#define C_MCR (CAN + 0x000)
#define C_MSR (CAN + 0x004)
#define C_TSR (CAN + 0x008)
#define C_RF0R (CAN + 0x00c)
#define C_RF1R (CAN + 0x010)
#define C_IER (CAN + 0x014)
#define C_ESR (CAN + 0x018)
#define C_BTR (CAN + 0x01c)
#define C_TX(n, r) (CAN + 0x180u + 16u * (n) + (r))
#define C_RX(n, r) (CAN + 0x1b0u + 16u * (n) + (r))
#define C_FMR (CAN + 0x200)
#define C_FM1R (CAN + 0x204)
#define C_FS1R (CAN + 0x20c)
#define C_FFA1R (CAN + 0x214)
#define C_FA1R (CAN + 0x21c)
#define C_BANK(n, r) (CAN + 0x240u + 8u * (n) + 4u * (r))

/* 16 quanta: F4 16 MHz / 2, F0 8 MHz / 1 = 500 kbit/s: 2 us a bit */
#define SEGMENTS (12u << 16 | 1u << 20)
#define BIT_NS 2000u

extern bool f0; /* the chip is the STM32F072 */

/** The number of the interrupt that a finished transmission raises. */
unsigned tx_irq(void);
/** A new chip with clock and pins; the controller sleeps. */
void clocked(const emu_chip *which);
/** Initialisation entered, 500 kbit/s. */
void init_mode(void);
/** Initialisation left with these options of MCR. */
void normal_mode(uint32_t mcr);
/** Bank 0: 32 bits, mask, FIFO 0: ids 0x080..0x08f. */
void filter(void);
/** All of it. */
void ready(const emu_chip *which, uint32_t mcr);
/** The same for another chip in the middle of a test. */
void again(const emu_chip *which, uint32_t mcr);
/** A standard frame with the data 11 22 .. 88 into a mailbox. */
void send(unsigned mailbox, uint32_t id, unsigned length);
/** A frame from outside; true = acknowledged. */
bool hear(uint32_t id, bool extended);

#endif
