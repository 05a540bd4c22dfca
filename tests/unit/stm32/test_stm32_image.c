/* SPDX-License-Identifier: Apache-2.0 */
#include "stm32_image.h"
#include "unity.h"
#include <string.h>

#define BYTES 512u
#define HEADER_AT 192u

static union {
    uint32_t words[BYTES / 4u];
    uint8_t bytes[BYTES];
} image;

/* Bit by bit, from the definition: reflected 0x04c11db7, begin and end inverted. */
static uint32_t by_definition(uint32_t crc, const uint8_t *data, size_t len)
{
    for (size_t i = 0; i < len * 8u; i++) {
        unsigned bit = (unsigned)data[i / 8u] >> (i % 8u) & 1u;
        crc = ((crc ^ bit) & 1u) != 0u ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    }
    return crc;
}

static stm32_image *header(void)
{
    return (stm32_image *)(void *)&image.words[HEADER_AT / 4u];
}

void setUp(void)
{
    uint32_t crc = 0xffffffffu;
    for (unsigned i = 0; i < BYTES; i++) {
        image.bytes[i] = (uint8_t)(i * 7u + (i >> 5));
    }
    header()->magic = STM32_IMAGE_MAGIC;
    header()->length = 400;
    crc = by_definition(crc, image.bytes, HEADER_AT + 8u);
    crc = by_definition(crc, image.bytes + HEADER_AT + 12u, 400u - HEADER_AT - 12u);
    header()->crc = ~crc;
}

void tearDown(void)
{
}

static void test_crc_published_values(void)
{
    TEST_ASSERT_EQUAL_HEX32(0xcbf43926u, stm32_crc32(0, "123456789", 9));
    TEST_ASSERT_EQUAL_HEX32(0xd202ef8du, stm32_crc32(0, "\0", 1));
    TEST_ASSERT_EQUAL_HEX32(0, stm32_crc32(0, "", 0));
    TEST_ASSERT_EQUAL_HEX32(0xcbf43926u, stm32_crc32(stm32_crc32(0, "1234", 4), "56789", 5));
}

static void test_layout_of_the_header(void)
{
    TEST_ASSERT_EQUAL_MEMORY("BQIM", &image.bytes[HEADER_AT], 4);
    TEST_ASSERT_EQUAL_UINT(32, sizeof(stm32_image));
    TEST_ASSERT_EQUAL_UINT(4, offsetof(stm32_image, length));
    TEST_ASSERT_EQUAL_UINT(8, offsetof(stm32_image, crc));
    TEST_ASSERT_EQUAL_UINT(12, offsetof(stm32_image, version));
}

static void test_a_whole_image(void)
{
    TEST_ASSERT_TRUE(stm32_image_ok(image.bytes, header(), BYTES));
    TEST_ASSERT_TRUE(stm32_image_ok(image.bytes, header(), 400));
}

/* Every byte of the image counts, its own header included; what lies behind it does not. */
static void test_every_flipped_byte_is_noticed(void)
{
    for (unsigned i = 0; i < BYTES; i++) {
        image.bytes[i] ^= 0x10u;
        TEST_ASSERT_EQUAL_INT(i >= 400u, stm32_image_ok(image.bytes, header(), BYTES));
        image.bytes[i] ^= 0x10u;
    }
}

static void test_lengths_that_cannot_be(void)
{
    TEST_ASSERT_FALSE(stm32_image_ok(image.bytes, header(), 399));
    header()->length = 0xffffffffu; /* as linked, before the tool has been there */
    TEST_ASSERT_FALSE(stm32_image_ok(image.bytes, header(), BYTES));
    header()->length = HEADER_AT;
    TEST_ASSERT_FALSE(stm32_image_ok(image.bytes, header(), BYTES));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_crc_published_values);
    RUN_TEST(test_layout_of_the_header);
    RUN_TEST(test_a_whole_image);
    RUN_TEST(test_every_flipped_byte_is_noticed);
    RUN_TEST(test_lengths_that_cannot_be);
    return UNITY_END();
}
