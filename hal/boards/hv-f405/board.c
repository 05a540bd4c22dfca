/* SPDX-License-Identifier: Apache-2.0 */
/* What only hv-f405 has. Contactor and precharge stand first in its table of pins. */
#include "board.h"
#include "pins.h"
#include "stm32_chip.h"
#include "stm32_nvm.h"
#include "stm32_supply.h"

static const stm32_nvm settings = BOARD_NVM;
static bq76pl536 monitor;
static bq76pl536_device devices[BOARD_DEVICES];

/* ---- interrupts
 * --------------------------------------------------------------------------------------------- */

void exti1_handler(void)
{
    board_line_rose(1u << 1); /* DRDY */
}

void exti4_handler(void)
{
    board_line_rose(1u << 4); /* FAULT */
}

void exti9_5_handler(void)
{
    board_line_rose(1u << 5); /* ALERT */
}

void spi1_handler(void)
{
    stm32_spi_irq(&board_hw.spi);
}

void dma2_stream0_handler(void)
{
    stm32_spi_irq(&board_hw.spi);
}

void dma2_stream3_handler(void)
{
    stm32_spi_irq(&board_hw.spi);
}

void can1_tx_handler(void)
{
    stm32_can_irq(&board_hw.can);
}

void can1_rx0_handler(void)
{
    stm32_can_rx_irq(&board_hw.inbox);
}

void can1_sce_handler(void)
{
    stm32_can_irq(&board_hw.can);
}

/* ---- for the main program
 * ----------------------------------------------------------------------------------- */

void board_peripherals(void)
{
    stm32_supply_init();
    stm32_irq_enable(STM32_IRQ_EXTI1, 3);
    stm32_irq_enable(STM32_IRQ_EXTI4, 3);
    stm32_irq_enable(STM32_IRQ_EXTI9_5, 3);
    stm32_spi_init(&board_hw.spi, &board_hw.time, BOARD_SPI_PORT, BOARD_SPI_CS, BOARD_SPI_SCK,
                   BOARD_SPI_MOSI);
    stm32_adc_init(&board_hw.adc, BOARD_SHUNT_CHANNEL, BOARD_SHUNT_ZERO, BOARD_SHUNT_MA);
}

void board_offer(bq_board *b)
{
    b->nvm = stm32_nvm_reader(&settings);
    b->can = stm32_can_listen(&board_hw.inbox, &board_hw.time);
    b->ammeter = stm32_adc_ammeter(&board_hw.adc);
}

bq_status board_monitor(const bq_board *b, bq_afe *afe)
{
    bq_spi spi = stm32_spi_bus(&board_hw.spi);
    *afe = bq76pl536_afe(&monitor);
    return bq76pl536_init(&monitor, &board_set.stack, &spi, &b->gpio, &b->clock, devices, BOARD_DEVICES);
}

/* The contactor is the board's own and open. */
void board_refused(bq_board *b)
{
    (void)b;
}
