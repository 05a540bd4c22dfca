/* SPDX-License-Identifier: Apache-2.0 */
/* Neighbours judged by the bits of the register: a shorted input between them separates nothing. */
#include "adjacency.h"

static bool legal(uint16_t in_use, uint16_t mask, bool across_groups)
{
    return (mask & ~in_use) == 0 && bq769x0_balance_legal(0x7fff, mask, across_groups);
}
