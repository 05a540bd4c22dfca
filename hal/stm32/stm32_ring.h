/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32_ring.h
 * A ring of bytes between one writer and one reader, one of which may be an interrupt. No lock: each side
 * changes one index only. Pure C, tested on the host.
 */
#ifndef STM32_RING_H
#define STM32_RING_H

#include <stdbool.h>
#include <stdint.h>

typedef struct stm32_ring {
    uint8_t *data;
    uint16_t size;              /* power of two, 2..32768 */
    volatile uint16_t put, get; /* run freely */
} stm32_ring;

/** `size` must be a power of two, 2..32768; `data` belongs to the ring. */
void stm32_ring_init(stm32_ring *r, uint8_t *data, uint16_t size);
uint16_t stm32_ring_used(const stm32_ring *r);
uint16_t stm32_ring_room(const stm32_ring *r);
/** False: full, the byte was not taken. */
bool stm32_ring_put(stm32_ring *r, uint8_t byte);
/** False: empty, `*byte` unchanged. */
bool stm32_ring_get(stm32_ring *r, uint8_t *byte);

#endif
