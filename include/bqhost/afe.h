/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file afe.h
 * What the pack controller's super-loop needs of a monitor family. Each driver offers a constructor that
 * fills a bq_afe (bq76pl536_afe(), bq769x0_afe()); the loop does not know which chips are behind it.
 *
 * Nothing here blocks. start, scan, apply, self_test, sleep and wake begin one job and return at once; poll
 * advances it. One job runs at a time: beginning another returns BQ_E_BUSY and changes nothing.
 */
#ifndef BQHOST_AFE_H
#define BQHOST_AFE_H

#include "bqhost/sample.h"
#include "bqhost/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Link statistics, counted since init, saturating. */
typedef struct bq_link_stats {
    uint32_t packets;      /**< bus transfers started */
    uint32_t bytes;        /**< bytes of these transfers, address and CRC bytes included (wraps) */
    uint32_t scans;        /**< updates completed with every module fresh */
    uint32_t retries;      /**< transfers repeated after any error */
    uint32_t crc_errors;   /**< damaged answers */
    uint32_t no_answers;   /**< SPI: answers of only 00 or ff; I2C: address or byte not acknowledged */
    uint32_t implausible;  /**< answers with a right CRC and impossible content */
    uint32_t bus_errors;   /**< transfers the back-end reported as failed */
    uint32_t write_errors; /**< writes that failed, did not read back, or that a chip flagged as damaged */
    uint32_t recoveries;   /**< modules found lost and configured again */
} bq_link_stats;

typedef struct bq_afe_ops {
    /** Begins bring-up from an unknown state: discovery or boot, configuration, the first checks. Afterwards
     * balancing is off, and so are the FETs of families that have them unless their configuration says
     * otherwise; after a failure both. Legal in every state (it is the answer to a failed job too). BQ_OK or
     * BQ_E_BUSY. */
    bq_status (*start)(void *ctx);
    /** Begins one update: convert and read everything, service chip faults, relocate lost modules.
     *  Balancing outputs are paused and settled inside; the bq769x0 opens them by itself to measure. What was
     * bled is in bq_module_reading.balancing. BQ_OK, BQ_E_BUSY, or BQ_E_STATE (not started, asleep). */
    bq_status (*scan)(void *ctx);
    /** Advances the running job. BQ_PENDING: call again after `*wait_us` (0 = as soon as possible; a hint,
     * calling earlier is harmless). BQ_OK: idle, the last job succeeded, or there was none. Negative: idle,
     * the last job failed with this status; asked again it says the same. `wait_us` may be NULL. Each call
     * does a bounded amount of work (at most one bus transfer started). */
    bq_status (*poll)(void *ctx, uint32_t *wait_us);
    /** Copies the present picture. Ages are computed at the time of the call. Current fields are filled only
     * by families that measure current. BQ_OK; BQ_E_ARG if a capacity is too small (nothing written);
     * BQ_E_STALE before the first update; BQ_E_BUSY while a scan is exchanging the picture (nothing written:
     * never half new). */
    bq_status (*sample)(void *ctx, bq_sample *sample);
    /** Begins to carry out an action, verified by read-back: balancing outputs; FETs of families that have
     * them; clear_faults where the chip leaves that to the caller (bq76PL536; the bq769x0 driver releases
     * faults by its own rules). A driver may do less than asked where its own rules forbid it, never more; a
     * path that was asked to conduct and had to stay open ends the job with BQ_E_STATE, while the sample
     * names the reason. bq_action.sleep is not for it. `action` is copied. BQ_OK, BQ_E_BUSY, BQ_E_STATE,
     * BQ_E_ARG (NULL). */
    bq_status (*apply)(void *ctx, const bq_action *action);
    /** Begins the self-test of chips and chains. BQ_OK, BQ_E_BUSY, BQ_E_STATE. */
    bq_status (*self_test)(void *ctx);
    /** Begins sleep entry, verified; afterwards only wake and start are legal. Cells are neither measured nor
     * protected then. For the bq769x0 this is SHIP: it forgets its configuration, and a host that it supplies
     * loses its supply. BQ_OK, BQ_E_BUSY, BQ_E_STATE. */
    bq_status (*sleep)(void *ctx);
    /** Begins sleep exit up to valid configuration; in families that forget everything in sleep the same as
     * start. BQ_OK, BQ_E_BUSY, BQ_E_STATE. */
    bq_status (*wake)(void *ctx);
    /** Number of modules found (0 before discovery), link statistics. Never fail. Either may be NULL: not
     * kept. */
    uint8_t (*modules_found)(void *ctx);
    const bq_link_stats *(*stats)(void *ctx);
} bq_afe_ops;

typedef struct bq_afe {
    const bq_afe_ops *ops;
    void *ctx;
} bq_afe;

#ifdef __cplusplus
}
#endif
#endif
