/* SPDX-License-Identifier: Apache-2.0 */
#include "bqhost/text.h"

const char *bq_word(const char *words, uint32_t n)
{
    for (; n > 0u && *words != '?'; n--) {
        while (*words++ != '\0') {
        }
    }
    return words;
}
