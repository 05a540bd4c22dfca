/* SPDX-License-Identifier: Apache-2.0 */
/* Resets and the supply. */
#include "emu_internal.h"

#define POWER_DOWN_MV 1880u /* power-on and power-down reset level of both families, typical falling edge */
#define POWER_UP_MV 1920u

emu_cause emu_reset_cause(const emu *e)
{
    return e->reset_now;
}

void emu_ask_reset(emu *e, emu_cause cause)
{
    if (e->reset_asked == EMU_CAUSES) {
        e->reset_asked = cause;
    }
    emu_kick(e);
}

static bool loses_ram(emu_cause cause)
{
    return cause == EMU_CAUSE_POWER || cause == EMU_CAUSE_BROWNOUT;
}

void emu_take_reset(emu *e, emu_cause cause)
{
    e->reset_now = cause;
    e->reset_asked = EMU_CAUSES;
    e->reset_happened = true;
    e->lockup = false;
    e->stall_ns = 0;
    e->dma_lines = 0;
    emu_apply_fixes(e);
    if (loses_ram(cause)) {
        emu_memory_lose(e);
    }
    emu_exc_reset(e);
    for (unsigned i = 0; i < e->periphs; i++) {
        if (e->periph[i]->reset != NULL) {
            e->periph[i]->reset(e->periph[i]);
        }
    }
    e->touched = UINT64_MAX;
    emu_cpu_reset(e);
    e->meter.resets[cause]++;
    e->meter.lowest_sp = UINT32_MAX;
    e->awake_since = e->cycle;
    e->awake_since_ns = emu_now(e);
    e->marked_ns = EMU_NEVER;
    e->reset_now = EMU_CAUSES;
    emu_kick(e);
}

void emu_reset(emu *e, emu_cause cause)
{
    if (cause != EMU_CAUSE_LOCKUP && cause < EMU_CAUSES) {
        emu_take_reset(e, cause);
        e->reset_happened = false;
    }
}

void emu_clock_dead(emu *e)
{
    e->lockup = true;
    emu_kick(e);
}

/* Without supply nothing drives a pin, long before the start that resets the rest. */
static void release_pins(emu *e)
{
    for (unsigned i = 0; i < sizeof e->gpio / sizeof e->gpio[0]; i++) {
        if (e->gpio[i] != NULL) {
            e->gpio[i]->reset(e->gpio[i]);
        }
    }
}

bool emu_settle_reset(emu *e)
{
    if (e->reset_asked == EMU_CAUSES) {
        return false;
    }
    if (e->trap.sprung) { /* power was lost: it is off for a while */
        e->trap.sprung = false;
        release_pins(e);
        emu_set_now(e, emu_now(e) + e->trap.off_ns);
        (void)emu_outside(e);
    }
    emu_take_reset(e, e->reset_asked);
    return true;
}

void emu_set_supply_mv(emu *e, unsigned mv)
{
    e->supply_mv = mv;
    e->touched = UINT64_MAX;
    emu_kick(e);
    if (e->powered && mv < POWER_DOWN_MV) {
        e->powered = false; /* everything is reset now; the start waits for the supply */
        release_pins(e);
        emu_ask_reset(e, EMU_CAUSE_POWER);
    } else if (!e->powered && mv >= POWER_UP_MV) {
        e->powered = true;
    }
    emu_pwr_supply(e);
}

void emu_set_crystal(emu *e, bool works)
{
    e->crystal = works;
    e->touched = UINT64_MAX;
    emu_rcc_crystal(e);
    emu_kick(e);
}

void emu_set_lsi_hz(emu *e, uint32_t hz)
{
    e->lsi_hz = hz;
}

void emu_lose_power_at_flash_op(emu *e, unsigned n, uint32_t seed, uint64_t off_ns)
{
    e->trap = (emu_flash_trap){.countdown = n, .seed = seed, .off_ns = off_ns};
}

uint32_t emu_flash_ops(const emu *e)
{
    return e->flash_ops;
}
