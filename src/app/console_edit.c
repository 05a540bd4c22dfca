/* SPDX-License-Identifier: Apache-2.0 */
/* The line editor: keys and the escape sequences of terminals, history, what the terminal shows. */
#include "console_internal.h"
#include <string.h>

enum {
    CTRL_A = 1,
    CTRL_B,
    CTRL_C,
    CTRL_D,
    CTRL_E,
    CTRL_F,
    BELL,
    BACKSPACE,
    CTRL_L = 12,
    CTRL_N = 14,
    CTRL_P = 16,
    CTRL_U = 21,
    ESCAPE = 27,
    DELETE = 127
};

/* States of an escape sequence; a digit of its parameter stands for itself. */
enum { PLAIN = 0, AFTER_ESCAPE = 1, AFTER_BRACKET = 2 };

void console_prompt(bq_console *c)
{
    console_text(c, "> ");
}

/* The whole line again, cursor in its place. */
static void redraw(bq_console *c)
{
    console_char(c, '\r');
    console_prompt(c);
    for (uint8_t i = 0; i < c->len; i++) {
        console_char(c, c->line[i]);
    }
    console_text(c, "\033[K");
    for (uint8_t i = c->cursor; i < c->len; i++) {
        console_char(c, '\b');
    }
}

static void set_line(bq_console *c, const char *text)
{
    c->len = (uint8_t)strlen(text);
    memmove(c->line, text, (size_t)c->len + 1u);
    c->cursor = c->len;
}

static void insert(bq_console *c, char what)
{
    if (c->len == BQ_CONSOLE_LINE) {
        console_char(c, (char)BELL);
        return;
    }
    memmove(&c->line[c->cursor + 1u], &c->line[c->cursor], (size_t)(c->len - c->cursor) + 1u);
    c->line[c->cursor++] = what;
    c->len++;
    if (c->cursor == c->len) {
        console_char(c, what);
    } else {
        redraw(c);
    }
}

/* Removes the character at the cursor. */
static void remove_here(bq_console *c)
{
    if (c->cursor < c->len) {
        memmove(&c->line[c->cursor], &c->line[c->cursor + 1u], (size_t)(c->len - c->cursor));
        c->len--;
        redraw(c);
    }
}

static void move_to(bq_console *c, uint8_t cursor)
{
    if (cursor <= c->len) { /* 255 = left of the beginning */
        c->cursor = cursor;
        redraw(c);
    }
}

/* history[0] keeps the line that was being typed while older ones are shown. */
static void recall(bq_console *c, uint8_t n)
{
    if (n > BQ_CONSOLE_HISTORY || (n > 0u && c->history[n][0] == '\0')) {
        console_char(c, (char)BELL);
        return;
    }
    if (c->recalled == 0u) {
        memcpy(c->history[0], c->line, sizeof c->line);
    }
    c->recalled = n;
    set_line(c, c->history[n]);
    redraw(c);
}

void console_remember(bq_console *c)
{
    c->recalled = 0;
    if (c->len > 0u && strcmp(c->line, c->history[1]) != 0) {
        memmove(c->history[2], c->history[1], sizeof c->history[0] * (BQ_CONSOLE_HISTORY - 1u));
        memcpy(c->history[1], c->line, sizeof c->line);
    }
}

/* Keys by their control characters; the sequences of a terminal are translated into these. */
static void key(bq_console *c, uint8_t code)
{
    switch (code) {
    case CTRL_A:
        move_to(c, 0);
        break;
    case CTRL_B:
        move_to(c, (uint8_t)(c->cursor - 1u));
        break;
    case CTRL_F:
        move_to(c, (uint8_t)(c->cursor + 1u));
        break;
    case CTRL_E:
        move_to(c, c->len);
        break;
    case BACKSPACE:
    case DELETE:
        if (c->cursor == 0u) {
            break;
        }
        c->cursor--;
        remove_here(c);
        break;
    case CTRL_D:
        remove_here(c);
        break;
    case CTRL_P:
        recall(c, (uint8_t)(c->recalled + 1u));
        break;
    case CTRL_N:
        recall(c, (uint8_t)(c->recalled - 1u)); /* below 0: 255, the bell */
        break;
    case CTRL_U:
        set_line(c, "");
        redraw(c);
        break;
    case CTRL_L:
        redraw(c);
        break;
    default:
        break;
    }
}

/* The last byte of a sequence ESC [ x or ESC O x, or the digit of ESC [ digit ~. */
static void sequence(bq_console *c, uint8_t what)
{
    static const char known[] = "ABCDHF13478";
    static const char keys[] = {CTRL_P, CTRL_N, CTRL_F, CTRL_B, CTRL_A, CTRL_E,
                                CTRL_A, CTRL_D, CTRL_E, CTRL_A, CTRL_E};

    for (uint8_t i = 0; i < sizeof keys; i++) {
        if ((uint8_t)known[i] == what) {
            key(c, (uint8_t)keys[i]);
        }
    }
}

/* True while the byte belongs to a sequence. */
static bool escaped(bq_console *c, uint8_t byte)
{
    const uint8_t state = c->escape;

    if (byte == ESCAPE) {
        c->escape = AFTER_ESCAPE;
        return true;
    }
    if (state == PLAIN) {
        return false;
    }
    if (byte < ' ') { /* a key in the middle of a sequence ends it */
        c->escape = PLAIN;
        return false;
    }
    if (state == AFTER_ESCAPE) {
        c->escape = byte == '[' || byte == 'O' ? AFTER_BRACKET : PLAIN;
    } else if (byte >= '@') {
        c->escape = PLAIN;
        sequence(c, byte == '~' ? state : byte);
    } else if (state == AFTER_BRACKET && byte >= '0' && byte <= '9') {
        c->escape = byte; /* further parameters say which modifier was held: ignored */
    }
    return true;
}

bool console_edit(bq_console *c, uint8_t byte)
{
    const bool after_cr = c->after_cr;

    c->after_cr = byte == '\r';
    if (escaped(c, byte) || (byte == '\n' && after_cr)) {
        return false;
    }
    if (byte == '\r' || byte == '\n') {
        console_end(c);
        return true;
    }
    if (byte == CTRL_C) {
        set_line(c, "");
        c->recalled = 0;
        console_text(c, "^C");
        console_end(c);
        console_prompt(c);
    } else if (byte >= ' ' && byte < DELETE) {
        insert(c, (char)byte);
    } else {
        key(c, byte);
    }
    return false;
}
