/* SPDX-License-Identifier: Apache-2.0 */
/* From the reset vector to board_main(), and the entry of every unexpected exception. */
#include "stm32_start.h"
#include "stm32_core.h"

/* Up to this function's own frame; it calls nothing while it paints. */
static inline void paint_stack(void)
{
    uint32_t *w, *sp;
    __asm volatile("mov %0, sp" : "=r"(sp));
    for (w = stm32_guard_begin; w < stm32_guard_end; w++) {
        *(volatile uint32_t *)w = STM32_GUARD_WORD;
    }
    for (; w < sp; w++) {
        *(volatile uint32_t *)w = STM32_PAINT_WORD;
    }
}

/* The volatile keeps a compiler from making calls of memcpy and memset of these, which run before .bss is
 * there. */
static inline void init_memory(void)
{
    const uint32_t *from = stm32_data_load;
    for (uint32_t *to = stm32_data_begin; to < stm32_data_end; to++) {
        *(volatile uint32_t *)to = *from++;
    }
    for (uint32_t *to = stm32_bss_begin; to < stm32_bss_end; to++) {
        *(volatile uint32_t *)to = 0;
    }
}

void stm32_start(void)
{
    (void)stm32_lock();
    board_outputs_safe();
    paint_stack();
    init_memory();
    board_main();
    stm32_crash(STM32_CRASH_ASSERT);
}

/* r0 = frame on the main stack (no other is used), r1 = number of the exception. If the stack has run into
 * its guard the handler goes on at its upper end, where nothing of the frame lies. */
__attribute__((naked, used)) void stm32_fault(void)
{
    __asm volatile("cpsid i\n\t"
                   "mrs r0, msp\n\t"
                   "mrs r1, ipsr\n\t"
                   "ldr r2, =stm32_guard_end + 128\n\t"
                   "cmp r0, r2\n\t"
                   "bhs 1f\n\t"
                   "ldr r2, =stm32_stack_end\n\t"
                   "mov sp, r2\n\t"
                   "1: ldr r2, =stm32_fault_kept\n\t"
                   "bx r2\n\t"
                   ".ltorg");
}
