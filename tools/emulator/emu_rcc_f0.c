/* SPDX-License-Identifier: Apache-2.0 */
/* Clock controller of the STM32F0 (RM0091 section 7). */
#include "emu_rcc.h"

enum {
    CR = 0,
    CFGR = 1,
    CIR = 2,
    APB2RSTR = 3,
    APB1RSTR = 4,
    CSR = 9,
    AHBRSTR = 10,
    CFGR2 = 11,
    CFGR3 = 12,
    CR2 = 13,
    WORDS = 14
};

#define SW_HSE 1u
#define SW_PLL 2u
#define SW_HSI48 3u
#define CR2_HSI14ON (1u << 0)
#define CR2_HSI48ON (1u << 16)
#define CFGR_PLL (0x3cu << 16 | 3u << 15 | 1u << 17) /* PLLMUL, PLLSRC, PLLXTPRE */

static bool f0_ready(const rcc *r, unsigned sw)
{
    static const uint8_t osc[4] = {OSC_HSI, OSC_HSE, OSC_PLL, OSC_HSI48};

    return r->osc[osc[sw & 3u]].ready;
}

static unsigned pll_source(const rcc *r)
{
    return r->reg[CFGR] >> 15 & 3u;
}

static bool f0_crystal(const rcc *r)
{
    return r->used == SW_HSE || (r->used == SW_PLL && pll_source(r) == 2);
}

static uint32_t pll_input(const emu_periph *p)
{
    const rcc *r = p->state;
    uint32_t prediv = (r->reg[CFGR2] & 15u) + 1u;

    switch (pll_source(r)) {
    case 0:
        return p->e->chip->hsi_hz / 2u;
    case 1:
        return p->e->chip->hsi_hz / prediv;
    case 2:
        return p->e->chip->hse_hz / prediv;
    default:
        return 48000000u / prediv;
    }
}

static uint32_t pll_hz(const emu_periph *p)
{
    const rcc *r = p->state;
    uint32_t mul = (r->reg[CFGR] >> 18 & 15u) + 2u;

    return pll_input(p) * (mul > 16 ? 16 : mul);
}

static uint32_t system_hz(const emu_periph *p)
{
    const rcc *r = p->state;

    switch (r->used) {
    case SW_HSE:
        return p->e->chip->hse_hz;
    case SW_PLL:
        return pll_hz(p);
    case SW_HSI48:
        return 48000000u;
    default:
        return p->e->chip->hsi_hz;
    }
}

static uint32_t usart_hz(const emu_periph *p, unsigned selection, const emu_clocks *c)
{
    switch (selection & 3u) {
    case 0:
        return c->pclk1;
    case 1:
        return c->sysclk;
    case 3:
        return p->e->chip->hsi_hz;
    default:
        return 32768;
    }
}

static void f0_retune(emu_periph *p)
{
    const rcc *r = p->state;
    uint32_t cfgr = r->reg[CFGR];
    uint32_t apb = rcc_apb_divider(cfgr >> 8 & 7u);
    emu_clocks c = {0};

    c.sysclk = system_hz(p);
    c.hclk = c.sysclk / rcc_ahb_divider(cfgr >> 4 & 15u);
    c.pclk1 = c.pclk2 = c.hclk / apb;
    c.apb1_divided = c.apb2_divided = apb > 1;
    c.i2c1 = (r->reg[CFGR3] & 0x10u) != 0 ? c.sysclk : p->e->chip->hsi_hz;
    c.usart[1] = usart_hz(p, r->reg[CFGR3], &c);
    c.usart[2] = usart_hz(p, r->reg[CFGR3] >> 16, &c);
    c.usart[3] = c.pclk1;
    rcc_judge(p, &c);
    emu_set_clocks(p->e, &c);
    emu_flash_judge_latency(p->e);
}

static uint32_t f0_read(emu_periph *p, uint32_t offset, unsigned bytes)
{
    const rcc *r = p->state;

    (void)bytes;
    switch (offset / 4) {
    case CR:
        return rcc_read_cr(r);
    case CFGR:
        return (r->reg[CFGR] & ~15u) | r->wanted | (uint32_t)r->used << 2;
    case CSR:
        return rcc_read_csr(r);
    case CR2:
        return 0x80u | (r->osc[OSC_HSI14].on ? 1u : 0) | (r->osc[OSC_HSI14].ready ? 2u : 0) |
               (r->reg[CR2] & 0xfcu) | (r->osc[OSC_HSI48].on ? 1u << 16 : 0) |
               (r->osc[OSC_HSI48].ready ? 1u << 17 : 0);
    default:
        return offset / 4 < WORDS ? r->reg[offset / 4] : 0;
    }
}

static void write_cfgr(emu_periph *p, uint32_t value)
{
    rcc *r = p->state;

    if (((value ^ r->reg[CFGR]) & CFGR_PLL) != 0 && r->osc[OSC_PLL].on) {
        emu_misuse(p, "CFGR", "PLL changed while it is on");
        value = (value & ~CFGR_PLL) | (r->reg[CFGR] & CFGR_PLL);
    }
    r->reg[CFGR] = value & ~15u;
    r->reg[CFGR2] = (r->reg[CFGR2] & ~1u) | (value >> 17 & 1u); /* PLLXTPRE is bit 0 of PREDIV */
    rcc_want(p, value & 3u);
    f0_retune(p);
}

static void judge_pll(emu_periph *p)
{
    const rcc *r = p->state;
    uint32_t in = pll_input(p), out = pll_hz(p);
    unsigned source = pll_source(r);
    bool ready = source < 2    ? r->osc[OSC_HSI].ready
                 : source == 2 ? r->osc[OSC_HSE].ready
                               : r->osc[OSC_HSI48].ready;

    if (!ready) {
        emu_misuse(p, "CR", "PLL switched on before its source is ready");
    }
    if (in < 1000000u || in > 24000000u || out < 16000000u || out > 48000000u) {
        emu_misuse(p, "CFGR", "PLL from %lu Hz to %lu Hz", (unsigned long)in, (unsigned long)out);
    }
}

static void write_cr2(emu_periph *p, uint32_t value)
{
    rcc *r = p->state;

    if (r->used == SW_HSI48 && (value & CR2_HSI48ON) == 0) {
        emu_misuse(p, "CR2", "a clock that is in use is switched off");
        value |= CR2_HSI48ON;
    }
    r->reg[CR2] = value & 0xfcu;
    rcc_switch(p, OSC_HSI14, (value & CR2_HSI14ON) != 0);
    rcc_switch(p, OSC_HSI48, (value & CR2_HSI48ON) != 0);
}

static void write_cfgr2(emu_periph *p, uint32_t value)
{
    rcc *r = p->state;

    if (r->osc[OSC_PLL].on && ((value ^ r->reg[CFGR2]) & 15u) != 0) {
        emu_misuse(p, "CFGR2", "PREDIV changed while the PLL is on");
        return;
    }
    r->reg[CFGR2] = emu_reserved(p, "CFGR2", value, 15u);
    r->reg[CFGR] = (r->reg[CFGR] & ~(1u << 17)) | (value & 1u) << 17;
}

static void write_cr(emu_periph *p, uint32_t value)
{
    rcc *r = p->state;
    bool was = r->osc[OSC_PLL].on;

    rcc_write_cr(p, value, 0xff00u, 0x030fffffu & ~4u);
    if (!was && r->osc[OSC_PLL].on) {
        judge_pll(p);
    }
}

static void f0_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    rcc *r = p->state;
    unsigned w = offset / 4;

    if (w >= WORDS) {
        return;
    }
    value = bytes == 4 ? value : emu_merge(f0_read(p, offset & ~3u, 4), offset, value, bytes);
    switch (w) {
    case CR:
        write_cr(p, value);
        break;
    case CFGR:
        write_cfgr(p, value);
        break;
    case CIR:
        rcc_write_cir(p, value);
        break;
    case APB2RSTR:
    case APB1RSTR:
    case AHBRSTR:
        rcc_reset_bits(p, w, value);
        break;
    case CSR:
        rcc_write_csr(p, value);
        break;
    case CFGR2:
        write_cfgr2(p, value);
        break;
    case CR2:
        write_cr2(p, value);
        break;
    default:
        r->reg[w] = value;
        f0_retune(p);
        break;
    }
}

static void f0_reset(emu_periph *p)
{
    rcc *r = p->state;

    rcc_reset_common(p);
    r->reg[CR] = 0x8080u; /* HSITRIM 16 and a calibration value */
    r->reg[5] = 0x14u;    /* AHBENR: flash interface and SRAM */
    f0_retune(p);
}

emu_periph *emu_rcc_f0_new(emu *e, const emu_instance *at)
{
    emu_periph *p = emu_periph_new(e, at, sizeof(rcc));
    rcc *r;

    if (p == NULL) {
        return NULL;
    }
    r = p->state;
    r->csr = CSR;
    r->retune = f0_retune;
    r->source_ready = f0_ready;
    r->uses_crystal = f0_crystal;
    e->rcc = r->reg;
    e->rcc_model = p;
    p->read = f0_read;
    p->write = f0_write;
    p->next = rcc_next;
    p->run = rcc_run;
    p->reset = f0_reset;
    return p;
}
