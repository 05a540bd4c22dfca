/* SPDX-License-Identifier: Apache-2.0 */
/* No CRC is checked. */
#include "pl_wrong.h"

static pl_deed hear(uint8_t device, uint8_t reg, uint8_t n, uint8_t *data, bool good)
{
    (void)device;
    (void)reg;
    (void)n;
    (void)data;
    return good ? PL_AS_IT_IS : PL_CHANGED;
}

const pl_wrong wrong = {.hear = hear};
