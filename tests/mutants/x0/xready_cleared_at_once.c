/* SPDX-License-Identifier: Apache-2.0 */
/* DEVICE_XREADY cleared as soon as it is seen. */
#include "x0_wrong.h"

static bool hear(uint8_t reg, unsigned n, uint8_t *data, unsigned bad)
{
    if (reg == BQ769X0_SYS_STAT && bad == n && (data[0] & BQ769X0_STAT_XREADY) != 0) {
        x0_wrong_also_write(BQ769X0_SYS_STAT, BQ769X0_STAT_XREADY);
    }
    return false;
}

const x0_wrong wrong = {.hear = hear};
