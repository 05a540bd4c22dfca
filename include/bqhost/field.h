/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file field.h
 * Tables that describe the integer fields of a configuration structure, so that it can be written to and read
 * from memory in one form on every platform (settings.h). Each driver has one for its own configuration.
 *
 * Pointers are never part of a table: whoever owns the structure sets them.
 */
#ifndef BQHOST_FIELD_H
#define BQHOST_FIELD_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum bq_field_kind {
    BQ_FIELD_UNSIGNED, /**< every value its size can hold */
    BQ_FIELD_SIGNED,   /**< two's complement */
    BQ_FIELD_BOOL,     /**< 0 or 1, size 1 */
    BQ_FIELD_POINTS    /**< unsigned, at most BQ_FIELD_MAX_POINTS: the used length of an array */
} bq_field_kind;

#define BQ_FIELD_MAX_POINTS 64u /**< longest open-circuit voltage curve in a record */

typedef struct bq_field {
    uint16_t offset; /**< in the structure */
    uint8_t size;    /**< 1, 2 or 4 bytes */
    uint8_t kind;    /**< bq_field_kind */
} bq_field;

typedef struct bq_field_table {
    const bq_field *fields; /**< [count], in the order of the record */
    uint16_t count;
    uint16_t id;     /**< changes whenever a field is added, removed, moved or gets another meaning */
    uint16_t stride; /**< size of the structure, the distance of two in an array */
} bq_field_table;

#define BQ_FIELD(type, member, kind)                                                                         \
    {(uint16_t)offsetof(type, member), (uint8_t)sizeof(((type *)0)->member), (kind)}

/** The field of an object, a negative one in two's complement. */
uint32_t bq_field_load(const bq_field *f, const void *object);

/** What would come back of a value after bq_field_store(): equal to it if the field can hold it. Knows no
 *  BQ_FIELD_MAX_POINTS. */
uint32_t bq_field_fit(const bq_field *f, uint32_t value);

/** Writes the field of an object, and nothing else of it; bits beyond its size are lost. */
void bq_field_store(const bq_field *f, void *object, uint32_t value);

#ifdef __cplusplus
}
#endif
#endif
