/* SPDX-License-Identifier: Apache-2.0 */
/** @file emu_flash.h
 * What the flash controllers of both families share: one operation at a time, which may be cut short. */
#ifndef EMU_FLASH_H
#define EMU_FLASH_H

#include "emu_internal.h"

#define FLASH_KEY1 0x45670123u
#define FLASH_KEY2 0xcdef89abu

enum flash_lock { LOCKED, HALF_OPEN, OPEN, SHUT /**< wrong key: until the next reset */ };

typedef struct flash {
    uint32_t acr, sr, cr, ar;
    enum flash_lock lock, option_lock;
    uint64_t busy_ns;   /**< end of the operation under way; 0 = none */
    uint32_t at, size;  /**< place it changes */
    uint8_t *old;       /**< what stood there */
    uint32_t done_flag; /**< bit of SR to set at its end */
} flash;

bool flash_busy(const emu_periph *p);
/** Begins an operation on a place that holds its result afterwards. Erase: result NULL. */
void flash_begin(emu_periph *p, uint32_t at, uint32_t size, const uint8_t *result, uint64_t ns);
uint64_t flash_next(const emu_periph *p);
void flash_polled(emu_periph *p); /**< the processor has seen it busy: emu_set_flash_poll_ns() */
void flash_abort(emu_periph *p); /**< a reset cuts it short */
void flash_key(emu_periph *p, enum flash_lock *lock, uint32_t value, const char *reg);
emu_periph *flash_new(emu *e, const emu_instance *at, uint32_t largest);

#endif
