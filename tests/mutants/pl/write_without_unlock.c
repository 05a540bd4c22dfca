/* SPDX-License-Identifier: Apache-2.0 */
/* Protected registers written without the key directly before. */
#include "pl_wrong.h"

static pl_deed say(uint8_t device, uint8_t reg, uint8_t *value)
{
    (void)device;
    return reg == BQ76PL536_SHDW_CTRL && *value == BQ76PL536_SHDW_KEY ? PL_DROPPED : PL_AS_IT_IS;
}

const pl_wrong wrong = {.say = say};
