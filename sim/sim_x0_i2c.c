/* SPDX-License-Identifier: Apache-2.0 */
/* I2C slave of the bq769x0 model, byte by byte and line by line (X0-I2C). */
#include "sim_x0_internal.h"

enum { IDLE, ADDRESS, POINTER, DATA, DATA_CRC, SEND, DEAF };

static uint8_t crc8(uint8_t crc, uint8_t byte)
{
    crc ^= byte;
    for (int i = 0; i < 8; i++) {
        crc = (uint8_t)((crc & 0x80u) != 0 ? (unsigned)(crc << 1) ^ 0x07u : (unsigned)crc << 1);
    }
    return crc;
}

int sim_x0_flip_sda(sim_x0 *s, int bit)
{
    if (bit < 0) {
        return -1;
    }
    s->i2c.flip_bit = bit + 1;
    return 0;
}

static void damage(sim_x0 *s)
{
    s->bus.flips++;
    s->i2c.damaged = true;
    s->stat_seen = 0xff; /* what the host believes to have read is unknown now */
}

/* Counts the byte's bits and returns it as the other side sees it. */
static uint8_t on_the_wire(sim_x0 *s, uint8_t byte)
{
    sim_x0_i2c *c = &s->i2c;
    int offset = c->flip_bit - 1 - c->bit_count;
    c->bit_count += 8;
    s->bus.bytes++;
    if (c->flip_bit != 0 && offset >= 0 && offset < 8) {
        c->flip_bit = 0;
        damage(s);
        byte = (uint8_t)(byte ^ (0x80u >> offset));
    }
    for (unsigned bit = 0; s->bus.flip_probability > 0.0 && bit < 8u; bit++) {
        if (x0_uniform(s) < s->bus.flip_probability) {
            damage(s);
            byte = (uint8_t)(byte ^ (1u << bit));
        }
    }
    return byte;
}

/* How the wires read whatever is sent: 0 = alive, 1 = low, 2 = high. */
static int dead(const sim_x0 *s)
{
    return s->bus.dead != 0 ? s->bus.dead : s->bus.stuck_clocks != 0;
}

sim_x0_bus_fault *sim_x0_bus(sim_x0 *s)
{
    return &s->bus;
}

bool sim_x0_sda_free(const sim_x0 *s)
{
    return s->bus.stuck_clocks == 0 && s->bus.dead != 1;
}

void sim_x0_recovery_clock(sim_x0 *s)
{
    if (s->bus.stuck_clocks > 0) {
        s->bus.stuck_clocks--;
    }
}

static bool answers(const sim_x0 *s)
{
    return s->mode == SIM_X0_NORMAL || (s->mode == SIM_X0_BOOT && s->now >= s->t_i2c);
}

void x0_bus_start(sim_x0 *s)
{
    sim_x0_i2c *c = &s->i2c;
    if (!c->in_transaction) {
        c->in_transaction = true;
        c->bit_count = 0;
        c->damaged = false;
    }
    c->state = ADDRESS;
    c->low_frozen = false;
    c->crc_next = false;
}

void x0_bus_stop(sim_x0 *s)
{
    sim_x0_i2c *c = &s->i2c;
    if (c->in_transaction && c->flip_bit != 0) {
        c->flip_bit = 0; /* the transaction was shorter than that */
    }
    c->state = IDLE;
    c->in_transaction = false;
    c->low_frozen = false;
    if (s->options.amb83_pointer_lost) {
        c->pointer = 0;
    }
}

static bool take_address(sim_x0 *s, uint8_t byte)
{
    sim_x0_i2c *c = &s->i2c;
    if (!answers(s) || (byte >> 1) != s->part->address7) {
        c->state = DEAF;
        return false;
    }
    c->crc = crc8(0, byte);
    c->state = (byte & 1u) != 0 ? SEND : POINTER;
    return true;
}

static bool take_byte(sim_x0 *s, uint8_t byte)
{
    sim_x0_i2c *c = &s->i2c;
    if (!x0_write(s, c->pointer++, byte)) {
        c->state = DEAF;
        return false;
    }
    return true;
}

static bool take_crc(sim_x0 *s, uint8_t byte)
{
    sim_x0_i2c *c = &s->i2c;
    if (byte != c->crc) { /* X0-I2C-17 */
        c->state = DEAF;
        return false;
    }
    c->crc = 0; /* X0-I2C-13 */
    c->state = DATA;
    return take_byte(s, c->data);
}

static bool take_data(sim_x0 *s, uint8_t byte)
{
    sim_x0_i2c *c = &s->i2c;
    if (s->part->crc) {
        c->data = byte;
        c->crc = crc8(c->crc, byte);
        c->state = DATA_CRC;
        return true;
    }
    return take_byte(s, byte);
}

bool x0_bus_write(sim_x0 *s, uint8_t byte)
{
    sim_x0_i2c *c = &s->i2c;
    uint8_t seen = on_the_wire(s, byte);
    if (dead(s) != 0) {
        return dead(s) == 1;
    }
    if (s->bus.nack_bytes > 0) {
        s->bus.nack_bytes--;
        c->state = DEAF;
        return false;
    }
    switch (c->state) {
    case ADDRESS:
        return take_address(s, seen);
    case POINTER:
        c->pointer = seen;
        c->crc = crc8(c->crc, seen);
        c->state = DATA;
        return answers(s);
    case DATA:
        return answers(s) && take_data(s, seen);
    case DATA_CRC:
        return answers(s) && take_crc(s, seen);
    default:
        return false;
    }
}

/* The next register byte; a high byte freezes its low half (X0-AMB-19). */
static uint8_t fetch(sim_x0 *s)
{
    sim_x0_i2c *c = &s->i2c;
    uint8_t reg = c->pointer++, value;
    bool paired = c->low_frozen && c->low_pointer == reg;
    x0_judge_read(s, reg, paired);
    value = paired ? c->low : x0_read(s, reg);
    c->low_frozen = reg >= X0_VC1_HI && reg <= X0_CC_HI && (reg & 1u) == 0;
    if (c->low_frozen) {
        c->low_pointer = (uint8_t)(reg + 1u);
        c->low = sim_x0_peek(s, c->low_pointer);
    }
    return value;
}

static uint8_t next_sent(sim_x0 *s)
{
    sim_x0_i2c *c = &s->i2c;
    uint8_t byte;
    if (c->crc_next) {
        byte = c->crc;
        c->crc = 0; /* X0-I2C-15 */
        c->crc_next = false;
        return byte;
    }
    byte = fetch(s);
    if (s->part->crc) {
        c->crc = crc8(c->crc, byte);
        c->crc_next = true;
    }
    return byte;
}

uint8_t x0_bus_read(sim_x0 *s, bool ack)
{
    sim_x0_i2c *c = &s->i2c;
    uint8_t byte = 0xff;
    if (dead(s) != 0) {
        s->bus.bytes++;
        s->stat_seen = 0xff; /* the host may have taken it for SYS_STAT */
        return dead(s) == 1 ? 0x00 : 0xff;
    }
    if (c->state == SEND && answers(s)) {
        byte = next_sent(s);
        if (!ack) {
            c->state = DEAF;
        }
    }
    return on_the_wire(s, byte);
}

/* ---- the public door: with a trace in the waveform ---- */

void sim_x0_i2c_start(sim_x0 *s)
{
    x0_record_start(s);
    x0_bus_start(s);
}

bool sim_x0_i2c_write(sim_x0 *s, uint8_t byte)
{
    bool ack = x0_bus_write(s, byte);
    x0_record_byte(s, byte, ack);
    return ack;
}

uint8_t sim_x0_i2c_read(sim_x0 *s, bool ack)
{
    uint8_t byte = x0_bus_read(s, ack);
    x0_record_byte(s, byte, ack);
    return byte;
}

void sim_x0_i2c_stop(sim_x0 *s)
{
    x0_bus_stop(s);
    x0_record_stop(s);
}

/* ---- line levels ---- */

static void rising_clock(sim_x0 *s, bool sda)
{
    sim_x0_i2c *c = &s->i2c;
    if (c->ack_phase) {
        c->host_nack = sda;
        return;
    }
    c->shift = (uint8_t)((unsigned)c->shift << 1 | (sda ? 1u : 0u));
    c->bits++;
}

/* After the falling clock edge the device sets SDA for the next bit. */
static void falling_clock(sim_x0 *s)
{
    sim_x0_i2c *c = &s->i2c;
    bool sending = c->selected_read;
    if (c->ack_phase) {
        c->ack_phase = false;
        c->drive_low = false;
        c->bits = 0;
        if (sending && c->host_nack) {
            c->selected_read = false;
            c->state = DEAF;
        } else if (c->state == SEND) {
            c->selected_read = true;
            c->shift = on_the_wire(s, next_sent(s));
            c->data = c->shift;
        }
    } else if (c->bits == 8) {
        c->ack_phase = true;
        c->drive_low = !sending && x0_bus_write(s, c->shift);
        return;
    }
    if (c->selected_read && !c->ack_phase) {
        c->drive_low = (((unsigned)c->data >> (7 - c->bits)) & 1u) == 0;
    }
}

bool sim_x0_lines(sim_x0 *s, bool scl, bool sda)
{
    sim_x0_i2c *c = &s->i2c;
    if (c->scl && scl && c->sda != sda && !c->drive_low) {
        if (!sda) {
            x0_bus_start(s);
            c->active = true;
        } else {
            x0_bus_stop(s);
            c->active = false;
        }
        c->bits = 0;
        c->ack_phase = c->selected_read = c->drive_low = false;
    } else if (c->active && !c->scl && scl) {
        rising_clock(s, sda && !c->drive_low);
    } else if (c->active && c->scl && !scl && (c->bits != 0 || c->ack_phase)) {
        falling_clock(s);
    }
    if (!c->scl && scl) {
        sim_x0_recovery_clock(s);
    }
    c->scl = scl;
    c->sda = sda;
    x0_record_lines(s, scl, sda && !c->drive_low && dead(s) != 1);
    return sda && !c->drive_low && dead(s) != 1;
}
