/* SPDX-License-Identifier: Apache-2.0 */
/* Which instructions need attention (ARMv6-M and ARMv7-M architecture reference manuals, instruction set
 * encodings). */
#include "emu_cpu.h"

static unsigned it_length(uint32_t mask)
{
    return (mask & 1u) != 0 ? 4 : (mask & 2u) != 0 ? 3 : (mask & 4u) != 0 ? 2 : 1;
}

static uint16_t hint(uint32_t op)
{
    switch (op) {
    case 0xbf30u:
        return INSN_WFI;
    case 0xbf10u: /* YIELD */
    case 0xbf20u: /* WFE */
    case 0xbf40u: /* SEV */
        return INSN_HINT;
    default:
        return 0;
    }
}

static uint16_t narrow(bool m4, uint32_t op)
{
    if ((op & 0xff00u) == 0xbf00u) {
        if ((op & 15u) == 0) {
            return hint(op);
        }
        return m4 ? (uint16_t)(it_length(op & 15u) << INSN_IT_SHIFT) : INSN_ILLEGAL;
    }
    if (op >= 0xe800u || (op & 0xff00u) == 0xde00u) {
        return INSN_ILLEGAL; /* permanently undefined */
    }
    if ((op & 0xffe8u) == 0xb660u) {
        return INSN_MASKS; /* CPSIE, CPSID */
    }
    if ((op & 0xfe00u) == 0xb400u) {
        return INSN_STACK; /* PUSH */
    }
    if ((op & 0xff80u) == 0xb080u) {
        return INSN_STACK; /* SUB SP, SP, #imm */
    }
    if ((op & 0xff87u) == 0x4485u || (op & 0xff87u) == 0x4685u) {
        return INSN_STACK; /* ADD SP, Rm; MOV SP, Rm */
    }
    if (!m4 && (op & 0xf500u) == 0xb100u) {
        return INSN_ILLEGAL; /* CBZ, CBNZ */
    }
    return (op & 0xf000u) == 0xc000u ? INSN_STRICT : 0; /* LDM, STM */
}

/* ARMv6-M has BL, MSR, MRS and the barriers only. */
static uint16_t wide_m0(uint32_t first, uint32_t second)
{
    if ((first & 0xf800u) == 0xf000u && (second & 0xd000u) == 0xd000u) {
        return 0; /* BL */
    }
    if ((first & 0xfff0u) == 0xf380u && (second & 0xff00u) == 0x8800u) {
        return INSN_MASKS | INSN_STACK; /* MSR */
    }
    if (first == 0xf3efu && (second & 0xf000u) == 0x8000u) {
        return 0; /* MRS */
    }
    if (first == 0xf3bfu && (second & 0xffc0u) == 0x8f40u) {
        return 0; /* DSB, DMB, ISB */
    }
    return INSN_ILLEGAL;
}

static uint16_t wide_m4(uint32_t first, uint32_t second)
{
    if ((first & 0xfff0u) == 0xf380u && (second & 0xff00u) == 0x8800u) {
        return INSN_MASKS | INSN_STACK; /* MSR */
    }
    if ((first & 0xec00u) == 0xec00u) { /* coprocessor: 10 and 11 are the FPU */
        return (second >> 9 & 7u) == 5u ? INSN_FPU | INSN_STACK : INSN_ILLEGAL;
    }
    if ((first & 0xfe40u) == 0xe840u) {
        return INSN_STRICT | INSN_STACK; /* LDRD, STRD, exclusive */
    }
    if ((first & 0xfe40u) == 0xe800u) {
        return INSN_STRICT | INSN_STACK; /* LDM, STM */
    }
    if ((first & 0xfbefu) == 0xf1adu || (first & 0xfbffu) == 0xf2adu || (first & 0xffefu) == 0xebadu) {
        return INSN_STACK; /* SUB SP, SP, ... */
    }
    return (first & 0xff0fu) == 0xf80du ? INSN_STACK : 0; /* STR Rt, [SP, #-imm]! */
}

uint16_t emu_decode(bool m4, uint32_t first, uint32_t second)
{
    uint16_t flags;

    if (first < 0xe800u) {
        return (uint16_t)(INSN_KNOWN | narrow(m4, first));
    }
    flags = m4 ? wide_m4(first, second) : wide_m0(first, second);
    return (uint16_t)(INSN_KNOWN | INSN_WIDE | flags);
}
