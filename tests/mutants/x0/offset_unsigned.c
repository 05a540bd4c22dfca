/* SPDX-License-Identifier: Apache-2.0 */
/* ADCOFFSET taken as unsigned: -20 mV makes a cell read 256 mV too much. */
#include "x0_wrong.h"

const x0_wrong wrong = {0};

bq_status __real_bq769x0_sample(bq769x0 *d, bq_sample *s);
bq_status __wrap_bq769x0_sample(bq769x0 *d, bq_sample *s);

bq_status __wrap_bq769x0_sample(bq769x0 *d, bq_sample *s)
{
    bq_status st = __real_bq769x0_sample(d, s);
    for (unsigned i = 0; st == BQ_OK && i < s->cell_count && bq769x0_get_achieved(d)->trim.offset_mv < 0;
         i++) {
        s->cells[i].mv = (uint16_t)(s->cells[i].mv + 256u);
        mutant_acted();
    }
    return st;
}
