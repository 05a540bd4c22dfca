/* SPDX-License-Identifier: Apache-2.0 */
#include "bqsim_text.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NUMBER_MAX 63 /* characters of a number */
#define DECIMALS_MAX 40

static bool is_blank(char c)
{
    return c == ' ' || c == '\t';
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

bool bqsim_word(bqsim_text *rest, bqsim_text *word)
{
    while (rest->n > 0 && is_blank(*rest->p)) {
        rest->p++;
        rest->n--;
    }
    word->p = rest->p;
    word->n = 0;
    while (rest->n > 0 && !is_blank(*rest->p)) {
        rest->p++;
        rest->n--;
        word->n++;
    }
    return word->n > 0;
}

bool bqsim_part(bqsim_text *path, bqsim_text *part)
{
    const char *dot;

    if (path->p == NULL) {
        return false;
    }
    dot = path->n > 0 ? memchr(path->p, '.', path->n) : NULL;
    part->p = path->p;
    part->n = dot != NULL ? (size_t)(dot - path->p) : path->n;
    if (dot != NULL) {
        path->n -= part->n + 1;
        path->p = dot + 1;
    } else {
        path->p = NULL;
        path->n = 0;
    }
    return true;
}

bool bqsim_is(bqsim_text t, const char *word)
{
    return strlen(word) == t.n && memcmp(t.p, word, t.n) == 0;
}

static int hex_digit(char c)
{
    if (is_digit(c)) {
        return c - '0';
    }
    if (c >= 'a' && c <= 'f') {
        return c - 'a' + 10;
    }
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

bool bqsim_hex8(bqsim_text t, uint8_t *value)
{
    int high, low;

    if (t.n != 2) {
        return false;
    }
    high = hex_digit(t.p[0]);
    low = hex_digit(t.p[1]);
    if (high < 0 || low < 0) {
        return false;
    }
    *value = (uint8_t)(high * 16 + low);
    return true;
}

bool bqsim_count(bqsim_text t, uint32_t low, uint32_t high, uint32_t *value)
{
    uint32_t v = 0;

    if (t.n == 0 || t.n > 9 || (t.n > 1 && t.p[0] == '0')) {
        return false;
    }
    for (size_t i = 0; i < t.n; i++) {
        if (!is_digit(t.p[i])) {
            return false;
        }
        v = v * 10 + (uint32_t)(t.p[i] - '0');
    }
    if (v < low || v > high) {
        return false;
    }
    *value = v;
    return true;
}

static size_t digits(bqsim_text t, size_t from)
{
    size_t n = 0;

    while (from + n < t.n && is_digit(t.p[from + n])) {
        n++;
    }
    return n;
}

static size_t sign(bqsim_text t, size_t from)
{
    return from < t.n && (t.p[from] == '+' || t.p[from] == '-') ? 1 : 0;
}

/* Length of the decimal number at the front of t, 0 if there is none. Letters such as nan, inf and 0x never
 * qualify. */
static size_t number_length(bqsim_text t)
{
    size_t i = sign(t, 0), whole = digits(t, i), fraction = 0;

    i += whole;
    if (i < t.n && t.p[i] == '.') {
        fraction = digits(t, i + 1);
        i += 1 + fraction;
    }
    if (whole + fraction == 0) {
        return 0;
    }
    if (i < t.n && (t.p[i] == 'e' || t.p[i] == 'E')) {
        size_t start = i + 1 + sign(t, i + 1), exponent = digits(t, start);

        if (exponent > 0) {
            i = start + exponent;
        }
    }
    return i;
}

bool bqsim_number(bqsim_text t, double *value)
{
    char copy[NUMBER_MAX + 1];
    double v;

    if (t.n == 0 || t.n > NUMBER_MAX || number_length(t) != t.n) {
        return false;
    }
    memcpy(copy, t.p, t.n);
    copy[t.n] = '\0';
    v = strtod(copy, NULL);
    if (!isfinite(v)) {
        return false;
    }
    *value = v;
    return true;
}

bool bqsim_time(bqsim_text t, uint64_t *ns)
{
    static const struct {
        const char *name;
        double ns;
    } unit[] = {{"us", 1e3}, {"ms", 1e6}, {"s", 1e9}, {"min", 60e9}, {"h", 3600e9}};
    bqsim_text number = {t.p, number_length(t)};
    bqsim_text rest = {t.p + number.n, t.n - number.n};
    double v;

    if (!bqsim_number(number, &v) || v < 0.0) {
        return false;
    }
    for (size_t i = 0; i < sizeof unit / sizeof unit[0]; i++) {
        if (bqsim_is(rest, unit[i].name)) {
            v = floor(v * unit[i].ns + 0.5);
            if (v >= 9.2e18) {
                return false;
            }
            *ns = (uint64_t)v;
            return true;
        }
    }
    return false;
}

void bqsim_print_number(char *out, size_t size, double value, int decimals)
{
    double v = value == 0.0 ? 0.0 : value; /* no minus zero */

    for (int places = decimals; places <= DECIMALS_MAX; places++) {
        (void)snprintf(out, size, "%.*f", places, v);
        if (strtod(out, NULL) == v) {
            return;
        }
    }
}
