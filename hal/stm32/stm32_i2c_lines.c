/* SPDX-License-Identifier: Apache-2.0 */
/* The two lines of the I2C bus, by hand: whether they are free, and how to free them. */
#include "stm32_core.h"
#include "stm32_gpio.h"
#include "stm32_i2c.h"

#define HALF_BIT_US 4u   /* stm32_wait_us() waits up to one more: 100 kHz */
#define RECOVERY_US 160u /* after this no further clock begins */

static bool high(const stm32_i2c *i2c, unsigned pin)
{
    return (stm32_port(i2c->port)->idr >> pin & 1u) != 0u;
}

bool stm32_i2c_lines_free(const stm32_i2c *i2c)
{
    return high(i2c, i2c->scl) && high(i2c, i2c->sda);
}

static void drive(const stm32_i2c *i2c, unsigned pin, bool level)
{
    stm32_pin_write(i2c->port, pin, level);
    stm32_wait_us(HALF_BIT_US);
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
static bool release_scl(const stm32_i2c *i2c, uint32_t from)
{
    drive(i2c, i2c->scl, true);
    while (!high(i2c, i2c->scl) && in_time(from)) {
    }
    return high(i2c, i2c->scl);
}

/* The lines stay open drain; both are released before they become outputs, so nothing is driven by accident.
 */
bq_status stm32_i2c_free_lines(const stm32_i2c *i2c)
{
    uint32_t from = stm32_now_us();
    bool clocked;
    stm32_pin_write(i2c->port, i2c->scl, true);
    stm32_pin_write(i2c->port, i2c->sda, true);
    set_mode(i2c, 1u);
    clocked = release_scl(i2c, from);
    for (unsigned n = 0; n < 9u && clocked && !high(i2c, i2c->sda) && in_time(from); n++) {
        drive(i2c, i2c->scl, false);
        clocked = release_scl(i2c, from);
    }
    if (clocked) { /* STOP: SDA rises while SCL is high */
        drive(i2c, i2c->scl, false);
        drive(i2c, i2c->sda, false);
        drive(i2c, i2c->scl, true);
        drive(i2c, i2c->sda, true);
    }
    set_mode(i2c, 2u);
    return stm32_i2c_lines_free(i2c) ? BQ_OK : BQ_E_ARBITRATION;
}
