/* SPDX-License-Identifier: Apache-2.0 */
/* Text into the row under construction. What does not fit is left out; the end of the row always fits. */
#include "console_internal.h"
#include <string.h>

#define END_OF_ROW 2u

void console_char(bq_console *c, char what)
{
    if (c->out_len < BQ_CONSOLE_ROW - END_OF_ROW) {
        c->out[c->out_len++] = what;
    }
}

void console_text(bq_console *c, const char *what)
{
    while (*what != '\0') {
        console_char(c, *what++);
    }
}

void console_end(bq_console *c)
{
    c->out[c->out_len++] = '\r';
    c->out[c->out_len++] = '\n';
}

/* With a point before the last `decimals` digits. */
static void digits(bq_console *c, uint32_t value, unsigned decimals)
{
    char reversed[10];
    unsigned n = 0;

    do {
        reversed[n++] = (char)('0' + value % 10u);
        value /= 10u;
    } while (value != 0u || n <= decimals);
    while (n > 0u) {
        console_char(c, reversed[--n]);
        if (n == decimals && n > 0u) {
            console_char(c, '.');
        }
    }
}

static void hex(bq_console *c, uint32_t value, unsigned n)
{
    while (n > 0u) {
        n--;
        console_char(c, "0123456789abcdef"[(value >> (4u * n)) & 15u]);
    }
}

/* An age when the picture was made; it has grown since. */
static void age(bq_console *c, uint32_t ms)
{
    if (ms > INT32_MAX - c->since_ms) {
        console_text(c, ", never measured");
        return;
    }
    console_text(c, ", ");
    digits(c, ms + c->since_ms, 0);
    console_text(c, " ms old");
}

static void one(bq_console *c, char code, int32_t value)
{
    unsigned decimals = (unsigned)(code - '0');

    switch (code) {
    case 'x':
        hex(c, (uint32_t)value, 4);
        return;
    case 'X':
        hex(c, (uint32_t)value, 8);
        return;
    case 'a':
        age(c, (uint32_t)value);
        return;
    case 'E':
        console_text(c, (uint32_t)value > 1u ? "BQ_E_" : "BQ_");
        console_text(c, bq_status_word((bq_status)value));
        return;
    case 'S':
        console_text(c, bq_pack_state_name((bq_pack_state_id)value));
        return;
    case 'F':
        console_text(c, bq_pack_fault_name((bq_pack_fault)value));
        return;
    case 'H':
        console_text(c, bq_pack_hold_name((bq_pack_hold)value));
        return;
    case 'T':
        value = (int32_t)(c->now_ms - (uint32_t)value);
        /* fall through */
    case 't':
        value = (int32_t)((uint32_t)value / 100u);
        decimals = 1;
        break;
    default:
        if (decimals != 0u && value < 0) {
            console_char(c, '-');
            value = (int32_t)(0u - (uint32_t)value);
        }
        break;
    }
    digits(c, (uint32_t)value, decimals);
}

/* The n-th of the words up to `end`; returns what follows them. */
static const char *choose(bq_console *c, const char *at, char end, uint32_t n)
{
    for (; *at != end; at++) {
        if (*at == '|') {
            n--;
        } else if (n == 0u) {
            console_char(c, *at);
        }
    }
    return at + 1;
}

void console_say(bq_console *c, const char *format, const int32_t *v)
{
    while (*format != '\0') {
        char code = *format++;
        if (code != '%' || *format == '\0') {
            console_char(c, code);
            continue;
        }
        code = *format++;
        if (code == '[') {
            format = choose(c, format, ']', (uint32_t)*v);
        } else if (code == '(') {
            format = choose(c, format, ')', *v == 0);
            if (*v != 0) {
                one(c, '0', *v);
            }
        } else if (code != '?') {
            one(c, code, *v);
        } else if (*v == 0) {
            format = "not valid";
        }
        v++;
    }
}
