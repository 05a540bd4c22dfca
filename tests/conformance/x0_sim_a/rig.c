/* SPDX-License-Identifier: Apache-2.0 */
#include "rig.h"
#include <stdio.h>

sim_x0 chip;

/* X0-VAR-01..15 */
const rig_part rig_parts[15] = {
    {"bq7692000", 5, 0x08, false, 2500},  {"bq7692001", 5, 0x08, true, 2500},
    {"bq7692002", 5, 0x08, false, 3300},  {"bq7692003", 5, 0x08, true, 3300},
    {"bq7692006", 5, 0x18, false, 3300},  {"bq7693000", 10, 0x08, false, 2500},
    {"bq7693001", 10, 0x08, true, 2500},  {"bq7693002", 10, 0x08, false, 3300},
    {"bq7693003", 10, 0x08, true, 3300},  {"bq7693006", 10, 0x18, false, 3300},
    {"bq7694000", 15, 0x08, false, 2500}, {"bq7694001", 15, 0x08, true, 2500},
    {"bq7694002", 15, 0x08, false, 3300}, {"bq7694003", 15, 0x08, true, 3300},
    {"bq7694006", 15, 0x18, false, 3300},
};

static const rig_part *part;

void setUp(void)
{
}

void tearDown(void)
{
}

/* x^8 + x^2 + x + 1, initial value 0, highest bit first */
uint8_t rig_crc(const uint8_t *bytes, size_t n)
{
    unsigned rest = 0;
    for (size_t bit = 0; bit < 8 * n; bit++) {
        unsigned in = (unsigned)bytes[bit / 8] >> (7 - bit % 8) & 1u;
        unsigned out = rest >> 7 & 1u;
        rest = rest << 1 & 0xffu;
        rest ^= (in ^ out) != 0 ? 0x07u : 0u;
    }
    return (uint8_t)rest;
}

void rig_ship_with(const char *name, const sim_x0_options *options)
{
    part = NULL;
    for (int i = 0; i < 15; i++) {
        part = strcmp(rig_parts[i].name, name) == 0 ? &rig_parts[i] : part;
    }
    TEST_ASSERT_NOT_NULL(part);
    TEST_ASSERT_EQUAL(0, sim_x0_init(&chip, sim_x0_find_part(name), options));
}

void rig_pulse_with(const char *name, const sim_x0_options *options)
{
    rig_ship_with(name, options);
    TEST_ASSERT_EQUAL(0, sim_x0_boot(&chip, 3 * MS));
}

unsigned rig_first_ms(void)
{
    return part->inputs == 5 ? 260 : part->inputs == 10 ? 410 : 810;
}

void rig_boot_with(const char *name, const sim_x0_options *options)
{
    rig_pulse_with(name, options);
    rig_at(rig_first_ms());
}

void rig_at(double ms)
{
    uint64_t t = (uint64_t)(ms * 1e6 + 0.5);
    TEST_ASSERT_TRUE_MESSAGE(t >= chip.now, "time does not run backwards");
    sim_x0_advance(&chip, t - chip.now);
}

void rig_wait(double ms)
{
    sim_x0_advance(&chip, (uint64_t)(ms * 1e6 + 0.5));
}

bool rig_block_write(int reg, const uint8_t *data, int n)
{
    uint8_t head[3] = {(uint8_t)(2 * part->address), (uint8_t)reg, 0};
    bool ok;
    sim_x0_i2c_start(&chip);
    ok = sim_x0_i2c_write(&chip, head[0]) && sim_x0_i2c_write(&chip, head[1]);
    for (int i = 0; i < n && ok; i++) {
        ok = sim_x0_i2c_write(&chip, data[i]);
        if (ok && part->crc) {
            head[2] = data[i];
            ok = sim_x0_i2c_write(&chip, i == 0 ? rig_crc(head, 3) : rig_crc(&data[i], 1));
        }
    }
    sim_x0_i2c_stop(&chip);
    return ok;
}

bool rig_write(int reg, int value)
{
    uint8_t byte = (uint8_t)value;
    return rig_block_write(reg, &byte, 1);
}

void rig_block_read(int reg, uint8_t *data, int n)
{
    uint8_t first[2] = {(uint8_t)(2 * part->address + 1), 0};
    sim_x0_i2c_start(&chip);
    TEST_ASSERT_TRUE(sim_x0_i2c_write(&chip, (uint8_t)(2 * part->address)));
    TEST_ASSERT_TRUE(sim_x0_i2c_write(&chip, (uint8_t)reg));
    sim_x0_i2c_start(&chip);
    TEST_ASSERT_TRUE(sim_x0_i2c_write(&chip, first[0]));
    for (int i = 0; i < n; i++) {
        data[i] = sim_x0_i2c_read(&chip, part->crc || i + 1 < n);
        if (part->crc) {
            first[1] = data[i];
            TEST_ASSERT_EQUAL_HEX8(i == 0 ? rig_crc(first, 2) : rig_crc(&data[i], 1),
                                   sim_x0_i2c_read(&chip, i + 1 < n));
        }
    }
    sim_x0_i2c_stop(&chip);
}

int rig_read(int reg)
{
    uint8_t byte;
    rig_block_read(reg, &byte, 1);
    return byte;
}

int rig_read16(int reg)
{
    uint8_t pair[2];
    rig_block_read(reg, pair, 2);
    return pair[0] << 8 | pair[1];
}

bool rig_answers(int address7)
{
    bool ack;
    sim_x0_i2c_start(&chip);
    ack = sim_x0_i2c_write(&chip, (uint8_t)(2 * address7));
    sim_x0_i2c_stop(&chip);
    return ack;
}

static void compare(const char *what, int expected, int actual, int line)
{
    char text[96];
    (void)snprintf(text, sizeof text, "%s, %s, t = %.3f ms", part->name, what, (double)chip.now / 1e6);
    UnityAssertHex((UNITY_UINT)expected, (UNITY_UINT)actual, 2, line, text);
}

void rig_stat_at(int expected, int line)
{
    compare("SYS_STAT", expected, rig_read(0x00), line);
}

void rig_reg_at(int reg, int expected, int line)
{
    char what[24];
    (void)snprintf(what, sizeof what, "register %02x", (unsigned)reg);
    compare(what, expected, rig_read(reg), line);
}

void rig_clear(void)
{
    int set = rig_read(0x00);
    TEST_ASSERT_TRUE(rig_write(0x00, set));
}

void rig_clean_at(int line)
{
    const sim_misuse *book = sim_x0_misuse(&chip);
    UnityAssert(book->count == 0, line, "no misuse", book->count != 0 ? book->entry[0].text : NULL);
}

void rig_misuse_at(const char *id, int line)
{
    sim_misuse *book = sim_x0_misuse(&chip);
    UnityAssert(book->count > 0, line, "a misuse is recorded", id);
    UnityAssertString(id, book->entry[0].id, line, book->entry[0].text);
    UnityAssertInt((UNITY_INT)book->count, (UNITY_INT)sim_misuse_of(book, id), line, "another ID too");
    sim_misuse_clear(book);
}

void rig_each(void (*check)(const rig_part *p))
{
    for (int i = 0; i < 15; i++) {
        check(&rig_parts[i]);
    }
}
