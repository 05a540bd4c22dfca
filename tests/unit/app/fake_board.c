/* SPDX-License-Identifier: Apache-2.0 */
#include "fake_board.h"
#include "unity.h"
#include <string.h>

static void note(fake_board *f, char what)
{
    if (f->orders + 1u < sizeof f->order) {
        f->order[f->orders++] = what;
        f->order[f->orders] = '\0';
    }
}

/* ---- monitor --------------------------------------------------------------------------------- */

static bq_status begin(fake_board *f, bq_app_job job, char what)
{
    fake_job *j = &f->job[job];

    note(f, what);
    if (f->running != BQ_JOB_NONE) {
        TEST_FAIL_MESSAGE("a job was begun while another one runs");
    }
    if (j->begin != BQ_OK) {
        return j->begin;
    }
    f->running = (int)job;
    f->ends_us = f->us + j->takes_us;
    j->begun++;
    j->begun_us = f->us;
    return BQ_OK;
}

static bq_status start(void *ctx)
{
    return begin(ctx, BQ_JOB_START, 'b');
}

static bq_status scan(void *ctx)
{
    return begin(ctx, BQ_JOB_SCAN, 's');
}

static bq_status apply(void *ctx, const bq_action *action)
{
    fake_board *f = ctx;
    const bq_status status = begin(f, BQ_JOB_APPLY, 'a');

    if (status == BQ_OK) {
        f->applied = *action;
    }
    return status;
}

static bq_status self_test(void *ctx)
{
    return begin(ctx, BQ_JOB_SELF_TEST, 't');
}

static bq_status go_to_sleep(void *ctx)
{
    return begin(ctx, BQ_JOB_SLEEP, 'z');
}

static bq_status wake(void *ctx)
{
    return begin(ctx, BQ_JOB_WAKE, 'w');
}

static bq_status poll(void *ctx, uint32_t *wait_us)
{
    fake_board *f = ctx;
    fake_job *j = &f->job[f->running];
    bq_status status;

    if (f->running == BQ_JOB_NONE) {
        return BQ_OK;
    }
    if (j->takes_us == FAKE_HANG || (int32_t)(f->us - f->ends_us) < 0) {
        *wait_us = j->takes_us == FAKE_HANG ? 500u : f->ends_us - f->us;
        return BQ_PENDING;
    }
    status = j->end;
    if (j->fail_next > 0u) {
        j->fail_next--;
        status = j->fail_status;
    }
    if (f->running == BQ_JOB_SCAN && status == BQ_OK) {
        f->sequence++;
        f->conversion_us = j->begun_us;
    }
    f->running = BQ_JOB_NONE;
    return status;
}

static bq_status sample(void *ctx, bq_sample *s)
{
    fake_board *f = ctx;

    note(f, 'm');
    if (f->sequence == 0u) {
        return BQ_E_STALE;
    }
    if (f->sample_status != BQ_OK) {
        return f->sample_status;
    }
    if (s->cell_capacity < FAKE_CELLS || s->temp_capacity < FAKE_SENSORS || s->module_capacity < 1u) {
        return BQ_E_ARG;
    }
    s->cell_count = FAKE_CELLS;
    s->temp_count = FAKE_SENSORS;
    s->module_count = 1;
    for (int i = 0; i < FAKE_CELLS; i++) {
        s->cells[i] = (bq_cell_reading){f->mv[i], BQ_Q_VALID, 0};
    }
    s->temps[0] = (bq_temp_reading){f->dc, BQ_Q_VALID, 0};
    memset(&s->modules[0], 0, sizeof s->modules[0]);
    s->modules[0].faults = f->faults;
    s->modules[0].age_ms = (f->us - f->conversion_us) / 1000u;
    s->sequence = f->sequence;
    s->t_us = f->conversion_us;
    return BQ_OK;
}

static uint8_t modules_found(void *ctx)
{
    return ((fake_board *)ctx)->sequence != 0u ? 1 : 0;
}

static const bq_link_stats *stats(void *ctx)
{
    fake_board *f = ctx;

    return f->has_link ? &f->link : NULL;
}

static const bq_afe_ops afe_ops = {start,     scan,        poll, sample,        apply,
                                   self_test, go_to_sleep, wake, modules_found, stats};

/* ---- lines, clock, ammeter ------------------------------------------------------------------- */

/* Noted where it moves, and when the loop opens it without knowing how it stands. */
static bq_status write_path(fake_board *f, bool level)
{
    if (!f->has_path || f->path != level) {
        note(f, level ? 'p' : 'P');
    }
    if (!f->has_path) {
        return BQ_E_UNSUPPORTED;
    }
    if (f->path_status == BQ_OK) {
        f->path = level;
    }
    return f->path_status;
}

static bq_status write_line(void *ctx, bq_line line, bool level)
{
    fake_board *f = ctx;

    if (line == BQ_LINE_PRECHARGE) {
        return write_path(f, level);
    }
    if (line != BQ_LINE_CONTACTOR || !f->has_contactor) {
        return BQ_E_UNSUPPORTED;
    }
    f->writes++;
    if (f->line_status != BQ_OK) {
        return f->line_status;
    }
    if (level != f->closed) {
        note(f, level ? '1' : '0');
        f->moved_us = f->us;
        if (!level) {
            f->opened_us = f->passed_us;
        }
    }
    f->closed = level;
    return BQ_OK;
}

static bq_status read_line(void *ctx, bq_line line, bool *level)
{
    fake_board *f = ctx;

    if (line == BQ_LINE_REQUEST && f->has_request) {
        *level = f->request;
        return f->request_status;
    }
    if (line != BQ_LINE_CONTACTOR_FB || !f->has_feedback) {
        return BQ_E_UNSUPPORTED;
    }
    if (f->feedback_status != BQ_OK) {
        return f->feedback_status;
    }
    *level = f->us - f->moved_us < f->feedback_us ? !f->closed : f->closed;
    if (f->welded) {
        *level = true;
    }
    if (f->stuck_open) {
        *level = false;
    }
    return BQ_OK;
}

static const bq_gpio_ops gpio_ops = {read_line, write_line};

static uint32_t now_us(void *ctx)
{
    return ((fake_board *)ctx)->us;
}

static bq_status read_current(void *ctx, int32_t *ma)
{
    fake_board *f = ctx;

    if (f->ammeter_status == BQ_OK) {
        *ma = f->ma;
    }
    return f->ammeter_status;
}

/* ---- for the tests --------------------------------------------------------------------------- */

bq_app_config fake_config(void)
{
    bq_app_config c;

    memset(&c, 0, sizeof c);
    c.period_ms = 100;
    c.retry_ms = 1000;
    c.pack = bq_pack_config_nmc(FAKE_CELLS, FAKE_SENSORS, 1);
    c.pack.comm_timeout_ms = 500;
    c.pack.debounce_ms = 300;
    c.pack.recover_ms = 1000;
    return c;
}

void fake_init(fake_board *f, uint32_t us)
{
    memset(f, 0, sizeof *f);
    f->us = us;
    for (int i = 0; i < FAKE_JOBS; i++) {
        f->job[i].takes_us = 3000;
    }
    for (int i = 0; i < FAKE_CELLS; i++) {
        f->mv[i] = 3700;
    }
    f->dc = 250;
    f->has_contactor = true;
    f->has_feedback = true;
    f->feedback_us = 20000;
    f->moved_us = us - 1000000u;
}

bq_afe fake_afe(fake_board *f)
{
    const bq_afe afe = {&afe_ops, f};

    return afe;
}

bq_gpio fake_gpio(fake_board *f)
{
    const bq_gpio gpio = {&gpio_ops, f};

    return gpio;
}

bq_clock fake_clock(fake_board *f)
{
    const bq_clock clock = {now_us, f};

    return clock;
}

bq_status fake_start(fake_board *f, const bq_app_config *c, bool ammeter)
{
    const bq_afe afe = fake_afe(f);
    const bq_gpio gpio = fake_gpio(f);
    const bq_clock clock = fake_clock(f);
    const bq_ammeter meter = {read_current, f};

    return bq_app_init(&f->app, c, &afe, &gpio, &clock, ammeter ? &meter : NULL, f->cells, FAKE_CELLS,
                       f->temps, FAKE_SENSORS, f->modules, 1);
}

void fake_run(fake_board *f, uint32_t ms)
{
    const uint64_t until = f->passed_us + (uint64_t)ms * 1000u;

    while (f->passed_us < until) {
        uint32_t hint = bq_app_step(&f->app);
        TEST_ASSERT_EQUAL(f->closed,
                          bq_app_outputs_on(&f->app) && f->has_contactor && f->line_status == BQ_OK);
        hint = hint == 0u ? 10u : hint;
        if (f->passed_us + hint > until) {
            hint = (uint32_t)(until - f->passed_us);
        }
        f->us += hint;
        f->passed_us += hint;
    }
}

void fake_on(fake_board *f)
{
    TEST_ASSERT_EQUAL(BQ_OK, bq_app_request(&f->app, BQ_REQUEST_ON));
    fake_run(f, 1000);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, fake_state(f));
    TEST_ASSERT_TRUE(f->closed);
}

bq_pack_state_id fake_state(const fake_board *f)
{
    return bq_app_pack(&f->app)->state;
}

int fake_active(const fake_board *f, bq_pack_fault fault)
{
    return ((bq_app_pack(&f->app)->faults >> fault) & 1u) != 0u;
}
