/* SPDX-License-Identifier: Apache-2.0 */
/** @file defect.h
 * A broken image is the image of a board linked with one shim that takes the place of one function (--wrap).
 * Each works for 1.6 s, so that the outputs are on when the defect strikes, unless it is one of the start. */
#ifndef DEFECT_H
#define DEFECT_H

#include "stm32_chip.h"
#include "stm32_time.h"
#include <stdbool.h>

static inline bool defect_due(void)
{
    return stm32_now_us() > 1600000u;
}

#endif
