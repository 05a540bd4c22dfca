/* SPDX-License-Identifier: Apache-2.0 */
#include "stm32_supply.h"
#include "stm32_chip.h"

void stm32_supply_init(void)
{
    stm32_apb1_enable(STM32_APB1_PWR);
    STM32_PWR_CR =
        (STM32_PWR_CR & ~(7u << STM32_PWR_CR_PLS_SHIFT)) | 7u << STM32_PWR_CR_PLS_SHIFT | STM32_PWR_CR_PVDE;
}

bool stm32_supply_ok(void)
{
    return (STM32_PWR_CSR & STM32_PWR_CSR_PVDO) == 0u;
}
