/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32_nvm.h
 * Flash sectors as the memory of bqhost/hal.h.
 */
#ifndef STM32_NVM_H
#define STM32_NVM_H

#include "bqhost/hal.h"

/** Where the sectors are; constant, owned by the board. */
typedef struct stm32_nvm {
    uint32_t base[2];      /**< address of each sector */
    uint32_t sector_bytes; /**< of each that are used; erasing erases the whole hardware sector */
} stm32_nvm;

/** Two sectors with units of STM32_FLASH_UNIT bytes. A supply that falls is BQ_E_BUS. `nvm` must outlive the
 * result. */
bq_nvm stm32_nvm_memory(const stm32_nvm *nvm);

/** The same to read only, for an image that never writes its settings: erasing and programming are
 * BQ_E_UNSUPPORTED, and their code takes no flash. */
bq_nvm stm32_nvm_reader(const stm32_nvm *nvm);

#endif
