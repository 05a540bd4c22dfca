/* SPDX-License-Identifier: Apache-2.0 */
/* Which cells are bled where the power of all together is no matter (X0-SEQ-39). */
#include "x0_internal.h"

bq_status bq769x0_begin_outputs(bq769x0 *d, unsigned fets, unsigned cells)
{
    unsigned chosen = cells & 0x5555u << (d->now_ms >> X0_TURN_BITS & 1u);
    return x0_begin_outputs(d, fets & BQ769X0_CTRL2_FETS,
                            chosen | (cells & ~x0_beside(chosen, d->known.apart)));
}
