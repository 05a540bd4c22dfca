/* SPDX-License-Identifier: Apache-2.0 */
/* Die temperature (X0-DIE-02, X0-DIE-04, X0-DIE-05): always where it is the source; beside thermistors by
 * switching over from time to time (X0-SEQ-43, X0-SEQ-44). Too hot a die ends balancing. */
#include "x0_internal.h"

enum {
    DIE_REST,   /* the thermistors are the source */
    DIE_LOOK,   /* the die is, for a while */
    DIE_RETURN, /* seen; or nobody knows which is: the thermistors must be selected */
    DIE_BACK    /* they are, but the registers may still hold the die */
};

#define HOLD_MS 10000u /* the values of the thermistors stand in for so long at most */
#define HYSTERESIS_DC 100
#define LIMIT_DC 850
#define FAULT_DC 950

void x0_die_reset(bq769x0 *d)
{
    bq769x0_die *t = &d->die;
    t->phase = DIE_REST;
    t->looked = t->known = d->die_hot = t->fault = d->temp_held = false;
    d->known.registers[BQ769X0_SYS_CTRL1] =
        d->config.sensors != 0u ? BQ769X0_CTRL1_ADC_EN | BQ769X0_CTRL1_TEMP_SEL : BQ769X0_CTRL1_ADC_EN;
}

static bool settled(const bq769x0 *d)
{
    return d->now_ms - d->temp_ms >= X0_TEMP_MS;
}

/* The registers of the thermistors count again; or the values that stand in have become too old. */
void x0_die_before_picture(bq769x0 *d)
{
    bq769x0_die *t = &d->die;
    if (t->phase == DIE_BACK && settled(d)) {
        t->phase = DIE_REST;
        d->temp_held = false;
    }
    if (t->phase != DIE_REST && d->now_ms - t->hold_ms > HOLD_MS) {
        d->temp_held = d->temp_settled = false;
        if (t->phase != DIE_BACK) {
            t->phase = DIE_RETURN;
            d->temp_ms = d->now_ms; /* nothing in the registers counts until it is known whose it is */
        }
    }
}

static bool over(bool before, int dc, int limit_dc)
{
    return dc > (before ? limit_dc - HYSTERESIS_DC : limit_dc);
}

/* The hottest of the sensors. What no working sensor gives counts as too hot to balance,
 * but not as a temperature. */
static void judge(bq769x0 *d)
{
    bq769x0_die *t = &d->die;
    const bq769x0_config *c = &d->config;
    const uint16_t *codes = &d->fresh[X0_TS];
    unsigned lowest = 0x3fff;
    for (unsigned i = 0; i < d->known.groups; i++) {
        unsigned code = codes[i] & 0x3fffu;
        lowest = code < lowest ? code : lowest;
    }
    t->dc = bq769x0_die_dc((uint16_t)lowest, d->config.die_v25_uv);
    t->looked = true;
    t->known = t->dc > -500 && t->dc < 1750;
    t->ms = d->now_ms;
    d->die_hot = !t->known || over(d->die_hot, t->dc, c->die_limit_dc != 0 ? c->die_limit_dc : LIMIT_DC);
    t->fault = t->known && over(t->fault, t->dc, c->die_fault_dc != 0 ? c->die_fault_dc : FAULT_DC);
}

/* Right after a picture. */
void x0_die_after_picture(bq769x0 *d)
{
    bq769x0_die *t = &d->die;
    bool of_the_die = d->config.sensors == 0u ? d->temp_quality == BQ_Q_VALID
                                              : t->phase == DIE_LOOK && settled(d) && x0_valid(d);
    if (of_the_die) {
        judge(d);
        if (t->phase == DIE_LOOK) {
            t->phase = DIE_RETURN;
        }
    }
    if (t->fault) {
        d->faults |= BQ_F_DIE_TEMP;
    }
}

/* While balancing is asked for, and until a die that was too hot has been seen cooler. */
static bool due(const bq769x0 *d)
{
    const bq769x0_die *t = &d->die;
    uint32_t period_s = d->config.die_check_s != 0u ? d->config.die_check_s : 60u;
    return t->phase == DIE_REST && d->config.sensors != 0u && period_s != BQ769X0_DIE_NEVER &&
           d->temp_quality == BQ_Q_VALID && (d->asked != 0u || d->die_hot) &&
           (!t->looked || d->now_ms - t->ms >= period_s * 1000u);
}

/* The consequences, at the end of a scan: switches off, the source switched over. A switch-over that fails
 * leaves DIE_RETURN: the next scan selects the thermistors. */
int x0_job_die(bq769x0 *d, bq769x0_frame *f)
{
    bq769x0_die *t = &d->die;
    SEQ_BEGIN(f)
    if (d->die_hot && d->balance != 0u) {
        x0_balance(d, 0);
        SEQ_TRY(1, X0_SET_SWITCHES(d));
    }
    if (due(d)) {
        d->temp_held = true;
        t->hold_ms = d->now_ms;
        t->phase = DIE_RETURN;
        d->known.registers[BQ769X0_SYS_CTRL1] &= (uint8_t)~BQ769X0_CTRL1_TEMP_SEL;
        SEQ_TRY(2, X0_SET(BQ769X0_SYS_CTRL1, 1));
        t->phase = DIE_LOOK;
        d->temp_ms = d->now_ms;
    } else if (t->phase == DIE_RETURN) {
        d->known.registers[BQ769X0_SYS_CTRL1] |= BQ769X0_CTRL1_TEMP_SEL;
        SEQ_TRY(3, X0_SET(BQ769X0_SYS_CTRL1, 1));
        t->phase = DIE_BACK;
        d->temp_ms = d->now_ms;
    }
    return BQ_OK;
    SEQ_END;
}

bq_status bq769x0_get_die(const bq769x0 *d, int16_t *dc, uint32_t *age_ms)
{
    const bq769x0_die *t = &d->die;
    if (!t->known) {
        return BQ_E_STALE;
    }
    *dc = t->dc;
    *age_ms = d->now_ms - t->ms;
    return BQ_OK;
}
