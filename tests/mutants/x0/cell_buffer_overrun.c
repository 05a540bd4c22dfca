/* SPDX-License-Identifier: Apache-2.0 */
/* Fifteen cells written whatever room there is. */
#include "x0_wrong.h"

const x0_wrong wrong = {0};

bq_status __real_bq769x0_sample(bq769x0 *d, bq_sample *s);
bq_status __wrap_bq769x0_sample(bq769x0 *d, bq_sample *s);

bq_status __wrap_bq769x0_sample(bq769x0 *d, bq_sample *s)
{
    uint16_t room = s->cell_capacity;
    bq_status st;
    if (room < 15) {
        mutant_acted();
    }
    s->cell_capacity = 15;
    st = __real_bq769x0_sample(d, s);
    s->cell_capacity = room;
    return st;
}
