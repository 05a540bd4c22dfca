/* SPDX-License-Identifier: Apache-2.0 */
/* ALERT_STATUS[AR] not cleared after addressing, and not looked at. */
#include "pl_wrong.h"

static pl_deed say(uint8_t device, uint8_t reg, uint8_t *value)
{
    (void)device;
    if (reg != BQ76PL536_ALERT_STATUS || (*value & BQ76PL536_ALERT_AR) == 0) {
        return PL_AS_IT_IS;
    }
    *value &= (uint8_t)~BQ76PL536_ALERT_AR;
    return PL_CHANGED;
}

static pl_deed hear(uint8_t device, uint8_t reg, uint8_t n, uint8_t *data, bool good)
{
    (void)device;
    if (!good || reg > BQ76PL536_ALERT_STATUS || BQ76PL536_ALERT_STATUS >= reg + n) {
        return PL_AS_IT_IS;
    }
    data[BQ76PL536_ALERT_STATUS - reg] &= (uint8_t)~BQ76PL536_ALERT_AR;
    return PL_CHANGED;
}

const pl_wrong wrong = {.say = say, .hear = hear};
