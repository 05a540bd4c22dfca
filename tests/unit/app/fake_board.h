/* SPDX-License-Identifier: Apache-2.0 */
/* A board for the super-loop: a monitor whose jobs take, fail or hang as told, a contactor with feedback, an
 * ammeter, a clock. */
#ifndef FAKE_BOARD_H
#define FAKE_BOARD_H

#include "bqhost/app.h"

#define FAKE_CELLS 6
#define FAKE_SENSORS 1
#define FAKE_JOBS 7 /* indexed by bq_app_job */
#define FAKE_HANG UINT32_MAX

typedef struct fake_job {
    uint32_t takes_us;  /* FAKE_HANG = never ends */
    bq_status begin;    /* what beginning returns; BQ_OK begins */
    bq_status end;      /* how it ends */
    uint32_t fail_next; /* that many further jobs end with fail_status instead */
    bq_status fail_status;
    uint32_t begun;    /* successfully */
    uint32_t begun_us; /* clock of the last */
} fake_job;

typedef struct fake_board {
    bq_app app;
    bq_cell_reading cells[FAKE_CELLS];
    bq_temp_reading temps[FAKE_SENSORS];
    bq_module_reading modules[1];
    uint32_t us;        /* the clock */
    uint64_t passed_us; /* since fake_init */
    fake_job job[FAKE_JOBS];
    int running; /* bq_app_job */
    uint32_t ends_us;
    /* the monitor's picture */
    uint16_t mv[FAKE_CELLS];
    int16_t dc;
    uint16_t faults;
    uint32_t sequence, conversion_us;
    bq_status sample_status; /* BQ_OK = copy */
    bq_action applied;
    /* lines */
    bool closed;         /* level of the contactor line */
    bool has_path, path; /* precharge: is there one, and its level */
    bq_status path_status;
    bool has_feedback, welded, stuck_open;
    uint32_t feedback_us; /* delay of the feedback contact */
    uint32_t moved_us;
    bq_status line_status, feedback_status;
    uint32_t writes;
    bool has_contactor;
    bool has_request, request; /* the request line */
    bq_status request_status;
    bq_link_stats link; /* NULL is told without `has_link` */
    bool has_link;
    /* ammeter */
    int32_t ma;
    bq_status ammeter_status;
    /* order of things: s scan, m sample, a apply, t self-test, b bring-up, z sleep, w wake, 0 open, 1 closed,
     * p precharge on, P off */
    char order[64];
    unsigned orders;
    uint64_t opened_us; /* passed_us at the last falling edge of the contactor line */
} fake_board;

bq_app_config fake_config(void);
/* Healthy: every job takes 3 ms and ends well; 3700 mV, 25 C; feedback after 20 ms. The clock begins at `us`.
 */
void fake_init(fake_board *f, uint32_t us);
/* bq_app_init with everything of the board; `ammeter` false = none. */
bq_status fake_start(fake_board *f, const bq_app_config *c, bool ammeter);
/* Its parts, for a loop elsewhere. */
bq_afe fake_afe(fake_board *f);
bq_gpio fake_gpio(fake_board *f);
bq_clock fake_clock(fake_board *f);
/* Runs the loop for `ms`, each pass when its hint says (10 us after 0). */
void fake_run(fake_board *f, uint32_t ms);
/* Started, on. */
void fake_on(fake_board *f);
bq_pack_state_id fake_state(const fake_board *f);
int fake_active(const fake_board *f, bq_pack_fault fault);

#endif
