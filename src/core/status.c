/* SPDX-License-Identifier: Apache-2.0 */
#include "status_words.h"

const char *bq_status_name(bq_status status)
{
    const char *name = status_word(STATUS_WORDS("BQ_", "BQ_E_"), status);

    return *name != '?' ? name : "BQ_E_?";
}
