/* SPDX-License-Identifier: Apache-2.0 */
/* Apart from the whole names: a program takes one of the two lists. */
#include "status_words.h"

const char *bq_status_word(bq_status status)
{
    return status_word(STATUS_WORDS("", ""), status);
}
