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

const bq_field *settings_next(settings_walk *w, unsigned char **at)
{
    while (w->part < w->s->count) {
        const bq_settings_part *p = &w->s->parts[w->part];
        if (w->field < p->table->count && w->element < p->count) {
            const bq_field *f = &p->table->fields[w->field++];
            *at = (unsigned char *)p->object + (size_t)w->element * p->table->stride + f->offset;
            return f;
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

uint32_t settings_load_field(const bq_field *f, const unsigned char *at)
{
    const unsigned unused = 32u - 8u * f->size; /* bits */
    uint32_t value = *at;
    uint16_t half;

    if (f->size == 4u) {
        memcpy(&value, at, sizeof value);
    } else if (f->size == 2u) {
        memcpy(&half, at, sizeof half);
        value = half;
    }
    if (f->kind == (uint8_t)BQ_FIELD_SIGNED) {
        const uint32_t sign = 0x80000000u >> unused;
        value = (value ^ sign) - sign;
    }
    return value;
}

void settings_store_field(const bq_field *f, unsigned char *at, uint32_t value)
{
    const uint16_t half = (uint16_t)value;

    if (f->size == 4u) {
        memcpy(at, &value, sizeof value);
    } else if (f->size == 2u) {
        memcpy(at, &half, sizeof half);
    } else if (f->kind == (uint8_t)BQ_FIELD_BOOL) {
        const bool flag = value != 0u;
        memcpy(at, &flag, sizeof flag);
    } else {
        *at = (unsigned char)value;
    }
}

/* What comes back from a field is what fits into it. */
bool settings_field_fits(const bq_field *f, uint32_t value)
{
    unsigned char copy[4];

    settings_store_field(f, copy, value);
    return settings_load_field(f, copy) == value &&
           (f->kind != (uint8_t)BQ_FIELD_POINTS || value <= BQ_FIELD_MAX_POINTS);
}
