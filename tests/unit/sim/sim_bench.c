/* SPDX-License-Identifier: Apache-2.0 */
#include "sim_bench.h"
#include <string.h>

sim_pl s;
uint8_t rx[64], driven[64];

static uint8_t crc8(const uint8_t *bytes, size_t n)
{
    unsigned crc = 0;

    for (size_t i = 0; i < n; i++) {
        crc ^= bytes[i];
        for (int k = 0; k < 8; k++) {
            crc = (crc & 0x80) != 0 ? (crc << 1 ^ 0x07) & 0xff : crc << 1;
        }
    }
    return (uint8_t)crc;
}

static unsigned digit(char c)
{
    return (unsigned)(c <= '9' ? c - '0' : c - 'a' + 10);
}

void spi(const char *hex)
{
    uint8_t tx[64];
    size_t n = strlen(hex) / 2;

    for (size_t i = 0; i < n; i++) {
        tx[i] = (uint8_t)(digit(hex[2 * i]) << 4 | digit(hex[2 * i + 1]));
    }
    sim_pl_spi(&s, tx, rx, driven, n);
}

void put(unsigned address, unsigned reg, unsigned value)
{
    uint8_t tx[4] = {(uint8_t)(address << 1 | 1), (uint8_t)reg, (uint8_t)value, 0};

    tx[3] = crc8(tx, 3);
    sim_pl_spi(&s, tx, rx, driven, 4);
}

void key_put(unsigned address, unsigned reg, unsigned value)
{
    put(address, 0x3a, 0x35);
    put(address, reg, value);
}

int get(unsigned address, unsigned reg)
{
    uint8_t tx[5] = {(uint8_t)(address << 1), (uint8_t)reg, 1, 0, 0};
    uint8_t check[4] = {tx[0], tx[1], tx[2], 0};

    sim_pl_spi(&s, tx, rx, driven, 5);
    check[3] = rx[3];
    return crc8(check, 4) == rx[4] && driven[3] && driven[4] ? rx[3] : -1;
}

int peek(int device, unsigned reg)
{
    return sim_pl_peek(&s, device, (uint8_t)reg);
}

void expect_one_misuse(const char *id)
{
    const sim_misuse *book = sim_pl_misuse(&s);

    TEST_ASSERT_EQUAL_MESSAGE(1, (int)book->count, book->count != 0 ? book->entry[0].id : id);
    TEST_ASSERT_EQUAL_STRING(id, book->entry[0].id);
    sim_misuse_clear(sim_pl_misuse(&s));
}

void expect_misuse(const char *id, const char *hex)
{
    spi(hex);
    expect_one_misuse(id);
}

void expect_put_misuse(const char *id, unsigned address, unsigned reg, unsigned value)
{
    put(address, reg, value);
    expect_one_misuse(id);
}
