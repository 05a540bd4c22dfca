/* SPDX-License-Identifier: Apache-2.0 */
/* What is told on CAN: content, moments, and a controller that is busy, off or absent. */
#include "bqhost/telemetry.h"
#include "fake_board.h"
#include "unity.h"
#include <string.h>

#define MOST 4000
static fake_board f;
static bq_app_config config;
static bq_telemetry t;
static bq_telemetry_source source;
static bq_boot boot;

/* The controller: takes as many frames as there is room for, or fails. */
static struct {
    bq_can_frame frame[MOST];
    uint32_t at_ms[MOST];
    int frames, room; /* room: negative = always */
    bq_status status;
} bus;

static bq_status can_send(void *ctx, const bq_can_frame *frame)
{
    (void)ctx;
    if (bus.status != BQ_OK) {
        return bus.status;
    }
    if (bus.room == 0) {
        return BQ_E_BUSY;
    }
    bus.room -= bus.room > 0;
    TEST_ASSERT_LESS_THAN(MOST, bus.frames);
    TEST_ASSERT_FALSE(frame->extended);
    TEST_ASSERT_EQUAL(8, frame->len);
    bus.at_ms[bus.frames] = source.now_ms;
    bus.frame[bus.frames++] = *frame;
    return BQ_OK;
}

static const bq_can_ops can_ops = {can_send, NULL, NULL};

void setUp(void)
{
    const bq_can can = {&can_ops, NULL};

    config = fake_config();
    fake_init(&f, 0);
    f.has_link = true;
    TEST_ASSERT_EQUAL(BQ_OK, fake_start(&f, &config, true));
    memset(&bus, 0, sizeof bus);
    memset(&boot, 0, sizeof boot);
    bus.room = -1;
    bus.status = BQ_OK;
    boot.cause = BQ_RESET_WATCHDOG;
    boot.image_ok = true;
    source = (bq_telemetry_source){&f.app, &boot, BQ_OK, 0, config.period_ms};
    bq_telemetry_init(&t, &can);
}

void tearDown(void)
{
}

/* One pass of the sender at the present time; its hint. */
static uint32_t pass(void)
{
    const int before = bus.frames;
    uint32_t hint;

    source.now_ms = source.app != NULL ? bq_app_now_ms(source.app) : (uint32_t)(f.passed_us / 1000u);
    hint = bq_telemetry_step(&t, &source);
    TEST_ASSERT_LESS_OR_EQUAL((int)BQ_TELEMETRY_FRAMES, bus.frames - before);
    return hint;
}

static void run(uint32_t ms)
{
    for (uint32_t n = 0; n < ms; n++) {
        fake_run(&f, 1);
        for (int passes = 0; pass() == 0u; passes++) {
            TEST_ASSERT_LESS_THAN(100, passes);
        }
    }
}

static int count(unsigned id)
{
    int n = 0;

    for (int i = 0; i < bus.frames; i++) {
        n += bus.frame[i].id == 0x100u + id;
    }
    return n;
}

/* The newest frame of an identifier. */
static const uint8_t *last(unsigned id)
{
    for (int i = bus.frames - 1; i >= 0; i--) {
        if (bus.frame[i].id == 0x100u + id) {
            return bus.frame[i].data;
        }
    }
    TEST_FAIL_MESSAGE("no such frame");
    return NULL;
}

static int u16(const uint8_t *d)
{
    return d[0] | d[1] << 8;
}

static int i16(const uint8_t *d)
{
    return (int16_t)u16(d);
}

static uint32_t u32(const uint8_t *d)
{
    return (uint32_t)u16(d) | (uint32_t)u16(d + 2) << 16;
}

/* ---- content ---- */

static void test_heartbeat_tells_state_outputs_and_time(void)
{
    bq_app_request(&f.app, BQ_REQUEST_ON);
    run(1000);
    TEST_ASSERT_EQUAL(3, last(0)[0]);         /* on */
    TEST_ASSERT_EQUAL_HEX8(0x3f, last(0)[1]); /* charge, discharge, line, complete, passed, request */
    TEST_ASSERT_EQUAL_HEX8(0xff, last(0)[2]);
    TEST_ASSERT_EQUAL(0, last(0)[3]);
    TEST_ASSERT_INT_WITHIN(100, 1000, u32(last(0) + 4));
    bq_app_request(&f.app, BQ_REQUEST_OFF);
    run(300);
    TEST_ASSERT_EQUAL(2, last(0)[0]);
    TEST_ASSERT_EQUAL_HEX8(0x18, last(0)[1]);
    f.mv[4] = 4300;
    run(1000);
    TEST_ASSERT_EQUAL(4, last(0)[0]);
    TEST_ASSERT_EQUAL(0, last(0)[2]); /* cell_ov */
    TEST_ASSERT_EQUAL(2, last(0)[3]); /* and the imbalance of 600 mV */
}

static void test_pack_cells_temperatures(void)
{
    f.mv[1] = 3650;
    f.mv[5] = 3750;
    f.dc = -123;
    f.ma = -123456;
    run(1000);
    TEST_ASSERT_EQUAL(6 * 3700, u32(last(1)));
    TEST_ASSERT_EQUAL(-123456, (int32_t)u32(last(1) + 4));
    TEST_ASSERT_EQUAL(3650, u16(last(2)));
    TEST_ASSERT_EQUAL(3750, u16(last(2) + 2));
    TEST_ASSERT_EQUAL(2, u16(last(2) + 4));
    TEST_ASSERT_EQUAL(6, u16(last(2) + 6));
    TEST_ASSERT_EQUAL(-123, i16(last(3)));
    TEST_ASSERT_EQUAL(-123, i16(last(3) + 2));
    TEST_ASSERT_EQUAL(-1, i16(last(3) + 4));
    TEST_ASSERT_EQUAL(0, u16(last(3) + 6));
}

static void test_faults_and_the_age_of_the_current(void)
{
    run(1000);
    TEST_ASSERT_EQUAL_HEX32(0, u32(last(4)));
    TEST_ASSERT_EQUAL(1, last(4)[4]);
    TEST_ASSERT_EQUAL(0, last(4)[5]);
    TEST_ASSERT_EQUAL(5, last(4)[6]); /* watchdog, no crash */
    TEST_ASSERT_LESS_OR_EQUAL(11, last(4)[7]);
    boot.crashed = true;
    f.ammeter_status = BQ_E_BUS;
    f.job[BQ_JOB_SCAN].end = BQ_E_NO_ANSWER;
    f.job[BQ_JOB_START].end = BQ_E_NOT_FOUND;
    run(1500);
    TEST_ASSERT_INT_WITHIN(15, 150, last(4)[7]);
    run(3000);
    TEST_ASSERT_EQUAL(255, last(4)[7]);
    TEST_ASSERT_EQUAL(0x85, last(4)[6]);
    TEST_ASSERT_EQUAL(-31, (int8_t)last(4)[5]);
    TEST_ASSERT_EQUAL_HEX32(1u << 5, u32(last(4)) & 1u << 5); /* comm_loss */
}

static void test_a_board_that_measures_no_current_says_so(void)
{
    TEST_ASSERT_EQUAL(BQ_OK, fake_start(&f, &config, false));
    run(500);
    TEST_ASSERT_EQUAL(255, last(4)[7]);
}

static void test_counters_and_boot(void)
{
    f.link = (bq_link_stats){.crc_errors = 1,
                             .no_answers = 20,
                             .implausible = 300,
                             .bus_errors = 4000,
                             .write_errors = 50000,
                             .retries = 600000,
                             .recoveries = 7};
    boot.crashed = true;
    boot.crystal_failed = true;
    boot.crash.kind = 0x100;
    boot.crash.pc = 0x08001234;
    run(1000);
    TEST_ASSERT_INT_WITHIN(1, bq_app_get_counters(&f.app)->periods, u32(last(8)));
    TEST_ASSERT_EQUAL(54321, u32(last(8) + 4));
    TEST_ASSERT_EQUAL(5, last(9)[0]);
    TEST_ASSERT_EQUAL_HEX8(0x07, last(9)[1]);
    TEST_ASSERT_EQUAL_HEX16(0x100, u16(last(9) + 2));
    TEST_ASSERT_EQUAL_HEX32(0x08001234, u32(last(9) + 4));
    f.has_link = false;
    run(200);
    TEST_ASSERT_EQUAL(0, u32(last(8) + 4));
}

/* ---- moments ---- */

static void test_every_frame_comes_when_it_is_due(void)
{
    static const unsigned of_period[] = {0, 1, 2, 3, 4, 8};

    run(10050);
    for (int i = 0; i < 6; i++) {
        TEST_ASSERT_INT_WITHIN(1, 101, count(of_period[i]));
    }
    TEST_ASSERT_EQUAL(3, count(9)); /* at once, after 5 s, after 10 s */
    TEST_ASSERT_EQUAL(0x109, bus.frame[0].id);
    TEST_ASSERT_EQUAL(0, count(5));
    TEST_ASSERT_EQUAL(f.sequence, count(7));
    TEST_ASSERT_EQUAL(2 * count(7), count(6));
}

static void test_the_hint_is_the_next_moment(void)
{
    run(1000);
    while (pass() == 0u) {
    }
    {
        const uint32_t hint = pass();
        TEST_ASSERT_LESS_OR_EQUAL(100000, hint);
        bus.frames = 0;
        source.now_ms += hint / 1000u - 1u;
        TEST_ASSERT_NOT_EQUAL(0, bq_telemetry_step(&t, &source));
        TEST_ASSERT_EQUAL(0, bus.frames);
        source.now_ms += 1u;
        (void)bq_telemetry_step(&t, &source);
        TEST_ASSERT_EQUAL(0x100, bus.frame[0].id);
    }
}

static void test_a_sample_is_told_once_and_whole(void)
{
    run(1000);
    bus.frames = 0;
    f.mv[3] = 3705;
    run(100);
    TEST_ASSERT_EQUAL(1, count(7));
    TEST_ASSERT_EQUAL(f.sequence, u32(last(7)));
    TEST_ASSERT_EQUAL(f.conversion_us, u32(last(7) + 4));
    TEST_ASSERT_EQUAL(2, count(6));
    TEST_ASSERT_EQUAL(1, last(6)[0]);
    TEST_ASSERT_EQUAL(f.sequence & 0xffu, last(6)[1]);
    TEST_ASSERT_EQUAL(3705, u16(last(6) + 2));
    TEST_ASSERT_EQUAL(3700, u16(last(6) + 6));
}

static void test_values_that_are_not_valid_and_cells_that_do_not_exist(void)
{
    bq_can_frame frame;

    run(500);
    f.cells[1].quality = BQ_Q_COMM;
    TEST_ASSERT_TRUE(bq_telemetry_frame(&source, BQ_FRAME_VOLTAGES, 0, &frame));
    TEST_ASSERT_EQUAL(3700, u16(frame.data + 2));
    TEST_ASSERT_EQUAL_HEX16(0xffff, u16(frame.data + 4));
    TEST_ASSERT_EQUAL(3700, u16(frame.data + 6));
    f.app.sample.cell_count = 5;
    TEST_ASSERT_TRUE(bq_telemetry_frame(&source, BQ_FRAME_VOLTAGES, 1, &frame));
    TEST_ASSERT_EQUAL(3700, u16(frame.data + 4));
    TEST_ASSERT_EQUAL_HEX16(0xffff, u16(frame.data + 6));
    TEST_ASSERT_FALSE(bq_telemetry_frame(&source, BQ_FRAME_VOLTAGES, 2, &frame));
}

static void test_each_fault_is_told_when_it_comes_and_when_it_goes(void)
{
    run(1000);
    f.mv[4] = 3100; /* 600 mV below: an imbalance */
    run(1000);
    TEST_ASSERT_EQUAL(1, count(5));
    TEST_ASSERT_EQUAL(BQ_FAULT_IMBALANCE, last(5)[0]);
    TEST_ASSERT_EQUAL(1, last(5)[1]);
    TEST_ASSERT_EQUAL(0, last(5)[7]);
    TEST_ASSERT_EQUAL(-1, (int8_t)last(5)[6]);
    f.mv[4] = 3700;
    run(2000);
    TEST_ASSERT_EQUAL(2, count(5));
    TEST_ASSERT_EQUAL(0, last(5)[1]);
    TEST_ASSERT_EQUAL(1, last(5)[7]);
    f.mv[4] = 4300;
    run(600);
    TEST_ASSERT_EQUAL(4, count(5)); /* imbalance again, and overvoltage */
    f.mv[4] = 3700;
    f.mv[2] = 2600;
    run(600);
    TEST_ASSERT_EQUAL(BQ_FAULT_CELL_UV, last(5)[0]);
    TEST_ASSERT_EQUAL(3, u16(last(5) + 2));
    TEST_ASSERT_EQUAL(1, last(5)[4]);
    TEST_ASSERT_EQUAL(0, last(5)[5]);
}

/* ---- a controller in trouble ----------------------------------------------------------------------------
 */

static void test_no_controller_is_no_trouble(void)
{
    const bq_can none = {NULL, NULL};

    bq_telemetry_init(&t, &none);
    TEST_ASSERT_EQUAL(UINT32_MAX, bq_telemetry_step(&t, &source));
    bq_telemetry_init(&t, NULL);
    TEST_ASSERT_EQUAL(UINT32_MAX, bq_telemetry_step(&t, &source));
}

static void test_a_busy_controller_postpones_and_nothing_is_lost(void)
{
    fake_run(&f, 500);
    bus.room = 1;
    TEST_ASSERT_EQUAL(BQ_TELEMETRY_BUSY_US, pass());
    TEST_ASSERT_EQUAL(1, bus.frames);
    TEST_ASSERT_EQUAL(1, t.busy);
    for (int n = 0; n < 9; n++) { /* room for one at a time: 6 of the period, the sample, two of voltages */
        bus.room = 1;
        (void)pass();
    }
    TEST_ASSERT_EQUAL(10, bus.frames);
    for (unsigned id = 0; id < 10; id++) {
        TEST_ASSERT_EQUAL(id == 5u ? 0 : id == 6u ? 2 : 1, count(id));
    }
}

/* What was due several times is sent once, with the newest values. */
static void test_after_a_long_time_without_room_the_present_is_told(void)
{
    run(1000);
    bus.room = 0;
    f.mv[0] = 3660;
    run(3000);
    bus.room = -1;
    bus.frames = 0;
    run(20);
    TEST_ASSERT_LESS_OR_EQUAL(2, count(0));
    TEST_ASSERT_EQUAL(3660, u16(last(2)));
    TEST_ASSERT_LESS_OR_EQUAL(2, count(7));
    TEST_ASSERT_INT_WITHIN(20, 4000, u32(last(0) + 4));
}

static void test_bus_off_keeps_the_events(void)
{
    run(1000);
    bus.status = BQ_E_BUS;
    f.mv[4] = 3100;
    run(500);
    f.mv[4] = 3700;
    run(2000);
    TEST_ASSERT_EQUAL(0, count(5));
    TEST_ASSERT_EQUAL(BQ_TELEMETRY_OFF_US, pass());
    bus.status = BQ_OK;
    run(10);
    TEST_ASSERT_EQUAL(2, count(5));
}

/* More events than the log keeps: the numbers have a gap. */
static void test_lost_events_leave_a_gap(void)
{
    run(1000);
    bus.status = BQ_E_BUS;
    for (int n = 0; n < 20; n++) {
        f.mv[4] = 3100;
        run(500);
        f.mv[4] = 3700;
        run(1500);
    }
    TEST_ASSERT_GREATER_THAN((int)BQ_PACK_EVENTS, f.app.pack.event_count);
    bus.status = BQ_OK;
    bus.frames = 0;
    run(50);
    TEST_ASSERT_GREATER_THAN(5, count(5));
    TEST_ASSERT_LESS_OR_EQUAL((int)BQ_PACK_EVENTS, count(5));
    for (int i = 0; i < bus.frames; i++) {
        if (bus.frame[i].id == 0x105u) {
            TEST_ASSERT_GREATER_THAN(0, bus.frame[i].data[7]); /* number 0 was never sent */
            break;
        }
    }
}

/* Never tried again and again: the other frames would wait behind it. */
static void test_a_frame_that_the_controller_calls_wrong_is_dropped(void)
{
    fake_run(&f, 500);
    bus.status = BQ_E_ARG;
    for (int n = 0; n < 20; n++) {
        (void)pass();
    }
    TEST_ASSERT_EQUAL(10, t.refused);
    bus.status = BQ_OK;
    (void)pass();
    TEST_ASSERT_EQUAL(0, bus.frames);
}

static void test_a_new_sample_replaces_one_that_is_being_told(void)
{
    run(1000);
    fake_run(&f, 100);
    bus.frames = 0;
    for (int n = 0; n < 8; n++) { /* everything but the second of the two frames */
        bus.room = 1;
        (void)pass();
    }
    TEST_ASSERT_EQUAL(1, count(6));
    fake_run(&f, 100);
    bus.frames = 0;
    bus.room = -1;
    while (pass() == 0u) {
    }
    TEST_ASSERT_EQUAL(1, count(7));
    TEST_ASSERT_EQUAL(2, count(6));
    TEST_ASSERT_EQUAL(f.sequence & 0xffu, last(6)[1]);
}

/* ---- refused --------------------------------------------------------------------------------------------
 */

static void test_a_refused_configuration_is_told(void)
{
    source.app = NULL;
    source.refused = BQ_E_RANGE;
    f.passed_us = 0;
    for (int n = 0; n < 1000; n++) {
        f.passed_us += 1000;
        while (pass() == 0u) {
        }
    }
    TEST_ASSERT_INT_WITHIN(1, 10, count(0));
    TEST_ASSERT_EQUAL(count(0), count(4));
    TEST_ASSERT_EQUAL(1, count(9));
    TEST_ASSERT_EQUAL(bus.frames, count(0) + count(4) + count(9));
    TEST_ASSERT_EQUAL(4, last(0)[0]);
    TEST_ASSERT_EQUAL(0, last(0)[1]);
    TEST_ASSERT_EQUAL(BQ_FAULT_CONFIG, last(0)[2]);
    TEST_ASSERT_EQUAL(1, last(0)[3]);
    TEST_ASSERT_EQUAL_HEX32(1u << BQ_FAULT_CONFIG, u32(last(4)));
    TEST_ASSERT_EQUAL(-10, (int8_t)last(4)[5]);
    TEST_ASSERT_EQUAL(255, last(4)[7]);
    source.boot = NULL;
    bus.frames = 0;
    f.passed_us += 5000000;
    while (pass() == 0u) {
    }
    TEST_ASSERT_EQUAL(0, last(9)[1]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_heartbeat_tells_state_outputs_and_time);
    RUN_TEST(test_pack_cells_temperatures);
    RUN_TEST(test_faults_and_the_age_of_the_current);
    RUN_TEST(test_a_board_that_measures_no_current_says_so);
    RUN_TEST(test_counters_and_boot);
    RUN_TEST(test_every_frame_comes_when_it_is_due);
    RUN_TEST(test_the_hint_is_the_next_moment);
    RUN_TEST(test_a_sample_is_told_once_and_whole);
    RUN_TEST(test_values_that_are_not_valid_and_cells_that_do_not_exist);
    RUN_TEST(test_each_fault_is_told_when_it_comes_and_when_it_goes);
    RUN_TEST(test_no_controller_is_no_trouble);
    RUN_TEST(test_a_busy_controller_postpones_and_nothing_is_lost);
    RUN_TEST(test_after_a_long_time_without_room_the_present_is_told);
    RUN_TEST(test_bus_off_keeps_the_events);
    RUN_TEST(test_lost_events_leave_a_gap);
    RUN_TEST(test_a_frame_that_the_controller_calls_wrong_is_dropped);
    RUN_TEST(test_a_new_sample_replaces_one_that_is_being_told);
    RUN_TEST(test_a_refused_configuration_is_told);
    return UNITY_END();
}
