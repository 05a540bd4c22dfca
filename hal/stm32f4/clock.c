/* SPDX-License-Identifier: Apache-2.0 */
/* The clock tree (RM0090 5.1.4, 3.5.1, 7.2, 7.3): 168 MHz by the PLL from the 8 MHz crystal, or from the
 * internal 16 MHz oscillator when the crystal fails. APB1 42 MHz, APB2 10.5 MHz. */
#include "stm32_chip.h"
#include "stm32_clock.h"
#include "stm32_life.h"

#define RCC_CR STM32_REG(0x40023800u)
#define RCC_PLLCFGR STM32_REG(0x40023804u)
#define RCC_CFGR STM32_REG(0x40023808u)
#define RCC_CIR STM32_REG(0x4002380Cu)
#define CR_HSION (1u << 0)
#define CR_HSIRDY (1u << 1)
#define CR_HSEON (1u << 16)
#define CR_HSERDY (1u << 17)
#define CR_CSSON (1u << 19)
#define CR_PLLON (1u << 24)
#define CR_PLLRDY (1u << 25)
#define CFGR_SW_HSI 0u
#define CFGR_SW_PLL 2u
#define CFGR_SW 3u
#define CFGR_SWS_SHIFT 2
#define CFGR_PRESCALERS (15u << 4 | 7u << 10 | 7u << 13) /* HPRE, PPRE1, PPRE2 */
#define CFGR_APB1_BY_4 (5u << 10)
#define CFGR_APB2_BY_16 (7u << 13)
#define CIR_CSSF (1u << 7)
#define CIR_CSSC (1u << 23)
#define PWR_CR_VOS (1u << 14) /* scale 1: more than 144 MHz */

#define FLASH_ACR STM32_REG(0x40023C00u)
#define ACR_LATENCY 7u
#define ACR_5_WAIT_STATES 5u /* 150..168 MHz at 2.7..3.6 V */
#define ACR_ICEN (1u << 9)
#define ACR_DCEN (1u << 10)

/* PLLCFGR: 2 MHz into the PLL, 336 MHz in it, 168 MHz out (P = 2), 48 MHz for nobody (Q = 7) */
#define PLL_FIELDS (63u | 511u << 6 | 3u << 16 | 1u << 22 | 15u << 24)
#define PLL_COMMON (168u << 6 | 0u << 16 | 7u << 24)
#define PLL_FROM_HSE (4u | 1u << 22)
#define PLL_FROM_HSI (8u | 0u << 22)

/* Bounds as turns of a loop of about eight cycles at 16 MHz */
#define TURNS_100_MS 200000u /* a crystal takes some milliseconds, if it starts */
#define TURNS_1_MS 2000u     /* the PLL takes at most 0.3 ms */

static bool reaches(volatile uint32_t *reg, uint32_t mask, uint32_t value, uint32_t turns)
{
    while ((*reg & mask) != value) {
        if (turns-- == 0u) {
            return false;
        }
    }
    return true;
}

/* Before the clock is raised: core voltage for it, and flash that is read slowly enough. Prefetch stays off:
 * revision A of the chip cannot do it (ES0182). */
static bool prepare(void)
{
    stm32_apb1_enable(STM32_APB1_PWR);
    STM32_PWR_CR |= PWR_CR_VOS;
    FLASH_ACR = ACR_5_WAIT_STATES | ACR_ICEN | ACR_DCEN;
    return reaches(&FLASH_ACR, ACR_LATENCY, ACR_5_WAIT_STATES, TURNS_1_MS);
}

static bool crystal_runs(void)
{
    RCC_CR |= CR_HSEON;
    if (reaches(&RCC_CR, CR_HSERDY, CR_HSERDY, TURNS_100_MS)) {
        return true;
    }
    RCC_CR &= ~CR_HSEON;
    return false;
}

/* From HSI as system clock to the PLL; the prescalers come first, so that no bus is ever too fast. */
static bool go(uint32_t source)
{
    RCC_CR &= ~CR_PLLON;
    if (!reaches(&RCC_CR, CR_PLLRDY, 0, TURNS_1_MS)) {
        return false;
    }
    RCC_PLLCFGR = (RCC_PLLCFGR & ~PLL_FIELDS) | PLL_COMMON | source;
    RCC_CFGR = (RCC_CFGR & ~CFGR_PRESCALERS) | CFGR_APB1_BY_4 | CFGR_APB2_BY_16;
    RCC_CR |= CR_PLLON;
    if (!reaches(&RCC_CR, CR_PLLRDY, CR_PLLRDY, TURNS_1_MS)) {
        return false;
    }
    RCC_CFGR = (RCC_CFGR & ~CFGR_SW) | CFGR_SW_PLL;
    return reaches(&RCC_CFGR, CFGR_SW << CFGR_SWS_SHIFT, CFGR_SW_PLL << CFGR_SWS_SHIFT, TURNS_1_MS);
}

/* Without a clock no time and no bus is right: outputs off, and once more from the beginning. */
static void by_internal_oscillator(void)
{
    RCC_CR |= CR_HSION;
    if (!reaches(&RCC_CR, CR_HSIRDY, CR_HSIRDY, TURNS_1_MS) || !go(PLL_FROM_HSI)) {
        stm32_crash(STM32_CRASH_ASSERT);
    }
}

bool stm32_clock_start(void)
{
    if (!prepare()) {
        stm32_crash(STM32_CRASH_ASSERT);
    }
    if (crystal_runs()) {
        if (go(PLL_FROM_HSE)) {
            RCC_CR |= CR_CSSON;
            return true;
        }
        RCC_CFGR = (RCC_CFGR & ~CFGR_SW) | CFGR_SW_HSI;
        RCC_CR &= ~(CR_PLLON | CR_HSEON);
    }
    by_internal_oscillator();
    return false;
}

bool stm32_clock_failed(void)
{
    if ((RCC_CIR & CIR_CSSF) == 0u) {
        return false;
    }
    RCC_CIR |= CIR_CSSC;
    RCC_CR &= ~(CR_CSSON | CR_HSEON);
    by_internal_oscillator();
    return true;
}
