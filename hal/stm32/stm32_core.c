/* SPDX-License-Identifier: Apache-2.0 */
#include "stm32_core.h"
#include "stm32_chip.h"

void stm32_irq_enable(unsigned irq, unsigned priority)
{
    unsigned shift = 8u * (irq & 3u) + 6u; /* the upper two bits are implemented in both cores */
    uint32_t bit = 1u << (irq & 31u);
    STM32_NVIC_IPR(irq >> 2) = (STM32_NVIC_IPR(irq >> 2) & ~(3u << shift)) | (priority << shift);
    STM32_NVIC_ICPR(irq >> 5) = bit;
    STM32_NVIC_ISER(irq >> 5) = bit;
}

void stm32_apb1_enable(uint32_t mask)
{
    STM32_RCC_APB1ENR |= mask;
    (void)STM32_RCC_APB1ENR;
}
