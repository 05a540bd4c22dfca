/* SPDX-License-Identifier: Apache-2.0 */
/* What is measured while the image runs. */
#include "emu_internal.h"

const emu_meter *emu_get_meter(const emu *e)
{
    return &e->meter;
}

void emu_meter_clear(emu *e)
{
    emu_meter *m = &e->meter;

    m->longest_awake = 0;
    m->longest_awake_ns = 0;
    m->longest_pass = 0;
    m->longest_pass_ns = 0;
    e->marked_ns = EMU_NEVER;
    m->longest_latency = 0;
    m->longest_latency_irq = 0;
    m->longest_isr = 0;
    m->lowest_sp = UINT32_MAX;
    e->awake_since = e->cycle;
    e->awake_since_ns = emu_now(e);
}

void emu_mark(emu *e, uint32_t address)
{
    e->mark = address & ~1u;
    e->marked_ns = EMU_NEVER;
    emu_cpu_code_changed(e, e->mark, 2);
}

void emu_marked(emu *e)
{
    uint64_t pass = e->cycle - e->marked;

    if (e->marked_ns != EMU_NEVER && pass > e->meter.longest_pass) {
        e->meter.longest_pass = pass;
        e->meter.longest_pass_ns = e->marked_ns;
    }
    e->marked = e->cycle;
    e->marked_ns = emu_now(e);
}
