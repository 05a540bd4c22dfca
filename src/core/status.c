/* SPDX-License-Identifier: Apache-2.0 */
#include "bqhost/status.h"

const char *bq_status_name(bq_status status)
{
    switch (status) {
    case BQ_OK: return "BQ_OK";
    case BQ_PENDING: return "BQ_PENDING";
    case BQ_E_ARG: return "BQ_E_ARG";
    case BQ_E_STATE: return "BQ_E_STATE";
    case BQ_E_BUSY: return "BQ_E_BUSY";
    case BQ_E_UNSUPPORTED: return "BQ_E_UNSUPPORTED";
    case BQ_E_RANGE: return "BQ_E_RANGE";
    case BQ_E_NO_CODE: return "BQ_E_NO_CODE";
    case BQ_E_COV_CUV: return "BQ_E_COV_CUV";
    case BQ_E_DEVICES: return "BQ_E_DEVICES";
    case BQ_E_CELLS: return "BQ_E_CELLS";
    case BQ_E_UNLATCHED: return "BQ_E_UNLATCHED";
    case BQ_E_CLOCK: return "BQ_E_CLOCK";
    case BQ_E_CONFIG: return "BQ_E_CONFIG";
    case BQ_E_BUS: return "BQ_E_BUS";
    case BQ_E_TIMEOUT: return "BQ_E_TIMEOUT";
    case BQ_E_NO_ANSWER: return "BQ_E_NO_ANSWER";
    case BQ_E_CRC: return "BQ_E_CRC";
    case BQ_E_IMPLAUSIBLE: return "BQ_E_IMPLAUSIBLE";
    case BQ_E_NACK: return "BQ_E_NACK";
    case BQ_E_ARBITRATION: return "BQ_E_ARBITRATION";
    case BQ_E_VERIFY: return "BQ_E_VERIFY";
    case BQ_E_NOT_FOUND: return "BQ_E_NOT_FOUND";
    case BQ_E_EXTRA_DEVICE: return "BQ_E_EXTRA_DEVICE";
    case BQ_E_LOCKED_UP: return "BQ_E_LOCKED_UP";
    case BQ_E_DEFECTIVE: return "BQ_E_DEFECTIVE";
    case BQ_E_LINE_STUCK: return "BQ_E_LINE_STUCK";
    case BQ_E_CHAIN_BROKEN: return "BQ_E_CHAIN_BROKEN";
    case BQ_E_PERSISTS: return "BQ_E_PERSISTS";
    case BQ_E_NOT_BLANK: return "BQ_E_NOT_BLANK";
    case BQ_E_VOLTAGE: return "BQ_E_VOLTAGE";
    case BQ_E_STALE: return "BQ_E_STALE";
    case BQ_E_CRC_OFF: return "BQ_E_CRC_OFF";
    }
    return "BQ_E_?";
}
