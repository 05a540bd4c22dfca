/* SPDX-License-Identifier: Apache-2.0 */
/* Shared part of the flash controllers. */
#include "emu_flash.h"
#include <stdlib.h>
#include <string.h>

bool flash_busy(const emu_periph *p)
{
    return ((const flash *)p->state)->busy_ns != 0;
}

static uint32_t next_random(uint32_t *x)
{
    *x = *x * 1664525u + 1013904223u;
    return *x >> 8;
}

/* What an interrupted operation leaves: a program any of its bits, an erase any of its bytes. */
static void mix(uint8_t *to, const uint8_t *old, uint32_t size, bool erase, uint32_t seed)
{
    uint32_t x = seed * 2654435761u + 12345u;

    for (uint32_t i = 0; i < size; i++) {
        uint8_t keep = (uint8_t)next_random(&x);

        if (erase) {
            to[i] = (keep & 1u) != 0 ? old[i] : 0xff;
        } else {
            to[i] = (uint8_t)(to[i] | (old[i] & keep));
        }
    }
}

static bool trap_springs(emu *e)
{
    if (e->trap.countdown == 0 || --e->trap.countdown != 0) {
        return false;
    }
    e->trap.sprung = true;
    emu_ask_reset(e, EMU_CAUSE_POWER);
    return true;
}

static void program(emu_periph *p, const uint8_t *result, bool cut)
{
    flash *s = p->state;
    uint8_t bytes[8];

    memcpy(bytes, result, s->size);
    if (cut) {
        mix(bytes, s->old, s->size, false, p->e->trap.seed);
        s->busy_ns = 0; /* settled: the reset must not mix again */
    }
    emu_add_fix(p->e, s->at, s->size, bytes);
}

static void erase(emu_periph *p, uint8_t *m, bool cut)
{
    flash *s = p->state;

    memset(m, 0xff, s->size);
    if (cut) {
        mix(m, s->old, s->size, true, p->e->trap.seed);
        s->busy_ns = 0;
    }
    emu_cpu_code_changed(p->e, s->at, s->size);
}

void flash_begin(emu_periph *p, uint32_t at, uint32_t size, const uint8_t *result, uint64_t ns)
{
    flash *s = p->state;
    emu_region_kind kind;
    uint8_t *m = emu_memory_at(p->e, at, size, &kind);
    bool cut;

    if (m == NULL) {
        return;
    }
    memcpy(s->old, m, size);
    s->at = at;
    s->size = size;
    s->busy_ns = emu_now(p->e) + ns;
    p->e->flash_ops++;
    emu_touch(p->e, p);
    cut = trap_springs(p->e);
    if (result != NULL) {
        program(p, result, cut);
    } else {
        erase(p, m, cut);
    }
    emu_stall_until(p->e, s->busy_ns);
}

uint64_t flash_next(const emu_periph *p)
{
    const flash *s = p->state;

    return s->busy_ns != 0 ? s->busy_ns : EMU_NEVER;
}

void flash_polled(emu_periph *p)
{
    emu *e = p->e;
    uint64_t now = emu_now(e), next;

    if (e->poll_ns == 0 || !e->running) {
        return;
    }
    next = emu_next_event(e);
    next = next < now + e->poll_ns ? next : now + e->poll_ns;
    if (next > now) {
        e->cycle = emu_cycle_of(e, next);
        emu_kick(e);
    }
}

void emu_set_flash_poll_ns(emu *e, uint64_t ns)
{
    e->poll_ns = ns;
}

void flash_abort(emu_periph *p)
{
    flash *s = p->state;
    emu_region_kind kind;
    uint8_t *m = emu_memory_at(p->e, s->at, s->size, &kind);

    if (s->busy_ns != 0 && m != NULL) {
        mix(m, s->old, s->size, s->size > 8, (uint32_t)(emu_now(p->e) / 1000u));
        emu_cpu_code_changed(p->e, s->at, s->size);
    }
    s->busy_ns = 0;
}

void flash_key(emu_periph *p, enum flash_lock *lock, uint32_t value, const char *reg)
{
    if (*lock == LOCKED && value == FLASH_KEY1) {
        *lock = HALF_OPEN;
    } else if (*lock == HALF_OPEN && value == FLASH_KEY2) {
        *lock = OPEN;
    } else {
        emu_misuse(p, reg,
                   *lock == OPEN ? "key written although open: locked until reset"
                                 : "wrong key: locked until reset");
        *lock = SHUT;
    }
}

bool emu_flash_store(emu *e, uint32_t address, uint32_t value, unsigned bytes)
{
    uint8_t old[8] = {0};

    if (address < e->chip->flash_base) {
        address += e->chip->flash_base; /* through the alias at 0 */
    }
    (void)emu_peek(e, address, old, bytes);
    emu_add_fix(e, address, bytes, old); /* the store itself changes nothing; an operation adds its own */
    return e->flash_store(e->flash, address, value, bytes);
}

void emu_flash_judge_latency(emu *e)
{
    if (e->flash != NULL) {
        e->flash_judge(e->flash);
    }
}

emu_periph *flash_new(emu *e, const emu_instance *at, uint32_t largest)
{
    /* the bytes of `old` stand behind the state and are freed with it */
    emu_periph *p = emu_periph_new(e, at, sizeof(flash) + largest);

    if (p != NULL) {
        ((flash *)p->state)->old = (uint8_t *)p->state + sizeof(flash);
        p->next = flash_next;
        e->flash = p;
    }
    return p;
}
