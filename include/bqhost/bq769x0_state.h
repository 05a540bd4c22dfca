/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file bq769x0_state.h
 * The instance of the bq769x0 driver, complete so that a caller can own it. Included by bq769x0.h; include
 * that file instead. All members are private to the driver: read them through its functions.
 */
#ifndef BQHOST_BQ769X0_STATE_H
#define BQHOST_BQ769X0_STATE_H

#define BQ769X0_INPUTS 15u
#define BQ769X0_FRAMES 8u
#define BQ769X0_BUFFER 84u /* 40 registers with CRC, and the header of a write */

typedef struct bq769x0_frame {
    uint16_t pc;         /* where the job goes on */
    uint8_t job;         /* which job */
    uint8_t reg, n;      /* its arguments */
    uint8_t tries, i, x; /* its variables */
} bq769x0_frame;

/* Small members first: on ARMv6-M only the first 32 bytes (64 of half-words, 128 of words) are one
 * instruction away. */
typedef struct bq769x0 {
    uint8_t depth, io, state;
    bool reading;             /* direction of the transfer under way */
    bool sent;                /* this poll started its transfer */
    bool valid;               /* the picture counts */
    bool measured;            /* there was a picture */
    bool temp_valid;          /* the temperatures count */
    bool fresh_boot;          /* booted by this driver: temperatures come with the first scan */
    bool probation;           /* fault bits were cleared and must stay clear for a while */
    bool locked;              /* too many short circuits */
    uint8_t stat;             /* SYS_STAT as read last */
    uint8_t shadow1, shadow2; /* SYS_CTRL1, SYS_CTRL2 as they should be */
    uint8_t want_fets;        /* what the caller asked for */
    uint8_t held;             /* SYS_STAT bits that are not released yet */
    uint8_t loads;            /* LOAD_PRESENT = 0 in a row */
    uint8_t strikes;          /* fault events in a row */
    bool again;               /* the present fault came back */
    bool released;            /* event_ms is the time of a release */
    uint8_t pointer;          /* register byte of a read */
    uint16_t in_use;          /* inputs that carry cells */
    uint16_t want_balance;    /* inputs the caller wants bled */
    uint16_t balance;         /* inputs whose switch is commanded */
    uint16_t balanced;        /* ... during the last picture */
    uint16_t faults;          /* BQ_F_... of the picture */
    uint16_t same;            /* identical pictures in a row */
    uint16_t bat_code;
    int16_t cc_code;
    uint16_t gain2_q15; /* GAIN2 in units of 1/32768 */
    bq_status result, transfer, last;
    uint32_t now_us, now_ms, rest_us, wait_from_us, wait_us;
    uint32_t held_ms;  /* since when the release condition holds, or when the probation began */
    uint32_t event_ms; /* when the last fault bit appeared, or when it was released */
    uint32_t picture_ms, picture_us, scrub_ms, served_ms, cc_ms, temp_ms, load_ms, same_ms;
    uint32_t data_ms; /* from when on the measurement registers count */
    uint32_t sequence;
    uint8_t data[40];              /* registers read last, or to be written */
    uint16_t code[BQ769X0_INPUTS]; /* of the inputs */
    uint16_t ts_code[3];
    bq769x0_frame frames[BQ769X0_FRAMES];
    bq_i2c_segment segments[2];
    uint8_t bus[BQ769X0_BUFFER]; /* as it travels, CRC bytes included */
    bq769x0_achieved achieved;
    bq769x0_config config;
    bq_i2c i2c;
    bq_gpio gpio;
    bq_clock clock;
    bq_link_stats stats;
    bq769x0_charge charge;
    uint16_t calibrated_mv[BQ769X0_INPUTS]; /* cells at the last calibration */
} bq769x0;

#endif
