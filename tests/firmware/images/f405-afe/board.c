/* SPDX-License-Identifier: Apache-2.0 */
/* What only the test image has: the I2C peripheral of the other generation. */
#include "board.h"
#include "pins.h"
#include "stm32_chip.h"
#include "stm32_nvm.h"
#include "stm32_supply.h"

static const stm32_nvm settings = BOARD_NVM;

void exti9_5_handler(void)
{
    board_line_rose(1u << 5); /* ALERT */
}

void i2c1_ev_handler(void)
{
    stm32_i2c_irq(&board_hw.i2c);
}

void i2c1_er_handler(void)
{
    stm32_i2c_irq(&board_hw.i2c);
}

void can1_tx_handler(void)
{
    stm32_can_irq(&board_hw.can);
}

void can1_sce_handler(void)
{
    stm32_can_irq(&board_hw.can);
}

void board_peripherals(void)
{
    stm32_supply_init();
    stm32_irq_enable(STM32_IRQ_EXTI9_5, 3);
    stm32_i2c_init(&board_hw.i2c, &board_hw.time, BOARD_I2C_PORT, BOARD_I2C_SCL, BOARD_I2C_SDA);
}

void board_offer(bq_board *b)
{
    b->nvm = stm32_nvm_memory(&settings);
}
