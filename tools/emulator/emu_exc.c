/* SPDX-License-Identifier: Apache-2.0 */
/* Exceptions as the core and its interrupt controller see them: pending, enabled, active, priorities. */
#include "emu_internal.h"
#include <string.h>

#define THREAD 256

void emu_exc_reset(emu *e)
{
    emu_exceptions *x = &e->exc;
    uint8_t level[EMU_EXCEPTIONS];

    memcpy(level, x->level, sizeof level); /* lines are withdrawn by the models that hold them */
    memset(x, 0, sizeof *x);
    memcpy(x->level, level, sizeof level);
    x->ccr = e->chip->m4 ? 0x200u : 0x208u;
    x->prigroup_mask = 0xffu << (8 - e->chip->priority_bits) & (e->chip->m4 ? 0xfeu : 0xffu);
    x->vtor = 0;
}

static bool can_wait(const emu *e, unsigned number)
{
    return number < 16u + e->chip->irqs;
}

void emu_exc_pend(emu *e, unsigned number)
{
    if (can_wait(e, number) && !e->exc.pending[number]) {
        e->exc.pending[number] = 1;
        e->exc.any++;
        e->exc.pend_cycle[number] = e->cycle;
        emu_kick(e);
    }
}

void emu_exc_unpend(emu *e, unsigned number)
{
    if (can_wait(e, number) && e->exc.pending[number] && e->exc.level[number] == 0) {
        e->exc.pending[number] = 0;
        e->exc.any--;
    }
}

void emu_exc_level(emu *e, unsigned number, bool level)
{
    if (!can_wait(e, number)) {
        return;
    }
    if (level) {
        e->exc.level[number]++;
        emu_exc_pend(e, number);
    } else {
        e->exc.level[number]--;
    }
}

int emu_exc_priority(const emu *e, unsigned number)
{
    switch (number) {
    case 1:
        return -3;
    case 2:
        return -2;
    case 3:
        return -1;
    default:
        return (int)(e->exc.priority[number] & e->exc.prigroup_mask);
    }
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

int emu_exc_current(const emu *e, bool primask, bool faultmask, uint32_t basepri)
{
    int now = THREAD;

    for (unsigned i = 0; i < e->exc.depth; i++) {
        now = least(now, emu_exc_priority(e, e->exc.active[i]));
    }
    if (e->chip->m4 && basepri != 0) {
        now = least(now, (int)(basepri & e->exc.prigroup_mask));
    }
    if (primask) {
        now = least(now, 0);
    }
    return e->chip->m4 && faultmask ? least(now, -1) : now;
}

static bool enabled(const emu *e, unsigned number)
{
    return number < 16 || e->exc.enabled[number] != 0;
}

/* Among equal preempting parts the whole priority decides, then the number. */
static int rank(const emu *e, unsigned number)
{
    return number < 4 ? emu_exc_priority(e, number) : e->exc.priority[number];
}

unsigned emu_exc_pick(const emu *e, bool primask, bool faultmask, uint32_t basepri)
{
    unsigned best = 0;

    if (e->exc.any == 0) {
        return 0;
    }
    for (unsigned i = 2; i < 16u + e->chip->irqs; i++) {
        if (e->exc.pending[i] && enabled(e, i) && (best == 0 || rank(e, i) < rank(e, best))) {
            best = i;
        }
    }
    if (best == 0 || emu_exc_priority(e, best) >= emu_exc_current(e, primask, faultmask, basepri)) {
        return 0;
    }
    return best;
}

static void measure_latency(emu *e, unsigned number)
{
    uint64_t waited = e->cycle - e->exc.pend_cycle[number];

    if (number >= 16 && waited > e->meter.longest_latency) {
        e->meter.longest_latency = waited;
        e->meter.longest_latency_irq = number - 16;
    }
}

void emu_exc_enter(emu *e, unsigned number)
{
    if (e->exc.pending[number]) {
        e->exc.pending[number] = 0;
        e->exc.any--;
        measure_latency(e, number);
    }
    if (e->exc.depth == 0) {
        e->isr_since = e->cycle;
    }
    if (e->exc.depth < EMU_DEPTH) {
        e->exc.active[e->exc.depth++] = (uint8_t)number;
    }
    e->meter.exceptions++;
    if (number == 3) {
        e->meter.faults++;
    }
}

unsigned emu_exc_leave(emu *e)
{
    unsigned number = e->exc.active[--e->exc.depth];

    if (e->exc.level[number] != 0) {
        emu_exc_pend(e, number);
    }
    if (e->exc.depth == 0 && e->cycle - e->isr_since > e->meter.longest_isr) {
        e->meter.longest_isr = e->cycle - e->isr_since;
    }
    emu_kick(e);
    return number;
}
