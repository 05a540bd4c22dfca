/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32_image.h
 * The header of a firmware image, directly behind the vector table. tools/imagecrc.py fills in `length` and
 * `crc` after linking; the start-up code checks them.
 */
#ifndef STM32_IMAGE_H
#define STM32_IMAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define STM32_IMAGE_MAGIC 0x4D495142u /**< "BQIM" in memory */

/** 32 bytes, little endian. */
typedef struct stm32_image {
    uint32_t magic;
    uint32_t length;  /**< of the image in bytes, from the first vector; a multiple of 4 */
    uint32_t crc;     /**< CRC-32 of the image without these four bytes */
    uint32_t version; /**< major << 16 | minor << 8 | patch */
    char board[16];   /**< name, filled up with zeros */
} stm32_image;

/** CRC-32 as in zlib (0x04C11DB7 reflected, begin and end inverted), continued: begin with 0. A table of 16
 * words, two look-ups a byte. */
uint32_t stm32_crc32(uint32_t crc, const void *data, size_t len);

/** Whether the image of `available` bytes at `base` with its header at `header` is whole. Reads the image
 * once: about 25 cycles a byte. */
bool stm32_image_ok(const void *base, const stm32_image *header, size_t available);

/** The header of the running image, and its check within the flash that the linker script gives to it. */
extern const stm32_image stm32_image_header;
bool stm32_image_self_check(void);
/** The checksum as stored in the header. */
uint32_t stm32_image_stored_crc(void);

#endif
