/* SPDX-License-Identifier: Apache-2.0 */
/* The voltage of the pack in 16 bits: it wraps at 65.5 V. */
#include "bqhost/pack.h"
#include "pl_wrong.h"

const pl_wrong wrong = {0};

void __real_bq_pack_step(bq_pack *p, const bq_sample *s, const bq_pack_input *in, uint32_t now_ms,
                         bq_action *a);
void __wrap_bq_pack_step(bq_pack *p, const bq_sample *s, const bq_pack_input *in, uint32_t now_ms,
                         bq_action *a);

void __wrap_bq_pack_step(bq_pack *p, const bq_sample *s, const bq_pack_input *in, uint32_t now_ms,
                         bq_action *a)
{
    __real_bq_pack_step(p, s, in, now_ms, a);
    if (p->summary.pack_mv > UINT16_MAX) {
        p->summary.pack_mv &= UINT16_MAX;
        mutant_acted();
    }
}
