/* SPDX-License-Identifier: Apache-2.0 */
/* SPI of the STM32F4 (RM0090, chapter 28) as a full-duplex master with software NSS. irq: global. I2S, CRC,
 * half duplex, receive only and slave mode are not there; using them is recorded. */
#include "emu_periph.h"

enum {
    CR1 = 0x00,
    CR2 = 0x04,
    SR = 0x08,
    DR = 0x0c,
    CRCPR = 0x10,
    RXCRCR = 0x14,
    TXCRCR = 0x18,
    I2SCFGR = 0x1c
};
enum { I2SPR = 0x20 };

enum { /* CR1 */
       MODE = 3u << 0,
       MSTR = 1u << 2,
       BR = 7u << 3,
       SPE = 1u << 6,
       LSBFIRST = 1u << 7,
       SSI = 1u << 8,
       SSM = 1u << 9,
       DFF = 1u << 11,
       CR1_MODELLED = MODE | MSTR | BR | SPE | LSBFIRST | SSI | SSM | DFF
};

enum { /* CR2 */
       RXDMAEN = 1u << 0,
       TXDMAEN = 1u << 1,
       SSOE = 1u << 2,
       ERRIE = 1u << 5,
       RXNEIE = 1u << 6,
       TXEIE = 1u << 7,
       CR2_ALL = 0xf7u
};

enum { /* SR */
       RXNE = 1u << 0,
       TXE = 1u << 1,
       MODF = 1u << 5,
       OVR = 1u << 6,
       BSY = 1u << 7
};

typedef struct spi_v1 {
    uint32_t cr1, cr2, sr;
    uint16_t tx, rx, shift;
    bool shifting, connected, dr_read; /* dr_read: first half of what clears OVR */
    bool modf_read;                    /* SR was read while MODF was set */
    uint64_t due;
} spi_v1;

static spi_v1 *of(const emu_periph *p)
{
    return p->state;
}

static uint32_t clock_hz(const emu_periph *p)
{
    return emu_bus_hz(p->e, p->at->bus) >> (((of(p)->cr1 & BR) >> 3) + 1u);
}

static unsigned frame_bits(const spi_v1 *s)
{
    return (s->cr1 & DFF) != 0 ? 16 : 8;
}

/* ---- interrupts and DMA
 * ------------------------------------------------------------------------------------ */

static void signals(emu_periph *p)
{
    const spi_v1 *s = of(p);
    uint32_t wanted = 0;
    bool first = p->at->number == 1;

    wanted |= (s->cr2 & RXNEIE) != 0 ? RXNE : 0u;
    wanted |= (s->cr2 & TXEIE) != 0 ? TXE : 0u;
    wanted |= (s->cr2 & ERRIE) != 0 ? OVR | MODF : 0u;
    emu_irq(p, 0, (s->sr & wanted) != 0);
    emu_dma_request(p->e, first ? EMU_DMA_SPI1_RX : EMU_DMA_SPI2_RX,
                    (s->cr2 & RXDMAEN) != 0 && (s->sr & RXNE) != 0);
    emu_dma_request(p->e, first ? EMU_DMA_SPI1_TX : EMU_DMA_SPI2_TX,
                    (s->cr2 & TXDMAEN) != 0 && (s->sr & TXE) != 0);
}

/* ---- the wire
 * ------------------------------------------------------------------------------------------------ */

static bool connect(emu_periph *p)
{
    bool clock = emu_pad_needed(p, EMU_SIG_SCK, "SCK") != NULL;
    bool out = emu_pad_needed(p, EMU_SIG_MOSI, "MOSI") != NULL;
    bool in = emu_pad_needed(p, EMU_SIG_MISO, "MISO") != NULL;

    return clock && out && in;
}

static void begin(emu_periph *p)
{
    spi_v1 *s = of(p);

    if (s->shifting || (s->sr & TXE) != 0 || (s->cr1 & (SPE | MSTR)) != (SPE | MSTR)) {
        return;
    }
    s->connected = connect(p);
    s->shift = s->tx;
    s->shifting = true;
    s->sr |= TXE | BSY;
    s->due = emu_now(p->e) + emu_cycles_ns(clock_hz(p), frame_bits(s));
}

static uint16_t exchange(emu_periph *p)
{
    const spi_v1 *s = of(p);
    const emu_world *w = emu_outside(p->e);
    emu_spi_frame f = {.value = s->shift, .bits = (uint8_t)frame_bits(s), .hz = clock_hz(p)};
    uint16_t value;

    if (!s->connected) {
        return 0;
    }
    f.mode = (uint8_t)((s->cr1 & 1u) | (s->cr1 & 2u));
    f.lsb_first = (s->cr1 & LSBFIRST) != 0;
    f.value = (uint16_t)(f.bits == 8 ? f.value & 0xffu : f.value);
    value = w->spi_frame(w->ctx, p->at->number, &f);
    return (uint16_t)(f.bits == 8 ? value & 0xffu : value);
}

static void frame_done(emu_periph *p)
{
    spi_v1 *s = of(p);
    uint16_t value = exchange(p);

    s->shifting = false;
    s->sr &= ~(uint32_t)BSY;
    if ((s->sr & RXNE) != 0) {
        emu_misuse(p, "DR", "overrun: DR was not read before the next frame ended");
        s->sr |= OVR;
        s->dr_read = false;
    } else {
        s->rx = value;
        s->sr |= RXNE;
    }
    begin(p);
}

static void run(emu_periph *p)
{
    if (of(p)->shifting && of(p)->due <= emu_now(p->e)) {
        frame_done(p);
        signals(p);
    }
}

static uint64_t next(const emu_periph *p)
{
    return of(p)->shifting ? of(p)->due : EMU_NEVER;
}

/* ---- registers
 * ------------------------------------------------------------------------------------------------- */

static uint32_t read_dr(emu_periph *p)
{
    spi_v1 *s = of(p);

    if ((s->sr & RXNE) == 0) {
        emu_misuse(p, "DR", "DR read while RXNE is not set");
    }
    s->sr &= ~(uint32_t)RXNE;
    s->dr_read = true;
    signals(p);
    return s->rx;
}

static uint32_t read_sr(emu_periph *p)
{
    spi_v1 *s = of(p);
    uint32_t value = s->sr;

    if ((s->sr & OVR) != 0 && s->dr_read) {
        s->sr &= ~(uint32_t)OVR;
    }
    s->modf_read = (s->sr & MODF) != 0;
    signals(p);
    return value;
}

static uint32_t reg_read(emu_periph *p, uint32_t offset, unsigned bytes)
{
    (void)bytes;
    switch (offset) {
    case CR1:
        return of(p)->cr1;
    case CR2:
        return of(p)->cr2;
    case SR:
        return read_sr(p);
    case DR:
        return read_dr(p);
    case CRCPR:
        return 7;
    case RXCRCR:
    case TXCRCR:
    case I2SCFGR:
        return 0;
    case I2SPR:
        return 2;
    default:
        emu_misuse(p, "-", "no register at offset %02x", (unsigned)offset);
        return 0;
    }
}

static void write_dr(emu_periph *p, uint16_t value)
{
    spi_v1 *s = of(p);

    if ((s->sr & TXE) == 0) {
        emu_misuse(p, "DR", "DR written while TXE is not set: a frame is lost");
    }
    s->tx = value;
    s->sr &= ~(uint32_t)TXE;
    begin(p);
}

static void judge_cr1(emu_periph *p, uint32_t value)
{
    const spi_v1 *s = of(p);
    uint32_t changed = s->cr1 ^ value;

    if ((value & ~(uint32_t)CR1_MODELLED) != 0) {
        emu_misuse(p, "CR1", "CRC, half duplex or receive only: not modelled");
    }
    if ((s->sr & BSY) != 0 && (changed & SPE) != 0) {
        emu_misuse(p, "CR1", "SPE cleared while BSY");
    } else if ((s->sr & TXE) == 0 && (s->cr1 & ~value & SPE) != 0) {
        emu_misuse(p, "CR1", "SPE cleared before TXE");
    }
    if ((s->sr & BSY) != 0 && (changed & (MODE | MSTR | BR | LSBFIRST)) != 0) {
        emu_misuse(p, "CR1", "mode, clock or order changed while BSY");
    }
    if ((s->cr1 & SPE) != 0 && (changed & DFF) != 0) {
        emu_misuse(p, "CR1", "DFF changed while SPE is set");
    }
    if ((value & (SPE | MSTR)) == SPE) {
        emu_misuse(p, "CR1", "enabled as a slave: not modelled");
    }
}

/* Without a high NSS a master believes that another one selects it. */
static void mode_fault(emu_periph *p)
{
    spi_v1 *s = of(p);
    bool held_high = (s->cr1 & SSM) != 0 ? (s->cr1 & SSI) != 0 : (s->cr2 & SSOE) != 0;

    if ((s->cr1 & (SPE | MSTR)) == (SPE | MSTR) && !held_high) {
        emu_misuse(p, "CR1", "master without NSS held high (SSM with SSI, or SSOE): MODF");
        s->sr |= MODF;
        s->cr1 &= ~(uint32_t)(SPE | MSTR);
    }
}

static void write_cr1(emu_periph *p, uint32_t value)
{
    spi_v1 *s = of(p);

    judge_cr1(p, value);
    if (s->modf_read) {
        s->sr &= ~(uint32_t)MODF;
        s->modf_read = false;
    }
    s->cr1 = value;
    mode_fault(p);
    if ((s->cr1 & SPE) == 0) {
        s->shifting = false;
        s->sr &= ~(uint32_t)BSY;
    }
    begin(p);
}

static void reg_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    spi_v1 *s = of(p);

    (void)bytes;
    switch (offset) {
    case CR1:
        write_cr1(p, value & 0xffffu);
        break;
    case CR2:
        s->cr2 = emu_reserved(p, "CR2", value & 0xffffu, CR2_ALL);
        break;
    case DR:
        write_dr(p, (uint16_t)value);
        break;
    case SR:
        break; /* only CRCERR can be written, and it never is set */
    case CRCPR:
    case I2SPR:
        break;
    case I2SCFGR:
        if ((value & 0xffffu) != 0) {
            emu_misuse(p, "I2SCFGR", "I2S: not modelled");
        }
        break;
    default:
        emu_misuse(p, "-", "no writable register at offset %02x", (unsigned)offset);
        break;
    }
    signals(p);
}

static void reset(emu_periph *p)
{
    *of(p) = (spi_v1){.sr = TXE};
    signals(p);
}

emu_periph *emu_spi_v1_new(emu *e, const emu_instance *at)
{
    emu_periph *p = emu_periph_new(e, at, sizeof(spi_v1));

    if (p != NULL) {
        p->read = reg_read;
        p->write = reg_write;
        p->next = next;
        p->run = run;
        p->reset = reset;
    }
    return p;
}
