/* SPDX-License-Identifier: Apache-2.0 */
/** @file emu_engine.h
 * Between the processor's rules (emu_cpu.c) and the engine that executes instructions (emu_unicorn.c). */
#ifndef EMU_ENGINE_H
#define EMU_ENGINE_H

#include "emu_cpu.h"

/** Registers by name, beside 0..12. */
enum {
    ENGINE_SP = 13,
    ENGINE_LR = 14,
    ENGINE_PC = 15,
    ENGINE_PSR = 16,
    ENGINE_FLAGS,
    ENGINE_IPSR,
    ENGINE_PRIMASK,
    ENGINE_BASEPRI,
    ENGINE_FAULTMASK,
    ENGINE_CONTROL
};

/** Why the engine left a run of instructions. */
enum engine_why {
    WHY_NOTHING,
    WHY_ATTENTION, /**< an event, an interrupt, a reset, the end of the time asked for */
    WHY_SLEEP,     /**< WFI */
    WHY_HINT,
    WHY_LEAVE, /**< return from an exception */
    WHY_CALL,  /**< SVC */
    WHY_BREAK, /**< BKPT, no debugger */
    WHY_UNDEFINED,
    WHY_STATE,  /**< not Thumb */
    WHY_RETURN, /**< forbidden EXC_RETURN */
    WHY_NO_COPROCESSOR,
    WHY_UNALIGNED,
    WHY_BUS,   /**< data access to nowhere */
    WHY_FETCH, /**< instruction from nowhere */
    WHY_STACK  /**< frame cannot be stored */
};

typedef struct emu_cpu {
    emu *e;
    void *uc;
    uint16_t *flags; /**< of each half-word of flash, see enum emu_insn */
    uint64_t *count; /**< how often executed; NULL = not counted */
    uint32_t code_base, code_words;
    uint64_t until_ns;
    enum engine_why why;
    uint32_t fault_address;
    bool look_at_stack, asleep, code_dirty, thumb_lost;
    uint32_t dirty_from, dirty_to;
    uint32_t fpu[EMU_DEPTH][17];
    bool fpu_saved[EMU_DEPTH];
} emu_cpu;

static inline const uint8_t *e_flash(const emu *e)
{
    return e->memory[0];
}

/* ---- the engine ---- */
uint32_t engine_get(emu_cpu *c, unsigned reg);
void engine_set(emu_cpu *c, unsigned reg, uint32_t value);
void engine_fpu(emu_cpu *c, uint32_t s[17], bool save);
void engine_run(emu_cpu *c);  /**< instructions until something ends the run */
void engine_halt(emu_cpu *c); /**< from inside a run */
int engine_priority(emu_cpu *c);
unsigned engine_pick(emu_cpu *c);

/* ---- the rules ---- */
bool engine_step(emu_cpu *c, uint32_t address); /**< before an instruction; false = it does not run */
void engine_access(emu_cpu *c, bool write, uint32_t address, unsigned bytes, uint32_t value);
void engine_fault(emu_cpu *c, enum engine_why why, uint32_t address);
void engine_raise(emu_cpu *c, enum engine_why why, uint32_t address);
void engine_handle(emu_cpu *c);
void engine_take(emu_cpu *c);
void engine_skip(emu_cpu *c); /**< over a 16-bit instruction */
void engine_sleep(emu_cpu *c);

#endif
