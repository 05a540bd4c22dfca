/* SPDX-License-Identifier: Apache-2.0 */
#include "ps_console.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#define CTRL_RIGHT_BRACKET 29

/* ---- the terminal ------------------------------------------------------------------------------- */

static struct termios cooked;
static volatile sig_atomic_t is_raw;

static void restore(void)
{
    if (is_raw != 0) {
        (void)tcsetattr(STDIN_FILENO, TCSANOW, &cooked);
        is_raw = 0;
    }
}

static void on_signal(int number)
{
    restore();
    (void)signal(number, SIG_DFL);
    (void)raise(number);
}

static bool make_raw(void)
{
    struct termios raw;
    if (isatty(STDIN_FILENO) != 1 || tcgetattr(STDIN_FILENO, &cooked) != 0) {
        return false;
    }
    raw = cooked;
    raw.c_iflag &= (tcflag_t) ~(ICRNL | INLCR | IGNCR | IXON | ISTRIP | BRKINT);
    raw.c_lflag &= (tcflag_t) ~(ECHO | ECHONL | ICANON | ISIG | IEXTEN);
    raw.c_oflag &= (tcflag_t)~OPOST;
    raw.c_cc[VMIN] = 0;
    raw.c_cc[VTIME] = 0;
    if (tcsetattr(STDIN_FILENO, TCSANOW, &raw) != 0) {
        return false;
    }
    is_raw = 1;
    (void)atexit(restore);
    (void)signal(SIGTERM, on_signal);
    (void)signal(SIGHUP, on_signal);
    (void)signal(SIGINT, on_signal);
    return true;
}

static uint64_t wall_ns(void)
{
    struct timespec t = {0, 0};
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * PS_S + (uint64_t)t.tv_nsec;
}

/* Waits until the wall clock has come as far, or a key. */
static void keep_pace(const ps_console *c, uint64_t now)
{
    uint64_t passed = wall_ns() - c->wall_ns, wanted = now - c->begun;
    struct pollfd keys = {STDIN_FILENO, POLLIN, 0};
    if (wanted > passed + PS_MS) {
        (void)poll(&keys, 1, (int)((wanted - passed) / PS_MS));
    }
}

static void take_keys(ps_console *c)
{
    ssize_t n;
    if (c->taken < c->len) {
        return;
    }
    n = read(STDIN_FILENO, c->line, sizeof c->line);
    c->len = n > 0 ? (size_t)n : 0;
    c->taken = 0;
    c->left = c->left || (n < 0 && errno != EAGAIN && errno != EINTR) ||
              memchr(c->line, CTRL_RIGHT_BRACKET, c->len) != NULL;
}

/* ---- a pipe or file --------------------------------------------------------------------------------- */

/* The next line, its time taken off. */
static void read_line(ps_console *c)
{
    char *at = c->ahead;
    c->due = 0;
    if (fgets(c->ahead, sizeof c->ahead - 1u, stdin) == NULL) {
        c->ended = true;
        return;
    }
    c->waiting = true;
    if (*at == '@') {
        size_t n = strcspn(at, " \t\r\n");
        char end = at[n];
        at[n] = '\0';
        if (ps_time(at + 1, &c->due)) {
            at[n] = end;
            at += n + strspn(at + n, " \t");
            memmove(c->ahead, at, strlen(at) + 1u);
        } else {
            at[n] = end;
        }
    }
}

static void take_line(ps_console *c, uint64_t now)
{
    if (!c->prompted) {
        return;
    }
    if (!c->waiting && !c->ended) {
        read_line(c);
    }
    if (c->waiting && c->due <= now) {
        c->len = strlen(c->ahead);
        memcpy(c->line, c->ahead, c->len);
        if (c->len == 0u || c->line[c->len - 1u] != '\n') {
            c->line[c->len++] = '\n'; /* the last line may lack it */
        }
        c->taken = 0;
        c->waiting = c->prompted = false;
    }
}

/* Whether the last that was seen is a prompt, "> " at the beginning of a row: what was typed is answered. */
static void look_for_prompt(ps_console *c, uint8_t byte)
{
    static const char prompt[] = "\n> ";
    c->matched = byte == (uint8_t)prompt[c->matched] ? c->matched + 1u : byte == '\n' ? 1u : 0u;
    c->prompted = c->matched == sizeof prompt - 1u;
    c->matched %= sizeof prompt - 1u;
}

/* ---- both ---------------------------------------------------------------------------------------------- */

static size_t stream_write(void *ctx, const uint8_t *data, size_t len)
{
    ps_console *c = ctx;
    for (size_t i = 0; i < len; i++) {
        look_for_prompt(c, data[i]);
        if (c->terminal || data[i] != '\r') {
            (void)putchar(data[i]);
        }
    }
    (void)fflush(stdout);
    return len;
}

static size_t stream_read(void *ctx, uint8_t *data, size_t len)
{
    ps_console *c = ctx;
    size_t n = c->len - c->taken < len ? c->len - c->taken : len;
    memcpy(data, c->line + c->taken, n);
    c->taken += n;
    return n;
}

bq_stream ps_console_stream(ps_console *c)
{
    static const bq_stream_ops ops = {stream_write, stream_read};
    const bq_stream stream = {&ops, c};
    return stream;
}

void ps_console_open(ps_console *c)
{
    memset(c, 0, sizeof *c);
    c->terminal = make_raw();
    c->wall_ns = wall_ns();
}

void ps_console_close(ps_console *c)
{
    restore();
    (void)putchar('\n');
    c->terminal = false;
}

void ps_console_turn(ps_console *c, uint64_t now)
{
    if (!c->terminal) {
        take_line(c, now);
        return;
    }
    keep_pace(c, now);
    take_keys(c);
}
