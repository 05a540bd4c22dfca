/* SPDX-License-Identifier: Apache-2.0 */
/** @file snippets.h
 * Machine code for the processor tests, with its assembly beside it; Thumb, little endian. */
#ifndef SNIPPETS_H
#define SNIPPETS_H

#include <stdint.h>

/* 1 + 100 * 2 instructions, then for ever 1 */
static const uint16_t code_count[] = {
    0x2064, /* movs r0, #100 */
    0x3801, /* subs r0, #1 */
    0xd1fd, /* bne.n 2 */
    0xe7fe, /* b.n 6 */
};

/* sleeps for ever; r4 counts */
static const uint16_t code_sleep[] = {
    0x2400, /* movs r4, #0 */
    0xbf30, /* wfi */
    0x3401, /* adds r4, #1 */
    0xe7fc, /* b.n 2 */
};

/* r4 counts wake-ups under PRIMASK; then lets the interrupt in */
static const uint16_t code_masked_sleep[] = {
    0x2400, /* movs r4, #0 */
    0xb672, /* cpsid i */
    0xbf30, /* wfi */
    0x3401, /* adds r4, #1 */
    0xbf30, /* wfi */
    0x3401, /* adds r4, #1 */
    0xb662, /* cpsie i */
    0x3410, /* adds r4, #16 */
    0xe7fe, /* b.n 10 */
};

/* r5 (kept by nobody else) counts */
static const uint16_t handler_count[] = {
    0x3501, /* adds r5, #1 */
    0x4770, /* bx lr */
};

/* a handler with a frame: calls nothing, marks r6 */
static const uint16_t handler_stack[] = {
    0xb510, /* push {r4, lr} */
    0xb08a, /* sub sp, #40 */
    0x3601, /* adds r6, #1 */
    0xb00a, /* add sp, #40 */
    0xbd10, /* pop {r4, pc} */
};

/* crash handler: frame's PC and xPSR to 20000100, then SYSRESETREQ */
static const uint16_t handler_save[] = {
    0x4668,         /* mov r0, sp */
    0x4905,         /* ldr r1, [pc, #20] */
    0x6982,         /* ldr r2, [r0, #24] */
    0x600a,         /* str r2, [r1, #0] */
    0x69c2,         /* ldr r2, [r0, #28] */
    0x604a,         /* str r2, [r1, #4] */
    0x6802,         /* ldr r2, [r0, #0] */
    0x608a,         /* str r2, [r1, #8] */
    0x4902,         /* ldr r1, [pc, #8] */
    0x4a03,         /* ldr r2, [pc, #12] */
    0x600a,         /* str r2, [r1, #0] */
    0xe7fe,         /* b.n 16 */
    0x0100, 0x2000, /* .word 0x20000100 */
    0xed0c, 0xe000, /* .word 0xe000ed0c */
    0x0004, 0x05fa, /* .word 0x05fa0004 */
};

/* load from nowhere at offset 6 */
static const uint16_t code_bad_read[] = {
    0x2007,         /* movs r0, #7 */
    0x4902,         /* ldr r1, [pc, #8] */
    0x46c0,         /* nop */
    0x680a,         /* ldr r2, [r1, #0] */
    0x2301,         /* movs r3, #1 */
    0xe7fe,         /* b.n a */
    0x0000, 0x6000, /* .word 0x60000000 */
};

/* store to nowhere at offset 4 */
static const uint16_t code_bad_write[] = {
    0x4901,         /* ldr r1, [pc, #4] */
    0x46c0,         /* nop */
    0x6009,         /* str r1, [r1, #0] */
    0xe7fe,         /* b.n 6 */
    0x0000, 0x3000, /* .word 0x30000000 */
};

/* word load from an odd address at offset 4; r2 = it was possible */
static const uint16_t code_unaligned[] = {
    0x4902,         /* ldr r1, [pc, #8] */
    0x2200,         /* movs r2, #0 */
    0x6808,         /* ldr r0, [r1, #0] */
    0x2201,         /* movs r2, #1 */
    0xe7fe,         /* b.n 8 */
    0x0000,         /* .short 0x0000 */
    0x0001, 0x2000, /* .word 0x20000001 */
};

/* word store to an odd address at offset 6 */
static const uint16_t code_unaligned_store[] = {
    0x4902,         /* ldr r1, [pc, #8] */
    0x2200,         /* movs r2, #0 */
    0x43d0,         /* mvns r0, r2 */
    0x6008,         /* str r0, [r1, #0] */
    0x2201,         /* movs r2, #1 */
    0xe7fe,         /* b.n a */
    0x0201, 0x2000, /* .word 0x20000201 */
};

/* LDRD from an odd address at offset 4 */
static const uint16_t code_unaligned_pair[] = {
    0x4902,         /* ldr r1, [pc, #8] */
    0x2200,         /* movs r2, #0 */
    0xe9d1, 0x4500, /* ldrd r4, r5, [r1] */
    0x2201,         /* movs r2, #1 */
    0xe7fe,         /* b.n a */
    0x0001, 0x2000, /* .word 0x20000001 */
};

static const uint16_t code_udf[] = {
    0x46c0, /* nop */
    0xde01, /* udf #1 */
    0xe7fe, /* b.n 4 */
};

/* an instruction that ARMv6-M lacks, at offset 2 */
static const uint16_t code_movw[] = {
    0x2200,         /* movs r2, #0 */
    0xf241, 0x2034, /* movw r0, #4660 */
    0x2201,         /* movs r2, #1 */
    0xe7fe,         /* b.n 8 */
};

/* IT: not on ARMv6-M, at offset 4; r2 = 1, r3 = 2 on the other */
static const uint16_t code_it[] = {
    0x2201, /* movs r2, #1 */
    0x2a01, /* cmp r2, #1 */
    0xbf0c, /* ite eq */
    0x2302, /* moveq r3, #2 */
    0x2303, /* movne r3, #3 */
    0xe7fe, /* b.n a */
};

/* at offset 2 */
static const uint16_t code_fpu[] = {
    0x2200,         /* movs r2, #0 */
    0xee00, 0x2a10, /* vmov s0, r2 */
    0x2201,         /* movs r2, #1 */
    0xe7fe,         /* b.n 8 */
};

/* branch to an even address */
static const uint16_t code_even[] = {
    0x4800,         /* ldr r0, [pc, #0] */
    0x4700,         /* bx r0 */
    0x1000, 0x0800, /* .word 0x08001000 */
};

static const uint16_t code_jump_nowhere[] = {
    0x4800,         /* ldr r0, [pc, #0] */
    0x4700,         /* bx r0 */
    0x0001, 0x6000, /* .word 0x60000001 */
};

/* r4 after the call */
static const uint16_t code_svc[] = {
    0x2401, /* movs r4, #1 */
    0xdf05, /* svc 5 */
    0x3401, /* adds r4, #1 */
    0xe7fe, /* b.n 6 */
};

static const uint16_t code_bkpt[] = {
    0x46c0, /* nop */
    0xbe00, /* bkpt 0x0000 */
    0xe7fe, /* b.n 4 */
};

static const uint16_t handler_fault_again[] = {
    0x4901,         /* ldr r1, [pc, #4] */
    0x680a,         /* ldr r2, [r1, #0] */
    0xe7fe,         /* b.n 4 */
    0x0000,         /* .short 0x0000 */
    0x0000, 0x6000, /* .word 0x60000000 */
};

static const uint16_t code_null[] = {
    0x2000, /* movs r0, #0 */
    0x6841, /* ldr r1, [r0, #4] */
    0xe7fe, /* b.n 4 */
};

/* a call with a frame of 8 + 64 bytes */
static const uint16_t code_deep[] = {
    0xf000, 0xf801, /* bl 6 */
    0xe7fe,         /* b.n 4 */
    0xb580,         /* push {r7, lr} */
    0xb090,         /* sub sp, #64 */
    0x2701,         /* movs r7, #1 */
    0xb010,         /* add sp, #64 */
    0xbd80,         /* pop {r7, pc} */
};

/* pushes until the memory ends */
static const uint16_t code_overflow[] = {
    0xb4ff, /* push {r0, r1, r2, r3, r4, r5, r6, r7} */
    0xe7fd, /* b.n 0 */
};

/* unlocks flash of F0, programs a half-word, waits; r7 = SR, r6 = loops */
static const uint16_t code_program_f0[] = {
    0x4808,         /* ldr r0, [pc, #32] */
    0x4909,         /* ldr r1, [pc, #36] */
    0x6041,         /* str r1, [r0, #4] */
    0x4909,         /* ldr r1, [pc, #36] */
    0x6041,         /* str r1, [r0, #4] */
    0x2101,         /* movs r1, #1 */
    0x6101,         /* str r1, [r0, #16] */
    0x4a08,         /* ldr r2, [pc, #32] */
    0x4b08,         /* ldr r3, [pc, #32] */
    0x8013,         /* strh r3, [r2, #0] */
    0x2600,         /* movs r6, #0 */
    0x3601,         /* adds r6, #1 */
    0x68c7,         /* ldr r7, [r0, #12] */
    0x2101,         /* movs r1, #1 */
    0x420f,         /* tst r7, r1 */
    0xd1fa,         /* bne.n 16 */
    0x8814,         /* ldrh r4, [r2, #0] */
    0xe7fe,         /* b.n 22 */
    0x2000, 0x4002, /* .word 0x40022000 */
    0x0123, 0x4567, /* .word 0x45670123 */
    0x89ab, 0xcdef, /* .word 0xcdef89ab */
    0xf000, 0x0801, /* .word 0x0801f000 */
    0x5aa5, 0x0000, /* .word 0x00005aa5 */
};

/* the same for F4, a word, with a store that increments its address */
static const uint16_t code_program_f4[] = {
    0x480a,         /* ldr r0, [pc, #40] */
    0x490b,         /* ldr r1, [pc, #44] */
    0x6041,         /* str r1, [r0, #4] */
    0x490b,         /* ldr r1, [pc, #44] */
    0x6041,         /* str r1, [r0, #4] */
    0xf240, 0x2101, /* movw r1, #513 */
    0x6101,         /* str r1, [r0, #16] */
    0x4a09,         /* ldr r2, [pc, #36] */
    0x4b0a,         /* ldr r3, [pc, #40] */
    0xf842, 0x3b04, /* str.w r3, [r2], #4 */
    0x2600,         /* movs r6, #0 */
    0x3601,         /* adds r6, #1 */
    0x68c7,         /* ldr r7, [r0, #12] */
    0xf417, 0x3f80, /* tst.w r7, #65536 */
    0xd1fa,         /* bne.n 1a */
    0xf852, 0x4c04, /* ldr.w r4, [r2, #-4] */
    0xe7fe,         /* b.n 28 */
    0x0000,         /* .short 0x0000 */
    0x3c00, 0x4002, /* .word 0x40023c00 */
    0x0123, 0x4567, /* .word 0x45670123 */
    0x89ab, 0xcdef, /* .word 0xcdef89ab */
    0xc000, 0x0800, /* .word 0x0800c000 */
    0x5678, 0x1234, /* .word 0x12345678 */
};

/* erases page 0801f000 of F0 */
static const uint16_t code_erase_f0[] = {
    0x4807,         /* ldr r0, [pc, #28] */
    0x4908,         /* ldr r1, [pc, #32] */
    0x6041,         /* str r1, [r0, #4] */
    0x4908,         /* ldr r1, [pc, #32] */
    0x6041,         /* str r1, [r0, #4] */
    0x2102,         /* movs r1, #2 */
    0x6101,         /* str r1, [r0, #16] */
    0x4a07,         /* ldr r2, [pc, #28] */
    0x6142,         /* str r2, [r0, #20] */
    0x2142,         /* movs r1, #66 */
    0x6101,         /* str r1, [r0, #16] */
    0x68c7,         /* ldr r7, [r0, #12] */
    0x2101,         /* movs r1, #1 */
    0x420f,         /* tst r7, r1 */
    0xd1fb,         /* bne.n 16 */
    0xe7fe,         /* b.n 1e */
    0x2000, 0x4002, /* .word 0x40022000 */
    0x0123, 0x4567, /* .word 0x45670123 */
    0x89ab, 0xcdef, /* .word 0xcdef89ab */
    0xf000, 0x0801, /* .word 0x0801f000 */
};

/* DWT: r1, r2 = CYCCNT twice, three instructions apart */
static const uint16_t code_cyccnt[] = {
    0x4805,         /* ldr r0, [pc, #20] */
    0xf04f, 0x7180, /* mov.w r1, #16777216 */
    0x6001,         /* str r1, [r0, #0] */
    0x4804,         /* ldr r0, [pc, #16] */
    0x2101,         /* movs r1, #1 */
    0x6001,         /* str r1, [r0, #0] */
    0x6841,         /* ldr r1, [r0, #4] */
    0xbf00,         /* nop */
    0xbf00,         /* nop */
    0x6842,         /* ldr r2, [r0, #4] */
    0xe7fe,         /* b.n 16 */
    0xedfc, 0xe000, /* .word 0xe000edfc */
    0x1000, 0xe000, /* .word 0xe0001000 */
};

/* holds interrupts of priority 0x40 and below back; r4 = passed */
static const uint16_t code_basepri[] = {
    0x2040,         /* movs r0, #64 */
    0xf380, 0x8811, /* msr BASEPRI, r0 */
    0x4906,         /* ldr r1, [pc, #24] */
    0x2203,         /* movs r2, #3 */
    0x600a,         /* str r2, [r1, #0] */
    0xbf00,         /* nop */
    0xbf00,         /* nop */
    0x2401,         /* movs r4, #1 */
    0x2000,         /* movs r0, #0 */
    0xf380, 0x8811, /* msr BASEPRI, r0 */
    0xbf00,         /* nop */
    0x2402,         /* movs r4, #2 */
    0xe7fe,         /* b.n 1c */
    0x0000,         /* .short 0x0000 */
    0xe200, 0xe000, /* .word 0xe000e200 */
};

/* enables and pends interrupts 0 and 1 with PRIMASK set, then opens */
static const uint16_t code_two_irqs[] = {
    0xb672,         /* cpsid i */
    0x4905,         /* ldr r1, [pc, #20] */
    0x2203,         /* movs r2, #3 */
    0x600a,         /* str r2, [r1, #0] */
    0x4904,         /* ldr r1, [pc, #16] */
    0x600a,         /* str r2, [r1, #0] */
    0x2300,         /* movs r3, #0 */
    0x2400,         /* movs r4, #0 */
    0xb662,         /* cpsie i */
    0x2701,         /* movs r7, #1 */
    0xe7fe,         /* b.n 14 */
    0x0000,         /* .short 0x0000 */
    0xe100, 0xe000, /* .word 0xe000e100 */
    0xe200, 0xe000, /* .word 0xe000e200 */
};

/* jumps to code_poll at 20000000, r0 = SR of the flash of F4 */
static const uint16_t code_to_ram[] = {
    0x4801,         /* ldr r0, [pc, #4] */
    0x4902,         /* ldr r1, [pc, #8] */
    0x4708,         /* bx r1 */
    0xbf00,         /* nop */
    0x3c0c, 0x4002, /* .word 0x40023c0c */
    0x0001, 0x2000, /* .word 0x20000001 */
};

/* waits until BSY is set, then until it is clear; r4 counts the turns of the second wait */
static const uint16_t code_poll[] = {
    0x6802, /* ldr r2, [r0, #0] */
    0x03d2, /* lsls r2, r2, #15 */
    0xd5fc, /* bpl.n 0 */
    0x3401, /* adds r4, #1 */
    0x6802, /* ldr r2, [r0, #0] */
    0x03d2, /* lsls r2, r2, #15 */
    0xd4fb, /* bmi.n 6 */
    0xe7fe, /* b.n e */
};

/* shifts 1 into r4 */
static const uint16_t handler_a[] = {
    0x0124, /* lsls r4, r4, #4 */
    0x3401, /* adds r4, #1 */
    0x4770, /* bx lr */
};

/* shifts 2 into r4 */
static const uint16_t handler_b[] = {
    0x0124, /* lsls r4, r4, #4 */
    0x3402, /* adds r4, #2 */
    0x4770, /* bx lr */
};

/* shifts 3, pends interrupt 1 (more urgent), shifts 4 */
static const uint16_t handler_nested[] = {
    0x0124,         /* lsls r4, r4, #4 */
    0x3403,         /* adds r4, #3 */
    0x4903,         /* ldr r1, [pc, #12] */
    0x2202,         /* movs r2, #2 */
    0x600a,         /* str r2, [r1, #0] */
    0x46c0,         /* nop */
    0x46c0,         /* nop */
    0x0124,         /* lsls r4, r4, #4 */
    0x3404,         /* adds r4, #4 */
    0x4770,         /* bx lr */
    0xe200, 0xe000, /* .word 0xe000e200 */
};

#endif
