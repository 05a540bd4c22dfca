/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file bq769x0_state.h
 * The instance of the bq769x0 driver, complete so that a caller can own it. Included by bq769x0.h; include
 * that file instead. All members are private to the driver: read them through its functions.
 */
#ifndef BQHOST_BQ769X0_STATE_H
#define BQHOST_BQ769X0_STATE_H

#define BQ769X0_INPUTS 15u
#define BQ769X0_FRAMES 7u
#define BQ769X0_BUFFER 82u /* address, register, 40 registers with CRC */

struct bq769x0;
struct bq769x0_frame;
/* A job: goes on where its frame says; > 0 = what it waits for and where to go on then, else how it ended. */
typedef int (*bq769x0_job)(struct bq769x0 *d, struct bq769x0_frame *f);

typedef struct bq769x0_frame {
    bq769x0_job job;
    int next;            /* what it returned last */
    int op;              /* of a transfer: what travels next */
    uint32_t word;       /* its variables: this ... */
    uint8_t tries, i, x; /* ... and these */
    uint8_t at;          /* where it goes on; 0 = its beginning */
} bq769x0_frame;

/* What is far from the beginning of the instance is reached through a pointer of its own. */

/* The faults that are held. */
typedef struct bq769x0_trouble {
    uint32_t held_ms;  /* since when the release condition holds, or when the probation began */
    uint32_t event_ms; /* when the last fault bit appeared, or when it was released */
    uint32_t load_ms;
    uint8_t loads;      /* LOAD_PRESENT = 0 in a row */
    uint8_t strikes;    /* overcurrents in a row */
    uint8_t breakdowns; /* internal faults in a row */
    bool probation;     /* fault bits were cleared and must stay clear for a while */
    bool locked;        /* too many short circuits */
    bool again;         /* the present fault came back */
    bool released;      /* event_ms is the time of a release */
} bq769x0_trouble;

/* Pictures that do not come, a converter that stands. */
typedef struct bq769x0_watch {
    uint32_t good_ms;        /* of the last good picture */
    uint32_t same_ms, print; /* print of the last picture */
    uint16_t same;           /* identical pictures in a row */
    bool fresh_boot;         /* booted by this driver: temperatures come with the first scan */
} bq769x0_watch;

typedef struct bq769x0_die {
    uint32_t ms, hold_ms; /* hold_ms: since when temperatures are held */
    int16_t dc;           /* of the hottest sensor */
    bool fault;           /* near the end of its range */
    bool known;           /* dc is a temperature */
    bool looked;          /* ms is the time of a look at the die */
    uint8_t phase;
} bq769x0_die;

typedef struct bq769x0_counting {
    bq769x0_charge charge;
    uint32_t ms;  /* windows are counted up to here */
    int32_t code; /* result counted last */
} bq769x0_counting;

/* In this order because on ARMv6-M only the first 32 bytes (64 of half-words, 128 of words) are one
 * instruction away, and what lies beyond 256 costs most. Not to be copied or moved once set up. */
typedef struct bq769x0 {
    uint8_t state;
    uint8_t quality;           /* of the picture: BQ_Q_VALID, or why it does not count */
    uint8_t temp_quality;      /* of its temperatures */
    bool temp_settled;         /* temperatures are of the source selected now */
    bool temp_held;            /* ... and stay as they are: the source is another one for a while */
    bool no_data;              /* the measurement registers do not count yet */
    bool current_seen;         /* there was a result of the coulomb counter */
    bool suspect;              /* the configuration is to be looked at: the bus was disturbed */
    uint8_t stat;              /* SYS_STAT as read last */
    uint8_t held;              /* SYS_STAT bits that are not released yet */
    uint8_t answer;            /* first register of the last read */
    bool die_hot;              /* no balancing: the die is too hot */
    bq769x0_known known;       /* .registers: as they should be; [0] = bits to clear */
    uint16_t balance;          /* cells whose switch is commanded */
    uint16_t balanced;         /* ... during the last picture */
    struct bq769x0_frame *top; /* frame of the job that runs */
    int32_t transfer;          /* bq_status of the transfer under way, or that ended last */
    int32_t result;            /* bq_status of the job that ended last */
    uint32_t now_us, now_ms;
    uint32_t whole_us; /* clock at the beginning of now_ms */
    uint32_t due_us;   /* end of a wait, or when a transfer should have ended */
    uint32_t cc_ms, temp_ms;
    int32_t cc_code;
    uint32_t scale;     /* of a cell: mV of a code in units of 1/2^18 */
    int32_t scale_zero; /* ... and of code 0, with half a mV for rounding */
    uint32_t trim;
    uint32_t picture_ms;
    bq_i2c i2c;
    bq_clock clock;
    /* beyond the base set, and beyond 128 bytes */
    uint32_t data_ms; /* from when on the measurement registers count */
    uint32_t scrub_ms, served_ms, sequence;
    uint16_t faults;    /* BQ_F_... of the picture */
    uint16_t asked;     /* cells the caller wants bled */
    uint16_t gain2_q15; /* GAIN2 in units of 1/32768 */
    bool measured;      /* there was a picture */
    bq769x0_trouble trouble;
    bq769x0_watch watch;
    bq769x0_die die;
    bq_link_stats stats;
    uint8_t
        bus[BQ769X0_BUFFER]; /* as it travels: address, register, data; after a read the data without CRC */
    /* beyond 256 bytes */
    bq769x0_config config;
    bq_gpio gpio;
    bq_i2c_segment segments[2];
    uint16_t code[18];  /* of the last good picture: cells from the lowest on, behind them TS1..TS3 */
    uint16_t fresh[20]; /* as read: 15 inputs, BAT, TS1..TS3, coulomb counter */
    bq769x0_frame frames[BQ769X0_FRAMES + 1u];
    bq769x0_counting counting;
    bq769x0_achieved achieved;
    uint16_t calibrated_mv[BQ769X0_INPUTS]; /* cells at the last calibration */
} bq769x0;

#endif
