/* SPDX-License-Identifier: Apache-2.0 */
/* From the 19 bytes of a burst to the readings of one device. */
#include "bqhost/bq76pl536_convert.h"
#include "pl536_internal.h"

/* Faults that a healthy burst does not take back. */
#define KEPT (PL_EVENTS | BQ_F_DEFECTIVE | BQ_F_CHAIN | BQ_F_OPEN_WIRE | BQ_F_DIE_TEMP)

#define WIRE_CYCLES 3u /* consecutive cycles before an open wire is reported (PL-SEQ-14-02) */

/* The recommended operating conditions (PL-ELEC-01, PL-AMB-94). */
#define CELL_MIN_MV 1000u
#define CELL_MAX_MV 4500u
#define BRICK_MAX_MV 27000u

static uint8_t outside(uint16_t mv, uint16_t min_mv, uint16_t max_mv)
{
    return mv < min_mv || mv > max_mv ? BQ_Q_OUTSIDE : 0u;
}

void pl_invalidate(bq76pl536_device *dev, uint8_t why, uint16_t fault)
{
    dev->flags &= (uint16_t)~PL_DEV_VALID;
    dev->faults |= fault;
    for (unsigned i = 0; i < BQ76PL536_MAX_CELLS; i++) {
        dev->cell_quality[i] = why;
    }
    dev->temp_quality[0] = why;
    dev->temp_quality[1] = why;
    dev->gpai_quality = why;
}

void pl_invalidate_from(bq76pl536 *d, unsigned first, uint8_t why, uint16_t fault)
{
    for (unsigned n = first; n <= d->config.devices; n++) {
        pl_invalidate(pl_dev(d, n), why, fault);
    }
}

bool pl_valid(const bq76pl536 *d, unsigned n)
{
    return (d->devices[n - 1u].flags & PL_DEV_VALID) != 0u;
}

static void take_sensor(const bq76pl536 *d, bq76pl536_device *dev, unsigned i, uint16_t code)
{
    uint32_t ohms;
    int16_t dc;
    if (bq76pl536_ts_ohms((uint8_t)(i + 1u), code, &ohms) != BQ_OK) {
        dev->temp_quality[i] = BQ_Q_SENSOR | BQ_Q_RANGE; /* open or shorted */
        return;
    }
    bq_status st = bq_thermistor_dc(d->config.thermistor, ohms, &dc);
    dev->temp_quality[i] = BQ_Q_VALID;
    if (st != BQ_OK) {
        dev->temp_quality[i] |= BQ_Q_RANGE;
    }
    dev->temp_dc[i] = dc;
}

/* Cells next to a suspicious wire keep their last good value and do not count (PL-SEQ-14-05). */
static void take_cells(const bq76pl536 *d, unsigned n, bq76pl536_device *dev, const uint8_t *data)
{
    uint16_t mv[BQ76PL536_MAX_CELLS];
    unsigned cells = pl_cells(d, n);
    uint8_t clipped = 0;
    for (unsigned i = 0; i < cells; i++) {
        uint16_t code = bq76pl536_burst_word(data, (uint8_t)(BQ76PL536_BURST_CELL1 + i));
        (void)bq76pl536_cell_mv(code, &mv[i]); /* bits 15..14 were checked */
        clipped |= (uint8_t)(bq76pl536_code_clipped(code) ? 1u << i : 0u);
    }
    uint8_t wires = pl_suspect_wires(d, n, mv);
    dev->wire_count =
        wires == 0u ? 0u : (uint8_t)(dev->wire_count < WIRE_CYCLES ? dev->wire_count + 1u : WIRE_CYCLES);
    dev->open_wire = 0;
    dev->faults &= (uint16_t)~BQ_F_OPEN_WIRE;
    if (dev->wire_count >= WIRE_CYCLES) {
        dev->open_wire = wires;
        dev->faults |= BQ_F_OPEN_WIRE;
    }
    for (unsigned i = 0; i < cells; i++) {
        if ((wires >> i & 3u) != 0u) { /* wire i below, wire i + 1 above */
            dev->cell_quality[i] = BQ_Q_OPEN_WIRE;
            continue;
        }
        dev->cell_mv[i] = mv[i];
        dev->cell_quality[i] = (uint8_t)(BQ_Q_VALID | ((clipped >> i & 1u) != 0u ? BQ_Q_RANGE : 0u) |
                                         outside(mv[i], CELL_MIN_MV, CELL_MAX_MV));
    }
}

static void take_gpai(const bq76pl536 *d, bq76pl536_device *dev, uint16_t code)
{
    dev->gpai_quality = (uint8_t)(BQ_Q_VALID | (bq76pl536_code_clipped(code) ? BQ_Q_RANGE : 0u));
    if (d->gpai_pins) {
        dev->gpai_mv = (uint16_t)((code * 2500ul + 8191u) / BQ76PL536_CODE_MAX);
    } else {
        (void)bq76pl536_brick_mv(code, &dev->gpai_mv);
        dev->gpai_quality |= outside(dev->gpai_mv, PL_SUPPLY_MIN_MV, BRICK_MAX_MV);
    }
}

/* The same results again and again: the conversion start was lost without a trace, or the converter has
 * stopped (06-08). */
static bool frozen(const bq76pl536 *d, bq76pl536_device *dev, const uint8_t *data)
{
    if (d->config.frozen_scans == 0u) {
        return false;
    }
    unsigned sum = 0;
    for (unsigned i = 1; i < BQ76PL536_BURST_COUNT; i++) {
        sum = sum * 31u + data[i];
    }
    uint8_t signature = (uint8_t)(sum ^ sum >> 8 ^ sum >> 16);
    dev->same =
        signature != dev->signature ? 0u : (uint8_t)(dev->same < UINT8_MAX ? dev->same + 1u : UINT8_MAX);
    dev->signature = signature;
    return dev->same >= d->config.frozen_scans;
}

/* Why the readings of this device do not count although the burst is sound; false: they do. */
static bool refuse(const bq76pl536 *d, bq76pl536_device *dev, const uint8_t *data, uint32_t t_ms)
{
    if ((data[0] & BQ76PL536_DS_UVLO) != 0u) {
        dev->cb_on = 0; /* UVLO cleared CB_CTRL (PL-UVLO-02) */
        pl_invalidate(dev, BQ_Q_CHIP, BQ_F_SUPPLY);
    } else if ((dev->flags & PL_DEV_DEFECTIVE) != 0u) {
        pl_invalidate(dev, BQ_Q_CHIP, BQ_F_DEFECTIVE);
    } else if ((dev->flags & PL_DEV_TSD) != 0u) {
        pl_invalidate(dev, BQ_Q_CHIP, BQ_F_DIE_TEMP);
    } else if ((data[0] & BQ76PL536_DS_CBT) != 0u) {
        dev->flags |= PL_DEV_CB_WRONG;
        pl_invalidate(dev, BQ_Q_CHIP, BQ_F_BALANCE);
    } else if ((dev->flags & PL_DEV_WARMING) != 0u && (int32_t)(t_ms - dev->ready_ms) < 0) {
        pl_invalidate(dev, BQ_Q_CHIP, 0);
    } else if (frozen(d, dev, data)) {
        pl_invalidate(dev, BQ_Q_CHIP, BQ_F_LOCKUP);
    } else {
        return false;
    }
    return true;
}

bq_status pl_take_burst(bq76pl536 *d, unsigned n, uint32_t t_ms)
{
    bq76pl536_device *dev = pl_dev(d, n);
    const uint8_t *data = pl_data(d);
    bq_status st = pl_reply(d);
    if (st != BQ_OK) {
        return st;
    }
    st = bq76pl536_burst_check(data);
    if (st != BQ_OK) {
        d->stats.implausible += d->stats.implausible != UINT32_MAX ? 1u : 0u;
        return st;
    }
    if ((data[0] & BQ76PL536_DS_DRDY) == 0u) {
        return BQ_E_LOCKED_UP;
    }
    dev->status = data[0];
    dev->faults &= KEPT;
    dev->flags &= (uint16_t)~(PL_DEV_CB_WRONG | PL_DEV_SERVICE);
    if ((data[0] & BQ76PL536_DS_ECC_COR) != 0u) {
        d->diagnosis.ecc_corrected = (uint8_t)n;
    }
    if ((data[0] & (BQ76PL536_DS_FAULT | BQ76PL536_DS_ALERT)) != 0u) {
        dev->flags |= PL_DEV_SERVICE;
    } else {
        dev->alert = dev->fault = dev->cov = dev->cuv = 0;
    }
    if (refuse(d, dev, data, t_ms)) {
        return BQ_OK;
    }
    take_gpai(d, dev, bq76pl536_burst_word(data, BQ76PL536_BURST_GPAI));
    take_cells(d, n, dev, data);
    for (unsigned i = 0; i < d->config.sensors && i < 2u; i++) {
        take_sensor(d, dev, i, bq76pl536_burst_word(data, (uint8_t)(BQ76PL536_BURST_TS1 + i)));
    }
    dev->t_ms = t_ms;
    dev->flags = (uint16_t)((dev->flags | PL_DEV_VALID | PL_DEV_MEASURED) & ~PL_DEV_WARMING);
    return BQ_OK;
}
