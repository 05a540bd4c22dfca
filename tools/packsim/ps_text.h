/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file ps_text.h
 * Words, numbers and times of the scenario language, and the one form of an error: FILE:LINE: reason.
 */
#ifndef PS_TEXT_H
#define PS_TEXT_H

#include <stdbool.h>
#include <stdint.h>

#define PS_PATH 1024
#define PS_WORDS 16
#define PS_WORD 64
#define PS_MS 1000000ull
#define PS_S 1000000000ull
#define PS_TIME_MAX (10000ull * 3600ull * PS_S)

/** Where a text came from. */
typedef struct ps_place {
    const char *file;
    int line;
} ps_place;

/** The first error; later ones do not replace it. */
typedef struct ps_error {
    bool set;
    char text[PS_PATH + 512];
} ps_error;

/** Records `FILE:LINE: reason`. Always returns -1. */
int ps_fail(ps_error *e, ps_place at, const char *format, ...) __attribute__((format(printf, 3, 4)));

/** A text cut at white space. */
typedef struct ps_words {
    int count;
    char word[PS_WORDS][PS_WORD];
} ps_words;

/** 0, or -1 when there are too many words or one is too long. */
int ps_split(ps_words *w, const char *text);
/** True when word i exists and is exactly `text`. */
bool ps_is(const ps_words *w, int i, const char *text);

/** A finite decimal number and nothing else. */
bool ps_number(const char *text, double *value);
/** A whole number within int. */
bool ps_int(const char *text, int *value);
/** A time with its unit (us, ms, s, min, h; a space before the unit is allowed; 0 needs none), rounded to
 * nanoseconds. */
bool ps_time(const char *text, uint64_t *ns);
/** The same at word *i (and the next, when the unit stands apart); moves *i behind it. */
bool ps_time_words(const ps_words *w, int *i, uint64_t *ns);

/** Cuts white space at both ends, in place; returns the start. */
char *ps_trim(char *text);

#endif
