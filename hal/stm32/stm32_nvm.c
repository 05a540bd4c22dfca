/* SPDX-License-Identifier: Apache-2.0 */
#include "stm32_nvm.h"
#include "stm32_chip.h"
#include "stm32_flash.h"
#include <string.h>

static bool inside(const stm32_nvm *nvm, uint8_t sector, uint32_t offset, size_t len, const void *data)
{
    return sector < 2u && offset <= nvm->sector_bytes && len <= nvm->sector_bytes - offset && data != NULL;
}

/* To the library a supply that falls is a write that failed. */
static bq_status plain(bq_status st)
{
    return st == BQ_E_VOLTAGE ? BQ_E_BUS : st;
}

static bq_status nvm_read(void *ctx, uint8_t sector, uint32_t offset, void *data, size_t len)
{
    const stm32_nvm *nvm = ctx;
    if (!inside(nvm, sector, offset, len, data)) {
        return BQ_E_ARG;
    }
    memcpy(data, (const void *)(uintptr_t)(nvm->base[sector] + offset), len);
    return BQ_OK;
}

static bq_status nvm_program(void *ctx, uint8_t sector, uint32_t offset, const void *data, size_t len)
{
    const stm32_nvm *nvm = ctx;
    const uint8_t *bytes = data;
    bq_status st = BQ_OK;
    if (!inside(nvm, sector, offset, len, data) || (offset | len) % STM32_FLASH_UNIT != 0u) {
        return BQ_E_ARG;
    }
    for (size_t i = 0; i < len && st == BQ_OK; i += STM32_FLASH_UNIT) {
        st = stm32_flash_program(nvm->base[sector] + offset + i, bytes + i);
    }
    return plain(st);
}

static bq_status nvm_erase(void *ctx, uint8_t sector)
{
    const stm32_nvm *nvm = ctx;
    if (sector >= 2u) {
        return BQ_E_ARG;
    }
    return plain(stm32_flash_erase(nvm->base[sector], nvm->sector_bytes));
}

static bq_status no_program(void *ctx, uint8_t sector, uint32_t offset, const void *data, size_t len)
{
    (void)ctx, (void)sector, (void)offset, (void)data, (void)len;
    return BQ_E_UNSUPPORTED;
}

static bq_status no_erase(void *ctx, uint8_t sector)
{
    (void)ctx, (void)sector;
    return BQ_E_UNSUPPORTED;
}

bq_nvm stm32_nvm_memory(const stm32_nvm *nvm)
{
    static const bq_nvm_ops ops = {nvm_read, nvm_program, nvm_erase};
    bq_nvm memory = {&ops, (void *)(uintptr_t)nvm, 2, STM32_FLASH_UNIT, nvm->sector_bytes};
    return memory;
}

bq_nvm stm32_nvm_reader(const stm32_nvm *nvm)
{
    static const bq_nvm_ops ops = {nvm_read, no_program, no_erase};
    bq_nvm memory = {&ops, (void *)(uintptr_t)nvm, 2, STM32_FLASH_UNIT, nvm->sector_bytes};
    return memory;
}
