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
    m->longest_latency = 0;
    m->longest_latency_irq = 0;
    m->longest_isr = 0;
    m->lowest_sp = UINT32_MAX;
    e->awake_since = e->cycle;
    e->awake_since_ns = emu_now(e);
}
