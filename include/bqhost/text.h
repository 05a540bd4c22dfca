/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file text.h
 * Lists of names without pointers: one word after the other, each with its '\0'. A last word "?" stands for
 * all that have none.
 */
#ifndef BQHOST_TEXT_H
#define BQHOST_TEXT_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Word number `n`, from 0. The list must have it, or end with a "?". */
const char *bq_word(const char *words, uint32_t n);

#ifdef __cplusplus
}
#endif
#endif
