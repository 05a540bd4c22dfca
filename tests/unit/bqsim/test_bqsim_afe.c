/* SPDX-License-Identifier: Apache-2.0 */
/* The commands of the bq769x0 family: parts, bus tokens, every path, and that a refused command changes
 * nothing. */
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
}

static void boot(const char *part)
{
    char line[32];

    (void)snprintf(line, sizeof line, "afe %s", part);
    expect(line, "ok");
    expect("set afe.boot 2.5ms", "ok");
    expect("advance 1s", "ok");
    expect("get afe.mode", "ok normal");
}

static void test_nothing_works_without_an_afe(void)
{
    static const char *const lines[] = {"i2c S 10 P", "set afe.cell.1 3.6", "get afe.mode", "peek afe 00",
                                        "inject sda 3"};

    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        refused(lines[i]);
        TEST_ASSERT_EQUAL_STRING("err no afe", reply);
    }
}

/* proves: X0-VAR-21 */
static void test_the_fifteen_names_and_no_other(void)
{
    static const char *const suffix[] = {"00", "01", "02", "03", "06"};
    char line[32];

    for (int size = 2; size <= 4; size++) {
        for (size_t i = 0; i < 5; i++) {
            (void)snprintf(line, sizeof line, "afe bq769%d0%s", size, suffix[i]);
            expect(line, "ok");
            expect("get afe.mode", "ok ship");
        }
    }
    refused("afe");
    refused("afe bq7694004");
    refused("afe bq76940");
    refused("afe BQ7694003");
    refused("afe bq7694003PW");
    refused("afe bq7694003 x");
    expect("get afe.mode", "ok ship"); /* the last one is still there */
}

/* The example of the contract, and silence in SHIP. */
static void test_bus_tokens(void)
{
    expect("afe bq7694003", "ok");
    expect("i2c S 10 04 S 11 r n P", "ok S 10- 04- S 11- ff ff P");
    boot("bq7694003");
    expect("i2c S 10 04 18 be P", "ok S 10+ 04+ 18+ be+ P");
    expect("i2c S 10 04 S 11 r n P", "ok S 10+ 04+ S 11+ 18 0a P");
    expect("i2c S 10 0B 19 7b P", "ok S 10+ 0b+ 19+ 7b- P");
    expect("peek afe 0b", "ok 00");
    expect("i2c S 30 P", "ok S 30- P");
    expect("i2c S 10 04", "ok S 10+ 04+"); /* a transaction may go on in the next line */
    expect("i2c S 11 r n P", "ok S 11+ 18 0a P");
}

static void test_a_bad_line_moves_nothing(void)
{
    boot("bq7694003");
    refused("i2c");
    refused("i2c S 10 05 43 2d X");
    refused("i2c S 10 05 43 2d 1");
    refused("i2c S 10 05 43 2d 0x1");
    expect("peek afe 05", "ok 00");
    expect("get afe.chg", "ok 0");
    refused("peek afe");
    refused("peek afe 5");
    refused("peek afe 05 06");
    refused("peek afe.05 05");
}

/* proves: X0-I2C-27 */
static void test_injected_bits(void)
{
    boot("bq7694003");
    expect("inject sda 16", "ok"); /* the first bit of the data byte */
    expect("i2c S 10 0b 19 7a P", "ok S 10+ 0b+ 19+ 7a- P");
    expect("peek afe 0b", "ok 00");
    expect("i2c S 10 0b 19 7a P", "ok S 10+ 0b+ 19+ 7a+ P");
    expect("inject sda 0", "ok");
    expect("i2c S 10 0b P", "ok S 10- 0b- P");
    expect("inject sda 31", "ok"); /* last bit of the first byte read */
    expect("i2c S 10 0b S 11 r n P", "ok S 10+ 0b+ S 11+ 18 0d P");
    refused("inject sda");
    refused("inject sda -1");
    refused("inject sda 1 2");
}

static void test_paths_of_the_inputs(void)
{
    boot("bq7694003");
    expect("get afe.cell.15", "ok 3.600");
    expect("set afe.cell.15 3.65", "ok");
    expect("get afe.cell.15", "ok 3.650");
    expect("get afe.ts.3", "ok 10000");
    expect("set afe.ts.3 2500.5", "ok");
    expect("get afe.ts.3", "ok 2500.5");
    expect("get afe.tdie", "ok 25");
    expect("set afe.tdie -12", "ok");
    expect("get afe.sense", "ok 0");
    expect("set afe.sense -0.05", "ok");
    expect("get afe.sense", "ok -0.05");
    expect("get afe.chgpin", "ok 0");
    expect("set afe.chgpin 1.5", "ok");
    expect("get afe.gain", "ok 382");
    expect("set afe.gain 396", "ok");
    expect("get afe.offset", "ok 0");
    expect("set afe.offset -128", "ok");
    expect("get afe.offset", "ok -128");
    expect("get afe.alert.ext", "ok 0");
    expect("get afe.supply", "ok on");
}

static void test_refused_paths_and_values(void)
{
    static const char *const lines[] = {
        "set afe.cell.0 3",    "set afe.cell.6 3",   "set afe.cell 3",      "set afe.cell.1 nan",
        "set afe.cell.1",      "set afe.cell.1 3 4", "set afe.ts.2 10000",  "set afe.ts.1 -1",
        "set afe.gain 364",    "set afe.gain 397",   "set afe.gain 370.5",  "set afe.offset 128",
        "set afe.offset -129", "set afe.alert 1",    "set afe.alert.ext 2", "set afe.supply 1",
        "set afe.boot 3",      "get afe.boot",       "set afe.chg 1",       "set afe.mode ship",
        "set afe.cb 0000",     "get afe.cell.1.2",   "get afe.alert.ext.1", "get afe",
        "get afe.nothing",     "set afe.xready 2",   "get afe.mode now",    "set afe.ts.1 inf",
    };

    boot("bq7692003");
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        refused(lines[i]);
    }
    expect("get afe.cell.1", "ok 3.600");
    expect("get afe.gain", "ok 382");
    expect("get afe.offset", "ok 0");
}

/* proves: X0-ALERT-11, X0-FET-17 */
static void test_outputs(void)
{
    boot("bq7694003");
    expect("i2c S 10 05 03 ea P", "ok S 10+ 05+ 03+ ea+ P");
    expect("get afe.chg", "ok 1");
    expect("get afe.dsg", "ok 1");
    expect("i2c S 10 03 0a ab P", "ok S 10+ 03+ 0a+ ab+ P");
    expect("get afe.cb", "ok 2800");
    expect("get afe.alert", "ok 0");
    expect("set afe.alert.ext 1", "ok");
    expect("get afe.alert", "ok 1");
    expect("get afe.chg", "ok 0");
    expect("peek afe 00", "ok 10");
    expect("get afe.xready", "ok 0");
    expect("set afe.xready 1", "ok");
    expect("get afe.xready", "ok 1");
    expect("get afe.cb", "ok 0000");
}

static void test_supply_and_boot(void)
{
    boot("bq7693006");
    expect("set afe.supply off", "ok");
    expect("get afe.mode", "ok off");
    expect("set afe.boot 3ms", "ok"); /* a pulse on a part without supply */
    expect("get afe.mode", "ok off");
    expect("set afe.supply on", "ok");
    expect("get afe.mode", "ok ship");
    expect("set afe.boot 1.9ms", "ok");
    expect("get afe.mode", "ok ship");
    expect("set afe.boot 2ms", "ok");
    expect("get afe.mode", "ok boot");
    refused("set afe.xready 1"); /* nothing is alive yet that could fail */
    expect("advance 10ms", "ok");
    expect("get afe.mode", "ok normal");
}

static void test_stack_and_afe_side_by_side(void)
{
    expect("stack 2", "ok");
    boot("bq7694003");
    expect("get dev.2.mode", "ok active");
    expect("stack 1", "ok");
    expect("get afe.mode", "ok normal");
    expect("afe bq7692000", "ok");
    expect("get dev.1.mode", "ok active");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_nothing_works_without_an_afe);
    RUN_TEST(test_the_fifteen_names_and_no_other);
    RUN_TEST(test_bus_tokens);
    RUN_TEST(test_a_bad_line_moves_nothing);
    RUN_TEST(test_injected_bits);
    RUN_TEST(test_paths_of_the_inputs);
    RUN_TEST(test_refused_paths_and_values);
    RUN_TEST(test_outputs);
    RUN_TEST(test_supply_and_boot);
    RUN_TEST(test_stack_and_afe_side_by_side);
    return UNITY_END();
}
