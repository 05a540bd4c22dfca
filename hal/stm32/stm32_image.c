/* SPDX-License-Identifier: Apache-2.0 */
#include "stm32_image.h"

uint32_t stm32_crc32(uint32_t crc, const void *data, size_t len)
{
    static const uint32_t table[16] = {0x00000000u, 0x1db71064u, 0x3b6e20c8u, 0x26d930acu,
                                       0x76dc4190u, 0x6b6b51f4u, 0x4db26158u, 0x5005713cu,
                                       0xedb88320u, 0xf00f9344u, 0xd6d6a3e8u, 0xcb61b38cu,
                                       0x9b64c2b0u, 0x86d3d2d4u, 0xa00ae278u, 0xbdbdf21cu};
    const uint8_t *bytes = data;
    crc = ~crc;
    for (; len > 0u; len--) {
        crc ^= *bytes++;
        crc = crc >> 4 ^ table[crc & 15u];
        crc = crc >> 4 ^ table[crc & 15u];
    }
    return ~crc;
}

bool stm32_image_ok(const void *base, const stm32_image *header, size_t available)
{
    const uint8_t *from = base, *field = (const uint8_t *)&header->crc;
    size_t before = (size_t)(field - from), length = header->length;
    uint32_t crc;
    if (header->magic != STM32_IMAGE_MAGIC || length > available || length < before + sizeof header->crc) {
        return false;
    }
    crc = stm32_crc32(0, from, before);
    crc = stm32_crc32(crc, field + sizeof header->crc, length - before - sizeof header->crc);
    return crc == header->crc;
}
