/* SPDX-License-Identifier: Apache-2.0 */
/* A failed update is begun again, for ever. */
#include "x0_wrong.h"

const x0_wrong wrong = {0};

bq_status __real_bq769x0_poll(bq769x0 *d, uint32_t *wait_us);
bq_status __wrap_bq769x0_poll(bq769x0 *d, uint32_t *wait_us);

bq_status __wrap_bq769x0_poll(bq769x0 *d, uint32_t *wait_us)
{
    bq_status st = __real_bq769x0_poll(d, wait_us);
    if (st >= 0 || bq769x0_begin_scan(d) != BQ_OK) {
        return st;
    }
    mutant_acted();
    return BQ_PENDING;
}
