/* SPDX-License-Identifier: Apache-2.0 */
/* Closing through a precharge path under everything that can go wrong at once: what must hold at every edge
 * of the two lines and in every pass, watched from the lines, the ammeter and the clock alone. */
#include "fake_board.h"
#include "unity.h"
#include <string.h>

static fake_board f;
static bq_app_config config;
static bq_gpio_ops fake_lines;
static bool hurried; /* no pass comes late */

/* What the guard saw from outside. Times are of the board's 64-bit clock. */
static struct guard {
    unsigned writes, fail_from, fail_count; /* writes that fail, counted from 1 */
    uint64_t path_us, measured_us, closed_us;
    int32_t ma;
    unsigned closings;
    uint32_t settled; /* pack steps after which the last failed write has been made good */
} g;

static uint32_t seed;

static uint32_t dice(uint32_t sides)
{
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 8) % sides;
}

/* ---- invariants ------------------------------------------------------------------------------------ */

/* The contactor has just closed. A path that stood closed for precharge_ms (to one reading of the clock), a
 * current that was measured since and is low, a request, and a picture no older than the pack tolerates. */
static void contactor_closed(void)
{
    const uint32_t limit_us =
        (config.pack.comm_timeout_ms + config.period_ms + config.period_ms / 4u + 1u) * 1000u;

    g.closings++;
    g.closed_us = f.passed_us;
    TEST_ASSERT_TRUE_MESSAGE(f.path, "closed with an open path");
    TEST_ASSERT_TRUE_MESSAGE(f.passed_us - g.path_us + 1000u >= config.precharge_ms * 1000u, "too early");
    TEST_ASSERT_TRUE_MESSAGE(g.measured_us > g.path_us, "current from before the path");
    TEST_ASSERT_LESS_OR_EQUAL(config.precharge_end_ma, g.ma < 0 ? -g.ma : g.ma);
    TEST_ASSERT_EQUAL(BQ_REQUEST_ON, bq_app_input(&f.app)->request);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, fake_state(&f));
    TEST_ASSERT_TRUE_MESSAGE(f.us - f.conversion_us <= limit_us, "closed by an old picture");
}

static bq_status write_line(void *ctx, bq_line line, bool level)
{
    const bool closed = f.closed, path = f.path;
    bq_status status;

    g.writes++;
    if (g.fail_from != 0u && g.writes >= g.fail_from && g.writes - g.fail_from < g.fail_count) {
        g.settled = bq_app_get_counters(&f.app)->steps + 2u;
        return BQ_E_BUS;
    }
    status = fake_lines.write(ctx, line, level);
    if (!path && f.path) {
        g.path_us = f.passed_us;
        TEST_ASSERT_FALSE_MESSAGE(f.closed, "path closed behind the contactor");
    }
    if (!closed && f.closed) {
        contactor_closed();
    }
    return status;
}

static bq_status read_current(void *ctx, int32_t *ma)
{
    (void)ctx;
    if (f.ammeter_status == BQ_OK) {
        *ma = f.ma;
        g.ma = f.ma;
        g.measured_us = f.passed_us;
    }
    return f.ammeter_status;
}

/* How long the path may stand closed: header of bq_app_use_precharge(), and the caller's lateness. */
static uint32_t longest_us(void)
{
    return (config.precharge_ms + config.pack.comm_timeout_ms + config.period_ms + config.period_ms / 4u) *
           1000u;
}

static void after_a_pass(void)
{
    if (bq_app_get_counters(&f.app)->steps < g.settled || !hurried) {
        return;
    }
    if (!f.app.step_now && !f.app.copied && fake_state(&f) != BQ_PACK_ON) {
        TEST_ASSERT_FALSE_MESSAGE(f.path || f.closed, "closed without the state on");
    }
    if (f.path && !f.closed) {
        TEST_ASSERT_TRUE_MESSAGE(f.passed_us - g.path_us <= longest_us() + 1000u, "path closed for too long");
    }
    if (f.path && f.closed) {
        TEST_ASSERT_TRUE_MESSAGE(f.passed_us - g.closed_us <=
                                     (BQ_PACK_MISMATCH_MS + config.period_ms * 5u / 4u + 1u) * 1000u,
                                 "path closed behind the contactor for too long");
    }
}

/* ---- the board ------------------------------------------------------------------------------------- */

static void begin(void)
{
    static bq_gpio_ops lines;
    const bq_afe afe = fake_afe(&f);
    const bq_clock clock = fake_clock(&f);
    const bq_ammeter meter = {read_current, NULL};
    bq_gpio gpio;

    fake_init(&f, UINT32_MAX - 2000000u);
    f.has_path = true;
    gpio = fake_gpio(&f);
    fake_lines = *gpio.ops;
    lines = fake_lines;
    lines.write = write_line;
    gpio.ops = &lines;
    memset(&g, 0, sizeof g);
    hurried = true;
    TEST_ASSERT_EQUAL(BQ_OK, bq_app_init(&f.app, &config, &afe, &gpio, &clock, &meter, f.cells, FAKE_CELLS,
                                         f.temps, FAKE_SENSORS, f.modules, 1));
    bq_app_use_precharge(&f.app);
}

static void let_pass(uint32_t us)
{
    f.us += us;
    f.passed_us += us;
}

static void pass(void)
{
    const uint32_t hint = bq_app_step(&f.app);

    after_a_pass();
    let_pass(hint == 0u ? 10u : hint);
}

static void run(uint32_t ms)
{
    const uint64_t until = f.passed_us + ms * 1000ull;

    while (f.passed_us < until) {
        pass();
    }
}

void setUp(void)
{
    config = fake_config();
    config.precharge_ms = 450;
    config.precharge_end_ma = 2000;
    begin();
}

void tearDown(void)
{
}

static void to_path(void)
{
    run(1000);
    bq_app_request(&f.app, BQ_REQUEST_ON);
    for (int i = 0; !f.path && i < 10000; i++) {
        pass();
    }
    TEST_ASSERT_TRUE(f.path);
}

/* ---- single blows ---------------------------------------------------------------------------------- */

/* The ammeter's last word is from just before the path closed; the action that would close the contactor
 * takes longer than the others did. */
static void test_a_current_from_before_the_path_never_closes(void)
{
    for (uint32_t us = 1000; us < 40000u; us += 1000u) {
        setUp();
        to_path();
        f.ammeter_status = BQ_E_STALE;
        f.ma = -50000;
        f.job[BQ_JOB_APPLY].takes_us = us;
        run(1500);
        TEST_ASSERT_EQUAL(0, g.closings);
    }
}

/* Nor one that was measured before the path itself, a relay, had time to close. */
static void test_a_current_from_the_beginning_of_the_path_never_closes(void)
{
    for (uint32_t ms = 0; ms < 1000u; ms += 50u) {
        setUp();
        to_path();
        run(ms);
        f.ammeter_status = BQ_E_STALE;
        run(1500);
        TEST_ASSERT_EQUAL(g.measured_us > g.path_us + config.precharge_ms * 500u, g.closings);
        TEST_ASSERT_FALSE(f.path);
    }
}

/* The monitor carries out nothing any more, and says so with every status there is. */
static void test_a_monitor_that_refuses_bounds_the_time_of_the_path(void)
{
    static const bq_status refusals[] = {BQ_E_BUS, BQ_E_VERIFY, BQ_E_STATE, BQ_E_BUSY};

    for (unsigned i = 0; i < 2u * sizeof refusals / sizeof refusals[0]; i++) {
        setUp();
        to_path();
        if ((i & 1u) != 0u) {
            f.job[BQ_JOB_APPLY].begin = refusals[i / 2u];
        } else {
            f.job[BQ_JOB_APPLY].end = refusals[i / 2u];
        }
        run(10000);
        TEST_ASSERT_FALSE(f.path);
        TEST_ASSERT_EQUAL(0, g.closings);
    }
}

/* One write after the other fails, alone and together with those that follow it. */
static void test_every_write_fails_once(void)
{
    for (unsigned count = 1; count <= 4u; count++) {
        for (unsigned n = 1; n < 60u; n++) {
            setUp();
            run(500);
            g.writes = 0;
            g.fail_from = n;
            g.fail_count = count;
            bq_app_request(&f.app, BQ_REQUEST_ON);
            run(1500);
            bq_app_request(&f.app, BQ_REQUEST_OFF);
            run(3000);
            TEST_ASSERT_FALSE(f.path || f.closed);
            TEST_ASSERT_EQUAL_HEX32(0, bq_app_pack(&f.app)->faults);
            bq_app_request(&f.app, BQ_REQUEST_ON);
            g.fail_from = 0;
            run(1500);
            TEST_ASSERT_TRUE(f.closed);
        }
    }
}

/* A path that closed at the second attempt is a path. */
static void test_one_failed_write_of_the_path_is_tried_again(void)
{
    run(1000);
    bq_app_request(&f.app, BQ_REQUEST_ON);
    while (f.app.job != BQ_JOB_APPLY || !f.app.action.charge_on) {
        pass();
    }
    f.path_status = BQ_E_BUS;
    while (f.app.job == BQ_JOB_APPLY) {
        pass();
    }
    f.path_status = BQ_OK;
    run(1500);
    TEST_ASSERT_EQUAL(0, bq_app_pack(&f.app)->fault[BQ_FAULT_CONTACTOR].count);
    TEST_ASSERT_EQUAL(1, g.closings);
}

/* A path that did not open when the load was refused is opened as soon as that succeeds, before the contactor
 * fault has had its time. */
static void test_a_refused_load_opens_the_path_again_and_again(void)
{
    config.period_ms = 20;
    begin();
    to_path();
    f.ma = -5000;
    run(440);
    f.path_status = BQ_E_BUS;
    while (bq_app_get_counters(&f.app)->precharge_failures == 0u) {
        pass();
    }
    TEST_ASSERT_TRUE(f.path);
    f.path_status = BQ_OK;
    run(30);
    TEST_ASSERT_FALSE(f.path);
    run(500);
    TEST_ASSERT_EQUAL(1, bq_app_get_counters(&f.app)->precharge_failures);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CONTACTOR));
}

/* Whatever else ends the closing, a load that did not charge stays refused until the request is off. */
static void test_a_refusal_outlasts_another_fault(void)
{
    to_path();
    f.ma = -5000;
    while (f.path) {
        pass();
    }
    f.faults = BQ_F_DIE_TEMP; /* before the contactor fault has its 100 ms */
    run(90);
    f.faults = 0;
    f.ma = 0;
    run(5000);
    TEST_ASSERT_EQUAL(0, g.closings);
    TEST_ASSERT_TRUE(fake_active(&f, BQ_FAULT_CONTACTOR));
    bq_app_request(&f.app, BQ_REQUEST_OFF);
    run(2000);
    bq_app_request(&f.app, BQ_REQUEST_ON);
    run(1500);
    TEST_ASSERT_TRUE(f.closed);
}

/* The caller comes late at every point of the closing, with a world that has changed meanwhile. */
static void test_a_late_caller_closes_nothing_by_an_old_picture(void)
{
    for (unsigned n = 0; n < 200u; n++) {
        setUp();
        to_path();
        hurried = false;
        for (unsigned i = 0; i < n; i++) {
            pass();
        }
        f.faults = BQ_F_DIE_TEMP;
        let_pass(5000000u);
        const unsigned before = g.closings;
        run(300);
        TEST_ASSERT_EQUAL(before, g.closings);
        TEST_ASSERT_FALSE(f.path || f.closed);
    }
}

/* ---- all at once ----------------------------------------------------------------------------------- */

static void blow(void)
{
    static const bq_status ends[] = {BQ_OK, BQ_OK, BQ_OK, BQ_E_BUS, BQ_E_STATE};
    fake_job *j = &f.job[1u + dice(FAKE_JOBS - 1u)];

    switch (dice(13)) {
    case 0:
    case 1:
    case 2:
        bq_app_request(&f.app, dice(5) == 0u   ? BQ_REQUEST_SLEEP
                               : dice(3) == 0u ? BQ_REQUEST_OFF
                                               : BQ_REQUEST_ON);
        break;
    case 3:
        f.faults = dice(4) == 0u ? BQ_F_DIE_TEMP : 0;
        break;
    case 4:
        j->fail_next = dice(3);
        j->fail_status = ends[dice(5)];
        break;
    case 5:
        j->begin = ends[dice(5)];
        break;
    case 6:
        j->takes_us = dice(8) == 0u ? 130000u : 1000u + dice(30000);
        break;
    case 7:
        f.ammeter_status = dice(3) == 0u ? BQ_E_STALE : BQ_OK;
        break;
    case 8:
        f.ma = dice(4) == 0u ? -5000 : 1000;
        break;
    case 9:
        g.fail_from = g.writes + 1u + dice(4);
        g.fail_count = dice(3);
        break;
    case 10:
        f.feedback_status = dice(6) == 0u ? BQ_E_BUS : BQ_OK;
        break;
    case 11:
        f.stuck_open = dice(6) == 0u;
        break;
    default:
        let_pass(hurried ? 0u : dice(2000000));
        break;
    }
}

static void test_all_at_once(void)
{
    unsigned closings = 0;

    for (seed = 1; seed <= 400u; seed++) {
        const uint32_t kept = seed;
        setUp();
        config.period_ms = 20u + dice(10) * 20u;
        config.pack.comm_timeout_ms = (uint16_t)(config.period_ms * (2u + dice(4)));
        config.precharge_ms = (uint16_t)(1u + dice(700));
        begin();
        hurried = dice(2) == 0u;
        for (int i = 0; i < 300; i++) {
            blow();
            for (uint32_t n = dice(60); n > 0u; n--) {
                pass();
            }
        }
        closings += g.closings;
        seed = kept;
    }
    TEST_ASSERT_GREATER_THAN(300, closings);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_current_from_before_the_path_never_closes);
    RUN_TEST(test_a_current_from_the_beginning_of_the_path_never_closes);
    RUN_TEST(test_a_monitor_that_refuses_bounds_the_time_of_the_path);
    RUN_TEST(test_every_write_fails_once);
    RUN_TEST(test_one_failed_write_of_the_path_is_tried_again);
    RUN_TEST(test_a_refused_load_opens_the_path_again_and_again);
    RUN_TEST(test_a_refusal_outlasts_another_fault);
    RUN_TEST(test_a_late_caller_closes_nothing_by_an_old_picture);
    RUN_TEST(test_all_at_once);
    return UNITY_END();
}
