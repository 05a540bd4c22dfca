/* SPDX-License-Identifier: Apache-2.0 */
/* Seeded random and mutated lines: every one gets a well-formed reply, and a refused line leaves the whole
 * session as it was. */
#include "bqsim.h"
#include "unity.h"
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LINE 400

static bqsim_session session, before;
static char reply[BQSIM_REPLY_MAX];
static uint64_t rng;

void setUp(void)
{
    rng = 0x9e3779b97f4a7c15ull;
    bqsim_init(&session, NULL);
}

void tearDown(void)
{
}

static uint32_t chance(uint32_t n)
{
    rng ^= rng << 13;
    rng ^= rng >> 7;
    rng ^= rng << 17;
    return (uint32_t)((rng >> 11) % n);
}

static const char *const seeds[] = {
    "stack 3",
    "stack 1",
    "stack 62",
    "advance 10ms",
    "advance 3s",
    "advance 1.5min",
    "advance 7us",
    "set dev.1.cell.3 4.25",
    "set dev.*.cell.6 2.1",
    "set dev.2.vbat 21.6",
    "set dev.2.vbat sum",
    "set dev.*.ts.1 0.42",
    "set dev.1.gpai 1.25",
    "set dev.3.gpio 0",
    "set dev.1.tdie 143",
    "set dev.1.tdie 25",
    "set dev.2.supply off",
    "set dev.*.supply on",
    "set dev.1.otp.42 2c",
    "set dev.1.vpp on",
    "set dev.1.vpp off",
    "set pin.conv 1",
    "set pin.conv 0",
    "get dev.1.cell.3",
    "get dev.1.mode",
    "get dev.2.cb",
    "get pin.fault",
    "get pin.drdy",
    "peek dev.1 21",
    "peek dev.3 3b",
    "inject mosi 12",
    "inject miso 30",
    "inject sda 4",
    "i2c S 10 P",
    "afe bq7694003",
    "set afe.boot 3ms",
    "set afe.cell.4 4.3",
    "set afe.sense -0.06",
    "set afe.alert.ext 1",
    "set afe.supply off",
    "get afe.cb",
    "peek afe 04",
    "i2c S 10 04 S 11 r n P",
    "i2c S 10 05 43 2d P",
    "spi 7f 3c a5 57",
    "spi 01 3b 01 02",
    "spi 01 3b 02 0b",
    "spi 01 3b 03 0c",
    "spi 02 3b 01 00 00",
    "spi 7f 34 01 8a",
    "spi 7f 30 7d ad",
    "spi 7f 3a 35 d0",
    "spi 7f 40 50 cc",
    "spi 7f 42 2c 95",
    "spi 7f 43 85 d6",
    "spi 7f 3a 27 ae",
    "spi 03 33 1e 21",
    "spi 03 32 12 10",
    "spi 7f 31 04 d0",
    "spi 7f 31 03 c5",
    "spi 03 3f 91 79",
    "spi 7f 41 01 69",
    "spi 02 03 0c 00 00 00 00 00 00 00 00 00",
    "# comment",
    "",
};

static size_t mutate(char *line)
{
    size_t n;

    n = (size_t)snprintf(line, LINE, "%s", seeds[chance(sizeof seeds / sizeof seeds[0])]);
    for (uint32_t edits = chance(4); edits > 0 && n > 0 && n + 2 < LINE; edits--) {
        size_t at = chance((uint32_t)n);

        switch (chance(5)) {
        case 0:
            line[at] = (char)chance(256);
            break;
        case 1:
            memmove(&line[at], &line[at + 1], n - at);
            n--;
            break;
        case 2:
            memmove(&line[at + 1], &line[at], n - at);
            line[at] = "0123456789abcdef .*-#\t\r"[chance(23)];
            n++;
            break;
        case 3:
            n = at;
            break;
        default:
            line[at] = (char)(line[at] ^ (1 << chance(7)));
            break;
        }
    }
    return n;
}

static size_t noise(char *line)
{
    size_t n = chance(LINE);

    for (size_t i = 0; i < n; i++) {
        line[i] = (char)chance(256);
    }
    return n;
}

/* A packet that may mean something: any header, any length, now and then the right CRC. */
static size_t packet(char *line)
{
    size_t bytes = 1 + chance(30), n = 3;
    uint8_t crc = 0;

    memcpy(line, "spi", 4);
    for (size_t i = 0; i < bytes; i++) {
        uint8_t byte = (uint8_t)chance(256);

        if (i == 0 && chance(2)) {
            byte = (uint8_t)(chance(4) << 1 | 1);
        }
        if (i == 3 && chance(4) != 0) {
            byte = crc;
            bytes = 4;
        }
        crc ^= byte;
        for (int b = 0; b < 8; b++) {
            crc = (uint8_t)(crc << 1 ^ (crc & 0x80 ? 7 : 0));
        }
        n += (size_t)snprintf(&line[n], LINE - n, " %02x", byte);
    }
    return n;
}

static void check_reply(bqsim_result result)
{
    size_t n = strlen(reply);

    if (result == BQSIM_SILENT) {
        TEST_ASSERT_EQUAL(0, n);
        return;
    }
    for (size_t i = 0; i < n; i++) {
        TEST_ASSERT_TRUE(reply[i] >= ' ' && reply[i] <= '~');
    }
    if (result == BQSIM_ERR) {
        TEST_ASSERT_EQUAL(0, strncmp(reply, "err ", 4));
    } else {
        TEST_ASSERT_EQUAL(0, strncmp(reply, "ok", 2));
        TEST_ASSERT_TRUE(reply[2] == '\0' || reply[2] == ' ');
    }
}

/* Everything but the scratch buffers of a packet. */
static bool same_world(void)
{
    return session.now_ns == before.now_ns && session.has_stack == before.has_stack &&
           memcmp(&session.stack, &before.stack, sizeof session.stack) == 0 &&
           memcmp(session.vbat_is_sum, before.vbat_is_sum, sizeof session.vbat_is_sum) == 0 &&
           memcmp(session.gpio_level, before.gpio_level, sizeof session.gpio_level) == 0 &&
           session.has_afe == before.has_afe && memcmp(&session.afe, &before.afe, sizeof session.afe) == 0 &&
           session.mosi.count == before.mosi.count && session.miso.count == before.miso.count;
}

static void step(const char *line, size_t n)
{
    bqsim_result result;

    memcpy(&before, &session, offsetof(bqsim_session, tx));
    result = bqsim_exec_n(&session, line, n, reply, sizeof reply);
    check_reply(result);
    if (result == BQSIM_ERR || result == BQSIM_SILENT) {
        TEST_ASSERT_TRUE_MESSAGE(same_world(), reply);
    }
}

static void test_mutated_sessions(void)
{
    char line[LINE + 1];
    int accepted = 0;

    for (int i = 0; i < 6000; i++) {
        size_t n = chance(4) == 0 ? packet(line) : mutate(line);

        if (i % 200 == 0) {
            n = (size_t)snprintf(line, sizeof line, "stack %u", 1 + (unsigned)chance(4));
        }
        step(line, n);
        accepted += strncmp(reply, "ok", 2) == 0;
    }
    TEST_ASSERT_GREATER_THAN(2000, accepted); /* the run reaches the model, not only the refusals */
    TEST_ASSERT_LESS_THAN(5900, accepted);
}

static void test_pure_noise(void)
{
    char line[LINE + 1];

    step("stack 2", 7);
    for (int i = 0; i < 3000; i++) {
        step(line, noise(line));
    }
}

static void test_small_reply_buffers(void)
{
    char line[LINE + 1];

    step("stack 2", 7);
    for (int i = 0; i < 2000; i++) {
        size_t size = 1 + chance(40), n = mutate(line);
        char *exact =
            malloc(size); /* of exactly this size, so that a write beyond it is seen by the sanitizer */

        TEST_ASSERT_NOT_NULL(exact);
        (void)bqsim_exec_n(&session, line, n, exact, size);
        TEST_ASSERT_TRUE(memchr(exact, '\0', size) != NULL);
        free(exact);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_mutated_sessions);
    RUN_TEST(test_pure_noise);
    RUN_TEST(test_small_reply_buffers);
    return UNITY_END();
}
