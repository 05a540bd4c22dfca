/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Open sense wires, passively (PL-SEQ-14-02, 14-03). Wire 0 is the bottom of the device, wire w the top of
 * cell w. Two signs: the brick differs from the sum of the cells (bottom or top wire, or a cell that
 * vanished), or two neighbours moved in opposite directions by the same amount since their last good values
 * (the wire between them).
 */
#include "pl536_internal.h"

#define VANISHED_MV                                                                                          \
    1000u          /* no last good value to compare with: a reading this low is not a cell (PL-ELEC-01) */
#define PAIR_MV 30 /* how equal the two movements must be, plus an eighth of them */

static int magnitude(int value)
{
    return value < 0 ? -value : value;
}

/* A cell with a last good value: it was valid, or its wire has been suspicious since. */
static bool has_reference(const bq76pl536_device *dev, unsigned i)
{
    return (dev->flags & PL_DEV_VALID) != 0u && dev->cell_mv[i] != 0u &&
           (dev->cell_quality[i] & (BQ_Q_VALID | BQ_Q_OPEN_WIRE)) != 0u;
}

static bool moved(const bq76pl536_device *dev, unsigned i, const uint16_t *mv, int limit)
{
    if (!has_reference(dev, i)) {
        return mv[i] < VANISHED_MV;
    }
    return magnitude((int)mv[i] - (int)dev->cell_mv[i]) > limit / 2;
}

/* The brick says that voltage is missing or too much: which wires explain it? */
static uint8_t explain_sum(const bq76pl536_device *dev, unsigned cells, const uint16_t *mv, int limit)
{
    unsigned wires = 0;
    for (unsigned i = 0; i < cells; i++) {
        if (!moved(dev, i, mv, limit)) {
            continue;
        }
        if (i == 0u) {
            wires |= 1u;
        } else if (i == cells - 1u) {
            wires |= 1u << cells;
        } else {
            wires |= 3u << i; /* a cell alone: below it or above it */
        }
    }
    return (uint8_t)(wires != 0u ? wires : 1u | 1u << cells);
}

static uint8_t explain_pairs(const bq76pl536_device *dev, unsigned cells, const uint16_t *mv, int limit)
{
    unsigned wires = 0;
    for (unsigned i = 0; i + 1u < cells; i++) {
        if (!has_reference(dev, i) || !has_reference(dev, i + 1u)) {
            continue;
        }
        int low = (int)mv[i] - (int)dev->cell_mv[i];
        int high = (int)mv[i + 1u] - (int)dev->cell_mv[i + 1u];
        /* coming closer together is a wire that was mended, with references taken while it was open */
        bool apart = magnitude((int)mv[i] - (int)mv[i + 1u]) >
                     magnitude((int)dev->cell_mv[i] - (int)dev->cell_mv[i + 1u]);
        if (apart && magnitude(low) > limit && magnitude(high) > limit && (low < 0) != (high < 0) &&
            magnitude(low + high) <= PAIR_MV + magnitude(low) / 8) {
            wires |= 2u << i;
        }
    }
    return (uint8_t)wires;
}

uint8_t pl_suspect_wires(const bq76pl536 *d, unsigned n, const uint16_t *mv)
{
    const bq76pl536_device *dev = &d->devices[n - 1u];
    unsigned cells = pl_cells(d, n);
    int limit = d->config.wire_limit_mv;
    int sum = 0;
    bool jumped = false;
    for (unsigned i = 0; i < cells; i++) {
        sum += mv[i];
        jumped = jumped || magnitude((int)mv[i] - (int)dev->cell_mv[i]) > limit;
    }
    uint8_t wires = jumped ? explain_pairs(dev, cells, mv, limit) : 0u; /* a quiet scan ends here */
    if (!d->gpai_pins && wires == 0u && magnitude((int)dev->gpai_mv - sum) > limit) {
        wires = explain_sum(dev, cells, mv, limit);
    }
    return wires;
}
