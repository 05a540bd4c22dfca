/* SPDX-License-Identifier: Apache-2.0 */
/* Shared part of the clock controllers. */
#include "emu_rcc.h"

#define RMVF (1u << 24)

static const uint32_t start_ns[OSCS] = {[OSC_HSI] = 2000,  [OSC_HSE] = 2000000, [OSC_PLL] = 200000,
                                        [OSC_LSI] = 85000, [OSC_HSI48] = 6000,  [OSC_HSI14] = 2000};

void rcc_switch(emu_periph *p, unsigned osc, bool on)
{
    rcc *r = p->state;
    rcc_source *s = &r->osc[osc];

    if (s->on == on) {
        return;
    }
    s->on = on;
    s->ready = false;
    s->due = on && (osc != OSC_HSE || p->e->crystal) ? emu_now(p->e) + start_ns[osc] : EMU_NEVER;
}

static void try_switch(emu_periph *p)
{
    rcc *r = p->state;

    if (r->used != r->wanted && r->source_ready(r, r->wanted)) {
        r->used = r->wanted;
        r->retune(p);
    }
}

uint64_t rcc_next(const emu_periph *p)
{
    const rcc *r = p->state;
    uint64_t t = EMU_NEVER;

    for (unsigned i = 0; i < OSCS; i++) {
        if (r->osc[i].on && !r->osc[i].ready && r->osc[i].due < t) {
            t = r->osc[i].due;
        }
    }
    return t;
}

void rcc_run(emu_periph *p)
{
    rcc *r = p->state;
    uint64_t now = emu_now(p->e);

    for (unsigned i = 0; i < OSCS; i++) {
        if (r->osc[i].on && !r->osc[i].ready && r->osc[i].due <= now) {
            r->osc[i].ready = true;
        }
    }
    try_switch(p);
}

void rcc_want(emu_periph *p, unsigned sw)
{
    rcc *r = p->state;

    if (sw != r->wanted && !r->source_ready(r, sw)) {
        emu_misuse(p, "CFGR", "SW = %u, a source that is not ready", sw);
    }
    r->wanted = (uint8_t)sw;
    try_switch(p);
}

uint32_t rcc_read_cr(const rcc *r)
{
    uint32_t v = r->reg[0] & ~(CR_HSIRDY | CR_HSERDY | CR_PLLRDY | CR_HSION | CR_HSEON | CR_PLLON);

    v |= r->osc[OSC_HSI].on ? CR_HSION : 0;
    v |= r->osc[OSC_HSI].ready ? CR_HSIRDY : 0;
    v |= r->osc[OSC_HSE].on ? CR_HSEON : 0;
    v |= r->osc[OSC_HSE].ready ? CR_HSERDY : 0;
    v |= r->osc[OSC_PLL].on ? CR_PLLON : 0;
    v |= r->osc[OSC_PLL].ready ? CR_PLLRDY : 0;
    return v;
}

/* A source that drives the system clock, or the PLL that does, cannot be switched off. */
static void on_or_off(emu_periph *p, unsigned osc, bool on, bool in_use)
{
    if (!on && in_use) {
        emu_misuse(p, "CR", "a clock that is in use is switched off");
        return;
    }
    rcc_switch(p, osc, on);
}

void rcc_write_cr(emu_periph *p, uint32_t value, uint32_t kept, uint32_t allowed)
{
    rcc *r = p->state;
    bool pll_used = r->used == 2;
    bool crystal_used = r->uses_crystal(r);

    value = emu_reserved(p, "CR", value, allowed);
    on_or_off(p, OSC_HSI, (value & CR_HSION) != 0, r->used == 0);
    on_or_off(p, OSC_HSE, (value & CR_HSEON) != 0, crystal_used);
    on_or_off(p, OSC_PLL, (value & CR_PLLON) != 0, pll_used);
    r->reg[0] = (r->reg[0] & kept) | (value & ~kept);
}

uint32_t rcc_read_csr(const rcc *r)
{
    return r->flags | (r->osc[OSC_LSI].on ? 1u : 0) | (r->osc[OSC_LSI].ready ? 2u : 0);
}

void rcc_write_csr(emu_periph *p, uint32_t value)
{
    rcc *r = p->state;

    rcc_switch(p, OSC_LSI, (value & 1u) != 0);
    if ((value & RMVF) != 0) {
        r->flags = 0;
    }
}

void rcc_write_cir(emu_periph *p, uint32_t value)
{
    rcc *r = p->state;
    uint32_t flags = r->reg[r->csr == 9 ? 2 : 3];

    if ((value & CIR_CSSC) != 0 && r->css_nmi) {
        r->css_nmi = false;
        emu_exc_level(p->e, 2, false);
        flags &= ~CIR_CSSF;
    }
    r->reg[r->csr == 9 ? 2 : 3] = (flags & 0xffu) | (value & 0x7f00u);
}

/* The crystal fails while it runs (clock security system: RM0091 7.2.8, RM0090 7.2.7). */
static void crystal_failed(emu_periph *p)
{
    rcc *r = p->state;
    bool used = r->uses_crystal(r);
    bool watched = (r->reg[0] & CR_CSSON) != 0;

    r->osc[OSC_HSE].ready = false;
    r->osc[OSC_HSE].due = EMU_NEVER;
    if (!watched) {
        if (used) {
            emu_clock_dead(p->e);
        }
        return;
    }
    rcc_switch(p, OSC_HSE, false);
    r->reg[0] &= ~CR_CSSON;
    if (used) {
        rcc_switch(p, OSC_HSI, true);
        r->osc[OSC_HSI].ready = true;
        rcc_switch(p, OSC_PLL, false);
        r->used = r->wanted = 0;
        r->retune(p);
    }
    if (!r->css_nmi) {
        r->css_nmi = true;
        r->reg[r->csr == 9 ? 2 : 3] |= CIR_CSSF;
        emu_exc_level(p->e, 2, true);
    }
}

void rcc_crystal_changed(emu_periph *p)
{
    rcc *r = p->state;

    if (!p->e->crystal && r->osc[OSC_HSE].on && r->osc[OSC_HSE].ready) {
        crystal_failed(p);
    } else if (!p->e->crystal) {
        r->osc[OSC_HSE].due = EMU_NEVER;
    } else if (r->osc[OSC_HSE].on && !r->osc[OSC_HSE].ready) {
        r->osc[OSC_HSE].due = emu_now(p->e) + start_ns[OSC_HSE];
    }
}

void emu_rcc_crystal(emu *e)
{
    rcc_crystal_changed(e->rcc_model);
}

bool emu_rcc_hsi_on(const emu *e)
{
    return ((const rcc *)e->rcc_model->state)->osc[OSC_HSI].ready;
}

static uint32_t flags_of(emu_cause cause, bool f4)
{
    static const uint32_t flag[EMU_CAUSES] = {
        [EMU_CAUSE_PIN] = 0,         [EMU_CAUSE_SOFTWARE] = 1u << 28,  [EMU_CAUSE_IWDG] = 1u << 29,
        [EMU_CAUSE_WWDG] = 1u << 30, [EMU_CAUSE_LOW_POWER] = 1u << 31,
    };
    uint32_t pin = 1u << 26; /* every reset also pulls NRST */

    if (cause == EMU_CAUSE_POWER) {
        return pin | 1u << 27 | (f4 ? 1u << 25 : 1u << 23);
    }
    if (cause == EMU_CAUSE_BROWNOUT) {
        return pin | (f4 ? 1u << 25 : 1u << 27 | 1u << 23);
    }
    return pin | flag[cause];
}

void rcc_reset_common(emu_periph *p)
{
    rcc *r = p->state;
    emu_cause cause = emu_reset_cause(p->e);
    bool f4 = p->at->family == EMU_F4;

    if (r->css_nmi) {
        r->css_nmi = false;
        emu_exc_level(p->e, 2, false);
    }
    for (unsigned i = 0; i < RCC_WORDS; i++) {
        r->reg[i] = 0;
    }
    for (unsigned i = 0; i < OSCS; i++) {
        r->osc[i] = (rcc_source){.due = EMU_NEVER};
    }
    r->osc[OSC_HSI] = (rcc_source){.on = true, .ready = true, .due = EMU_NEVER};
    r->used = r->wanted = 0;
    if (cause == EMU_CAUSE_POWER || cause == EMU_CAUSE_BROWNOUT) {
        r->flags = 0;
    }
    if (cause != EMU_CAUSES) {
        r->flags |= flags_of(cause, f4);
    }
}

/* Bits of a reset register: the models on them go to their reset values. */
void rcc_reset_bits(emu_periph *p, unsigned reg, uint32_t value)
{
    rcc *r = p->state;
    uint32_t fresh = value & ~r->reg[reg];

    r->reg[reg] = value;
    for (unsigned i = 0; i < p->e->periphs; i++) {
        emu_periph *other = p->e->periph[i];

        if (other->at->reset_reg == reg * 4 && (fresh >> other->at->enable_bit & 1u) != 0 &&
            other->reset != NULL) {
            other->reset(other);
            emu_touch(p->e, other);
        }
    }
}

uint32_t rcc_ahb_divider(uint32_t hpre)
{
    static const uint16_t by[8] = {2, 4, 8, 16, 64, 128, 256, 512};

    return hpre < 8 ? 1 : by[hpre - 8];
}

uint32_t rcc_apb_divider(uint32_t ppre)
{
    return ppre < 4 ? 1 : 2u << (ppre - 4);
}

void rcc_judge(emu_periph *p, const emu_clocks *c)
{
    const emu_chip *chip = p->e->chip;

    if (c->hclk > chip->max_hclk) {
        emu_misuse(p, "CFGR", "HCLK of %lu Hz is too fast", (unsigned long)c->hclk);
    }
    if (c->pclk1 > chip->max_pclk1) {
        emu_misuse(p, "CFGR", "PCLK1 of %lu Hz is too fast", (unsigned long)c->pclk1);
    }
    if (c->pclk2 > chip->max_pclk2) {
        emu_misuse(p, "CFGR", "PCLK2 of %lu Hz is too fast", (unsigned long)c->pclk2);
    }
}
