/* SPDX-License-Identifier: Apache-2.0 */
#include "bqhost/bq76pl536_packet.h"
#include "bqhost/crc8.h"

bq_status bq76pl536_packet_read(uint8_t *tx, size_t room, uint8_t device, uint8_t first, uint8_t count,
                                bool crc, size_t *length)
{
    if (tx == NULL || length == NULL || device > BQ76PL536_ADDR_LAST) {
        return BQ_E_ARG;
    }
    if (count == 0u || (unsigned)first + count - 1u > BQ76PL536_REG_LAST) {
        return BQ_E_ARG;
    }
    size_t bytes = BQ76PL536_READ_BYTES((size_t)count, crc);
    if (room < bytes) {
        return BQ_E_ARG;
    }
    tx[0] = (uint8_t)(device << 1);
    tx[1] = first;
    tx[2] = count;
    for (size_t i = BQ76PL536_READ_HEADER; i < bytes; i++) {
        tx[i] = 0;
    }
    *length = bytes;
    return BQ_OK;
}

bq_status bq76pl536_packet_write(uint8_t *tx, size_t room, uint8_t device, uint8_t reg, uint8_t value,
                                 bool crc, size_t *length)
{
    if (tx == NULL || length == NULL || room < BQ76PL536_WRITE_BYTES(crc) ||
        device > BQ76PL536_ADDR_BROADCAST) {
        return BQ_E_ARG;
    }
    if (reg == BQ76PL536_ADDRESS_CONTROL && device != BQ76PL536_ADDR_NONE) {
        return BQ_E_ARG;
    }
    if (reg == BQ76PL536_E_EN && device == BQ76PL536_ADDR_BROADCAST) {
        return BQ_E_ARG;
    }
    bq_status legal = bq76pl536_write_check(reg, value);
    if (legal != BQ_OK) {
        return legal;
    }
    tx[0] = (uint8_t)((unsigned)device << 1 | 1u);
    tx[1] = reg;
    tx[2] = value;
    if (crc) {
        tx[3] = bq_crc8(0, tx, 3);
    }
    *length = BQ76PL536_WRITE_BYTES(crc);
    return BQ_OK;
}

static bool all_bytes(const uint8_t *bytes, size_t n, uint8_t value)
{
    for (size_t i = 0; i < n; i++) {
        if (bytes[i] != value) {
            return false;
        }
    }
    return true;
}

static bool dead(const uint8_t *bytes, size_t n)
{
    return (bytes[0] == 0x00u || bytes[0] == 0xffu) && all_bytes(bytes, n, bytes[0]);
}

static bool covers(const uint8_t *tx, uint8_t reg)
{
    return reg >= tx[1] && (unsigned)reg - tx[1] < tx[2];
}

/* Without a CRC: can the registers asked for truly all hold this value (0x00 or 0xff)? */
static bool can_hold(const uint8_t *tx, uint8_t value)
{
    if (value == 0u) {
        return tx[0] == 0u || !(covers(tx, BQ76PL536_DEVICE_STATUS) || covers(tx, BQ76PL536_ADDRESS_CONTROL));
    }
    return tx[1] >= BQ76PL536_CONFIG_OTT;
}

bq_status bq76pl536_packet_check(const uint8_t *tx, const uint8_t *rx, size_t length, bool crc)
{
    if (tx == NULL || rx == NULL || length < BQ76PL536_READ_BYTES(1u, crc) ||
        length != BQ76PL536_READ_BYTES((size_t)tx[2], crc)) {
        return BQ_E_ARG;
    }
    const uint8_t *data = rx + BQ76PL536_READ_HEADER;
    if (dead(data, length - BQ76PL536_READ_HEADER) && (crc || !can_hold(tx, data[0]))) {
        return BQ_E_NO_ANSWER;
    }
    if (crc && bq_crc8(bq_crc8(0, tx, BQ76PL536_READ_HEADER), data, tx[2]) != data[tx[2]]) {
        return BQ_E_CRC;
    }
    return BQ_OK;
}

bool bq76pl536_packet_ambiguous(uint8_t device, uint8_t first, uint8_t count)
{
    static const uint8_t high = 0xff;
    const uint8_t header[BQ76PL536_READ_HEADER] = {(uint8_t)(device << 1), first, count};
    uint8_t zeros = bq_crc8(0, header, sizeof header);
    uint8_t ones = zeros;
    for (unsigned i = 0; i < count; i++) {
        ones = bq_crc8(ones, &high, 1);
    }
    return zeros == 0u || ones == 0xffu;
}

bq_status bq76pl536_burst_check(const uint8_t *data)
{
    if (data == NULL) {
        return BQ_E_ARG;
    }
    if (dead(data, BQ76PL536_BURST_COUNT)) {
        return BQ_E_NO_ANSWER;
    }
    unsigned wrong = (unsigned)(data[0] ^ BQ76PL536_DS_AR) & (BQ76PL536_DS_AR | BQ76PL536_DS_ZERO);
    for (unsigned i = 1; i < BQ76PL536_BURST_COUNT; i += 2u) {
        wrong |= data[i] & 0xc0u;
    }
    return wrong == 0u ? BQ_OK : BQ_E_IMPLAUSIBLE;
}
