/* SPDX-License-Identifier: Apache-2.0 */
/* I2C of the STM32F4: what the master does on the wires, and how long it takes. */
#include "emu_i2c_v1.h"

/* ---- time -------------------------------------------------------------------------------------------- */

/* Cycles of the bus clock in one SCL period. */
static uint64_t period(const emu_i2c_v1 *s)
{
    uint64_t ccr = s->ccr & 0xfffu;

    if ((s->ccr & 0x8000u) == 0) {
        return 2 * ccr;
    }
    return (s->ccr & 0x4000u) != 0 ? 25 * ccr : 3 * ccr;
}

static uint64_t bits_ns(const emu_periph *p, unsigned bits)
{
    uint64_t cycles = period(emu_i2c_v1_of(p)) * bits;

    return emu_cycles_ns(emu_bus_hz(p->e, p->at->bus), cycles != 0 ? cycles : 8u * bits);
}

static void begin(emu_periph *p, emu_i2c_v1_job what, unsigned bits)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);
    uint64_t from = emu_now(p->e);

    from = s->not_before > from ? s->not_before : from;
    s->doing = what;
    s->due = from + bits_ns(p, bits);
}

/* ---- interrupts and DMA -------------------------------------------------------------------------------- */

void emu_i2c_v1_signals(emu_periph *p)
{
    const emu_i2c_v1 *s = emu_i2c_v1_of(p);
    uint32_t events = s->sr1 & (SB | ADDR | BTF);
    uint32_t buffer = s->sr1 & (TXE | RXNE);
    bool dma = (s->cr2 & DMAEN) != 0;

    emu_irq(p, 0,
            (s->cr2 & ITEVTEN) != 0 && (events != 0 || ((s->cr2 & ITBUFEN) != 0 && !dma && buffer != 0)));
    emu_irq(p, 1, (s->cr2 & ITERREN) != 0 && (s->sr1 & SR1_ERRORS) != 0);
    if (p->at->number == 1) {
        emu_dma_request(p->e, EMU_DMA_I2C1_TX, dma && (s->sr1 & TXE) != 0);
        emu_dma_request(p->e, EMU_DMA_I2C1_RX, dma && (s->sr1 & RXNE) != 0);
    }
}

/* ---- conditions on the wires -----------------------------------------------------------------------------
 */

static void judge_rate(emu_periph *p)
{
    const emu_i2c_v1 *s = emu_i2c_v1_of(p);
    uint32_t hz = emu_bus_hz(p->e, p->at->bus), freq = s->cr2 & 0x3fu, ccr = s->ccr & 0xfffu;
    bool fast = (s->ccr & 0x8000u) != 0;
    uint64_t cycles = period(s);

    if (freq < 2 || freq != hz / 1000000u) {
        emu_misuse(p, "CR2", "FREQ %u is not the bus clock of %u MHz", freq, hz / 1000000u);
    }
    if (ccr < ((s->ccr & 0xc000u) == 0xc000u ? 1u : 4u)) {
        emu_misuse(p, "CCR", "CCR %u below its minimum", ccr);
    } else if (hz / cycles > (fast ? 400000u : 100000u)) {
        emu_misuse(p, "CCR", "SCL of %u Hz is too fast for this mode", (unsigned)(hz / cycles));
    }
    if (s->trise == 0 || emu_cycles_ns(hz, s->trise - 1u) > (fast ? 300u : 1000u) + 50u) {
        emu_misuse(p, "TRISE", "TRISE %u does not fit the bus clock", s->trise);
    }
}

static void try_start(emu_periph *p)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);

    s->connected = emu_i2c_connected(p);
    judge_rate(p);
    s->sr1 &= ~(uint32_t)BTF;
    begin(p, STARTING, 1);
}

/* START or STOP was asked for and no byte is under way. */
void emu_i2c_v1_conditions(emu_periph *p)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);

    if ((s->cr1 & PE) == 0 || s->doing != NOTHING || (s->sr1 & (SB | ADDR)) != 0) {
        return;
    }
    if ((s->cr1 & STOP) != 0 && s->master) {
        if (!s->transmits && s->last_ack) {
            emu_misuse(p, "CR1", "STOP behind a byte that was acknowledged: the slave still drives SDA");
        }
        begin(p, STOPPING, 1);
    } else if ((s->cr1 & START) != 0) {
        try_start(p);
    }
}

void emu_i2c_v1_release(emu_i2c_v1 *s)
{
    s->doing = NOTHING;
    s->master = s->transmits = s->dr_full = s->refused = s->last_ack = false;
    s->not_before = 0;
}

/* ---- bytes
 * ------------------------------------------------------------------------------------------------- */

void emu_i2c_v1_receive(emu_periph *p)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);

    s->ack_latched = (s->cr1 & ACK) != 0;
    begin(p, RECEIVING, 9);
}

void emu_i2c_v1_send(emu_periph *p, uint8_t byte)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);

    s->shift = byte;
    s->sr1 |= TXE;
    s->sr1 &= ~(uint32_t)BTF;
    begin(p, SENDING, 9);
}

void emu_i2c_v1_send_address(emu_periph *p, uint8_t byte)
{
    emu_i2c_v1_of(p)->shift = byte;
    begin(p, ADDRESSING, 9);
}

static emu_i2c_answer put(emu_periph *p, bool address)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);
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

/* Everything but an acknowledge. Returns false when the byte was taken. */
static bool failed(emu_periph *p, emu_i2c_answer a)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);

    switch (a) {
    case EMU_I2C_ACK:
        return false;
    case EMU_I2C_NACK:
        s->sr1 |= AF;
        s->sr1 &= ~(uint32_t)TXE;
        s->refused = true;
        s->dr_full = false;
        break;
    case EMU_I2C_LOST:
        s->sr1 |= ARLO;
        s->sr1 &= ~(uint32_t)(TXE | BTF);
        emu_i2c_v1_release(s);
        s->cr1 &= ~(uint32_t)(START | STOP);
        break;
    default:
        s->sr1 |= BERR;
        s->refused = true;
        break;
    }
    return true;
}

static void started(emu_periph *p)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);

    s->cr1 &= ~(uint32_t)START;
    s->master = true;
    s->refused = s->dr_full = s->shift_full = false;
    s->sr1 = (s->sr1 | SB) & ~(uint32_t)(TXE | BTF);
    s->sr1_read = false;
}

static void addressed(emu_periph *p)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);

    s->transmits = (s->shift & 1u) == 0;
    s->last_ack = false;
    if (!failed(p, put(p, true))) {
        s->sr1 |= ADDR;
        s->sr1_read = false;
    }
}

static void sent(emu_periph *p)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);

    if (failed(p, put(p, false))) {
        return;
    }
    if ((s->cr1 & (START | STOP)) != 0 && !s->dr_full) {
        return;
    }
    if (s->dr_full) {
        s->dr_full = false;
        emu_i2c_v1_send(p, s->dr);
    } else {
        s->sr1 |= BTF;
    }
}

/* The byte leaves the shift register. */
void emu_i2c_v1_into_dr(emu_i2c_v1 *s)
{
    s->dr = s->shift;
    s->sr1 |= RXNE;
    s->shift_full = false;
}

void emu_i2c_v1_go_on_receiving(emu_periph *p)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);

    if ((s->cr1 & (START | STOP)) != 0) {
        return;
    }
    if (!s->last_ack) {
        emu_misuse(p, "CR1", "no STOP or START behind a byte not acknowledged: the clock runs on");
    }
    emu_i2c_v1_receive(p);
}

static void received(emu_periph *p)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);
    const emu_world *w = emu_outside(p->e);
    bool ack = (s->cr1 & POS) != 0 ? s->ack_latched : (s->cr1 & ACK) != 0;

    s->shift = s->connected ? w->i2c_read(w->ctx, p->at->number, ack) : 0xff;
    if ((emu_i2c_held(p) & EMU_I2C_SDA_LOW) != 0) {
        s->shift = 0;
    }
    s->not_before = emu_now(p->e) + w->i2c_stretch_ns(w->ctx, p->at->number);
    s->last_ack = ack;
    if ((s->sr1 & RXNE) != 0) {
        s->shift_full = true;
        s->sr1 |= BTF;
    } else {
        emu_i2c_v1_into_dr(s);
        emu_i2c_v1_go_on_receiving(p);
    }
}

static void stopped(emu_periph *p)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);
    const emu_world *w = emu_outside(p->e);

    if (s->connected) {
        w->i2c_stop(w->ctx, p->at->number);
    }
    s->cr1 &= ~(uint32_t)STOP;
    s->sr1 &= ~(uint32_t)(TXE | (s->transmits ? BTF : 0u));
    emu_i2c_v1_release(s);
}

/* A held wire keeps the master waiting: SCL at any time, SDA where the bus must be free. */
static bool held_up(emu_periph *p)
{
    const emu_i2c_v1 *s = emu_i2c_v1_of(p);
    unsigned held = emu_i2c_held(p);
    bool wants_sda = s->doing == STARTING || s->doing == STOPPING;

    return (held & EMU_I2C_SCL_LOW) != 0 || (wants_sda && (held & EMU_I2C_SDA_LOW) != 0);
}

void emu_i2c_v1_run(emu_periph *p)
{
    static void (*const end[])(emu_periph *) = {[STARTING] = started,
                                                [ADDRESSING] = addressed,
                                                [SENDING] = sent,
                                                [RECEIVING] = received,
                                                [STOPPING] = stopped};
    emu_i2c_v1 *s = emu_i2c_v1_of(p);
    emu_i2c_v1_job done = s->doing;

    if (done == NOTHING || s->due > emu_now(p->e)) {
        return;
    }
    if (held_up(p)) {
        s->due = emu_now(p->e) + bits_ns(p, 1);
        return;
    }
    s->doing = NOTHING;
    end[done](p);
    emu_i2c_v1_conditions(p);
    emu_i2c_v1_signals(p);
}

uint64_t emu_i2c_v1_next(const emu_periph *p)
{
    return emu_i2c_v1_of(p)->doing == NOTHING ? EMU_NEVER : emu_i2c_v1_of(p)->due;
}
