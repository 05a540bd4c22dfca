/* SPDX-License-Identifier: Apache-2.0 */
#include "stm32_ring.h"

void stm32_ring_init(stm32_ring *r, uint8_t *data, uint16_t size)
{
    r->data = data;
    r->size = size;
    r->put = 0;
    r->get = 0;
}

uint16_t stm32_ring_used(const stm32_ring *r)
{
    return (uint16_t)(r->put - r->get);
}

uint16_t stm32_ring_room(const stm32_ring *r)
{
    return (uint16_t)(r->size - stm32_ring_used(r));
}

/* The byte is there before the index says so: on these cores stores are seen in program order by their own
 * interrupts, and the index is volatile; the barrier keeps the compiler from moving the byte. */
static void settle(void)
{
    __asm volatile("" ::: "memory");
}

bool stm32_ring_put(stm32_ring *r, uint8_t byte)
{
    uint16_t put = r->put;
    if (stm32_ring_room(r) == 0u) {
        return false;
    }
    r->data[put & (r->size - 1u)] = byte;
    settle();
    r->put = (uint16_t)(put + 1u);
    return true;
}

bool stm32_ring_get(stm32_ring *r, uint8_t *byte)
{
    uint16_t get = r->get;
    if (stm32_ring_used(r) == 0u) {
        return false;
    }
    settle();
    *byte = r->data[get & (r->size - 1u)];
    settle();
    r->get = (uint16_t)(get + 1u);
    return true;
}
