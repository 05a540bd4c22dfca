/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file bench.h
 * A bq769x0 driver on a simulated part, with a back-end that keeps a log of every transaction and can spoil
 * any of them. One transaction takes its bus time at 100 kHz.
 */
#ifndef BENCH_H
#define BENCH_H

#include "bqhost/bq769x0.h"
#include "bqhost/bq769x0_regs.h"
#include "bqhost/thermistor.h"
#include "sim_x0.h"
#include "unity.h"
#include <string.h>

#define MS 1000000ull
#define LOG_MAX 8192
#define LOG_DATA 16

typedef enum spoil {
    SPOIL_NONE,
    SPOIL_LOST,       /* not carried out, ends with BQ_E_BUS */
    SPOIL_NACK,       /* not carried out, ends with BQ_E_NACK */
    SPOIL_TIMEOUT,    /* not carried out, ends with BQ_E_TIMEOUT */
    SPOIL_REFUSED,    /* start answers BQ_E_ARBITRATION */
    SPOIL_BUSY,       /* start answers BQ_E_BUSY */
    SPOIL_UNHEARD,    /* carried out, but reported as BQ_E_BUS */
    SPOIL_LATE,       /* carried out, 8 ms late */
    SPOIL_FLIP,       /* one bit is wrong on the wire */
    SPOIL_FIRST_HALF, /* only the first byte after the address was sent; BQ_E_NACK */
    SPOIL_BROWNOUT,   /* the part loses its supply for an instant before it: SHIP */
    SPOIL_KINDS
} spoil;

typedef struct bench_entry {
    uint64_t t_ns;                      /* when it began */
    uint8_t address7, reg, wrote, read; /* wrote, read: data registers, CRC not counted */
    uint8_t data[LOG_DATA];             /* written data, CRC not counted */
    uint8_t raw;                        /* bytes on the bus, address bytes included */
    bool restart;                       /* read after a repeated START */
    bool crc_good;                      /* write: every CRC byte is there and right, for a part with CRC */
    bq_status status;
} bench_entry;

typedef struct bench {
    sim_x0 chip;
    bq769x0 d;
    bq769x0_config cfg;
    uint32_t clock_offset;
    uint32_t missing;  /* lines the board does not have */
    bool never_free;   /* start always answers BQ_E_ARBITRATION, recover does not help */
    bool no_power;     /* nobody acknowledges */
    bool no_restart;   /* a controller that cannot repeat a START: STOP and START instead (Fig. 7-6) */
    uint64_t spoil_at; /* number of the transaction, counted from 1; 0 = none */
    spoil spoil_kind;
    uint32_t spoil_count; /* so many in a row, 0 counts as 1 */
    bool spoil_writes;    /* spoil_at is the number of the write to spoil_reg instead */
    uint8_t spoil_reg;
    uint64_t spoil_seen;
    int flip_bit;
    uint64_t count;
    uint32_t overlaps, recoveries, rises, falls;
    uint64_t rise_ns, fall_ns;
    bool boot_level, busy;
    bq_status outcome;
    uint64_t ready_ns;
    uint32_t stuck_pending;        /* polls that never end */
    void (*hook)(struct bench *b); /* before each transaction */
    bench_entry log[LOG_MAX];
    char wire[1 << 16]; /* bytes since wire_used was set to 0, in the notation of the rows */
    size_t wire_used;
    /* picture */
    bq_cell_reading cells[16];
    bq_temp_reading temps[4];
    bq_module_reading module;
    bq_sample sample;
    bq_action action;
} bench;

extern bench b;

/** A part in SHIP, all cells at 3.6 V, and a configuration for it (not yet given to the driver). */
void bench_part(const char *name, const sim_x0_options *options);
/** bq769x0_init() with b.cfg; inputs not in use are shorted. */
bq_status bench_init(void);
/** The back-end that bench_init() gives to the driver, and what the driver counts. */
bq_i2c bench_i2c(void);
bq_clock bench_clock(void);
const bq_link_stats *bench_stats(void);
/** Polls until the job ends; fails the test when it takes more than `ms`. */
bq_status bench_run(uint32_t ms);
bq_status bench_start(void);
/** bench_part + init + start, all must succeed. */
void bench_up(const char *name);
/** One scan, then the picture; the scan's status. */
bq_status bench_scan(void);
bq_status bench_apply(bool charge, bool discharge, uint32_t balance);
/** Scan and apply b.action every `period` ms until `ms` have passed. */
void bench_serve(uint32_t ms, uint32_t period);
/** Scan and apply until CHG and DSG pins are as wanted; ms passed, or `limit` when they never are. */
uint32_t bench_until(bool chg, bool dsg, uint32_t limit);
/** Scan and apply every `period` ms, at least once, until both pins are on; ms passed, `limit` when never. */
uint32_t bench_until_on(uint32_t limit, uint32_t period);
void bench_wait(double ms);
bq_status bench_picture(void);
uint64_t bench_now_ms(void);
/** Entries of the log since `from` that write `reg` alone or inside a block; the value of the last in
 * `*value`. */
unsigned bench_writes(uint64_t from, uint8_t reg, uint8_t *value);
/** The entry with this number, counted from 0. */
const bench_entry *bench_log(uint64_t n);
void bench_cells(double volts); /* every input in use */
uint32_t bench_random(uint32_t below);
void bench_no_misuse(int line);
#define NO_MISUSE() bench_no_misuse(__LINE__)

#endif
