/* SPDX-License-Identifier: Apache-2.0 */
/* Vector table of the STM32F072 (RM0091 11.1.3). A board defines the handlers it uses; all others end in
 * stm32_fault(). */
#include "stm32_chip.h"
#include "stm32_start.h"

#define HANDLER(name) void name(void) __attribute__((weak, alias("stm32_unhandled")))

static __attribute__((used)) void stm32_unhandled(void);
HANDLER(nmi_handler);
HANDLER(exti0_1_handler);
HANDLER(tim2_handler);
HANDLER(i2c1_handler);
HANDLER(usart2_handler);
HANDLER(can_handler);

static __attribute__((naked, used)) void stm32_unhandled(void)
{
    __asm volatile("ldr r0, =stm32_fault\n\tbx r0\n\t.ltorg");
}

typedef union vector {
    void (*handler)(void);
    const void *stack;
} vector;

__attribute__((section(".vectors"), used)) const vector stm32_vectors[16 + STM32_IRQ_COUNT] = {
    [0] = {.stack = stm32_stack_end},
    [1] = {.handler = stm32_start},
    [2] = {.handler = nmi_handler},
    [3 ... 15] = {.handler = stm32_fault},
    [16 ... 16 + STM32_IRQ_EXTI0_1 - 1] = {.handler = stm32_fault},
    [16 + STM32_IRQ_EXTI0_1] = {.handler = exti0_1_handler},
    [16 + STM32_IRQ_EXTI0_1 + 1 ... 16 + STM32_IRQ_TIM2 - 1] = {.handler = stm32_fault},
    [16 + STM32_IRQ_TIM2] = {.handler = tim2_handler},
    [16 + STM32_IRQ_TIM2 + 1 ... 16 + STM32_IRQ_I2C1 - 1] = {.handler = stm32_fault},
    [16 + STM32_IRQ_I2C1] = {.handler = i2c1_handler},
    [16 + STM32_IRQ_I2C1 + 1 ... 16 + STM32_IRQ_USART2 - 1] = {.handler = stm32_fault},
    [16 + STM32_IRQ_USART2] = {.handler = usart2_handler},
    [16 + STM32_IRQ_USART2 + 1] = {.handler = stm32_fault},
    [16 + STM32_IRQ_CAN] = {.handler = can_handler},
    [16 + STM32_IRQ_CAN + 1] = {.handler = stm32_fault},
};
