/* SPDX-License-Identifier: Apache-2.0 */
/* Text into the row under construction. What does not fit is left out; the end of the row always fits. */
#include "console_internal.h"
#include <string.h>

#define END_OF_ROW 2u
#define NOT_VALID "not valid"

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

static void quantity(bq_console *c, int32_t value, unsigned decimals, const char *unit)
{
    if (value < 0) {
        console_char(c, '-');
    }
    digits(c, value < 0 ? 0u - (uint32_t)value : (uint32_t)value, decimals);
    console_text(c, unit);
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

static bool ends(char what)
{
    return what == '|' || what == ']' || what == '\0';
}

const char *console_word(const char *list, uint32_t n)
{
    for (; n > 0u; n--) {
        while (!ends(*list)) {
            list++;
        }
        if (*list++ != '|') {
            return NULL;
        }
    }
    return list;
}

static void choose(bq_console *c, const char *list, uint32_t n)
{
    const char *word = console_word(list, n);

    while (word != NULL && !ends(*word)) {
        console_char(c, *word++);
    }
}

static void one(bq_console *c, char code, int32_t value)
{
    switch (code) {
    case 'u':
        digits(c, (uint32_t)value, 0);
        break;
    case 'x':
        hex(c, (uint32_t)value, 4);
        break;
    case 'X':
        hex(c, (uint32_t)value, 8);
        break;
    case 'v':
        quantity(c, value, 3, " V");
        break;
    case 'i':
        quantity(c, value, 3, " A");
        break;
    case 'c':
        quantity(c, value, 1, " C");
        break;
    case 'p':
        if (value < 0) {
            console_text(c, NOT_VALID);
        } else {
            quantity(c, value, 1, " %");
        }
        break;
    case 'T':
        value = (int32_t)(c->now_ms - (uint32_t)value);
        /* fall through */
    case 't':
        digits(c, (uint32_t)value / 100u, 1);
        console_text(c, " s");
        break;
    case 'a':
        age(c, (uint32_t)value);
        break;
    case 'E':
        console_text(c, bq_status_name((bq_status)value));
        break;
    case 'S':
        console_text(c, bq_pack_state_name((bq_pack_state_id)value));
        break;
    case 'F':
        console_text(c, bq_pack_fault_name((bq_pack_fault)value));
        break;
    default:
        console_text(c, bq_pack_hold_name((bq_pack_hold)value));
        break;
    }
}

/* Skips to behind `end`, copying if asked to. */
static const char *until(bq_console *c, const char *at, char end, bool copy)
{
    while (*at != end) {
        if (copy) {
            console_char(c, *at);
        }
        at++;
    }
    return at + 1;
}

void console_say(bq_console *c, const char *format, const int32_t *v)
{
    while (*format != '\0') {
        const char code = format[0] == '%' ? format[1] : '\0';
        if (code == '\0') {
            console_char(c, *format++);
            continue;
        }
        format += 2;
        if (code == '[') {
            choose(c, format, (uint32_t)*v);
            format = until(c, format, ']', false);
        } else if (code == '(') {
            format = until(c, format, ')', *v != 0);
            if (*v != 0) {
                one(c, 'u', *v);
            }
        } else if (code != '?') {
            one(c, code, *v);
        } else if (*v == 0) {
            format = NOT_VALID;
        }
        v++;
    }
}
