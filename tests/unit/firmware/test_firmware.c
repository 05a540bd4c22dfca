/* SPDX-License-Identifier: Apache-2.0 */
/* The whole loop on a fake board: request line, watchdog, one thing a pass, reset, refusal. */
#include "bqhost/firmware.h"
#include "fake_board.h"
#include "unity.h"
#include <string.h>

static fake_board f;
static bq_firmware fw;
static bq_board board;
static bq_boot boot;
static bq_app_config config;

/* What the rest of the board saw. */
static struct {
    uint32_t fed, resets, frames, heartbeats;
    uint32_t fed_us, worst_gap_us; /* by the clock of the board */
    uint8_t state, cause;
    bool reset_with_outputs_on;
    char text[20000];
    size_t len;
    char typed[100];
    size_t typed_len, typed_read;
    bool deaf; /* the stream takes nothing */
} seen;

static void feed(void *ctx)
{
    const uint32_t gap = f.us - seen.fed_us;

    (void)ctx;
    seen.fed++;
    seen.worst_gap_us = gap > seen.worst_gap_us ? gap : seen.worst_gap_us;
    seen.fed_us = f.us;
}

static void reset(void *ctx)
{
    (void)ctx;
    seen.resets++;
    seen.reset_with_outputs_on = seen.reset_with_outputs_on || f.closed || f.applied.charge_on;
}

static uint32_t stack_free(void *ctx)
{
    (void)ctx;
    return 100;
}

static bq_status can_send(void *ctx, const bq_can_frame *frame)
{
    (void)ctx;
    seen.frames++;
    if (frame->id == 0x100u) {
        seen.heartbeats++;
        seen.state = frame->data[0];
        seen.cause = frame->data[2];
    }
    return BQ_OK;
}

static bq_status can_receive(void *ctx, bq_can_frame *frame)
{
    (void)ctx;
    (void)frame;
    return BQ_PENDING;
}

static bq_can_state can_state(void *ctx)
{
    (void)ctx;
    return BQ_CAN_PASSIVE;
}

static size_t stream_write(void *ctx, const uint8_t *data, size_t len)
{
    (void)ctx;
    if (seen.deaf) {
        return 0;
    }
    TEST_ASSERT_LESS_THAN(sizeof seen.text - 1u, seen.len + len);
    memcpy(&seen.text[seen.len], data, len);
    seen.len += len;
    seen.text[seen.len] = '\0';
    return len;
}

static size_t stream_read(void *ctx, uint8_t *data, size_t len)
{
    (void)ctx;
    if (len == 0u || seen.typed_read == seen.typed_len) {
        return 0;
    }
    data[0] = (uint8_t)seen.typed[seen.typed_read++];
    return 1;
}

static const bq_mcu_ops mcu_ops = {feed, reset, stack_free};
static const bq_can_ops can_ops = {can_send, can_receive, can_state};
static const bq_stream_ops stream_ops = {stream_write, stream_read};

static bq_status start(void)
{
    const bq_afe afe = fake_afe(&f);

    return bq_firmware_init(&fw, &board, &config, &afe, f.cells, FAKE_CELLS, f.temps, FAKE_SENSORS, f.modules,
                            1);
}

void setUp(void)
{
    memset(&seen, 0, sizeof seen);
    memset(&board, 0, sizeof board);
    memset(&boot, 0, sizeof boot);
    config = fake_config();
    fake_init(&f, UINT32_MAX - 3000000u); /* the clock wraps somewhere in every test */
    board.name = "fake";
    board.gpio = fake_gpio(&f);
    board.clock = fake_clock(&f);
    board.can = (bq_can){&can_ops, NULL};
    board.console = (bq_stream){&stream_ops, NULL};
    board.mcu = (bq_mcu){&mcu_ops, NULL, &boot};
    seen.fed_us = f.us;
    TEST_ASSERT_EQUAL(BQ_OK, start());
}

void tearDown(void)
{
}

/* Passes when the hint says, for `ms`. */
static void run(uint32_t ms)
{
    const uint64_t until = f.passed_us + (uint64_t)ms * 1000u;

    while (f.passed_us < until) {
        uint32_t hint = bq_firmware_step(&fw);
        TEST_ASSERT_LESS_OR_EQUAL(BQ_FIRMWARE_SLEEP_US, hint);
        hint = hint == 0u ? 10u : hint;
        f.us += hint;
        f.passed_us += hint;
    }
}

static void type(const char *keys)
{
    seen.typed_len = strlen(keys);
    seen.typed_read = 0;
    memcpy(seen.typed, keys, seen.typed_len);
    seen.len = 0;
    seen.text[0] = '\0';
}

static bq_pack_state_id state(void)
{
    return bq_app_pack(bq_firmware_app(&fw))->state;
}

/* ---- request ------------------------------------------------------------------------------------ */

static void test_without_a_line_the_request_is_what_was_asked_for(void)
{
    run(1000);
    TEST_ASSERT_EQUAL(BQ_PACK_STANDBY, state());
    TEST_ASSERT_EQUAL(BQ_OK, bq_firmware_request(&fw, BQ_REQUEST_ON));
    run(500);
    TEST_ASSERT_TRUE(f.closed);
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_firmware_request(&fw, (bq_pack_request)9));
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_firmware_request(NULL, BQ_REQUEST_ON));
    run(100);
    TEST_ASSERT_TRUE(f.closed);
    TEST_ASSERT_EQUAL(BQ_OK, bq_firmware_request(&fw, BQ_REQUEST_SLEEP));
    run(1000);
    TEST_ASSERT_EQUAL(BQ_PACK_SLEEP, state());
}

static void test_the_line_is_on_after_its_time_and_off_at_once(void)
{
    f.has_request = true;
    TEST_ASSERT_EQUAL(BQ_OK, bq_firmware_request(&fw, BQ_REQUEST_ON)); /* counts for nothing here */
    run(1000);
    TEST_ASSERT_EQUAL(BQ_PACK_STANDBY, state());
    f.request = true;
    (void)bq_firmware_step(&fw);
    f.us += 19000;
    (void)bq_firmware_step(&fw);
    TEST_ASSERT_EQUAL(BQ_REQUEST_OFF, bq_app_input(bq_firmware_app(&fw))->request);
    f.us += 1000;
    (void)bq_firmware_step(&fw);
    TEST_ASSERT_EQUAL(BQ_REQUEST_ON, bq_app_input(bq_firmware_app(&fw))->request);
    run(500);
    TEST_ASSERT_TRUE(f.closed);
    f.request = false;
    (void)bq_firmware_step(&fw);
    TEST_ASSERT_FALSE(f.closed);
}

static void test_a_pulse_on_the_line_is_no_request(void)
{
    f.has_request = true;
    run(1000);
    for (int n = 0; n < 100; n++) {
        f.request = n % 2 == 0;
        (void)bq_firmware_step(&fw);
        f.us += 15000;
    }
    TEST_ASSERT_EQUAL(BQ_REQUEST_OFF, bq_app_input(bq_firmware_app(&fw))->request);
}

static void test_a_line_that_cannot_be_read_is_off(void)
{
    f.has_request = true;
    f.request = true;
    run(1500);
    TEST_ASSERT_TRUE(f.closed);
    f.request_status = BQ_E_BUS;
    (void)bq_firmware_step(&fw);
    TEST_ASSERT_FALSE(f.closed);
}

static void test_sleep_counts_while_the_line_is_low(void)
{
    f.has_request = true;
    f.request = true;
    TEST_ASSERT_EQUAL(BQ_OK, bq_firmware_request(&fw, BQ_REQUEST_SLEEP));
    run(1500);
    TEST_ASSERT_TRUE(f.closed);
    f.request = false;
    run(1000);
    TEST_ASSERT_EQUAL(BQ_PACK_SLEEP, state());
    f.request = true;
    run(2000);
    TEST_ASSERT_TRUE(f.closed);
}

/* ---- watchdog ------------------------------------------------------------------------------------- */

static void test_a_healthy_loop_feeds_often_enough(void)
{
    static const uint32_t periods[] = {10, 100, 1000, 10000};

    for (int i = 0; i < 4; i++) {
        config.period_ms = periods[i];
        config.pack.comm_timeout_ms = 30000;
        fake_init(&f, 0);
        seen.fed_us = 0;
        seen.worst_gap_us = 0;
        TEST_ASSERT_EQUAL(BQ_OK, start());
        run(60000);
        TEST_ASSERT_LESS_OR_EQUAL(300000, seen.worst_gap_us);
    }
}

/* A monitor that fails or hangs is no reason for a reset: the loop handles it. */
static void test_trouble_with_the_monitor_is_no_illness(void)
{
    f.job[BQ_JOB_SCAN].takes_us = FAKE_HANG;
    f.job[BQ_JOB_START].end = BQ_E_NOT_FOUND;
    run(20000);
    TEST_ASSERT_LESS_OR_EQUAL(300000, seen.worst_gap_us);
}

static void test_no_food_when_the_pack_step_stops(void)
{
    run(1000);
    fw.app.period_us = UINT32_MAX / 2u; /* as a stray write would */
    run(125 + BQ_FIRMWARE_SLACK_MS + 100);
    seen.fed = 0;
    run(5000);
    TEST_ASSERT_EQUAL(0, seen.fed);
}

static void test_no_food_from_a_loop_that_is_always_late(void)
{
    run(1000);
    seen.fed = 0;
    for (int n = 0; n < 100; n++) {
        (void)bq_firmware_step(&fw);
        f.us += 126000 + BQ_FIRMWARE_SLACK_MS * 1000u;
    }
    TEST_ASSERT_LESS_OR_EQUAL(2, seen.fed);
    run(1000);
    TEST_ASSERT_GREATER_THAN(5, seen.fed); /* and again when it is in time again */
}

static void test_no_food_when_the_clock_stands_still(void)
{
    run(1000);
    seen.fed = 0;
    for (int n = 0; n < 10000; n++) {
        (void)bq_firmware_step(&fw);
    }
    TEST_ASSERT_LESS_OR_EQUAL(1, seen.fed);
}

/* ---- one thing a pass ------------------------------------------------------------------------------ */

static void test_a_pass_steps_or_sends_or_answers(void)
{
    type("help\rcounters\rstatus\r");
    for (int n = 0; n < 20000; n++) {
        const uint32_t steps = bq_app_get_counters(&fw.app)->steps, frames = seen.frames;
        const size_t len = seen.len;
        int did;
        f.us += bq_firmware_step(&fw);
        did = (bq_app_get_counters(&fw.app)->steps != steps) + (seen.frames != frames) + (seen.len != len);
        TEST_ASSERT_LESS_OR_EQUAL(1, did);
        TEST_ASSERT_LESS_OR_EQUAL(frames + BQ_TELEMETRY_FRAMES, seen.frames);
    }
    TEST_ASSERT_NOT_NULL(strstr(seen.text, "uptime    "));
    TEST_ASSERT_GREATER_THAN(50, seen.heartbeats);
}

static void test_every_command_is_answered_within_a_period(void)
{
    static const char *const lines[] = {"help\r",     "version\r",   "status\r",  "cells\r",   "faults\r",
                                        "counters\r", "self-test\r", "balance\r", "nonsense\r"};

    run(1000);
    for (int i = 0; i < 9; i++) {
        type(lines[i]);
        run(100);
        TEST_ASSERT_NOT_NULL(strstr(seen.text, "\r\n"));
        TEST_ASSERT_GREATER_THAN((int)strlen(lines[i]) + 3, seen.len);
        run(2000);
    }
}

/* Punctual with a console that nobody reads and one that talks all the time. */
static void test_talking_does_not_delay_the_loop(void)
{
    run(1000);
    for (int deaf = 0; deaf < 2; deaf++) {
        const uint32_t overruns = bq_app_get_counters(&fw.app)->overruns;
        const uint32_t late = bq_app_get_counters(&fw.app)->late_scans;
        seen.deaf = deaf == 1;
        for (int n = 0; n < 20; n++) {
            type("counters\rcounters\r");
            run(150);
        }
        TEST_ASSERT_EQUAL(overruns, bq_app_get_counters(&fw.app)->overruns);
        TEST_ASSERT_EQUAL(late, bq_app_get_counters(&fw.app)->late_scans);
    }
}

static void test_a_board_with_nothing_runs(void)
{
    board.can.ops = NULL;
    board.console.ops = NULL;
    board.mcu = (bq_mcu){NULL, NULL, NULL};
    board.gpio.ops = NULL;
    TEST_ASSERT_EQUAL(BQ_OK, start());
    run(1000);
    TEST_ASSERT_EQUAL(BQ_PACK_STANDBY, state());
    TEST_ASSERT_EQUAL(BQ_OK, bq_firmware_request(&fw, BQ_REQUEST_ON));
    run(500);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, state());
}

/* ---- reset ------------------------------------------------------------------------------------------- */

static void test_reset_opens_first_and_has_answered(void)
{
    TEST_ASSERT_EQUAL(BQ_OK, bq_firmware_request(&fw, BQ_REQUEST_ON));
    run(1500);
    TEST_ASSERT_TRUE(f.closed);
    f.job[BQ_JOB_APPLY].takes_us = 30000;
    type("reset\r");
    run(200);
    TEST_ASSERT_GREATER_THAN(0, seen.resets);
    TEST_ASSERT_FALSE(seen.reset_with_outputs_on);
    TEST_ASSERT_NOT_NULL(strstr(seen.text, "reset\r\noutputs off, then reset\r\n"));
}

static void test_reset_comes_even_if_the_monitor_hangs_and_nobody_reads(void)
{
    TEST_ASSERT_EQUAL(BQ_OK, bq_firmware_request(&fw, BQ_REQUEST_ON));
    run(1500);
    f.job[BQ_JOB_APPLY].takes_us = FAKE_HANG;
    type("reset\r");
    run(20);
    seen.deaf = true;
    run(250);
    TEST_ASSERT_GREATER_THAN(0, seen.resets);
    TEST_ASSERT_FALSE(f.closed);
}

/* ---- refused ------------------------------------------------------------------------------------------- */

static void test_init_refuses(void)
{
    const bq_afe afe = fake_afe(&f);

    TEST_ASSERT_EQUAL(BQ_E_ARG,
                      bq_firmware_init(NULL, &board, &config, &afe, f.cells, 6, f.temps, 1, f.modules, 1));
    TEST_ASSERT_EQUAL(BQ_E_ARG,
                      bq_firmware_init(&fw, NULL, &config, &afe, f.cells, 6, f.temps, 1, f.modules, 1));
    config.period_ms = 1;
    TEST_ASSERT_EQUAL(BQ_E_RANGE, start());
    TEST_ASSERT_NULL(bq_firmware_app(&fw));
    config = fake_config();
    board.clock.now_us = NULL;
    TEST_ASSERT_EQUAL(BQ_E_ARG, start());
}

static void test_refused_stays_off_and_tells_why(void)
{
    f.closed = true;
    f.has_request = true;
    f.request = true;
    bq_firmware_refuse(&fw, &board, BQ_E_RANGE, "cell_ov_mv");
    TEST_ASSERT_FALSE(f.closed);
    TEST_ASSERT_NULL(bq_firmware_app(&fw));
    (void)bq_firmware_request(&fw, BQ_REQUEST_ON);
    run(1000);
    f.closed = true; /* a glitch: written again */
    run(110);
    TEST_ASSERT_FALSE(f.closed);
    TEST_ASSERT_EQUAL(4, seen.state);
    TEST_ASSERT_EQUAL(BQ_FAULT_CONFIG, seen.cause);
    TEST_ASSERT_INT_WITHIN(2, 11, seen.heartbeats);
    TEST_ASSERT_GREATER_THAN(5, seen.fed);
    type("status\r");
    run(100);
    TEST_ASSERT_NOT_NULL(strstr(seen.text, "refused   BQ_E_RANGE cell_ov_mv"));
    type("reset\r");
    run(300);
    TEST_ASSERT_GREATER_THAN(0, seen.resets);
}

/* FETs of a monitor may still be on from the life before: its bring-up leaves them off. */
static void test_refused_brings_the_monitor_up_until_it_succeeds(void)
{
    board.safe = fake_afe(&f);
    f.job[BQ_JOB_START].end = BQ_E_NACK;
    bq_firmware_refuse(&fw, &board, BQ_E_CRC, NULL);
    run(3500);
    TEST_ASSERT_EQUAL(4, f.job[BQ_JOB_START].begun); /* at once and once a second */
    f.job[BQ_JOB_START].begin = BQ_E_BUSY;
    run(2000);
    f.job[BQ_JOB_START].begin = BQ_OK;
    f.job[BQ_JOB_START].end = BQ_OK;
    run(2000);
    TEST_ASSERT_EQUAL(5, f.job[BQ_JOB_START].begun);
    run(5000);
    TEST_ASSERT_EQUAL(5, f.job[BQ_JOB_START].begun);
    TEST_ASSERT_EQUAL(0, f.job[BQ_JOB_SCAN].begun + f.job[BQ_JOB_APPLY].begun);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_without_a_line_the_request_is_what_was_asked_for);
    RUN_TEST(test_the_line_is_on_after_its_time_and_off_at_once);
    RUN_TEST(test_a_pulse_on_the_line_is_no_request);
    RUN_TEST(test_a_line_that_cannot_be_read_is_off);
    RUN_TEST(test_sleep_counts_while_the_line_is_low);
    RUN_TEST(test_a_healthy_loop_feeds_often_enough);
    RUN_TEST(test_trouble_with_the_monitor_is_no_illness);
    RUN_TEST(test_no_food_when_the_pack_step_stops);
    RUN_TEST(test_no_food_from_a_loop_that_is_always_late);
    RUN_TEST(test_no_food_when_the_clock_stands_still);
    RUN_TEST(test_a_pass_steps_or_sends_or_answers);
    RUN_TEST(test_every_command_is_answered_within_a_period);
    RUN_TEST(test_talking_does_not_delay_the_loop);
    RUN_TEST(test_a_board_with_nothing_runs);
    RUN_TEST(test_reset_opens_first_and_has_answered);
    RUN_TEST(test_reset_comes_even_if_the_monitor_hangs_and_nobody_reads);
    RUN_TEST(test_init_refuses);
    RUN_TEST(test_refused_stays_off_and_tells_why);
    RUN_TEST(test_refused_brings_the_monitor_up_until_it_succeeds);
    return UNITY_END();
}
