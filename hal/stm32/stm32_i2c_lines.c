/* SPDX-License-Identifier: Apache-2.0 */
/* The two lines of the I2C bus, by hand: whether they are free, and how to free them. */
#include "stm32_core.h"
#include "stm32_gpio.h"
#include "stm32_i2c.h"

#define HALF_BIT_US 5u   /* X0-SEQ-52 */
#define RECOVERY_US 160u /* after this no further clock begins */

static bool high(const stm32_i2c *i2c, unsigned pin)
{
    return (stm32_port(i2c->port)->idr >> pin & 1u) != 0u;
}

bool stm32_i2c_lines_free(const stm32_i2c *i2c)
{
    return high(i2c, i2c->scl) && high(i2c, i2c->sda);
}

/* Edges stand on a grid of half bits, whatever the code in between takes; `*edge` is the last one. */
static void hold(uint32_t *edge)
{
    while (stm32_now_us() - *edge < HALF_BIT_US) {
    }
    *edge += HALF_BIT_US;
}

static void drive(const stm32_i2c *i2c, unsigned pin, bool level, uint32_t *edge)
{
    stm32_pin_write(i2c->port, pin, level);
    hold(edge);
}

static void set_mode(const stm32_i2c *i2c, uint32_t mode)
{
    stm32_gpio_regs *port = stm32_port(i2c->port);
    uint32_t mask = 3u << 2u * i2c->scl | 3u << 2u * i2c->sda;
    uint32_t value = mode << 2u * i2c->scl | mode << 2u * i2c->sda;
    uint32_t lock = stm32_lock();
    port->moder = (port->moder & ~mask) | value;
    stm32_unlock(lock);
}

static bool in_time(uint32_t from)
{
    return stm32_now_us() - from < RECOVERY_US;
}

/* SCL released; a slave may hold it, which costs time of the whole budget only. */
static bool release_scl(const stm32_i2c *i2c, uint32_t from, uint32_t *edge)
{
    stm32_pin_write(i2c->port, i2c->scl, true);
    while (!high(i2c, i2c->scl) && in_time(from)) {
        *edge = stm32_now_us();
    }
    hold(edge);
    return high(i2c, i2c->scl);
}

/* The lines stay open drain; both are released before they become outputs, so nothing is driven by accident.
 */
bq_status stm32_i2c_free_lines(const stm32_i2c *i2c)
{
    uint32_t from = stm32_now_us(), edge = from;
    bool clocked;
    stm32_pin_write(i2c->port, i2c->scl, true);
    stm32_pin_write(i2c->port, i2c->sda, true);
    set_mode(i2c, 1u);
    clocked = release_scl(i2c, from, &edge);
    for (unsigned n = 0; n < 9u && clocked && !high(i2c, i2c->sda) && in_time(from); n++) {
        drive(i2c, i2c->scl, false, &edge);
        clocked = release_scl(i2c, from, &edge);
    }
    if (clocked) { /* STOP: SDA rises while SCL is high */
        drive(i2c, i2c->scl, false, &edge);
        drive(i2c, i2c->sda, false, &edge);
        drive(i2c, i2c->scl, true, &edge);
        drive(i2c, i2c->sda, true, &edge);
    }
    set_mode(i2c, 2u);
    return stm32_i2c_lines_free(i2c) ? BQ_OK : BQ_E_ARBITRATION;
}
