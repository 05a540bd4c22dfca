/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file emu_internal.h
 * The emulator's own state. Models use emu_periph.h; only the core, the processor and the models that are
 * part of it (SCS, RCC, GPIO, EXTI, FLASH, PWR) see this.
 */
#ifndef EMU_INTERNAL_H
#define EMU_INTERNAL_H

#include "emu_models.h"

#define EMU_SLOTS 64
#define EMU_PORTS 9
#define EMU_EXCEPTIONS 112 /**< 16 of the core and up to 96 interrupts */
#define EMU_DEPTH 32
#define EMU_FIXES 32

typedef enum emu_region_kind {
    EMU_RAM,
    EMU_FLASH,
    EMU_ALIAS /**< of flash, at 0 */,
    EMU_ROM
} emu_region_kind;

typedef struct emu_region {
    emu_region_kind kind;
    uint32_t base, size;
} emu_region;

typedef struct emu_word {
    uint32_t address, value;
} emu_word;

/** A stretch of addresses that belongs to peripherals; an access to a hole in it reads 0. */
typedef struct emu_window {
    uint32_t base, size;
} emu_window;

struct emu_chip {
    const char *name;
    emu_family family;
    bool m4;
    unsigned irqs, priority_bits;
    uint32_t flash_base, flash_size, max_hclk, max_pclk1, max_pclk2;
    uint32_t hsi_hz, hse_hz, lsi_hz;
    const emu_region *regions; /**< ends with size 0; flash first */
    const emu_window *windows; /**< ends with size 0 */
    const emu_word *rom;       /**< words of the system memory other than ffffffff; ends with address 0 */
    const emu_instance *instances;
    unsigned instance_count;
    unsigned exti_lines;
    const uint8_t *exti_irq; /**< NVIC number of each line */
    const uint32_t *sectors; /**< F4: sizes of the sectors, ends with 0; F0: NULL = pages of 2 KB */
};

typedef struct emu_clocks {
    uint32_t sysclk, hclk, pclk1, pclk2;
    uint32_t i2c1, usart[4]; /**< F0: kernel clocks by RCC_CFGR3, by number */
    bool apb1_divided, apb2_divided;
} emu_clocks;

/** Exceptions: what NVIC, SCB and the entry and return of the core share. */
typedef struct emu_exceptions {
    uint8_t pending[EMU_EXCEPTIONS], enabled[EMU_EXCEPTIONS], priority[EMU_EXCEPTIONS], level[EMU_EXCEPTIONS];
    uint64_t pend_cycle[EMU_EXCEPTIONS];
    uint8_t active[EMU_DEPTH]; /**< stack of numbers */
    unsigned depth;
    unsigned any; /**< how many are pending */
    uint32_t vtor, prigroup, scr, ccr, shcsr, cfsr, hfsr, bfar, mmfar, cpacr, demcr;
    uint32_t prigroup_mask; /**< of a priority byte: the part that preempts */
} emu_exceptions;

/** A place of flash whose content differs from what the store instruction left there. */
typedef struct emu_fix {
    uint32_t at, size;
    uint8_t bytes[8];
} emu_fix;

typedef struct emu_flash_trap {
    unsigned countdown; /**< 0 = none */
    uint32_t seed;
    uint64_t off_ns;
    bool sprung;
} emu_flash_trap;

struct emu {
    const emu_chip *chip;
    emu_world world;
    /* time: now = base_ns + (cycle - base_cycle) / hclk */
    uint64_t cycle, base_cycle, base_ns;
    uint64_t attention; /**< cycle at which the processor has to look up; 0 = at once */
    uint64_t world_now, world_done;
    uint64_t stall_ns, poll_ns;
    bool exti_dirty, running, stop_here, stop_on_reset, lockup;
    emu_clocks clock;
    emu_exceptions exc;
    /* chip */
    emu_periph *periph[EMU_SLOTS];
    uint64_t due[EMU_SLOTS]; /**< what next() said last */
    uint64_t touched;        /**< bits of slots whose next() has to be asked again */
    unsigned periphs, last_hit;
    uint8_t irq_lines[EMU_SLOTS]; /**< levels, bit = index */
    const uint32_t *rcc;          /**< registers of RCC, by word */
    emu_periph *gpio[EMU_PORTS], *exti, *syscfg, *flash, *pwr, *rcc_model;
    uint32_t dma_lines;
    uint8_t *memory[8]; /**< of chip->regions */
    emu_fix fix[EMU_FIXES];
    unsigned fixes;
    bool (*flash_store)(emu_periph *p, uint32_t address, uint32_t value, unsigned bytes);
    void (*flash_judge)(emu_periph *p);
    uint32_t flash_ops, lsi_hz;
    emu_flash_trap trap;
    unsigned supply_mv;
    bool crystal, powered;
    emu_cause reset_asked, reset_now; /**< EMU_CAUSES = none */
    bool reset_happened;
    /* judge and meters */
    sim_misuse misuse;
    uint32_t misuse_count[SIM_MISUSE_KEPT], misuse_pc[SIM_MISUSE_KEPT];
    emu_meter meter;
    uint32_t mark; /**< 0 = none */
    uint64_t marked, marked_ns;
    uint64_t awake_since, awake_since_ns, isr_since;
    void *cpu; /**< emu_cpu.c's own; NULL = none */
};

/* ---- core ---- */
void emu_set_now(emu *e, uint64_t ns);                    /**< time jumps: asleep or without processor */
void emu_set_clocks(emu *e, const emu_clocks *c);         /**< by RCC */
uint64_t emu_next_event(emu *e);                          /**< absolute ns */
uint64_t emu_cycle_of(const emu *e, uint64_t ns);         /**< first core cycle at or after a time */
void emu_events(emu *e);                                  /**< runs what is due now */
static inline void emu_touch(emu *e, const emu_periph *p) /**< the model's next event may have changed */
{
    e->touched |= 1ull << p->slot;
}

static inline void emu_kick(emu *e) /**< something changed: look before the next instruction */
{
    e->attention = 0;
}
void emu_misuse_named(emu *e, const char *periph, const char *reg, const char *format, ...);
bool emu_route_read(emu *e, uint32_t address, unsigned bytes, uint32_t *value);
bool emu_route_write(emu *e, uint32_t address, unsigned bytes, uint32_t value);
bool emu_in_window(const emu *e, uint32_t address);

/* ---- memory ---- */
bool emu_memory_make(emu *e);
void emu_memory_drop(emu *e);
/** Host address of n bytes of memory and what kind it is; NULL = not (all) memory. */
uint8_t *emu_memory_at(const emu *e, uint32_t address, size_t n, emu_region_kind *kind);
void emu_memory_lose(emu *e); /**< RAM after power on */
/** What a place holds once the store under way is over. */
void emu_add_fix(emu *e, uint32_t at, uint32_t size, const uint8_t *bytes);
void emu_apply_fixes(emu *e);

/* ---- reset ---- */
void emu_take_reset(emu *e, emu_cause cause);
bool emu_settle_reset(emu *e); /**< carries out what was asked for; true = there was one */

/* ---- meters ---- */
void emu_marked(emu *e); /**< the marked place is reached */

/* ---- exceptions ---- */
void emu_exc_reset(emu *e);
void emu_exc_pend(emu *e, unsigned number);
void emu_exc_unpend(emu *e, unsigned number);
void emu_exc_level(emu *e, unsigned number, bool level); /**< counts lines */
int emu_exc_priority(const emu *e, unsigned number);     /**< preempting part */
/** Priority at which the core runs; lower = more urgent, 256 = thread. */
int emu_exc_current(const emu *e, bool primask, bool faultmask, uint32_t basepri);
/** The exception to take now, or 0. */
unsigned emu_exc_pick(const emu *e, bool primask, bool faultmask, uint32_t basepri);
void emu_exc_enter(emu *e, unsigned number); /**< bookkeeping only */
unsigned emu_exc_leave(emu *e);              /**< bookkeeping only; the number that ended */

/* ---- what models offer to the core ---- */
emu_periph *emu_scs_new(emu *e, const emu_instance *at);   /**< NVIC, SCB, SysTick */
emu_periph *emu_dwt_new(emu *e, const emu_instance *at);   /**< CYCCNT */
emu_periph *emu_debug_new(emu *e, const emu_instance *at); /**< DBGMCU: stores */
void emu_exti_refresh(emu *e);                             /**< looks at the pins */
unsigned emu_syscfg_port(const emu *e, unsigned line);     /**< port chosen for an EXTI line */
/** A store to flash; what the place holds afterwards goes to the fixes. False: bus error. */
bool emu_flash_store(emu *e, uint32_t address, uint32_t value, unsigned bytes);
void emu_rcc_crystal(emu *e); /**< the crystal stopped or came back */
void emu_pwr_supply(emu *e);
bool emu_rcc_hsi_on(const emu *e);
void emu_flash_judge_latency(emu *e); /**< wait states against the clock */
void emu_clock_dead(emu *e);          /**< the system clock stopped: nothing runs until a reset */
bool emu_pwr_backup_unlocked(const emu *e);
emu_drive emu_gpio_drive(const emu *e, unsigned port, unsigned pin);
int emu_gpio_pull(const emu *e, unsigned port, unsigned pin); /**< -1 none, 0 down, 1 up */

/* ---- processor (emu_cpu.c or emu_cpu_none.c) ---- */
void emu_cpu_close(emu *e);
void emu_cpu_reset(emu *e);
uint32_t emu_cpu_pc(const emu *e);
void emu_cpu_code_changed(emu *e, uint32_t address, uint32_t n);

#endif
