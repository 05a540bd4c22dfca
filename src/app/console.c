/* SPDX-License-Identifier: Apache-2.0 */
/* The console's passes: what is waiting leaves first, then the running command, then the next key. */
#include "console_internal.h"
#include <string.h>

#define CTRL_C 3u

void bq_console_init(bq_console *c, const bq_stream *stream)
{
    memset(c, 0, sizeof *c);
    if (stream != NULL) {
        c->stream = *stream;
    }
    c->command = CONSOLE_GREETING;
    console_end(c); /* whatever the life before has left in the row */
}

bool bq_console_idle(const bq_console *c)
{
    return c->stream.ops == NULL || (c->out_len == 0u && c->command == 0u);
}

static uint32_t flush(bq_console *c)
{
    const size_t left = (size_t)(c->out_len - c->out_sent);
    const size_t took = c->stream.ops->write(c->stream.ctx, (const uint8_t *)&c->out[c->out_sent], left);

    if (took < left) {
        c->out_sent = (uint8_t)(c->out_sent + took);
        return BQ_CONSOLE_WAIT_US;
    }
    c->out_len = 0;
    c->out_sent = 0;
    return 0;
}

/* Whether there is a byte of input; then it is `held`. */
static bool look_ahead(bq_console *c)
{
    if (!c->has_held) {
        c->has_held = c->stream.ops->read(c->stream.ctx, &c->held, 1) == 1u;
    }
    return c->has_held;
}

/* Ctrl-C ends a command; any other byte waits for its end. */
static bool interrupted(bq_console *c)
{
    if (!look_ahead(c) || c->held != CTRL_C) {
        return false;
    }
    c->has_held = false;
    console_text(c, "^C");
    console_end(c);
    return true;
}

static void finish(bq_console *c)
{
    c->command = 0;
    c->len = 0;
    c->cursor = 0;
    c->line[0] = '\0';
    console_prompt(c);
}

static uint32_t run(bq_console *c, bq_console_target *t)
{
    console_row made;

    if (interrupted(c)) {
        finish(c);
        return 0;
    }
    if (t->app != NULL) {
        c->now_ms = bq_app_now_ms(t->app);
        c->since_ms = bq_app_step_age_ms(t->app);
    }
    made = console_run(c, t);
    if (made == CONSOLE_ROW) {
        console_end(c);
    } else if (made == CONSOLE_DONE) {
        finish(c);
    }
    return made == CONSOLE_LATER ? BQ_CONSOLE_WAIT_US : 0u;
}

static uint32_t listen(bq_console *c)
{
    if (!look_ahead(c)) {
        return UINT32_MAX;
    }
    c->has_held = false;
    if (console_edit(c, c->held)) {
        console_remember(c);
        c->row = 0;
        c->item = 0;
        c->command = console_parse(c);
        if (c->command == 0u) {
            finish(c);
        }
    }
    return 0;
}

uint32_t bq_console_step(bq_console *c, bq_console_target *target)
{
    if (c->stream.ops == NULL) {
        return UINT32_MAX;
    }
    if (c->out_len > 0u) {
        return flush(c);
    }
    return c->command != 0u ? run(c, target) : listen(c);
}
