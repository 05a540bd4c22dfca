/* SPDX-License-Identifier: Apache-2.0 */
#include "bqhost/field.h"

#define OFFSET(f) ((f) & 0xfffu)

/* Members lie where their type wants them, so they are read and written as what they are. */
uint32_t bq_field_load(bq_field f, const void *object)
{
    const void *at = (const unsigned char *)object + OFFSET(f);
    const unsigned size = bq_field_size(f);

    return bq_field_fit(f, size == 4u   ? *(const uint32_t *)at
                           : size == 2u ? *(const uint16_t *)at
                                        : *(const uint8_t *)at);
}

uint32_t bq_field_fit(bq_field f, uint32_t value)
{
    const unsigned unused = 32u - 8u * bq_field_size(f); /* bits */
    const uint32_t sign = bq_field_kind_of(f) == BQ_FIELD_SIGNED ? 0x80000000u >> unused : 0u;

    if (bq_field_kind_of(f) == BQ_FIELD_BOOL) {
        return value != 0u;
    }
    return ((value << unused >> unused) ^ sign) - sign;
}

void bq_field_store(bq_field f, void *object, uint32_t value)
{
    void *at = (unsigned char *)object + OFFSET(f);
    const unsigned size = bq_field_size(f);

    value = bq_field_fit(f, value);
    if (size == 4u) {
        *(uint32_t *)at = value;
    } else if (size == 2u) {
        *(uint16_t *)at = (uint16_t)value;
    } else {
        *(uint8_t *)at = (uint8_t)value;
    }
}
