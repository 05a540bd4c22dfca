/* SPDX-License-Identifier: Apache-2.0 */
/* Recovery thresholds that were never configured are accepted. */
#include "x0_wrong.h"

static void config(bq769x0_config *c)
{
    c->ov_recover_mv = c->ov_recover_mv != 0 ? c->ov_recover_mv : (uint16_t)(c->ov_mv - 1u);
    c->uv_recover_mv = c->uv_recover_mv != 0 ? c->uv_recover_mv : (uint16_t)(c->uv_mv + 1u);
}

const x0_wrong wrong = {.config = config};
