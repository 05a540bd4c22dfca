/* SPDX-License-Identifier: Apache-2.0 */
/* The board: its pins, its safe state, and the order in which it starts. */
#include "board.h"
#include "pins.h"
#include "stm32_chip.h"
#include "stm32_clock.h"
#include "stm32_image.h"
#include "stm32_nvm.h"
#include "stm32_watchdog.h"

static const stm32_pin pin_table[] = {BOARD_PINS};
static const stm32_pins pins = {pin_table, sizeof pin_table / sizeof pin_table[0]};
static const stm32_nvm settings = BOARD_NVM;

/* The FETs hang on the bq769x0. They keep their state while the processor restarts, a fraction of a second,
 * under the monitor's own protections; the bring-up turns them off. */
void board_outputs_safe(void)
{
    stm32_pins_safe(&pins);
}

void board_start(board_parts *p)
{
    stm32_life_begin(&p->boot);
    p->boot.crystal_failed = !stm32_clock_start(); /* first: the checksum takes ten times longer without */
    p->boot.image_ok = stm32_image_self_check();
    p->boot.image_crc = stm32_image_stored_crc();
    stm32_watchdog_start();
    stm32_time_init(&p->time);
    stm32_pins_init(&pins);
    stm32_irq_enable(STM32_IRQ_EXTI0_1, 3);
    stm32_uart_init(&p->uart, &p->time, BOARD_BAUD);
    stm32_i2c_init(&p->i2c, &p->time, BOARD_I2C_PORT, BOARD_I2C_SCL, BOARD_I2C_SDA, BOARD_I2C_AF);
    (void)stm32_can_init(&p->can, &p->time); /* a dead controller is told by its state */
}

bq_board board_table(board_parts *p)
{
    bq_board b = {.name = BQHOST_BOARD,
                  .gpio = stm32_gpio(&pins),
                  .clock = stm32_clock(),
                  .can = stm32_can_bus(&p->can),
                  .console = stm32_uart_stream(&p->uart),
                  .nvm = stm32_nvm_reader(&settings),
                  .mcu = stm32_mcu(&p->boot)};
    return b;
}

void board_led(bool on)
{
    stm32_pin_write(BOARD_LED_PORT, BOARD_LED_PIN, on);
}
