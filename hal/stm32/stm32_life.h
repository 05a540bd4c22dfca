/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32_life.h
 * From reset to reset: start-up, why the last life ended, crash record, stack guard, the end of a life.
 *
 * Memory, from the start of RAM upward: the record below, the guard, the stack (growing down towards the
 * guard), .data, .bss. The start-up code touches the record only where it says so here, so it survives every
 * reset.
 */
#ifndef STM32_LIFE_H
#define STM32_LIFE_H

#include "bqhost/hal.h"

#define STM32_CRASH_GUARD 0x100u
#define STM32_CRASH_ASSERT 0x101u

/** What is kept in RAM over a reset. Placed by the linker script, not initialised. */
typedef struct stm32_record {
    uint32_t alive; /* STM32_ALIVE from the first start: RAM has kept its content */
    uint32_t magic; /* STM32_CRASHED: `crash` was written and not yet read */
    bq_crash crash;
    uint32_t check; /* CRC-32 of `crash` */
    uint32_t uptime_ms, last_us, rest_us;
} stm32_record;

/* ---- what a board provides
 * ------------------------------------------------------------------------------------ */

/** Puts every output to its safe level. Called first thing after reset, before .data and .bss are there, and
 * by the fault handlers: it may use the stack and constants only. Usually stm32_pins_safe() of the board's
 * table. */
void board_outputs_safe(void);
/** The firmware; must not return (if it does: crash STM32_CRASH_ASSERT). Interrupts are masked when it
 * begins; board_main() enables them. */
void board_main(void);

/* ---- start
 * ---------------------------------------------------------------------------------------------------- */

/** Reads and clears reset flags and crash record and fills `*boot` except `crystal_failed` and the image's
 * fields. Call once, early in board_main(). */
void stm32_life_begin(bq_boot *boot);

/** Why the last life ended. `flags`: RCC_CSR; `brown_out`: mask of the flag that means brown-out in this
 * family, 0 = none; `kept`: RAM kept its content; `crashed`: a valid record was found. Pure. The order of the
 * answers: crash, watchdog, software, power (with `kept`: brown-out), brown-out, pin. */
bq_reset_cause stm32_reset_cause(uint32_t flags, uint32_t brown_out, bool kept, bool crashed);

/* ---- every pass of the main loop
 * ------------------------------------------------------------------------------ */

/** Checks the guard below the stack (damaged: stm32_crash(STM32_CRASH_GUARD)) and advances the uptime of a
 * later crash record. Call at least every hour. */
void stm32_life_pass(void);

/** Bytes of the stack that were never used. */
uint32_t stm32_stack_free(void);

/* ---- end
 * ------------------------------------------------------------------------------------------------------ */

/** Outputs safe, crash record of this place, reset. */
void stm32_crash(uint32_t kind) __attribute__((noreturn));
/** Outputs safe, reset. */
void stm32_reset(void) __attribute__((noreturn));

/** The microcontroller for bqhost/hal.h. `boot` must outlive the result. */
bq_mcu stm32_mcu(const bq_boot *boot);

/* ---- vectors
 * ---------------------------------------------------------------------------------------------------- */

/** Reset: outputs safe, stack painted, .data, .bss, board_main(). */
void stm32_start(void) __attribute__((noreturn));
/** Every exception and interrupt that nobody handles: outputs safe, record, reset. */
void stm32_fault(void);

#endif
