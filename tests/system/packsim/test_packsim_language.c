/* SPDX-License-Identifier: Apache-2.0 */
/* Times, events and expectations: what is understood, and what is refused with its place. */
#include "ps_scenario.h"
#include "unity.h"

#include <string.h>

static ps_scenario scenario;
static ps_error error;

void setUp(void)
{
    memset(&scenario, 0, sizeof scenario);
    memset(&error, 0, sizeof error);
    scenario.devices = 4;
    scenario.cells = 22;
    scenario.sensors = 8;
}

void tearDown(void)
{
}

static void test_times_carry_units(void)
{
    uint64_t t = 1;
    TEST_ASSERT_TRUE(ps_time("250 us", &t));
    TEST_ASSERT_EQUAL(250000, t);
    TEST_ASSERT_TRUE(ps_time("100ms", &t));
    TEST_ASSERT_EQUAL(100 * PS_MS, t);
    TEST_ASSERT_TRUE(ps_time("1.5 s", &t));
    TEST_ASSERT_EQUAL(1500 * PS_MS, t);
    TEST_ASSERT_TRUE(ps_time("2min", &t));
    TEST_ASSERT_EQUAL(120 * PS_S, t);
    TEST_ASSERT_TRUE(ps_time("3 h", &t));
    TEST_ASSERT_EQUAL(10800 * PS_S, t);
    TEST_ASSERT_TRUE(ps_time("0", &t));
    TEST_ASSERT_EQUAL(0, t);
    static const char *const bad[] = {"",      "10",     "10 sec", "-1 s",  "s",
                                      "1 s x", "1e99 h", "nan s",  "inf s", "20000 h"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_FALSE_MESSAGE(ps_time(bad[i], &t), bad[i]);
    }
}

static void test_numbers_are_decimal_and_alone(void)
{
    double x = 0.0;
    int n = 0;
    TEST_ASSERT_TRUE(ps_number("-2.5e1", &x));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, -25.0, x);
    TEST_ASSERT_FALSE(ps_number("0x10", &x));
    TEST_ASSERT_FALSE(ps_number("nan", &x));
    TEST_ASSERT_FALSE(ps_number("1e999", &x));
    TEST_ASSERT_FALSE(ps_number("1 V", &x));
    TEST_ASSERT_FALSE(ps_number("", &x));
    TEST_ASSERT_TRUE(ps_int("-7", &n));
    TEST_ASSERT_EQUAL(-7, n);
    TEST_ASSERT_FALSE(ps_int("7.5", &n));
    TEST_ASSERT_FALSE(ps_int("99999999999", &n));
    TEST_ASSERT_FALSE(ps_int("", &n));
}

static ps_event event(const char *action)
{
    ps_event v;
    memset(&error, 0, sizeof error);
    TEST_ASSERT_EQUAL_MESSAGE(0, ps_event_parse(&v, &scenario, "1 s", action, (ps_place){"f", 3}, &error),
                              action);
    TEST_ASSERT_EQUAL(PS_S, v.t);
    return v;
}

static void test_every_action(void)
{
    ps_event v = event("cell 22 volts 4.3");
    TEST_ASSERT_TRUE(v.kind == PS_ACT_CELL_VOLTS && v.n == 22);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 4.3, v.value);
    TEST_ASSERT_TRUE(event("cell 1 free").kind == PS_ACT_CELL_FREE);
    v = event("sensor 8 celsius -12.5");
    TEST_ASSERT_TRUE(v.kind == PS_ACT_SENSOR && v.n == 8);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, -12.5, v.value);
    TEST_ASSERT_TRUE(event("current -40").kind == PS_ACT_CURRENT);
    scenario.has_load_file = true;
    TEST_ASSERT_TRUE(event("current file").kind == PS_ACT_CURRENT_FILE);
    v = event("request on");
    TEST_ASSERT_TRUE(v.kind == PS_ACT_REQUEST && v.on);
    TEST_ASSERT_FALSE(event("request off").on);
    v = event("break above 3");
    TEST_ASSERT_TRUE(v.kind == PS_ACT_BREAK && v.n == 3);
    TEST_ASSERT_TRUE(event("mend").kind == PS_ACT_MEND);
    v = event("device 4 on");
    TEST_ASSERT_TRUE(v.kind == PS_ACT_DEVICE && v.n == 4 && v.on);
    TEST_ASSERT_FALSE(event("device 4 off").on);
    v = event("wire 0 open");
    TEST_ASSERT_TRUE(v.kind == PS_ACT_WIRE && v.n == 0 && v.on);
    TEST_ASSERT_FALSE(event("wire 22 closed").on);
    v = event("spi flip 1e-4");
    TEST_ASSERT_TRUE(v.kind == PS_ACT_FLIP);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1e-4, v.value);
    TEST_ASSERT_TRUE(event("bus dead ff").on);
    TEST_ASSERT_FALSE(event("bus dead 00").on);
    TEST_ASSERT_TRUE(event("bus free").kind == PS_ACT_BUS_FREE);
    TEST_ASSERT_TRUE(event("mcu reset").kind == PS_ACT_MCU_RESET);
    TEST_ASSERT_TRUE(event("contactor weld").kind == PS_ACT_WELD);
}

static void test_bad_actions_are_refused_with_their_place(void)
{
    static const char *const bad[] = {
        "cell 0 volts 3",
        "cell 23 volts 3",
        "cell 1 volts 6.1",
        "cell 1 volts x",
        "cell 1 volts",
        "cell 1 loose",
        "sensor 9 celsius 20",
        "sensor 1 kelvin 300",
        "sensor 1 celsius 200",
        "current",
        "current lots",
        "current file",
        "request maybe",
        "break above 4",
        "break above 0",
        "break under 2",
        "mend 2",
        "device 5 off",
        "device 1 gone",
        "wire 23 open",
        "wire -1 open",
        "wire 1 cut",
        "spi flip 1.5",
        "spi flop 0.1",
        "bus dead aa",
        "bus alive",
        "mcu halt",
        "contactor open",
        "i2c flip 0.1",
        "afe xready",
        "afe alert",
        "explode",
        "",
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        ps_event v;
        memset(&error, 0, sizeof error);
        TEST_ASSERT_EQUAL_MESSAGE(
            -1, ps_event_parse(&v, &scenario, "1 s", bad[i], (ps_place){"f.ini", 3}, &error), bad[i]);
        TEST_ASSERT_EQUAL_MESSAGE(0, strncmp(error.text, "f.ini:3: ", 9), error.text);
    }
    ps_event v;
    memset(&error, 0, sizeof error);
    TEST_ASSERT_EQUAL(-1, ps_event_parse(&v, &scenario, "1 fortnight", "mend", (ps_place){"f", 3}, &error));
}

/* The same scenario on a bq7694003: 13 cells, three thermistors. */
static void use_afe(void)
{
    scenario.part = sim_x0_find_part("bq7694003");
    scenario.devices = 1;
    scenario.cells = 13;
    scenario.sensors = 3;
}

static void test_every_action_of_an_afe(void)
{
    use_afe();
    ps_event v = event("i2c flip 1e-4");
    TEST_ASSERT_TRUE(v.kind == PS_ACT_FLIP);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1e-4, v.value);
    TEST_ASSERT_TRUE(event("afe xready").kind == PS_ACT_XREADY);
    TEST_ASSERT_TRUE(event("afe alert").kind == PS_ACT_ALERT);
    v = event("device 1 off");
    TEST_ASSERT_TRUE(v.kind == PS_ACT_DEVICE && v.n == 1 && !v.on);
    v = event("cell 13 volts 4.3");
    TEST_ASSERT_TRUE(v.kind == PS_ACT_CELL_VOLTS && v.n == 13);
    v = event("sensor 3 celsius 70");
    TEST_ASSERT_TRUE(v.kind == PS_ACT_SENSOR && v.n == 3);
    TEST_ASSERT_TRUE(event("bus dead ff").kind == PS_ACT_BUS_DEAD);
    TEST_ASSERT_TRUE(event("mcu reset").kind == PS_ACT_MCU_RESET);
}

static void test_actions_that_make_no_sense_with_an_afe_are_refused(void)
{
    static const char *const bad[] = {"cell 14 volts 3",
                                      "sensor 4 celsius 20",
                                      "device 2 off",
                                      "break above 1",
                                      "mend",
                                      "wire 1 open",
                                      "spi flip 0.1",
                                      "contactor weld",
                                      "i2c flip 1.5",
                                      "i2c flop 0.1",
                                      "i2c flip",
                                      "afe panic",
                                      "afe",
                                      "afe xready twice"};
    use_afe();
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        ps_event v;
        memset(&error, 0, sizeof error);
        TEST_ASSERT_EQUAL_MESSAGE(
            -1, ps_event_parse(&v, &scenario, "1 s", bad[i], (ps_place){"f.ini", 3}, &error), bad[i]);
        TEST_ASSERT_EQUAL_MESSAGE(0, strncmp(error.text, "f.ini:3: ", 9), error.text);
    }
    ps_event v;
    memset(&error, 0, sizeof error);
    (void)ps_event_parse(&v, &scenario, "1 s", "break above 1", (ps_place){"f.ini", 3}, &error);
    TEST_ASSERT_EQUAL_STRING("f.ini:3: break concerns a bq76pl536 stack; this pack has a bq7694003",
                             error.text);
}

static void test_bad_expectations_are_refused_with_their_place(void)
{
    static const char *const bad[] = {
        "state on",
        "state sideways at 1 s",
        "state on at 1",
        "state on at 1 s 2",
        "fault",
        "fault nothing within 1 s of 2 s",
        "fault cell_ov cell 23 within 1 s of 2 s",
        "fault cell_ov cell within 1 s of 2 s",
        "fault cell_ov within 1 s",
        "fault cell_ov within 1 s of 2",
        "no",
        "no fault",
        "no fault before",
        "no worries",
        "discovered 5 at 1 s",
        "discovered 4",
        "spread below 5 at 1 s",
        "spread below 5 mv",
        "spread above 5 mv at 1 s",
        "soc error below 1",
        "soc error below 1 percent at 1 s",
        "measurement error below 2",
        "measurement error below -2 mv",
        "outputs off",
        "outputs on within 1 s of 2 s",
        "recovered",
        "recovered at",
        "misuse some",
        "speed above",
        "speed above fast",
        "happiness above 3",
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        ps_expect x;
        memset(&error, 0, sizeof error);
        TEST_ASSERT_EQUAL_MESSAGE(-1, ps_expect_parse(&x, &scenario, bad[i], (ps_place){"f.ini", 7}, &error),
                                  bad[i]);
        TEST_ASSERT_EQUAL_MESSAGE(0, strncmp(error.text, "f.ini:7: ", 9), error.text);
    }
}

static void test_every_fault_and_state_has_its_name(void)
{
    static const char *const faults[] = {
        "cell_ov",      "cell_uv",      "overtemp",      "undertemp", "imbalance", "comm_loss", "chip",
        "chip_cell_ov", "chip_cell_uv", "chip_overtemp", "open_wire", "sensor",    "self_test", "config"};
    for (size_t i = 0; i < sizeof faults / sizeof faults[0]; i++) {
        TEST_ASSERT_EQUAL((int)i, ps_fault_number(faults[i]));
    }
    TEST_ASSERT_EQUAL(-1, ps_fault_number("?"));
    TEST_ASSERT_EQUAL(BQ_PACK_ON, ps_state_number("on"));
    TEST_ASSERT_EQUAL(BQ_PACK_FAULT, ps_state_number("fault"));
    TEST_ASSERT_EQUAL(-1, ps_state_number("?"));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_times_carry_units);
    RUN_TEST(test_numbers_are_decimal_and_alone);
    RUN_TEST(test_every_action);
    RUN_TEST(test_bad_actions_are_refused_with_their_place);
    RUN_TEST(test_every_action_of_an_afe);
    RUN_TEST(test_actions_that_make_no_sense_with_an_afe_are_refused);
    RUN_TEST(test_bad_expectations_are_refused_with_their_place);
    RUN_TEST(test_every_fault_and_state_has_its_name);
    return UNITY_END();
}
