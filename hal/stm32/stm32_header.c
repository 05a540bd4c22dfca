/* SPDX-License-Identifier: Apache-2.0 */
/* The header of this image; the linker script puts it behind the vectors, tools/imagecrc.py completes it. */
#include "stm32_image.h"

extern const uint8_t stm32_flash_begin[], stm32_flash_end[]; /* linker script */

__attribute__((section(".image_header"), used)) const stm32_image stm32_image_header = {
    STM32_IMAGE_MAGIC, 0xffffffffu, 0xffffffffu, BQHOST_IMAGE_VERSION, BQHOST_BOARD};

/* The compiler believes to know the constants above, the tool changes them later: hide where they come from.
 */
static const stm32_image *sealed(void)
{
    const stm32_image *header = &stm32_image_header;
    __asm volatile("" : "+r"(header));
    return header;
}

bool stm32_image_self_check(void)
{
    return stm32_image_ok(stm32_flash_begin, sealed(), (size_t)(stm32_flash_end - stm32_flash_begin));
}

uint32_t stm32_image_stored_crc(void)
{
    return sealed()->crc;
}
