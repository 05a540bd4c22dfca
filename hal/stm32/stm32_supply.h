/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32_supply.h
 * The programmable voltage detector: while the supply is low no write to flash begins.
 */
#ifndef STM32_SUPPLY_H
#define STM32_SUPPLY_H

#include <stdbool.h>

/** Switches the detector on at the highest level (about 2.8 V on a falling supply, F4: 2.9 V). */
void stm32_supply_init(void);
/** False while the supply is below the level. */
bool stm32_supply_ok(void);

#endif
