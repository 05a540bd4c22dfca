/* SPDX-License-Identifier: Apache-2.0 */
/* What the files of the settings share; see include/bqhost/settings.h. */
#ifndef SETTINGS_INTERNAL_H
#define SETTINGS_INTERNAL_H

#include "bqhost/settings.h"
#include <stdbool.h>

#define SETTINGS_BLOCK 8u /* two words; block 0 is the commit mark */
#define SETTINGS_HEAD 5u  /* words before the first value */

/* A walk over all fields of all objects, in the order of the record. */
typedef struct settings_walk {
    const bq_settings *s;
    uint8_t part;
    uint16_t element, field;
} settings_walk;

/* A record as found in a sector. */
typedef struct settings_record {
    uint8_t sector;
    uint32_t format, layout, sequence; /* words 2, 3, 4 */
} settings_record;

uint32_t settings_get32(const uint8_t *at);
void settings_put32(uint8_t *at, uint32_t value);

settings_walk settings_begin(const bq_settings *s);
/* The next field and the object that has it; NULL past the end. */
const bq_field *settings_next(settings_walk *w, void **object);
bool settings_field_fits(bq_field f, uint32_t value);

/* Words of the whole record, even; above BQ_SETTINGS_MAX_WORDS: too many. */
uint32_t settings_words(const bq_settings *s);
/* Arguments of load and save. */
bool settings_usable(const bq_settings *s, const bq_nvm *nvm);
/* The intact record with the highest sequence number. BQ_OK, BQ_E_NOT_FOUND (all erased), BQ_E_CRC, or what
 * read returned. */
bq_status settings_newest(const bq_nvm *nvm, settings_record *newest);

#endif
