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

/** Where a field lies and what it is: bits 0..11 its offset, 12..13 its size / 2 (1, 2 or 4 bytes), 14..15
 *  bq_field_kind. */
typedef uint16_t bq_field;

#define BQ_FIELD_AT(offset, size, kind)                                                                      \
    ((bq_field)((size_t)(offset) | (size_t)(size) / 2u << 12 | (size_t)(kind) << 14))

/** The member of a structure. Does not compile when it lies beyond 4095 bytes. */
#define BQ_FIELD(type, member, kind)                                                                         \
    BQ_FIELD_AT(offsetof(type, member) * sizeof(char[offsetof(type, member) < 4096u ? 1 : -1]),              \
                sizeof(((type *)0)->member), kind)

static inline unsigned bq_field_size(bq_field f)
{
    return 1u << (f >> 12 & 3u);
}

static inline bq_field_kind bq_field_kind_of(bq_field f)
{
    return (bq_field_kind)(f >> 14);
}

typedef struct bq_field_table {
    const bq_field *fields; /**< [count], in the order of the record */
    uint16_t count;
    uint16_t id;     /**< changes whenever a field is added, removed, moved or gets another meaning */
    uint16_t stride; /**< size of the structure, the distance of two in an array */
} bq_field_table;

/** The field of an object, a negative one in two's complement. */
uint32_t bq_field_load(bq_field f, const void *object);

/** What would come back of a value after bq_field_store(): equal to it if the field can hold it. Knows no
 *  BQ_FIELD_MAX_POINTS. */
uint32_t bq_field_fit(bq_field f, uint32_t value);

/** Writes the field of an object, and nothing else of it; bits beyond its size are lost. */
void bq_field_store(bq_field f, void *object, uint32_t value);

#ifdef __cplusplus
}
#endif
#endif
