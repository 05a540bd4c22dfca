/* SPDX-License-Identifier: Apache-2.0 */
/* Finding the record that counts, and reading it. */
#include "settings_internal.h"
#include <string.h>

#define POLYNOMIAL 0xedb88320ul /* 0x04c11db7 reflected */

uint32_t bq_crc32(uint32_t crc, const void *data, size_t len)
{
    const uint8_t *at = data;

    crc = ~crc;
    for (size_t i = 0; i < len; i++) {
        crc ^= at[i];
        for (unsigned bit = 0; bit < 8u; bit++) {
            crc = (crc >> 1) ^ ((crc & 1u) != 0u ? POLYNOMIAL : 0u);
        }
    }
    return ~crc;
}

/* ---- shape ----------------------------------------------------------------------------------- */

uint32_t bq_settings_layout(const bq_settings *s)
{
    uint32_t crc = 0;

    for (uint8_t i = 0; i < s->count; i++) {
        const bq_settings_part *p = &s->parts[i];
        uint8_t head[6] = {(uint8_t)p->table->id,    (uint8_t)(p->table->id >> 8),
                           (uint8_t)p->table->count, (uint8_t)(p->table->count >> 8),
                           (uint8_t)p->count,        (uint8_t)(p->count >> 8)};
        crc = bq_crc32(crc, head, sizeof head);
        for (uint16_t f = 0; f < p->table->count; f++) {
            const bq_field field = p->table->fields[f];
            const uint8_t shape[2] = {(uint8_t)bq_field_size(field), (uint8_t)bq_field_kind_of(field)};
            crc = bq_crc32(crc, shape, sizeof shape);
        }
    }
    return crc;
}

uint32_t settings_words(const bq_settings *s)
{
    uint32_t words = SETTINGS_HEAD;

    for (uint8_t i = 0; i < s->count; i++) {
        words += (uint32_t)s->parts[i].count * s->parts[i].table->count;
    }
    return (words + 1u) & ~(uint32_t)1;
}

bool settings_usable(const bq_settings *s, const bq_nvm *nvm)
{
    uint32_t words;

    if (s == NULL || s->parts == NULL || nvm == NULL || nvm->ops == NULL || nvm->sectors < 2u) {
        return false;
    }
    words = settings_words(s);
    return words <= BQ_SETTINGS_MAX_WORDS && words * 4u <= nvm->sector_bytes;
}

/* ---- finding --------------------------------------------------------------------------------- */

static bool erased(const uint8_t *block)
{
    for (unsigned i = 0; i < SETTINGS_BLOCK; i++) {
        if (block[i] != 0xffu) {
            return false;
        }
    }
    return true;
}

static bool length_ok(const bq_nvm *nvm, uint32_t words)
{
    return words >= SETTINGS_HEAD && words <= BQ_SETTINGS_MAX_WORDS && words % 2u == 0u &&
           words * 4u <= nvm->sector_bytes;
}

/* The blocks behind the commit mark; `crc` of them, words 2 to 4 into `r`. */
static bq_status read_body(const bq_nvm *nvm, settings_record *r, uint32_t *crc)
{
    uint8_t block[SETTINGS_BLOCK];
    uint32_t words = SETTINGS_HEAD + 1u;

    *crc = 0;
    for (uint32_t at = 2; at < words; at += 2u) {
        const bq_status status = nvm->ops->read(nvm->ctx, r->sector, at * 4u, block, sizeof block);
        if (status != BQ_OK) {
            return status;
        }
        *crc = bq_crc32(*crc, block, sizeof block);
        if (at == 2u) {
            r->format = settings_get32(block);
            r->layout = settings_get32(block + 4);
            words = r->format & 0xffffu;
            if (!length_ok(nvm, words)) {
                return BQ_E_CRC;
            }
        } else if (at == 4u) {
            r->sequence = settings_get32(block);
        }
    }
    return BQ_OK;
}

/* BQ_OK: intact. BQ_E_NOT_FOUND: begins erased. BQ_E_CRC: anything else. */
static bq_status read_record(const bq_nvm *nvm, settings_record *r)
{
    uint8_t mark[SETTINGS_BLOCK];
    uint32_t crc;
    bq_status status = nvm->ops->read(nvm->ctx, r->sector, 0, mark, sizeof mark);

    if (status != BQ_OK) {
        return status;
    }
    if (erased(mark)) {
        return BQ_E_NOT_FOUND;
    }
    if (settings_get32(mark) != BQ_SETTINGS_MAGIC) {
        return BQ_E_CRC;
    }
    status = read_body(nvm, r, &crc);
    if (status == BQ_OK && crc != settings_get32(mark + 4)) {
        status = BQ_E_CRC;
    }
    return status;
}

bq_status settings_newest(const bq_nvm *nvm, settings_record *newest)
{
    bq_status found = BQ_E_NOT_FOUND;

    for (uint8_t sector = 0; sector < nvm->sectors; sector++) {
        settings_record r = {sector, 0, 0, 0};
        const bq_status status = read_record(nvm, &r);
        if (status != BQ_OK && status != BQ_E_NOT_FOUND && status != BQ_E_CRC) {
            return status;
        }
        if (status == BQ_OK && (found != BQ_OK || (int32_t)(r.sequence - newest->sequence) > 0)) {
            *newest = r;
            found = BQ_OK;
        } else if (status == BQ_E_CRC && found != BQ_OK) {
            found = BQ_E_CRC;
        }
    }
    return found;
}

/* ---- reading --------------------------------------------------------------------------------- */

/* All values, compared with their fields or stored into them. */
static bq_status read_values(const bq_settings *s, const bq_nvm *nvm, uint8_t sector, bool store)
{
    settings_walk w = settings_begin(s);
    void *object = NULL;
    uint32_t offset = SETTINGS_HEAD * 4u;
    const bq_field *f = settings_next(&w, &object);

    for (; f != NULL; f = settings_next(&w, &object)) {
        uint8_t word[4];
        const bq_status status = nvm->ops->read(nvm->ctx, sector, offset, word, sizeof word);
        if (status != BQ_OK) {
            return status;
        }
        offset += 4u;
        if (store) {
            bq_field_store(*f, object, settings_get32(word));
        } else if (!settings_field_fits(*f, settings_get32(word))) {
            return BQ_E_RANGE;
        }
    }
    return BQ_OK;
}

bq_status bq_settings_load(const bq_settings *s, const bq_nvm *nvm)
{
    settings_record r = {0, 0, 0, 0};
    bq_status status;

    if (!settings_usable(s, nvm)) {
        return BQ_E_ARG;
    }
    status = settings_newest(nvm, &r);
    if (status != BQ_OK) {
        return status;
    }
    if (r.format != (BQ_SETTINGS_FORMAT << 16 | settings_words(s)) || r.layout != bq_settings_layout(s)) {
        return BQ_E_CONFIG;
    }
    status = read_values(s, nvm, r.sector, false);
    return status != BQ_OK ? status : read_values(s, nvm, r.sector, true);
}
