/* SPDX-License-Identifier: Apache-2.0 */
/* Why the last life ended. Pure, tested on the host. */
#include "stm32_life.h"
#include "stm32_regs.h"

bq_reset_cause stm32_reset_cause(uint32_t flags, uint32_t brown_out, bool kept, bool crashed)
{
    if (crashed && (flags & STM32_CSR_PORRSTF) == 0u) {
        return BQ_RESET_CRASH;
    }
    if ((flags & (STM32_CSR_IWDGRSTF | STM32_CSR_WWDGRSTF)) != 0u) {
        return BQ_RESET_WATCHDOG;
    }
    if ((flags & STM32_CSR_SFTRSTF) != 0u) {
        return BQ_RESET_SOFTWARE;
    }
    if ((flags & STM32_CSR_PORRSTF) != 0u) {
        return kept ? BQ_RESET_BROWN_OUT : BQ_RESET_POWER;
    }
    if ((flags & brown_out) != 0u) {
        return BQ_RESET_BROWN_OUT;
    }
    return (flags & STM32_CSR_PINRSTF) != 0u ? BQ_RESET_PIN : BQ_RESET_UNKNOWN;
}
