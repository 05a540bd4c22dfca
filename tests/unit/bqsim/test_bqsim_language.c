/* SPDX-License-Identifier: Apache-2.0 */
/* The command language: every command, every notation, and that a refused command changes nothing. */
#include "bqsim.h"
#include "unity.h"
#include <stdio.h>
#include <string.h>

static bqsim_session session;
static char reply[BQSIM_REPLY_MAX];

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

static void silent(const char *line)
{
    reply[0] = 'x';
    TEST_ASSERT_EQUAL_MESSAGE(BQSIM_SILENT, bqsim_exec(&session, line, reply, sizeof reply), line);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", reply, line);
}

static void test_blank_and_comment_lines_have_no_reply(void)
{
    silent("");
    silent("\n");
    silent("\r\n");
    silent(" \t ");
    silent("# stack 3");
    silent("  # indented");
    refused("get pin.conv");
}

static void test_comments_and_line_ends_are_cut_off(void)
{
    expect("stack 2 # two devices\r\n", "ok");
    expect("\tget  dev.2.supply\t\n", "ok on");
    expect("get dev.1.gpai#text", "ok 0");
    expect("get dev.1.tdie\r", "ok 25");
}

static void test_everything_needs_a_stack(void)
{
    refused("spi 00 00 01 00 00");
    refused("set dev.1.cell.1 3.5");
    refused("get dev.1.cell.1");
    refused("set pin.conv 1");
    refused("get pin.fault");
    refused("peek dev.1 00");
    refused("inject mosi 0");
    refused("inject miso 0");
    expect("advance 1s", "ok");
}

static void test_stack_takes_one_number_from_1_to_62(void)
{
    static const char *const bad[] = {"stack",
                                      "stack 0",
                                      "stack 63",
                                      "stack -1",
                                      "stack +1",
                                      "stack 1.0",
                                      "stack 0x2",
                                      "stack a",
                                      "stack 01",
                                      "stack 2 3",
                                      "stack 99999999999999999999",
                                      "stack 1e1",
                                      "Stack 1",
                                      "stack,1"};

    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        refused(bad[i]);
        refused("get dev.1.supply");
    }
    expect("stack 1", "ok");
    refused("get dev.2.supply");
    expect("stack 62", "ok");
    expect("get dev.62.supply", "ok on");
    refused("get dev.63.supply");
    refused("stack 63");
    expect("get dev.62.supply", "ok on");
}

static void test_a_second_stack_replaces_the_first(void)
{
    expect("stack 2", "ok");
    expect("set dev.*.cell.3 1.5", "ok");
    expect("set dev.2.vbat 12", "ok");
    expect("set dev.1.gpio 0", "ok");
    expect("stack 2", "ok");
    expect("get dev.2.cell.3", "ok 3.600");
    expect("get dev.2.vbat", "ok sum");
    expect("get dev.1.gpio", "ok 1");
}

static void test_defaults(void)
{
    static const char *const table[][2] = {
        {"get dev.1.cell.1", "ok 3.600"}, {"get dev.1.cell.6", "ok 3.600"}, {"get dev.1.vbat", "ok sum"},
        {"get dev.1.ts.1", "ok 0.1369"},  {"get dev.1.ts.2", "ok 0.1369"},  {"get dev.1.gpai", "ok 0"},
        {"get dev.1.gpio", "ok 1"},       {"get dev.1.tdie", "ok 25"},      {"get dev.1.supply", "ok on"},
        {"get dev.1.otp.40", "ok 00"},    {"get dev.1.otp.4b", "ok 00"},    {"get dev.1.vpp", "ok off"},
        {"get pin.conv", "ok 0"},         {"get dev.1.cb", "ok 00"},        {"get dev.1.mode", "ok active"},
        {"get pin.fault", "ok 1"},        {"get pin.alert", "ok 1"},        {"get pin.drdy", "ok 1"},
    };

    expect("stack 1", "ok");
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        expect(table[i][0], table[i][1]);
    }
}

static void test_what_is_set_reads_back(void)
{
    static const char *const table[][3] = {
        {"cell.1", "3.650", "ok 3.650"},
        {"cell.2", "4.2", "ok 4.200"},
        {"cell.6", "3.123456789", "ok 3.123456789"},
        {"cell.3", "-0.5", "ok -0.500"},
        {"cell.4", "0", "ok 0.000"},
        {"cell.5", "-0", "ok 0.000"},
        {"vbat", "21.6", "ok 21.600"},
        {"vbat", "sum", "ok sum"},
        {"ts.1", "0.5", "ok 0.5"},
        {"ts.2", "0.13242", "ok 0.13242"},
        {"gpai", "1.25", "ok 1.25"},
        {"gpai", "-0.001", "ok -0.001"},
        {"gpio", "0", "ok 0"},
        {"gpio", "1", "ok 1"},
        {"tdie", "-40", "ok -40"},
        {"tdie", "84.5", "ok 84.5"},
        {"supply", "off", "ok off"},
        {"supply", "on", "ok on"},
        {"otp.42", "2c", "ok 2c"},
        {"otp.4B", "A5", "ok a5"},
        {"vpp", "on", "ok on"},
        {"vpp", "off", "ok off"},
        {"gpai", "1.5e-05", "ok 0.000015"},
        {"tdie", "+30.", "ok 30"},
        {"cell.1", ".5", "ok 0.500"},
        {"cell.1", "3600e-3", "ok 3.600"},
    };
    char line[80];

    expect("stack 3", "ok");
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        (void)snprintf(line, sizeof line, "set dev.2.%s %s", table[i][0], table[i][1]);
        expect(line, "ok");
        (void)snprintf(line, sizeof line, "get dev.2.%s", table[i][0]);
        expect(line, table[i][2]);
    }
    expect("set pin.conv 1", "ok");
    expect("get pin.conv", "ok 1");
    expect("set pin.conv 0", "ok");
    expect("get pin.conv", "ok 0");
}

static void test_star_sets_all_devices_and_only_sets(void)
{
    expect("stack 3", "ok");
    expect("set dev.*.cell.2 2.5", "ok");
    expect("get dev.1.cell.2", "ok 2.500");
    expect("get dev.2.cell.2", "ok 2.500");
    expect("get dev.3.cell.2", "ok 2.500");
    expect("get dev.3.cell.1", "ok 3.600");
    expect("set dev.*.otp.42 80", "ok");
    expect("get dev.3.otp.42", "ok 80");
    refused("get dev.*.cell.2");
    refused("peek dev.* 00");
    refused("set dev.*.cell.* 1");
    refused("set dev.*.cell.2 nan");
    expect("get dev.3.cell.2", "ok 2.500");
}

static void test_values_that_cannot_be_are_refused_and_change_nothing(void)
{
    static const char *const number[] = {
        "nan", "inf",   "-inf",    "NaN",      "INFINITY",   "0x3", "3.6V", "3,6", "3.6 x",
        "",    "1e999", "-1e999",  "--1",      "1..2",       ".",   "+",    "e5",  "1e",
        "1e+", "3.6.",  "3.6\x01", "\xc3\xa9", "1000000000", "sum", "on"};
    char line[80];

    expect("stack 2", "ok");
    expect("set dev.*.cell.1 3.3", "ok");
    for (size_t i = 0; i < sizeof number / sizeof number[0]; i++) {
        (void)snprintf(line, sizeof line, "set dev.1.cell.1 %s", number[i]);
        refused(line);
        (void)snprintf(line, sizeof line, "set dev.*.cell.1 %s", number[i]);
        refused(line);
    }
    expect("get dev.1.cell.1", "ok 3.300");
    expect("get dev.2.cell.1", "ok 3.300");
    refused("set dev.1.vbat -1");
    refused("set dev.1.vbat -0.001");
    refused("set dev.1.vbat Sum");
    expect("get dev.1.vbat", "ok sum");
    refused("set dev.1.gpio 2");
    refused("set dev.1.gpio 00");
    refused("set dev.1.gpio on");
    expect("get dev.1.gpio", "ok 1");
    refused("set dev.1.supply 0");
    refused("set dev.1.supply OFF");
    refused("set dev.1.supply off now");
    expect("get dev.1.supply", "ok on");
    refused("set dev.1.otp.42 0");
    refused("set dev.1.otp.42 100");
    refused("set dev.1.otp.42 0x10");
    refused("set dev.1.otp.42 4g");
    expect("get dev.1.otp.42", "ok 00");
    refused("set pin.conv 2");
    refused("set pin.conv on");
    refused("set pin.conv 1 1");
    expect("get pin.conv", "ok 0");
}

static void test_unknown_and_read_only_paths_are_refused(void)
{
    static const char *const bad[] = {
        "set dev.1.cell.0 3",  "set dev.1.cell.7 3",
        "set dev.1.cell 3",    "set dev.1.cell.1.1 3",
        "set dev.1.cell. 3",   "set dev.1. 3",
        "set dev.1 3",         "set dev. 3",
        "set dev 3",           "set dev.0.cell.1 3",
        "set dev.3.cell.1 3",  "set dev.01.cell.1 3",
        "set dev.-1.cell.1 3", "set dev.1.cell.01 3",
        "set dev.1.ts.0 0.1",  "set dev.1.ts.3 0.1",
        "set dev.1.otp.3f 00", "set dev.1.otp.4c 00",
        "set dev.1.otp.4 00",  "set dev.1.otp.64 00",
        "set dev.1.vbat.1 3",  "set dev.1.nothing 3",
        "set dev.1.cb 00",     "set dev.1.mode active",
        "set pin.fault 0",     "set pin.alert 0",
        "set pin.drdy 0",      "set pin. 0",
        "set pin 0",           "set",
        "set dev.1.cell.1",    "set cell.1 3",
        "set .dev.1.cell.1 3", "get",
        "get dev.1",           "get dev.0.cell.1",
        "peek dev.0 00",       "get dev.1.cell.1 x",
        "get pin.conv x",      "get pin.none",
        "get dev.1.cb.1",      "get nothing",
        "get DEV.1.cb",        "get dev.1.otp.40 00",
    };

    expect("stack 2", "ok");
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        refused(bad[i]);
    }
    expect("get dev.1.cell.1", "ok 3.600");
    expect("get dev.1.otp.40", "ok 00");
}

static void test_times(void)
{
    static const char *const good[][2] = {
        {"1us", "1000"},         {"1ms", "1000000"},      {"1s", "1000000000"},
        {"1min", "60000000000"}, {"1h", "3600000000000"}, {"0us", "0"},
        {"0.5us", "500"},        {"1.5ms", "1500000"},    {"1e3us", "1000000"}};
    static const char *const bad[] = {
        "advance",       "advance 1",    "advance us", "advance -1us",    "advance -0.0001us", "advance 1 us",
        "advance 1ns",   "advance 1d",   "advance 1S", "advance 1us 1us", "advance nanus",     "advance infs",
        "advance 1e30h", "advance 0x1s", "advance 1m", "advance 1mins",   "advance 3000000h"};

    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        char line[40], now[40];

        bqsim_init(&session, NULL);
        (void)snprintf(line, sizeof line, "advance %s", good[i][0]);
        expect(line, "ok");
        (void)snprintf(now, sizeof now, "%llu", (unsigned long long)session.now_ns);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(good[i][1], now, line);
    }
    bqsim_init(&session, NULL);
    expect("stack 1", "ok");
    expect("advance 10h", "ok");
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        refused(bad[i]);
    }
    TEST_ASSERT_EQUAL_UINT64(36000ull * 1000000000ull, session.now_ns);
    TEST_ASSERT_EQUAL_UINT64(36000ull * 1000000000ull, sim_pl_now(&session.stack));
}

static void test_simulated_time_has_an_end(void)
{
    expect("stack 1", "ok");
    expect("advance 2000000h", "ok");
    refused("advance 2000000h");
    expect("advance 500000h", "ok");
    TEST_ASSERT_EQUAL_UINT64(9000000000ull * 1000000000ull, sim_pl_now(&session.stack));
}

static void test_simulated_time_moves_only_with_advance(void)
{
    expect("stack 2", "ok");
    expect("spi 00 00 01 00 00", "ok -- -- -- 61 35");
    expect("set dev.*.cell.1 2", "ok");
    expect("get dev.1.mode", "ok active");
    TEST_ASSERT_EQUAL_UINT64(0, sim_pl_now(&session.stack));
}

static void test_peek(void)
{
    expect("stack 2", "ok");
    expect("peek dev.1 00", "ok 61");
    expect("peek dev.2 20", "ok 80");
    expect("peek dev.2 21", "ok 09");
    expect("peek dev.1 ff", "ok 00");
    refused("peek");
    refused("peek dev.1");
    refused("peek dev.3 00");
    refused("peek dev.1 0");
    refused("peek dev.1 000");
    refused("peek dev.1 0x0");
    refused("peek dev.1 00 00");
    refused("peek dev 00");
    refused("peek dev.1.cell 00");
    refused("peek pin.conv 00");
}

static void test_unknown_commands(void)
{
    refused("hello");
    refused("GET pin.conv");
    refused("ok");
    refused("\x01\xff");
    TEST_ASSERT_EQUAL_STRING("err unknown command: ??", reply);
    refused("stack\v1");
    refused("stack 1\f");
}

static void test_quit(void)
{
    refused("quit now");
    TEST_ASSERT_EQUAL(BQSIM_QUIT, bqsim_exec(&session, "quit # end", reply, sizeof reply));
    TEST_ASSERT_EQUAL_STRING("ok", reply);
}

static void test_nul_is_refused_outside_comments(void)
{
    static const char middle[] = "stack 1\0 2", name[] = "st\0ck 1", comment[] = "stack 1 # \0";

    TEST_ASSERT_EQUAL(BQSIM_ERR, bqsim_exec_n(&session, middle, sizeof middle - 1, reply, sizeof reply));
    TEST_ASSERT_EQUAL(BQSIM_ERR, bqsim_exec_n(&session, name, sizeof name - 1, reply, sizeof reply));
    refused("get pin.conv");
    TEST_ASSERT_EQUAL(BQSIM_OK, bqsim_exec_n(&session, comment, sizeof comment - 1, reply, sizeof reply));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_blank_and_comment_lines_have_no_reply);
    RUN_TEST(test_comments_and_line_ends_are_cut_off);
    RUN_TEST(test_everything_needs_a_stack);
    RUN_TEST(test_stack_takes_one_number_from_1_to_62);
    RUN_TEST(test_a_second_stack_replaces_the_first);
    RUN_TEST(test_defaults);
    RUN_TEST(test_what_is_set_reads_back);
    RUN_TEST(test_star_sets_all_devices_and_only_sets);
    RUN_TEST(test_values_that_cannot_be_are_refused_and_change_nothing);
    RUN_TEST(test_unknown_and_read_only_paths_are_refused);
    RUN_TEST(test_times);
    RUN_TEST(test_simulated_time_has_an_end);
    RUN_TEST(test_simulated_time_moves_only_with_advance);
    RUN_TEST(test_peek);
    RUN_TEST(test_unknown_commands);
    RUN_TEST(test_quit);
    RUN_TEST(test_nul_is_refused_outside_comments);
    return UNITY_END();
}
