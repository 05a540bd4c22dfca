/* SPDX-License-Identifier: Apache-2.0 */
/* The CRC byte taken for the last byte of the data. */
#include "pl_wrong.h"

static pl_deed hear(uint8_t device, uint8_t reg, uint8_t n, uint8_t *data, bool good)
{
    (void)device;
    (void)reg;
    for (unsigned i = 0; good && i < n; i++) {
        data[i] = data[i + 1];
    }
    return good ? PL_CHANGED : PL_AS_IT_IS;
}

const pl_wrong wrong = {.hear = hear};
