/* SPDX-License-Identifier: Apache-2.0 */
#include "bqhost/field.h"

/* Members lie where their type wants them, so they are read and written as what they are. */
uint32_t bq_field_load(const bq_field *f, const void *object)
{
    const void *at = (const unsigned char *)object + f->offset;

    if (f->size == 4u) {
        return *(const uint32_t *)at;
    }
    return bq_field_fit(f, f->size == 2u ? *(const uint16_t *)at : *(const uint8_t *)at);
}

uint32_t bq_field_fit(const bq_field *f, uint32_t value)
{
    const unsigned unused = 32u - 8u * f->size; /* bits */
    const uint32_t sign = f->kind == (uint8_t)BQ_FIELD_SIGNED ? 0x80000000u >> unused : 0u;

    if (f->kind == (uint8_t)BQ_FIELD_BOOL) {
        return value != 0u;
    }
    return ((value << unused >> unused) ^ sign) - sign;
}

void bq_field_store(const bq_field *f, void *object, uint32_t value)
{
    void *at = (unsigned char *)object + f->offset;

    value = bq_field_fit(f, value);
    if (f->size == 4u) {
        *(uint32_t *)at = value;
    } else if (f->size == 2u) {
        *(uint16_t *)at = (uint16_t)value;
    } else {
        *(uint8_t *)at = (uint8_t)value;
    }
}
