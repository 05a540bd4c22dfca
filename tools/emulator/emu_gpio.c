/* SPDX-License-Identifier: Apache-2.0 */
/* GPIO port of both families (RM0091 section 8, RM0090 section 8) and the pin services for other models. */
#include "emu_internal.h"

enum { MODER, OTYPER, OSPEEDR, PUPDR, IDR, ODR, BSRR, LCKR, AFRL, AFRH, BRR, WORDS };

static const char *const reg_names[WORDS] = {"MODER", "OTYPER", "OSPEEDR", "PUPDR", "IDR", "ODR",
                                             "BSRR",  "LCKR",   "AFRL",    "AFRH",  "BRR"};

typedef struct gpio {
    uint32_t reg[WORDS];
    uint8_t drive[16]; /**< last told to the world */
} gpio;

static unsigned port_of(const emu_periph *p)
{
    return p->at->number - 1u;
}

static const gpio *port(const emu *e, unsigned n)
{
    return n < EMU_PORTS && e->gpio[n] != NULL ? e->gpio[n]->state : NULL;
}

static unsigned mode_of(const gpio *g, unsigned pin)
{
    return g->reg[MODER] >> (2 * pin) & 3u;
}

/* ---- services ---- */

int emu_pin_af(const emu *e, unsigned number, unsigned pin)
{
    const gpio *g = port(e, number);

    if (g == NULL || pin > 15) {
        return -1;
    }
    switch (mode_of(g, pin)) {
    case 2:
        return (int)(g->reg[pin < 8 ? AFRL : AFRH] >> (4 * (pin & 7u)) & 15u);
    case 3:
        return (int)EMU_AF_ANALOG;
    default:
        return -1;
    }
}

bool emu_pin_open_drain(const emu *e, unsigned number, unsigned pin)
{
    const gpio *g = port(e, number);

    return g != NULL && (g->reg[OTYPER] >> pin & 1u) != 0;
}

emu_drive emu_gpio_drive(const emu *e, unsigned number, unsigned pin)
{
    const gpio *g = port(e, number);

    if (g == NULL || mode_of(g, pin) != 1) {
        return EMU_DRIVE_NONE;
    }
    if ((g->reg[ODR] >> pin & 1u) == 0) {
        return EMU_DRIVE_LOW;
    }
    return emu_pin_open_drain(e, number, pin) ? EMU_DRIVE_NONE : EMU_DRIVE_HIGH;
}

int emu_gpio_pull(const emu *e, unsigned number, unsigned pin)
{
    const gpio *g = port(e, number);
    unsigned pull = g == NULL ? 0 : g->reg[PUPDR] >> (2 * pin) & 3u;

    return pull == 1 ? 1 : pull == 2 ? 0 : -1;
}

bool emu_pin_level(emu *e, unsigned number, unsigned pin)
{
    const emu_world *w = emu_outside(e);
    bool exists = port(e, number) != NULL; /* EXTI can be pointed at a port that this chip has not got */
    int outside = exists ? w->pin_in(w->ctx, number, pin) : 0;
    emu_drive own = emu_gpio_drive(e, number, pin);

    if (outside == 0 || own == EMU_DRIVE_LOW) {
        return false;
    }
    if (outside == 1 || own == EMU_DRIVE_HIGH) {
        return true;
    }
    return emu_gpio_pull(e, number, pin) == 1;
}

const emu_pad *emu_pad_of(const emu *e, const emu_instance *at, unsigned signal)
{
    for (const emu_pad *pad = at->pads; pad != NULL && pad->signal != EMU_SIG_END; pad++) {
        const gpio *g = port(e, pad->port);

        if (pad->signal == signal && g != NULL && emu_clocked(e, e->gpio[pad->port]->at) &&
            emu_pin_af(e, pad->port, pad->pin) == (int)pad->af) {
            return pad;
        }
    }
    return NULL;
}

const emu_pad *emu_pad_needed(emu_periph *p, unsigned signal, const char *signal_name)
{
    const emu_pad *pad = emu_pad_of(p->e, p->at, signal);

    if (pad == NULL) {
        emu_misuse(p, "pin", "%s is on no pin: no alternate function selects it", signal_name);
    }
    return pad;
}

/* ---- registers ---- */

static void tell_world(emu_periph *p)
{
    gpio *g = p->state;

    for (unsigned pin = 0; pin < 16; pin++) {
        emu_drive drive = emu_gpio_drive(p->e, port_of(p), pin);

        if (drive != (emu_drive)g->drive[pin]) {
            const emu_world *w = emu_outside(p->e);

            g->drive[pin] = (uint8_t)drive;
            w->pin_out(w->ctx, port_of(p), pin, drive);
            p->e->exti_dirty = true;
        }
    }
}

static uint32_t input_data(emu_periph *p)
{
    const gpio *g = p->state;
    uint32_t v = 0;

    for (unsigned pin = 0; pin < 16; pin++) {
        if (mode_of(g, pin) != 3 && emu_pin_level(p->e, port_of(p), pin)) {
            v |= 1u << pin;
        }
    }
    return v;
}

static uint32_t gpio_read(emu_periph *p, uint32_t offset, unsigned bytes)
{
    const gpio *g = p->state;
    unsigned r = offset / 4;

    (void)bytes;
    if (r == IDR) {
        return input_data(p);
    }
    if (r >= WORDS || r == BSRR || r == BRR || (r == BRR && p->at->family == EMU_F4)) {
        return 0;
    }
    return g->reg[r];
}

static void judge_write(emu_periph *p, unsigned r, uint32_t value)
{
    if (r == PUPDR) {
        for (unsigned pin = 0; pin < 16; pin++) {
            if ((value >> (2 * pin) & 3u) == 3u) {
                emu_misuse(p, "PUPDR", "reserved pull setting 3 on pin %u", pin);
            }
        }
    }
    if (r == IDR) {
        emu_misuse(p, "IDR", "written, but it is read-only");
    }
    if ((r == OTYPER || r == ODR || r == BRR) && value >> 16 != 0) {
        emu_misuse(p, reg_names[r], "reserved bits %08lx set", (unsigned long)(value & 0xffff0000u));
    }
}

static void set_bits(gpio *g, uint32_t set, uint32_t clear)
{
    g->reg[ODR] = ((g->reg[ODR] & ~clear) | set) & 0xffffu; /* set wins (BSRR) */
}

static void gpio_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    gpio *g = p->state;
    unsigned r = offset / 4;

    if (r >= WORDS || (r == BRR && p->at->family == EMU_F4)) {
        emu_misuse(p, "port", "write of %03lx: no register here", (unsigned long)offset);
        return;
    }
    value = emu_merge(r == BSRR || r == BRR ? 0 : g->reg[r], offset, value, bytes);
    judge_write(p, r, value);
    if (r == BSRR) {
        set_bits(g, value & 0xffffu, value >> 16);
    } else if (r == BRR) {
        set_bits(g, 0, value & 0xffffu);
    } else if (r != IDR) {
        g->reg[r] = r == OTYPER || r == ODR ? value & 0xffffu : value;
    }
    tell_world(p);
}

static void gpio_reset(emu_periph *p)
{
    gpio *g = p->state;
    bool f4 = p->at->family == EMU_F4;

    for (unsigned r = 0; r < WORDS; r++) {
        g->reg[r] = 0;
    }
    if (port_of(p) == 0) { /* the debug port: PA13, PA14, on F4 PA15 too */
        g->reg[MODER] = f4 ? 0xa8000000u : 0x28000000u;
        g->reg[PUPDR] = f4 ? 0x64000000u : 0x24000000u;
        g->reg[OSPEEDR] = f4 ? 0x0c000000u : 0x0c000000u;
    } else if (port_of(p) == 1 && f4) { /* PB3, PB4 */
        g->reg[MODER] = 0x280u;
        g->reg[PUPDR] = 0x100u;
        g->reg[OSPEEDR] = 0xc0u;
    }
    tell_world(p);
}

emu_periph *emu_gpio_new(emu *e, const emu_instance *at)
{
    emu_periph *p = emu_periph_new(e, at, sizeof(gpio));

    if (p != NULL) {
        p->read = gpio_read;
        p->write = gpio_write;
        p->reset = gpio_reset;
        e->gpio[port_of(p)] = p;
    }
    return p;
}
