/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file bq76pl536_state.h
 * The instance of the bq76PL536 driver, complete so that a caller can own it. Included by bq76pl536.h after
 * bq76pl536_config; include that file instead. All members are private to the driver: read them through its
 * functions.
 */
#ifndef BQHOST_BQ76PL536_STATE_H
#define BQHOST_BQ76PL536_STATE_H

/** What the driver keeps of one device; the caller owns an array of them. Readings first, then bookkeeping.
 */
typedef struct bq76pl536_device {
    uint32_t t_ms;     /* conversion start the readings come from, instance time */
    uint32_t ready_ms; /* conversions started before this do not count (supply and sensors still settle) */
    uint16_t cell_mv[BQ76PL536_MAX_CELLS];
    uint16_t gpai_mv; /* brick voltage, or GPAI pins when they are selected */
    int16_t temp_dc[2];
    uint16_t faults; /* BQ_F_... */
    uint16_t flags;  /* PL_DEV_... of the driver's internal header */
    uint8_t cell_quality[BQ76PL536_MAX_CELLS];
    uint8_t temp_quality[2];
    uint8_t gpai_quality;
    uint8_t status, alert, fault, cov, cuv; /* as read last */
    uint8_t cb_want, cb_on, cb_seen;        /* masks: wanted, written, on until the last measurement */
    uint8_t open_wire, wire_count;          /* named sense wires, consecutive cycles with a suspicion */
    uint8_t signature, same;                /* of the last burst, how often it repeated */
    uint8_t resets;                         /* resets tried against a chip fault since start */
} bq76pl536_device;

/** One job of the sequencer waiting for its child or its packet. */
typedef struct bq76pl536_frame {
    uint16_t pc;            /* where the job goes on */
    uint8_t job;            /* which job */
    uint8_t dev, reg, val;  /* its arguments */
    uint8_t n, i, tries, x; /* its variables */
} bq76pl536_frame;

#define BQ76PL536_FRAMES 14u
#define BQ76PL536_BUFFER 24u

typedef struct bq76pl536 {
    bq76pl536_config config;
    bq_spi spi;
    bq_gpio gpio;
    bq_clock clock;
    bq76pl536_device *devices;
    bq_link_stats stats;
    bq76pl536_diagnosis diagnosis;
    bq76pl536_frame frames[BQ76PL536_FRAMES];
    uint8_t tx[BQ76PL536_BUFFER], rx[BQ76PL536_BUFFER];
    uint8_t length;      /* of the packet under way */
    uint8_t data;        /* where the data of the last read begins in rx */
    uint8_t depth;       /* frames in use */
    uint8_t io;          /* nothing, transfer or wait under way */
    uint8_t state;       /* PL_STATE_... */
    uint8_t found;       /* devices 1..found answer */
    uint8_t scrub_next;  /* device whose configuration is read back next */
    bool active;         /* outputs may be on: a job must switch them off before it measures */
    uint8_t unexplained; /* scans in a row with a line high that no device explains */
    uint8_t probes;      /* looks in vain since the last device was lost */
    uint8_t attempt;     /* of address discovery */
    uint8_t failed_at;   /* device at which the last discovery pass ended */
    uint8_t
        height; /* where the stack ends by the last discovery: nothing above is touched until the next one */
    bool crc;   /* present framing */
    bool started;       /* bring-up was begun in this life */
    bool sent;          /* this poll started its packet */
    bool reading;       /* the picture is being renewed */
    bool clear_faults;  /* apply: chip flags are acknowledged */
    bool gpai_pins;     /* GPAI pins instead of the brick voltage */
    bool user_readonly; /* USER1..USER4 do not keep what is written */
    bq_status result;   /* of the child that ended last */
    bq_status transfer; /* of the last packet */
    bq_status last;     /* of the last job of the caller */
    uint16_t diff;      /* registers of group 3 that differ */
    uint32_t spi_hz;
    uint32_t now_us, now_ms, rest_us; /* clock as read last; milliseconds since init */
    uint32_t wait_from_us, wait_us;
    uint32_t start_us;                             /* clock at the conversion start of the picture */
    uint32_t convert_us;                           /* clock at the last conversion start */
    uint32_t start_ms;                             /* the same in instance time */
    uint32_t power_ms;                             /* when bring-up began */
    uint32_t cb_ms;                                /* when the outputs were last switched on */
    uint32_t scrub_ms, probe_ms, tsd_ms, clear_ms; /* when these were last done */
    uint32_t sequence;
    const uint8_t *image; /* EPROM image being programmed, else NULL */
} bq76pl536;

#endif
