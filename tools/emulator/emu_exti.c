/* SPDX-License-Identifier: Apache-2.0 */
/* EXTI and the part of SYSCFG that connects pins to it (RM0091 sections 9 and 11, RM0090 sections 9 and 12).
 */
#include "emu_internal.h"

enum { IMR, EMR, RTSR, FTSR, SWIER, PR, WORDS };

#define PIN_LINES 16u

typedef struct exti {
    uint32_t reg[WORDS];
    uint32_t level;  /**< of each line when last looked at */
    uint32_t inside; /**< lines 16.. as their sources drive them */
} exti;

/* Several lines share an interrupt: each instance row has four lines only, so EXTI drives the numbers of the
 * chip's own table, ORed here. */
static bool any_line_of(const emu_periph *p, uint8_t irq)
{
    const exti *x = p->state;

    for (unsigned line = 0; line < p->e->chip->exti_lines; line++) {
        if (p->e->chip->exti_irq[line] == irq && (x->reg[PR] & x->reg[IMR]) >> line & 1u) {
            return true;
        }
    }
    return false;
}

typedef struct exti_state {
    exti x;
    uint8_t driven[EMU_EXCEPTIONS];
} exti_state;

static void drive(emu_periph *p)
{
    exti_state *s = p->state;

    for (unsigned line = 0; line < p->e->chip->exti_lines; line++) {
        uint8_t irq = p->e->chip->exti_irq[line];

        if (irq != EMU_NO_IRQ) {
            bool on = any_line_of(p, irq);

            if (on != (s->driven[irq] != 0)) {
                s->driven[irq] = on;
                emu_exc_level(p->e, 16u + irq, on);
            }
        }
    }
}

static void edge(emu_periph *p, unsigned line, bool level)
{
    exti *x = p->state;
    uint32_t bit = 1u << line;

    if (((x->level & bit) != 0) == level) {
        return;
    }
    x->level ^= bit;
    if ((x->reg[level ? RTSR : FTSR] & bit) != 0 && (x->reg[IMR] & bit) != 0) {
        x->reg[PR] |= bit;
        drive(p);
    }
}

static bool level_of(emu *e, const exti *x, unsigned line)
{
    return line < PIN_LINES ? emu_pin_level(e, emu_syscfg_port(e, line), line)
                            : (x->inside >> line & 1u) != 0;
}

void emu_exti_refresh(emu *e)
{
    const exti *x;

    if (e->exti == NULL) {
        return;
    }
    x = e->exti->state;
    for (unsigned line = 0; line < PIN_LINES; line++) {
        if (((x->reg[RTSR] | x->reg[FTSR]) >> line & 1u) != 0) {
            edge(e->exti, line, level_of(e, x, line));
        }
    }
}

void emu_exti_line(emu *e, unsigned line, bool level)
{
    exti *x;

    if (e->exti == NULL || line < PIN_LINES || line >= e->chip->exti_lines) {
        return;
    }
    x = e->exti->state;
    x->inside = level ? x->inside | 1u << line : x->inside & ~(1u << line);
    edge(e->exti, line, level);
}

/* ---- registers ---- */

static uint32_t exti_read(emu_periph *p, uint32_t offset, unsigned bytes)
{
    const exti *x = p->state;

    (void)bytes;
    return offset / 4 < WORDS ? x->reg[offset / 4] : 0;
}

/* An edge detector that is switched on starts from the present level. */
static void arm(emu_periph *p, uint32_t lines)
{
    exti *x = p->state;

    for (unsigned line = 0; line < p->e->chip->exti_lines; line++) {
        if (lines >> line & 1u) {
            x->level = level_of(p->e, x, line) ? x->level | 1u << line : x->level & ~(1u << line);
        }
    }
}

static void exti_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    static const char *const names[WORDS] = {"IMR", "EMR", "RTSR", "FTSR", "SWIER", "PR"};
    exti *x = p->state;
    unsigned r = offset / 4;
    uint32_t before = x->reg[RTSR] | x->reg[FTSR];

    if (r >= WORDS) {
        return;
    }
    if (bytes != 4) {
        emu_misuse(p, names[r], "takes words only");
    }
    if (value >> (p->e->chip->exti_lines - 1u) > 1u) {
        emu_misuse(p, names[r], "reserved bits in %08lx", (unsigned long)value);
    }
    if (r == PR) {
        x->reg[PR] &= ~value;
        x->reg[SWIER] &= ~value;
    } else if (r == SWIER) {
        uint32_t fresh = value & ~x->reg[SWIER] & x->reg[IMR];

        x->reg[SWIER] |= value;
        x->reg[PR] |= fresh;
    } else {
        x->reg[r] = value;
    }
    arm(p, (x->reg[RTSR] | x->reg[FTSR]) & ~before);
    drive(p);
}

static void exti_reset(emu_periph *p)
{
    exti *x = p->state;

    for (unsigned r = 0; r < WORDS; r++) {
        x->reg[r] = 0;
    }
    if (p->at->family == EMU_F0) {
        x->reg[IMR] = 0x7f840000u; /* direct lines of the STM32F07x */
    }
    x->level = x->inside;
    drive(p);
}

emu_periph *emu_exti_new(emu *e, const emu_instance *at)
{
    emu_periph *p = emu_periph_new(e, at, sizeof(exti_state));

    if (p != NULL) {
        p->read = exti_read;
        p->write = exti_write;
        p->reset = exti_reset;
        e->exti = p;
    }
    return p;
}

/* ---- SYSCFG ---- */

unsigned emu_syscfg_port(const emu *e, unsigned line)
{
    const uint32_t *r = e->syscfg->state;

    return r[2 + line / 4] >> (4 * (line & 3u)) & 15u;
}

static uint32_t syscfg_read(emu_periph *p, uint32_t offset, unsigned bytes)
{
    const uint32_t *r = p->state;

    (void)bytes;
    return offset < 0x20 ? r[offset / 4] : 0;
}

static void syscfg_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    uint32_t *r = p->state;

    (void)bytes;
    if (offset >= 0x20) {
        return;
    }
    if (offset >= 8 && offset < 0x18) {
        value = emu_reserved(p, "EXTICR", value, 0xffffu);
        for (unsigned i = 0; i < 4; i++) {
            unsigned n = value >> (4 * i) & 15u;

            if (n >= EMU_PORTS || p->e->gpio[n] == NULL) {
                emu_misuse(p, "EXTICR", "line %u on port %u, which does not exist", (unsigned)offset - 8 + i,
                           n);
            }
        }
    }
    r[offset / 4] = value;
    p->e->exti_dirty = true;
}

static void syscfg_reset(emu_periph *p)
{
    uint32_t *r = p->state;

    for (unsigned i = 0; i < 8; i++) {
        r[i] = 0;
    }
}

emu_periph *emu_syscfg_new(emu *e, const emu_instance *at)
{
    emu_periph *p = emu_periph_new(e, at, 0x20);

    if (p != NULL) {
        p->read = syscfg_read;
        p->write = syscfg_write;
        p->reset = syscfg_reset;
        e->syscfg = p;
    }
    return p;
}
