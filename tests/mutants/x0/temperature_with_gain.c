/* SPDX-License-Identifier: Apache-2.0 */
/* Thermistor and die readings scaled with the GAIN of the cells instead of 382 uV. */
#include "bqhost/thermistor.h"
#include "x0_wrong.h"

const x0_wrong wrong = {0};

bq_status __real_bq769x0_sample(bq769x0 *d, bq_sample *s);
bq_status __wrap_bq769x0_sample(bq769x0 *d, bq_sample *s);

bq_status __wrap_bq769x0_sample(bq769x0 *d, bq_sample *s)
{
    bq_status st = __real_bq769x0_sample(d, s);
    for (unsigned i = 0; st == BQ_OK && i < s->temp_count; i++) {
        uint8_t reg = (uint8_t)(BQ769X0_TS1_HI + 2u * i);
        unsigned code = (x0_wrong_seen(reg) & 0x3fu) << 8 | x0_wrong_seen((uint8_t)(reg + 1u));
        uint32_t ohms = 0;
        code = code * bq769x0_get_achieved(d)->trim.gain_uv / 382u;
        if (x0_wrong_config()->sensors == 0) {
            s->temps[i].dc = bq769x0_die_dc((uint16_t)code, 1200000u);
        } else if (bq769x0_ts_ohms((uint16_t)code, &ohms) == BQ_OK) {
            (void)bq_thermistor_dc(x0_wrong_config()->sensor_ctx, ohms, &s->temps[i].dc);
        }
        mutant_acted();
    }
    return st;
}
