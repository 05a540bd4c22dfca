/* SPDX-License-Identifier: Apache-2.0 */
/* Flags cleared by writing 0xff, which also sets FORCE. */
#include "pl_wrong.h"

static pl_deed say(uint8_t device, uint8_t reg, uint8_t *value)
{
    (void)device;
    if ((reg != BQ76PL536_ALERT_STATUS && reg != BQ76PL536_FAULT_STATUS) || *value == 0) {
        return PL_AS_IT_IS;
    }
    *value = 0xff;
    return PL_CHANGED;
}

const pl_wrong wrong = {.say = say};
