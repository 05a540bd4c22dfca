/* SPDX-License-Identifier: Apache-2.0 */
#include "bqhost/bq76pl536_packet.h"
#include "bqhost/crc8.h"

bq_status bq76pl536_packet_program(uint8_t *tx, size_t room, uint8_t device, bool crc, size_t *length)
{
    if (tx == NULL || length == NULL || room < BQ76PL536_WRITE_BYTES(crc)) {
        return BQ_E_ARG;
    }
    if (device < BQ76PL536_ADDR_FIRST || device > BQ76PL536_ADDR_LAST) {
        return BQ_E_ARG;
    }
    tx[0] = (uint8_t)((unsigned)device << 1 | 1u);
    tx[1] = BQ76PL536_E_EN;
    tx[2] = BQ76PL536_E_EN_PROGRAM;
    if (crc) {
        tx[3] = bq_crc8(0, tx, 3);
    }
    *length = BQ76PL536_WRITE_BYTES(crc);
    return BQ_OK;
}
