/* SPDX-License-Identifier: Apache-2.0 */
/* A threshold encoded through a float, cut off: many codes come out one step low. */
#include "pl_wrong.h"

const pl_wrong wrong = {0};

bq_status __real_bq76pl536_cov_code(uint32_t mv, uint8_t *code);
bq_status __wrap_bq76pl536_cov_code(uint32_t mv, uint8_t *code);

bq_status __wrap_bq76pl536_cov_code(uint32_t mv, uint8_t *code)
{
    bq_status st = __real_bq76pl536_cov_code(mv, code);
    if (st == BQ_OK) {
        float volts = (float)mv / 1000.0f;
        *code = (uint8_t)((volts - 2.0f) / 0.05f);
        mutant_acted();
    }
    return st;
}
