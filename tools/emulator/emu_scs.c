/* SPDX-License-Identifier: Apache-2.0 */
/* System control space at e000e000: NVIC, SCB, SysTick (PM0215 for Cortex-M0, PM0214 for Cortex-M4). */
#include "emu_internal.h"

#define ISER 0x100u
#define ICER 0x180u
#define ISPR 0x200u
#define ICPR 0x280u
#define IABR 0x300u
#define IPR 0x400u
#define CPUID 0xd00u
#define ICSR 0xd04u
#define VTOR 0xd08u
#define AIRCR 0xd0cu
#define SCR 0xd10u
#define CCR 0xd14u
#define SHPR1 0xd18u
#define SHCSR 0xd24u
#define CFSR 0xd28u
#define HFSR 0xd2cu
#define MMFAR 0xd34u
#define BFAR 0xd38u
#define CPACR 0xd88u
#define DEMCR 0xdfcu
#define STIR 0xf00u
#define VECTKEY 0x05fau

typedef struct systick {
    uint32_t control, reload;
    uint64_t due_ns; /**< of the next passage through 0 */
    bool flag;
} systick;

/* ---- SysTick ---- */

static uint32_t tick_hz(const emu_periph *p)
{
    const systick *s = p->state;

    return (s->control & 4u) != 0 ? p->e->clock.hclk : p->e->clock.hclk / 8u;
}

static uint64_t tick_next(const emu_periph *p)
{
    return ((const systick *)p->state)->due_ns;
}

static void tick_start(emu_periph *p, uint64_t from_ns)
{
    systick *s = p->state;

    s->due_ns = (s->control & 1u) != 0 && s->reload != 0
                    ? from_ns + emu_cycles_ns(tick_hz(p), (uint64_t)s->reload + 1u)
                    : EMU_NEVER;
}

static void tick_run(emu_periph *p)
{
    systick *s = p->state;

    s->flag = true;
    if ((s->control & 2u) != 0) {
        emu_exc_pend(p->e, 15);
    }
    tick_start(p, s->due_ns);
}

static uint32_t tick_value(const emu_periph *p)
{
    const systick *s = p->state;
    uint64_t now = emu_now(p->e);

    if (s->due_ns == EMU_NEVER || s->due_ns <= now) {
        return 0;
    }
    return (uint32_t)((s->due_ns - now) * tick_hz(p) / 1000000000u) & 0xffffffu;
}

static uint32_t tick_read(emu_periph *p, uint32_t offset)
{
    systick *s = p->state;

    if (offset == 0x10) {
        uint32_t v = s->control | (s->flag ? 1u << 16 : 0);

        s->flag = false;
        return v;
    }
    return offset == 0x14 ? s->reload : offset == 0x18 ? tick_value(p) : 0;
}

static void tick_write(emu_periph *p, uint32_t offset, uint32_t value)
{
    systick *s = p->state;

    if (offset == 0x10) {
        bool was = (s->control & 1u) != 0;

        s->control = emu_reserved(p, "SYST_CSR", value & ~(1u << 16), 7u);
        if (was != ((value & 1u) != 0)) {
            tick_start(p, emu_now(p->e));
        }
    } else if (offset == 0x14) {
        s->reload = emu_reserved(p, "SYST_RVR", value, 0xffffffu);
    } else if (offset == 0x18) {
        s->flag = false;
        tick_start(p, emu_now(p->e));
    }
}

/* ---- NVIC ---- */

static uint32_t bits_of(const emu *e, uint32_t offset, const uint8_t *set)
{
    unsigned first = 16u + (offset & 0x7cu) * 8u;
    uint32_t v = 0;

    for (unsigned i = 0; i < 32 && first + i < 16u + e->chip->irqs; i++) {
        v |= (uint32_t)(set[first + i] != 0) << i;
    }
    return v;
}

static void enable(emu *e, unsigned number)
{
    if (!e->exc.enabled[number]) {
        e->exc.enabled[number] = 1;
        e->exc.pend_cycle[number] = e->cycle; /* latency counts from when it could be served */
    }
}

static void for_bits(emu_periph *p, uint32_t offset, uint32_t value)
{
    emu *e = p->e;
    unsigned first = 16u + (offset & 0x7cu) * 8u;

    for (unsigned i = 0; i < 32; i++) {
        if ((value >> i & 1u) == 0) {
            continue;
        }
        if (first + i >= 16u + e->chip->irqs) {
            emu_misuse(p, "NVIC", "interrupt %u does not exist", first + i - 16);
            return;
        }
        if (offset < ICER) {
            enable(e, first + i);
        } else if (offset < ISPR) {
            e->exc.enabled[first + i] = 0;
        } else if (offset < ICPR) {
            emu_exc_pend(e, first + i);
        } else {
            emu_exc_unpend(e, first + i);
        }
    }
}

static uint32_t active_bits(const emu *e, uint32_t offset)
{
    uint8_t set[EMU_EXCEPTIONS] = {0};

    for (unsigned i = 0; i < e->exc.depth; i++) {
        set[e->exc.active[i]] = 1;
    }
    return bits_of(e, offset, set);
}

static uint32_t priority_read(const emu *e, unsigned first)
{
    uint32_t v = 0;

    for (unsigned i = 0; i < 4 && first + i < EMU_EXCEPTIONS; i++) {
        v |= (uint32_t)e->exc.priority[first + i] << (8 * i);
    }
    return v;
}

static void priority_write(emu_periph *p, unsigned first, uint32_t offset, uint32_t value, unsigned bytes)
{
    emu *e = p->e;
    uint32_t v = emu_merge(priority_read(e, first), offset, value, bytes);

    if (!e->chip->m4 && bytes != 4) {
        emu_misuse(p, "IPR", "this core takes words only"); /* byte access is unpredictable on ARMv6-M */
    }
    for (unsigned i = 0; i < 4 && first + i < 16u + e->chip->irqs; i++) {
        e->exc.priority[first + i] =
            (uint8_t)(v >> (8 * i)) & (uint8_t)(0xffu << (8 - e->chip->priority_bits));
    }
}

/* ---- SCB ---- */

static uint32_t icsr(const emu *e)
{
    const emu_exceptions *x = &e->exc;
    unsigned active = x->depth > 0 ? x->active[x->depth - 1] : 0;
    unsigned first = 0;
    bool irq = false;

    for (unsigned i = 2; i < 16u + e->chip->irqs; i++) {
        if (x->pending[i]) {
            irq |= i >= 16;
            if ((i < 16 || x->enabled[i]) &&
                (first == 0 || emu_exc_priority(e, i) < emu_exc_priority(e, first))) {
                first = i;
            }
        }
    }
    return active | (x->depth <= 1 && e->chip->m4 ? 1u << 11 : 0) | first << 12 | (irq ? 1u << 22 : 0) |
           (x->pending[15] ? 1u << 26 : 0) | (x->pending[14] ? 1u << 28 : 0) | (x->pending[2] ? 1u << 31 : 0);
}

static void icsr_write(emu *e, uint32_t value)
{
    if ((value & 1u << 31) != 0) {
        emu_exc_pend(e, 2);
    }
    if ((value & 1u << 28) != 0) {
        emu_exc_pend(e, 14);
    } else if ((value & 1u << 27) != 0) {
        emu_exc_unpend(e, 14);
    }
    if ((value & 1u << 26) != 0) {
        emu_exc_pend(e, 15);
    } else if ((value & 1u << 25) != 0) {
        emu_exc_unpend(e, 15);
    }
}

static void aircr_write(emu_periph *p, uint32_t value)
{
    emu *e = p->e;

    if (value >> 16 != VECTKEY) {
        emu_misuse(p, "AIRCR", "written without its key");
        return;
    }
    if (e->chip->m4) {
        e->exc.prigroup = value >> 8 & 7u;
        e->exc.prigroup_mask = 0xffu << (8 - e->chip->priority_bits) & 0xffu << (e->exc.prigroup + 1) & 0xffu;
    }
    if ((value & 4u) != 0) {
        emu_ask_reset(e, EMU_CAUSE_SOFTWARE);
    }
}

/* Registers that only the Cortex-M4 has. */
static uint32_t *m4_register(emu *e, uint32_t offset)
{
    switch (offset) {
    case SHCSR:
        return &e->exc.shcsr;
    case CFSR:
        return &e->exc.cfsr;
    case HFSR:
        return &e->exc.hfsr;
    case MMFAR:
        return &e->exc.mmfar;
    case BFAR:
        return &e->exc.bfar;
    case CPACR:
        return &e->exc.cpacr;
    case VTOR:
        return &e->exc.vtor;
    case DEMCR:
        return &e->exc.demcr;
    default:
        return NULL;
    }
}

static uint32_t scb_read(emu_periph *p, uint32_t offset)
{
    emu *e = p->e;

    switch (offset) {
    case CPUID:
        return e->chip->m4 ? 0x410fc241u : 0x410cc200u;
    case ICSR:
        return icsr(e);
    case AIRCR:
        return 0xfa050000u | e->exc.prigroup << 8;
    case SCR:
        return e->exc.scr;
    case CCR:
        return e->exc.ccr;
    default:
        break;
    }
    if (e->chip->m4 && m4_register(e, offset) != NULL) {
        return *m4_register(e, offset);
    }
    if (offset != DEMCR) {
        emu_misuse(p, "SCB", "read of %03lx: no register of this core here", (unsigned long)offset);
    }
    return 0;
}

static void m4_write(emu_periph *p, uint32_t offset, uint32_t value)
{
    emu *e = p->e;
    uint32_t *r = m4_register(e, offset);

    if (offset == CFSR || offset == HFSR) {
        *r &= ~value; /* write one to clear */
    } else if (offset == VTOR) {
        if ((value & 0x1ffu) != 0) {
            emu_misuse(p, "VTOR", "table not aligned to 512 bytes");
        }
        *r = value & 0x3fffff80u;
    } else if (offset == STIR) {
        emu_exc_pend(e, 16u + (value & 0x1ffu));
    } else if (r != NULL) {
        *r = value;
    } else {
        emu_misuse(p, "SCB", "write of %03lx: no register here", (unsigned long)offset);
    }
}

static void scb_write(emu_periph *p, uint32_t offset, uint32_t value)
{
    emu *e = p->e;

    switch (offset) {
    case ICSR:
        icsr_write(e, value);
        break;
    case AIRCR:
        aircr_write(p, value);
        break;
    case SCR:
        e->exc.scr = emu_reserved(p, "SCR", value, 0x16u);
        if ((value & 4u) != 0) {
            emu_misuse(p, "SCR", "deep sleep is not modelled");
        }
        break;
    case CCR:
        e->exc.ccr = value;
        break;
    case CPUID:
        break;
    default:
        if (e->chip->m4) {
            m4_write(p, offset, value);
        } else {
            emu_misuse(p, "SCB", "write of %03lx: no register of this core here", (unsigned long)offset);
        }
        break;
    }
}

/* ---- the space ---- */

static uint32_t scs_read(emu_periph *p, uint32_t offset, unsigned bytes)
{
    emu *e = p->e;
    uint32_t word = offset & ~3u;

    (void)bytes;
    if (word >= 0x10 && word < 0x20) {
        return tick_read(p, word);
    }
    if (word >= ISER && word < ISPR) {
        return bits_of(e, word, e->exc.enabled);
    }
    if (word >= ISPR && word < IABR) {
        return bits_of(e, word, e->exc.pending);
    }
    if (word >= IABR && word < IPR) {
        return active_bits(e, word);
    }
    if (word >= IPR && word < IPR + EMU_EXCEPTIONS - 16) {
        return priority_read(e, 16u + word - IPR);
    }
    if (word >= SHPR1 && word < SHCSR) {
        return priority_read(e, 4u + word - SHPR1);
    }
    if (word == 0x04 || word == 0x08) {
        return 0; /* ICTR, ACTLR */
    }
    return word >= CPUID ? scb_read(p, word) : 0;
}

static void scs_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    uint32_t word = offset & ~3u;

    if (word >= IPR && word < IPR + EMU_EXCEPTIONS - 16) {
        priority_write(p, 16u + word - IPR, offset, value, bytes);
        return;
    }
    if (word >= SHPR1 && word < SHCSR) {
        priority_write(p, 4u + word - SHPR1, offset, value, bytes);
        return;
    }
    value = emu_merge(0, offset, value, bytes);
    if (word >= 0x10 && word < 0x20) {
        tick_write(p, word, value);
    } else if (word >= ISER && word < IABR) {
        for_bits(p, word, value);
    } else if (word >= CPUID) {
        scb_write(p, word, value);
    }
}

static void scs_reset(emu_periph *p)
{
    systick *s = p->state;

    *s = (systick){.due_ns = EMU_NEVER};
}

static void scs_clock(emu_periph *p)
{
    systick *s = p->state;

    if (s->due_ns != EMU_NEVER) {
        tick_start(p, emu_now(p->e));
    }
}

emu_periph *emu_scs_new(emu *e, const emu_instance *at)
{
    emu_periph *p = emu_periph_new(e, at, sizeof(systick));

    if (p != NULL) {
        p->read = scs_read;
        p->write = scs_write;
        p->next = tick_next;
        p->run = tick_run;
        p->reset = scs_reset;
        p->clock = scs_clock;
    }
    return p;
}
