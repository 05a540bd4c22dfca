/* SPDX-License-Identifier: Apache-2.0 */
#include "stm32_uart.h"
#include "stm32_chip.h"
#include "stm32_core.h"
#include "stm32_usart.h"

void stm32_uart_init(stm32_uart *uart, stm32_time *time, uint32_t baud)
{
    stm32_ring_init(&uart->rx, uart->rx_data, STM32_UART_RX);
    stm32_ring_init(&uart->tx, uart->tx_data, STM32_UART_TX);
    uart->time = time;
    stm32_apb1_enable(STM32_APB1_USART2);
    stm32_usart_start((STM32_APB1_HZ + baud / 2u) / baud);
    stm32_irq_enable(STM32_IRQ_USART2, 2);
}

/* ---- interrupt
 * ----------------------------------------------------------------------------------------------- */

static void receive(stm32_uart *uart)
{
    uint8_t byte;
    bool damaged;
    while (stm32_usart_take(&byte, &damaged)) {
        if (!damaged) {
            (void)stm32_ring_put(&uart->rx, byte);
        }
        stm32_time_event(uart->time);
    }
}

static void transmit(stm32_uart *uart)
{
    uint8_t byte;
    if (!stm32_usart_tx_due()) {
        return;
    }
    if (!stm32_ring_get(&uart->tx, &byte)) {
        stm32_usart_tx_irq(false);
        return;
    }
    stm32_usart_put(byte);
    if (stm32_ring_used(&uart->tx) == STM32_UART_TX / 2u) {
        stm32_time_event(uart->time);
    }
}

void stm32_uart_irq(stm32_uart *uart)
{
    receive(uart);
    transmit(uart);
}

/* ---- stream
 * -------------------------------------------------------------------------------------------------- */

static size_t stream_write(void *ctx, const uint8_t *data, size_t len)
{
    stm32_uart *uart = ctx;
    size_t n = 0;
    uint32_t mask;
    while (n < len && stm32_ring_put(&uart->tx, data[n])) {
        n++;
    }
    if (n > 0u) {
        mask = stm32_lock(); /* the handler changes the same register */
        stm32_usart_tx_irq(true);
        stm32_unlock(mask);
    }
    return n;
}

static size_t stream_read(void *ctx, uint8_t *data, size_t len)
{
    stm32_uart *uart = ctx;
    size_t n = 0;
    while (n < len && stm32_ring_get(&uart->rx, &data[n])) {
        n++;
    }
    return n;
}

bq_stream stm32_uart_stream(stm32_uart *uart)
{
    static const bq_stream_ops ops = {stream_write, stream_read};
    bq_stream stream = {&ops, uart};
    return stream;
}
