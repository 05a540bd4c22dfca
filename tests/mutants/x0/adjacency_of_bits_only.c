/* SPDX-License-Identifier: Apache-2.0 */
/* Neighbours judged by the bits of the register: a shorted input between them separates nothing. */
#include "x0_wrong.h"

const x0_wrong wrong = {0};

bool __real_bq769x0_balance_legal(uint16_t in_use, uint16_t mask, bool across_groups);
bool __wrap_bq769x0_balance_legal(uint16_t in_use, uint16_t mask, bool across_groups);

bool __wrap_bq769x0_balance_legal(uint16_t in_use, uint16_t mask, bool across_groups)
{
    mutant_acted();
    return (mask & ~in_use) == 0 && __real_bq769x0_balance_legal(0x7fff, mask, across_groups);
}
