/* SPDX-License-Identifier: Apache-2.0 */
/* What the tests of the bq76PL536 model share: one stack and a host that sends well-formed packets. */
#ifndef SIM_BENCH_H
#define SIM_BENCH_H

#include "sim_pl536.h"
#include "unity.h"

extern sim_pl s;
extern uint8_t rx[64], driven[64];

/** Sends a packet given as lower-case hex digits without blanks. */
void spi(const char *hex);
/** Writes a register, with CRC. */
void put(unsigned address, unsigned reg, unsigned value);
/** The same with the key in front. */
void key_put(unsigned address, unsigned reg, unsigned value);
/** Reads one register; -1 when the answer does not fit the request. */
int get(unsigned address, unsigned reg);
/** A register without the bus. */
int peek(int device, unsigned reg);
/** Exactly one misuse, with this ID, since the last look; the book is cleared. */
void expect_one_misuse(const char *id);
void expect_misuse(const char *id, const char *hex);
void expect_put_misuse(const char *id, unsigned address, unsigned reg, unsigned value);

#endif
