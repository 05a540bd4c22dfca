/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file rig_reg.h
 * What the register rows have in common: one check per kind of register, each on a fresh stack.
 */
#ifndef RIG_REG_H
#define RIG_REG_H

#include "rig.h"

/** Every value written leaves it as it is, raises no flag, and counts as misuse. */
void read_only(int reg);
/** Reads 0 with and without the key; a write counts as misuse. */
void reserved(int first, int last);
/** A result: zero after reset, two bytes, bits 15..14 zero at full scale, read-only; `full` drives its input.
 */
void result(int reg, void (*full)(void));
void all_cells_full(void);
void gpai_full(void);
void sensors_full(void);
/** Keeps the bits of `mask`, shows `live` besides and is `reset` after a reset; group 3 goes through the key.
 */
void read_write(int reg, int mask, int live, int reset);
/** A reserved bit (0 in `mask`) written as 1 is misuse. */
void reserved_bits(int reg, int mask);

#endif
