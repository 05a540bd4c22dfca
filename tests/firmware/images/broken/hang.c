/* SPDX-License-Identifier: Apache-2.0 */
/* The main loop hangs; interrupts go on. */
#include "bqhost/firmware.h"
#include "defect.h"

uint32_t __real_bq_firmware_step(bq_firmware *fw);
uint32_t __wrap_bq_firmware_step(bq_firmware *fw);

uint32_t __wrap_bq_firmware_step(bq_firmware *fw)
{
    if (defect_due()) {
        for (;;) {
        }
    }
    return __real_bq_firmware_step(fw);
}
