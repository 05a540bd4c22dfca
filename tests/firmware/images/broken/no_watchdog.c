/* SPDX-License-Identifier: Apache-2.0 */
/* The watchdog is never started, and the main loop hangs. */
#include "bqhost/firmware.h"
#include "defect.h"

uint32_t __real_bq_firmware_step(bq_firmware *fw);
uint32_t __wrap_bq_firmware_step(bq_firmware *fw);
void __wrap_stm32_watchdog_start(void);

void __wrap_stm32_watchdog_start(void)
{
}

uint32_t __wrap_bq_firmware_step(bq_firmware *fw)
{
    if (defect_due()) {
        for (;;) {
        }
    }
    return __real_bq_firmware_step(fw);
}
