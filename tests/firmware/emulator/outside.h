/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file outside.h
 * A chip without processor and a scripted world on its buses: tests play the firmware by single register
 * accesses and let time pass. Register addresses are written from the reference manuals.
 */
#ifndef OUTSIDE_H
#define OUTSIDE_H

#include "emu.h"
#include "unity.h"

#define US 1000ull
#define MS 1000000ull

typedef struct outside {
    /* I2C: the script and what was seen ("S10 W01 R41a P": START, write, read with a = acknowledged, STOP) */
    emu_i2c_answer address_answer, byte_answer;
    int refuse_at; /**< this written byte gets byte_answer, the others ACK; -1 = all ACK */
    unsigned held;
    uint64_t stretch_ns;
    uint8_t next_read;
    char log[400];
    unsigned written;
    /* SPI */
    emu_spi_frame frame[32];
    unsigned frames;
    bool miso_undriven; /**< reads ones */
    /* CAN */
    emu_can_result result;
    emu_can_wire wire;
    emu_can_frame sent[64];
    uint64_t sent_at[64];
    unsigned sents;
    /* ADC */
    double volts[19];
} outside;

extern outside out;
extern emu *chip;

/** A new chip at its reset clock (F0: 8 MHz, F4: 16 MHz) and a world that acknowledges everything. */
void outside_begin(const emu_chip *which);
void outside_end(void);

void put(uint32_t address, uint32_t value);
uint32_t get(uint32_t address);
void set_bits(uint32_t address, uint32_t bits);
void pass(uint64_t ns);
/** Pin of port 0 = A as alternate function (16 = analog). */
void pin_function(unsigned port, unsigned pin, unsigned af, bool open_drain);
/** Lets time pass in steps of `step_ns` until the bits of a register are all set; fails after 100 ms. Returns
 * the time it took. The register is read each step. */
uint64_t until(uint32_t address, uint32_t bits, uint64_t step_ns, int at);
#define UNTIL(address, bits) until((address), (bits), 1000, __LINE__)

/** Demands an empty book. */
void no_misuse_at(int at);
#define NO_MISUSE() no_misuse_at(__LINE__)
/** Demands that the book holds an entry of PERIPH.REG with this part in its text. */
void misuse_at(const char *periph, const char *reg, const char *text, int at);
#define MISUSE(periph, reg, text) misuse_at((periph), (reg), (text), __LINE__)
/** Level of an interrupt request, read from the pending bit in the NVIC. */
bool irq_pending(unsigned irq);
void irq_clear(unsigned irq);

#endif
