/* SPDX-License-Identifier: Apache-2.0 */
/* Clock tree of the STM32F072: HSE 8 MHz x 6 = 48 MHz; without the crystal HSI48, and without that HSI / 2
 * x 12. All three give 48 MHz on core and APB, so nothing else has to know which one runs. */
#include "stm32_chip.h"
#include "stm32_clock.h"
#include "stm32f0_regs.h"

/* Turns of the waiting loop, about ten cycles each, at the 8 MHz of the start: 100 ms for the crystal, which
 * is fifty times its usual time, and 1 ms for what is inside the chip. */
#define PATIENCE_CRYSTAL 80000u
#define PATIENCE_INSIDE 800u

static bool reached(const volatile uint32_t *reg, uint32_t mask, uint32_t value, uint32_t patience)
{
    while ((*reg & mask) != value) {
        if (patience-- == 0u) {
            return false;
        }
    }
    return true;
}

static bool switch_to(uint32_t source)
{
    STM32_RCC_CFGR = (STM32_RCC_CFGR & ~STM32_RCC_CFGR_SW) | source;
    return reached(&STM32_RCC_CFGR, STM32_RCC_CFGR_SW << STM32_RCC_CFGR_SWS_SHIFT,
                   source << STM32_RCC_CFGR_SWS_SHIFT, PATIENCE_INSIDE);
}

/* Source and factor may change while the PLL is off only. */
static bool run_from_pll(uint32_t source, uint32_t factor)
{
    STM32_RCC_CR &= ~STM32_RCC_CR_PLLON;
    if (!reached(&STM32_RCC_CR, STM32_RCC_CR_PLLRDY, 0, PATIENCE_INSIDE)) {
        return false;
    }
    STM32_RCC_CFGR = (STM32_RCC_CFGR & ~STM32_RCC_CFGR_PLL) | source | STM32_RCC_CFGR_PLLMUL(factor);
    STM32_RCC_CR |= STM32_RCC_CR_PLLON;
    return reached(&STM32_RCC_CR, STM32_RCC_CR_PLLRDY, STM32_RCC_CR_PLLRDY, PATIENCE_INSIDE) &&
           switch_to(STM32_RCC_CFGR_SW_PLL);
}

static void run_from_inside(void)
{
    STM32_RCC_CR &= ~(STM32_RCC_CR_HSEON | STM32_RCC_CR_CSSON);
    STM32_RCC_CR2 |= STM32_RCC_CR2_HSI48ON;
    if (!reached(&STM32_RCC_CR2, STM32_RCC_CR2_HSI48RDY, STM32_RCC_CR2_HSI48RDY, PATIENCE_INSIDE) ||
        !switch_to(STM32_RCC_CFGR_SW_HSI48)) {
        (void)run_from_pll(STM32_RCC_CFGR_PLLSRC_HSI_2, 12);
    }
}

bool stm32_clock_start(void)
{
    STM32_FLASH->acr = STM32_FLASH_ACR_LATENCY | STM32_FLASH_ACR_PRFTBE; /* before the clock rises */
    (void)STM32_FLASH->acr;
    STM32_RCC_CR |= STM32_RCC_CR_HSEON;
    if (reached(&STM32_RCC_CR, STM32_RCC_CR_HSERDY, STM32_RCC_CR_HSERDY, PATIENCE_CRYSTAL) &&
        run_from_pll(STM32_RCC_CFGR_PLLSRC_HSE, 6)) {
        STM32_RCC_CR |= STM32_RCC_CR_CSSON;
        return true;
    }
    run_from_inside();
    return false;
}

/* The hardware has switched HSE and the PLL that it fed off, and the core to HSI. */
bool stm32_clock_failed(void)
{
    if ((STM32_RCC_CIR & STM32_RCC_CIR_CSSF) == 0u) {
        return false;
    }
    STM32_RCC_CIR |= STM32_RCC_CIR_CSSC;
    run_from_inside();
    return true;
}
