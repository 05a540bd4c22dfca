/* SPDX-License-Identifier: Apache-2.0 */
/* What was written is believed to be there. */
#include "pl_wrong.h"

static uint8_t said[64][256];
static bool was_said[64][256];

static bool configuration(unsigned reg)
{
    return reg >= BQ76PL536_GROUP3_FIRST || reg == BQ76PL536_ADC_CONTROL || reg == BQ76PL536_IO_CONTROL;
}

static pl_deed say(uint8_t device, uint8_t reg, uint8_t *value)
{
    for (unsigned d = 0; d < 64; d++) {
        if (d == device || device == BQ76PL536_ADDR_BROADCAST) {
            said[d][reg] = *value;
            was_said[d][reg] = configuration(reg);
        }
    }
    return PL_AS_IT_IS;
}

static pl_deed hear(uint8_t device, uint8_t reg, uint8_t n, uint8_t *data, bool good)
{
    pl_deed deed = PL_AS_IT_IS;
    for (unsigned i = 0; good && i < n; i++) {
        if (was_said[device][reg + i]) {
            data[i] = said[device][reg + i];
            deed = PL_CHANGED;
        }
    }
    return deed;
}

const pl_wrong wrong = {.say = say, .hear = hear};
