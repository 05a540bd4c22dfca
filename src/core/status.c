/* SPDX-License-Identifier: Apache-2.0 */
#include "bqhost/status.h"
#include <stdint.h>

/* From BQ_PENDING downwards, one after the other; empty where no status has the number. */
static const char names[] =
    "BQ_PENDING\0BQ_OK\0"
    "BQ_E_ARG\0BQ_E_STATE\0BQ_E_BUSY\0BQ_E_UNSUPPORTED\0\0\0\0\0\0" /* -1 to -9 */
    "BQ_E_RANGE\0BQ_E_NO_CODE\0BQ_E_COV_CUV\0BQ_E_DEVICES\0BQ_E_CELLS\0BQ_E_UNLATCHED\0BQ_E_CLOCK\0"
    "BQ_E_CONFIG\0\0\0" /* to -19 */
    "BQ_E_BUS\0BQ_E_TIMEOUT\0BQ_E_NO_ANSWER\0BQ_E_CRC\0BQ_E_IMPLAUSIBLE\0BQ_E_NACK\0BQ_E_ARBITRATION\0"
    "\0\0\0" /* to -29 */
    "BQ_E_VERIFY\0BQ_E_NOT_FOUND\0BQ_E_EXTRA_DEVICE\0BQ_E_LOCKED_UP\0BQ_E_DEFECTIVE\0BQ_E_LINE_STUCK\0"
    "BQ_E_CHAIN_BROKEN\0BQ_E_PERSISTS\0BQ_E_NOT_BLANK\0BQ_E_VOLTAGE\0BQ_E_STALE\0BQ_E_CRC_OFF";

const char *bq_status_name(bq_status status)
{
    const char *name = names;
    uint32_t skip = (uint32_t)BQ_PENDING - (uint32_t)(int32_t)status; /* large for what is above BQ_PENDING */

    if (skip > (uint32_t)((int32_t)BQ_PENDING - (int32_t)BQ_E_CRC_OFF)) {
        return "BQ_E_?";
    }
    for (; skip > 0u; skip--) {
        while (*name++ != '\0') {
        }
    }
    return *name != '\0' ? name : "BQ_E_?";
}
