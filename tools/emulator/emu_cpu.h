/* SPDX-License-Identifier: Apache-2.0 */
/** @file emu_cpu.h
 * What the files of the processor share: decoder and engine. */
#ifndef EMU_CPU_H
#define EMU_CPU_H

#include "emu_internal.h"

/** What the engine has to know of an instruction before it runs. */
enum emu_insn {
    INSN_KNOWN = 1u,      /**< decoded; nothing else set: an ordinary instruction */
    INSN_WIDE = 2u,       /**< 32 bits */
    INSN_MASKS = 4u,      /**< may change what interrupts are let through: look afterwards */
    INSN_WFI = 8u,        /**< goes to sleep */
    INSN_HINT = 0x10u,    /**< WFE, SEV, YIELD: passed over */
    INSN_ILLEGAL = 0x20u, /**< not an instruction of this core */
    INSN_FPU = 0x40u,     /**< needs CPACR */
    INSN_STACK = 0x80u,   /**< lowers SP: measure afterwards */
    INSN_STRICT = 0x100u, /**< several words: never unaligned */
    INSN_IN_IT = 0x200u,  /**< conditional by an IT before it: no stop in front of it */
    INSN_MARK = 0x400u,   /**< the place of emu_mark() */
    INSN_IT_SHIFT = 12u   /**< bits 12..14: an IT instruction that covers so many */
};

/** Decodes from its first and second half-word. */
uint16_t emu_decode(bool m4, uint32_t first, uint32_t second);

#endif
