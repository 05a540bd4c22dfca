/* SPDX-License-Identifier: Apache-2.0 */
#include "terminal.h"
#include "unity.h"
#include <string.h>

/* ---- what a terminal does with what it gets ---- */

static void show(terminal *t, char what)
{
    switch (what) {
    case '\r':
        t->column = 0;
        break;
    case '\n':
        memset(t->row, 0, sizeof t->row);
        break;
    case '\b':
        t->column -= t->column > 0;
        break;
    case '\a':
        t->bells++;
        break;
    default:
        TEST_ASSERT_TRUE(what >= ' ' && what < 127);
        TEST_ASSERT_LESS_THAN((int)sizeof t->row - 1, t->column);
        t->row[t->column++] = what;
        break;
    }
}

static void take(terminal *t, const uint8_t *data, size_t len)
{
    for (size_t i = 0; i < len; i++) {
        TEST_ASSERT_LESS_THAN(TERMINAL_TEXT - 1, t->len);
        t->text[t->len++] = (char)data[i];
        t->text[t->len] = '\0';
        if (t->len >= 3u && memcmp(&t->text[t->len - 3u], "\033[K", 3) == 0) {
            memset(&t->row[t->column], 0, sizeof t->row - (size_t)t->column);
        } else if (data[i] != 27u && !(t->len >= 2u && t->text[t->len - 2u] == '\033')) {
            show(t, (char)data[i]);
        }
    }
}

/* ---- the stream ---- */

static size_t stream_write(void *ctx, const uint8_t *data, size_t len)
{
    terminal *t = ctx;
    const size_t n = len < t->takes ? len : t->takes;

    take(t, data, n);
    return n;
}

static size_t stream_read(void *ctx, uint8_t *data, size_t len)
{
    terminal *t = ctx;

    if (len == 0u || t->typed_read == t->typed_len) {
        return 0;
    }
    data[0] = (uint8_t)t->typed[t->typed_read++];
    return 1;
}

static void mcu_feed(void *ctx)
{
    (void)ctx;
}

static void mcu_reset(void *ctx)
{
    (void)ctx;
    TEST_FAIL_MESSAGE("the console resets nothing by itself");
}

static uint32_t mcu_stack_free(void *ctx)
{
    (void)ctx;
    return 512;
}

/* ---- for the tests ---- */

void terminal_restart(terminal *t, bool stream)
{
    static const bq_stream_ops ops = {stream_write, stream_read};
    const bq_stream s = {stream ? &ops : NULL, t};

    bq_console_init(&t->console, &s);
}

void terminal_init(terminal *t)
{
    static const bq_mcu_ops ops = {mcu_feed, mcu_reset, mcu_stack_free};
    bq_app_config config = fake_config();

    config.pack.balance_rest_ms = 0;
    memset(t, 0, sizeof *t);
    t->takes = 1000;
    fake_init(&t->board, 0);
    t->board.has_link = true;
    TEST_ASSERT_EQUAL(BQ_OK, fake_start(&t->board, &config, true));
    fake_run(&t->board, 1000);
    t->boot.image_ok = true;
    t->mcu = (bq_mcu){&ops, t, NULL};
    t->target.app = &t->board.app;
    t->target.name = "fake-board";
    t->target.mcu = &t->mcu;
    terminal_restart(t, true);
    terminal_settle(t);
    terminal_forget(t);
}

void terminal_settle(terminal *t)
{
    for (int n = 0; n < 20000; n++) {
        uint32_t hint;
        if (t->target.app != NULL) {
            t->target.now_ms = bq_app_now_ms(t->target.app);
        }
        hint = bq_console_step(&t->console, &t->target);
        if (hint == UINT32_MAX || (hint > 0u && t->takes == 0u)) {
            return;
        }
        TEST_ASSERT_TRUE(hint == 0u || hint == BQ_CONSOLE_WAIT_US);
        if (hint > 0u && t->target.app != NULL) {
            fake_run(&t->board, hint / 1000u);
        }
    }
    TEST_FAIL_MESSAGE("the console never comes to rest");
}

void terminal_type(terminal *t, const char *keys)
{
    const size_t n = strlen(keys);

    TEST_ASSERT_LESS_THAN(sizeof t->typed, n);
    memcpy(t->typed, keys, n);
    t->typed_len = n;
    t->typed_read = 0;
    terminal_settle(t);
}

void terminal_forget(terminal *t)
{
    t->len = 0;
    t->text[0] = '\0';
    t->bells = 0;
}

const char *terminal_ask(terminal *t, const char *line)
{
    terminal_forget(t);
    terminal_type(t, line);
    terminal_type(t, "\r");
    return t->text;
}
