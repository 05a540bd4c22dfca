/* SPDX-License-Identifier: Apache-2.0 */
/* Fields of objects to words and back. */
#include "settings_internal.h"

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

const bq_field *settings_next(settings_walk *w, void **object)
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

bool settings_field_fits(bq_field f, uint32_t value)
{
    return bq_field_fit(f, value) == value &&
           (bq_field_kind_of(f) != BQ_FIELD_POINTS || value <= BQ_FIELD_MAX_POINTS);
}
