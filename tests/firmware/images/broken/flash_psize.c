/* SPDX-License-Identifier: Apache-2.0 */
/* Programs words while the width of a byte is set (STM32F405). */
#include "stm32_chip.h"
#include "stm32_flash.h"

#define KEYR STM32_REG(0x40023C04u)
#define SR STM32_REG(0x40023C0Cu)
#define SR_ALL 0xf3u
#define SR_BSY (1u << 16)
#define CR STM32_REG(0x40023C10u)
#define CR_PG 1u /* and PSIZE 0 */
#define CR_LOCK (1u << 31)

bq_status __wrap_stm32_flash_program(uint32_t address, const uint8_t *unit);

bq_status __wrap_stm32_flash_program(uint32_t address, const uint8_t *unit)
{
    KEYR = 0x45670123u;
    KEYR = 0xCDEF89ABu;
    SR = SR_ALL;
    CR = CR_PG;
    STM32_REG(address) = unit[0] | (uint32_t)unit[1] << 8 | (uint32_t)unit[2] << 16 | (uint32_t)unit[3] << 24;
    stm32_dsb();
    while ((SR & SR_BSY) != 0u) {
    }
    CR = CR_LOCK;
    return BQ_OK;
}
