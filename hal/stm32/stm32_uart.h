/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32_uart.h
 * USART2, 8N1, with a ring for each direction, as the stream of the console. Bytes that arrive without room
 * or damaged are dropped. The registers of the generation are in stm32_usart.h of the family.
 */
#ifndef STM32_UART_H
#define STM32_UART_H

#include "bqhost/hal.h"
#include "stm32_ring.h"
#include "stm32_time.h"

#define STM32_UART_RX 64u
#define STM32_UART_TX 128u

/** One UART; the board owns it. */
typedef struct stm32_uart {
    stm32_ring rx, tx;
    stm32_time *time;
    uint8_t rx_data[STM32_UART_RX], tx_data[STM32_UART_TX];
} stm32_uart;

/** Clocks and starts USART2 at `baud` (its pins come from the board's table) and enables its interrupt. */
void stm32_uart_init(stm32_uart *uart, stm32_time *time, uint32_t baud);

/** For the board's USART2 handler. Reports an event to `time` when a byte arrived and when the transmit ring
 * has half its room again. */
void stm32_uart_irq(stm32_uart *uart);

bq_stream stm32_uart_stream(stm32_uart *uart);

#endif
