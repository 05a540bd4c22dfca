/* SPDX-License-Identifier: Apache-2.0 */
/* Flash of the STM32F072 (RM0091 3.2.2): half-words into erased half-words, pages of 2 KB. The core stands
 * while a fetch meets a running operation; HSI must be on, which it always is. */
#include "stm32_chip.h"
#include "stm32_flash.h"
#include "stm32_supply.h"
#include "stm32_watchdog.h"
#include "stm32f0_regs.h"

#define PAGE_BYTES 2048u
#define ERRORS (STM32_FLASH_SR_PGERR | STM32_FLASH_SR_WRPRTERR)

/* Turns of about ten cycles: well above the longest programming (54 us) and erasing (40 ms) of the data
 * sheet. */
#define PATIENCE_PROGRAM 400u
#define PATIENCE_ERASE 400000u

static bool idle(uint32_t patience)
{
    while ((STM32_FLASH->sr & STM32_FLASH_SR_BSY) != 0u) {
        if (patience-- == 0u) {
            return false;
        }
    }
    return true;
}

static bq_status unlock(void)
{
    if (!stm32_supply_ok()) {
        return BQ_E_VOLTAGE;
    }
    if (!idle(PATIENCE_PROGRAM)) {
        return BQ_E_BUS;
    }
    if ((STM32_FLASH->cr & STM32_FLASH_CR_LOCK) != 0u) {
        STM32_FLASH->keyr = STM32_FLASH_KEY1;
        STM32_FLASH->keyr = STM32_FLASH_KEY2;
    }
    STM32_FLASH->sr = ERRORS | STM32_FLASH_SR_EOP; /* what an earlier operation left */
    return (STM32_FLASH->cr & STM32_FLASH_CR_LOCK) == 0u ? BQ_OK : BQ_E_BUS;
}

/* Waits for the end, takes the answer, clears `mode` and locks. */
static bq_status finish(uint32_t mode, uint32_t patience)
{
    bool ended = idle(patience);
    uint32_t sr = STM32_FLASH->sr;
    STM32_FLASH->sr = sr & (ERRORS | STM32_FLASH_SR_EOP);
    STM32_FLASH->cr &= ~mode;
    STM32_FLASH->cr |= STM32_FLASH_CR_LOCK;
    return ended && (sr & ERRORS) == 0u && (sr & STM32_FLASH_SR_EOP) != 0u ? BQ_OK : BQ_E_BUS;
}

bq_status stm32_flash_program(uint32_t address, const uint8_t *unit)
{
    volatile uint16_t *there = (volatile uint16_t *)(uintptr_t)address;
    uint16_t value = (uint16_t)(unit[0] | unit[1] << 8);
    bq_status st = unlock();
    if (st != BQ_OK) {
        return st;
    }
    STM32_FLASH->cr |= STM32_FLASH_CR_PG;
    *there = value;
    st = finish(STM32_FLASH_CR_PG, PATIENCE_PROGRAM);
    if (st == BQ_OK && *there != value) {
        st = BQ_E_VERIFY;
    }
    return st;
}

static bool blank(uint32_t address, uint32_t bytes)
{
    const uint32_t *w = (const uint32_t *)(uintptr_t)address;
    for (uint32_t i = 0; i < bytes / 4u; i++) {
        if (w[i] != 0xffffffffu) {
            return false;
        }
    }
    return true;
}

bq_status stm32_flash_erase(uint32_t address, uint32_t bytes)
{
    bq_status st;
    if (address % PAGE_BYTES != 0u || bytes > PAGE_BYTES) {
        return BQ_E_ARG;
    }
    st = unlock();
    if (st != BQ_OK) {
        return st;
    }
    stm32_watchdog_feed();
    STM32_FLASH->cr |= STM32_FLASH_CR_PER;
    STM32_FLASH->ar = address;
    STM32_FLASH->cr |= STM32_FLASH_CR_STRT;
    (void)STM32_FLASH->cr; /* BSY is up one cycle after STRT */
    st = finish(STM32_FLASH_CR_PER, PATIENCE_ERASE);
    stm32_watchdog_feed();
    return st == BQ_OK && !blank(address, bytes) ? BQ_E_VERIFY : st;
}
