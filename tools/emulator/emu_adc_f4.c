/* SPDX-License-Identifier: Apache-2.0 */
/* ADC of the STM32F4 (RM0090, chapter 13): regular conversions by software. irq: global. VDDA is 3.300 V.
 * Injected channels, external triggers, the watchdog and the multi-ADC modes are not there; using them is
 * recorded. */
#include "emu_periph.h"

#define VDDA 3.300
#define MAX_HZ 36000000u
#define STABLE_NS 3000u /* from ADON to the first conversion */
#define FIRST_INTERNAL 16u

enum { SR = 0x00, CR1 = 0x04, CR2 = 0x08, SMPR1 = 0x0c, SMPR2 = 0x10, SQR1 = 0x2c, SQR3 = 0x34, DR = 0x4c };
enum { JOFR1 = 0x14, LTR = 0x28, JSQR = 0x38, CSR = 0x300, CCR = 0x304, REGS = 0x50 / 4 };

enum { EOC = 1u << 1, STRT = 1u << 4, OVR = 1u << 5, SR_ALL = 0x3fu };

enum { /* CR1 */
       EOCIE = 1u << 5,
       SCAN = 1u << 8,
       OVRIE = 1u << 26,
       CR1_MODELLED = EOCIE | SCAN | 3u << 24 | OVRIE | 0x1fu
};

enum { /* CR2 */
       ADON = 1u << 0,
       CONT = 1u << 1,
       DMA = 1u << 8,
       DDS = 1u << 9,
       EOCS = 1u << 10,
       ALIGN = 1u << 11,
       SWSTART = 1u << 30,
       CR2_MODELLED = ADON | CONT | DMA | DDS | EOCS | ALIGN | SWSTART
};

typedef struct adc_f4 {
    uint32_t reg[REGS], ccr;
    uint64_t on_since, due; /* due: the conversion under way ends; EMU_NEVER = none */
    unsigned place;         /* in the sequence */
} adc_f4;

static adc_f4 *of(const emu_periph *p)
{
    return p->state;
}

static uint32_t *reg(const emu_periph *p, uint32_t offset)
{
    return &of(p)->reg[offset / 4];
}

static void signals(emu_periph *p)
{
    uint32_t sr = *reg(p, SR), cr1 = *reg(p, CR1);

    emu_irq(p, 0, ((cr1 & EOCIE) != 0 && (sr & EOC) != 0) || ((cr1 & OVRIE) != 0 && (sr & OVR) != 0));
    emu_dma_request(p->e, EMU_DMA_ADC1, (*reg(p, CR2) & DMA) != 0 && (sr & EOC) != 0);
}

/* ---- conversion
 * ------------------------------------------------------------------------------------------------- */

static unsigned length(const emu_periph *p)
{
    return (*reg(p, CR1) & SCAN) != 0 ? (*reg(p, SQR1) >> 20 & 15u) + 1u : 1u;
}

static unsigned channel(const emu_periph *p)
{
    unsigned place = of(p)->place;

    return *reg(p, SQR3 - place / 6u * 4u) >> place % 6u * 5u & 31u;
}

static uint32_t adc_hz(const emu_periph *p)
{
    return emu_bus_hz(p->e, p->at->bus) / (2u * ((of(p)->ccr >> 16 & 3u) + 1u));
}

static unsigned resolution_bits(const emu_periph *p)
{
    return 12u - 2u * (*reg(p, CR1) >> 24 & 3u);
}

static unsigned conversion_cycles(const emu_periph *p)
{
    static const uint16_t sampling[8] = {3, 15, 28, 56, 84, 112, 144, 480};
    unsigned c = channel(p) <= 18u ? channel(p) : 18u; /* there are no more */
    uint32_t smpr = c > 9 ? *reg(p, SMPR1) >> (c - 10u) * 3u : *reg(p, SMPR2) >> c * 3u;

    return sampling[smpr & 7u] + resolution_bits(p);
}

static void convert(emu_periph *p)
{
    of(p)->due = emu_now(p->e) + emu_cycles_ns(adc_hz(p), conversion_cycles(p));
    *reg(p, SR) |= STRT;
}

static void judge_channel(emu_periph *p)
{
    unsigned c = channel(p);

    if (c > 18) {
        emu_misuse(p, "SQR3", "channel %u does not exist", c);
    } else if (c < FIRST_INTERNAL && emu_pad_of(p->e, p->at, EMU_SIG_CHANNEL0 + c) == NULL) {
        emu_misuse(p, "SQR3", "the pin of channel %u is not in analog mode", c);
    }
}

static void start(emu_periph *p)
{
    adc_f4 *s = of(p);

    if ((*reg(p, CR2) & ADON) == 0) {
        emu_misuse(p, "CR2", "SWSTART while ADON is not set");
        return;
    }
    if (emu_now(p->e) - s->on_since < STABLE_NS) {
        emu_misuse(p, "CR2", "SWSTART less than 3 us after ADON");
    }
    if (s->due != EMU_NEVER) {
        emu_misuse(p, "CR2", "SWSTART during a conversion");
    }
    if (adc_hz(p) > MAX_HZ) {
        emu_misuse(p, "CCR", "ADC clock of %u Hz is above 36 MHz", (unsigned)adc_hz(p));
    }
    s->place = 0;
    judge_channel(p);
    convert(p);
}

static uint32_t code(emu_periph *p)
{
    const emu_world *w = emu_outside(p->e);
    double steps = (double)(1u << resolution_bits(p));
    double value = w->adc_volts(w->ctx, p->at->number, channel(p)) / VDDA * steps;
    uint32_t result = value <= 0.0 ? 0u : value >= steps ? (uint32_t)steps - 1u : (uint32_t)value;

    return (*reg(p, CR2) & ALIGN) != 0 ? result << (16u - resolution_bits(p)) : result;
}

/* Overrun is watched only where every result is wanted. Returns false when the result is lost. */
static bool keep(emu_periph *p, uint32_t value)
{
    if ((*reg(p, CR2) & (DMA | EOCS)) != 0 && (*reg(p, SR) & EOC) != 0) {
        *reg(p, SR) |= OVR;
        emu_misuse(p, "DR", "overrun: DR was not read before the next result");
        return false;
    }
    *reg(p, DR) = value;
    return true;
}

static void converted(emu_periph *p)
{
    adc_f4 *s = of(p);
    bool last = s->place + 1u >= length(p);

    s->due = EMU_NEVER;
    if ((*reg(p, SR) & OVR) != 0 || !keep(p, code(p))) {
        return;
    }
    if (last || (*reg(p, CR2) & (EOCS | DMA)) != 0) {
        *reg(p, SR) |= EOC;
    }
    s->place = last ? 0 : s->place + 1u;
    if (!last || (*reg(p, CR2) & CONT) != 0) {
        convert(p);
    } else {
        *reg(p, CR2) &= ~(uint32_t)SWSTART;
    }
}

static void run(emu_periph *p)
{
    if (of(p)->due <= emu_now(p->e)) {
        converted(p);
        signals(p);
    }
}

static uint64_t next(const emu_periph *p)
{
    return of(p)->due;
}

/* ---- registers
 * ----------------------------------------------------------------------------------------------------- */

static uint32_t read_dr(emu_periph *p)
{
    if ((*reg(p, SR) & EOC) == 0) {
        emu_misuse(p, "DR", "DR read while EOC is not set");
    }
    *reg(p, SR) &= ~(uint32_t)EOC;
    signals(p);
    return *reg(p, DR);
}

static uint32_t reg_read(emu_periph *p, uint32_t offset, unsigned bytes)
{
    (void)bytes;
    switch (offset) {
    case DR:
        return read_dr(p);
    case CSR:
        return *reg(p, SR);
    case CCR:
        return of(p)->ccr;
    default:
        if (offset < REGS * 4u) {
            return *reg(p, offset);
        }
        emu_misuse(p, "-", "no register at offset %03x", (unsigned)offset);
        return 0;
    }
}

static void write_cr2(emu_periph *p, uint32_t value)
{
    adc_f4 *s = of(p);
    uint32_t old = *reg(p, CR2);

    if ((value & ~(uint32_t)CR2_MODELLED) != 0) {
        emu_misuse(p, "CR2", "external trigger or injected channels: not modelled");
    }
    *reg(p, CR2) = value & CR2_MODELLED & ~(uint32_t)SWSTART;
    if ((value & ADON) == 0) {
        s->due = EMU_NEVER;
    } else if ((old & ADON) == 0) {
        s->on_since = emu_now(p->e);
    }
    if ((value & SWSTART) != 0) {
        start(p);
    }
}

static void write_setting(emu_periph *p, uint32_t offset, uint32_t value)
{
    if (of(p)->due != EMU_NEVER) {
        emu_misuse(p, "SQR3", "sequence or sampling time changed during a conversion");
    }
    *reg(p, offset) = value;
}

static void reg_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    (void)bytes;
    switch (offset) {
    case SR:
        *reg(p, SR) &= value | ~(uint32_t)SR_ALL;
        break;
    case CR1:
        if ((value & ~(uint32_t)CR1_MODELLED) != 0) {
            emu_misuse(p, "CR1", "injected channels, watchdog or discontinuous mode: not modelled");
        }
        *reg(p, CR1) = value;
        break;
    case CR2:
        write_cr2(p, value);
        break;
    case CCR:
        of(p)->ccr = emu_reserved(p, "CCR", value, 0x00c3ef1fu);
        break;
    case DR:
    case CSR:
        emu_misuse(p, offset == DR ? "DR" : "CSR", "read-only register written");
        break;
    default:
        if (offset == SMPR1 || offset == SMPR2 || (offset >= SQR1 && offset <= SQR3)) {
            write_setting(p, offset, value);
        } else if (offset >= JOFR1 && offset <= LTR) {
            *reg(p, offset) = value;
        } else {
            emu_misuse(p, offset == JSQR ? "JSQR" : "-", "injected channels: not modelled");
        }
        break;
    }
    signals(p);
}

static void reset(emu_periph *p)
{
    *of(p) = (adc_f4){.due = EMU_NEVER};
    *reg(p, 0x24) = 0xfff;
    signals(p);
}

emu_periph *emu_adc_f4_new(emu *e, const emu_instance *at)
{
    emu_periph *p = emu_periph_new(e, at, sizeof(adc_f4));

    if (p != NULL) {
        p->read = reg_read;
        p->write = reg_write;
        p->next = next;
        p->run = run;
        p->reset = reset;
    }
    return p;
}
