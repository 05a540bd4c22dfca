/* SPDX-License-Identifier: Apache-2.0 */
/* Flash (RM0090 3.6, 3.9): words, 2.7..3.6 V. While the array is busy every fetch from it stalls the core, so
 * the wait for an erasure, which may take longer than the watchdog does, stands in RAM. */
#include "stm32_chip.h"
#include "stm32_flash.h"
#include "stm32_supply.h"
#include "stm32_time.h"
#include "stm32_watchdog.h"

#define FLASH_ACR STM32_REG(0x40023C00u)
#define ACR_DCEN (1u << 10)
#define ACR_DCRST (1u << 12)
#define FLASH_KEYR STM32_REG(0x40023C04u)
#define KEY1 0x45670123u
#define KEY2 0xCDEF89ABu
#define FLASH_SR STM32_REG(0x40023C0Cu)
#define SR_EOP (1u << 0)
#define SR_ERRORS (1u << 1 | 1u << 4 | 1u << 5 | 1u << 6 | 1u << 7) /* OPERR WRPERR PGAERR PGPERR PGSERR */
#define SR_BSY (1u << 16)
#define FLASH_CR STM32_REG(0x40023C10u)
#define CR_PG (1u << 0)
#define CR_SER (1u << 1)
#define CR_SNB(n) ((uint32_t)(n) << 3)
#define CR_PSIZE_WORD (2u << 8)
#define CR_STRT (1u << 16)
#define CR_LOCK (1u << 31)

#define FLASH_BASE 0x08000000u
#define PROGRAM_US 100u
#define ERASE_US 2000000u
#define NO_SECTOR 0xffu

/* ---- access
 * ------------------------------------------------------------------------------------------------ */

static bool unlock(void)
{
    if ((FLASH_SR & SR_BSY) != 0u) {
        return false;
    }
    if ((FLASH_CR & CR_LOCK) != 0u) {
        FLASH_KEYR = KEY1;
        FLASH_KEYR = KEY2;
    }
    FLASH_SR = SR_ERRORS | SR_EOP;
    return (FLASH_CR & CR_LOCK) == 0u;
}

static void lock(void)
{
    FLASH_CR = 0; /* LOCK is set alone: the other bits are of the operation that is over */
    FLASH_CR = CR_LOCK;
}

static bool ended_well(uint32_t from, uint32_t bound_us)
{
    while ((FLASH_SR & SR_BSY) != 0u) {
        if (stm32_now_us() - from > bound_us) {
            return false;
        }
    }
    return (FLASH_SR & SR_ERRORS) == 0u;
}

/* ---- one word
 * ---------------------------------------------------------------------------------------------- */

static uint32_t word_of(const uint8_t *b)
{
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

bq_status stm32_flash_program(uint32_t address, const uint8_t *unit)
{
    uint32_t word = word_of(unit), from = stm32_now_us();
    bool well;
    if (!stm32_supply_ok()) {
        return BQ_E_VOLTAGE;
    }
    if (!unlock()) {
        return BQ_E_BUS;
    }
    FLASH_CR = CR_PSIZE_WORD | CR_PG;
    STM32_REG(address) = word;
    stm32_dsb();
    well = ended_well(from, PROGRAM_US);
    lock();
    if (!well) {
        return BQ_E_BUS;
    }
    return STM32_REG(address) == word ? BQ_OK : BQ_E_VERIFY;
}

/* ---- one sector
 * -------------------------------------------------------------------------------------------- */

/* Four sectors of 16 KB, one of 64 KB, seven of 128 KB (RM0090 3.4). */
static unsigned sector_of(uint32_t address)
{
    uint32_t begin = FLASH_BASE;
    for (unsigned n = 0; n < 12u; n++) {
        if (begin == address) {
            return n;
        }
        begin += n < 4u ? 0x4000u : n == 4u ? 0x10000u : 0x20000u;
    }
    return NO_SECTOR;
}

/* Calls nothing and reads no constant from flash. False: the bound has passed. */
__attribute__((section(".ramcode"), noinline)) static bool erase_and_wait(uint32_t command)
{
    uint32_t from = STM32_TIM2->cnt;
    FLASH_CR = command;
    FLASH_CR = command | CR_STRT;
    stm32_dsb();
    while ((FLASH_SR & SR_BSY) != 0u) {
        STM32_IWDG->kr = STM32_IWDG_KR_RELOAD;
        if (STM32_TIM2->cnt - from > ERASE_US) {
            return false;
        }
    }
    return true;
}

/* What the data cache holds of the sector is of before (RM0090 3.5.4); it is emptied while it is off. */
static void empty_data_cache(void)
{
    FLASH_ACR &= ~ACR_DCEN;
    FLASH_ACR |= ACR_DCRST;
    FLASH_ACR &= ~ACR_DCRST;
    FLASH_ACR |= ACR_DCEN;
}

static bool blank(uint32_t address, uint32_t bytes)
{
    for (uint32_t i = 0; i < bytes; i += 4u) {
        if (STM32_REG(address + i) != 0xffffffffu) {
            return false;
        }
    }
    return true;
}

bq_status stm32_flash_erase(uint32_t address, uint32_t bytes)
{
    bool (*volatile erase)(uint32_t) = erase_and_wait; /* too far away for a direct call */
    unsigned sector = sector_of(address);
    bool well;
    if (sector == NO_SECTOR) {
        return BQ_E_ARG;
    }
    if (!stm32_supply_ok()) {
        return BQ_E_VOLTAGE;
    }
    if (!unlock()) {
        return BQ_E_BUS;
    }
    stm32_watchdog_feed();
    uint32_t mask =
        stm32_lock(); /* the handlers stand in flash: they come when the array can be read again */
    well = erase(CR_PSIZE_WORD | CR_SER | CR_SNB(sector));
    stm32_unlock(mask);
    well = well && (FLASH_SR & SR_ERRORS) == 0u;
    lock();
    empty_data_cache();
    if (!well) {
        return BQ_E_BUS;
    }
    return blank(address, bytes) ? BQ_OK : BQ_E_VERIFY;
}
