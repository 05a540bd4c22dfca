/* SPDX-License-Identifier: Apache-2.0 */
/* Accesses: which model or memory an address belongs to, clock gate, narrow writes; and the judge's book. */
#include "emu_internal.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* ---- judge ---- */

static unsigned find_entry(const emu *e, const sim_misuse_entry *like)
{
    unsigned kept = e->misuse.count < SIM_MISUSE_KEPT ? e->misuse.count : SIM_MISUSE_KEPT;

    for (unsigned i = 0; i < kept; i++) {
        if (strcmp(e->misuse.entry[i].id, like->id) == 0 &&
            strcmp(e->misuse.entry[i].text, like->text) == 0) {
            return i;
        }
    }
    return kept;
}

static void record(emu *e, const char *periph, const char *reg, const char *format, va_list args)
{
    sim_misuse_entry m = {0};
    unsigned n;

    snprintf(m.id, sizeof m.id, "%s.%s", periph, reg);
    vsnprintf(m.text, sizeof m.text, format, args);
    n = find_entry(e, &m);
    if (n < SIM_MISUSE_KEPT) {
        if (e->misuse_count[n] == 0 || n >= e->misuse.count) {
            e->misuse_count[n] = 0;
            e->misuse_pc[n] = emu_cpu_pc(e);
            sim_misuse_add(&e->misuse, emu_now(e), 0, m.id, m.text);
        }
        e->misuse_count[n]++;
    }
}

void emu_misuse_named(emu *e, const char *periph, const char *reg, const char *format, ...)
{
    va_list args;

    va_start(args, format);
    record(e, periph, reg, format, args);
    va_end(args);
}

void emu_misuse(emu_periph *p, const char *reg, const char *format, ...)
{
    va_list args;

    va_start(args, format);
    record(p->e, p->at->name, reg, format, args);
    va_end(args);
}

uint32_t emu_reserved(emu_periph *p, const char *reg, uint32_t value, uint32_t allowed)
{
    if ((value & ~allowed) != 0) {
        emu_misuse(p, reg, "reserved bits %08lx set", (unsigned long)(value & ~allowed));
    }
    return value & allowed;
}

sim_misuse *emu_get_misuse(emu *e)
{
    return &e->misuse;
}

uint32_t emu_misuse_pc(const emu *e, unsigned n)
{
    return n < SIM_MISUSE_KEPT && n < e->misuse.count ? e->misuse_pc[n] : 0;
}

uint32_t emu_misuse_of(const emu *e, const char *periph, const char *reg)
{
    uint32_t sum = 0;
    size_t length = strlen(periph);

    for (unsigned i = 0; i < SIM_MISUSE_KEPT && i < e->misuse.count; i++) {
        const char *id = e->misuse.entry[i].id;

        if (strncmp(id, periph, length) == 0 && id[length] == '.' &&
            (reg == NULL || strcmp(id + length + 1, reg) == 0)) {
            sum += e->misuse_count[i];
        }
    }
    return sum;
}

/* ---- interrupts and requests ---- */

void emu_irq(emu_periph *p, unsigned index, bool level)
{
    uint8_t bit = (uint8_t)(1u << index);
    uint8_t *lines = &p->e->irq_lines[p->slot];

    if (((*lines & bit) != 0) == level || p->at->irq[index] == EMU_NO_IRQ) {
        return;
    }
    *lines ^= bit;
    emu_exc_level(p->e, 16u + p->at->irq[index], level);
}

void emu_nmi(emu *e)
{
    emu_exc_pend(e, 2);
}

void emu_dma_request(emu *e, emu_dma_line line, bool level)
{
    if (emu_dma_level(e, line) == level) {
        return;
    }
    e->dma_lines ^= 1u << line;
    for (unsigned i = 0; i < e->periphs; i++) {
        if (e->periph[i]->dma != NULL) {
            emu_touch(e, e->periph[i]);
            e->periph[i]->dma(e->periph[i], line, level);
        }
    }
}

bool emu_dma_level(const emu *e, emu_dma_line line)
{
    return (e->dma_lines >> line & 1u) != 0;
}

/* ---- routing ---- */

uint32_t emu_merge(uint32_t old, uint32_t offset, uint32_t value, unsigned bytes)
{
    uint32_t mask = bytes >= 4 ? 0xffffffffu : (1u << (8 * bytes)) - 1u;
    unsigned shift = bytes >= 4 ? 0 : 8 * (offset & 3u);

    return (old & ~(mask << shift)) | (value & mask) << shift;
}

static bool rcc_bit(const emu *e, uint8_t reg, uint8_t bit)
{
    return reg != 0xff && e->rcc != NULL && (e->rcc[reg / 4] >> bit & 1u) != 0;
}

bool emu_clocked(const emu *e, const emu_instance *at)
{
    return at->enable_reg == 0xff || rcc_bit(e, at->enable_reg, at->enable_bit);
}

static emu_periph *periph_at(emu *e, uint32_t address)
{
    for (unsigned k = 0; k < e->periphs; k++) {
        unsigned i = k == 0 ? e->last_hit : k <= e->last_hit ? k - 1 : k;
        const emu_instance *at = e->periph[i]->at;

        if (address >= at->base && address - at->base < at->size) {
            e->last_hit = i;
            return e->periph[i];
        }
    }
    return NULL;
}

static bool refused(emu_periph *p, uint32_t offset, const char *what, const char *why)
{
    char reg[12];

    snprintf(reg, sizeof reg, "%03lx", (unsigned long)(offset & 0xfffu));
    emu_misuse(p, reg, "%s %s", what, why);
    return false;
}

static bool usable(emu_periph *p, uint32_t offset, const char *what)
{
    emu_touch(p->e, p);
    if (!emu_clocked(p->e, p->at)) {
        return refused(p, offset, what, "without its clock enabled");
    }
    if (p->at->reset_reg != 0xff && rcc_bit(p->e, p->at->reset_reg, p->at->enable_bit)) {
        return refused(p, offset, what, "while held in reset");
    }
    return true;
}

bool emu_in_window(const emu *e, uint32_t address)
{
    for (const emu_window *w = e->chip->windows; w->size != 0; w++) {
        if (address >= w->base && address - w->base < w->size) {
            return true;
        }
    }
    return false;
}

static bool hole(emu *e, uint32_t address, const char *what)
{
    if (!emu_in_window(e, address)) {
        return false;
    }
    emu_misuse_named(e, "BUS", "hole", "%s of %08lx, where nothing is modelled", what,
                     (unsigned long)address);
    return true;
}

static bool on_apb(const emu_periph *p)
{
    return p->at->bus == EMU_APB1 || p->at->bus == EMU_APB2;
}

bool emu_route_read(emu *e, uint32_t address, unsigned bytes, uint32_t *value)
{
    emu_periph *p = periph_at(e, address);
    uint32_t offset, word;

    *value = 0;
    if (p == NULL) {
        return hole(e, address, "read");
    }
    offset = address - p->at->base;
    emu_kick(e);
    if (!usable(p, offset, "read")) {
        return true;
    }
    word = p->read != NULL ? p->read(p, on_apb(p) ? offset & ~3u : offset, bytes) : 0;
    word >>= 8 * (offset & 3u);
    *value = bytes >= 4 ? word : word & ((1u << (8 * bytes)) - 1u);
    return true;
}

static uint32_t duplicated(uint32_t value, unsigned bytes)
{
    switch (bytes) {
    case 1:
        return (value & 0xffu) * 0x01010101u;
    case 2:
        return (value & 0xffffu) * 0x00010001u;
    default:
        return value;
    }
}

bool emu_route_write(emu *e, uint32_t address, unsigned bytes, uint32_t value)
{
    emu_periph *p = periph_at(e, address);
    uint32_t offset;

    if (p == NULL) {
        return hole(e, address, "write");
    }
    offset = address - p->at->base;
    emu_kick(e);
    if (!usable(p, offset, "write") || p->write == NULL) {
        return true;
    }
    if (on_apb(p)) {
        p->write(p, offset & ~3u, duplicated(value, bytes), bytes);
    } else {
        p->write(p, offset, value, bytes);
    }
    return true;
}

/* ---- whole accesses: memory or peripheral ---- */

bool emu_bus_read(emu *e, uint32_t address, unsigned bytes, uint32_t *value)
{
    emu_region_kind kind;
    const uint8_t *m = emu_memory_at(e, address, bytes, &kind);

    if (m != NULL) {
        *value = 0;
        for (unsigned i = 0; i < bytes; i++) {
            *value |= (uint32_t)m[i] << (8 * i);
        }
        return true;
    }
    bool there = emu_route_read(e, address, bytes, value);

    if (!e->running) {
        emu_events(e);
        emu_settle_reset(e);
    }
    return there;
}

bool emu_bus_write(emu *e, uint32_t address, unsigned bytes, uint32_t value)
{
    emu_region_kind kind;
    uint8_t *m = emu_memory_at(e, address, bytes, &kind);

    if (m != NULL && kind == EMU_RAM) {
        for (unsigned i = 0; i < bytes; i++) {
            m[i] = (uint8_t)(value >> (8 * i));
        }
        return true;
    }
    if (m != NULL) {
        if (kind == EMU_ROM) {
            return false;
        }
        bool stored = emu_flash_store(e, address, value, bytes);

        emu_apply_fixes(e);
        if (!stored) {
            return false;
        }
    }
    bool there = m != NULL || emu_route_write(e, address, bytes, value);

    if (!e->running) {
        emu_events(e);
        emu_settle_reset(e);
    }
    return there;
}

static bool piecewise(emu *e, uint32_t address, size_t n, unsigned *width)
{
    *width = n == 1 || n == 2 || n == 4 ? (unsigned)n : 1;
    return emu_memory_at(e, address, n, &(emu_region_kind){EMU_RAM}) != NULL || n == *width;
}

bool emu_mem_read(emu *e, uint32_t address, void *bytes, size_t n)
{
    emu_region_kind kind;
    const uint8_t *m = emu_memory_at(e, address, n, &kind);
    unsigned width;
    uint32_t value;

    if (m != NULL) {
        memcpy(bytes, m, n);
        return true;
    }
    if (!piecewise(e, address, n, &width) || !emu_route_read(e, address, width, &value)) {
        return false;
    }
    memcpy(bytes, &value, n);
    return true;
}

bool emu_mem_write(emu *e, uint32_t address, const void *bytes, size_t n)
{
    emu_region_kind kind;
    uint8_t *m = emu_memory_at(e, address, n, &kind);
    unsigned width;
    uint32_t value = 0;

    if (m != NULL && kind == EMU_RAM) {
        memcpy(m, bytes, n);
        return true;
    }
    if (m != NULL || !piecewise(e, address, n, &width)) {
        return false;
    }
    memcpy(&value, bytes, n);
    return emu_route_write(e, address, width, value);
}
