/* SPDX-License-Identifier: Apache-2.0 */
/* bq_i2c above both generations of the peripheral. */
#include "stm32_i2c.h"
#include "stm32_chip.h"

void stm32_i2c_init(stm32_i2c *i2c, stm32_time *time, unsigned port, unsigned scl, unsigned sda)
{
    *i2c = (stm32_i2c){.time = time, .port = (uint8_t)port, .scl = (uint8_t)scl, .sda = (uint8_t)sda};
    stm32_apb1_enable(STM32_APB1_I2C1);
    stm32_i2c_off();
    stm32_i2c_on();
    stm32_i2c_irqs_enable();
}

void stm32_i2c_enter(stm32_i2c *i2c, const bq_i2c_segment *s)
{
    i2c->segment = s;
    i2c->at = s->data;
    i2c->end = s->data + s->len;
}

void stm32_i2c_cut_off(stm32_i2c *i2c, bq_status why)
{
    uint32_t mask = stm32_lock();
    i2c->result = why;
    i2c->step = 0;
    stm32_i2c_off();
    stm32_i2c_on();
    i2c->busy = false;
    stm32_unlock(mask);
    stm32_time_event(i2c->time);
}

static bq_status i2c_start(void *ctx, uint8_t address7, const bq_i2c_segment *segments, size_t count)
{
    stm32_i2c *i2c = ctx;
    if (!stm32_i2c_legal(address7, segments, count)) {
        return BQ_E_ARG;
    }
    if (i2c->busy || i2c->owed) {
        return BQ_E_BUSY;
    }
    if (!stm32_i2c_bus_free(i2c)) {
        return BQ_E_ARBITRATION;
    }
    i2c->address7 = address7;
    i2c->last = segments + count - 1u;
    i2c->result = BQ_OK;
    i2c->limit_us = stm32_i2c_limit_us(segments, count);
    i2c->from_us = stm32_now_us();
    i2c->owed = true;
    i2c->busy = true;
    stm32_i2c_begin(i2c, segments);
    return BQ_OK;
}

static bq_status i2c_poll(void *ctx)
{
    stm32_i2c *i2c = ctx;
    uint32_t mask;
    stm32_i2c_look(i2c);
    mask = stm32_lock(); /* or it may end between the question and the cut */
    if (i2c->busy && stm32_now_us() - i2c->from_us > i2c->limit_us) {
        stm32_i2c_cut_off(i2c, BQ_E_TIMEOUT);
    }
    stm32_unlock(mask);
    if (i2c->busy) {
        return BQ_PENDING;
    }
    if (!i2c->owed) {
        return BQ_OK;
    }
    i2c->owed = false;
    return i2c->result;
}

static bq_status i2c_recover(void *ctx)
{
    stm32_i2c *i2c = ctx;
    bq_status st;
    if (i2c->busy) {
        stm32_i2c_cut_off(i2c, BQ_E_BUS);
    }
    stm32_i2c_off();
    st = stm32_i2c_free_lines(i2c);
    stm32_i2c_on();
    return st;
}

bq_i2c stm32_i2c_bus(stm32_i2c *i2c)
{
    static const bq_i2c_ops ops = {i2c_start, i2c_poll, i2c_recover};
    bq_i2c bus = {&ops, i2c};
    return bus;
}
