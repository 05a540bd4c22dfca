/* SPDX-License-Identifier: Apache-2.0 */
/* From codes to single readings (X0-SEQ-23). */
#include "x0_internal.h"

/* uV / 1000 up to 6.7 V. A Cortex-M0 has no divider, and this is done for every cell: 2^19 / 125 is 4194.3,
 * so the product is at most one too low. */
static uint32_t thousandth(uint32_t uv)
{
    uint32_t mv = (uv >> 3) * 4194u >> 19;
    return uv - mv * 1000u >= 1000u ? mv + 1u : mv;
}

uint32_t x0_cell_mv(const bq769x0 *d, unsigned input)
{
    int32_t uv = bq769x0_cell_uv(d->achieved.trim, d->code[input]);
    uint32_t mv = uv < 0 ? 0u : thousandth((uint32_t)uv + 500u);
    return (mv * d->gain2_q15 + 16384u) >> 15;
}

/* Quality of a value of this picture that is `bad` for the reason given, or `doubtful`. One that was not
 * measured: the part did not answer, or it did and what it says does not count. */
uint8_t x0_quality(const bq769x0 *d, bool measured, unsigned bad, bool doubtful)
{
    if (!measured) {
        return (d->faults & BQ_F_COMM) != 0u ? BQ_Q_COMM : BQ_Q_CHIP;
    }
    if (bad != 0u) {
        return (uint8_t)bad;
    }
    return doubtful ? BQ_Q_VALID | BQ_Q_OUTSIDE : BQ_Q_VALID;
}

/* A dead cell or broken wire: the part itself ignores it (X0-UV-08). Accuracy is stated for 2 to 5 V only
 * (X0-ADC-09). */
void x0_read_cell(const bq769x0 *d, bq_cell_reading *c, unsigned input)
{
    unsigned code = d->code[input], bad = 0;
    uint32_t mv = x0_cell_mv(d, input);
    if (code == 0x3fffu) {
        bad = BQ_Q_RANGE;
    } else if (code < BQ769X0_UV_MINQUAL) {
        bad = BQ_Q_OPEN_WIRE;
    }
    c->mv = (uint16_t)mv;
    c->module = 0;
    c->quality = x0_quality(d, d->valid, bad, mv - 2000u > 3000u);
}

void x0_read_temp(const bq769x0 *d, bq_temp_reading *t, uint16_t code)
{
    uint32_t ohms;
    bq_status st = BQ_OK;
    if (d->config.sensors == 0u) {
        t->dc = bq769x0_die_dc(code, d->config.die_v25_uv);
    } else {
        st = bq769x0_ts_ohms(code, &ohms);
        st = st == BQ_OK ? bq_thermistor_dc(d->config.thermistor, ohms, &t->dc) : st;
    }
    t->module = 0;
    t->quality = x0_quality(d, d->temp_valid, st != BQ_OK ? BQ_Q_SENSOR : 0u,
                            code - 785u > 7853u - 785u); /* X0-TS-07 */
}
