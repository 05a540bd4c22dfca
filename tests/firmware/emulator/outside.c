/* SPDX-License-Identifier: Apache-2.0 */
#include "outside.h"
#include <stdio.h>
#include <string.h>

outside out;
emu *chip;

static bool is_f0;

static void log_text(const char *format, unsigned value, const char *more)
{
    char text[12];

    (void)snprintf(text, sizeof text, format, value, more);
    if (strlen(out.log) + strlen(text) + 1 < sizeof out.log) {
        strcat(out.log, text);
    }
}

static emu_i2c_answer i2c_start(void *ctx, unsigned bus, uint8_t byte)
{
    (void)ctx;
    (void)bus;
    log_text("S%02x%s ", byte, "");
    return out.address_answer;
}

static emu_i2c_answer i2c_write(void *ctx, unsigned bus, uint8_t byte)
{
    bool meant = out.refuse_at >= 0 && out.written == (unsigned)out.refuse_at;

    (void)ctx;
    (void)bus;
    log_text("W%02x%s ", byte, "");
    out.written++;
    return meant ? out.byte_answer : EMU_I2C_ACK;
}

static uint8_t i2c_read(void *ctx, unsigned bus, bool ack)
{
    (void)ctx;
    (void)bus;
    log_text("R%02x%s ", out.next_read, ack ? "a" : "n");
    return out.next_read++;
}

static void i2c_stop(void *ctx, unsigned bus)
{
    (void)ctx;
    log_text("P%.0u%s ", bus * 0u, "");
}

static unsigned i2c_lines(void *ctx, unsigned bus)
{
    (void)ctx;
    (void)bus;
    return out.held;
}

static uint64_t i2c_stretch(void *ctx, unsigned bus)
{
    (void)ctx;
    (void)bus;
    return out.stretch_ns;
}

static uint16_t spi_frame(void *ctx, unsigned bus, const emu_spi_frame *frame)
{
    (void)ctx;
    (void)bus;
    out.frame[out.frames++ % 32] = *frame;
    return out.miso_undriven ? 0xffff : (uint16_t)~frame->value;
}

static emu_can_result can_out(void *ctx, unsigned bus, const emu_can_frame *frame)
{
    (void)ctx;
    (void)bus;
    out.sent_at[out.sents % 64] = emu_now(chip);
    out.sent[out.sents++ % 64] = *frame;
    return out.result;
}

static emu_can_wire can_wire(void *ctx, unsigned bus)
{
    (void)ctx;
    (void)bus;
    return out.wire;
}

static double adc_volts(void *ctx, unsigned adc, unsigned channel)
{
    (void)ctx;
    (void)adc;
    return channel < 19 ? out.volts[channel] : 0.0;
}

void outside_begin(const emu_chip *which)
{
    emu_world world = {.i2c_start = i2c_start,
                       .i2c_write = i2c_write,
                       .i2c_read = i2c_read,
                       .i2c_stop = i2c_stop,
                       .i2c_lines = i2c_lines,
                       .i2c_stretch_ns = i2c_stretch,
                       .spi_frame = spi_frame,
                       .can_out = can_out,
                       .can_wire = can_wire,
                       .adc_volts = adc_volts};

    memset(&out, 0, sizeof out);
    out.address_answer = EMU_I2C_ACK;
    out.refuse_at = -1;
    out.next_read = 0x40;
    is_f0 = which == &emu_f072;
    chip = emu_create(which, &world);
    TEST_ASSERT_NOT_NULL(chip);
}

void outside_end(void)
{
    emu_destroy(chip);
    chip = NULL;
}

void put(uint32_t address, uint32_t value)
{
    TEST_ASSERT_TRUE(emu_bus_write(chip, address, 4, value));
}

uint32_t get(uint32_t address)
{
    uint32_t value = 0;

    TEST_ASSERT_TRUE(emu_bus_read(chip, address, 4, &value));
    return value;
}

void set_bits(uint32_t address, uint32_t bits)
{
    put(address, get(address) | bits);
}

void pass(uint64_t ns)
{
    emu_advance(chip, ns);
}

static void field(uint32_t address, unsigned shift, uint32_t mask, uint32_t value)
{
    put(address, (get(address) & ~(mask << shift)) | value << shift);
}

void pin_function(unsigned port, unsigned pin, unsigned af, bool open_drain)
{
    uint32_t base = (is_f0 ? 0x48000000u : 0x40020000u) + 0x400u * port;

    if (is_f0) {
        set_bits(0x40021014u, 1u << (17u + port));
    } else {
        set_bits(0x40023830u, 1u << port);
    }
    if (af < 16) {
        field(base + 0x20u + 4u * (pin / 8u), 4u * (pin % 8u), 15, af);
    }
    field(base + 0x04u, pin, 1, open_drain);
    field(base, 2u * pin, 3, af < 16 ? 2 : 3);
}

uint64_t until(uint32_t address, uint32_t bits, uint64_t step_ns, int at)
{
    uint64_t from = emu_now(chip);

    while ((get(address) & bits) != bits) {
        if (emu_now(chip) - from > 100 * MS) {
            char text[60];

            (void)snprintf(text, sizeof text, "line %d: %08lx never shows %lx", at, (unsigned long)address,
                           (unsigned long)bits);
            TEST_FAIL_MESSAGE(text);
        }
        pass(step_ns);
    }
    return emu_now(chip) - from;
}

void no_misuse_at(int at)
{
    const sim_misuse *m = emu_get_misuse(chip);
    char text[160];

    (void)snprintf(text, sizeof text, "line %d: %s %s", at, m->entry[0].id, m->entry[0].text);
    TEST_ASSERT_EQUAL_MESSAGE(0, m->count, text);
}

void misuse_at(const char *periph, const char *reg, const char *part, int at)
{
    const sim_misuse *m = emu_get_misuse(chip);
    char id[32], text[160];

    (void)snprintf(id, sizeof id, "%s.%s", periph, reg);
    for (unsigned i = 0; i < m->count && i < SIM_MISUSE_KEPT; i++) {
        if (strncmp(m->entry[i].id, id, sizeof m->entry[i].id - 1) == 0 &&
            strstr(m->entry[i].text, part) != NULL) {
            return;
        }
    }
    (void)snprintf(text, sizeof text, "line %d: no %s \"%s\"; first of %u: %s %s", at, id, part,
                   (unsigned)m->count, m->entry[0].id, m->entry[0].text);
    TEST_FAIL_MESSAGE(text);
}

bool irq_pending(unsigned irq)
{
    return (get(0xe000e200u + 4u * (irq / 32u)) >> irq % 32u & 1u) != 0;
}

void irq_clear(unsigned irq)
{
    put(0xe000e280u + 4u * (irq / 32u), 1u << irq % 32u);
}
