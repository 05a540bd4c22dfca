/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Every bus trace that the requirement list prints is replayed on the model, byte by byte and line by line.
 * The traces are read from the list itself, so that no copying mistake can hide.
 */
#include "sim_x0.h"
#include "unity.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static sim_x0 chip;
static unsigned rows, replayed;

void setUp(void)
{
}

void tearDown(void)
{
}

static void boot(const char *part)
{
    TEST_ASSERT_EQUAL(0, sim_x0_init(&chip, sim_x0_find_part(part), NULL));
    TEST_ASSERT_EQUAL(0, sim_x0_boot(&chip, 3000000));
    sim_x0_advance(&chip, 900000000);
}

static bool line(bool scl, bool sda)
{
    return sim_x0_lines(&chip, scl, sda);
}

static bool bit(bool sda)
{
    bool level;
    (void)line(false, sda);
    level = line(true, sda);
    (void)line(false, sda);
    return level;
}

static bool lines_send(unsigned byte)
{
    for (unsigned i = 8; i-- > 0u;) {
        (void)bit((byte >> i & 1u) != 0u);
    }
    return !bit(true);
}

static unsigned lines_read(bool ack)
{
    unsigned byte = 0;
    for (unsigned i = 0; i < 8u; i++) {
        byte = byte << 1 | (bit(true) ? 1u : 0u);
    }
    (void)bit(!ack);
    return byte;
}

static void start(bool by_line)
{
    if (by_line) {
        (void)line(false, true);
        (void)line(true, true);
        (void)line(true, false);
        (void)line(false, false);
    } else {
        sim_x0_i2c_start(&chip);
    }
}

static void stop(bool by_line)
{
    if (by_line) {
        (void)line(false, false);
        (void)line(true, false);
        (void)line(true, true);
    } else {
        sim_x0_i2c_stop(&chip);
    }
}

/* Replays one trace and writes what came back in the same notation. */
static void replay(const char *trace, bool by_line, char *out)
{
    char copy[512];
    out[0] = '\0';
    (void)snprintf(copy, sizeof copy, "%s", trace);
    for (char *t = strtok(copy, " "); t != NULL;) {
        char *next = strtok(NULL, " "), shown[8];
        unsigned byte = (unsigned)strtoul(t, NULL, 16);
        if (strcmp(t, "S") == 0 || strcmp(t, "P") == 0) {
            (t[0] == 'S' ? start : stop)(by_line);
            (void)snprintf(shown, sizeof shown, "%s", t);
        } else if (strlen(t) == 3) {
            bool ack = by_line ? lines_send(byte) : sim_x0_i2c_write(&chip, (uint8_t)byte);
            (void)snprintf(shown, sizeof shown, "%02x%c", byte, ack ? '+' : '-');
        } else {
            bool ack = next != NULL && strcmp(next, "P") != 0 && strcmp(next, "S") != 0;
            unsigned got = by_line ? lines_read(ack) : sim_x0_i2c_read(&chip, ack);
            (void)snprintf(shown, sizeof shown, "%02x", got);
        }
        (void)strcat(out, shown);
        (void)strcat(out, next != NULL ? " " : "");
        t = next;
    }
}

static void hold(unsigned reg, unsigned value)
{
    if (reg == 0x50u) {
        chip.gain_uv = 365 + (int)((value & 0x0cu) << 1) + ((chip.gain_uv - 365) & 7);
        chip.rsvd50 = (uint8_t)value;
    } else if (reg == 0x51u) {
        chip.offset_mv = (int8_t)value;
    } else if (reg == 0x59u) {
        chip.gain_uv = 365 + ((chip.gain_uv - 365) & ~7) + (int)(value >> 5);
    } else {
        chip.reg[reg] = (uint8_t)value;
    }
}

/* Puts what the trace will read into the registers, so that address, order, acknowledge and CRC are what is
 * tested. */
static void prepare(const char *trace, bool crc)
{
    unsigned reg = 0, in_phase = 0, n = 0;
    char copy[512];
    (void)snprintf(copy, sizeof copy, "%s", trace);
    for (char *t = strtok(copy, " "); t != NULL; t = strtok(NULL, " ")) {
        size_t length = strlen(t);
        if (length == 1) {
            in_phase = 0;
        } else if (length == 3) {
            reg = ++in_phase == 2 ? (unsigned)strtoul(t, NULL, 16) : reg;
        } else if (!crc || n++ % 2u == 0u) {
            hold(reg++, (unsigned)strtoul(t, NULL, 16));
        }
    }
}

static void check_trace(const char *id, const char *part, const char *trace)
{
    for (int by_line = 0; by_line < 2; by_line++) {
        char got[512], text[96];
        (void)snprintf(text, sizeof text, "%s %s", id, by_line ? "line by line" : "byte by byte");
        boot(part);
        prepare(trace, sim_x0_find_part(part)->crc);
        replay(trace, by_line != 0, got);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(trace, got, text);
        replayed++;
    }
}

static const char *part_of(const char *row)
{
    return strstr(row, "*CRC part*") != NULL ? "bq7694003"
           : strstr(row, "Part 06") != NULL  ? "bq7694006"
                                             : "bq7694000";
}

static void check_row(char *row)
{
    char id[16];
    char *trace = row;
    (void)snprintf(id, sizeof id, "%.10s", row + 2);
    if (strstr(row, "arithmetic") != NULL || strstr(row, " r r ") != NULL || strstr(row, "`S ") == NULL) {
        return;
    }
    rows++;
    while ((trace = strstr(trace, "`S ")) != NULL) {
        char *end = strchr(++trace, '`');
        TEST_ASSERT_NOT_NULL(end);
        *end = '\0';
        check_trace(id, part_of(row), trace);
        *end = '`';
        trace = end + 1;
    }
}

/*
 * proves: X0-NUM-803, X0-NUM-804, X0-NUM-805, X0-NUM-806, X0-NUM-807, X0-NUM-808, X0-NUM-809, X0-NUM-810,
 *     X0-NUM-811, X0-NUM-812, X0-NUM-813, X0-NUM-814, X0-NUM-815, X0-NUM-816, X0-NUM-817, X0-NUM-818,
 *     X0-NUM-819, X0-NUM-820, X0-NUM-821, X0-NUM-822, X0-NUM-823, X0-NUM-824, X0-NUM-825, X0-NUM-826,
 *     X0-NUM-827, X0-NUM-828, X0-NUM-829, X0-NUM-830, X0-NUM-831, X0-NUM-832, X0-NUM-833, X0-NUM-834,
 *     X0-NUM-835, X0-NUM-836, X0-NUM-837, X0-NUM-838, X0-NUM-839, X0-NUM-840, X0-NUM-841, X0-NUM-842,
 *     X0-NUM-843, X0-NUM-844, X0-NUM-845, X0-NUM-846, X0-NUM-847, X0-NUM-848, X0-NUM-849, X0-NUM-850,
 *     X0-NUM-851, X0-NUM-852, X0-NUM-853, X0-NUM-854, X0-NUM-855, X0-NUM-856, X0-NUM-857, X0-NUM-867,
 *     X0-NUM-868, X0-NUM-870, X0-NUM-871
 */
static void test_every_printed_trace(void)
{
    char row[2048];
    FILE *list = fopen(X0_LIST, "r");
    TEST_ASSERT_NOT_NULL(list);
    rows = replayed = 0;
    while (fgets(row, sizeof row, list) != NULL) {
        if (strncmp(row, "| X0-NUM-8", 10) == 0) {
            check_row(row);
        }
    }
    (void)fclose(list);
    TEST_ASSERT_EQUAL(59, rows);
    TEST_ASSERT_EQUAL(2 * 66, replayed);
}

/* proves: X0-NUM-869 */
static void test_probe_after_boot(void)
{
    static const struct {
        const char *part, *expected;
    } c[] = {{"bq7694003", "S 10+ 09+ S 11+ ac 0f 97 ec P"}, {"bq7694000", "S 10+ 09+ S 11+ ac 97 00 00 P"}};
    for (unsigned i = 0; i < 2u; i++) {
        char got[128];
        TEST_ASSERT_EQUAL(0, sim_x0_init(&chip, sim_x0_find_part(c[i].part), NULL));
        (void)sim_x0_boot(&chip, 3000000);
        sim_x0_advance(&chip, 20000000);
        replay("S 10+ 09+ S 11+ 00 00 00 00 P", false, got);
        TEST_ASSERT_EQUAL_STRING(c[i].expected, got);
    }
}

/* proves: X0-NUM-855, X0-NUM-856, X0-NUM-857, X0-I2C-17, X0-AMB-79, X0-AMB-80, X0-AMB-81 */
static void test_what_a_bad_crc_leaves(void)
{
    char got[128];
    boot("bq7694003");
    replay("S 10+ 0b+ 19+ 7b- P", false, got);
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_x0_peek(&chip, 0x0b));
    replay("S 10+ 06+ 8b+ 64+ 5a+ 01- 50- b7- P", false, got);
    TEST_ASSERT_EQUAL_HEX8(0x8b, sim_x0_peek(&chip, 0x06));
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_x0_peek(&chip, 0x07));
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_x0_peek(&chip, 0x08));
    replay("S 10+ 0b+ 19+ P", false, got);
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_x0_peek(&chip, 0x0b));
}

/* proves: X0-NUM-870, X0-NUM-871, X0-I2C-18 */
static void test_crc_frame_on_a_part_without(void)
{
    char got[128];
    boot("bq7694000");
    replay("S 10+ 0b+ 19+ 7a+ P", false, got);
    TEST_ASSERT_EQUAL_HEX8(0x19, sim_x0_peek(&chip, 0x0b));
    TEST_ASSERT_EQUAL_HEX8(0x0d, chip.i2c.pointer);
    replay("S 10+ 06+ 8b+ 64+ P", false, got);
    TEST_ASSERT_EQUAL_HEX8(0x8b, sim_x0_peek(&chip, 0x06));
    TEST_ASSERT_EQUAL_HEX8(0x64, sim_x0_peek(&chip, 0x07));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_printed_trace);
    RUN_TEST(test_probe_after_boot);
    RUN_TEST(test_what_a_bad_crc_leaves);
    RUN_TEST(test_crc_frame_on_a_part_without);
    return UNITY_END();
}
