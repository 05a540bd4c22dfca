/* SPDX-License-Identifier: Apache-2.0 */
/* For variants that judge neighbours wrongly: cells are chosen anew by legal(), and the driver reads back
 * what it meant. */
#ifndef ADJACENCY_H
#define ADJACENCY_H

#include "x0_wrong.h"

/* The variant's judgement of a set of inputs. */
static bool legal(uint16_t in_use, uint16_t mask, bool across_groups);

static uint32_t asked;
static uint8_t meant[3];

bq_status __real_bq769x0_begin_apply(bq769x0 *d, const bq_action *action);
bq_status __wrap_bq769x0_begin_apply(bq769x0 *d, const bq_action *action);

bq_status __wrap_bq769x0_begin_apply(bq769x0 *d, const bq_action *action)
{
    asked = action->balance[0];
    return __real_bq769x0_begin_apply(d, action);
}

static bool say(uint8_t reg, unsigned n, uint8_t *data)
{
    const bq769x0_config *c = x0_wrong_config();
    unsigned chosen = 0, cell = 0;
    if (reg != BQ769X0_CELLBAL1 || n != 3) {
        return false;
    }
    for (unsigned i = 0; i < 15; i++) {
        if ((c->wiring >> i & 1) != 0 && (asked >> cell++ & 1) != 0 &&
            legal(c->wiring, (uint16_t)(chosen | 1u << i), c->balance_across_groups)) {
            chosen |= 1u << i;
        }
    }
    for (unsigned g = 0; g < 3; g++) {
        meant[g] = data[g];
        data[g] = chosen >> (5 * g) & 0x1f;
    }
    return true;
}

static bool hear(uint8_t reg, unsigned n, uint8_t *data, unsigned bad)
{
    if (reg != BQ769X0_CELLBAL1 || bad < n) {
        return false;
    }
    for (unsigned g = 0; g < 3; g++) {
        data[g] = meant[g];
    }
    return true;
}

const x0_wrong wrong = {.say = say, .hear = hear};

#endif
