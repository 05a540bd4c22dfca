/* SPDX-License-Identifier: Apache-2.0 */
/* OV_TRIP and UV_TRIP without a range check: only the eight bits that fit are kept. */
#include "x0_wrong.h"

/* What a nominal part does with the bits that are left of a limit. */
static uint16_t left_of(uint16_t mv, unsigned base)
{
    unsigned code = base | ((mv * 1000u / 382u) & 0x0fffu);
    return (uint16_t)(code * 382u / 1000u);
}

static void config(bq769x0_config *c)
{
    c->ov_mv = left_of(c->ov_mv, 0x2000);
    c->uv_mv = left_of(c->uv_mv, 0x1000);
    c->ov_recover_mv = (uint16_t)(c->ov_mv - 100u);
    c->uv_recover_mv = (uint16_t)(c->uv_mv + 200u);
}

const x0_wrong wrong = {.config = config};
