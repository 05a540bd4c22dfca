/* SPDX-License-Identifier: Apache-2.0 */
/* Making a record, and writing it so that at every moment one record counts. */
#include "settings_internal.h"
#include <string.h>

/* Makes a record block by block from block 1 on; block 0 is known when the last one is. */
typedef struct maker {
    settings_walk walk;
    uint32_t words, at; /* of the whole record, next */
    uint32_t sequence, crc;
} maker;

static maker begin(const bq_settings *s, uint32_t sequence)
{
    const maker m = {settings_begin(s), settings_words(s), 2, sequence, 0};

    return m;
}

static uint32_t next_value(maker *m)
{
    void *object = NULL;
    const bq_field *f = settings_next(&m->walk, &object);

    return f != NULL ? bq_field_load(*f, object) : UINT32_MAX;
}

static uint32_t next_word(maker *m)
{
    switch (m->at++) {
    case 2:
        return BQ_SETTINGS_FORMAT << 16 | m->words;
    case 3:
        return bq_settings_layout(m->walk.s);
    case 4:
        return m->sequence;
    default:
        return next_value(m);
    }
}

/* False past the end. */
static bool next_block(maker *m, uint8_t *block)
{
    if (m->at >= m->words) {
        return false;
    }
    settings_put32(block, next_word(m));
    settings_put32(block + 4, next_word(m));
    m->crc = bq_crc32(m->crc, block, SETTINGS_BLOCK);
    return true;
}

static void commit_mark(const maker *m, uint8_t *block)
{
    settings_put32(block, BQ_SETTINGS_MAGIC);
    settings_put32(block + 4, m->crc);
}

size_t bq_settings_encode(const bq_settings *s, uint32_t sequence, uint8_t *record, size_t capacity)
{
    maker m = begin(s, sequence);
    size_t len = SETTINGS_BLOCK;

    if (m.words > BQ_SETTINGS_MAX_WORDS || m.words * 4u > capacity) {
        return 0;
    }
    while (next_block(&m, record + len)) {
        len += SETTINGS_BLOCK;
    }
    commit_mark(&m, record);
    return len;
}

/* Unit after unit, in ascending order, then compared. */
static bq_status program_block(const bq_nvm *nvm, uint8_t sector, uint32_t offset, const uint8_t *block)
{
    uint8_t back[SETTINGS_BLOCK];
    bq_status status = BQ_OK;

    for (uint32_t i = 0; status == BQ_OK && i < SETTINGS_BLOCK; i += nvm->unit_bytes) {
        status = nvm->ops->program(nvm->ctx, sector, offset + i, block + i, nvm->unit_bytes);
    }
    if (status == BQ_OK) {
        status = nvm->ops->read(nvm->ctx, sector, offset, back, sizeof back);
    }
    if (status == BQ_OK && memcmp(back, block, sizeof back) != 0) {
        status = BQ_E_VERIFY;
    }
    return status;
}

static bq_status write_record(const bq_settings *s, const bq_nvm *nvm, uint8_t sector, uint32_t sequence)
{
    maker m = begin(s, sequence);
    uint8_t block[SETTINGS_BLOCK];
    uint32_t offset = SETTINGS_BLOCK;
    bq_status status = nvm->ops->erase(nvm->ctx, sector);

    while (status == BQ_OK && next_block(&m, block)) {
        status = program_block(nvm, sector, offset, block);
        offset += SETTINGS_BLOCK;
    }
    if (status == BQ_OK) {
        commit_mark(&m, block);
        status = program_block(nvm, sector, 0, block);
    }
    return status;
}

bq_status bq_settings_save(const bq_settings *s, const bq_nvm *nvm)
{
    settings_record old = {0, 0, 0, 0};
    settings_record now = {0, 0, 0, 0};
    uint8_t sector = 0;
    bq_status status;

    if (!settings_usable(s, nvm) ||
        (nvm->unit_bytes != 2u && nvm->unit_bytes != 4u && nvm->unit_bytes != 8u)) {
        return BQ_E_ARG;
    }
    status = settings_newest(nvm, &old);
    if (status == BQ_OK) {
        sector = (uint8_t)((old.sector + 1u) % nvm->sectors);
    } else if (status != BQ_E_NOT_FOUND && status != BQ_E_CRC) {
        return status;
    }
    status = write_record(s, nvm, sector, old.sequence + 1u);
    if (status != BQ_OK) {
        return status;
    }
    status = settings_newest(nvm, &now);
    return status != BQ_OK || now.sector != sector ? BQ_E_VERIFY : BQ_OK;
}
