/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file bqsim.h
 * The interpreter of bqsim's command language (docs/bqsim.md) without any input or output of its own: one
 * call executes one line and leaves one reply. The program bqsim and the conformance tests are both thin
 * users of it.
 */
#ifndef BQSIM_H
#define BQSIM_H

#include "sim_bus_fault.h"
#include "sim_pl536.h"
#include "sim_vcd.h"
#include "sim_x0.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define BQSIM_LINE_MAX 131072u                  /**< characters of a line, without its end */
#define BQSIM_REPLY_MAX (BQSIM_LINE_MAX + 128u) /**< a buffer of this size holds every reply */
#define BQSIM_PACKET_MAX (BQSIM_LINE_MAX / 3u)  /**< bytes of one spi command */
#define BQSIM_FLIPS 64                          /**< bits that can be armed for one packet and direction */

typedef enum bqsim_result {
    BQSIM_SILENT, /**< blank line or comment: there is no reply */
    BQSIM_OK,     /**< accepted; reply is `ok ...` */
    BQSIM_QUIT,   /**< accepted `quit`; reply is `ok` */
    BQSIM_ERR     /**< refused, nothing changed; reply is `err REASON` */
} bqsim_result;

/** Bits armed by `inject` for the next packet, one list per direction. */
typedef struct bqsim_flips {
    int count;
    uint32_t bit[BQSIM_FLIPS];
} bqsim_flips;

/**
 * One session: caller-owned, no other state anywhere. Tests may set `options` before the command `stack`
 * (`afe_options` before `afe`) and reach the models' other doors through `stack` and `afe`; everything else is private to the interpreter.
 */
typedef struct bqsim_session {
    sim_pl_options options; /**< readings and imperfections of the next `stack`; all zero = ideal */
    bool has_stack;
    sim_pl stack;
    sim_x0_options afe_options; /**< the same for the next `afe` */
    bool has_afe;
    sim_x0 afe;
    uint64_t now_ns; /**< simulated time since the session began */
    sim_vcd *vcd;    /**< NULL = no waveform */
    bool vbat_is_sum[SIM_PL_MAX_DEVICES + 1];
    bool gpio_level[SIM_PL_MAX_DEVICES + 1];
    bqsim_flips mosi, miso;
    uint8_t tx[BQSIM_PACKET_MAX], rx[BQSIM_PACKET_MAX], driven[BQSIM_PACKET_MAX];
} bqsim_session;

/** An empty world. `vcd` (may be NULL) is an open waveform file, owned by the caller, that records every bus
 * and pin edge. */
void bqsim_init(bqsim_session *s, sim_vcd *vcd);

/**
 * Executes one line (with or without its line end). `reply` receives a single line without line end, always
 * terminated; it is empty for BQSIM_SILENT. A reply that does not fit in `size` refuses the command before it
 * has any effect.
 */
bqsim_result bqsim_exec(bqsim_session *s, const char *line, char *reply, size_t size);

/** The same for `length` characters, which may contain NUL (refused outside a comment). */
bqsim_result bqsim_exec_n(bqsim_session *s, const char *line, size_t length, char *reply, size_t size);

#endif
