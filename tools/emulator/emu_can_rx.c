/* SPDX-License-Identifier: Apache-2.0 */
/* bxCAN: what is received, by which filter, into which FIFO. */
#include "emu_can_internal.h"

enum { FMR = 0x200, FM1R = 0x204, FS1R = 0x20c, FFA1R = 0x214, FA1R = 0x21c, BANKS = 0x240 };

static unsigned banks(const emu_periph *p)
{
    return p->at->family == EMU_F0 ? 14 : EMU_CAN_BANKS;
}

/* ---- filters
 * ------------------------------------------------------------------------------------------------------ */

/* The identifier as the 32-bit scale sees it. */
static uint32_t wide(const emu_can_frame *f)
{
    uint32_t id = f->extended ? f->id << 3 | 4u : f->id << 21;

    return id | (f->remote ? 2u : 0u);
}

/* As the 16-bit scale sees it: STID, RTR, IDE, EXID[17:15]. */
static uint32_t narrow(const emu_can_frame *f)
{
    uint32_t id = f->extended ? (f->id >> 18) << 5 | 1u << 3 | (f->id >> 15 & 7u) : f->id << 5;

    return id | (f->remote ? 1u << 4 : 0u);
}

/* Returns the number of the matching filter within the bank, or -1. `filters`: how many the bank has. */
static int match_bank(const emu_can *s, unsigned bank, const emu_can_frame *f, int *filters)
{
    bool list = (s->fm1r >> bank & 1u) != 0, single = (s->fs1r >> bank & 1u) != 0;
    const uint32_t *r = s->bank[bank];
    uint32_t half[4] = {r[0] & 0xffffu, r[0] >> 16, r[1] & 0xffffu, r[1] >> 16};

    *filters = (single ? 1 : 2) * (list ? 2 : 1);
    if (single) {
        uint32_t id = wide(f);

        return list                              ? (id == (r[0] & ~1u)   ? 0
                                                    : id == (r[1] & ~1u) ? 1
                                                                         : -1)
               : ((id ^ r[0]) & r[1] & ~1u) == 0 ? 0
                                                 : -1;
    }
    for (int i = 0; i < *filters; i++) {
        uint32_t id = list ? half[i] : half[2 * i], mask = list ? 0xffffu : half[2 * i + 1];

        if (((narrow(f) ^ id) & mask) == 0) {
            return i;
        }
    }
    return -1;
}

/* 32-bit before 16-bit, list before mask, then the lower number. */
static unsigned priority(const emu_can *s, unsigned bank)
{
    return ((s->fs1r >> bank & 1u) != 0 ? 0u : 2u) + ((s->fm1r >> bank & 1u) != 0 ? 0u : 1u);
}

typedef struct hit {
    unsigned fifo, number, priority;
    bool found;
} hit;

static hit match(const emu_periph *p, const emu_can_frame *f)
{
    const emu_can *s = emu_can_of(p);
    unsigned number[2] = {0, 0};
    hit best = {0, 0, 4, false};

    for (unsigned b = 0; b < banks(p); b++) {
        unsigned fifo = s->ffa1r >> b & 1u;
        int filters, at = match_bank(s, b, f, &filters);

        if (at >= 0 && (s->fa1r >> b & 1u) != 0 && priority(s, b) < best.priority) {
            best = (hit){fifo, number[fifo] + (unsigned)at, priority(s, b), true};
        }
        number[fifo] += (unsigned)filters; /* inactive banks are counted as well */
    }
    return best;
}

/* ---- FIFOs
 * ---------------------------------------------------------------------------------------------------------
 */

static void pack(const emu_can_frame *f, unsigned filter, uint32_t out[4])
{
    out[0] = wide(f);
    out[1] = filter << 8 | f->length;
    out[2] = out[3] = 0;
    for (unsigned i = 0; i < 4; i++) {
        out[2] |= (uint32_t)f->data[i] << 8 * i;
        out[3] |= (uint32_t)f->data[4 + i] << 8 * i;
    }
}

bool emu_can_store(emu_periph *p, const emu_can_frame *frame)
{
    emu_can *s = emu_can_of(p);
    hit h = (s->fmr & 1u) != 0 ? (hit){0, 0, 0, false} : match(p, frame);
    emu_can_fifo *fifo = &s->fifo[h.fifo];
    uint32_t r[4];
    unsigned at = fifo->count;

    if (!h.found) {
        return false;
    }
    if (at == EMU_CAN_DEPTH) {
        fifo->overrun = true;
        if ((s->mcr & RFLM) != 0) {
            return false;
        }
        at--; /* the last one is overwritten */
    }
    pack(frame, h.number, r);
    fifo->message[at].ir = r[0];
    fifo->message[at].dtr = r[1];
    fifo->message[at].dlr = r[2];
    fifo->message[at].dhr = r[3];
    fifo->count = at + 1u;
    fifo->full = fifo->full || fifo->count == EMU_CAN_DEPTH;
    return true;
}

static void wake(emu_periph *p)
{
    emu_can *s = emu_can_of(p);

    s->msr |= WKUI;
    if ((s->mcr & AWUM) != 0) {
        s->mcr &= ~(uint32_t)SLEEP;
        s->msr &= ~(uint32_t)SLAK;
        s->synced_at = emu_now(p->e) + emu_can_bits_ns(p, 11);
    }
}

bool emu_can_in_frame(emu_periph *p, const emu_can_frame *frame)
{
    emu_can *s = emu_can_of(p);
    bool there = emu_can_takes_part(s) && emu_pad_of(p->e, p->at, EMU_SIG_RX) != NULL;

    if ((s->msr & SLAK) != 0) {
        wake(p); /* the frame itself is lost */
    }
    if (there && (s->btr & LBKM) == 0) {
        s->rec = s->rec > 127 ? 120u : s->rec - (s->rec > 0 ? 1u : 0u);
        (void)emu_can_store(p, frame);
        emu_can_error_seen(p, LEC_NONE);
    }
    emu_can_signals(p);
    return there && (s->btr & (LBKM | EMU_CAN_SILM)) == 0;
}

uint32_t emu_can_fifo_status(const emu_can *s, unsigned n)
{
    const emu_can_fifo *f = &s->fifo[n];

    return f->count | (f->full ? FULL : 0u) | (f->overrun ? FOVR : 0u);
}

void emu_can_fifo_write(emu_periph *p, unsigned n, uint32_t value)
{
    emu_can_fifo *f = &emu_can_of(p)->fifo[n];

    (void)emu_reserved(p, n == 0 ? "RF0R" : "RF1R", value, 0x3bu);
    f->full = f->full && (value & FULL) == 0;
    f->overrun = f->overrun && (value & FOVR) == 0;
    if ((value & RFOM) == 0) {
        return;
    }
    if (f->count == 0) {
        emu_misuse(p, n == 0 ? "RF0R" : "RF1R", "RFOM with an empty FIFO");
        return;
    }
    f->count--;
    f->full = false;
    for (unsigned i = 0; i < f->count; i++) {
        f->message[i] = f->message[i + 1];
    }
}

uint32_t emu_can_fifo_read(emu_periph *p, unsigned n, uint32_t offset)
{
    const emu_can_fifo *f = &emu_can_of(p)->fifo[n];

    if (f->count == 0) {
        emu_misuse(p, n == 0 ? "RI0R" : "RI1R", "mailbox of an empty FIFO read");
    }
    switch (offset) {
    case 0x0:
        return f->message[0].ir;
    case 0x4:
        return f->message[0].dtr;
    case 0x8:
        return f->message[0].dlr;
    default:
        return f->message[0].dhr;
    }
}

/* ---- filter registers
 * ------------------------------------------------------------------------------------------------ */

static uint32_t *filter_reg(emu_periph *p, uint32_t offset, const char **name)
{
    emu_can *s = emu_can_of(p);

    switch (offset) {
    case FM1R:
        *name = "FM1R";
        return &s->fm1r;
    case FS1R:
        *name = "FS1R";
        return &s->fs1r;
    case FFA1R:
        *name = "FFA1R";
        return &s->ffa1r;
    case FA1R:
        *name = "FA1R";
        return &s->fa1r;
    case FMR:
        *name = "FMR";
        return &s->fmr;
    default:
        *name = "FiRx";
        if (offset >= BANKS && offset < BANKS + 8u * banks(p)) {
            return &s->bank[(offset - BANKS) / 8u][offset >> 2 & 1u];
        }
        return NULL;
    }
}

uint32_t emu_can_filter_read(emu_periph *p, uint32_t offset)
{
    const char *name;
    const uint32_t *r = filter_reg(p, offset, &name);

    if (r == NULL) {
        emu_misuse(p, "-", "no register at offset %03x", (unsigned)offset);
        return 0;
    }
    return *r;
}

static void write_fmr(emu_periph *p, uint32_t value)
{
    emu_can *s = emu_can_of(p);
    uint32_t own = p->at->family == EMU_F0 ? 1u : 0x3f01u;

    if (((s->fmr ^ value) & ~own) != 0) {
        emu_misuse(p, "FMR", "reserved bits must keep their reset value");
    }
    s->fmr = (s->fmr & ~own) | (value & own);
}

static bool may_write(const emu_periph *p, uint32_t offset)
{
    const emu_can *s = emu_can_of(p);

    if ((s->fmr & 1u) != 0 || offset == FA1R) {
        return true;
    }
    return offset >= BANKS && (s->fa1r >> (offset - BANKS) / 8u & 1u) == 0;
}

void emu_can_filter_write(emu_periph *p, uint32_t offset, uint32_t value)
{
    const char *name;
    uint32_t *r = filter_reg(p, offset, &name);

    if (r == NULL) {
        emu_misuse(p, "-", "no register at offset %03x", (unsigned)offset);
    } else if (offset == FMR) {
        write_fmr(p, value);
    } else if (!may_write(p, offset)) {
        emu_misuse(p, name, "filter written outside of FINIT while it is active");
    } else {
        *r = offset < BANKS ? emu_reserved(p, name, value, (1u << banks(p)) - 1u) : value;
    }
}
