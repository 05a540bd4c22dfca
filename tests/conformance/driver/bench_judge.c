/* SPDX-License-Identifier: Apache-2.0 */
/* What may stand on the wire at all: the shape of every packet that the driver sent since the last mark. */
#include "bench.h"

static void judge_write(const bench_packet *p, const char *where)
{
    static const uint8_t may[256] = {
        [0x20] = 0xff, [0x21] = 0x3f, [0x30] = 0x7f, [0x31] = 0xc7, [0x32] = 0x3f, [0x33] = 0xbf,
        [0x34] = 0x01, [0x3a] = 0x37, [0x3b] = 0xbf, [0x3c] = 0xa5, [0x3f] = 0x91, [0x40] = 0xfc,
        [0x41] = 0x01, [0x42] = 0xbf, [0x43] = 0x9f, [0x44] = 0x9f, [0x45] = 0x9f, [0x46] = 0xff,
        [0x47] = 0xff, [0x48] = 0xff, [0x49] = 0xff, [0x4a] = 0xff, [0x4b] = 0xff,
    };
    uint8_t reg = p->tx[1], value = p->tx[2];
    if (b.driver.config.crc_off || b.driver.crc == false) {
        return; /* the framing without CRC is judged by the test that uses it */
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(4, p->n, where);
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(bench_crc(p->tx, 3), p->tx[3], where);
    TEST_ASSERT_TRUE_MESSAGE(may[reg] != 0, where);
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(0, value & (uint8_t)~may[reg], where);
    if (reg == 0x20 || reg == 0x21) { /* FORCE only alone */
        TEST_ASSERT_TRUE_MESSAGE((value & 0x10) == 0 || value == 0x10, where);
    }
    if (reg == 0x3b) {
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(0x01, p->tx[0], where);
        TEST_ASSERT_TRUE_MESSAGE((value & 0x3f) != 0 && (value & 0x3f) != 0x3f, where);
    }
    if (reg == 0x3c) {
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(0xa5, value, where);
    }
    if (reg == 0x3a) {
        TEST_ASSERT_TRUE_MESSAGE(value == 0x35 || value == 0x27, where);
    }
}

static void judge_read(const bench_packet *p, const char *where)
{
    if (b.driver.config.crc_off || b.driver.crc == false) {
        return;
    }
    TEST_ASSERT_TRUE_MESSAGE(p->n >= 5, where);
    TEST_ASSERT_EQUAL_INT_MESSAGE(p->tx[2] + 4, p->n, where);
    TEST_ASSERT_TRUE_MESSAGE(p->tx[1] + p->tx[2] - 1 <= 0x4b, where);
    TEST_ASSERT_TRUE_MESSAGE(p->tx[0] != 0x7e, where);
    TEST_ASSERT_TRUE_MESSAGE(p->tx[1] != 0x34, where); /* CONV is never polled */
    for (int i = 3; i < p->n; i++) {
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(0x00, p->tx[i], where);
    }
}

/* A 16-bit result is never split, a group-3 write follows its key directly, and a key is followed by a
 * group-3 write. */
static void judge_order(int i, const char *where)
{
    const bench_packet *p = &b.log[i];
    if (IS_WRITE(p) && p->tx[1] >= 0x40 && p->tx[1] <= 0x4b) {
        TEST_ASSERT_TRUE_MESSAGE(i > 0, where);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(0x3a, p[-1].tx[1], where);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(0x35, p[-1].tx[2], where);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(p->tx[0], p[-1].tx[0], where);
    }
    if (IS_READ(p) && p->tx[1] >= 0x01 && p->tx[1] <= 0x12) {
        int first = p->tx[1], last = first + p->tx[2] - 1;
        TEST_ASSERT_TRUE_MESSAGE((first & 1) == 1 && (last & 1) == 0, where);
    }
}

/* 1, then 0 directly after it, to the same device (PL-FLT-12); FORCE stays for the length of a self-test. */
static void judge_pair(int i, int end, const char *where)
{
    const bench_packet *p = &b.log[i];
    if (IS_WRITE(p) && (p->tx[1] == 0x20 || p->tx[1] == 0x21) && p->tx[2] != 0 && p->tx[2] != 0x10 &&
        i + 1 < end && b.packets == b.transfers) {
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(p->tx[0], p[1].tx[0], where);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(p->tx[1], p[1].tx[1], where);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(0x00, p[1].tx[2], where);
    }
}

void bench_judge_packets(void)
{
    int end = b.packets < BENCH_LOG ? (int)b.packets : BENCH_LOG;
    for (int i = 0; i < end; i++) {
        const bench_packet *p = &b.log[i];
        const char *where = bench_text("packet %d at %lu us: %02x %02x %02x %02x", i, (unsigned long)p->t_us,
                                       p->tx[0], p->tx[1], p->tx[2], p->n > 3 ? p->tx[3] : 0);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(0, p->tx[0] & 0x80, where);
        if (IS_WRITE(p)) {
            judge_write(p, where);
        } else {
            judge_read(p, where);
        }
        judge_order(i, where);
        judge_pair(i, end, where);
    }
}
