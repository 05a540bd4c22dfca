/* SPDX-License-Identifier: Apache-2.0 */
/** @file bqsim_call.h One command being executed, and the chip families' entries in the command tables.
 * Private to bqsim. */
#ifndef BQSIM_CALL_H
#define BQSIM_CALL_H

#include "bqsim.h"
#include "bqsim_text.h"

/** A command being executed: what is left of its line, and where its reply goes. */
typedef struct bqsim_call {
    bqsim_session *s;
    bqsim_text rest;
    char *reply;
    size_t size;
} bqsim_call;

/** Replies `ok`, or `ok VALUE` when `value` is not NULL. */
bqsim_result bqsim_accept(bqsim_call *c, const char *value);
/** Replies `err REASON`, followed by the word that was not liked when it has any characters. */
bqsim_result bqsim_refuse(bqsim_call *c, const char *reason, bqsim_text word);
/** Takes the next word; false (and a refusal naming `what`) when there is none. */
bool bqsim_argument(bqsim_call *c, const char *what, bqsim_text *word);
/** True at the end of the line; otherwise refuses what is left. */
bool bqsim_end(bqsim_call *c);

/** Takes the last word as a decimal number from low to high; false after a refusal. */
bool bqsim_last_count(bqsim_call *c, const char *what, uint32_t low, uint32_t high, uint32_t *value);

/* The stack of bq76PL536: bqsim_stack.c (life, bus), bqsim_stack_paths.c (inputs and outputs). */

bqsim_result bqsim_stack_create(bqsim_call *c);
bqsim_result bqsim_stack_spi(bqsim_call *c);
bqsim_result bqsim_stack_inject(bqsim_call *c, bqsim_flips *flips);
/** `device` is the text after `dev.`; the register follows on the line. */
bqsim_result bqsim_stack_peek(bqsim_call *c, bqsim_text device);
/** `path` is the text after `dev.` or `pin.`; a value follows on the line of set. */
bqsim_result bqsim_stack_set_dev(bqsim_call *c, bqsim_text path);
bqsim_result bqsim_stack_get_dev(bqsim_call *c, bqsim_text path);
bqsim_result bqsim_stack_set_pin(bqsim_call *c, bqsim_text path);
bqsim_result bqsim_stack_get_pin(bqsim_call *c, bqsim_text path);

/* The bq769x0: bqsim_afe.c (life, bus), bqsim_afe_paths.c (inputs and outputs). */

bqsim_result bqsim_afe_create(bqsim_call *c);
bqsim_result bqsim_afe_i2c(bqsim_call *c);
bqsim_result bqsim_afe_inject(bqsim_call *c);
bqsim_result bqsim_afe_peek(bqsim_call *c);
/** `path` is the text after `afe.`; a value follows on the line of set. */
bqsim_result bqsim_afe_set(bqsim_call *c, bqsim_text path);
bqsim_result bqsim_afe_get(bqsim_call *c, bqsim_text path);
/** True when there is one; otherwise refuses. */
bool bqsim_afe_present(bqsim_call *c);

#endif
