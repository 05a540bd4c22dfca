/* SPDX-License-Identifier: Apache-2.0 */
#include "ps_text.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int ps_fail(ps_error *e, ps_place at, const char *format, ...)
{
    if (e->set) {
        return -1;
    }
    e->set = true;
    int n = snprintf(e->text, sizeof e->text, "%s:%d: ", at.file, at.line);
    if (n > 0 && (size_t)n < sizeof e->text) {
        va_list args;
        va_start(args, format);
        (void)vsnprintf(e->text + n, sizeof e->text - (size_t)n, format, args);
        va_end(args);
    }
    return -1;
}

int ps_split(ps_words *w, const char *text)
{
    w->count = 0;
    for (;;) {
        while (isspace((unsigned char)*text)) {
            text++;
        }
        if (*text == '\0') {
            return 0;
        }
        size_t n = 0;
        while (text[n] != '\0' && !isspace((unsigned char)text[n])) {
            n++;
        }
        if (w->count == PS_WORDS || n >= PS_WORD) {
            return -1;
        }
        memcpy(w->word[w->count], text, n);
        w->word[w->count][n] = '\0';
        w->count++;
        text += n;
    }
}

bool ps_is(const ps_words *w, int i, const char *text)
{
    return i < w->count && strcmp(w->word[i], text) == 0;
}

bool ps_number(const char *text, double *value)
{
    if (strchr("+-.0123456789", text[0]) == NULL || text[0] == '\0' || strpbrk(text, "xX") != NULL) {
        return false;
    }
    char *end;
    double x = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(x)) {
        return false;
    }
    *value = x;
    return true;
}

bool ps_int(const char *text, int *value)
{
    char *end;
    errno = 0;
    long x = strtol(text, &end, 10);
    if (end == text || *end != '\0' || errno != 0 || x < INT_MIN || x > INT_MAX) {
        return false;
    }
    *value = (int)x;
    return true;
}

static double unit_ns(const char *unit)
{
    static const struct {
        const char *name;
        double ns;
    } units[] = {{"us", 1e3}, {"ms", 1e6}, {"s", 1e9}, {"min", 60e9}, {"h", 3600e9}};
    for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
        if (strcmp(unit, units[i].name) == 0) {
            return units[i].ns;
        }
    }
    return 0.0;
}

bool ps_time(const char *text, uint64_t *ns)
{
    if (!isdigit((unsigned char)text[0]) && text[0] != '.') {
        return false;
    }
    char *end;
    double x = strtod(text, &end);
    if (end == text || !isfinite(x) || x < 0.0) {
        return false;
    }
    while (*end == ' ' || *end == '\t') {
        end++;
    }
    double unit = unit_ns(end);
    if (unit <= 0.0) {
        if (*end == '\0' && x <= 0.0) {
            *ns = 0;
            return true;
        }
        return false;
    }
    x *= unit;
    if (x > (double)PS_TIME_MAX) {
        return false;
    }
    *ns = (uint64_t)(x + 0.5);
    return true;
}

bool ps_time_words(const ps_words *w, int *i, uint64_t *ns)
{
    if (*i >= w->count) {
        return false;
    }
    if (*i + 1 < w->count && unit_ns(w->word[*i + 1]) > 0.0) {
        char both[2 * PS_WORD];
        (void)snprintf(both, sizeof both, "%s %s", w->word[*i], w->word[*i + 1]);
        *i += 2;
        return ps_time(both, ns);
    }
    *i += 1;
    return ps_time(w->word[*i - 1], ns);
}

char *ps_trim(char *text)
{
    while (isspace((unsigned char)*text)) {
        text++;
    }
    size_t n = strlen(text);
    while (n > 0 && isspace((unsigned char)text[n - 1])) {
        text[--n] = '\0';
    }
    return text;
}
