/* SPDX-License-Identifier: Apache-2.0 */
#include "stm32_gpio.h"
#include "stm32_chip.h"

stm32_gpio_regs *stm32_port(unsigned port)
{
    return (stm32_gpio_regs *)(STM32_GPIO_BASE + 0x400u * port);
}

/* One field of `bits` bits for pin `pin`. */
static void field(volatile uint32_t *reg, unsigned pin, unsigned bits, uint32_t value)
{
    uint32_t mask = ((1u << bits) - 1u) << (pin * bits);
    *reg = (*reg & ~mask) | value << (pin * bits);
}

static void clock_ports(const stm32_pins *pins)
{
    uint32_t ports = 0;
    for (unsigned i = 0; i < pins->count; i++) {
        ports |= 1u << (pins->pin[i].port + STM32_GPIOEN_SHIFT);
    }
    STM32_RCC_GPIOENR |= ports;
    (void)STM32_RCC_GPIOENR; /* two cycles until the clock is there */
}

static void route_exti(const stm32_pin *p)
{
    stm32_exti_regs *exti = STM32_EXTI;
    volatile uint32_t *route = &STM32_SYSCFG_EXTICR(p->pin >> 2);
    field(route, p->pin & 3u, 4, p->port);
    if ((p->edge & STM32_EDGE_RISING) != 0u) {
        exti->rtsr |= 1u << p->pin;
    }
    if ((p->edge & STM32_EDGE_FALLING) != 0u) {
        exti->ftsr |= 1u << p->pin;
    }
    exti->pr = 1u << p->pin;
    exti->imr |= 1u << p->pin;
}

static void init_pin(const stm32_pin *p)
{
    static const uint8_t moder[] = {0, 1, 2, 2, 3};
    stm32_gpio_regs *port = stm32_port(p->port);
    stm32_pin_write(p->port, p->pin, p->initial != 0u);
    field(&port->otyper, p->pin, 1, p->mode == STM32_PIN_AF_OD ? 1u : 0u);
    field(&port->pupdr, p->pin, 2, p->pull);
    field(&port->afr[p->pin >> 3], p->pin & 7u, 4, p->af);
    field(&port->moder, p->pin, 2, moder[p->mode]);
    if (p->edge != STM32_EDGE_NONE) {
        route_exti(p);
    }
}

void stm32_pins_safe(const stm32_pins *pins)
{
    clock_ports(pins);
    for (unsigned i = 0; i < pins->count; i++) {
        if (pins->pin[i].mode == STM32_PIN_OUTPUT) {
            init_pin(&pins->pin[i]);
        }
    }
}

void stm32_pins_init(const stm32_pins *pins)
{
    clock_ports(pins);
    STM32_RCC_APB2ENR |= STM32_APB2_SYSCFG;
    (void)STM32_RCC_APB2ENR;
    for (unsigned i = 0; i < pins->count; i++) {
        init_pin(&pins->pin[i]);
    }
}

uint32_t stm32_exti_take(uint32_t mask)
{
    uint32_t pending = STM32_EXTI->pr & mask;
    STM32_EXTI->pr = pending;
    return pending;
}

/* ---- lines
 * --------------------------------------------------------------------------------------------------- */

static const stm32_pin *find(const stm32_pins *pins, bq_line line)
{
    for (unsigned i = 0; i < pins->count; i++) {
        if (pins->pin[i].line == (unsigned)line) {
            return &pins->pin[i];
        }
    }
    return NULL;
}

static bq_status line_read(void *ctx, bq_line line, bool *level)
{
    const stm32_pin *p;
    if ((unsigned)line >= (unsigned)BQ_LINE_COUNT || level == NULL) {
        return BQ_E_ARG;
    }
    p = find(ctx, line);
    if (p == NULL) {
        return BQ_E_UNSUPPORTED;
    }
    *level = (stm32_port(p->port)->idr >> p->pin & 1u) != 0u;
    return BQ_OK;
}

static bq_status line_write(void *ctx, bq_line line, bool level)
{
    const stm32_pin *p;
    if ((unsigned)line >= (unsigned)BQ_LINE_COUNT) {
        return BQ_E_ARG;
    }
    p = find(ctx, line);
    if (p == NULL || p->mode != STM32_PIN_OUTPUT) {
        return BQ_E_UNSUPPORTED;
    }
    stm32_pin_write(p->port, p->pin, level);
    return BQ_OK;
}

bq_gpio stm32_gpio(const stm32_pins *pins)
{
    static const bq_gpio_ops ops = {line_read, line_write};
    bq_gpio gpio = {&ops, (void *)(uintptr_t)pins};
    return gpio;
}
