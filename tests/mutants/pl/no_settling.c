/* SPDX-License-Identifier: Apache-2.0 */
/* Measured at once after the balancing outputs went off. */
#include "pl_wrong.h"

static void config(bq76pl536_config *c)
{
    c->balance_settle_ms = 1;
}

const pl_wrong wrong = {.config = config};
