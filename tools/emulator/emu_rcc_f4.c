/* SPDX-License-Identifier: Apache-2.0 */
/* Clock controller of the STM32F405 (RM0090 section 7). */
#include "emu_rcc.h"

enum {
    CR = 0,
    PLLCFGR = 1,
    CFGR = 2,
    CIR = 3,
    AHB1RSTR = 4,
    AHB2RSTR = 5,
    AHB3RSTR = 6,
    APB1RSTR = 8,
    APB2RSTR = 9,
    CSR = 29,
    WORDS = 34
};

#define SW_HSE 1u
#define SW_PLL 2u

static bool f4_ready(const rcc *r, unsigned sw)
{
    static const uint8_t osc[3] = {OSC_HSI, OSC_HSE, OSC_PLL};

    return sw < 3 && r->osc[osc[sw]].ready;
}

static bool pll_from_crystal(const rcc *r)
{
    return (r->reg[PLLCFGR] & 1u << 22) != 0;
}

static bool f4_crystal(const rcc *r)
{
    return r->used == SW_HSE || (r->used == SW_PLL && pll_from_crystal(r));
}

typedef struct pll {
    uint32_t in, vco, out;
} pll;

static pll pll_of(const emu_periph *p)
{
    const rcc *r = p->state;
    uint32_t c = r->reg[PLLCFGR];
    uint32_t m = c & 0x3fu, n = c >> 6 & 0x1ffu, div = (c >> 16 & 3u) * 2u + 2u;
    pll v;

    v.in = (pll_from_crystal(r) ? p->e->chip->hse_hz : p->e->chip->hsi_hz) / (m == 0 ? 1 : m);
    v.vco = v.in * n;
    v.out = v.vco / div;
    return v;
}

static uint32_t system_hz(const emu_periph *p)
{
    const rcc *r = p->state;

    switch (r->used) {
    case SW_HSE:
        return p->e->chip->hse_hz;
    case SW_PLL:
        return pll_of(p).out;
    default:
        return p->e->chip->hsi_hz;
    }
}

static void f4_retune(emu_periph *p)
{
    const rcc *r = p->state;
    uint32_t cfgr = r->reg[CFGR];
    uint32_t div1 = rcc_apb_divider(cfgr >> 10 & 7u), div2 = rcc_apb_divider(cfgr >> 13 & 7u);
    emu_clocks c = {0};

    c.sysclk = system_hz(p);
    if (c.sysclk == 0) {
        c.sysclk = p->e->chip->hsi_hz;
    }
    c.hclk = c.sysclk / rcc_ahb_divider(cfgr >> 4 & 15u);
    c.pclk1 = c.hclk / div1;
    c.pclk2 = c.hclk / div2;
    c.apb1_divided = div1 > 1;
    c.apb2_divided = div2 > 1;
    rcc_judge(p, &c);
    emu_set_clocks(p->e, &c);
    emu_flash_judge_latency(p->e);
}

static uint32_t f4_read(emu_periph *p, uint32_t offset, unsigned bytes)
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
    default:
        return offset / 4 < WORDS ? r->reg[offset / 4] : 0;
    }
}

static void judge_pll(emu_periph *p)
{
    const rcc *r = p->state;
    uint32_t c = r->reg[PLLCFGR];
    pll v = pll_of(p);

    if (!r->osc[pll_from_crystal(r) ? OSC_HSE : OSC_HSI].ready) {
        emu_misuse(p, "CR", "PLL switched on before its source is ready");
    }
    if ((c & 0x3fu) < 2 || (c >> 6 & 0x1ffu) < 50 || (c >> 6 & 0x1ffu) > 432 || (c >> 24 & 15u) < 2) {
        emu_misuse(p, "PLLCFGR", "forbidden factor in %08lx", (unsigned long)c);
    }
    if (v.in < 950000u || v.in > 2100000u || v.vco < 100000000u || v.vco > 432000000u) {
        emu_misuse(p, "PLLCFGR", "PLL input %lu Hz, VCO %lu Hz", (unsigned long)v.in, (unsigned long)v.vco);
    }
}

static void write_cr(emu_periph *p, uint32_t value)
{
    rcc *r = p->state;
    bool was = r->osc[OSC_PLL].on;

    rcc_write_cr(p, value, 0xff00u, 0x0f0ffffbu);
    if (!was && r->osc[OSC_PLL].on) {
        judge_pll(p);
    }
}

static void write_pllcfgr(emu_periph *p, uint32_t value)
{
    rcc *r = p->state;

    if (r->osc[OSC_PLL].on) {
        emu_misuse(p, "PLLCFGR", "written while the PLL is on");
        return;
    }
    r->reg[PLLCFGR] = value; /* bits 28..31 keep their reset value 2 */
    if (value >> 28 != 2 || (value & 0x00bc8000u) != 0) {
        emu_misuse(p, "PLLCFGR", "reserved bits changed: %08lx", (unsigned long)value);
    }
}

static void write_cfgr(emu_periph *p, uint32_t value)
{
    rcc *r = p->state;

    if ((value & 3u) == 3u) {
        emu_misuse(p, "CFGR", "SW = 3 is not allowed");
        value &= ~3u;
    }
    r->reg[CFGR] = value & ~15u;
    rcc_want(p, value & 3u);
    f4_retune(p);
}

static void f4_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    rcc *r = p->state;
    unsigned w = offset / 4;

    if (w >= WORDS) {
        return;
    }
    value = bytes == 4 ? value : emu_merge(f4_read(p, offset & ~3u, 4), offset, value, bytes);
    switch (w) {
    case CR:
        write_cr(p, value);
        break;
    case PLLCFGR:
        write_pllcfgr(p, value);
        break;
    case CFGR:
        write_cfgr(p, value);
        break;
    case CIR:
        rcc_write_cir(p, value);
        break;
    case AHB1RSTR:
    case AHB2RSTR:
    case AHB3RSTR:
    case APB1RSTR:
    case APB2RSTR:
        rcc_reset_bits(p, w, value);
        break;
    case CSR:
        rcc_write_csr(p, value);
        break;
    default:
        r->reg[w] = value;
        break;
    }
}

static void f4_reset(emu_periph *p)
{
    rcc *r = p->state;

    rcc_reset_common(p);
    r->reg[CR] = 0x8080u;
    r->reg[PLLCFGR] = 0x24003010u;
    r->reg[12] = 0x00100000u; /* AHB1ENR: CCM data RAM */
    f4_retune(p);
}

emu_periph *emu_rcc_f4_new(emu *e, const emu_instance *at)
{
    emu_periph *p = emu_periph_new(e, at, sizeof(rcc));
    rcc *r;

    if (p == NULL) {
        return NULL;
    }
    r = p->state;
    r->csr = CSR;
    r->retune = f4_retune;
    r->source_ready = f4_ready;
    r->uses_crystal = f4_crystal;
    e->rcc = r->reg;
    e->rcc_model = p;
    p->read = f4_read;
    p->write = f4_write;
    p->next = rcc_next;
    p->run = rcc_run;
    p->reset = f4_reset;
    return p;
}
