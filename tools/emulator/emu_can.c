/* SPDX-License-Identifier: Apache-2.0 */
/* bxCAN: registers, operating modes and interrupts. irq: transmit, FIFO 0, FIFO 1, status change; on the F0,
 * where there is one for all, the first. Time triggered mode is not there; using it is recorded. */
#include "emu_can_internal.h"

enum {
    MCR = 0x000,
    MSR = 0x004,
    TSR = 0x008,
    RF0R = 0x00c,
    RF1R = 0x010,
    IER = 0x014,
    ESR = 0x018,
    BTR = 0x01c
};
enum { TX_FIRST = 0x180, RX_FIRST = 0x1b0, MAILBOXES_END = 0x1d0, FILTERS = 0x200 };

/* ---- interrupts
 * -------------------------------------------------------------------------------------------------- */

static bool any_tx(const emu_can *s)
{
    bool done = false;

    for (unsigned i = 0; i < EMU_CAN_MAILBOXES; i++) {
        done = done || (s->mb[i].status & RQCP) != 0;
    }
    return done && (s->ier & TMEIE) != 0;
}

static bool any_rx(const emu_can *s, unsigned n)
{
    const emu_can_fifo *f = &s->fifo[n];
    uint32_t wanted = s->ier >> (1u + 3u * n) & 7u;

    return (f->count > 0 && (wanted & 1u) != 0) || (f->full && (wanted & 2u) != 0) ||
           (f->overrun && (wanted & 4u) != 0);
}

static bool any_change(const emu_can *s)
{
    return ((s->msr & ERRI) != 0 && (s->ier & ERRIE) != 0) ||
           ((s->msr & WKUI) != 0 && (s->ier & WKUIE) != 0) ||
           ((s->msr & SLAKI) != 0 && (s->ier & SLKIE) != 0);
}

void emu_can_signals(emu_periph *p)
{
    const emu_can *s = emu_can_of(p);

    if (p->at->family == EMU_F0) {
        emu_irq(p, 0, any_tx(s) || any_rx(s, 0) || any_rx(s, 1) || any_change(s));
        return;
    }
    emu_irq(p, 0, any_tx(s));
    emu_irq(p, 1, any_rx(s, 0));
    emu_irq(p, 2, any_rx(s, 1));
    emu_irq(p, 3, any_change(s));
}

/* ---- modes
 * ---------------------------------------------------------------------------------------------------------
 */

static void judge_timing(emu_periph *p)
{
    uint32_t btr = emu_can_of(p)->btr, ts1 = (btr >> 16 & 15u) + 1u, ts2 = (btr >> 20 & 7u) + 1u;

    if (1u + ts1 + ts2 < 8 || 1u + ts1 + ts2 > 25) {
        emu_misuse(p, "BTR", "a bit of %u time quanta: CAN wants 8 to 25", (unsigned)(1u + ts1 + ts2));
    }
    if ((btr >> 24 & 3u) + 1u > ts2) {
        emu_misuse(p, "BTR", "SJW is longer than segment 2");
    }
    if (emu_can_bits_ns(p, 1) < 1000) {
        emu_misuse(p, "BTR", "more than 1 Mbit/s");
    }
}

static void leave_init(emu_periph *p)
{
    emu_can *s = emu_can_of(p);

    judge_timing(p);
    (void)emu_pad_needed(p, EMU_SIG_TX, "CAN_TX");
    (void)emu_pad_needed(p, EMU_SIG_RX, "CAN_RX");
    s->synced_at = emu_now(p->e) + emu_can_bits_ns(p, 11);
    if (s->bus_off && !s->recovering) {
        emu_can_start_recovery(p);
    }
}

static void enter(emu_can *s, uint32_t mode)
{
    s->msr = (s->msr & ~(uint32_t)(INAK | SLAK)) | mode;
    s->synced_at = EMU_NEVER;
}

static void wants_init(emu_can *s)
{
    if ((s->msr & INAK) == 0 || s->synced_at != EMU_NEVER) {
        enter(s, INAK);
    }
}

static void wants_sleep(emu_can *s)
{
    if ((s->msr & SLAK) == 0) {
        enter(s, SLAK);
        s->msr |= (s->ier & SLKIE) != 0 ? SLAKI : 0u;
    }
}

static void wants_normal(emu_periph *p)
{
    emu_can *s = emu_can_of(p);

    if ((s->msr & (INAK | SLAK)) == 0 || s->synced_at != EMU_NEVER) {
        return;
    }
    if ((s->msr & INAK) != 0) {
        leave_init(p);
    } else {
        s->synced_at = emu_now(p->e) + emu_can_bits_ns(p, 11);
    }
}

void emu_can_modes(emu_periph *p)
{
    emu_can *s = emu_can_of(p);

    if (s->sending >= 0) {
        return; /* the frame under way ends first */
    }
    if ((s->mcr & SLEEP) != 0) {
        wants_sleep(s);
    } else if ((s->mcr & INRQ) != 0) {
        wants_init(s);
    } else {
        wants_normal(p);
    }
}

static void master_reset(emu_periph *p)
{
    *emu_can_of(p) = (emu_can){.mcr = DBF | SLEEP,
                               .msr = SLAK,
                               .btr = 0x01230000u,
                               .fmr = 0x2a1c0e01u,
                               .sending = -1,
                               .synced_at = EMU_NEVER,
                               .recovered_at = EMU_NEVER};
}

static void write_mcr(emu_periph *p, uint32_t value)
{
    emu_can *s = emu_can_of(p);

    value = emu_reserved(p, "MCR", value, MCR_ALL);
    if ((value & MCR_RESET) != 0) {
        master_reset(p);
        return;
    }
    if ((value & TTCM) != 0) {
        emu_misuse(p, "MCR", "time triggered mode: not modelled");
    }
    if ((value & INRQ) != 0 && (value & SLEEP) != 0 && (s->mcr & INRQ) == 0) {
        emu_misuse(p, "MCR", "INRQ set with SLEEP not cleared: never acknowledged");
    }
    if ((s->msr & INAK) == 0 && ((s->mcr ^ value) & (TXFP | RFLM | NART | ABOM)) != 0) {
        emu_misuse(p, "MCR", "option changed outside of initialisation");
    }
    s->mcr = value;
    emu_can_modes(p);
}

/* ---- mailboxes
 * ------------------------------------------------------------------------------------------------------ */

static unsigned next_free(uint32_t empty)
{
    return (empty & 1u) != 0 ? 0 : (empty & 2u) != 0 ? 1 : 2;
}

static unsigned weakest(const emu_can *s)
{
    unsigned last = 0;
    bool found = false;

    for (unsigned i = 0; i < EMU_CAN_MAILBOXES; i++) {
        if (s->mb[i].pending && (!found || emu_can_rank(s, &s->mb[i]) >= emu_can_rank(s, &s->mb[last]))) {
            last = i;
            found = true;
        }
    }
    return last;
}

static uint32_t read_tsr(const emu_can *s)
{
    uint32_t value = 0, empty = 0, pending = 0;

    for (unsigned i = 0; i < EMU_CAN_MAILBOXES; i++) {
        value |= s->mb[i].status << 8 * i;
        empty |= s->mb[i].pending ? 0u : 1u << i;
        pending += s->mb[i].pending;
    }
    value |= empty << 26 | (empty != 0 ? next_free(empty) : weakest(s)) << 24;
    return pending > 1 ? value | 1u << (29u + weakest(s)) : value;
}

static void abort_mailbox(emu_can *s, unsigned i)
{
    emu_can_mailbox *m = &s->mb[i];

    if (!m->pending) {
        return;
    }
    if (s->sending == (int)i) {
        m->status |= ABRQ; /* the frame under way decides */
        return;
    }
    m->pending = false;
    m->ir &= ~1u;
    m->status = RQCP;
}

static void write_tsr(emu_periph *p, uint32_t value)
{
    emu_can *s = emu_can_of(p);

    for (unsigned i = 0; i < EMU_CAN_MAILBOXES; i++) {
        uint32_t bits = value >> 8 * i;

        if ((bits & RQCP) != 0 && (s->mb[i].status & RQCP) != 0) {
            s->mb[i].status = 0;
        }
        if ((bits & ABRQ) != 0) {
            abort_mailbox(s, i);
        }
    }
}

static void request(emu_periph *p, emu_can_mailbox *m)
{
    emu_can *s = emu_can_of(p);

    if ((m->dtr & 15u) > 8) {
        emu_misuse(p, "TDTxR", "DLC above 8");
    }
    m->pending = true;
    m->status = 0;
    m->order = s->orders++;
}

static void write_mailbox(emu_periph *p, uint32_t offset, uint32_t value)
{
    emu_can_mailbox *m = &emu_can_of(p)->mb[(offset - TX_FIRST) / 16u];

    if (m->pending) {
        emu_misuse(p, "TIxR", "transmit mailbox written while it is not empty");
        return;
    }
    switch (offset & 15u) {
    case 0x0:
        m->ir = value;
        if ((value & 1u) != 0) {
            request(p, m);
        }
        break;
    case 0x4:
        m->dtr = emu_reserved(p, "TDTxR", value, 0xffff010fu);
        break;
    case 0x8:
        m->dlr = value;
        break;
    default:
        m->dhr = value;
        break;
    }
}

static uint32_t read_mailbox(emu_periph *p, uint32_t offset)
{
    const emu_can *s = emu_can_of(p);
    const emu_can_mailbox *m;

    if (offset >= RX_FIRST) {
        return emu_can_fifo_read(p, (offset - RX_FIRST) / 16u, offset & 15u);
    }
    m = &s->mb[(offset - TX_FIRST) / 16u];
    switch (offset & 15u) {
    case 0x0:
        return m->ir;
    case 0x4:
        return m->dtr;
    case 0x8:
        return m->dlr;
    default:
        return m->dhr;
    }
}

/* ---- registers
 * -------------------------------------------------------------------------------------------------------- */

static uint32_t read_esr(const emu_can *s)
{
    uint32_t value = s->lec << 4;

    value |= s->tec >= 96 || s->rec >= 96 ? 1u : 0u;
    value |= s->tec > 127 || s->rec > 127 ? 2u : 0u;
    value |= s->bus_off ? 4u : 0u;
    return value | (s->tec > 255 ? 255u : s->tec) << 16 | s->rec << 24;
}

static uint32_t reg_read(emu_periph *p, uint32_t offset, unsigned bytes)
{
    const emu_can *s = emu_can_of(p);

    (void)bytes;
    if (offset >= FILTERS) {
        return emu_can_filter_read(p, offset);
    }
    if (offset >= TX_FIRST && offset < MAILBOXES_END) {
        return read_mailbox(p, offset);
    }
    switch (offset) {
    case MCR:
        return s->mcr;
    case MSR:
        return s->msr | (emu_can_dominant(p) ? 0u : 0xc00u) | (s->sending >= 0 ? 0x100u : 0u);
    case TSR:
        return read_tsr(s);
    case RF0R:
    case RF1R:
        return emu_can_fifo_status(s, offset == RF0R ? 0 : 1);
    case IER:
        return s->ier;
    case ESR:
        return read_esr(s);
    case BTR:
        return s->btr;
    default:
        emu_misuse(p, "-", "no register at offset %03x", (unsigned)offset);
        return 0;
    }
}

static void write_btr(emu_periph *p, uint32_t value)
{
    emu_can *s = emu_can_of(p);

    if ((s->msr & INAK) == 0) {
        emu_misuse(p, "BTR", "BTR written outside of initialisation");
        return;
    }
    s->btr = emu_reserved(p, "BTR", value, BTR_ALL | EMU_CAN_SILM);
}

static void write_control(emu_periph *p, uint32_t offset, uint32_t value)
{
    emu_can *s = emu_can_of(p);

    switch (offset) {
    case MCR:
        write_mcr(p, value);
        break;
    case MSR:
        s->msr &= ~(value & (ERRI | WKUI | SLAKI));
        break;
    case TSR:
        write_tsr(p, value);
        break;
    case RF0R:
    case RF1R:
        emu_can_fifo_write(p, offset == RF0R ? 0 : 1, value);
        break;
    case IER:
        s->ier = emu_reserved(p, "IER", value, IER_ALL);
        break;
    case ESR:
        s->lec = value >> 4 & 7u;
        break;
    case BTR:
        write_btr(p, value);
        break;
    default:
        emu_misuse(p, "-", "no writable register at offset %03x", (unsigned)offset);
        break;
    }
}

static void reg_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    if (bytes != 4 && (offset < TX_FIRST + 8u || offset >= RX_FIRST)) {
        emu_misuse(p, "-", "register at offset %03x written by %u bytes", (unsigned)offset, bytes);
    }
    if (offset >= FILTERS) {
        emu_can_filter_write(p, offset, value);
    } else if (offset >= TX_FIRST && offset < RX_FIRST) {
        write_mailbox(p, offset, value);
    } else {
        write_control(p, offset, value);
    }
    emu_can_schedule(p);
    emu_can_signals(p);
}

static void reset(emu_periph *p)
{
    master_reset(p);
    emu_can_signals(p);
}

emu_periph *emu_can_new(emu *e, const emu_instance *at)
{
    emu_periph *p = emu_periph_new(e, at, sizeof(emu_can));

    if (p != NULL) {
        p->read = reg_read;
        p->write = reg_write;
        p->next = emu_can_next;
        p->run = emu_can_run;
        p->reset = reset;
        p->can_in = emu_can_in_frame;
    }
    return p;
}
