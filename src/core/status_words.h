/* SPDX-License-Identifier: Apache-2.0 */
/* The names of the statuses, one after the other from BQ_PENDING downwards; empty where no status has the
 * number. */
#ifndef STATUS_WORDS_H
#define STATUS_WORDS_H

#include "bqhost/status.h"
#include "bqhost/text.h"

/* `good` stands before the names of what is no error, `bad` before the others. */
#define STATUS_WORDS(good, bad)                                                                              \
    good "PENDING\0" good "OK\0" bad "ARG\0" bad "STATE\0" bad "BUSY\0" bad "UNSUPPORTED\0"                  \
         "\0\0\0\0\0" /* to -9 */                                                                            \
        bad "RANGE\0" bad "NO_CODE\0" bad "COV_CUV\0" bad "DEVICES\0" bad "CELLS\0" bad "UNLATCHED\0" bad    \
         "CLOCK\0" bad "CONFIG\0"                                                                            \
         "\0\0" /* to -19 */                                                                                 \
        bad "BUS\0" bad "TIMEOUT\0" bad "NO_ANSWER\0" bad "CRC\0" bad "IMPLAUSIBLE\0" bad "NACK\0" bad       \
         "ARBITRATION\0"                                                                                     \
         "\0\0\0" /* to -29 */                                                                               \
        bad "VERIFY\0" bad "NOT_FOUND\0" bad "EXTRA_DEVICE\0" bad "LOCKED_UP\0" bad "DEFECTIVE\0" bad        \
         "LINE_STUCK\0" bad "CHAIN_BROKEN\0" bad "PERSISTS\0" bad "NOT_BLANK\0" bad "VOLTAGE\0" bad          \
         "STALE\0" bad "CRC_OFF\0?"

/* The word of a status in such a list. */
static inline const char *status_word(const char *words, bq_status status)
{
    const char *word =
        bq_word(words, (unsigned)BQ_PENDING - (unsigned)status); /* large for what is above it */

    return *word != '\0' ? word : bq_word(word, UINT32_MAX);
}

#endif
