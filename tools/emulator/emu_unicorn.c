/* SPDX-License-Identifier: Apache-2.0 */
/* Unicorn as the engine: memory map, hooks, registers. */
#include "emu_engine.h"
#include <stdlib.h>
#include <string.h>
#include <unicorn/unicorn.h>

#define NOWHERE 0xffffffffu /* no instruction stands here: a run does not end by address */
#define PAGE 4096u

static const int reg_of[] = {
    UC_ARM_REG_R0,      UC_ARM_REG_R1,        UC_ARM_REG_R2,          UC_ARM_REG_R3,   UC_ARM_REG_R4,
    UC_ARM_REG_R5,      UC_ARM_REG_R6,        UC_ARM_REG_R7,          UC_ARM_REG_R8,   UC_ARM_REG_R9,
    UC_ARM_REG_R10,     UC_ARM_REG_R11,       UC_ARM_REG_R12,         UC_ARM_REG_SP,   UC_ARM_REG_LR,
    UC_ARM_REG_PC,      UC_ARM_REG_XPSR,      UC_ARM_REG_XPSR_NZCVQG, UC_ARM_REG_IPSR, UC_ARM_REG_PRIMASK,
    UC_ARM_REG_BASEPRI, UC_ARM_REG_FAULTMASK, UC_ARM_REG_CONTROL};

uint32_t engine_get(emu_cpu *c, unsigned reg)
{
    uint32_t v = 0;

    uc_reg_read(c->uc, reg_of[reg], &v);
    return v;
}

void engine_set(emu_cpu *c, unsigned reg, uint32_t value)
{
    uc_reg_write(c->uc, reg_of[reg], &value);
}

void engine_fpu(emu_cpu *c, uint32_t s[17], bool save)
{
    for (int i = 0; i < 17; i++) {
        int reg = i < 16 ? UC_ARM_REG_S0 + i : UC_ARM_REG_FPSCR;

        if (save) {
            uc_reg_read(c->uc, reg, &s[i]);
        } else {
            uc_reg_write(c->uc, reg, &s[i]);
        }
    }
}

void engine_halt(emu_cpu *c)
{
    uc_emu_stop(c->uc);
}

static bool masked(emu_cpu *c, unsigned reg)
{
    return (engine_get(c, reg) & 1u) != 0;
}

int engine_priority(emu_cpu *c)
{
    bool m4 = c->e->chip->m4;

    return emu_exc_current(c->e, masked(c, ENGINE_PRIMASK), m4 && masked(c, ENGINE_FAULTMASK),
                           m4 ? engine_get(c, ENGINE_BASEPRI) : 0);
}

unsigned engine_pick(emu_cpu *c)
{
    bool m4 = c->e->chip->m4;

    return emu_exc_pick(c->e, masked(c, ENGINE_PRIMASK), m4 && masked(c, ENGINE_FAULTMASK),
                        m4 ? engine_get(c, ENGINE_BASEPRI) : 0);
}

void engine_skip(emu_cpu *c)
{
    engine_set(c, ENGINE_PC, (engine_get(c, ENGINE_PC) + 2u) | 1u);
    c->e->cycle++;
    c->e->meter.instructions++;
}

/* ---- hooks ---- */

static void on_code(uc_engine *uc, uint64_t address, uint32_t size, void *user)
{
    emu_cpu *c = user;
    emu *e = c->e;
    uint32_t i = ((uint32_t)address - c->code_base) / 2u;

    (void)size;
    if ((i >= c->code_words || (c->flags[i] & ~(unsigned)INSN_WIDE) != INSN_KNOWN ||
         e->cycle >= e->attention) &&
        !engine_step(c, (uint32_t)address)) {
        uc_emu_stop(uc);
        return;
    }
    e->cycle++;
    e->meter.instructions++;
    if (c->count != NULL && i < c->code_words) {
        c->count[i]++;
    }
}

static void on_access(uc_engine *uc, uc_mem_type type, uint64_t address, int size, int64_t value, void *user)
{
    emu_cpu *c = user;
    uint32_t a = (uint32_t)address;
    unsigned n = (unsigned)size;

    (void)uc;
    if ((a & (n - 1u)) != 0 || a - c->code_base < 2u * c->code_words || a < 2u * c->code_words) {
        engine_access(c, type == UC_MEM_WRITE, a, n, (uint32_t)value);
    }
}

static bool on_invalid_access(uc_engine *uc, uc_mem_type type, uint64_t address, int size, int64_t value,
                              void *user)
{
    emu_cpu *c = user;

    (void)uc;
    (void)size;
    (void)value;
    if (c->why == WHY_NOTHING) {
        c->why = type == UC_MEM_FETCH_UNMAPPED || type == UC_MEM_FETCH_PROT ? WHY_FETCH : WHY_BUS;
        c->fault_address = (uint32_t)address;
    }
    return false;
}

static void on_exception(uc_engine *uc, uint32_t number, void *user)
{
    emu_cpu *c = user;

    switch (number) {
    case 8:
        c->why = WHY_LEAVE;
        break;
    case 2:
        c->why = WHY_CALL;
        break;
    case 7:
    case 16:
        c->why = WHY_BREAK;
        break;
    default:
        c->why = WHY_UNDEFINED;
        break;
    }
    uc_emu_stop(uc);
}

static uint64_t on_device_read(uc_engine *uc, uint64_t offset, unsigned size, void *user)
{
    const emu_window *w = ((void **)user)[1];
    emu_cpu *c = ((void **)user)[0];
    uint32_t value = 0;

    (void)uc;
    if (!emu_route_read(c->e, w->base + (uint32_t)offset, size, &value)) {
        engine_fault(c, WHY_BUS, w->base + (uint32_t)offset);
    }
    return value;
}

static void on_device_write(uc_engine *uc, uint64_t offset, unsigned size, uint64_t value, void *user)
{
    const emu_window *w = ((void **)user)[1];
    emu_cpu *c = ((void **)user)[0];

    (void)uc;
    if (!emu_route_write(c->e, w->base + (uint32_t)offset, size, (uint32_t)value)) {
        engine_fault(c, WHY_BUS, w->base + (uint32_t)offset);
    }
}

/* ---- life ---- */

typedef struct engine {
    emu_cpu cpu; /* first: emu->cpu points here */
    void *window[16][2];
} engine;

static bool map_memory(emu_cpu *c)
{
    const emu *e = c->e;

    for (unsigned i = 0; e->chip->regions[i].size != 0; i++) {
        const emu_region *r = &e->chip->regions[i];
        uint32_t perms = r->kind == EMU_ROM ? UC_PROT_READ | UC_PROT_EXEC : UC_PROT_ALL;

        if (uc_mem_map_ptr(c->uc, r->base, (r->size + PAGE - 1) / PAGE * PAGE, perms, e->memory[i]) !=
            UC_ERR_OK) {
            return false;
        }
    }
    return true;
}

static bool map_devices(engine *g)
{
    unsigned i = 0;

    for (const emu_window *w = g->cpu.e->chip->windows; w->size != 0 && i < 16; w++, i++) {
        union {
            const emu_window *from;
            void *to;
        } u = {.from = w};

        g->window[i][0] = &g->cpu;
        g->window[i][1] = u.to;
        if (uc_mmio_map(g->cpu.uc, w->base, (w->size + PAGE - 1) / PAGE * PAGE, on_device_read, g->window[i],
                        on_device_write, g->window[i]) != UC_ERR_OK) {
            return false;
        }
    }
    return true;
}

/* ISO C has no conversion from a function to void *; the interface of Unicorn wants one. */
static bool hook(emu_cpu *c, int type, void (*function)(void))
{
    uc_hook handle;
    union {
        void (*function)(void);
        void *object;
    } u = {.function = function};

    return uc_hook_add(c->uc, &handle, type, u.object, c, 1, 0) == UC_ERR_OK;
}

static bool prepare(engine *g)
{
    emu_cpu *c = &g->cpu;
    uc_engine *uc = NULL;

    if (uc_open(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS, &uc) != UC_ERR_OK) {
        return false;
    }
    c->uc = uc;
    return uc_ctl_set_cpu_model(uc, c->e->chip->m4 ? UC_CPU_ARM_CORTEX_M4 : UC_CPU_ARM_CORTEX_M0) ==
               UC_ERR_OK &&
           map_memory(c) && map_devices(g) && hook(c, UC_HOOK_CODE, (void (*)(void))on_code) &&
           hook(c, UC_HOOK_MEM_READ | UC_HOOK_MEM_WRITE, (void (*)(void))on_access) &&
           hook(c, UC_HOOK_MEM_INVALID, (void (*)(void))on_invalid_access) &&
           hook(c, UC_HOOK_INTR, (void (*)(void))on_exception);
}

bool emu_cpu_open(emu *e)
{
    engine *g = calloc(1, sizeof *g);

    if (g == NULL || e->cpu != NULL) {
        free(g);
        return false;
    }
    e->cpu = g;
    g->cpu.e = e;
    g->cpu.code_base = e->chip->flash_base;
    g->cpu.code_words = e->chip->flash_size / 2u;
    g->cpu.flags = calloc(g->cpu.code_words, sizeof g->cpu.flags[0]);
    if (g->cpu.flags == NULL || !prepare(g)) {
        emu_cpu_close(e);
        return false;
    }
    emu_cpu_reset(e);
    return true;
}

bool emu_count_code(emu *e)
{
    emu_cpu *c = e->cpu != NULL ? &((engine *)e->cpu)->cpu : NULL;

    if (c != NULL && c->count == NULL) {
        c->count = calloc(c->code_words, sizeof c->count[0]);
    }
    return c != NULL && c->count != NULL;
}

uint64_t emu_code_count(const emu *e, uint32_t address)
{
    const emu_cpu *c = e->cpu != NULL ? &((const engine *)e->cpu)->cpu : NULL;
    uint32_t i = c != NULL ? (address - c->code_base) / 2u : 0;

    return c != NULL && c->count != NULL && i < c->code_words ? c->count[i] : 0;
}

void emu_cpu_close(emu *e)
{
    engine *g = e->cpu;

    if (g != NULL) {
        if (g->cpu.uc != NULL) {
            uc_close(g->cpu.uc);
        }
        free(g->cpu.flags);
        free(g->cpu.count);
        free(g);
        e->cpu = NULL;
    }
}

void emu_cpu_reset(emu *e)
{
    emu_cpu *c = e->cpu;
    uint32_t vector[2] = {0, 0};

    if (c == NULL) {
        return;
    }
    (void)emu_peek(e, e->chip->flash_base, vector, 8);
    for (unsigned r = 0; r < 13; r++) {
        engine_set(c, r, 0);
    }
    engine_set(c, ENGINE_CONTROL, 0);
    engine_set(c, ENGINE_PRIMASK, 0);
    if (e->chip->m4) {
        engine_set(c, ENGINE_BASEPRI, 0);
        engine_set(c, ENGINE_FAULTMASK, 0);
    }
    engine_set(c, ENGINE_FLAGS, 0);
    engine_set(c, ENGINE_IPSR, 0);
    engine_set(c, ENGINE_SP, vector[0] & ~3u);
    engine_set(c, ENGINE_LR, 0xffffffffu);
    engine_set(c, ENGINE_PC, vector[1] | 1u);
    c->asleep = c->look_at_stack = false;
    c->thumb_lost = (vector[1] & 1u) == 0;
    c->why = WHY_NOTHING;
}

uint32_t emu_cpu_pc(const emu *e)
{
    return e->cpu != NULL ? engine_get(e->cpu, ENGINE_PC) : 0;
}

uint32_t emu_register(const emu *e, unsigned n)
{
    return e->cpu != NULL && n <= ENGINE_PSR ? engine_get(e->cpu, n) : 0;
}

static void flush(emu_cpu *c)
{
    (void)uc_ctl_remove_cache((uc_engine *)c->uc, c->dirty_from, c->dirty_to);
    c->code_dirty = false;
}

void emu_cpu_code_changed(emu *e, uint32_t address, uint32_t n)
{
    emu_cpu *c = e->cpu;
    uint32_t first, end;

    if (c == NULL || address < c->code_base || address - c->code_base >= 2u * c->code_words) {
        return;
    }
    first = (address - c->code_base) / 2u;
    end = first + (n + 1u) / 2u;
    for (uint32_t i = first; i < end && i < c->code_words; i++) {
        if (c->flags[i] != 0) {
            c->dirty_from = !c->code_dirty || address < c->dirty_from ? address : c->dirty_from;
            c->dirty_to = !c->code_dirty || address + n > c->dirty_to ? address + n : c->dirty_to;
            c->code_dirty = true;
            c->flags[i] = 0;
        }
    }
    if (c->code_dirty && !e->running) {
        flush(c);
    }
    emu_kick(e);
}

/* One run of instructions, ended by engine_halt(), a fault or an exception. */
void engine_run(emu_cpu *c)
{
    uc_err error;

    if (c->code_dirty) {
        flush(c);
    }
    if (c->thumb_lost) {
        c->thumb_lost = false;
        c->why = WHY_STATE;
        return;
    }
    c->e->attention = 0;
    c->e->running = true;
    error = uc_emu_start(c->uc, engine_get(c, ENGINE_PC) | 1u, NOWHERE, 0, 0);
    c->e->running = false;
    if (error == UC_ERR_INSN_INVALID && c->why == WHY_NOTHING) {
        c->why = (engine_get(c, ENGINE_PSR) >> 24 & 1u) != 0 ? WHY_UNDEFINED : WHY_STATE;
    }
}
