/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file monitor_template.h
 * An empty driver for another family of monitors: copy this folder, rename `template`, fill the places marked
 * FILL IN, move this header to include/bqhost/. It compiles as it stands, is a complete bq_afe, measures
 * nothing, and says so: bring-up ends with BQ_E_UNSUPPORTED, there is never a picture, and so no pack
 * controller above it ever switches an output on.
 *
 * Nothing blocks: "begin" starts a job, poll advances it. The instance is the caller's; there is no other
 * state. docs/porting.md says in which order to fill it in.
 */
#ifndef MONITOR_TEMPLATE_H
#define MONITOR_TEMPLATE_H

#include "bqhost/afe.h"
#include "bqhost/hal.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What the user wants, in physical units; validated whole by init. FILL IN: limits, delays, sensors. */
typedef struct monitor_template_config {
    uint8_t cells; /**< cells in series, 1..MONITOR_TEMPLATE_CELLS */
} monitor_template_config;

#define MONITOR_TEMPLATE_CELLS 16u

typedef struct monitor_template_frame {
    uint16_t pc; /* where the job goes on; see bqhost/seq.h */
} monitor_template_frame;

/** One monitor. Caller-owned; members are private. */
typedef struct monitor_template {
    monitor_template_config config;
    bq_i2c i2c; /* or a bq_spi */
    bq_gpio gpio;
    bq_clock clock;
    uint8_t job;  /* which one runs; 0 = none */
    bool started; /* bring-up has succeeded and no sleep came after it */
    bool waiting;
    bool measured;  /* there has been a picture */
    bq_status last; /* how the last job ended */
    uint32_t wait_from_us, wait_us;
    monitor_template_frame frame;
    bq_link_stats stats;
} monitor_template;

/**
 * Checks the whole configuration, then sets up the instance. Touches no bus. `gpio` may be NULL. What the
 * pointers point to is copied; their `ctx` must outlive the instance.
 * BQ_OK; BQ_E_ARG (null pointer, missing function); BQ_E_CELLS. Nothing is changed after an error.
 */
bq_status monitor_template_init(monitor_template *t, const monitor_template_config *config, const bq_i2c *i2c,
                                const bq_gpio *gpio, const bq_clock *clock);

/** Fills the interface the super-loop uses. `t` must outlive it. */
bq_afe monitor_template_afe(monitor_template *t);

#ifdef __cplusplus
}
#endif
#endif
