/* SPDX-License-Identifier: Apache-2.0 */
/* The third damaged answer in a row sends the part to SHIP. */
#include "x0_wrong.h"

static unsigned in_a_row;

static bool hear(uint8_t reg, unsigned n, uint8_t *data, unsigned bad)
{
    (void)reg;
    (void)data;
    in_a_row = bad < n ? in_a_row + 1 : 0;
    if (in_a_row >= 3) {
        in_a_row = 0;
        x0_wrong_also_write(BQ769X0_SYS_CTRL1, 0x1a); /* the last one in is sent first */
        x0_wrong_also_write(BQ769X0_SYS_CTRL1, 0x19);
    }
    return false;
}

const x0_wrong wrong = {.hear = hear};
