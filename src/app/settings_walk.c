/* SPDX-License-Identifier: Apache-2.0 */
/* Fields of objects to words and back. */
#include "settings_internal.h"
#include <string.h>

uint32_t settings_get32(const uint8_t *at)
{
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

void settings_put32(uint8_t *at, uint32_t value)
{
    for (unsigned i = 0; i < 4u; i++) {
        at[i] = (uint8_t)(value >> (8u * i));
    }
}

settings_walk settings_begin(const bq_settings *s)
{
    const settings_walk w = {s, 0, 0, 0};

    return w;
}

const bq_field *settings_next(settings_walk *w, unsigned char **object)
{
    while (w->part < w->s->count) {
        const bq_settings_part *p = &w->s->parts[w->part];
        if (w->field < p->table->count && w->element < p->count) {
            *object = (unsigned char *)p->object + (size_t)w->element * p->table->stride;
            return &p->table->fields[w->field++];
        }
        w->field = 0;
        w->element++;
        if (w->element >= p->count) {
            w->element = 0;
            w->part++;
        }
    }
    return NULL;
}

uint32_t settings_load_field(const bq_field *f, const unsigned char *object)
{
    const unsigned char *at = object + f->offset;
    uint32_t u32 = *at;
    uint16_t u16;

    if (f->size == 2u) {
        memcpy(&u16, at, sizeof u16);
        u32 = u16;
    } else if (f->size == 4u) {
        memcpy(&u32, at, sizeof u32);
    }
    if (f->kind == (uint8_t)BQ_FIELD_SIGNED && f->size < 4u) {
        const uint32_t sign = (uint32_t)1 << (8u * f->size - 1u);
        u32 = (u32 ^ sign) - sign;
    }
    return u32;
}

bool settings_field_fits(const bq_field *f, uint32_t value)
{
    const uint32_t half = (uint32_t)1 << (8u * f->size - 1u);

    switch (f->kind) {
    case BQ_FIELD_BOOL:
        return value <= 1u;
    case BQ_FIELD_POINTS:
        return value <= BQ_FIELD_MAX_POINTS;
    case BQ_FIELD_SIGNED:
        return f->size == 4u || value + half < 2u * half;
    default:
        return f->size == 4u || value < 2u * half;
    }
}

void settings_store_field(const bq_field *f, unsigned char *object, uint32_t value)
{
    unsigned char *at = object + f->offset;
    const uint16_t u16 = (uint16_t)value;

    if (f->size == 4u) {
        memcpy(at, &value, sizeof value);
    } else if (f->size == 2u) {
        memcpy(at, &u16, sizeof u16);
    } else if (f->kind == (uint8_t)BQ_FIELD_BOOL) {
        const bool flag = value != 0u;
        memcpy(at, &flag, sizeof flag);
    } else {
        *at = (unsigned char)value;
    }
}
