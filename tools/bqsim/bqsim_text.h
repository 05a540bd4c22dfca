/* SPDX-License-Identifier: Apache-2.0 */
/** @file bqsim_text.h Pieces of a command line and the notations of numbers in it. Private to bqsim. */
#ifndef BQSIM_TEXT_H
#define BQSIM_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** A slice of a line; not terminated. */
typedef struct bqsim_text {
    const char *p;
    size_t n;
} bqsim_text;

/** Cuts the next word (blanks are space and tab) from the front of `rest`; false at its end. */
bool bqsim_word(bqsim_text *rest, bqsim_text *word);
/** Cuts the part before the next dot from the front of a path; false when nothing is left. Parts may be
 * empty. */
bool bqsim_part(bqsim_text *path, bqsim_text *part);
bool bqsim_is(bqsim_text t, const char *word);

/* Each of these accepts the whole slice or returns false and leaves *value. */

bool bqsim_hex8(bqsim_text t, uint8_t *value); /**< exactly two hex digits */
bool bqsim_count(bqsim_text t, uint32_t low, uint32_t high,
                 uint32_t *value);              /**< decimal, no sign, no leading zero */
bool bqsim_number(bqsim_text t, double *value); /**< finite decimal number */
bool bqsim_time(bqsim_text t, uint64_t *ns);    /**< number and us, ms, s, min or h */

/** The shortest decimal notation without exponent, at least `decimals` places, that reads back as the same
 * number. */
void bqsim_print_number(char *out, size_t size, double value, int decimals);

#endif
