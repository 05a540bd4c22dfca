/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file ps_wires.h
 * Boards on the bench: what hangs on which pin of the emulated microcontroller, from the pin tables of
 * docs/boards.md and from nothing of hal/.
 */
#ifndef PS_WIRES_H
#define PS_WIRES_H

#include "emu.h"
#include "ps_rig.h"

/** A board: its chip, the memory of its settings, and its wires. `world` has the callbacks of the buses, with
 * the ps_rig as context; those of pins, time, CAN and console are the bench's. */
typedef struct ps_wires {
    const char *board;
    const emu_chip *chip;
    bool stack;           /**< carries a stack of bq76PL536, otherwise a bq769x0 */
    uint32_t settings_at; /**< first address of the first sector */
    const emu_world *world;
    int (*level)(ps_rig *r, unsigned port, unsigned pin); /**< that the outside puts on it; -1 = none */
    void (*drive)(ps_rig *r, unsigned port, unsigned pin, bool high);
    uint64_t (*next)(const ps_rig *r); /**< ns until a pin may move by itself; UINT64_MAX = never */
} ps_wires;

extern const ps_wires ps_lv_f072, ps_hv_f405;

#endif
