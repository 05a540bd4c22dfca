/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32_flash.h
 * Programming and erasing flash: written by each family. Flash is locked before and after each call. Nothing
 * is begun while the supply is below the level of the voltage detector.
 */
#ifndef STM32_FLASH_H
#define STM32_FLASH_H

#include "bqhost/hal.h"

/** Programs one unit (STM32_FLASH_UNIT bytes, aligned) and reads it back. BQ_OK; BQ_E_VOLTAGE (supply
 * falling, nothing begun); BQ_E_BUS (the hardware reported an error or was not ready); BQ_E_VERIFY. At most
 * 100 us. */
bq_status stm32_flash_program(uint32_t address, const uint8_t *unit);

/** Erases the page or sector that begins at `address` and checks that its first `bytes` read 0xff. The
 * watchdog is fed. BQ_OK; BQ_E_ARG (no page or sector begins there); BQ_E_VOLTAGE; BQ_E_BUS; BQ_E_VERIFY.
 * Blocks: F0 at most 40 ms, F4 up to 2 s. */
bq_status stm32_flash_erase(uint32_t address, uint32_t bytes);

#endif
