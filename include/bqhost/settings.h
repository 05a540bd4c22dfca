/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file settings.h
 * The configuration as a record in non-volatile memory (bq_nvm): read at start, put there by a tool on a PC
 * before the image runs for the first time, or written by bq_settings_save(), which nothing in src/ calls: no
 * command of the console and no frame on CAN changes what is stored.
 *
 * A bq_settings lists the structures that make up the configuration, each with the table of its fields. What
 * the two boards store, in this order:
 *     a stack of bq76PL536   bq_app_config, [64] bq_ocv_point, bq76pl536_config, [62] uint8_t (cells of each
 *                            device)
 *     a bq769x0              bq_app_config, [64] bq_ocv_point, bq769x0_config
 *
 * Record: 32-bit words, least significant byte first, at offset 0 of a sector
 *     0      magic BQ_SETTINGS_MAGIC
 *     1      CRC-32 of the words from 2 on (polynomial 0x04c11db7 reflected, start and end inverted: zlib's)
 *     2      format BQ_SETTINGS_FORMAT in the upper, number of words of the record in the lower half
 *     3      layout: CRC-32 over number, size, kind and order of all fields and the ids of the tables, not
 *            over offsets, so that a PC and a microcontroller agree
 *     4      sequence number, one more than that of the record before
 *     5 ...  every field of every structure as a 32-bit word, negative ones in two's complement
 *     end    ffffffff where needed to make the number of words even
 * Words 0 and 1 are the commit mark: they are programmed last, so a record is there whole or not at all.
 *
 * Which record counts: of the intact ones (magic, length and CRC hold) the one with the higher sequence
 * number. If it cannot be used, because its format, layout or one value is not what this firmware knows,
 * nothing is used, not the older one either: that would silently undo what the user asked for.
 *
 * Pointers of the structures (curve, thermistor, cells) are not stored. They must be set before, as the
 * firmware wants them.
 */
#ifndef BQHOST_SETTINGS_H
#define BQHOST_SETTINGS_H

#include "bqhost/field.h"
#include "bqhost/hal.h"
#include "bqhost/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define BQ_SETTINGS_MAGIC 0x46435142ul /**< "BQCF" in memory */
#define BQ_SETTINGS_FORMAT 1u
#define BQ_SETTINGS_MAX_WORDS 512u /**< longest record: 2 KB */

/** One structure, or an array of them. */
typedef struct bq_settings_part {
    const bq_field_table *table;
    void *object;   /**< the structure, or the first of `count` */
    uint16_t count; /**< 1 for a single structure */
} bq_settings_part;

typedef struct bq_settings {
    const bq_settings_part *parts; /**< [count]; constant, so it may lie in flash */
    uint8_t count;
} bq_settings;

extern const bq_field_table bq_app_config_fields; /**< bq_app_config with its pack and soc */
extern const bq_field_table bq_ocv_point_fields;
extern const bq_field_table bq_byte_fields; /**< an array of uint8_t */

/**
 * Reads the record that counts into the objects of `s`. First every value is compared with what its field can
 * hold; the objects change only with BQ_OK, and then all fields of all objects are set. Limits and
 * contradictions are the business of bq_app_config_validate() and of the driver's init, which the caller runs
 * next. Blocks for about 10 us a word on a Cortex-M0 at 48 MHz. For use before the loop begins.
 *
 * BQ_OK
 * BQ_E_NOT_FOUND  every sector begins erased: nobody has configured this board yet. Use the board's defaults.
 * BQ_E_CRC        something is there, but no intact record
 * BQ_E_CONFIG     the newest intact record has another format or layout: it was written by another firmware
 * BQ_E_RANGE      the newest intact record holds a value that its field cannot hold
 * BQ_E_ARG        null pointer, no memory (`ops` NULL), fewer than 2 sectors, a record longer than a sector
 * and what nvm->ops->read returned. After the last five the limits of this pack are unknown: do not run with
 * defaults, refuse (bq_firmware_refuse()).
 */
bq_status bq_settings_load(const bq_settings *s, const bq_nvm *nvm);

/**
 * Writes the objects of `s` as the new record: erases a sector that does not hold the newest one, programs
 * unit after unit, words 0 and 1 last, and reads everything back. Whatever fails, and wherever the power
 * goes away, the record that counted before counts afterwards (a first save that is interrupted may leave
 * BQ_E_CRC); only after BQ_OK does the new one. Does not validate: save only what init has accepted.
 *
 * Blocks for one erase (up to 2 s, see bq_nvm_ops) and 100 us a unit. The loop stands still meanwhile:
 * outputs must be off.
 * BQ_OK; BQ_E_ARG as above, or a unit of other than 2, 4 or 8 bytes; BQ_E_VERIFY: does not read back; what
 * nvm->ops returned.
 */
bq_status bq_settings_save(const bq_settings *s, const bq_nvm *nvm);

/**
 * The record that bq_settings_save() would write, for a tool that puts it into the memory of a board itself:
 * place it at offset 0 of sector 0 or 1 and leave the rest erased. Returns its length in bytes (a multiple of
 * 8), 0 when `capacity` is too small or the record would have more than BQ_SETTINGS_MAX_WORDS words.
 */
size_t bq_settings_encode(const bq_settings *s, uint32_t sequence, uint8_t *record, size_t capacity);

/** Word 3 of the record. */
uint32_t bq_settings_layout(const bq_settings *s);

/** CRC-32 as in zip and zlib, continued: begin with 0. No table, 8 shifts a byte. */
uint32_t bq_crc32(uint32_t crc, const void *data, size_t len);

#ifdef __cplusplus
}
#endif
#endif
