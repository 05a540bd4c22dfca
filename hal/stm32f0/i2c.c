/* SPDX-License-Identifier: Apache-2.0 */
/* I2C1 of the STM32F072, version 2 of the peripheral, as interrupt-driven master (RM0091 26.4.8). */
#include "stm32_chip.h"
#include "stm32_i2c.h"
#include "stm32f0_i2c_timing.h"
#include "stm32f0_regs.h"

#define INTERRUPTS                                                                                           \
    (STM32_I2C_CR1_TXIE | STM32_I2C_CR1_RXIE | STM32_I2C_CR1_NACKIE | STM32_I2C_CR1_STOPIE |                 \
     STM32_I2C_CR1_TCIE | STM32_I2C_CR1_ERRIE)
#define ENDS (STM32_I2C_ISR_NACKF | STM32_I2C_ISR_TCR | STM32_I2C_ISR_TC | STM32_I2C_ISR_STOPF)
#define CHUNK (0xffu << STM32_I2C_CR2_NBYTES_SHIFT | STM32_I2C_CR2_RELOAD | STM32_I2C_CR2_AUTOEND)

/* PE low for three cycles of APB and more resets the state machine and releases the lines. */
void stm32_i2c_off(void)
{
    STM32_I2C1->cr1 = 0;
    for (int i = 0; i < 3; i++) {
        (void)STM32_I2C1->cr1;
    }
}

void stm32_i2c_on(void)
{
    STM32_RCC_CFGR3 &= ~STM32_RCC_CFGR3_I2C1SW;
    STM32_I2C1->timingr = STM32_I2C_TIMINGR;
    STM32_I2C1->cr1 = STM32_I2C_CR1_PE; /* the analog filter is on after reset */
}

void stm32_i2c_irqs_enable(void)
{
    stm32_irq_enable(STM32_IRQ_I2C1, 1);
}

bool stm32_i2c_bus_free(const stm32_i2c *i2c)
{
    return (STM32_I2C1->isr & STM32_I2C_ISR_BUSY) == 0u && stm32_i2c_lines_free(i2c);
}

/* ---- the transaction
 * ------------------------------------------------------------------------------------------ */

/* Count and ending of the next at most 255 bytes. Without AUTOEND the bus is held after them (TC) for a
 * repeated START. */
static uint32_t chunk(const stm32_i2c *i2c)
{
    uint32_t left = (uint32_t)(i2c->end - i2c->at);
    if (left > 255u) {
        return 255u << STM32_I2C_CR2_NBYTES_SHIFT | STM32_I2C_CR2_RELOAD;
    }
    return left << STM32_I2C_CR2_NBYTES_SHIFT |
           (i2c->segment->stop_after || i2c->segment == i2c->last ? STM32_I2C_CR2_AUTOEND : 0u);
}

static void begin_segment(stm32_i2c *i2c, const bq_i2c_segment *s)
{
    stm32_i2c_enter(i2c, s);
    STM32_I2C1->cr2 = (uint32_t)i2c->address7 << STM32_I2C_CR2_SADD7_SHIFT |
                      (s->read ? STM32_I2C_CR2_RD_WRN : 0u) | chunk(i2c) | STM32_I2C_CR2_START;
}

void stm32_i2c_begin(stm32_i2c *i2c, const bq_i2c_segment *s)
{
    STM32_I2C1->cr1 = STM32_I2C_CR1_PE | INTERRUPTS;
    begin_segment(i2c, s);
}

void stm32_i2c_look(stm32_i2c *i2c)
{
    (void)i2c; /* the interrupts do everything */
}

static void end(stm32_i2c *i2c)
{
    STM32_I2C1->cr1 = STM32_I2C_CR1_PE;
    i2c->busy = false;
    stm32_time_event(i2c->time);
}

static void move_byte(stm32_i2c *i2c, uint32_t isr)
{
    bool more = i2c->at != i2c->end;
    if ((isr & STM32_I2C_ISR_RXNE) != 0u) {
        uint8_t byte = (uint8_t)STM32_I2C1->rxdr;
        if (more) {
            *i2c->at++ = byte;
        }
    } else if ((isr & STM32_I2C_ISR_TXIS) != 0u) {
        STM32_I2C1->txdr = more ? *i2c->at++ : 0xffu;
    }
}

/* After a NACK the master sends STOP by itself, with and without AUTOEND; TXDR may hold a byte that nobody
 * wants. */
static void take_nack(stm32_i2c *i2c)
{
    STM32_I2C1->icr = STM32_I2C_ISR_NACKF;
    STM32_I2C1->isr = STM32_I2C_ISR_TXE;
    i2c->result = BQ_E_NACK;
}

static void take_stop(stm32_i2c *i2c)
{
    STM32_I2C1->icr = STM32_I2C_ISR_STOPF;
    if (i2c->result == BQ_OK && i2c->segment != i2c->last) {
        begin_segment(i2c, i2c->segment + 1);
    } else {
        end(i2c);
    }
}

void stm32_i2c_irq(stm32_i2c *i2c)
{
    uint32_t isr = STM32_I2C1->isr;
    if (!i2c->busy) {
        STM32_I2C1->cr1 = STM32_I2C_CR1_PE;
        return;
    }
    if ((isr & (STM32_I2C_ISR_ARLO | STM32_I2C_ISR_BERR)) != 0u) {
        stm32_i2c_cut_off(i2c, (isr & STM32_I2C_ISR_ARLO) != 0u ? BQ_E_ARBITRATION : BQ_E_BUS);
        return;
    }
    move_byte(i2c, isr);
    if ((isr & ENDS) == 0u) {
        return; /* nearly always: this costs a main loop that sleeps most */
    }
    if ((isr & STM32_I2C_ISR_NACKF) != 0u) {
        take_nack(i2c);
    } else if ((isr & STM32_I2C_ISR_TCR) != 0u) {
        STM32_I2C1->cr2 = (STM32_I2C1->cr2 & ~CHUNK) | chunk(i2c);
    } else if ((isr & STM32_I2C_ISR_TC) != 0u) {
        begin_segment(i2c, i2c->segment + 1);
    }
    if ((isr & STM32_I2C_ISR_STOPF) != 0u) {
        take_stop(i2c);
    }
}
