/* SPDX-License-Identifier: Apache-2.0 */
/* A delay in ms compared with a table in s: every delay becomes the longest. */
#include "x0_wrong.h"

static void config(bq769x0_config *c)
{
    c->ov_delay_s = c->uv_delay_s = 255;
}

const x0_wrong wrong = {.config = config};
