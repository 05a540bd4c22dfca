/* SPDX-License-Identifier: Apache-2.0 */
/* The stack grows into the guard and comes back. */
#include "bqhost/firmware.h"
#include "defect.h"
#include "stm32_core.h"
#include "stm32_life.h"
#include "stm32_start.h"

uint32_t __real_bq_firmware_step(bq_firmware *fw);
uint32_t __wrap_bq_firmware_step(bq_firmware *fw);

/* With interrupts masked, or one would push its frame below the guard. */
static __attribute__((noinline)) uint32_t deeper(uint32_t depth)
{
    volatile uint32_t here[2] = {depth, depth};
    if ((uintptr_t)here >= (uintptr_t)stm32_guard_end) {
        here[1] = deeper(depth + 1u);
    }
    return here[0] + here[1];
}

uint32_t __wrap_bq_firmware_step(bq_firmware *fw)
{
    if (defect_due()) {
        uint32_t mask = stm32_lock();
        (void)deeper(0);
        stm32_unlock(mask);
    }
    return __real_bq_firmware_step(fw);
}
