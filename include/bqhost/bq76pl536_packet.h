/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file bq76pl536_packet.h
 * SPI packets of the bq76PL536: building requests and judging replies. Pure functions: no bus, no state,
 * nothing blocks.
 *
 * Every packet is transferred full duplex with chip select held; `tx` is what the host sends, `rx` what came
 * back, both of the same length. Packets carry a CRC byte unless the stack runs with CRC_DIS (`crc` = false).
 */
#ifndef BQHOST_BQ76PL536_PACKET_H
#define BQHOST_BQ76PL536_PACKET_H

#include "bqhost/bq76pl536_regs.h"
#include "bqhost/status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Bytes before the data of a read: address, first register, count (PL-PKT-04). */
#define BQ76PL536_READ_HEADER 3u
/** Length of a read packet of `count` registers. */
#define BQ76PL536_READ_BYTES(count, crc) (BQ76PL536_READ_HEADER + (count) + ((crc) ? 1u : 0u))
/** Length of a write packet (PL-PKT-03). */
#define BQ76PL536_WRITE_BYTES(crc) (3u + ((crc) ? 1u : 0u))
/** Room for the longest packet: all registers in one read. */
#define BQ76PL536_PACKET_MAX BQ76PL536_READ_BYTES(BQ76PL536_REG_LAST + 1u, true)

/** The measurement burst: status, GPAI or brick, six cells, two temperatures in one packet of 23 bytes
 * (PL-SEQ-06-04). */
#define BQ76PL536_BURST_FIRST 0x00u
#define BQ76PL536_BURST_COUNT 19u
#define BQ76PL536_BURST_WORDS 9u /**< words of the burst: GPAI, cells 1..6, temperatures 1, 2 */
#define BQ76PL536_BURST_GPAI 0u  /**< index of a word in the burst, for bq76pl536_burst_word() */
#define BQ76PL536_BURST_CELL1 1u
#define BQ76PL536_BURST_TS1 7u
#define BQ76PL536_BURST_TS2 8u

/**
 * Builds a read of `count` registers from `first` at `device` (PL-PKT-01, -04, -06): header and filler bytes
 * 0x00. `tx` has room for `room` bytes (BQ76PL536_PACKET_MAX always suffices); `*length` receives the bytes to
 * transfer. Reserved registers inside the range are legal (PL-PKT-08).
 * BQ_OK, or BQ_E_ARG with nothing written: null pointer, no room, `device` above 0x3e (a broadcast cannot be
 * read, PL-BCAST-02), `count` 0, or first + count - 1 beyond 0x4b (PL-PKT-14).
 */
bq_status bq76pl536_packet_read(uint8_t *tx, size_t room, uint8_t device, uint8_t first, uint8_t count,
                                bool crc, size_t *length);

/**
 * Builds a write of one register (PL-PKT-03, PL-CRC-02). `device` 0x3f is the broadcast.
 * BQ_OK, or with nothing written:
 * BQ_E_ARG: null pointer, no room, `device` above 0x3f, a reserved or read-only register, ADDRESS_CONTROL at
 * any device but 0x00 (PL-ADR-05, PL-ADR-15), E_EN by broadcast;
 * BQ_E_RANGE: a value that bq76pl536_write_check() refuses.
 * The key of a group 3 register is a packet of its own and not this function's business.
 */
bq_status bq76pl536_packet_write(uint8_t *tx, size_t room, uint8_t device, uint8_t reg, uint8_t value,
                                 bool crc, size_t *length);

/**
 * Builds the command that programs the EPROM of one device, once and for ever (PL-OTP-09): E_EN = 0x91.
 * An object of its own, so that a firmware that never names it does not contain it.
 * BQ_OK, or BQ_E_ARG with nothing written: null pointer, no room, `device` not in 0x01..0x3e.
 */
bq_status bq76pl536_packet_program(uint8_t *tx, size_t room, uint8_t device, bool crc, size_t *length);

/**
 * Judges the reply to a read built by bq76pl536_packet_read(). `tx` and `rx` are the packet as sent and
 * received, `length` its length. The data is at rx + BQ76PL536_READ_HEADER; whatever came before it is
 * ignored (PL-SPI-09).
 * With CRC: the CRC over the header as sent and the data must match, so that a damaged request is found too
 * (PL-CRC-07).
 * BQ_OK: the data may be used.
 * BQ_E_NO_ANSWER: all data (and CRC) bytes are 0x00 or all are 0xff, even if the CRC happens to match
 * (PL-CRC-12, PL-CRC-13).
 *   Without CRC only where the range cannot truly read so.
 * BQ_E_CRC: anything else that does not match: a damaged answer (or a damaged request).
 * BQ_E_ARG: null pointer, or `length` and the count in the header do not belong together.
 */
bq_status bq76pl536_packet_check(const uint8_t *tx, const uint8_t *rx, size_t length, bool crc);

/**
 * True if a dead bus (all 00 or all ff) would pass the CRC of this request, so that a truthful reply of only
 * 00 or ff is refused as "no answer" for ever. Ask for one register more or less then; the burst from 0x00
 * needs no such care.
 */
bool bq76pl536_packet_ambiguous(uint8_t device, uint8_t first, uint8_t count);

/**
 * Plausibility of the data of a measurement burst at an assigned address: `data` [BQ76PL536_BURST_COUNT] of
 * registers 0x00..0x12. The second line of defence behind the CRC (PL-CRC-13, PL-CRC-14, PL-VCELL-06).
 * BQ_OK; BQ_E_NO_ANSWER: all 00 or all ff; BQ_E_IMPLAUSIBLE: AR clear, status bit 4 set, or bits 15..14 of a
 * word set;
 * BQ_E_ARG: null pointer. DRDY, UVLO and the flags are for the driver to judge.
 */
bq_status bq76pl536_burst_check(const uint8_t *data);

/** A big-endian word, high byte first (PL-ADC-01). */
static inline uint16_t bq76pl536_word(const uint8_t *bytes)
{
    return (uint16_t)((unsigned)bytes[0] << 8 | bytes[1]);
}

/** Word `index` (BQ76PL536_BURST_..., 0..8) of the data of a burst. */
static inline uint16_t bq76pl536_burst_word(const uint8_t *data, uint8_t index)
{
    return bq76pl536_word(data + 1u + 2u * index);
}

#ifdef __cplusplus
}
#endif
#endif
