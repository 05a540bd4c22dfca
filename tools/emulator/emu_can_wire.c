/* SPDX-License-Identifier: Apache-2.0 */
/* bxCAN on the wire: the length of frames, who may send, and fault confinement. */
#include "emu_can_internal.h"

#define ERROR_BITS 14u /* error flag and delimiter */
#define UNSENT_BITS 8u /* acknowledge delimiter and end of frame, which a broken frame does not have */
#define SUSPEND_BITS 8u
#define RECOVERY_BITS (128u * 11u)

/* ---- length
 * ------------------------------------------------------------------------------------------------ */

typedef struct stream {
    unsigned bits, run, last, crc;
} stream;

static void put(stream *s, unsigned bit)
{
    unsigned feed = (s->crc >> 14 & 1u) ^ bit;

    s->crc = (s->crc << 1 & 0x7fffu) ^ (feed != 0 ? 0x4599u : 0u);
    s->run = s->bits != 0 && bit == s->last ? s->run + 1u : 1u;
    s->last = bit;
    s->bits++;
    if (s->run == 5) { /* a stuff bit follows and begins the next run */
        s->bits++;
        s->last = bit ^ 1u;
        s->run = 1;
    }
}

static void put_field(stream *s, uint32_t value, unsigned width)
{
    while (width-- > 0) {
        put(s, value >> width & 1u);
    }
}

static void put_header(stream *s, const emu_can_frame *f)
{
    put(s, 0);
    if (f->extended) {
        put_field(s, f->id >> 18, 11);
        put_field(s, 3, 2);
        put_field(s, f->id, 18);
        put_field(s, f->remote ? 4u : 0u, 3);
    } else {
        put_field(s, f->id, 11);
        put_field(s, f->remote ? 4u : 0u, 3);
    }
    put_field(s, f->length, 4);
}

unsigned emu_can_frame_bits(const emu_can_frame *f)
{
    stream s = {0};
    unsigned length = f->length > 8 ? 8 : f->length;

    put_header(&s, f);
    for (unsigned i = 0; i < length && !f->remote; i++) {
        put_field(&s, f->data[i], 8);
    }
    put_field(&s, s.crc, 15);
    return s.bits + 1u + 2u + 7u + 3u; /* CRC delimiter, acknowledge, end of frame, intermission */
}

static uint32_t quanta(uint32_t btr)
{
    return 3u + (btr >> 16 & 15u) + (btr >> 20 & 7u);
}

uint64_t emu_can_bits_ns(const emu_periph *p, uint64_t bits)
{
    uint32_t btr = emu_can_of(p)->btr;

    return emu_cycles_ns(emu_bus_hz(p->e, p->at->bus), bits * quanta(btr) * ((btr & 0x3ffu) + 1u));
}

uint32_t emu_can_bit_hz(const emu *e, unsigned can)
{
    const emu_periph *p = emu_periph_find(e, can == 1 ? "CAN1" : "CAN2");
    uint32_t btr;

    p = p == NULL && can == 1 ? emu_periph_find(e, "CAN") : p;
    if (p == NULL) {
        return 0;
    }
    btr = emu_can_of(p)->btr;
    return emu_bus_hz(e, p->at->bus) / (quanta(btr) * ((btr & 0x3ffu) + 1u));
}

/* ---- fault confinement
 * ----------------------------------------------------------------------------------------- */

bool emu_can_takes_part(const emu_can *s)
{
    return (s->msr & (INAK | SLAK)) == 0 && !s->bus_off && s->synced_at == EMU_NEVER;
}

bool emu_can_dominant(emu_periph *p)
{
    const emu_world *w = emu_outside(p->e);

    return w->can_wire(w->ctx, p->at->number) == EMU_CAN_DOMINANT;
}

void emu_can_start_recovery(emu_periph *p)
{
    emu_can *s = emu_can_of(p);

    s->recovering = true;
    s->recovered_at = emu_now(p->e) + emu_can_bits_ns(p, RECOVERY_BITS);
}

static void go_bus_off(emu_periph *p)
{
    emu_can *s = emu_can_of(p);

    s->bus_off = true;
    if ((s->ier & BOFIE) != 0) {
        s->msr |= ERRI;
    }
    if ((s->mcr & ABOM) != 0) {
        emu_can_start_recovery(p);
    }
}

static void tell_levels(emu_can *s)
{
    bool warned = s->tec >= 96 || s->rec >= 96, passive = s->tec > 127 || s->rec > 127;

    if ((warned && !s->warned && (s->ier & EWGIE) != 0) ||
        (passive && !s->passive && (s->ier & EPVIE) != 0)) {
        s->msr |= ERRI;
    }
    s->warned = warned;
    s->passive = passive;
}

void emu_can_error_seen(emu_periph *p, emu_can_error what)
{
    emu_can *s = emu_can_of(p);

    s->lec = (unsigned)what;
    if (what != LEC_NONE && (s->ier & LECIE) != 0) {
        s->msr |= ERRI;
    }
    tell_levels(s);
    if (s->tec > 255 && !s->bus_off) {
        go_bus_off(p);
    }
}

static void recovered(emu_periph *p)
{
    emu_can *s = emu_can_of(p);

    s->bus_off = s->recovering = false;
    s->tec = s->rec = 0;
    s->wire_free = emu_now(p->e);
    tell_levels(s);
}

/* ---- transmission
 * ------------------------------------------------------------------------------------------------ */

static emu_can_frame frame_of(const emu_can_mailbox *m)
{
    emu_can_frame f = {.extended = (m->ir & 4u) != 0, .remote = (m->ir & 2u) != 0};

    f.id = f.extended ? m->ir >> 3 : m->ir >> 21;
    f.length = (uint8_t)((m->dtr & 15u) > 8 ? 8 : m->dtr & 15u);
    for (unsigned i = 0; i < 4; i++) {
        f.data[i] = (uint8_t)(m->dlr >> 8 * i);
        f.data[4 + i] = (uint8_t)(m->dhr >> 8 * i);
    }
    return f;
}

/* Lower = sent first: the order of the bits in arbitration. */
uint32_t emu_can_rank(const emu_can *s, const emu_can_mailbox *m)
{
    uint32_t id = m->ir >> 3;

    if ((s->mcr & TXFP) != 0) {
        return m->order;
    }
    if ((m->ir & 4u) == 0) {
        return (m->ir >> 21) << 20 | (m->ir & 2u) << 18;
    }
    return (id >> 18) << 20 | 1u << 19 | (id & 0x3ffffu) << 1 | (m->ir >> 1 & 1u);
}

static int strongest(const emu_can *s)
{
    int best = -1;

    for (int i = 0; i < (int)EMU_CAN_MAILBOXES; i++) {
        if (s->mb[i].pending && (best < 0 || emu_can_rank(s, &s->mb[i]) < emu_can_rank(s, &s->mb[best]))) {
            best = i;
        }
    }
    return best;
}

void emu_can_schedule(emu_periph *p)
{
    emu_can *s = emu_can_of(p);
    uint64_t from = emu_now(p->e);
    emu_can_frame f;

    if (s->sending >= 0 || !emu_can_takes_part(s) || (s->mcr & (INRQ | SLEEP)) != 0) {
        return;
    }
    s->sending = strongest(s);
    if (s->sending < 0) {
        return;
    }
    f = frame_of(&s->mb[s->sending]);
    from = s->wire_free > from ? s->wire_free : from;
    s->sent_at = from + emu_can_bits_ns(p, emu_can_frame_bits(&f));
}

static void complete(emu_can_mailbox *m, uint32_t status)
{
    m->pending = false;
    m->ir &= ~1u;
    m->status = RQCP | status;
}

static emu_can_result put_on_wire(emu_periph *p, const emu_can_frame *f)
{
    const emu_can *s = emu_can_of(p);
    const emu_world *w = emu_outside(p->e);

    if ((s->btr & LBKM) != 0) { /* loop back: no acknowledge is needed, and with SILM nothing goes out */
        if ((s->btr & EMU_CAN_SILM) == 0) {
            (void)w->can_out(w->ctx, p->at->number, f);
        }
        (void)emu_can_store(p, f);
        return EMU_CAN_ACKED;
    }
    if ((s->btr & EMU_CAN_SILM) != 0) {
        return EMU_CAN_NO_ACK;
    }
    if (emu_can_dominant(p) || emu_pad_of(p->e, p->at, EMU_SIG_RX) == NULL ||
        emu_pad_of(p->e, p->at, EMU_SIG_TX) == NULL) {
        return EMU_CAN_BIT_ERROR;
    }
    return w->can_out(w->ctx, p->at->number, f);
}

static void tx_failed(emu_periph *p, emu_can_mailbox *m, emu_can_result r)
{
    static const emu_can_error lec[] = {
        [EMU_CAN_NO_ACK] = LEC_ACK, [EMU_CAN_BIT_ERROR] = LEC_RECESSIVE, [EMU_CAN_FORM_ERROR] = LEC_FORM};
    emu_can *s = emu_can_of(p);
    bool lost = r == EMU_CAN_LOST, passive = s->tec > 127;
    uint32_t cause = lost ? ALST : TERR;

    if (lost) {
        s->wire_free = emu_now(p->e);
    } else {
        /* a passive node alone on the bus stays passive: a missing acknowledge no longer counts */
        s->tec += r == EMU_CAN_NO_ACK && passive ? 0u : 8u;
        s->wire_free =
            emu_now(p->e) + emu_can_bits_ns(p, ERROR_BITS - UNSENT_BITS + (passive ? SUSPEND_BITS : 0u));
        emu_can_error_seen(p, lec[r]);
    }
    if ((s->mcr & NART) != 0 || (m->status & ABRQ) != 0) {
        complete(m, cause);
    } else {
        m->status = (m->status & ABRQ) | cause;
    }
}

static void frame_sent(emu_periph *p)
{
    emu_can *s = emu_can_of(p);
    emu_can_mailbox *m = &s->mb[s->sending];
    emu_can_frame f = frame_of(m);
    emu_can_result r;

    s->sending = -1; /* the world may look around */
    r = put_on_wire(p, &f);
    if (r != EMU_CAN_ACKED) {
        tx_failed(p, m, r);
        return;
    }
    s->wire_free = emu_now(p->e);
    s->tec -= s->tec > 0 ? 1u : 0u;
    complete(m, TXOK);
    emu_can_error_seen(p, LEC_NONE);
}

/* ---- time
 * ---------------------------------------------------------------------------------------------------------
 */

static void keep_waiting(emu_periph *p, uint64_t *until, uint64_t bits)
{
    *until = emu_now(p->e) + emu_can_bits_ns(p, bits);
}

void emu_can_run(emu_periph *p)
{
    emu_can *s = emu_can_of(p);
    uint64_t now = emu_now(p->e);

    if (s->sending >= 0 && s->sent_at <= now) {
        frame_sent(p);
    }
    if (s->synced_at <= now) {
        if (emu_can_dominant(p)) {
            keep_waiting(p, &s->synced_at, 11);
        } else {
            s->synced_at = EMU_NEVER;
            s->msr &= ~(uint32_t)(INAK | SLAK);
        }
    }
    if (s->recovering && s->recovered_at <= now) {
        if (emu_can_dominant(p)) {
            keep_waiting(p, &s->recovered_at, RECOVERY_BITS);
        } else {
            recovered(p);
        }
    }
    emu_can_modes(p);
    emu_can_schedule(p);
    emu_can_signals(p);
}

uint64_t emu_can_next(const emu_periph *p)
{
    const emu_can *s = emu_can_of(p);
    uint64_t when = s->synced_at;

    if (s->sending >= 0 && s->sent_at < when) {
        when = s->sent_at;
    }
    if (s->recovering && s->recovered_at < when) {
        when = s->recovered_at;
    }
    return when;
}
