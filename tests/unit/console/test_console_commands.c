/* SPDX-License-Identifier: Apache-2.0 */
/* What the commands answer, on streams that take little or nothing, healthy and not. */
#include "terminal.h"
#include "unity.h"
#include <string.h>

static terminal t;

void setUp(void)
{
    terminal_init(&t);
}

void tearDown(void)
{
}

static void answers(const char *line, const char *row)
{
    if (strstr(terminal_ask(&t, line), row) == NULL) {
        TEST_ASSERT_EQUAL_STRING(row, t.text);
    }
}

static void test_help_names_every_command(void)
{
    static const char *const names[] = {"help",     "version",   "status",  "cells", "faults",
                                        "counters", "self-test", "balance", "reset"};
    const char *at = terminal_ask(&t, "help");

    for (int i = 0; i < 9; i++) {
        at = strstr(at, names[i]);
        TEST_ASSERT_NOT_NULL(at);
    }
}

static void test_blanks_do_not_matter_and_words_do(void)
{
    answers("  balance   off  ", "forbidden");
    answers("balance on", "allowed");
    answers("balance maybe", "unknown, try help");
    answers("status now", "unknown");
    answers("stat", "unknown");
    answers("statuss", "unknown");
    answers("STATUS", "unknown");
    TEST_ASSERT_EQUAL_STRING("   \r\n> ", terminal_ask(&t, "   "));
}

static void test_status_in_words_with_units_and_ages(void)
{
    t.board.mv[2] = 3650;
    t.board.ma = -12345;
    bq_app_request(&t.board.app, BQ_REQUEST_ON);
    fake_run(&t.board, 1000);
    answers("status", "state     on for 0.");
    TEST_ASSERT_NOT_NULL(strstr(t.text, "outputs   charge on, discharge on, contactor on\r\n"));
    TEST_ASSERT_NOT_NULL(strstr(t.text, "request   on\r\n"));
    TEST_ASSERT_NOT_NULL(strstr(t.text, "cause     none\r\n"));
    TEST_ASSERT_NOT_NULL(strstr(t.text, "pack      22.150 V, complete, "));
    TEST_ASSERT_NOT_NULL(strstr(t.text, " ms old\r\ncells     3.650 V (3) to 3.700 V (1)\r\n"));
    TEST_ASSERT_NOT_NULL(strstr(t.text, "sensors   25.0 C (1) to 25.0 C (1)\r\n"));
    TEST_ASSERT_NOT_NULL(strstr(t.text, "current   -12.345 A, "));
    TEST_ASSERT_NOT_NULL(strstr(t.text, "charge    not valid\r\n"));
    TEST_ASSERT_NOT_NULL(strstr(t.text, "monitor   up, modules 1, BQ_OK\r\n"));
    TEST_ASSERT_NOT_NULL(strstr(t.text, "self-test passed, BQ_OK\r\n"));
    TEST_ASSERT_NOT_NULL(strstr(t.text, "can       none\r\nuptime    1.9 s"));
}

static void test_status_names_the_cause_and_what_is_not_valid(void)
{
    t.board.job[BQ_JOB_SCAN].end = BQ_E_NO_ANSWER;
    t.board.job[BQ_JOB_START].end = BQ_E_NOT_FOUND;
    t.board.ammeter_status = BQ_E_BUS;
    fake_run(&t.board, 3000);
    answers("status", "state     fault for ");
    TEST_ASSERT_NOT_NULL(strstr(t.text, "held by condition\r\n"));
    TEST_ASSERT_NOT_NULL(strstr(t.text, "not complete, "));
    TEST_ASSERT_NOT_NULL(strstr(t.text, "cells     not valid\r\n"));
    TEST_ASSERT_NOT_NULL(strstr(t.text, "monitor   failed, modules 1, BQ_E_NOT_FOUND\r\n"));
}

static void test_cells_with_what_is_wrong_with_them(void)
{
    t.board.mv[5] = 3712;
    fake_run(&t.board, 200);
    answers("cells", "cells 1: 3700 3700 3700 3700 3700 3712 mV, ");
    TEST_ASSERT_NOT_NULL(strstr(t.text, " ms old\r\nsensor 1: 25.0 C, "));
    t.board.cells[1].quality = BQ_Q_OPEN_WIRE;
    t.board.temps[0].quality = BQ_Q_SENSOR;
    t.board.temps[0].dc = -5;
    answers("cells", "cells 1: 3700 3700? 3700");
    TEST_ASSERT_NOT_NULL(strstr(t.text, ", ? is not valid: open wire\r\n"));
    TEST_ASSERT_NOT_NULL(strstr(t.text, "sensor 1: -0.5 C?, "));
    TEST_ASSERT_NOT_NULL(strstr(t.text, ", ? is not valid: sensor\r\n"));
    t.board.modules[0].age_ms = UINT32_MAX;
    answers("cells", "never measured");
}

static void test_cells_before_the_first_picture(void)
{
    const bq_app_config config = fake_config();

    fake_init(&t.board, 0);
    TEST_ASSERT_EQUAL(BQ_OK, fake_start(&t.board, &config, false));
    answers("cells", "nothing measured yet\r\n> ");
}

static void test_faults_with_place_value_time_and_reason(void)
{
    answers("faults", "none since the start\r\n> ");
    t.board.mv[3] = 4300;
    fake_run(&t.board, 1000);
    answers("faults", "cell_ov: active, held by condition, device 1, cell 4, 4.300 V, at ");
    TEST_ASSERT_NOT_NULL(strstr(t.text, ", times 1\r\n"));
    t.board.mv[3] = 3700;
    fake_run(&t.board, 3000);
    answers("faults", "cell_ov: cleared, held by none, device 1, cell 4, 4.300 V");
    t.board.dc = 700;
    fake_run(&t.board, 1000);
    answers("faults", "overtemp: active, held by condition, device 1, sensor 1, 70.0 C");
    t.board.faults = BQ_F_MEMORY;
    fake_run(&t.board, 1000);
    answers("faults", "chip: active, held by condition, device 1, flags 0040");
    t.board.job[BQ_JOB_SELF_TEST].end = BQ_E_LINE_STUCK;
    (void)bq_app_self_test(&t.board.app);
    fake_run(&t.board, 500);
    answers("faults", "self_test: active, held by condition, BQ_E_LINE_STUCK, at ");
}

static void test_counters_of_loop_and_link(void)
{
    t.board.link.recoveries = 4000000000u;
    t.board.link.packets = 17;
    answers("counters", "periods ");
    TEST_ASSERT_NOT_NULL(strstr(t.text, "\r\nammeter failures 0\r\nprecharge failures 0\r\ntransfers 17\r\nbytes 0\r\n"));
    TEST_ASSERT_NOT_NULL(strstr(t.text, "\r\nrecoveries 4000000000\r\n> "));
    t.board.has_link = false;
    TEST_ASSERT_NULL(strstr(terminal_ask(&t, "counters"), "transfers"));
}

static void test_balance_shows_allows_and_forbids(void)
{
    answers("balance", "allowed, cells that bleed: 0\r\n> ");
    t.board.mv[0] = 3800;
    t.board.mv[4] = 3800;
    fake_run(&t.board, 1000);
    answers("balance", "allowed, cells that bleed: 2\r\ncells 1 5\r\n> ");
    answers("cells", "cells 1: 3800b 3700");
    answers("balance off", "forbidden");
    fake_run(&t.board, 300);
    answers("balance", "forbidden, cells that bleed: 0\r\n> ");
    TEST_ASSERT_FALSE(bq_mask_get(t.board.applied.balance, 1));
    answers("balance on", "allowed");
    fake_run(&t.board, 300);
    TEST_ASSERT_TRUE(bq_mask_get(t.board.applied.balance, 1));
}

static void test_self_test_waits_for_its_result(void)
{
    answers("self-test", "running\r\npassed, BQ_OK\r\n> ");
    t.board.job[BQ_JOB_SELF_TEST].end = BQ_E_CHAIN_BROKEN;
    answers("self-test", "running\r\nfailed, BQ_E_CHAIN_BROKEN\r\n> ");
    t.board.job[BQ_JOB_SELF_TEST].end = BQ_OK;
    fake_run(&t.board, 4000);
    bq_app_request(&t.board.app, BQ_REQUEST_ON);
    fake_run(&t.board, 1000);
    answers("self-test", "not now: an output is on, or the monitor is not up\r\n> ");
}

/* The loop goes on; only this command waits, until the monitor is given up or the user has enough. */
static void test_self_test_that_never_ends(void)
{
    t.board.job[BQ_JOB_SELF_TEST].takes_us = FAKE_HANG;
    terminal_type(&t, "self-test");
    t.typed[0] = '\r';
    t.typed_len = 1;
    t.typed_read = 0;
    for (int n = 0; n < 100; n++) {
        (void)bq_console_step(&t.console, &t.target);
        fake_run(&t.board, 2);
    }
    TEST_ASSERT_NULL(strstr(t.text, "passed"));
    TEST_ASSERT_FALSE(bq_console_idle(&t.console));
    t.typed[0] = '\003';
    t.typed_read = 0;
    terminal_settle(&t);
    TEST_ASSERT_NOT_NULL(strstr(t.text, "running\r\n^C\r\n> "));
}

static void test_reset_is_asked_for_where_there_is_one(void)
{
    answers("reset", "outputs off, then reset\r\n> ");
    TEST_ASSERT_TRUE(t.target.reset);
    t.target.reset = false;
    t.mcu.ops = NULL;
    answers("reset", "not on this board\r\n> ");
    t.target.mcu = NULL;
    answers("reset", "not on this board\r\n> ");
    TEST_ASSERT_FALSE(t.target.reset);
}

static void test_version_tells_the_last_reset_and_the_crash(void)
{
    answers("version", "bqhost " PROJECT_VERSION " fake-board\r\n> ");
    t.mcu.boot = &t.boot;
    t.boot.cause = BQ_RESET_CRASH;
    t.boot.image_crc = 0x12ab34cd;
    answers("version", "reset by  crash, image 12ab34cd ok, stack left 512\r\n> ");
    t.boot.crystal_failed = true;
    t.boot.image_ok = false;
    t.boot.crashed = true;
    t.boot.crash =
        (bq_crash){3, 0x08001234, 0x08005679, 0x20001ff0, 1234, 0x01000003, 0x8200, 0x40000000, 0xe000};
    answers("version", "crash, crystal failed, image 12ab34cd damaged");
    TEST_ASSERT_NOT_NULL(
        strstr(t.text, "crash     kind 3 pc 08001234 lr 08005679 sp 20001ff0 after 1.2 s\r\n"));
    TEST_ASSERT_NOT_NULL(
        strstr(t.text, "          psr 01000003 cfsr 00008200 hfsr 40000000 address 0000e000\r\n> "));
}

static void test_a_refused_configuration_says_why(void)
{
    t.target.app = NULL;
    t.target.refused = BQ_E_RANGE;
    t.target.what = "cell_ov_mv";
    t.target.now_ms = 12345;
    answers("status",
            "refused   BQ_E_RANGE cell_ov_mv, outputs stay off\r\ncan       none\r\nuptime    12.3 s\r\n> ");
    answers("cells", "nothing runs, see status\r\n> ");
    answers("balance off", "nothing runs, see status\r\n> ");
    answers("help", "this list");
    t.target.what = NULL;
    answers("status", "refused   BQ_E_RANGE , outputs");
}

/* ---- streams ---- */

static void test_no_stream_is_no_trouble(void)
{
    terminal_restart(&t, false);
    TEST_ASSERT_EQUAL(UINT32_MAX, bq_console_step(&t.console, &t.target));
    TEST_ASSERT_TRUE(bq_console_idle(&t.console));
    bq_console_init(&t.console, NULL);
    TEST_ASSERT_EQUAL(UINT32_MAX, bq_console_step(&t.console, &t.target));
}

static void test_a_stream_that_takes_a_byte_at_a_time_gets_the_same(void)
{
    static char whole[TERMINAL_TEXT];

    strcpy(whole, terminal_ask(&t, "help"));
    t.takes = 1;
    TEST_ASSERT_EQUAL_STRING(whole, terminal_ask(&t, "help"));
}

static void test_a_stream_that_takes_nothing_stops_nothing(void)
{
    terminal_type(&t, "status");
    t.takes = 0;
    terminal_forget(&t);
    terminal_type(&t, "\r");
    for (int n = 0; n < 1000; n++) {
        TEST_ASSERT_EQUAL(BQ_CONSOLE_WAIT_US, bq_console_step(&t.console, &t.target));
    }
    TEST_ASSERT_EQUAL(0, t.len);
    TEST_ASSERT_FALSE(bq_console_idle(&t.console));
    t.takes = 7;
    terminal_settle(&t);
    TEST_ASSERT_NOT_NULL(strstr(t.text, "\r\nstate     standby"));
}

static void test_lines_typed_ahead_are_run_in_turn(void)
{
    terminal_type(&t, "nonsense\rbalance\r");
    TEST_ASSERT_EQUAL_STRING(
        "nonsense\r\nunknown, try help\r\n> balance\r\nallowed, cells that bleed: 0\r\n> ", t.text);
}

/* A row per pass at most, however long the list. */
static void test_a_pass_makes_one_row(void)
{
    size_t before;

    terminal_type(&t, "help");
    t.typed[0] = '\r';
    t.typed_len = 1;
    t.typed_read = 0;
    for (uint32_t hint = 0; hint != UINT32_MAX;) {
        before = t.len;
        hint = bq_console_step(&t.console, &t.target);
        TEST_ASSERT_LESS_OR_EQUAL((int)BQ_CONSOLE_ROW, t.len - before);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_help_names_every_command);
    RUN_TEST(test_blanks_do_not_matter_and_words_do);
    RUN_TEST(test_status_in_words_with_units_and_ages);
    RUN_TEST(test_status_names_the_cause_and_what_is_not_valid);
    RUN_TEST(test_cells_with_what_is_wrong_with_them);
    RUN_TEST(test_cells_before_the_first_picture);
    RUN_TEST(test_faults_with_place_value_time_and_reason);
    RUN_TEST(test_counters_of_loop_and_link);
    RUN_TEST(test_balance_shows_allows_and_forbids);
    RUN_TEST(test_self_test_waits_for_its_result);
    RUN_TEST(test_self_test_that_never_ends);
    RUN_TEST(test_reset_is_asked_for_where_there_is_one);
    RUN_TEST(test_version_tells_the_last_reset_and_the_crash);
    RUN_TEST(test_a_refused_configuration_says_why);
    RUN_TEST(test_no_stream_is_no_trouble);
    RUN_TEST(test_a_stream_that_takes_a_byte_at_a_time_gets_the_same);
    RUN_TEST(test_a_stream_that_takes_nothing_stops_nothing);
    RUN_TEST(test_lines_typed_ahead_are_run_in_turn);
    RUN_TEST(test_a_pass_makes_one_row);
    return UNITY_END();
}
