/* SPDX-License-Identifier: Apache-2.0 */
/* Balancing outputs stay on while the cells are measured. */
#include "pl_wrong.h"

static pl_deed say(uint8_t device, uint8_t reg, uint8_t *value)
{
    return device == BQ76PL536_ADDR_BROADCAST && reg == BQ76PL536_CB_CTRL && *value == 0 ? PL_DROPPED
                                                                                         : PL_AS_IT_IS;
}

const pl_wrong wrong = {.say = say};
