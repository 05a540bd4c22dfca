/* SPDX-License-Identifier: Apache-2.0 */
/* Packets on the command line: notation, armed bit flips, long lines. */
#include "bqsim.h"
#include "unity.h"
#include <stdio.h>
#include <string.h>

static bqsim_session session;
static char reply[BQSIM_REPLY_MAX];
static char longest[BQSIM_LINE_MAX + 16];

void setUp(void)
{
    bqsim_init(&session, NULL);
}

void tearDown(void)
{
}

static void expect(const char *line, const char *expected)
{
    bqsim_result result = bqsim_exec(&session, line, reply, sizeof reply);

    TEST_ASSERT_EQUAL_STRING_MESSAGE(expected, reply, line);
    TEST_ASSERT_EQUAL_MESSAGE(BQSIM_OK, result, line);
}

static void refused(const char *line)
{
    bqsim_result result = bqsim_exec(&session, line, reply, sizeof reply);

    TEST_ASSERT_EQUAL_MESSAGE(BQSIM_ERR, result, line);
    TEST_ASSERT_TRUE_MESSAGE(strncmp(reply, "err ", 4) == 0 && reply[4] != '\0', line);
    TEST_ASSERT_NULL(strchr(reply, '\n'));
}

static void test_spi_bytes_are_two_hex_digits(void)
{
    static const char *const bad[] = {"spi",           "spi 0",
                                      "spi 000",       "spi 0x00",
                                      "spi 00 0",      "spi 00 00 01 00 0g",
                                      "spi 00,00",     "spi -1",
                                      "spi +1 00",     "spi 00 00 01 00 00 zz",
                                      "spi 0001000000"};

    expect("stack 1", "ok");
    expect("inject miso 24", "ok");
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        refused(bad[i]);
    }
    expect("spi 00 00 01 00 00", "ok -- -- -- e1 35"); /* the armed bit was not used up by a refused packet */
}

static void test_upper_case_digits_are_digits(void)
{
    expect("stack 1", "ok");
    expect("spi 01 3B 01 02", "ok -- -- -- --");
    expect("spi 02 3B 01 00 00", "ok -- -- -- 81 ba");
    expect("peek dev.1 3B", "ok 81");
}

static void test_inject_flips_the_bits_of_one_packet(void)
{
    expect("stack 1", "ok");
    expect("inject miso 24",
           "ok"); /* bit 0 is the first on the wire: 24 is the highest bit of the fourth byte */
    expect("spi 00 00 01 00 00", "ok -- -- -- e1 35");
    expect("spi 00 00 01 00 00", "ok -- -- -- 61 35");
    expect("inject miso 24", "ok");
    expect("inject miso 39", "ok");
    expect("spi 00 00 01 00 00", "ok -- -- -- e1 34");
    expect("spi 00 00 01 00 00", "ok -- -- -- 61 35");
    expect("inject mosi 14", "ok"); /* register 00 becomes 02 */
    expect("spi 00 00 01 00 00", "ok -- -- -- 00 c3");
    expect("spi 00 00 01 00 00", "ok -- -- -- 61 35");
    expect("inject mosi 8", "ok"); /* two bits: register 00 becomes 82 */
    expect("inject mosi 14", "ok");
    expect("spi 00 00 01 00 00", "ok -- -- -- 00 c8");
    expect("inject mosi 14", "ok"); /* twice the same bit: no change */
    expect("inject mosi 14", "ok");
    expect("spi 00 00 01 00 00", "ok -- -- -- 61 35");
    expect("inject miso 8000", "ok"); /* beyond the packet: used up without effect */
    expect("spi 00 00 01 00 00", "ok -- -- -- 61 35");
    expect("inject miso 24", "ok");
    expect("stack 1", "ok"); /* a new stack has nothing armed */
    expect("spi 00 00 01 00 00", "ok -- -- -- 61 35");
}

static void test_inject_is_checked(void)
{
    static const char *const bad[] = {
        "inject",          "inject mosi",          "inject miso",     "inject mosi -1", "inject mosi 1.0",
        "inject mosi 0x1", "inject mosi 99999999", "inject mosi 1 1", "inject sclk 1",  "inject MOSI 1"};

    expect("stack 1", "ok");
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        refused(bad[i]);
    }
    expect("spi 00 00 01 00 00", "ok -- -- -- 61 35");
    for (int i = 0; i < BQSIM_FLIPS; i++) {
        expect("inject miso 24", "ok");
    }
    refused("inject miso 24");
    expect("spi 00 00 01 00 00", "ok -- -- -- 61 35"); /* an even number of flips */
}

static void test_long_lines(void)
{
    size_t n;

    expect("stack 1", "ok");
    n = (size_t)snprintf(longest, sizeof longest, "spi");
    while (n + 3 <= 65536) {
        memcpy(&longest[n], " 00", 4);
        n += 3;
    }
    TEST_ASSERT_EQUAL(BQSIM_OK, bqsim_exec(&session, longest, reply, sizeof reply));
    TEST_ASSERT_EQUAL(n - 1, strlen(reply));                                  /* ok is one shorter than spi */
    TEST_ASSERT_EQUAL(BQSIM_ERR, bqsim_exec(&session, longest, reply, 1000)); /* a reply that does not fit */
    memset(longest, ' ', sizeof longest);
    memcpy(longest, "get", 3);
    memcpy(&longest[BQSIM_LINE_MAX - 8], "pin.conv", 9);
    expect(longest, "ok 0");
    longest[BQSIM_LINE_MAX] = ' ';
    longest[BQSIM_LINE_MAX + 1] = '\0';
    refused(longest);
    memset(longest, '7', sizeof longest);
    memcpy(longest, "set dev.1.cell.1 ", 17);
    longest[70000] = '\0';
    refused(longest);
    expect("get dev.1.cell.1", "ok 3.600");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_spi_bytes_are_two_hex_digits);
    RUN_TEST(test_upper_case_digits_are_digits);
    RUN_TEST(test_inject_flips_the_bits_of_one_packet);
    RUN_TEST(test_inject_is_checked);
    RUN_TEST(test_long_lines);
    return UNITY_END();
}
