/* SPDX-License-Identifier: Apache-2.0 */
/* Neighbours judged by the numbers of the cells, in fives, whatever inputs they are on. */
#include "adjacency.h"

/* The bits of `mask` that are set in `in_use`, closed up. */
static uint16_t closed_up(uint16_t in_use, uint16_t mask)
{
    unsigned out = 0, n = 0;
    for (unsigned i = 0; i < 15; i++) {
        if ((in_use >> i & 1) != 0) {
            out |= (mask >> i & 1u) << n++;
        }
    }
    return (uint16_t)out;
}

static bool legal(uint16_t in_use, uint16_t mask, bool across_groups)
{
    return bq769x0_balance_legal(closed_up(in_use, in_use), closed_up(in_use, mask), across_groups);
}
