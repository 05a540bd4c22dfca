/* SPDX-License-Identifier: Apache-2.0 */
/* DMA controller with streams of the STM32F4 (RM0090, chapter 10). irq: streams 0 to 3; the others have no
 * interrupt here. Requests come one item at a time, as without bursts; double buffers and memory to memory
 * are not there; using them is recorded. */
#include "emu_periph.h"
#include <string.h>

#define STREAMS 8u
#define ITEM_CYCLES 6u /* of HCLK, from the request to the item's arrival */

enum { LISR = 0x00, HISR = 0x04, LIFCR = 0x08, HIFCR = 0x0c, STREAM0 = 0x10, STREAM_SIZE = 0x18 };
enum { CR = 0x00, NDTR = 0x04, PAR = 0x08, M0AR = 0x0c, M1AR = 0x10, FCR = 0x14 };

enum { /* SxCR */
       EN = 1u << 0,
       INTERRUPTS = 0x1eu,
       DIR = 3u << 6,
       CIRC = 1u << 8,
       PINC = 1u << 9,
       MINC = 1u << 10,
       CR_ALL = 0x0fefffffu,
       CR_NOT_MODELLED = 1u << 5 | 1u << 15 | 1u << 18 | 1u << 19 | 0xfu << 21
};

enum { FEIF = 1u << 0, DMEIF = 1u << 2, TEIF = 1u << 3, HTIF = 1u << 4, TCIF = 1u << 5 };

typedef struct stream {
    uint32_t cr, ndtr, par, m0ar, m1ar, fcr, flags;
    uint32_t length, at; /* items at the beginning, items done */
    uint64_t due;        /* the item under way arrives; EMU_NEVER = none */
} stream;

typedef struct dma_v2 {
    stream s[STREAMS];
} dma_v2;

/* Which request stands behind a stream and channel; of those lines that models raise. */
static const struct route {
    uint8_t controller, stream, channel, line;
} routes[] = {
    {1, 0, 1, EMU_DMA_I2C1_RX}, {1, 5, 1, EMU_DMA_I2C1_RX},   {1, 6, 1, EMU_DMA_I2C1_TX},
    {1, 7, 1, EMU_DMA_I2C1_TX}, {1, 5, 4, EMU_DMA_USART2_RX}, {1, 6, 4, EMU_DMA_USART2_TX},
    {1, 3, 0, EMU_DMA_SPI2_RX}, {1, 4, 0, EMU_DMA_SPI2_TX},   {2, 0, 3, EMU_DMA_SPI1_RX},
    {2, 2, 3, EMU_DMA_SPI1_RX}, {2, 3, 3, EMU_DMA_SPI1_TX},   {2, 5, 3, EMU_DMA_SPI1_TX},
    {2, 0, 0, EMU_DMA_ADC1},    {2, 4, 0, EMU_DMA_ADC1},
};

static dma_v2 *of(const emu_periph *p)
{
    return p->state;
}

static bool requested(const emu_periph *p, unsigned n)
{
    uint32_t channel = of(p)->s[n].cr >> 25 & 7u;

    for (size_t i = 0; i < sizeof routes / sizeof routes[0]; i++) {
        if (routes[i].controller == p->at->number && routes[i].stream == n && routes[i].channel == channel) {
            return emu_dma_level(p->e, (emu_dma_line)routes[i].line);
        }
    }
    return false;
}

static void signals(emu_periph *p)
{
    for (unsigned n = 0; n < EMU_IRQS_PER_INSTANCE && n < STREAMS; n++) {
        const stream *s = &of(p)->s[n];
        uint32_t wanted = (s->cr & 2u) << 1 | (s->cr & 4u) << 1 | (s->cr & 8u) << 1 | (s->cr & 16u) << 1;

        emu_irq(p, n, (s->flags & wanted) != 0 || ((s->fcr & 0x80u) != 0 && (s->flags & FEIF) != 0));
    }
}

/* ---- items
 * ------------------------------------------------------------------------------------------------------ */

static void poll(emu_periph *p)
{
    for (unsigned n = 0; n < STREAMS; n++) {
        stream *s = &of(p)->s[n];

        if ((s->cr & EN) == 0 || s->ndtr == 0 || !requested(p, n)) {
            s->due = EMU_NEVER;
        } else if (s->due == EMU_NEVER) {
            s->due = emu_now(p->e) + emu_cycles_ns(emu_bus_hz(p->e, EMU_AHB), ITEM_CYCLES);
        }
    }
}

static void transfer_error(emu_periph *p, stream *s, uint32_t address)
{
    emu_misuse(p, "SxCR", "transfer error: the DMA cannot reach %08x", (unsigned)address);
    s->flags |= TEIF;
    s->cr &= ~(uint32_t)EN;
}

static void finish(stream *s)
{
    s->flags |= TCIF;
    if ((s->cr & CIRC) != 0) {
        s->ndtr = s->length;
        s->at = 0;
    } else {
        s->cr &= ~(uint32_t)EN;
    }
}

/* The core-coupled memory hangs on the core alone. */
static bool in_ccm(uint32_t address)
{
    return address >> 16 == 0x1000u;
}

static void item(emu_periph *p, stream *s)
{
    unsigned size = 1u << (s->cr >> 11 & 3u);
    uint32_t memory = s->m0ar + ((s->cr & MINC) != 0 ? s->at * size : 0u);
    uint32_t periph = s->par + ((s->cr & PINC) != 0 ? s->at * size : 0u);
    bool to_memory = (s->cr & DIR) == 0;
    uint8_t bytes[4] = {0};

    if (in_ccm(memory)) {
        transfer_error(p, s, memory);
        return;
    }
    if (!emu_mem_read(p->e, to_memory ? periph : memory, bytes, size)) {
        transfer_error(p, s, to_memory ? periph : memory);
        return;
    }
    s->at++;
    s->ndtr--;
    if (!emu_mem_write(p->e, to_memory ? memory : periph, bytes, size)) {
        transfer_error(p, s, to_memory ? memory : periph);
        return;
    }
    if (s->ndtr == s->length / 2) {
        s->flags |= HTIF;
    }
    if (s->ndtr == 0) {
        finish(s);
    }
}

static void run(emu_periph *p)
{
    for (unsigned n = 0; n < STREAMS; n++) {
        stream *s = &of(p)->s[n];

        if (s->due <= emu_now(p->e)) {
            s->due = EMU_NEVER;
            item(p, s);
        }
    }
    poll(p);
    signals(p);
}

static uint64_t next(const emu_periph *p)
{
    uint64_t earliest = EMU_NEVER;

    for (unsigned n = 0; n < STREAMS; n++) {
        earliest = of(p)->s[n].due < earliest ? of(p)->s[n].due : earliest;
    }
    return earliest;
}

static void line_changed(emu_periph *p, emu_dma_line line, bool level)
{
    (void)line;
    (void)level;
    poll(p);
}

/* ---- registers
 * ---------------------------------------------------------------------------------------------------- */

static const uint8_t flag_shift[4] = {0, 6, 16, 22};

static uint32_t flags_of(const emu_periph *p, unsigned first)
{
    uint32_t value = 0;

    for (unsigned i = 0; i < 4; i++) {
        value |= of(p)->s[first + i].flags << flag_shift[i];
    }
    return value;
}

static void clear_flags(emu_periph *p, unsigned first, uint32_t value)
{
    (void)emu_reserved(p, first == 0 ? "LIFCR" : "HIFCR", value, 0x0f7d0f7du);
    for (unsigned i = 0; i < 4; i++) {
        of(p)->s[first + i].flags &= ~(value >> flag_shift[i] & 0x3du);
    }
}

static uint32_t *field(stream *s, uint32_t offset)
{
    switch (offset) {
    case CR:
        return &s->cr;
    case NDTR:
        return &s->ndtr;
    case PAR:
        return &s->par;
    case M0AR:
        return &s->m0ar;
    case M1AR:
        return &s->m1ar;
    default:
        return &s->fcr;
    }
}

static uint32_t reg_read(emu_periph *p, uint32_t offset, unsigned bytes)
{
    uint32_t word = offset & ~3u, value;

    (void)bytes;
    if (word == LISR || word == HISR) {
        value = flags_of(p, word == LISR ? 0 : 4);
    } else if (word == LIFCR || word == HIFCR) {
        value = 0;
    } else if (word < STREAM0 + STREAMS * STREAM_SIZE) {
        value = *field(&of(p)->s[(word - STREAM0) / STREAM_SIZE], (word - STREAM0) % STREAM_SIZE);
    } else {
        emu_misuse(p, "-", "no register at offset %02x", (unsigned)offset);
        value = 0;
    }
    return value;
}

static void judge_enable(emu_periph *p, const stream *s, unsigned n)
{
    uint32_t psize = s->cr >> 11 & 3u, msize = s->cr >> 13 & 3u;

    if (s->flags != 0) {
        emu_misuse(p, "SxCR", "stream %u enabled with its flags %02x not cleared", n, (unsigned)s->flags);
    }
    if (s->ndtr == 0) {
        emu_misuse(p, "SxNDTR", "stream %u enabled with nothing to transfer", n);
    }
    if ((s->cr & CR_NOT_MODELLED) != 0 || (s->cr & DIR) > 1u << 6) {
        emu_misuse(p, "SxCR", "burst, double buffer, flow control or memory to memory: not modelled");
    }
    if (psize != msize && (s->fcr & 4u) == 0) {
        emu_misuse(p, "SxCR", "stream %u: memory and peripheral sizes differ in direct mode", n);
    }
    if ((s->par & ((1u << psize) - 1u)) != 0 || (s->m0ar & ((1u << msize) - 1u)) != 0) {
        emu_misuse(p, "SxPAR", "stream %u: address not aligned to the item", n);
    }
}

static void write_cr(emu_periph *p, unsigned n, uint32_t value)
{
    stream *s = &of(p)->s[n];

    value = emu_reserved(p, "SxCR", value, CR_ALL);
    if ((s->cr & EN) != 0) {
        if (((s->cr ^ value) & ~(uint32_t)(EN | INTERRUPTS)) != 0) {
            emu_misuse(p, "SxCR", "stream %u configured while enabled", n);
        }
        s->cr = (s->cr & ~(uint32_t)(EN | INTERRUPTS)) | (value & (EN | INTERRUPTS));
        if ((value & EN) == 0) {
            s->flags |= TCIF; /* stopping a running stream completes it */
        }
        return;
    }
    s->cr = value;
    if ((value & EN) != 0) {
        judge_enable(p, s, n);
        s->length = s->ndtr;
        s->at = 0;
    }
}

static void write_stream(emu_periph *p, unsigned n, uint32_t offset, uint32_t value)
{
    stream *s = &of(p)->s[n];

    if (offset == CR) {
        write_cr(p, n, value);
    } else if ((s->cr & EN) != 0 && offset != M1AR) {
        emu_misuse(p, "SxCR", "stream %u configured while enabled", n);
    } else {
        *field(s, offset) = offset == NDTR ? value & 0xffffu : value;
    }
}

static void reg_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    if (bytes != 4) {
        emu_misuse(p, "-", "register written by %u bytes: only words are allowed", bytes);
        value = emu_merge(reg_read(p, offset, 4), offset, value, bytes);
        offset &= ~3u;
    }
    if (offset == LIFCR || offset == HIFCR) {
        clear_flags(p, offset == LIFCR ? 0 : 4, value);
    } else if (offset >= STREAM0 && offset < STREAM0 + STREAMS * STREAM_SIZE) {
        write_stream(p, (offset - STREAM0) / STREAM_SIZE, (offset - STREAM0) % STREAM_SIZE, value);
    } else {
        emu_misuse(p, "-", "no writable register at offset %02x", (unsigned)offset);
    }
    poll(p);
    signals(p);
}

static void reset(emu_periph *p)
{
    memset(of(p), 0, sizeof *of(p));
    for (unsigned n = 0; n < STREAMS; n++) {
        of(p)->s[n].fcr = 0x21;
        of(p)->s[n].due = EMU_NEVER;
    }
    signals(p);
}

emu_periph *emu_dma_v2_new(emu *e, const emu_instance *at)
{
    emu_periph *p = emu_periph_new(e, at, sizeof(dma_v2));

    if (p != NULL) {
        p->read = reg_read;
        p->write = reg_write;
        p->next = next;
        p->run = run;
        p->reset = reset;
        p->dma = line_changed;
    }
    return p;
}
