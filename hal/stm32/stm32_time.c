/* SPDX-License-Identifier: Apache-2.0 */
#include "stm32_time.h"
#include "stm32_chip.h"
#include "stm32_core.h"

void stm32_time_init(stm32_time *time)
{
    stm32_tim_regs *t = STM32_TIM2;
    time->event = false;
    stm32_apb1_enable(STM32_APB1_TIM2);
    t->cr1 = 0;
    t->psc = STM32_TIM2_HZ / 1000000u - 1u;
    t->arr = 0xffffffffu;
    t->egr = STM32_TIM_EGR_UG; /* the prescaler is taken over by an update; the counter becomes 0 */
    t->sr = 0;
    t->cr1 = STM32_TIM_CR1_CEN;
    stm32_irq_enable(STM32_IRQ_TIM2, 3);
}

void stm32_wait_us(uint32_t us)
{
    uint32_t from = stm32_now_us();
    while (stm32_now_us() - from <= us) {
    }
}

/* Channel 1 compares, without an output (CCMR1 = 0 after reset). A comparison that lies in the past would
 * come an hour late, so the counter is looked at again after it is set. */
static void arm(stm32_time *time, uint32_t deadline)
{
    stm32_tim_regs *t = STM32_TIM2;
    t->ccr1 = deadline;
    t->sr = ~STM32_TIM_SR_CC1IF;
    t->dier = STM32_TIM_DIER_CC1IE;
    if ((int32_t)(deadline - t->cnt) <= 0) {
        stm32_time_event(time);
    }
}

/* With interrupts masked a pending one still ends WFI; it is served when they are unmasked. So nothing can
 * come between the look at `event` and the sleep. */
void stm32_time_sleep(stm32_time *time, uint32_t us)
{
    uint32_t mask;
    if (us == 0u) {
        return;
    }
    arm(time, stm32_now_us() + (us > 0x7fffffffu ? 0x7fffffffu : us));
    while (mask = stm32_lock(), !time->event) {
        stm32_wfi();
        stm32_unlock_and_serve(mask);
    }
    STM32_TIM2->dier = 0;
    time->event = false;
    stm32_unlock(mask);
}

void stm32_time_irq(stm32_time *time)
{
    STM32_TIM2->sr = ~STM32_TIM_SR_CC1IF;
    STM32_TIM2->dier = 0;
    stm32_time_event(time);
}

static uint32_t now_us(void *ctx)
{
    (void)ctx;
    return stm32_now_us();
}

bq_clock stm32_clock(void)
{
    bq_clock clock = {now_us, NULL};
    return clock;
}
