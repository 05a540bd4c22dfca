/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file x0_wrong.h
 * A bq769x0 driver with a mistake: the real one behind a shim at its own boundaries, so that a change inside
 * the driver does not touch the variants. The linker redirects bq769x0_init() here (--wrap), which puts a bus
 * of its own between driver and back-end. A variant fills in what is wrong; NULL and false mean "as it is".
 */
#ifndef X0_WRONG_H
#define X0_WRONG_H

#include "bqhost/bq769x0.h"
#include "bqhost/bq769x0_regs.h"
#include "mutant.h"

typedef struct x0_wrong {
    /** Changes the configuration that the driver gets. */
    void (*config)(bq769x0_config *config);
    /** A write of `n` registers from `reg`; true = `data` was changed, CRC bytes are made anew. */
    bool (*say)(uint8_t reg, unsigned n, uint8_t *data);
    /** A read that arrived; `bad` = first register whose CRC byte does not hold, `n` if all do or there are
     * none; true = as for say. */
    bool (*hear)(uint8_t reg, unsigned n, uint8_t *data, unsigned bad);
    /** True = this read is sent without its pointer. `again` = it follows a damaged read of the same. */
    bool (*without_pointer)(bool again);
    /** Blocks of measurements are read one register a transaction. */
    bool one_by_one;
} x0_wrong;

/** The mistake of this program; the variant defines it. */
extern const x0_wrong wrong;

/** Called inside hear: a write of one register that is sent before the driver hears that the read ended. */
void x0_wrong_also_write(uint8_t reg, uint8_t value);
/** Registers as they came over the bus last, high bytes unmasked. */
uint8_t x0_wrong_seen(uint8_t reg);
/** The driver under test. */
bq769x0 *x0_wrong_driver(void);
/** The configuration it was given. */
const bq769x0_config *x0_wrong_config(void);

#endif
