/* SPDX-License-Identifier: Apache-2.0 */
/* I2C of the STM32F4 (RM0090, chapter 27) as a master with 7-bit addresses: registers and their judge. irq:
 * event, error. Slave mode, SMBus and packet error checking are not there; using them is recorded. */
#include "emu_i2c_v1.h"

static void clear_addr(emu_periph *p)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);

    s->sr1 &= ~(uint32_t)ADDR;
    if (s->transmits) {
        s->sr1 |= TXE;
    } else {
        emu_i2c_v1_receive(p);
    }
}

static uint32_t read_sr2(emu_periph *p)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);
    uint32_t value = (s->master ? MSL | BUSY : 0u) | (s->master && s->transmits ? TRA : 0u);

    if ((s->cr1 & PE) != 0 && emu_i2c_held(p) != 0) {
        value |= BUSY;
    }
    if ((s->sr1 & ADDR) != 0) {
        if (s->sr1_read) {
            clear_addr(p);
        } else {
            emu_misuse(p, "SR2", "SR2 read before SR1 while ADDR is set: ADDR stays");
        }
    }
    return value;
}

static uint32_t read_dr(emu_periph *p)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);
    uint32_t value = s->dr;

    if ((s->sr1 & RXNE) == 0) {
        emu_misuse(p, "DR", "DR read while RXNE is not set");
        return value;
    }
    s->sr1 &= ~(uint32_t)(RXNE | BTF);
    if (s->shift_full) {
        emu_i2c_v1_into_dr(s);
        if (s->doing == NOTHING && s->master) {
            emu_i2c_v1_go_on_receiving(p);
        }
    }
    emu_i2c_v1_conditions(p);
    return value;
}

static uint32_t reg_read(emu_periph *p, uint32_t offset, unsigned bytes)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);
    uint32_t value = 0;

    (void)bytes;
    switch (offset) {
    case CR1:
        return s->cr1;
    case CR2:
        return s->cr2;
    case OAR1:
        return s->oar1;
    case OAR2:
        return s->oar2;
    case DR:
        value = read_dr(p);
        break;
    case SR1:
        s->sr1_read = true;
        return s->sr1;
    case SR2:
        value = read_sr2(p);
        break;
    case CCR:
        return s->ccr;
    case TRISE:
        return s->trise;
    default:
        emu_misuse(p, "-", "no register at offset %02x", (unsigned)offset);
        return 0;
    }
    emu_i2c_v1_signals(p);
    return value;
}

static void write_address(emu_periph *p, uint8_t byte)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);

    if (!s->sr1_read) {
        emu_misuse(p, "DR", "address written before SR1 was read: SB stays set");
        return;
    }
    s->sr1 &= ~(uint32_t)SB;
    emu_i2c_v1_send_address(p, byte);
}

static void write_data(emu_periph *p, uint8_t byte)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);

    if (s->dr_full) {
        emu_misuse(p, "DR", "DR written while TXE is not set: a byte is lost");
    }
    if (s->doing == SENDING) {
        s->dr = byte;
        s->dr_full = true;
        s->sr1 &= ~(uint32_t)TXE;
    } else {
        emu_i2c_v1_send(p, byte);
    }
}

static void write_dr(emu_periph *p, uint8_t byte)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);

    if ((s->sr1 & SB) != 0) {
        write_address(p, byte);
    } else if ((s->sr1 & ADDR) != 0) {
        emu_misuse(p, "DR", "DR written while ADDR is set");
    } else if (!s->master || s->doing == STARTING || s->doing == ADDRESSING) {
        emu_misuse(p, "DR", "DR written before SB");
    } else if (!s->transmits || s->refused) {
        emu_misuse(p, "DR", s->refused ? "DR written after NACK" : "DR written while receiving");
    } else {
        write_data(p, byte);
    }
}

static void reset_core(emu_periph *p)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);

    emu_i2c_v1_release(s);
    s->sr1 = 0;
    s->shift_full = s->sr1_read = false;
    s->cr1 &= ~(uint32_t)(START | STOP);
}

static void judge_cr1(emu_periph *p, uint32_t value)
{
    const emu_i2c_v1 *s = emu_i2c_v1_of(p);
    bool ends = (value & SWRST) != 0 || (value & PE) == 0;

    if ((value & CR1_ALL & ~(uint32_t)CR1_MODELLED) != 0) {
        emu_misuse(p, "CR1", "SMBus, PEC, general call or NOSTRETCH: not modelled");
    }
    if ((s->cr1 & (START | STOP)) != 0 && !ends) {
        emu_misuse(p, "CR1", "CR1 written while %s waits to be carried out",
                   (s->cr1 & START) != 0 ? "START" : "STOP");
    }
    if ((s->cr1 & PE) != 0 && (value & (PE | SWRST)) == 0 && s->doing != NOTHING && emu_i2c_held(p) == 0) {
        emu_misuse(p, "CR1", "PE cleared before the end of the communication");
    }
    if ((value & PE) == 0 && (value & (START | STOP)) != 0) {
        emu_misuse(p, "CR1", "START or STOP while PE is not set");
    }
    if ((value & START) != 0 && (s->sr1 & (SB | ADDR)) != 0) {
        emu_misuse(p, "CR1", "START while %s is set", (s->sr1 & SB) != 0 ? "SB" : "ADDR");
    }
    if ((value & STOP & ~s->cr1) != 0 && (value & PE) != 0 && !s->master) {
        emu_misuse(p, "CR1", "STOP while not master");
    }
}

static void write_cr1(emu_periph *p, uint32_t value)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);
    uint32_t waits = s->cr1 & (START | STOP);

    judge_cr1(p, value);
    if ((value & SWRST) != 0) {
        uint32_t cr1 = value & SWRST;

        reset_core(p);
        s->cr2 = s->oar1 = s->oar2 = s->ccr = 0;
        s->trise = 2;
        s->cr1 = cr1;
        return;
    }
    s->cr1 = (value & CR1_ALL) | waits;
    if ((value & PE) == 0) {
        reset_core(p);
        return;
    }
    if (!s->master) {
        s->cr1 &= ~(uint32_t)STOP;
    }
    emu_i2c_v1_conditions(p);
}

static void write_sr1(emu_periph *p, uint32_t value)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);

    s->sr1 &= value | ~(uint32_t)SR1_ERRORS;
}

static void write_timing(emu_periph *p, uint32_t *reg, const char *name, uint32_t value, uint32_t allowed)
{
    if ((emu_i2c_v1_of(p)->cr1 & PE) != 0) {
        emu_misuse(p, name, "%s written while PE is set", name);
    }
    *reg = emu_reserved(p, name, value, allowed);
}

static void reg_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);

    (void)bytes;
    value &= 0xffffu;
    if ((s->cr1 & SWRST) != 0 && offset != CR1) {
        emu_misuse(p, "CR1", "register written while SWRST holds the peripheral in reset");
        return;
    }
    switch (offset) {
    case CR1:
        write_cr1(p, emu_reserved(p, "CR1", value, CR1_ALL));
        break;
    case CR2:
        s->cr2 = emu_reserved(p, "CR2", value, CR2_ALL);
        break;
    case OAR1:
        s->oar1 = emu_reserved(p, "OAR1", value, 0xc3ffu);
        break;
    case OAR2:
        s->oar2 = emu_reserved(p, "OAR2", value, 0x00ffu);
        break;
    case DR:
        write_dr(p, (uint8_t)value);
        break;
    case SR1:
        write_sr1(p, value);
        break;
    case CCR:
        write_timing(p, &s->ccr, "CCR", value, 0xcfffu);
        break;
    case TRISE:
        write_timing(p, &s->trise, "TRISE", value, 0x3fu);
        break;
    case SR2:
        emu_misuse(p, "SR2", "read-only register written");
        break;
    default:
        emu_misuse(p, "-", "no register at offset %02x", (unsigned)offset);
        break;
    }
    emu_i2c_v1_signals(p);
}

static void reset(emu_periph *p)
{
    emu_i2c_v1 *s = emu_i2c_v1_of(p);

    *s = (emu_i2c_v1){.trise = 2};
    emu_i2c_v1_signals(p);
}

emu_periph *emu_i2c_v1_new(emu *e, const emu_instance *at)
{
    emu_periph *p = emu_periph_new(e, at, sizeof(emu_i2c_v1));

    if (p != NULL) {
        p->read = reg_read;
        p->write = reg_write;
        p->next = emu_i2c_v1_next;
        p->run = emu_i2c_v1_run;
        p->reset = reset;
    }
    return p;
}
