/* SPDX-License-Identifier: Apache-2.0 */
/* The CAN controller is used without its clock. */
#include "defect.h"
#include "stm32_can.h"

bq_can __real_stm32_can_bus(void);
bq_can __wrap_stm32_can_bus(void);

bq_can __wrap_stm32_can_bus(void)
{
    STM32_RCC_APB1ENR &= ~STM32_APB1_CAN1;
    return __real_stm32_can_bus();
}
