/* SPDX-License-Identifier: Apache-2.0 */
/* The handlers of the lines do not clear the flag they came for. They take their time, so that fewer of their
 * endless entries have to be emulated. */
#include "defect.h"
#include "stm32_gpio.h"

#define TURNS 20000u

uint32_t __wrap_stm32_exti_take(uint32_t mask);

uint32_t __wrap_stm32_exti_take(uint32_t mask)
{
    for (uint32_t i = 0; i < TURNS; i++) {
        __asm volatile("nop");
    }
    return STM32_EXTI->pr & mask;
}
