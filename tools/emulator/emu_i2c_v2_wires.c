/* SPDX-License-Identifier: Apache-2.0 */
/* I2C of the STM32F0: what the master does on the wires, and how long it takes. */
#include "emu_i2c_v2.h"

/* Cycles of the kernel clock in one SCL period: both phases, and twice the synchronisation of an edge, taken
 * as 3 cycles and the digital filter. The rise time of the wires is not there. */
uint64_t emu_i2c_v2_scl_cycles(const emu_i2c_v2 *s)
{
    uint32_t t = s->timingr;
    uint64_t phases = ((t & 0xffu) + 1u) + ((t >> 8 & 0xffu) + 1u);

    return phases * ((t >> 28) + 1u) + 2u * (3u + ((s->cr1 & DNF) >> 8));
}

static uint64_t bits_ns(const emu_periph *p, unsigned bits)
{
    return emu_cycles_ns(emu_kernel_hz(p->e, p->at), emu_i2c_v2_scl_cycles(emu_i2c_v2_of(p)) * bits);
}

static void begin(emu_periph *p, emu_i2c_v2_job what, unsigned bits)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);
    uint64_t from = emu_now(p->e), length = bits_ns(p, bits);

    from = s->not_before > from ? s->not_before : from;
    s->doing = what;
    s->due = length == EMU_NEVER ? EMU_NEVER : from + length;
}

void emu_i2c_v2_signals(emu_periph *p)
{
    const emu_i2c_v2 *s = emu_i2c_v2_of(p);
    uint32_t wanted = 0;

    wanted |= (s->cr1 & TXIE) != 0 ? TXIS : 0u;
    wanted |= (s->cr1 & RXIE) != 0 ? RXNE : 0u;
    wanted |= (s->cr1 & NACKIE) != 0 ? NACKF : 0u;
    wanted |= (s->cr1 & STOPIE) != 0 ? STOPF : 0u;
    wanted |= (s->cr1 & TCIE) != 0 ? TC | TCR : 0u;
    wanted |= (s->cr1 & ERRIE) != 0 ? ISR_ERRORS : 0u;
    emu_irq(p, 0, (s->isr & wanted) != 0);
    if (p->at->number == 1) {
        emu_dma_request(p->e, EMU_DMA_I2C1_TX, (s->cr1 & TXDMAEN) != 0 && (s->isr & TXIS) != 0);
        emu_dma_request(p->e, EMU_DMA_I2C1_RX, (s->cr1 & RXDMAEN) != 0 && (s->isr & RXNE) != 0);
    }
}

/* ---- conditions ------------------------------------------------------------------------------------------
 */

static void judge_start(emu_periph *p)
{
    const emu_i2c_v2 *s = emu_i2c_v2_of(p);
    uint32_t hz = emu_kernel_hz(p->e, p->at);

    if (s->timingr == 0) {
        emu_misuse(p, "TIMINGR", "START with TIMINGR never written");
    } else if (hz / emu_i2c_v2_scl_cycles(s) > 1000000u) {
        emu_misuse(p, "TIMINGR", "SCL above 1 MHz");
    }
    if (hz == 0) {
        emu_misuse(p, "CR1", "the kernel clock of the I2C stands still");
    }
    if ((s->isr & TXE) == 0) {
        emu_misuse(p, "TXDR", "START with a byte of an earlier transfer in TXDR");
    }
}

void emu_i2c_v2_conditions(emu_periph *p)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);

    if ((s->cr1 & PE) == 0 || s->doing != NOTHING || s->shift_full) {
        return;
    }
    if (s->master && (s->cr2 & STOP) != 0) {
        s->isr &= ~(uint32_t)(TC | TCR | TXIS);
        begin(p, STOPPING, 1);
    } else if ((s->cr2 & START) != 0 && !s->active) {
        s->connected = emu_i2c_connected(p);
        judge_start(p);
        s->isr &= ~(uint32_t)TC;
        begin(p, STARTING, 1);
    }
}

void emu_i2c_v2_release(emu_i2c_v2 *s)
{
    s->doing = NOTHING;
    s->master = s->active = s->shift_full = false;
    s->not_before = s->low_since = 0;
    s->cr2 &= ~(uint32_t)(START | STOP);
    s->isr &= ~(uint32_t)(TXIS | TC | TCR);
}

/* ---- bytes
 * ------------------------------------------------------------------------------------------------- */

static void end_of_block(emu_periph *p)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);

    s->isr &= ~(uint32_t)TXIS;
    if ((s->cr2 & RELOAD) != 0) {
        s->isr |= TCR;
    } else if ((s->cr2 & AUTOEND) != 0) {
        s->active = false;
        begin(p, STOPPING, 1);
    } else {
        s->active = false;
        s->isr |= TC;
    }
}

static void ask(emu_i2c_v2 *s)
{
    if ((s->isr & TXE) != 0 && s->asked < emu_i2c_v2_nbytes(s)) {
        s->asked++;
        s->isr |= TXIS;
    }
}

void emu_i2c_v2_feed(emu_periph *p)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);

    if (!s->active || emu_i2c_v2_reads(s) || s->doing != NOTHING || (s->cr2 & STOP) != 0) {
        return;
    }
    if ((s->isr & TXE) == 0) {
        s->shift = s->txdr;
        s->isr |= TXE;
        begin(p, SENDING, 9);
    }
    ask(s);
}

static void go_on(emu_periph *p)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);

    if ((s->cr2 & STOP) != 0) {
        return;
    }
    if (s->done == emu_i2c_v2_nbytes(s)) {
        end_of_block(p);
    } else if (emu_i2c_v2_reads(s)) {
        begin(p, RECEIVING, 9);
    } else {
        emu_i2c_v2_feed(p);
    }
}

void emu_i2c_v2_next_block(emu_periph *p)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);

    s->isr &= ~(uint32_t)TCR;
    s->done = s->asked = 0;
    go_on(p);
}

static void into_rxdr(emu_i2c_v2 *s)
{
    s->rxdr = s->shift;
    s->isr |= RXNE;
    s->shift_full = false;
}

void emu_i2c_v2_take(emu_periph *p)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);

    s->isr &= ~(uint32_t)RXNE;
    if (s->shift_full) {
        into_rxdr(s);
        go_on(p);
        emu_i2c_v2_conditions(p);
    }
}

/* ---- ends of jobs
 * -------------------------------------------------------------------------------------------- */

static void started(emu_periph *p)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);

    s->master = true;
    s->shift = (uint8_t)((s->cr2 & 0xfeu) | (emu_i2c_v2_reads(s) ? 1u : 0u));
    s->done = s->asked = 0;
    begin(p, ADDRESSING, 9);
}

static emu_i2c_answer put(emu_periph *p, bool address)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);
    const emu_world *w = emu_outside(p->e);
    emu_i2c_answer a;

    if (!s->connected) {
        return EMU_I2C_NACK;
    }
    if ((emu_i2c_held(p) & EMU_I2C_SDA_LOW) != 0 && s->shift != 0) {
        return EMU_I2C_LOST;
    }
    a = address ? w->i2c_start(w->ctx, p->at->number, s->shift)
                : w->i2c_write(w->ctx, p->at->number, s->shift);
    s->not_before = emu_now(p->e) + w->i2c_stretch_ns(w->ctx, p->at->number);
    return a;
}

/* Everything but an acknowledge. Returns false when the byte was taken. A refused byte ends in a STOP. */
static bool failed(emu_periph *p, emu_i2c_answer a)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);

    switch (a) {
    case EMU_I2C_ACK:
        return false;
    case EMU_I2C_NACK:
        s->isr |= NACKF;
        s->isr &= ~(uint32_t)TXIS;
        s->active = false;
        begin(p, STOPPING, 1);
        break;
    case EMU_I2C_LOST:
        s->isr |= ARLO;
        emu_i2c_v2_release(s);
        break;
    default:
        s->isr |= BERR;
        emu_i2c_v2_release(s);
        break;
    }
    return true;
}

static void addressed(emu_periph *p)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);

    s->cr2 &= ~(uint32_t)START;
    if (!failed(p, put(p, true))) {
        s->active = true;
        go_on(p);
    }
}

static void sent(emu_periph *p)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);

    if (!failed(p, put(p, false))) {
        s->done++;
        go_on(p);
    }
}

static void received(emu_periph *p)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);
    const emu_world *w = emu_outside(p->e);
    bool last = s->done + 1u >= emu_i2c_v2_nbytes(s) && (s->cr2 & RELOAD) == 0;
    bool ack = !last && (s->cr2 & STOP) == 0;

    s->shift = s->connected ? w->i2c_read(w->ctx, p->at->number, ack) : 0xff;
    if ((emu_i2c_held(p) & EMU_I2C_SDA_LOW) != 0) {
        s->shift = 0;
    }
    s->not_before = emu_now(p->e) + w->i2c_stretch_ns(w->ctx, p->at->number);
    s->done++;
    if ((s->isr & RXNE) != 0) {
        s->shift_full = true;
    } else {
        into_rxdr(s);
        go_on(p);
    }
}

static void stopped(emu_periph *p)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);
    const emu_world *w = emu_outside(p->e);

    if (s->connected) {
        w->i2c_stop(w->ctx, p->at->number);
    }
    emu_i2c_v2_release(s);
    s->isr |= STOPF;
}

/* ---- held wires
 * ---------------------------------------------------------------------------------------------- */

/* SCL low for longer than TIMEOUTA. */
static void watch_low(emu_periph *p, bool low)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);
    uint64_t limit = ((s->timeoutr & 0xfffu) + 1ull) * 2048ull;

    if (!low) {
        s->low_since = 0;
        return;
    }
    s->low_since = s->low_since != 0 ? s->low_since : emu_now(p->e);
    if ((s->timeoutr & 0x9000u) == 0x8000u &&
        emu_now(p->e) - s->low_since > emu_cycles_ns(emu_kernel_hz(p->e, p->at), limit)) {
        s->isr |= TIMEOUT;
        s->cr2 &= ~(uint32_t)START;
    }
}

static bool held_up(emu_periph *p)
{
    const emu_i2c_v2 *s = emu_i2c_v2_of(p);
    unsigned held = emu_i2c_held(p);
    bool wants_sda = s->doing == STARTING || s->doing == STOPPING;
    bool scl = (held & EMU_I2C_SCL_LOW) != 0;

    watch_low(p, scl);
    return scl || (wants_sda && (held & EMU_I2C_SDA_LOW) != 0);
}

void emu_i2c_v2_run(emu_periph *p)
{
    static void (*const end[])(emu_periph *) = {[STARTING] = started,
                                                [ADDRESSING] = addressed,
                                                [SENDING] = sent,
                                                [RECEIVING] = received,
                                                [STOPPING] = stopped};
    emu_i2c_v2 *s = emu_i2c_v2_of(p);
    emu_i2c_v2_job done = s->doing;

    if (done == NOTHING || s->due > emu_now(p->e)) {
        return;
    }
    if (held_up(p)) {
        s->due = emu_now(p->e) + bits_ns(p, 1);
    } else {
        s->doing = NOTHING;
        end[done](p);
        emu_i2c_v2_conditions(p);
    }
    emu_i2c_v2_signals(p);
}

uint64_t emu_i2c_v2_next(const emu_periph *p)
{
    return emu_i2c_v2_of(p)->doing == NOTHING ? EMU_NEVER : emu_i2c_v2_of(p)->due;
}
