/* SPDX-License-Identifier: Apache-2.0 */
/* The processor: Unicorn executes the instructions; time, sleep, interrupts, exceptions and faults are here.
 */
#include "emu_cpu.h"
#include "emu_engine.h"
#include <stdlib.h>
#include <string.h>

/* ---- before each instruction ---- */

static uint16_t flags_at(emu_cpu *c, uint32_t address)
{
    uint32_t i = (address - c->code_base) / 2u;
    bool kept = address >= c->code_base && i < c->code_words;
    uint32_t both = 0;
    uint16_t f;

    if (kept && (c->flags[i] & INSN_KNOWN) != 0) {
        return c->flags[i];
    }
    if (!emu_peek(c->e, address, &both, 4)) {
        (void)emu_peek(c->e, address, &both, 2);
    }
    f = emu_decode(c->e->chip->m4, both & 0xffffu, both >> 16);
    if (c->e->mark != 0 && address == c->e->mark) {
        f |= INSN_MARK;
    }
    if (kept) {
        uint32_t at = i;

        c->flags[i] = f = (uint16_t)(f | (c->flags[i] & INSN_IN_IT));
        for (unsigned n = f >> INSN_IT_SHIFT; n > 0 && at + 2 < c->code_words; n--) {
            uint16_t hw;

            at += (c->flags[at] & INSN_WIDE) != 0 ? 2 : 1;
            memcpy(&hw, e_flash(c->e) + 2u * at, 2);
            c->flags[at] = (uint16_t)(INSN_IN_IT | (hw >= 0xe800u ? INSN_WIDE : 0));
        }
    }
    return f;
}

static void measure_stack(emu_cpu *c)
{
    uint32_t sp = engine_get(c, ENGINE_SP);

    c->look_at_stack = false;
    if (sp < c->e->meter.lowest_sp) {
        c->e->meter.lowest_sp = sp;
    }
}

static bool can_take(emu_cpu *c)
{
    return c->e->exc.any != 0 && engine_pick(c) != 0;
}

/* Brings time up to date; true = the processor has to leave its run of instructions. */
static bool look(emu_cpu *c, uint32_t address)
{
    emu *e = c->e;
    uint64_t now = emu_now(e), next;

    emu_apply_fixes(e);
    if (c->look_at_stack) {
        measure_stack(c);
    }
    next = emu_next_event(e);
    if (next <= now || e->exti_dirty) {
        emu_events(e);
        next = emu_next_event(e);
    }
    e->attention = emu_cycle_of(e, next < c->until_ns ? next : c->until_ns);
    if (e->attention <= e->cycle) {
        e->attention = e->cycle + 1;
    }
    return e->reset_asked != EMU_CAUSES || e->stop_here || e->lockup || !e->powered || c->code_dirty ||
           now >= c->until_ns || (e->stall_ns > now && address - c->code_base < 2u * c->code_words) ||
           can_take(c);
}

/* An instruction that is not ordinary; true = it does not run here. */
static bool special(emu_cpu *c, uint16_t f)
{
    if ((f & (INSN_WFI | INSN_HINT | INSN_ILLEGAL)) != 0) {
        c->why = (f & INSN_WFI) != 0 ? WHY_SLEEP : (f & INSN_HINT) != 0 ? WHY_HINT : WHY_UNDEFINED;
        return true;
    }
    if ((f & INSN_FPU) != 0 && (c->e->exc.cpacr >> 20 & 15u) != 15u) {
        c->why = WHY_NO_COPROCESSOR;
        return true;
    }
    if ((f & INSN_MARK) != 0) {
        emu_marked(c->e);
    }
    if ((f & (INSN_STACK | INSN_MASKS)) != 0) {
        c->look_at_stack = true;
        c->e->attention = 0;
    }
    return false;
}

bool engine_step(emu_cpu *c, uint32_t address)
{
    uint16_t f = flags_at(c, address);

    if (c->e->cycle >= c->e->attention && (f & INSN_IN_IT) == 0 && look(c, address)) {
        c->why = WHY_ATTENTION;
        return false;
    }
    return (f & ~(unsigned)(INSN_KNOWN | INSN_WIDE)) == 0 || !special(c, f);
}

/* ---- accesses ---- */

void engine_fault(emu_cpu *c, enum engine_why why, uint32_t address)
{
    if (c->why == WHY_NOTHING) {
        c->why = why;
        c->fault_address = address;
    }
    engine_halt(c);
}

static bool strict(emu_cpu *c, uint32_t address)
{
    const emu *e = c->e;

    return !e->chip->m4 || (e->exc.ccr & 8u) != 0 || address >= 0x40000000u ||
           (flags_at(c, engine_get(c, ENGINE_PC)) & INSN_STRICT) != 0;
}

void engine_access(emu_cpu *c, bool write, uint32_t address, unsigned bytes, uint32_t value)
{
    emu *e = c->e;

    if ((address & (bytes - 1u)) != 0 && strict(c, address)) {
        uint8_t old[8] = {0};

        if (write && emu_peek(e, address, old, bytes)) {
            emu_add_fix(e, address, bytes, old); /* the engine stores all the same */
        }
        engine_fault(c, WHY_UNALIGNED, address);
        return;
    }
    if (address - c->code_base < 2u * c->code_words || address < 2u * c->code_words) {
        if (write && !emu_flash_store(e, address, value, bytes)) {
            engine_fault(c, WHY_BUS, address);
        } else if (!write && address < 0x100u) {
            emu_misuse_named(e, "MEM", "null", "data read of %08lx", (unsigned long)address);
        }
    }
}

/* ---- exceptions ---- */

static void save_fpu(emu_cpu *c)
{
    if (c->e->chip->m4 && (c->e->exc.cpacr >> 20 & 15u) == 15u && c->e->exc.depth < EMU_DEPTH) {
        engine_fpu(c, c->fpu[c->e->exc.depth], true);
        c->fpu_saved[c->e->exc.depth] = true;
    } else if (c->e->exc.depth < EMU_DEPTH) {
        c->fpu_saved[c->e->exc.depth] = false;
    }
}

static void lock_up(emu_cpu *c)
{
    c->e->lockup = true;
}

static bool push_frame(emu_cpu *c, uint32_t return_to)
{
    static const unsigned order[6] = {0, 1, 2, 3, 12, ENGINE_LR};
    emu *e = c->e;
    uint32_t sp = engine_get(c, ENGINE_SP), frame[8], psr = engine_get(c, ENGINE_PSR);
    uint32_t pad = !e->chip->m4 || (e->exc.ccr & 0x200u) != 0 ? sp >> 2 & 1u : 0;
    emu_region_kind kind;
    uint8_t *m;

    for (unsigned i = 0; i < 6; i++) {
        frame[i] = engine_get(c, order[i]);
    }
    frame[6] = return_to & ~1u;
    frame[7] = (psr & 0xfffffc00u) | pad << 9 | (e->exc.depth > 0 ? e->exc.active[e->exc.depth - 1] : 0);
    frame[7] |= 1u << 24;
    sp = (sp & ~3u) - 32u - 4u * pad;
    engine_set(c, ENGINE_SP, sp);
    m = emu_memory_at(e, sp, 32, &kind);
    if (m == NULL || kind != EMU_RAM) {
        return false;
    }
    memcpy(m, frame, 32);
    return true;
}

static bool jump_to_vector(emu_cpu *c, unsigned number)
{
    uint32_t vector = 0;

    if (!emu_peek(c->e, c->e->exc.vtor + 4u * number, &vector, 4)) {
        return false;
    }
    engine_set(c, ENGINE_PC, vector);
    if ((vector & 1u) == 0) {
        c->thumb_lost = true;
    }
    return true;
}

static void enter(emu_cpu *c, unsigned number, uint32_t return_to)
{
    emu *e = c->e;
    bool pushed;

    save_fpu(c);
    pushed = push_frame(c, return_to);
    engine_set(c, ENGINE_LR, e->exc.depth > 0 ? 0xfffffff1u : 0xfffffff9u);
    e->cycle += e->chip->m4 ? 12 : 16;
    emu_exc_enter(e, number);
    engine_set(c, ENGINE_IPSR, number);
    measure_stack(c);
    if (!jump_to_vector(c, number)) {
        lock_up(c);
    } else if (!pushed && number != 3) {
        e->exc.cfsr |= 1u << 12; /* STKERR: escalates, as bus faults do that are not enabled */
        engine_raise(c, WHY_STACK, 0);
    }
}

static unsigned fault_class(emu_cpu *c, enum engine_why why, uint32_t address)
{
    static const uint8_t usage_bit[] = {[WHY_UNDEFINED] = 16,
                                        [WHY_STATE] = 17,
                                        [WHY_RETURN] = 18,
                                        [WHY_NO_COPROCESSOR] = 19,
                                        [WHY_UNALIGNED] = 24};
    emu_exceptions *x = &c->e->exc;

    switch (why) {
    case WHY_BUS:
        x->cfsr |= 1u << 9 | 1u << 15;
        x->bfar = address;
        return 5;
    case WHY_FETCH:
        x->cfsr |= 1u << 8;
        return 5;
    case WHY_STACK:
        return 5;
    case WHY_BREAK:
        x->hfsr |= 1u << 31;
        return 3;
    case WHY_UNDEFINED:
    case WHY_STATE:
    case WHY_RETURN:
    case WHY_NO_COPROCESSOR:
    case WHY_UNALIGNED:
        x->cfsr |= 1u << usage_bit[why];
        return 6;
    default:
        return 3;
    }
}

/* A synchronous exception: taken now, escalated to HardFault, or the end. */
void engine_raise(emu_cpu *c, enum engine_why why, uint32_t address)
{
    emu *e = c->e;
    unsigned number = why == WHY_CALL ? 11 : fault_class(c, why, address);
    int current = engine_priority(c);
    uint32_t pc = engine_get(c, ENGINE_PC);

    if (why != WHY_CALL && number != 3 && (!e->chip->m4 || (e->exc.shcsr >> (number + 12u) & 1u) == 0)) {
        e->exc.hfsr |= 1u << 30; /* FORCED */
        number = 3;
    }
    if (emu_exc_priority(e, number) >= current) {
        e->exc.hfsr |= number != 3 ? 1u << 30 : 0;
        number = 3;
    }
    if (current <= -1) {
        e->meter.faults++;
        lock_up(c);
        return;
    }
    enter(c, number, pc);
}

static bool pop_frame(emu_cpu *c)
{
    static const unsigned order[6] = {0, 1, 2, 3, 12, ENGINE_LR};
    uint32_t sp = engine_get(c, ENGINE_SP), frame[8];

    if (!emu_peek(c->e, sp, frame, 32)) {
        return false;
    }
    for (unsigned i = 0; i < 6; i++) {
        engine_set(c, order[i], frame[i]);
    }
    engine_set(c, ENGINE_FLAGS, frame[7] & 0xf80f0000u);
    engine_set(c, ENGINE_IPSR, frame[7] & 0x1ffu);
    engine_set(c, ENGINE_SP, sp + 32u + (frame[7] >> 9 & 1u) * 4u);
    engine_set(c, ENGINE_PC, frame[6] | 1u);
    return true;
}

static void leave(emu_cpu *c)
{
    emu *e = c->e;
    uint32_t code = engine_get(c, ENGINE_PC) | 1u;
    bool to_thread = e->exc.depth == 1;

    if (e->exc.depth == 0 || (code != (to_thread ? 0xfffffff9u : 0xfffffff1u))) {
        engine_raise(c, WHY_RETURN, code); /* return to a mode that was not left, or to the process stack */
        return;
    }
    if (emu_exc_leave(e) != 2) {
        engine_set(c, ENGINE_FAULTMASK, 0);
    }
    e->cycle += 10;
    if (!pop_frame(c)) {
        engine_raise(c, WHY_STACK, 0);
        return;
    }
    if (c->fpu_saved[e->exc.depth]) {
        engine_fpu(c, c->fpu[e->exc.depth], false);
    }
    if (to_thread && (e->exc.scr & 2u) != 0 && !can_take(c)) {
        engine_sleep(c);
    }
}

/* ---- what ended a run of instructions ---- */

void engine_handle(emu_cpu *c)
{
    enum engine_why why = c->why;

    c->why = WHY_NOTHING;
    switch (why) {
    case WHY_NOTHING:
    case WHY_ATTENTION:
        break;
    case WHY_SLEEP:
        engine_skip(c);
        engine_sleep(c);
        break;
    case WHY_HINT:
        engine_skip(c);
        break;
    case WHY_LEAVE:
        leave(c);
        break;
    default:
        engine_raise(c, why, c->fault_address);
        break;
    }
}

void engine_take(emu_cpu *c)
{
    unsigned number = c->e->exc.any != 0 ? engine_pick(c) : 0;

    if (number != 0) {
        enter(c, number, engine_get(c, ENGINE_PC));
    }
}
