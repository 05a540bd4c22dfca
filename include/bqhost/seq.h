/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file seq.h
 * For the authors of drivers: jobs that read from top to bottom like the procedure they carry out, and yet never block.
 *
 * A job is a function that is called again and again with its frame. Between SEQ_BEGIN and SEQ_END it lets go of the processor at
 * each SEQ_YIELD, which starts something (a transfer, a wait, a child job) and returns what that start returned; the next call goes
 * on behind it. `frame` is any struct with a uint16_t member `pc`, 0 before the first call.
 *
 * Local variables do not survive a SEQ_YIELD: what must survive lives in the frame or in the instance. A job must not use
 * `switch` across a SEQ_YIELD, and must not put two of them on one line.
 */
#ifndef BQHOST_SEQ_H
#define BQHOST_SEQ_H

#include "bqhost/status.h"
#include <stdint.h>

#define SEQ_BEGIN(frame)                                                                                     \
    switch ((frame)->pc) {                                                                                   \
    case 0:

#define SEQ_YIELD(frame, start)                                                                              \
    do {                                                                                                     \
        (frame)->pc = (uint16_t)__LINE__;                                                                    \
        return (start);                                                                                      \
    case __LINE__:;                                                                                          \
    } while (0)

/** The end of every job; reached only by a job that forgot to return its status. */
#define SEQ_END                                                                                              \
    }                                                                                                        \
    return BQ_E_STATE

#endif
