/* SPDX-License-Identifier: Apache-2.0 */
/** @file noise.h
 * What a board is not meant to see: lines that toggle all the time, a console that gets bytes without end, a
 * CAN bus full of frames. A world owns one and asks it in its callbacks. */
#ifndef NOISE_H
#define NOISE_H

#include "emu.h"

#define MS 1000000ull

typedef struct noise_source {
    uint64_t every_ns; /**< 0 = quiet */
    uint64_t at_ns;
    unsigned given;
} noise_source;

typedef struct noise {
    noise_source line, uart, can;
    unsigned port, pin;  /**< the line that toggles */
    bool level;          /**< its present level */
    uint8_t byte;        /**< what the console gets */
    emu_can_frame frame; /**< what stands on CAN */
    unsigned taken;      /**< frames that the controller acknowledged */
} noise;

void noise_begin(noise_source *s, const emu *e, uint64_t every_ns);
void noise_end(noise *n);
/** For advance(): everything due. */
void noise_advance(noise *n, emu *e, uint64_t now_ns);
/** For next(): absolute. */
uint64_t noise_next(const noise *n);
/** For pin_in(): whether the noise is on this pin; the level is n->level. */
bool noise_on(const noise *n, unsigned port, unsigned pin);

#endif
