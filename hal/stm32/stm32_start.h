/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32_start.h
 * Private to this back-end: what the linker script places, and what start-up and crash code share.
 */
#ifndef STM32_START_H
#define STM32_START_H

#include "stm32_life.h"

#define STM32_PAINT_WORD 0xA5A5A5A5u
#define STM32_GUARD_WORD 0x6B726147u

#define STM32_RECORD_BYTES 80 /* room that sections.ld leaves for the record */
typedef char stm32_record_fits[sizeof(stm32_record) <= STM32_RECORD_BYTES ? 1 : -1];

extern stm32_record stm32_life_record;
extern uint32_t stm32_guard_begin[], stm32_guard_end[]; /* the stack begins where the guard ends */
extern uint32_t stm32_stack_end[];
extern uint32_t stm32_data_begin[], stm32_data_end[], stm32_bss_begin[], stm32_bss_end[];
extern const uint32_t stm32_data_load[];

/** Second half of stm32_fault(): `frame` is the exception frame. Does not return. */
void stm32_fault_kept(const uint32_t *frame, uint32_t exception) __attribute__((used));

#endif
