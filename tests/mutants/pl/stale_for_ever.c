/* SPDX-License-Identifier: Apache-2.0 */
/* A device that is lost keeps its values as if they were fresh. */
#include "pl_wrong.h"

const pl_wrong wrong = {0};

bq_status __real_bq76pl536_sample(bq76pl536 *d, bq_sample *s);
bq_status __wrap_bq76pl536_sample(bq76pl536 *d, bq_sample *s);

bq_status __wrap_bq76pl536_sample(bq76pl536 *d, bq_sample *s)
{
    bq_status st = __real_bq76pl536_sample(d, s);
    for (unsigned i = 0; st == BQ_OK && i < s->cell_count; i++) {
        if (s->cells[i].quality == BQ_Q_COMM) {
            s->cells[i].quality = BQ_Q_VALID;
            s->modules[s->cells[i].module].age_ms = 0;
            mutant_acted();
        }
    }
    return st;
}
