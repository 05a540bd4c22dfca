/* SPDX-License-Identifier: Apache-2.0 */
/* No recovery threshold for UV: it recovers at once. */
#include "x0_wrong.h"

static void config(bq769x0_config *c)
{
    c->uv_recover_mv = (uint16_t)(c->uv_mv + 1u);
}

const x0_wrong wrong = {.config = config};
