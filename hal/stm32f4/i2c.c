/* SPDX-License-Identifier: Apache-2.0 */
/*
 * I2C1 of the STM32F405, version 1 of the peripheral, as interrupt-driven master (RM0090 27.3.3, 27.6; the
 * method for reading that needs no deadline, and what ES0182 says of this peripheral).
 *
 * - 88 kHz: between 88 and 100 kHz the set-up time of a repeated START is too short (ES0182).
 * - A bus error in master mode may be reported without cause and harms nothing: cleared and ignored; a real
 * one ends as lost arbitration or by the limit of time (ES0182).
 * - While START or STOP is asked for, CR1 is not written.
 * - Reading one byte, and the last two: ACK and STOP are set while the clock is held by ADDR or BTF, with
 * interrupts off where a late STOP would read one byte too many.
 */
#include "stm32_chip.h"
#include "stm32_i2c.h"

typedef struct i2c_regs {
    volatile uint32_t cr1, cr2, oar1, oar2, dr, sr1, sr2, ccr, trise;
} i2c_regs;

#define I2C1 ((i2c_regs *)(uintptr_t)0x40005400u)
#define CR1_PE (1u << 0)
#define CR1_START (1u << 8)
#define CR1_STOP (1u << 9)
#define CR1_ACK (1u << 10)
#define CR1_POS (1u << 11)
#define CR1_SWRST (1u << 15)
#define CR2_FREQ (STM32_APB1_HZ / 1000000u)
#define CR2_ITERREN (1u << 8)
#define CR2_ITEVTEN (1u << 9)
#define CR2_ITBUFEN (1u << 10)
#define OAR1_ALWAYS (1u << 14) /* "kept at 1 by software" */
#define SR1_SB (1u << 0)
#define SR1_ADDR (1u << 1)
#define SR1_BTF (1u << 2)
#define SR1_RXNE (1u << 6)
#define SR1_TXE (1u << 7)
#define SR1_BERR (1u << 8)
#define SR1_ARLO (1u << 9)
#define SR1_AF (1u << 10)
#define SR1_OVR (1u << 11)
#define SR1_TIMEOUT (1u << 14)
#define SR1_ERRORS (SR1_BERR | SR1_ARLO | SR1_AF | SR1_OVR | SR1_TIMEOUT)
#define SR2_BUSY (1u << 1)
#define SPEED_HZ 88000u
#define TRISE (STM32_APB1_HZ / 1000000u + 1u) /* 1000 ns */

enum step {
    STEP_IDLE,
    STEP_START,   /* START asked for: SB */
    STEP_ADDRESS, /* address sent: ADDR */
    STEP_MOVE,    /* data: RXNE, TXE, BTF */
    STEP_STOP,    /* STOP asked for; poll goes on when it is over */
    STEP_BROKEN   /* poll resets the peripheral */
};

/* ---- the peripheral ---------------------------------------------------------------------------------------
 */

void stm32_i2c_off(void)
{
    I2C1->cr1 = CR1_SWRST;
    (void)I2C1->cr1;
    I2C1->cr1 = 0;
}

void stm32_i2c_on(void)
{
    stm32_i2c_off(); /* BUSY follows the lines while the peripheral is off, too */
    I2C1->cr2 = CR2_FREQ;
    I2C1->oar1 = OAR1_ALWAYS;
    I2C1->ccr = (STM32_APB1_HZ + 2u * SPEED_HZ - 1u) / (2u * SPEED_HZ);
    I2C1->trise = TRISE;
    I2C1->cr1 = CR1_PE;
}

void stm32_i2c_irqs_enable(void)
{
    stm32_irq_enable(STM32_IRQ_I2C1_EV, 0); /* the clock is held for most of its events, not for all */
    stm32_irq_enable(STM32_IRQ_I2C1_ER, 0);
}

static bool bus_free(const stm32_i2c *i2c)
{
    return stm32_i2c_lines_free(i2c) && (I2C1->sr2 & SR2_BUSY) == 0u;
}

/* The filter may have left BUSY set by a disturbance (ES0182). */
bool stm32_i2c_bus_free(const stm32_i2c *i2c)
{
    if (!bus_free(i2c)) {
        stm32_i2c_on();
    }
    return bus_free(i2c);
}

static void interrupts(uint32_t which)
{
    I2C1->cr2 = CR2_FREQ | which;
}

/* ---- the transaction
 * --------------------------------------------------------------------------------------- */

static bool wants_stop(const stm32_i2c *i2c)
{
    return i2c->segment == i2c->last || i2c->segment->stop_after;
}

static uint32_t left(const stm32_i2c *i2c)
{
    return (uint32_t)(i2c->end - i2c->at);
}

static void enter(stm32_i2c *i2c, const bq_i2c_segment *s)
{
    stm32_i2c_enter(i2c, s);
    i2c->step = STEP_START;
}

/* Asks for what follows the present segment. ACK and POS are off afterwards. */
static void ask(const stm32_i2c *i2c)
{
    I2C1->cr1 = CR1_PE | (wants_stop(i2c) ? CR1_STOP : CR1_START);
}

/* ask() was called and every byte of the segment has moved. */
static void close_segment(stm32_i2c *i2c)
{
    if (wants_stop(i2c)) {
        interrupts(0);
        i2c->step = STEP_STOP;
        stm32_time_event(i2c->time);
    } else {
        interrupts(CR2_ITERREN | CR2_ITEVTEN);
        enter(i2c, i2c->segment + 1);
    }
}

/* SB: START has been sent. Two bytes to read: NACK is decided one byte ahead (POS). */
static void send_address(stm32_i2c *i2c)
{
    const bq_i2c_segment *s = i2c->segment;
    uint32_t ack = s->read && s->len >= 2u ? CR1_ACK : 0u;
    uint32_t pos = s->read && s->len == 2u ? CR1_POS : 0u;
    I2C1->cr1 = CR1_PE | ack | pos;
    i2c->step = STEP_ADDRESS;
    I2C1->dr = (uint32_t)i2c->address7 << 1 | (s->read ? 1u : 0u);
}

/* ADDR, which reading SR1 (done) and SR2 clears; until then the clock is held. */
static void addressed(stm32_i2c *i2c)
{
    const bq_i2c_segment *s = i2c->segment;
    uint32_t mask;
    i2c->step = STEP_MOVE;
    if (!s->read) {
        (void)I2C1->sr2;
        if (s->len == 0u) {
            ask(i2c);
            close_segment(i2c);
        } else {
            interrupts(CR2_ITERREN | CR2_ITEVTEN | CR2_ITBUFEN);
        }
        return;
    }
    mask = stm32_lock();
    (void)I2C1->sr2;
    if (s->len == 1u) {
        ask(i2c);
    } else if (s->len == 2u) {
        I2C1->cr1 = CR1_PE | CR1_POS;
    }
    stm32_unlock(mask);
    interrupts(CR2_ITERREN | CR2_ITEVTEN | (s->len == 1u || s->len > 3u ? CR2_ITBUFEN : 0u));
}

static void take_byte(stm32_i2c *i2c)
{
    *i2c->at++ = (uint8_t)I2C1->dr;
}

/* The last three bytes are read with the clock held: BTF = one in DR, one behind it. */
static void read_end(stm32_i2c *i2c)
{
    uint32_t mask;
    if (left(i2c) == 3u) {
        I2C1->cr1 = CR1_PE; /* the last byte is answered by NACK */
        take_byte(i2c);
        return;
    }
    mask = stm32_lock();
    ask(i2c);
    take_byte(i2c);
    stm32_unlock(mask);
    take_byte(i2c);
    close_segment(i2c);
}

static void read_on(stm32_i2c *i2c, uint32_t sr1)
{
    if (i2c->segment->len == 1u) {
        if ((sr1 & SR1_RXNE) != 0u) {
            take_byte(i2c);
            close_segment(i2c);
        }
    } else if (left(i2c) > 3u) {
        if ((sr1 & SR1_RXNE) != 0u) {
            take_byte(i2c);
        }
        if (left(i2c) == 3u) {
            interrupts(CR2_ITERREN | CR2_ITEVTEN);
        }
    } else if ((sr1 & SR1_BTF) != 0u) {
        read_end(i2c);
    }
}

static void write_on(stm32_i2c *i2c, uint32_t sr1)
{
    if (left(i2c) > 0u) {
        if ((sr1 & SR1_TXE) != 0u) {
            I2C1->dr = *i2c->at++;
        }
        if (left(i2c) == 0u) {
            interrupts(CR2_ITERREN | CR2_ITEVTEN); /* BTF ends it; TXE alone would come at once */
        }
    } else if ((sr1 & SR1_BTF) != 0u) {
        ask(i2c);
        close_segment(i2c);
    }
}

/* Flags are cleared by writing 0; the others of this half of the register keep what they are when 1 is
 * written. */
static void clear(uint32_t flags)
{
    I2C1->sr1 = SR1_ERRORS & ~flags;
}

static void take_error(stm32_i2c *i2c, uint32_t errors)
{
    clear(errors);
    if ((errors & ~SR1_BERR) == 0u) {
        return;
    }
    interrupts(0);
    i2c->result = (errors & SR1_ARLO) != 0u ? BQ_E_ARBITRATION
                  : (errors & SR1_AF) != 0u ? BQ_E_NACK
                                            : BQ_E_BUS;
    if (i2c->result == BQ_E_NACK) {
        I2C1->cr1 = CR1_PE | CR1_STOP;
        i2c->step = STEP_STOP;
    } else {
        i2c->step = STEP_BROKEN;
    }
    stm32_time_event(i2c->time);
}

void stm32_i2c_irq(stm32_i2c *i2c)
{
    uint32_t sr1 = I2C1->sr1;
    if (!i2c->busy) {
        interrupts(0);
        clear(sr1 & SR1_ERRORS);
    } else if ((sr1 & SR1_ERRORS) != 0u) {
        take_error(i2c, sr1 & SR1_ERRORS);
    } else if (i2c->step == STEP_START && (sr1 & SR1_SB) != 0u) {
        send_address(i2c);
    } else if (i2c->step == STEP_ADDRESS && (sr1 & SR1_ADDR) != 0u) {
        addressed(i2c);
    } else if (i2c->step == STEP_MOVE && i2c->segment->read) {
        read_on(i2c, sr1);
    } else if (i2c->step == STEP_MOVE) {
        write_on(i2c, sr1);
    }
}

/* ---- from the main loop
 * ------------------------------------------------------------------------------------ */

void stm32_i2c_begin(stm32_i2c *i2c, const bq_i2c_segment *s)
{
    enter(i2c, s);
    I2C1->cr1 = CR1_PE | CR1_START;
    interrupts(CR2_ITERREN | CR2_ITEVTEN);
}

/* No interrupt tells that a STOP is over; it takes about 10 us. */
static void after_stop(stm32_i2c *i2c)
{
    if ((I2C1->cr1 & CR1_STOP) != 0u) {
        return;
    }
    if (i2c->result == BQ_OK && i2c->segment != i2c->last) {
        stm32_i2c_begin(i2c, i2c->segment + 1);
    } else {
        i2c->step = STEP_IDLE;
        i2c->busy = false;
    }
}

void stm32_i2c_look(stm32_i2c *i2c)
{
    if (i2c->step == STEP_BROKEN) {
        stm32_i2c_cut_off(i2c, i2c->result);
    } else if (i2c->step == STEP_STOP) {
        after_stop(i2c);
    }
}
