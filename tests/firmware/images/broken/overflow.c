/* SPDX-License-Identifier: Apache-2.0 */
/* The stack grows for ever: through the guard, the crash record and the end of RAM. */
#include "bqhost/firmware.h"
#include "defect.h"

uint32_t __real_bq_firmware_step(bq_firmware *fw);
uint32_t __wrap_bq_firmware_step(bq_firmware *fw);

static volatile bool deep = true;

static __attribute__((noinline)) uint32_t deeper(uint32_t depth)
{
    volatile uint32_t here[2] = {depth, depth};
    if (deep) {
        here[1] = deeper(depth + 1u);
    }
    return here[0] + here[1];
}

uint32_t __wrap_bq_firmware_step(bq_firmware *fw)
{
    if (defect_due()) {
        (void)deeper(0);
    }
    return __real_bq_firmware_step(fw);
}
