/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file bench.h
 * The real driver against the simulated stack, with every packet recorded. The back-end is the bench's own:
 * it can refuse a transfer, lose a packet by its number, lack lines, and start its clock just before it
 * wraps.
 */
#ifndef BENCH_H
#define BENCH_H

#include "bqhost/bq76pl536.h"
#include "sim_bus_fault.h"
#include "sim_pl536.h"
#include "unity.h"
#include <string.h>

#define BENCH_LOG 60000

typedef struct bench_packet {
    uint64_t t_us;
    uint8_t n, tx[24], rx[24];
} bench_packet;

typedef struct bench {
    sim_pl pl;
    bq76pl536_config config;
    bq76pl536 driver;
    bq76pl536_device devices[BQ76PL536_MAX_DEVICES];
    bq_afe afe;
    bq_sample sample;
    bq_cell_reading cells[6 * BQ76PL536_MAX_DEVICES];
    bq_temp_reading temps[2 * BQ76PL536_MAX_DEVICES];
    bq_module_reading modules[BQ76PL536_MAX_DEVICES];
    bench_packet log[BENCH_LOG]; /**< the first packets since bench_mark() */
    uint32_t packets;            /**< since bench_mark() */
    uint32_t transfers;          /**< since bench_mark(), refused ones included */
    uint64_t bytes;              /**< since bench_mark() */
    uint32_t clock_offset_us;
    uint32_t hz;
    uint32_t lose;   /**< number (1 = first since bench_mark()) of the packet that never arrives; 0 = none */
    uint32_t refuse; /**< number of the transfer that the back-end refuses; 0 = none */
    uint32_t fail_after; /**< number of the transfer that arrives but is reported as failed; 0 = none */
    bool eager;          /**< polls every microsecond whatever the driver hints */
    bool no_lines;       /**< the board has no line at all */
    bool stuck_fault, stuck_alert, stuck_drdy; /**< reads high whatever the chips do */
    uint32_t conv_edges;                       /**< rising edges of CONV */
    bool vpp_fails;
    int vpp_device; /**< device whose LDOD pins BQ_LINE_VPP feeds */
    uint64_t vpp_since_us, vpp_longest_us;
    uint32_t under_vpp; /**< packets other than E_EN while the 7 V stood */
} bench;

extern bench b;

/** A fresh stack of `devices` and the usual configuration; nothing is on the bus yet. */
void bench_up(int devices, const sim_pl_options *options);
/** Sets the driver up from b.config; fails the test if that is refused. */
void bench_init(void);
/** Polls the running job to its end. */
bq_status bench_run(bq_status begun);
bq_status bench_start(void);
bq_status bench_scan(void);
bq_status bench_sleep(void);
bq_status bench_wake(void);
bq_status bench_self_test(void);
bq_status bench_apply(const bq_action *action);
/** apply() with these cells of device `device` on (mask) and everything else off. */
bq_status bench_balance(int device, unsigned mask);
bq_status bench_acknowledge(void);
/** Takes the picture; fails the test if there is none. */
const bq_sample *bench_sample(void);
/** Up, initialised, started, scanned once: fails the test unless all is well. */
void bench_ready(int devices, const sim_pl_options *options);
void bench_ready_from(void); /**< the same from b.config and the stack as they are */
void bench_wait_ms(uint32_t ms);
/** Power off and on of every device: EPROM changes take effect. */
void bench_power_cycle(void);
void bench_mark(void); /**< begins a new record */

uint8_t bench_crc(const uint8_t *data, size_t n);
/** A packet of the test itself, not recorded. */
void bench_raw_write(int device, int reg, int value);

/** First recorded packet from `from` on with this first byte and register (-1 = any); -1 when there is none.
 */
int bench_find(int from, int first_byte, int reg);
int bench_count(int first_byte, int reg);
#define IS_READ(p) (((p)->tx[0] & 1) == 0)
#define IS_WRITE(p) (((p)->tx[0] & 1) != 0)
#define BROADCAST 0x7f
#define W(device) ((device) << 1 | 1)
#define RD(device) ((device) << 1)

/** Every recorded packet is one a driver may send; see bench_judge.c. */
void bench_judge_packets(void);
void bench_no_misuse(void);
const char *bench_text(const char *format, ...) __attribute__((format(printf, 1, 2)));

#define EXPECT_STATUS(expected, actual)                                                                      \
    do {                                                                                                     \
        bq_status status_ = (actual);                                                                        \
        TEST_ASSERT_EQUAL_INT_MESSAGE((expected), status_, bq_status_name(status_));                         \
    } while (0)
#define PEEK(device, reg) sim_pl_peek(&b.pl, (device), (reg))
#define CELL(device, cell) (&b.sample.cells[((device)-1) * 6 + (cell)-1])
#define MODULE(device) (&b.sample.modules[(device)-1])

#endif
