/* SPDX-License-Identifier: Apache-2.0 */
#include "stm32_watchdog.h"
#include "stm32_chip.h"

#define PRESCALE_32 3u /* IWDG_PR: divider 4 << n */

/* Starting it switches its oscillator on. Prescaler and reload are taken over within some of its periods;
 * meanwhile they must not be written again. */
void stm32_watchdog_start(void)
{
    stm32_iwdg_regs *w = STM32_IWDG;
    uint32_t patience = STM32_CORE_HZ / 1000u;
    w->kr = STM32_IWDG_KR_START;
    w->kr = STM32_IWDG_KR_UNLOCK;
    w->pr = PRESCALE_32;
    w->rlr = STM32_LSI_HZ / 32u - 1u;
    while (w->sr != 0u && patience > 0u) {
        patience--;
    }
    w->kr = STM32_IWDG_KR_RELOAD;
}

void stm32_watchdog_feed(void)
{
    STM32_IWDG->kr = STM32_IWDG_KR_RELOAD;
}
