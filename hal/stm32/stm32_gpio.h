/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32_gpio.h
 * The pins of a board as one table that can be read beside its circuit diagram, and the lines of bqhost/hal.h
 * made of it.
 */
#ifndef STM32_GPIO_H
#define STM32_GPIO_H

#include "bqhost/hal.h"
#include "stm32_regs.h"

enum { STM32_PORT_A, STM32_PORT_B, STM32_PORT_C, STM32_PORT_D, STM32_PORT_E, STM32_PORT_F };
typedef enum stm32_pin_mode {
    STM32_PIN_INPUT,
    STM32_PIN_OUTPUT, /**< push-pull */
    STM32_PIN_AF,     /**< alternate function, push-pull */
    STM32_PIN_AF_OD,  /**< alternate function, open drain */
    STM32_PIN_ANALOG
} stm32_pin_mode;
enum { STM32_PULL_NONE, STM32_PULL_UP, STM32_PULL_DOWN };
enum { STM32_EDGE_NONE = 0, STM32_EDGE_RISING = 1, STM32_EDGE_FALLING = 2, STM32_EDGE_BOTH = 3 };

#define STM32_NO_LINE 0xffu /**< a pin that the library does not know by name */

/** One pin. */
typedef struct stm32_pin {
    uint8_t line;    /**< bq_line, or STM32_NO_LINE */
    uint8_t port;    /**< STM32_PORT_A ... */
    uint8_t pin;     /**< 0..15 */
    uint8_t mode;    /**< stm32_pin_mode */
    uint8_t pull;    /**< STM32_PULL_... */
    uint8_t initial; /**< outputs: level from reset on, and the safe one after a crash */
    uint8_t af;      /**< number of the alternate function */
    uint8_t edge;    /**< inputs: edges that wake the CPU by EXTI; STM32_EDGE_NONE = none */
} stm32_pin;

/** The table; constant, owned by the board. */
typedef struct stm32_pins {
    const stm32_pin *pin;
    uint8_t count;
} stm32_pins;

stm32_gpio_regs *stm32_port(unsigned port);

/** Puts every output of the table to its initial level and makes it an output. Clocks the ports. Needs no RAM
 * but the stack, so it may run first thing after reset and in a fault handler. */
void stm32_pins_safe(const stm32_pins *pins);

/** Sets up all pins, level before direction, then EXTI for those with an edge (unmasked in EXTI; the board
 * enables the interrupt in the NVIC). */
void stm32_pins_init(const stm32_pins *pins);

/** For the board's EXTI handlers: acknowledges the pending lines of `mask` (bit n = EXTIn) and returns them.
 */
uint32_t stm32_exti_take(uint32_t mask);

/** Drives one pin that is not a line (a LED). */
static inline void stm32_pin_write(unsigned port, unsigned pin, bool level)
{
    stm32_port(port)->bsrr = level ? 1u << pin : 0x10000u << pin;
}

/** The lines of the table. `pins` must outlive the result. A line that is not in the table is
 * BQ_E_UNSUPPORTED; writing an input is BQ_E_UNSUPPORTED; reading an output gives the level at the pin. */
bq_gpio stm32_gpio(const stm32_pins *pins);

#endif
