/* SPDX-License-Identifier: Apache-2.0 */
#include "regs.h"
#include "unity.h"
#include <string.h>

static void advance(void *ctx, uint64_t now_ns)
{
    ((regs_world *)ctx)->now_ns = now_ns;
}

static uint64_t next(void *ctx)
{
    regs_world *w = ctx;

    return w->next_ns > w->now_ns ? w->next_ns : EMU_NEVER;
}

static int pin_in(void *ctx, unsigned port, unsigned pin)
{
    return ((regs_world *)ctx)->level[port][pin];
}

static void pin_out(void *ctx, unsigned port, unsigned pin, emu_drive drive)
{
    regs_world *w = ctx;

    w->drive[port][pin] = drive;
    w->pin_changes++;
}

static void uart_out(void *ctx, unsigned uart, uint8_t byte)
{
    regs_world *w = ctx;

    (void)uart;
    if (w->sent_count < sizeof w->sent) {
        w->sent_ns[w->sent_count] = w->now_ns;
        w->sent[w->sent_count++] = byte;
    }
}

emu_world regs_world_of(regs_world *w)
{
    emu_world world = {.ctx = w,
                       .advance = advance,
                       .next = next,
                       .pin_in = pin_in,
                       .pin_out = pin_out,
                       .uart_out = uart_out};

    memset(w, 0, sizeof *w);
    w->next_ns = EMU_NEVER;
    memset(w->level, 0xff, sizeof w->level);
    return world;
}

static uint32_t read_n(emu *e, uint32_t address, unsigned bytes)
{
    uint32_t v = 0;

    TEST_ASSERT_TRUE(emu_bus_read(e, address, bytes, &v));
    return v;
}

uint32_t rd(emu *e, uint32_t address)
{
    return read_n(e, address, 4);
}

uint32_t rd16(emu *e, uint32_t address)
{
    return read_n(e, address, 2);
}

uint32_t rd8(emu *e, uint32_t address)
{
    return read_n(e, address, 1);
}

void wr(emu *e, uint32_t address, uint32_t value)
{
    TEST_ASSERT_TRUE(emu_bus_write(e, address, 4, value));
}

void wr16(emu *e, uint32_t address, uint32_t value)
{
    TEST_ASSERT_TRUE(emu_bus_write(e, address, 2, value));
}

void wr8(emu *e, uint32_t address, uint32_t value)
{
    TEST_ASSERT_TRUE(emu_bus_write(e, address, 1, value));
}

void set(emu *e, uint32_t address, uint32_t bits)
{
    wr(e, address, rd(e, address) | bits);
}

void clear(emu *e, uint32_t address, uint32_t bits)
{
    wr(e, address, rd(e, address) & ~bits);
}

void advance_us(emu *e, uint64_t us)
{
    emu_advance(e, us * 1000u);
}

uint32_t misuse(emu *e, const char *periph)
{
    return periph == NULL ? emu_get_misuse(e)->count : emu_misuse_of(e, periph, NULL);
}

bool pending(emu *e, unsigned irq)
{
    return (rd(e, 0xe000e200u + irq / 32u * 4u) >> (irq % 32u) & 1u) != 0;
}
