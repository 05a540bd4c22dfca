/* SPDX-License-Identifier: Apache-2.0 */
/* In place of the processor where Unicorn is missing. */
#include "emu_internal.h"

bool emu_cpu_open(emu *e)
{
    (void)e;
    return false;
}

emu_stop emu_run_until(emu *e, uint64_t ns)
{
    (void)e;
    (void)ns;
    return EMU_STOP_NO_CPU;
}

bool emu_count_code(emu *e)
{
    (void)e;
    return false;
}

uint64_t emu_code_count(const emu *e, uint32_t address)
{
    (void)e;
    (void)address;
    return 0;
}

void emu_cpu_close(emu *e)
{
    (void)e;
}

void emu_cpu_reset(emu *e)
{
    (void)e;
}

uint32_t emu_cpu_pc(const emu *e)
{
    (void)e;
    return 0;
}

uint32_t emu_register(const emu *e, unsigned n)
{
    (void)e;
    (void)n;
    return 0;
}

void emu_cpu_code_changed(emu *e, uint32_t address, uint32_t n)
{
    (void)e;
    (void)address;
    (void)n;
}
