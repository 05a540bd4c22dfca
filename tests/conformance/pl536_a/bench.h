/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file bench.h
 * A bqsim session under test, and packets built the way the requirements describe them. The CRC here is
 * written from PL-CRC-01, bit by bit, independent of the simulator's and of the driver's.
 */
#ifndef BENCH_H
#define BENCH_H

#include "bqsim.h"
#include "unity.h"
#include <string.h>

#define ALL 0x3f /* broadcast address */

/** A new session with a stack of n devices, ideal or with options. */
void bench_stack(int n);
void bench_stack_with(int n, const sim_pl_options *options);
/** The stack's C doors. */
sim_pl *bench_pl(void);
sim_bus_fault *bench_fault(void);

/** Executes a line and demands this reply. */
void bench_expect(const char *line, const char *reply, int at);
#define expect(line, reply) bench_expect((line), (reply), __LINE__)

uint8_t bench_crc(const uint8_t *bytes, size_t n);

/** Gives devices 1..n the addresses 1..n, from the base upward. */
void bench_address(int n);
/** Addresses 1..n, limits 4.25 V and 2.8 V with 500 ms delay, every flag of the reset cleared: a stack
 * without fault and alert. */
void bench_quiet(int n);

/** A write packet with its CRC; demands that no byte is driven. */
void bench_write(int address, int reg, int data);
/** The key and a group-3 write. */
void bench_shadow(int address, int reg, int data);
/** A read packet; demands undriven header bytes, n driven data bytes and the right CRC. */
void bench_read_block(int address, int reg, int n, uint8_t *data);
int bench_read(int address, int reg);
/** True when nobody drives a byte of a one-byte read. */
bool bench_silent(int address);
/** Sends raw bytes; false when a device drove any byte. */
bool bench_send(const uint8_t *bytes, size_t n);

int bench_peek(int device, int reg);
/** Every register of a device, without side effects. */
void bench_dump(int device, uint8_t out[256]);
void bench_advance_us(uint32_t us);
/** Broadcast conversion start with ADC_CONTROL = 0x3d (9 channels, automatic), and the time it needs. */
void bench_convert(void);

/** Entries in the judge's book. */
uint32_t bench_misuses(void);
/** Demands an empty book. */
void bench_no_misuse_at(int at);
#define expect_no_misuse() bench_no_misuse_at(__LINE__)
/** Demands that the book holds an entry of one of the IDs (separated by blanks) for this device (-1 = any),
 * then clears it. */
void bench_misuse_at(const char *ids, int device, int at);
#define expect_misuse(ids, device) bench_misuse_at((ids), (device), __LINE__)

#endif
