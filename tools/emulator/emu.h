/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file emu.h
 * Runs the unchanged image of a microcontroller on a PC: processor core (Unicorn), interrupt controller and
 * peripherals from the reference manuals, joined to a world of callbacks (emu_world.h). It is also a judge:
 * what a reference manual forbids is recorded with peripheral, register, reason and program counter.
 *
 * Time is simulated and starts at 0 with emu_create(); it never jumps back, not even over a reset. One
 * instruction takes one core cycle; what the bus does takes the time it takes on the wire. WFI jumps to the
 * next event. An event inside a run of instructions without a branch is seen at its end.
 *
 * An emu without a processor (emu_create() alone) is a whole chip whose registers a test reads and writes
 * with emu_bus_read() and emu_bus_write() and whose time it moves with emu_advance().
 */
#ifndef EMU_H
#define EMU_H

#include "emu_world.h"
#include "sim_misuse.h"
#include <stddef.h>

typedef struct emu emu;
typedef struct emu_chip emu_chip;

extern const emu_chip emu_f072; /**< STM32F072CB: Cortex-M0, 128 KB flash, 16 KB RAM */
extern const emu_chip emu_f405; /**< STM32F405RG: Cortex-M4F, 1 MB flash, 112 + 16 KB RAM, 64 KB CCM */

/** Why the microcontroller starts. */
typedef enum emu_cause {
    EMU_CAUSE_POWER,    /**< power on: RAM content is undefined (filled with a pattern) */
    EMU_CAUSE_BROWNOUT, /**< the supply dipped below the reset level; RAM content is lost as well */
    EMU_CAUSE_PIN,      /**< NRST; RAM keeps its content, as with the following */
    EMU_CAUSE_SOFTWARE, /**< SYSRESETREQ */
    EMU_CAUSE_IWDG,
    EMU_CAUSE_WWDG,
    EMU_CAUSE_LOW_POWER,
    EMU_CAUSE_LOCKUP, /**< no reset of real hardware: the core locked up and waits for the watchdog */
    EMU_CAUSES
} emu_cause;

/* ---- life --------------------------------------------------------------------------------------------- */

/** A powered chip in reset, flash erased, time 0. NULL without memory. `world` is copied. */
emu *emu_create(const emu_chip *chip, const emu_world *world);
void emu_destroy(emu *e);
/** Adds the processor. False when the program was built without Unicorn or the engine refuses. */
bool emu_cpu_open(emu *e);
/** Puts bytes into flash, as a programmer would; false when they do not fit. */
bool emu_load(emu *e, uint32_t address, const void *bytes, size_t n);
/** The same from a file (.bin) at the start of flash. False: not readable, empty or too long. */
bool emu_load_file(emu *e, const char *path);
/** Resets for a cause, at the present time. The image starts at its reset vector with the next
 * emu_run_until(). */
void emu_reset(emu *e, emu_cause cause);

/* ---- run ---------------------------------------------------------------------------------------------- */

typedef enum emu_stop {
    EMU_STOP_TIME,   /**< the time asked for is reached */
    EMU_STOP_RESET,  /**< reserved for emu_stop_on_reset(): a reset happened, the image has not started again
                      */
    EMU_STOP_LOCKUP, /**< a fault inside HardFault or NMI; nothing runs until a reset. Time still went on. */
    EMU_STOP_BREAK,  /**< a BKPT instruction, or emu_stop_here() */
    EMU_STOP_NO_CPU  /**< emu_cpu_open() was not called or failed */
} emu_stop;

/** Runs the image until the absolute time `ns` (or up to one run of instructions later). */
emu_stop emu_run_until(emu *e, uint64_t ns);
/** Moves time without the processor: every event of models and world due in between happens in order. */
void emu_advance(emu *e, uint64_t ns);
uint64_t emu_now(const emu *e); /**< ns */
/** True: emu_run_until() returns EMU_STOP_RESET at each reset that happens by itself. Default: it goes on. */
void emu_stop_on_reset(emu *e, bool stop);
/** Makes emu_run_until() return EMU_STOP_BREAK soon; for callbacks of the world. */
void emu_stop_here(emu *e);

/* ---- what comes in from outside ------------------------------------------------------------------------ */

/** A byte is complete in the receiver of USART n now. False: no such USART, or not listening. */
bool emu_uart_in(emu *e, unsigned uart, uint8_t byte);
/** A frame is complete on CAN bus n now. False: the controller does not take part (no clock, in
 * initialisation, asleep, bus-off), so it gives no acknowledge. */
bool emu_can_in(emu *e, unsigned can, const emu_can_frame *frame);
/** Supply in millivolts, initially 3300. Below the power-down reset level the chip stays in reset until it
 * rises; the following start has cause power or brown-out. A program or erase under way is left half done. */
void emu_set_supply_mv(emu *e, unsigned mv);
/** The crystal: false = it does not oscillate (from now on; running it fails at once, which the clock
 * security system sees). Initially true. */
void emu_set_crystal(emu *e, bool works);
/** The internal slow oscillator that drives the watchdog, initially 40 kHz (F0) or 32 kHz (F4); it is
 * inaccurate (30..60 and 17..47 kHz). From the next refresh on. */
void emu_set_lsi_hz(emu *e, uint32_t hz);
/**
 * Power is lost during the n-th flash operation from now (1 = the next; a half-word of F0, a unit of PSIZE of
 * F4, or the erase of a page or sector; 0 = never). That operation is left half done: of a program any bits
 * still 1 that should become 0, of an erase any byte either old or erased; which ones is decided by `seed`.
 * The chip starts again at once with cause power, `off_ns` later.
 */
void emu_lose_power_at_flash_op(emu *e, unsigned n, uint32_t seed, uint64_t off_ns);
/**
 * For images that wait for the flash in RAM, where the core does not stall: a read that sees it busy takes this
 * long, but not beyond the next event, instead of one cycle. Initially 0 = one cycle. The wait costs the PC
 * accordingly less; code that counts its turns, and not the time, sees fewer of them. Only F4.
 */
void emu_set_flash_poll_ns(emu *e, uint64_t ns);
/** Flash operations begun since emu_create(). */
uint32_t emu_flash_ops(const emu *e);

/* ---- look ---------------------------------------------------------------------------------------------- */

typedef struct emu_meter {
    uint64_t instructions;     /**< executed since emu_create() */
    uint64_t cycles;           /**< core cycles awake, stalls and exception entries included */
    uint64_t cycles_asleep;    /**< core cycles that passed in WFI */
    uint64_t passes;           /**< how often WFI was executed */
    uint64_t longest_awake;    /**< cycles from waking to the next WFI, the largest since emu_meter_clear() */
    uint64_t longest_awake_ns; /**< when that one began */
    uint64_t longest_pass;     /**< cycles awake between two visits of the place given to emu_mark() */
    uint64_t longest_pass_ns;  /**< when that one began */
    uint64_t longest_latency;  /**< cycles from an interrupt pending and enabled to its first instruction */
    unsigned longest_latency_irq;
    uint64_t longest_isr; /**< cycles from the first instruction of a handler to the return to thread mode */
    uint32_t lowest_sp;   /**< of the main stack, since the last reset or emu_meter_clear() */
    uint32_t exceptions;  /**< entered */
    uint32_t resets[EMU_CAUSES];
    uint32_t faults; /**< HardFaults entered */
} emu_meter;

const emu_meter *emu_get_meter(const emu *e);
/** A place that the image comes by once in each pass of its main loop, for example the address of its step
 * function from the map file: `longest_pass` is measured there. */
void emu_mark(emu *e, uint32_t address);
/** From now on counts how often the instruction at each address of flash is executed. False: no memory, or no
 * processor. */
bool emu_count_code(emu *e);
/** How often; 0 for anything that is not counted. */
uint64_t emu_code_count(const emu *e, uint32_t address);
/** Clears the "longest" and "lowest" entries, for example after start-up. */
void emu_meter_clear(emu *e);

/** The judge's book; id is "PERIPHERAL.REGISTER". The same breach again only counts. */
sim_misuse *emu_get_misuse(emu *e);
/** Program counter (start of the run of instructions) of entry n of the book; 0 = unknown. */
uint32_t emu_misuse_pc(const emu *e, unsigned n);
/** How often the book has an entry of a peripheral (and a register; NULL = any). */
uint32_t emu_misuse_of(const emu *e, const char *periph, const char *reg);

/** RAM or flash behind the back of everything. False: not all of it is memory. */
bool emu_peek(const emu *e, uint32_t address, void *bytes, size_t n);
bool emu_poke(emu *e, uint32_t address, const void *bytes, size_t n);
/** Core register 0..15 (13 = SP, 14 = LR, 15 = PC), 16 = xPSR; 0 without a processor. */
uint32_t emu_register(const emu *e, unsigned n);

/** One access as the processor makes it, of 1, 2 or 4 bytes, with clock gate, side effects and judge. False:
 * nothing there; the processor would take a fault. */
bool emu_bus_read(emu *e, uint32_t address, unsigned bytes, uint32_t *value);
bool emu_bus_write(emu *e, uint32_t address, unsigned bytes, uint32_t value);

#endif
