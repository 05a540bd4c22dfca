/* SPDX-License-Identifier: Apache-2.0 */
/** @file bqsim_value.h How the values of paths are written. Inside, every value travels as a double. Private
 * to bqsim. */
#ifndef BQSIM_VALUE_H
#define BQSIM_VALUE_H

#include "bqsim_text.h"

typedef enum bqsim_notation {
    BQSIM_NUMBER, /* decimal number */
    BQSIM_VOLTS,  /* the same, printed with at least millivolts */
    BQSIM_VBAT,   /* volts, or sum, which stands for any negative value */
    BQSIM_WHOLE,  /* whole decimal number */
    BQSIM_LEVEL,  /* 0 or 1 */
    BQSIM_SWITCH, /* on or off */
    BQSIM_BYTE,   /* two hex digits */
    BQSIM_WORD,   /* four hex digits, read only */
    BQSIM_TIME,   /* a time with its unit, in nanoseconds, write only */
    BQSIM_NAME    /* one of the owner's names, by number, read only; the owner prints it */
} bqsim_notation;

/** One of two words; false for any other. */
bool bqsim_choice(bqsim_text word, const char *no, const char *yes, double *value);
/** A value from low to high; false when the word does not say one. */
bool bqsim_read_value(bqsim_notation as, bqsim_text word, double low, double high, double *value);
void bqsim_print_value(bqsim_notation as, double value, char *out, size_t size);

#endif
