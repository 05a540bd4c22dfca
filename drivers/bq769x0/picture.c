/* SPDX-License-Identifier: Apache-2.0 */
/* From registers to readings: cells, temperatures, current, and the sample (X0-SEQ-22, X0-SEQ-23, X0-SEQ-26).
 */
#include "x0_internal.h"
#include <string.h>

static uint16_t pair(const uint8_t *p)
{
    return (uint16_t)((unsigned)p[0] << 8 | p[1]);
}

int32_t x0_cell_mv(const bq769x0 *d, unsigned input)
{
    int32_t uv = bq769x0_cell_uv(d->achieved.trim, d->code[input]);
    uint32_t mv = uv < 0 ? 0u : ((uint32_t)uv + 500u) / 1000u;
    return (int32_t)((mv * d->gain2_q15 + 16384u) >> 15);
}

void x0_invalidate(bq769x0 *d, uint16_t fault)
{
    d->valid = d->temp_valid = false;
    d->faults |= fault;
}

/* BAT is a quarter of the sum of all codes of the same scan, within 1 (X0-BAT-05). A block read across a
 * publication fails this too: it is then read again. */
static bool plausible(const bq769x0 *d)
{
    uint32_t sum = 0, bat;
    for (unsigned i = 0; i < d->config.inputs; i++) {
        sum += d->code[i];
    }
    bat = d->bat_code;
    return sum != 0u && bat <= sum / 4u + 1u && bat + 1u >= sum / 4u;
}

/* `block` is what 0x0c..0x31 hold, in the order of the registers. */
void x0_take_picture(bq769x0 *d, const uint8_t *block)
{
    unsigned inputs = d->config.inputs, changed = 0;
    const uint8_t *tail = block + 2u * inputs; /* BAT, then the temperatures */
    for (unsigned i = 0; i < inputs; i++) {
        uint16_t code = pair(block + 2u * i) & 0x3fffu;
        changed |= (unsigned)(code ^ d->code[i]);
        d->code[i] = code;
    }
    changed |= (unsigned)(pair(tail) ^ d->bat_code);
    d->bat_code = pair(tail);
    for (unsigned i = 0; i < x0_groups(d); i++) {
        changed |= (unsigned)pair(tail + 2u + 2u * i) ^ d->ts_code[i];
        d->ts_code[i] = pair(tail + 2u + 2u * i) & 0x3fffu;
    }
    if (changed != 0u) {
        d->same = 0;
    } else if (d->now_ms - d->same_ms >= X0_SCAN_MS && d->same != UINT16_MAX) {
        d->same++; /* counted once per scan of the part, however often the host looks */
        d->same_ms = d->now_ms;
    }
    d->valid = plausible(d) && (d->stat & BQ769X0_STAT_XREADY) == 0u;
    if (!plausible(d)) {
        x0_bump(&d->stats.implausible);
    }
    d->measured = d->measured || d->valid;
    d->temp_valid = d->valid && d->now_ms - d->temp_ms >= X0_TEMP_MS;
    d->balanced = d->balance;
    d->picture_ms = d->now_ms;
    d->picture_us = d->now_us;
    d->sequence++;
}

/* One fetched result. Its time is measured by the host's clock (X0-AMB-99); windows that the clock says were
 * lost are filled with the mean of their neighbours (X0-SEQ-26). */
void x0_take_current(bq769x0 *d, const uint8_t *cc)
{
    int16_t code = (int16_t)pair(cc);
    uint32_t ms = d->now_ms - d->cc_ms, windows = (ms + X0_SCAN_MS / 2u) / X0_SCAN_MS, own = ms;
    int32_t ma, mean;
    if (d->config.invert_current) {
        code = (int16_t)(code == INT16_MIN ? INT16_MAX : -code);
    }
    ma = bq769x0_current_ma(code, d->config.shunt_uohm);
    mean = (bq769x0_current_ma(d->cc_code, d->config.shunt_uohm) + ma) / 2;
    if (windows > 1u) {
        own = ms / windows;
        if (d->charge.results != 0u) {
            d->charge.missed += windows - 1u;
            d->charge.uas += (int64_t)mean * (int32_t)(ms - own);
        }
    }
    d->charge.uas += (int64_t)ma * (int32_t)own;
    x0_bump(&d->charge.results);
    d->cc_code = code;
    d->cc_ms = d->now_ms;
}

static void fill_cells(const bq769x0 *d, bq_sample *s)
{
    unsigned n = 0;
    for (unsigned i = 0; i < d->config.inputs; i++) {
        if ((d->in_use >> i & 1u) != 0u) {
            bq_cell_reading *c = &s->cells[n++];
            bool dead = d->code[i] < BQ769X0_UV_MINQUAL; /* X0-UV-08 */
            c->mv = (uint16_t)x0_cell_mv(d, i);
            c->module = 0;
            c->quality = d->valid && !dead ? BQ_Q_VALID : dead && d->valid ? BQ_Q_OPEN_WIRE : BQ_Q_COMM;
            if (d->code[i] == 0x3fffu) {
                c->quality = BQ_Q_RANGE;
            } else if (c->quality == BQ_Q_VALID && (c->mv < 2000u || c->mv > 5000u)) {
                c->quality |= BQ_Q_RANGE; /* outside what the accuracy is stated for (X0-ADC-09) */
            }
        }
    }
    s->cell_count = (uint16_t)n;
}

static void fill_temps(const bq769x0 *d, bq_sample *s)
{
    unsigned n = d->config.sensors != 0u ? d->config.sensors : 1u;
    for (unsigned i = 0; i < n; i++) {
        bq_temp_reading *t = &s->temps[i];
        uint32_t ohms = 0;
        bq_status st = BQ_OK;
        t->module = 0;
        if (d->config.sensors == 0u) {
            t->dc = bq769x0_die_dc(d->ts_code[i], 1200000u);
        } else {
            st = bq769x0_ts_ohms(d->ts_code[i], &ohms);
            st = st == BQ_OK ? bq_thermistor_dc(d->config.thermistor, ohms, &t->dc) : st;
        }
        t->quality = !d->temp_valid ? BQ_Q_COMM : st == BQ_OK ? BQ_Q_VALID : BQ_Q_SENSOR;
        if (t->quality == BQ_Q_VALID && (d->ts_code[i] < 785u || d->ts_code[i] > 7853u)) {
            t->quality |= BQ_Q_RANGE; /* X0-TS-07 */
        }
    }
    s->temp_count = (uint16_t)n;
}

static uint16_t cells_of(const bq769x0 *d, uint16_t inputs)
{
    unsigned mask = 0, n = 0;
    for (unsigned i = 0; i < d->config.inputs; i++) {
        if ((d->in_use >> i & 1u) != 0u) {
            mask |= ((unsigned)inputs >> i & 1u) << n++;
        }
    }
    return (uint16_t)mask;
}

static void fill_module(const bq769x0 *d, bq_module_reading *m)
{
    memset(m, 0, sizeof *m);
    m->age_ms = d->measured ? d->now_ms - d->picture_ms + X0_SCAN_MS : UINT32_MAX;
    m->faults = d->faults;
    for (unsigned i = 0; d->valid && i < d->config.inputs; i++) {
        if (((unsigned)d->in_use >> i & 1u) != 0u && d->code[i] < BQ769X0_UV_MINQUAL) {
            m->faults |= BQ_F_OPEN_WIRE; /* dead cell or broken wire: the part itself ignores it (X0-UV-08) */
        }
    }
    for (unsigned i = 0; i < d->config.inputs; i++) {
        if ((d->in_use >> i & 1u) != 0u) {
            m->stack_mv += (uint32_t)x0_cell_mv(d, i);
        }
    }
    m->balancing = cells_of(d, d->balanced);
    m->quality = d->valid ? BQ_Q_VALID : BQ_Q_COMM;
}

bq_status bq769x0_sample(bq769x0 *d, bq_sample *s)
{
    unsigned temps = d->config.sensors != 0u ? d->config.sensors : 1u;
    if (s == NULL || s->cell_capacity < d->config.cells || s->temp_capacity < temps ||
        s->module_capacity < 1u) {
        return BQ_E_ARG;
    }
    if (!d->measured) {
        return BQ_E_STALE;
    }
    x0_tick(d);
    fill_cells(d, s);
    fill_temps(d, s);
    fill_module(d, &s->modules[0]);
    s->module_count = 1;
    s->sequence = d->sequence;
    s->t_us = d->picture_us;
    s->current_ma = bq769x0_current_ma(d->cc_code, d->config.shunt_uohm);
    s->current_age_ms = d->charge.results != 0u ? d->now_ms - d->cc_ms : UINT32_MAX;
    s->current_valid = d->charge.results != 0u && s->current_age_ms < 600u && d->cc_code >= -31990 &&
                       d->cc_code <= 31990; /* saturated beyond (X0-CC-11) */
    return BQ_OK;
}

bq_status bq769x0_calibrate(bq769x0 *d, uint32_t stack_mv)
{
    uint32_t sum = 0;
    if (!d->valid) {
        return BQ_E_STALE;
    }
    for (unsigned i = 0; i < d->config.inputs; i++) {
        if (((unsigned)d->in_use >> i & 1u) != 0u) {
            int32_t uv = bq769x0_cell_uv(d->achieved.trim, d->code[i]);
            sum += uv < 0 ? 0u : ((uint32_t)uv + 500u) / 1000u;
        }
    }
    if (sum == 0u || stack_mv > 110000u || stack_mv * 100u < sum * 97u || stack_mv * 100u > sum * 103u) {
        return BQ_E_RANGE; /* X0-AMB-20 */
    }
    d->gain2_q15 = (uint16_t)((stack_mv * 32768u + sum / 2u) / sum);
    for (unsigned i = 0; i < d->config.inputs; i++) {
        d->calibrated_mv[i] = (uint16_t)x0_cell_mv(d, i);
    }
    return BQ_OK;
}

bool bq769x0_calibration_due(const bq769x0 *d)
{
    for (unsigned i = 0; i < d->config.inputs; i++) {
        int32_t moved = x0_cell_mv(d, i) - (int32_t)d->calibrated_mv[i];
        if ((d->in_use >> i & 1u) != 0u && (moved > 100 || moved < -100)) {
            return true;
        }
    }
    return false;
}
