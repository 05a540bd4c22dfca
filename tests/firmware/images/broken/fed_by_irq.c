/* SPDX-License-Identifier: Apache-2.0 */
/* The main loop hangs, and an interrupt feeds the watchdog. */
#include "bqhost/firmware.h"
#include "defect.h"
#include "stm32_watchdog.h"

uint32_t __real_bq_firmware_step(bq_firmware *fw);
uint32_t __wrap_bq_firmware_step(bq_firmware *fw);
void __wrap_stm32_time_irq(stm32_time *time);

static void again(void)
{
    STM32_TIM2->ccr1 = STM32_TIM2->cnt + 10000u;
    STM32_TIM2->dier = STM32_TIM_DIER_CC1IE;
}

void __wrap_stm32_time_irq(stm32_time *time)
{
    STM32_TIM2->sr = ~STM32_TIM_SR_CC1IF;
    stm32_watchdog_feed();
    stm32_time_event(time);
    again();
}

uint32_t __wrap_bq_firmware_step(bq_firmware *fw)
{
    if (defect_due()) {
        again();
        for (;;) {
        }
    }
    return __real_bq_firmware_step(fw);
}
