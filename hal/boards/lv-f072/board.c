/* SPDX-License-Identifier: Apache-2.0 */
/* What only lv-f072 has. Its FETs hang on the bq769x0: they keep their state while the processor restarts, a
 * fraction of a second, under the monitor's own protections; the bring-up turns them off. */
#include "board.h"
#include "pins.h"
#include "stm32_chip.h"
#include "stm32_nvm.h"

static const stm32_nvm settings = BOARD_NVM;

void exti0_1_handler(void)
{
    board_line_rose(1u << 0); /* ALERT */
}

void i2c1_handler(void)
{
    stm32_i2c_irq(&board_hw.i2c);
}

void can_handler(void)
{
    stm32_can_irq(&board_hw.can);
}

void board_peripherals(void)
{
    stm32_irq_enable(STM32_IRQ_EXTI0_1, 3);
    stm32_i2c_init(&board_hw.i2c, &board_hw.time, BOARD_I2C_PORT, BOARD_I2C_SCL, BOARD_I2C_SDA);
}

void board_offer(bq_board *b)
{
    b->nvm = stm32_nvm_reader(&settings);
}
