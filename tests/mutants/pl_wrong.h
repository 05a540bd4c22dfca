/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file pl_wrong.h
 * A bq76PL536 driver with a mistake: the real one behind a shim, see x0_wrong.h. The linker redirects
 * bq76pl536_init() here, which puts a bus of its own between driver and back-end.
 */
#ifndef PL_WRONG_H
#define PL_WRONG_H

#include "bqhost/bq76pl536.h"
#include "bqhost/bq76pl536_regs.h"
#include "mutant.h"

typedef enum pl_deed { PL_AS_IT_IS, PL_CHANGED, PL_DROPPED } pl_deed;

typedef struct pl_wrong {
    /** Changes the configuration that the driver gets. */
    void (*config)(bq76pl536_config *config);
    /** A write of `value` to `reg` of `device`; the value may be changed. */
    pl_deed (*say)(uint8_t device, uint8_t reg, uint8_t *value);
    /** A read that arrived, `n` registers from `reg`; `good` = its CRC holds. PL_CHANGED: the CRC is made
     * anew. `data` [n] is followed by the CRC byte. */
    pl_deed (*hear)(uint8_t device, uint8_t reg, uint8_t n, uint8_t *data, bool good);
} pl_wrong;

/** The mistake of this program; the variant defines it. */
extern const pl_wrong wrong;

#endif
