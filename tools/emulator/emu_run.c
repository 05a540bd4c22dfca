/* SPDX-License-Identifier: Apache-2.0 */
/* The main loop: awake, asleep, stalled, locked up, without power. */
#include "emu_engine.h"

static void book_pass(emu *e)
{
    uint64_t awake = e->cycle - e->awake_since;

    e->meter.passes++;
    if (awake > e->meter.longest_awake) {
        e->meter.longest_awake = awake;
        e->meter.longest_awake_ns = e->awake_since_ns;
    }
}

static void wake(emu_cpu *c)
{
    c->asleep = false;
    c->e->awake_since = c->e->cycle;
    c->e->awake_since_ns = emu_now(c->e);
}

/* A pending interrupt that would preempt ends sleep even while PRIMASK holds it back. */
static bool awakes(emu_cpu *c)
{
    return emu_exc_pick(c->e, false, false, 0) != 0;
}

void engine_sleep(emu_cpu *c)
{
    book_pass(c->e);
    c->asleep = true;
    if (awakes(c)) {
        wake(c);
    }
}

/* Time up to the next event or the end, without instructions. `busy`: the cycles count as spent. */
static void pass_time(emu *e, uint64_t until, bool busy)
{
    uint64_t next, before = emu_now(e);

    emu_events(e);
    next = emu_next_event(e);
    next = next < until ? next : until;
    if (next <= before) {
        return;
    }
    if (busy) {
        e->cycle = emu_cycle_of(e, next);
    } else {
        e->meter.cycles_asleep += (next - before) * (e->clock.hclk / 1000u) / 1000000u;
        emu_set_now(e, next);
    }
    emu_events(e);
}

/* The processor does not run now; true = time was spent instead. */
static bool rests(emu_cpu *c)
{
    emu *e = c->e;
    uint32_t pc = engine_get(c, ENGINE_PC);

    if (!e->powered || e->lockup) {
        pass_time(e, c->until_ns, false);
        return true;
    }
    if (c->asleep && !awakes(c)) {
        pass_time(e, c->until_ns, false);
        if (!awakes(c)) {
            return true;
        }
    }
    if (c->asleep) {
        wake(c);
        return true;
    }
    if (e->stall_ns > emu_now(e) && pc - c->code_base < 2u * c->code_words) {
        pass_time(e, e->stall_ns < c->until_ns ? e->stall_ns : c->until_ns, true);
        return true;
    }
    return false;
}

static bool over(emu_cpu *c, emu_stop *why)
{
    emu *e = c->e;

    if (e->powered && emu_settle_reset(e) && e->stop_on_reset) {
        *why = EMU_STOP_RESET;
        return true;
    }
    if (e->stop_here) {
        e->stop_here = false;
        *why = EMU_STOP_BREAK;
        return true;
    }
    if (emu_now(e) >= c->until_ns) {
        *why = e->lockup ? EMU_STOP_LOCKUP : EMU_STOP_TIME;
        return true;
    }
    return false;
}

emu_stop emu_run_until(emu *e, uint64_t ns)
{
    emu_cpu *c = e->cpu;
    emu_stop why;

    if (c == NULL) {
        return EMU_STOP_NO_CPU;
    }
    c->until_ns = ns;
    while (!over(c, &why)) {
        if (rests(c)) {
            continue;
        }
        engine_take(c);
        if (!e->lockup) {
            engine_run(c);
            engine_handle(c);
        }
    }
    (void)emu_outside(e);
    e->meter.cycles = e->cycle;
    return why;
}
