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

/* ---- reading --------------------------------------------------------------------------------- */

/* Reads a sector word by word. After a failure every word is 0 and the status stays. */
typedef struct reader {
    const bq_nvm *nvm;
    uint32_t at, crc; /* offset of the next word; of the words read */
    uint8_t sector;
    bq_status status;
} reader;

static uint32_t next_word(reader *r)
{
    uint8_t bytes[4] = {0, 0, 0, 0};

    if (r->status == BQ_OK) {
        r->status = r->nvm->ops->read(r->nvm->ctx, r->sector, r->at, bytes, sizeof bytes);
    }
    r->at += 4u;
    r->crc = bq_crc32(r->crc, bytes, sizeof bytes);
    return settings_get32(bytes);
}

/* BQ_OK: intact. BQ_E_NOT_FOUND: begins erased. BQ_E_CRC: anything else. */
static bq_status read_record(const bq_nvm *nvm, settings_record *record)
{
    reader r = {nvm, 0, 0, record->sector, BQ_OK};
    const uint32_t magic = next_word(&r), crc = next_word(&r);
    uint32_t bytes;

    r.crc = 0;
    record->format = next_word(&r);
    record->layout = next_word(&r);
    record->sequence = next_word(&r);
    bytes = (record->format & 0xffffu) * 4u;
    if (r.status != BQ_OK) {
        return r.status;
    }
    if ((magic & crc) == UINT32_MAX) {
        return BQ_E_NOT_FOUND;
    }
    if (magic != BQ_SETTINGS_MAGIC || bytes < SETTINGS_HEAD * 4u || bytes > BQ_SETTINGS_MAX_WORDS * 4u ||
        bytes % SETTINGS_BLOCK != 0u || bytes > nvm->sector_bytes) {
        return BQ_E_CRC;
    }
    while (r.at < bytes) {
        (void)next_word(&r);
    }
    return r.status != BQ_OK || r.crc == crc ? r.status : BQ_E_CRC;
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

/* All values, compared with their fields or stored into them. */
static bq_status read_values(const bq_settings *s, const bq_nvm *nvm, uint8_t sector, bool store)
{
    reader r = {nvm, SETTINGS_HEAD * 4u, 0, sector, BQ_OK};
    settings_walk w = settings_begin(s);
    void *object = NULL;
    const bq_field *f;

    while ((f = settings_next(&w, &object)) != NULL) {
        const uint32_t word = next_word(&r);
        if (r.status != BQ_OK) {
            return r.status;
        }
        if (store) {
            bq_field_store(*f, object, word);
        } else if (!settings_field_fits(*f, word)) {
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
