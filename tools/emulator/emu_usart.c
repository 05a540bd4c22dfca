/* SPDX-License-Identifier: Apache-2.0 */
/* USART in both forms: v1 (F4, RM0090 section 30) and v2 (F0, RM0091 section 27). Asynchronous, 8 or 9 bits,
 * no parity check, no DMA, oversampling by 16 or 8. The two forms differ in where bits stand and in how flags
 * are cleared. */
#include "emu_periph.h"
#include <stdlib.h>

#define FE (1u << 1)
#define ORE (1u << 3)
#define IDLE (1u << 4)
#define RXNE (1u << 5)
#define TC (1u << 6)
#define TXE (1u << 7)
#define CR1_RE (1u << 2)
#define CR1_TE (1u << 3)
#define CR1_RXNEIE (1u << 5)
#define CR1_TCIE (1u << 6)
#define CR1_TXEIE (1u << 7)
#define CR1_M (1u << 12)
#define CR1_OVER8 (1u << 15)
#define CR3_EIE 1u
#define V1_UE (1u << 13)
#define V2_UE 1u

typedef struct usart {
    bool v2;
    uint32_t cr1, cr2, cr3, brr, other[3];
    uint32_t status;
    uint32_t seen; /**< v1: flags that a read of SR has shown, so that the access of DR clears them */
    uint16_t tdr, shift, rdr;
    bool full, shifting;
    uint64_t done_ns; /**< end of the stop bit of `shift` */
} usart;

static bool enabled(const usart *u)
{
    return (u->cr1 & (u->v2 ? V2_UE : V1_UE)) != 0;
}

static void drive(emu_periph *p)
{
    const usart *u = p->state;
    uint32_t s = u->status;
    bool on = ((u->cr1 & CR1_TXEIE) != 0 && (s & TXE) != 0) || ((u->cr1 & CR1_TCIE) != 0 && (s & TC) != 0) ||
              ((u->cr1 & CR1_RXNEIE) != 0 && (s & (RXNE | ORE)) != 0) ||
              ((u->cr1 & IDLE) != 0 && (s & IDLE) != 0) || ((u->cr3 & CR3_EIE) != 0 && (s & (ORE | FE)) != 0);

    emu_irq(p, 0, on && enabled(u));
}

/* ---- speed ---- */

static uint32_t divider(const usart *u)
{
    uint32_t d = u->brr & 0xffffu;

    return (u->cr1 & CR1_OVER8) == 0 ? d : (d & ~0xfu) | (d & 7u) << 1;
}

static uint32_t baud(const emu_periph *p)
{
    const usart *u = p->state;
    uint32_t d = divider(u);
    uint32_t hz = emu_kernel_hz(p->e, p->at);

    if (d == 0) {
        return 0;
    }
    return (u->cr1 & CR1_OVER8) == 0 ? hz / d : 2u * hz / d;
}

static void judge_baud(emu_periph *p)
{
    static const uint32_t usual[] = {9600, 19200, 38400, 57600, 115200, 230400, 460800, 921600, 1000000};
    uint32_t b = baud(p);

    if (divider(p->state) < 16) {
        emu_misuse(p, "BRR", "divider %lu is below 16", (unsigned long)divider(p->state));
        return;
    }
    for (unsigned i = 0; i < sizeof usual / sizeof usual[0]; i++) {
        if (llabs((long long)b - (long long)usual[i]) * 50 <= (long long)usual[i]) { /* 2 % */
            return;
        }
    }
    emu_misuse(p, "BRR", "%lu baud is no usual speed", (unsigned long)b);
}

static uint64_t byte_ns(const emu_periph *p)
{
    const usart *u = p->state;
    uint32_t bits = 10u + ((u->cr1 & CR1_M) != 0 ? 1u : 0) + ((u->cr2 >> 12 & 3u) == 2 ? 1u : 0);
    uint32_t b = baud(p);

    return b == 0 ? EMU_NEVER : emu_cycles_ns(b, bits);
}

/* ---- transmitter ---- */

static void load_shift(emu_periph *p)
{
    usart *u = p->state;
    uint64_t ns = byte_ns(p);

    if (!u->full || u->shifting || (u->cr1 & CR1_TE) == 0 || !enabled(u) || ns == EMU_NEVER) {
        return;
    }
    (void)emu_pad_needed(p, EMU_SIG_TX, "TX");
    judge_baud(p);
    u->shift = u->tdr;
    u->full = false;
    u->shifting = true;
    u->done_ns = emu_now(p->e) + ns;
    u->status = (u->status | TXE) & ~TC;
}

static void transmit(emu_periph *p, uint32_t value)
{
    usart *u = p->state;

    if (!enabled(u) || (u->cr1 & CR1_TE) == 0) {
        emu_misuse(p, "TDR", "written while the transmitter is off");
    }
    if (u->full) {
        emu_misuse(p, "TDR", "written while TXE is 0: the byte before is lost");
    }
    u->tdr = (uint16_t)(value & 0x1ffu);
    u->full = true;
    u->status &= ~(TXE | TC);
    load_shift(p);
    drive(p);
}

static uint64_t usart_next(const emu_periph *p)
{
    const usart *u = p->state;

    return u->shifting ? u->done_ns : EMU_NEVER;
}

static void usart_run(emu_periph *p)
{
    usart *u = p->state;

    u->shifting = false;
    if (emu_pad_of(p->e, p->at, EMU_SIG_TX) != NULL) {
        const emu_world *w = emu_outside(p->e);

        w->uart_out(w->ctx, p->at->number, (uint8_t)u->shift);
    }
    if (u->full) {
        load_shift(p);
    } else {
        u->status |= TC;
    }
    drive(p);
}

/* ---- receiver ---- */

static bool usart_in(emu_periph *p, uint8_t byte)
{
    usart *u = p->state;

    if (!enabled(u) || (u->cr1 & CR1_RE) == 0 || emu_pad_of(p->e, p->at, EMU_SIG_RX) == NULL) {
        return false;
    }
    if ((u->status & RXNE) != 0) {
        if (!u->v2 || (u->cr3 & 1u << 12) == 0) { /* OVRDIS */
            u->status |= ORE;
            drive(p);
            return true; /* the new byte is lost */
        }
    }
    u->rdr = byte;
    u->status |= RXNE;
    drive(p);
    return true;
}

static uint32_t receive(emu_periph *p)
{
    usart *u = p->state;
    uint32_t excused = u->v2 ? 0 : ORE | FE | IDLE;

    if ((u->status & (RXNE | excused)) == 0) {
        emu_misuse(p, "RDR", "read while RXNE is 0");
    }
    u->status &= ~RXNE;
    drive(p);
    return u->rdr;
}

/* ---- registers of v2 ---- */

static uint32_t v2_read(emu_periph *p, uint32_t offset, unsigned bytes)
{
    const usart *u = p->state;

    (void)bytes;
    switch (offset) {
    case 0x00:
        return u->cr1;
    case 0x04:
        return u->cr2;
    case 0x08:
        return u->cr3;
    case 0x0c:
        return u->brr;
    case 0x1c:
        return u->status | (enabled(u) && (u->cr1 & CR1_TE) != 0 ? 1u << 21 : 0) |
               (enabled(u) && (u->cr1 & CR1_RE) != 0 ? 1u << 22 : 0);
    case 0x24:
        return receive(p);
    case 0x28:
        return u->tdr;
    default:
        return 0;
    }
}

static void only_while_off(emu_periph *p, const char *reg, uint32_t changed)
{
    if (changed != 0 && enabled(p->state)) {
        emu_misuse(p, reg, "bits %08lx changed while UE is 1", (unsigned long)changed);
    }
}

static void v2_write_cr1(emu_periph *p, uint32_t value)
{
    usart *u = p->state;

    if ((u->cr1 & value & V2_UE) != 0) {
        only_while_off(p, "CR1", (u->cr1 ^ value) & 0x1c009600u);
    }
    u->cr1 = emu_reserved(p, "CR1", value, 0x1fffffffu);
    if ((value & V2_UE) == 0) {
        u->status = TXE | TC;
        u->full = u->shifting = false;
    }
    load_shift(p);
}

static void v2_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    usart *u = p->state;

    (void)bytes;
    switch (offset) {
    case 0x00:
        v2_write_cr1(p, value);
        break;
    case 0x04:
        only_while_off(p, "CR2", (u->cr2 ^ value) & 0x00fffff0u);
        u->cr2 = value;
        break;
    case 0x08:
        only_while_off(p, "CR3", (u->cr3 ^ value) & 0x1000u);
        u->cr3 = value;
        break;
    case 0x0c:
        only_while_off(p, "BRR", u->brr ^ value);
        u->brr = emu_reserved(p, "BRR", value, 0xffffu);
        break;
    case 0x18:
        u->status &= (value & 8u) != 0 ? ~RXNE : ~0u;
        break;
    case 0x20:
        u->status &= ~(value & (0x1fu | TC));
        break;
    case 0x28:
        transmit(p, value);
        break;
    default:
        break;
    }
    drive(p);
}

/* ---- registers of v1 ---- */

static uint32_t v1_read_dr(emu_periph *p)
{
    usart *u = p->state;
    uint32_t v = receive(p);

    u->status &= ~(u->seen & (ORE | FE | IDLE | 5u)); /* SR was read before: the errors are cleared */
    u->seen = 0;
    drive(p);
    return v;
}

static uint32_t v1_read(emu_periph *p, uint32_t offset, unsigned bytes)
{
    usart *u = p->state;

    (void)bytes;
    switch (offset) {
    case 0x00:
        u->seen = u->status;
        return u->status;
    case 0x04:
        return v1_read_dr(p);
    case 0x08:
        return u->brr;
    case 0x0c:
        return u->cr1;
    case 0x10:
        return u->cr2;
    case 0x14:
        return u->cr3;
    default:
        return 0;
    }
}

static void v1_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    usart *u = p->state;

    (void)bytes;
    switch (offset) {
    case 0x00:
        u->status &= value | ~(uint32_t)(TC | RXNE); /* TC and RXNE are cleared by writing 0 */
        break;
    case 0x04:
        transmit(p, value);
        break;
    case 0x08:
        u->brr = emu_reserved(p, "BRR", value, 0xffffu);
        break;
    case 0x0c:
        u->cr1 = emu_reserved(p, "CR1", value, 0xbfffu);
        if ((value & V1_UE) == 0) {
            u->full = u->shifting = false;
            u->status = TXE | TC;
        }
        load_shift(p);
        break;
    case 0x10:
        u->cr2 = value;
        break;
    case 0x14:
        u->cr3 = value;
        break;
    default:
        break;
    }
    drive(p);
}

/* ---- both ---- */

static void usart_reset(emu_periph *p)
{
    usart *u = p->state;

    *u = (usart){.v2 = u->v2, .status = TXE | TC};
    drive(p);
}

static emu_periph *make(emu *e, const emu_instance *at, bool v2)
{
    emu_periph *p = emu_periph_new(e, at, sizeof(usart));

    if (p != NULL) {
        ((usart *)p->state)->v2 = v2;
        p->read = v2 ? v2_read : v1_read;
        p->write = v2 ? v2_write : v1_write;
        p->next = usart_next;
        p->run = usart_run;
        p->reset = usart_reset;
        p->uart_in = usart_in;
    }
    return p;
}

emu_periph *emu_usart_v1_new(emu *e, const emu_instance *at)
{
    return make(e, at, false);
}

emu_periph *emu_usart_v2_new(emu *e, const emu_instance *at)
{
    return make(e, at, true);
}
