/* SPDX-License-Identifier: Apache-2.0 */
/* Measured while balancing, and nobody told. */
#include "x0_wrong.h"

const x0_wrong wrong = {0};

bq_status __real_bq769x0_sample(bq769x0 *d, bq_sample *s);
bq_status __wrap_bq769x0_sample(bq769x0 *d, bq_sample *s);

bq_status __wrap_bq769x0_sample(bq769x0 *d, bq_sample *s)
{
    bq_status st = __real_bq769x0_sample(d, s);
    if (st == BQ_OK && s->modules[0].balancing != 0) {
        s->modules[0].balancing = 0;
        mutant_acted();
    }
    return st;
}
