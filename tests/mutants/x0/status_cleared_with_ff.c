/* SPDX-License-Identifier: Apache-2.0 */
/* SYS_STAT cleared with 0xff: flags that were set in between are lost. */
#include "x0_wrong.h"

static bool say(uint8_t reg, unsigned n, uint8_t *data)
{
    (void)n;
    data[0] = reg == BQ769X0_SYS_STAT ? 0xff : data[0];
    return reg == BQ769X0_SYS_STAT;
}

const x0_wrong wrong = {.say = say};
