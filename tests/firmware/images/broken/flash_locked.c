/* SPDX-License-Identifier: Apache-2.0 */
/* Writes into flash that is locked. */
#include "stm32_chip.h"
#include "stm32_flash.h"

bq_status __real_stm32_flash_erase(uint32_t address, uint32_t bytes);
bq_status __wrap_stm32_flash_erase(uint32_t address, uint32_t bytes);
bq_status __real_stm32_flash_program(uint32_t address, const uint8_t *unit);
bq_status __wrap_stm32_flash_program(uint32_t address, const uint8_t *unit);

bq_status __wrap_stm32_flash_erase(uint32_t address, uint32_t bytes)
{
    return __real_stm32_flash_erase(address, bytes);
}

bq_status __wrap_stm32_flash_program(uint32_t address, const uint8_t *unit)
{
#if STM32_FLASH_UNIT == 2u
    *(volatile uint16_t *)(uintptr_t)address = (uint16_t)(unit[0] | unit[1] << 8);
#else
    STM32_REG(address) = unit[0] | (uint32_t)unit[1] << 8 | (uint32_t)unit[2] << 16 | (uint32_t)unit[3] << 24;
#endif
    return BQ_OK;
}
