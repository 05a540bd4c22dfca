/* SPDX-License-Identifier: Apache-2.0 */
/* Memories of the chip and what a test or programmer does to them. */
#include "emu_internal.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PAGE 4096u
#define LOST 0xa5u /* RAM after power on: no value that a program should expect */

static void fill_rom(emu *e, const emu_region *r, uint8_t *m)
{
    for (const emu_word *w = e->chip->rom; w != NULL && w->address != 0; w++) {
        if (w->address >= r->base && w->address - r->base + 4 <= r->size) {
            memcpy(m + (w->address - r->base), &w->value, 4);
        }
    }
}

bool emu_memory_make(emu *e)
{
    for (unsigned i = 0; e->chip->regions[i].size != 0; i++) {
        const emu_region *r = &e->chip->regions[i];

        if (r->kind == EMU_ALIAS) {
            e->memory[i] = e->memory[0]; /* flash stands first */
            continue;
        }
        e->memory[i] = aligned_alloc(PAGE, (r->size + PAGE - 1) / PAGE * PAGE);
        if (e->memory[i] == NULL) {
            return false;
        }
        memset(e->memory[i], r->kind == EMU_RAM ? LOST : 0xff, r->size);
        fill_rom(e, r, e->memory[i]);
    }
    return true;
}

void emu_memory_drop(emu *e)
{
    for (unsigned i = 0; e->chip->regions[i].size != 0; i++) {
        if (e->chip->regions[i].kind != EMU_ALIAS) {
            free(e->memory[i]);
        }
    }
}

void emu_memory_lose(emu *e)
{
    for (unsigned i = 0; e->chip->regions[i].size != 0; i++) {
        if (e->chip->regions[i].kind == EMU_RAM) {
            memset(e->memory[i], LOST, e->chip->regions[i].size);
        }
    }
}

uint8_t *emu_memory_at(const emu *e, uint32_t address, size_t n, emu_region_kind *kind)
{
    for (unsigned i = 0; e->chip->regions[i].size != 0; i++) {
        const emu_region *r = &e->chip->regions[i];

        if (address >= r->base && address - r->base < r->size && n <= r->size - (address - r->base)) {
            *kind = r->kind;
            return e->memory[i] + (address - r->base);
        }
    }
    return NULL;
}

void emu_add_fix(emu *e, uint32_t at, uint32_t size, const uint8_t *bytes)
{
    emu_fix *f = &e->fix[e->fixes < EMU_FIXES ? e->fixes++ : EMU_FIXES - 1];

    f->at = at;
    f->size = size;
    memcpy(f->bytes, bytes, size);
    emu_kick(e);
}

void emu_apply_fixes(emu *e)
{
    for (unsigned i = 0; i < e->fixes; i++) {
        emu_region_kind kind;
        uint8_t *m = emu_memory_at(e, e->fix[i].at, e->fix[i].size, &kind);

        if (m != NULL) {
            memcpy(m, e->fix[i].bytes, e->fix[i].size);
        }
    }
    e->fixes = 0;
}

bool emu_peek(const emu *e, uint32_t address, void *bytes, size_t n)
{
    emu_region_kind kind;
    const uint8_t *m = emu_memory_at(e, address, n, &kind);

    if (m != NULL) {
        memcpy(bytes, m, n);
    }
    return m != NULL;
}

bool emu_poke(emu *e, uint32_t address, const void *bytes, size_t n)
{
    emu_region_kind kind;
    uint8_t *m = emu_memory_at(e, address, n, &kind);

    if (m == NULL) {
        return false;
    }
    memcpy(m, bytes, n);
    emu_cpu_code_changed(e, address, (uint32_t)n);
    return true;
}

bool emu_load(emu *e, uint32_t address, const void *bytes, size_t n)
{
    emu_region_kind kind;

    return emu_memory_at(e, address, n, &kind) != NULL && kind == EMU_FLASH && emu_poke(e, address, bytes, n);
}

bool emu_load_file(emu *e, const char *path)
{
    FILE *f = fopen(path, "rb");
    uint8_t *m = e->memory[0];
    uint32_t size = e->chip->flash_size;
    size_t n;
    bool fits;

    if (f == NULL) {
        return false;
    }
    n = fread(m, 1, size, f);
    fits = n > 0 && ferror(f) == 0 && fgetc(f) == EOF;
    fclose(f);
    emu_cpu_code_changed(e, e->chip->flash_base, size);
    return fits;
}
