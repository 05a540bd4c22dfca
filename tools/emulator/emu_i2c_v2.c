/* SPDX-License-Identifier: Apache-2.0 */
/* I2C of the STM32F0 (RM0091, chapter 26) as a master with 7-bit addresses: registers and their judge. irq:
 * global. Slave mode, SMBus and packet error checking are not there; using them is recorded. */
#include "emu_i2c_v2.h"

enum {
    CR1 = 0x00,
    CR2 = 0x04,
    OAR1 = 0x08,
    OAR2 = 0x0c,
    TIMINGR = 0x10,
    TIMEOUTR = 0x14,
    ISR = 0x18,
    ICR = 0x1c,
    PECR = 0x20,
    RXDR = 0x24,
    TXDR = 0x28
};

static uint32_t status(emu_periph *p)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);
    bool busy = s->master || ((s->cr1 & PE) != 0 && emu_i2c_held(p) != 0);

    return s->isr | (busy ? BUSY : 0u);
}

static uint32_t read_rxdr(emu_periph *p)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);
    uint32_t value = s->rxdr;

    if ((s->isr & RXNE) == 0) {
        emu_misuse(p, "RXDR", "RXDR read while RXNE is not set");
        return value;
    }
    emu_i2c_v2_take(p);
    emu_i2c_v2_signals(p);
    return value;
}

static uint32_t reg_read(emu_periph *p, uint32_t offset, unsigned bytes)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);

    (void)bytes;
    switch (offset) {
    case CR1:
        s->pe_looked_at = true;
        return s->cr1;
    case CR2:
        return s->cr2;
    case OAR1:
        return s->oar1;
    case OAR2:
        return s->oar2;
    case TIMINGR:
        return s->timingr;
    case TIMEOUTR:
        return s->timeoutr;
    case ISR:
        return status(p);
    case ICR:
    case PECR:
        return 0;
    case RXDR:
        return read_rxdr(p);
    case TXDR:
        return s->txdr;
    default:
        emu_misuse(p, "-", "no register at offset %02x", (unsigned)offset);
        return 0;
    }
}

/* ---- CR1
 * --------------------------------------------------------------------------------------------------- */

static void judge_cr1(emu_periph *p, uint32_t value)
{
    const emu_i2c_v2 *s = emu_i2c_v2_of(p);

    if ((value & CR1_ALL & ~(uint32_t)CR1_MODELLED) != 0) {
        emu_misuse(p, "CR1", "slave byte control, NOSTRETCH, wake-up or SMBus: not modelled");
    }
    if ((s->cr1 & value & PE) != 0 && ((s->cr1 ^ value) & (DNF | ANFOFF)) != 0) {
        emu_misuse(p, "CR1", "filter changed while PE is set");
    }
    if ((s->cr1 & PE) == 0 && (value & PE) != 0 && s->disabled_at != EMU_NEVER && !s->pe_looked_at &&
        emu_now(p->e) - s->disabled_at < emu_cycles_ns(emu_bus_hz(p->e, p->at->bus), 3)) {
        emu_misuse(p, "CR1", "PE set again before it was low for 3 bus cycles");
    }
}

static void write_cr1(emu_periph *p, uint32_t value)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);

    judge_cr1(p, value);
    if ((s->cr1 & PE) != 0 && (value & PE) == 0) {
        emu_i2c_v2_release(s);
        s->isr = TXE;
        s->disabled_at = emu_now(p->e);
        s->pe_looked_at = false;
    }
    s->cr1 = value;
}

/* ---- CR2
 * --------------------------------------------------------------------------------------------------- */

static void judge_start_bit(emu_periph *p, uint32_t value)
{
    const emu_i2c_v2 *s = emu_i2c_v2_of(p);

    if ((s->cr1 & PE) == 0) {
        emu_misuse(p, "CR2", "START while PE is not set");
    } else if (s->active || s->doing != NOTHING || ((status(p) & BUSY) != 0 && (s->isr & TC) == 0)) {
        emu_misuse(p, "CR2", "START while BUSY");
    }
    if ((value & STOP) != 0) {
        emu_misuse(p, "CR2", "START and STOP in one write");
    }
    if ((value & RD_WRN) != 0 && (value & NBYTES) == 0) {
        emu_misuse(p, "CR2", "read of no bytes: the slave would keep SDA");
    }
}

static void judge_cr2(emu_periph *p, uint32_t value)
{
    const emu_i2c_v2 *s = emu_i2c_v2_of(p);

    if ((value & ~(uint32_t)(CR2_MODELLED | 1u)) != 0) {
        emu_misuse(p, "CR2", "10-bit address, NACK or PEC: not modelled");
    }
    if ((s->cr2 & START) != 0) {
        emu_misuse(p, "CR2", "CR2 written while START waits to be carried out");
    } else if ((value & START) != 0) {
        judge_start_bit(p, value);
    }
    if ((value & STOP) != 0 && !s->master) {
        emu_misuse(p, "CR2", "STOP while not master");
    }
    if (s->active && (s->isr & TCR) == 0 && ((s->cr2 ^ value) & (NBYTES | RELOAD)) != 0) {
        emu_misuse(p, "CR2", "NBYTES or RELOAD changed before TCR");
    }
    if ((s->isr & TCR) != 0 && (value & NBYTES) == 0 && (value & STOP) == 0) {
        emu_misuse(p, "CR2", "NBYTES of 0 does not clear TCR");
    }
    if (s->active && ((s->cr2 ^ value) & RD_WRN) != 0) {
        emu_misuse(p, "CR2", "direction changed during a transfer");
    }
}

static void write_cr2(emu_periph *p, uint32_t value)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);
    uint32_t waits = s->cr2 & (START | STOP);

    judge_cr2(p, value);
    if ((s->cr1 & PE) == 0) {
        s->cr2 = value & ~(uint32_t)(START | STOP);
        return;
    }
    s->cr2 = (waits & START) != 0 ? s->cr2 : value | waits;
    if (!s->master) {
        s->cr2 &= ~(uint32_t)STOP;
    }
    if ((s->isr & TCR) != 0 && (value & NBYTES) != 0) {
        emu_i2c_v2_next_block(p);
    }
    emu_i2c_v2_conditions(p);
}

/* ---- the rest
 * ------------------------------------------------------------------------------------------------ */

static void write_txdr(emu_periph *p, uint8_t byte)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);

    if ((s->isr & TXIS) == 0) {
        emu_misuse(p, "TXDR", "TXDR written while TXIS is not set");
    }
    s->txdr = byte;
    s->isr &= ~(uint32_t)(TXE | TXIS);
    emu_i2c_v2_feed(p);
}

/* Only TXE can be written: 1 throws away what is in TXDR. */
static void write_isr(emu_periph *p, uint32_t value)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);

    if ((value & ~(uint32_t)(TXE | TXIS)) != 0) {
        emu_misuse(p, "ISR", "read-only bits written: flags are cleared in ICR");
    }
    s->isr |= value & TXE;
}

static void write_timingr(emu_periph *p, uint32_t value)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);

    if ((s->cr1 & PE) != 0) {
        emu_misuse(p, "TIMINGR", "TIMINGR written while PE is set");
    }
    s->timingr = emu_reserved(p, "TIMINGR", value, 0xf0ffffffu);
}

static void write_timeoutr(emu_periph *p, uint32_t value)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);

    if ((s->timeoutr & value & 0x8000u) != 0 && ((s->timeoutr ^ value) & 0x1fffu) != 0) {
        emu_misuse(p, "TIMEOUTR", "TIMEOUTA changed while TIMOUTEN is set");
    }
    s->timeoutr = emu_reserved(p, "TIMEOUTR", value, 0x8fff9fffu);
}

static void reg_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    emu_i2c_v2 *s = emu_i2c_v2_of(p);

    (void)bytes;
    switch (offset) {
    case CR1:
        write_cr1(p, emu_reserved(p, "CR1", value, CR1_ALL));
        break;
    case CR2:
        write_cr2(p, emu_reserved(p, "CR2", value, CR2_ALL));
        break;
    case OAR1:
        s->oar1 = emu_reserved(p, "OAR1", value, 0x87ffu);
        break;
    case OAR2:
        s->oar2 = emu_reserved(p, "OAR2", value, 0x87feu);
        break;
    case TIMINGR:
        write_timingr(p, value);
        break;
    case TIMEOUTR:
        write_timeoutr(p, value);
        break;
    case ISR:
        write_isr(p, value);
        break;
    case ICR:
        s->isr &= ~emu_reserved(p, "ICR", value, 0x3f38u);
        break;
    case TXDR:
        write_txdr(p, (uint8_t)value);
        break;
    case RXDR:
    case PECR:
        emu_misuse(p, offset == RXDR ? "RXDR" : "PECR", "read-only register written");
        break;
    default:
        emu_misuse(p, "-", "no register at offset %02x", (unsigned)offset);
        break;
    }
    emu_i2c_v2_signals(p);
}

static void reset(emu_periph *p)
{
    *emu_i2c_v2_of(p) = (emu_i2c_v2){.isr = TXE, .disabled_at = EMU_NEVER};
    emu_i2c_v2_signals(p);
}

emu_periph *emu_i2c_v2_new(emu *e, const emu_instance *at)
{
    emu_periph *p = emu_periph_new(e, at, sizeof(emu_i2c_v2));

    if (p != NULL) {
        p->read = reg_read;
        p->write = reg_write;
        p->next = emu_i2c_v2_next;
        p->run = emu_i2c_v2_run;
        p->reset = reset;
    }
    return p;
}
