/* SPDX-License-Identifier: Apache-2.0 */
/* Vector table of the STM32F405 (RM0090 12.2). A board defines the handlers it uses; all others end in
 * stm32_fault(). */
#include "stm32_chip.h"
#include "stm32_start.h"

#define HANDLER(name) void name(void) __attribute__((weak, alias("stm32_unhandled")))

static __attribute__((used)) void stm32_unhandled(void);
HANDLER(nmi_handler);
HANDLER(exti1_handler);
HANDLER(exti4_handler);
HANDLER(can1_tx_handler);
HANDLER(can1_rx0_handler);
HANDLER(can1_sce_handler);
HANDLER(exti9_5_handler);
HANDLER(tim2_handler);
HANDLER(i2c1_ev_handler);
HANDLER(i2c1_er_handler);
HANDLER(spi1_handler);
HANDLER(usart2_handler);
HANDLER(dma2_stream0_handler);
HANDLER(dma2_stream3_handler);

static __attribute__((naked, used)) void stm32_unhandled(void)
{
    __asm volatile("ldr r0, =stm32_fault\n\tbx r0\n\t.ltorg");
}

typedef union vector {
    void (*handler)(void);
    const void *stack;
} vector;

#define AT(irq, function) [16 + (irq)] = {.handler = function}
#define REST(first, last) [16 + (first)... 16 + (last)] = {.handler = stm32_fault}

__attribute__((section(".vectors"), used)) const vector stm32_vectors[16 + STM32_IRQ_COUNT] = {
    [0] = {.stack = stm32_stack_end},
    [1] = {.handler = stm32_start},
    [2] = {.handler = nmi_handler},
    [3 ... 15] = {.handler = stm32_fault},
    REST(0, STM32_IRQ_EXTI1 - 1),
    AT(STM32_IRQ_EXTI1, exti1_handler),
    REST(STM32_IRQ_EXTI1 + 1, STM32_IRQ_EXTI4 - 1),
    AT(STM32_IRQ_EXTI4, exti4_handler),
    REST(STM32_IRQ_EXTI4 + 1, STM32_IRQ_CAN_TX - 1),
    AT(STM32_IRQ_CAN_TX, can1_tx_handler),
    AT(STM32_IRQ_CAN_RX0, can1_rx0_handler),
    REST(STM32_IRQ_CAN_RX0 + 1, STM32_IRQ_CAN_SCE - 1),
    AT(STM32_IRQ_CAN_SCE, can1_sce_handler),
    AT(STM32_IRQ_EXTI9_5, exti9_5_handler),
    REST(STM32_IRQ_EXTI9_5 + 1, STM32_IRQ_TIM2 - 1),
    AT(STM32_IRQ_TIM2, tim2_handler),
    REST(STM32_IRQ_TIM2 + 1, STM32_IRQ_I2C1_EV - 1),
    AT(STM32_IRQ_I2C1_EV, i2c1_ev_handler),
    AT(STM32_IRQ_I2C1_ER, i2c1_er_handler),
    REST(STM32_IRQ_I2C1_ER + 1, STM32_IRQ_SPI1 - 1),
    AT(STM32_IRQ_SPI1, spi1_handler),
    REST(STM32_IRQ_SPI1 + 1, STM32_IRQ_USART2 - 1),
    AT(STM32_IRQ_USART2, usart2_handler),
    REST(STM32_IRQ_USART2 + 1, STM32_IRQ_DMA2_S0 - 1),
    AT(STM32_IRQ_DMA2_S0, dma2_stream0_handler),
    REST(STM32_IRQ_DMA2_S0 + 1, STM32_IRQ_DMA2_S3 - 1),
    AT(STM32_IRQ_DMA2_S3, dma2_stream3_handler),
    REST(STM32_IRQ_DMA2_S3 + 1, STM32_IRQ_COUNT - 1),
};
