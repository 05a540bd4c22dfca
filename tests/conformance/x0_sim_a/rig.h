/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file rig.h
 * One bq769x0 under test, reached over its bus the way the requirements describe it. The CRC here is written
 * from X0-I2C-11, bit by bit, independent of the simulator's and of the driver's.
 */
#ifndef RIG_H
#define RIG_H

#include "sim_x0.h"
#include "unity.h"
#include <stdint.h>
#include <string.h>

#define MS 1000000ull
#define US 1000ull

typedef struct rig_part {
    const char *name;
    int inputs, address;
    bool crc;
    int ldo_mv;
} rig_part;

/** The fifteen parts as the VAR rows list them. */
extern const rig_part rig_parts[15];
extern sim_x0 chip;

uint8_t rig_crc(const uint8_t *bytes, size_t n);

/** A new part in SHIP, at time 0. NULL options = ideal. */
void rig_ship_with(const char *name, const sim_x0_options *options);
/** The same with a boot pulse of 3 ms at time 0. */
void rig_pulse_with(const char *name, const sim_x0_options *options);
#define rig_ship(name) rig_ship_with((name), NULL)
#define rig_pulse(name) rig_pulse_with((name), NULL)
/** Booted, and at the first publication (260, 410 or 810 ms). */
void rig_boot_with(const char *name, const sim_x0_options *options);
#define rig_boot(name) rig_boot_with((name), NULL)
/** Lets time pass up to this many milliseconds or microseconds after time 0. */
void rig_at(double ms);
void rig_wait(double ms);
/** Milliseconds from time 0 to NORMAL's first publication for the part at hand. */
unsigned rig_first_ms(void);

/** A complete write with CRC where the part has it; true when every byte was acknowledged. */
bool rig_block_write(int reg, const uint8_t *data, int n);
bool rig_write(int reg, int value);
/** A complete read; demands that every CRC is right. */
void rig_block_read(int reg, uint8_t *data, int n);
int rig_read(int reg);
/** High and low byte in one transaction. */
int rig_read16(int reg);
/** Whether the address is acknowledged. */
bool rig_answers(int address7);

/** Demands that SYS_STAT reads this. */
void rig_stat_at(int expected, int line);
#define expect_stat(expected) rig_stat_at((expected), __LINE__)
/** Demands that a register reads this. */
void rig_reg_at(int reg, int expected, int line);
#define expect_reg(reg, expected) rig_reg_at((reg), (expected), __LINE__)
/** Reads SYS_STAT and clears what it shows. */
void rig_clear(void);

/** Demands an empty book of misuse. */
void rig_clean_at(int line);
#define expect_clean() rig_clean_at(__LINE__)
/** Demands that the book holds this ID and nothing else, then clears it. */
void rig_misuse_at(const char *id, int line);
#define expect_misuse(id) rig_misuse_at((id), __LINE__)

/** Runs a check for each of the fifteen parts. */
void rig_each(void (*check)(const rig_part *part));

#endif
