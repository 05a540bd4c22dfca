/* SPDX-License-Identifier: Apache-2.0 */
/* The protecting half: comparators, delays, latches, FAULT_STATUS and ALERT_STATUS (PL-COV, PL-CUV, PL-OT,
 * PL-FLT, PL-ALT). It knows nothing of the ADC (PL-GEN-02). */
#include "sim_pl536_internal.h"

/* Table 1: ratio at which a code sets and clears (PL-NUM-17..27). */
static const double ot_set[12] = {0.0,    0.2000, 0.2244, 0.2488, 0.2712, 0.2956,
                                  0.3156, 0.3356, 0.3556, 0.3712, 0.3866, 0.4000};
static const double ot_clear[12] = {0.0,    0.1766, 0.2000, 0.2270, 0.2498, 0.2750,
                                    0.2956, 0.3162, 0.3368, 0.3528, 0.3688, 0.3824};

/* ---- delays -----------------------------------------------------------------------------------------------
 */

static void guard_stop(sim_pl_guard *g, unsigned inputs)
{
    for (int i = 0; i < 6; i++) {
        if ((inputs >> i & 1u) != 0) {
            g->due[i] = SIM_PL_NEVER;
        }
    }
    g->pending &= (uint8_t)~inputs;
}

static void guard_start(const sim_pl *s, sim_pl_guard *g, unsigned inputs)
{
    for (int i = 0; i < 6; i++) {
        if ((inputs >> i & 1u) != 0) {
            g->due[i] = s->now + g->delay_ns;
        }
    }
    g->pending |= (uint8_t)inputs;
}

/* The comparators moved. `held`: inputs that may not be reported now (PL-AMB-33); `sticky`: PL-AMB-40. */
static void guard_move(const sim_pl *s, sim_pl_guard *g, unsigned active, unsigned held, bool sticky)
{
    unsigned rose = active & ~(unsigned)g->active;
    unsigned fell = g->active & ~active;

    g->active = (uint8_t)active;
    if (g->delay_ns == 0) {
        guard_stop(g, 0x3f);
        g->latched = (uint8_t)(active & ~held);
        return;
    }
    guard_stop(g, fell);
    guard_start(s, g, rose & ~(unsigned)g->latched & ~held);
    if (sticky) {
        g->latched &= (uint8_t)~fell;
    }
}

/* Inputs whose delay ends now. */
static bool guard_due(const sim_pl *s, sim_pl_guard *g)
{
    unsigned ended = 0;

    for (int i = 0; i < 6; i++) {
        if (((unsigned)g->pending >> i & 1u) != 0 && g->due[i] <= s->now) {
            ended |= 1u << i;
        }
    }
    guard_stop(g, ended);
    g->latched |= (uint8_t)ended;
    return ended != 0;
}

/* The host wrote 1: nothing is reported, and what is still tripped waits its delay again (PL-FLT-12). */
static void guard_clear(const sim_pl *s, sim_pl_guard *g, unsigned inputs, unsigned held, bool sticky)
{
    if (sticky && g->delay_ns != 0) {
        g->latched &= (uint8_t)(g->active | ~inputs);
    } else {
        g->latched &= (uint8_t)~inputs;
    }
    guard_stop(g, inputs);
    if (g->delay_ns != 0) {
        guard_start(s, g, g->active & inputs & ~held);
    }
}

/* The 0 that PL-AMB-33 waits for was written. */
static void guard_release(const sim_pl *s, sim_pl_guard *g, unsigned inputs)
{
    if (g->delay_ns != 0) {
        guard_start(s, g, g->active & inputs & ~(unsigned)(g->latched | g->pending));
    }
}

/* One flag of FAULT_STATUS stands for all six inputs. */
static unsigned inputs_of(unsigned bits, unsigned flag)
{
    return (bits & flag) != 0 ? 0x3fu : 0u;
}

/* ---- comparators
 * -------------------------------------------------------------------------------------------- */

static bool watching(const sim_pl_dev *d)
{
    return sim_pl_is_on(d) && !d->uvlo && !d->tsd && !d->asleep && d->blank_end == SIM_PL_NEVER;
}

static unsigned over(const sim_pl_dev *d)
{
    unsigned active = 0;

    for (unsigned i = 0; i < 6; i++) {
        active |=
            (unsigned)(d->seen[i] > (((unsigned)d->cov.active >> i & 1u) != 0 ? d->cov.hold : d->cov.trip))
            << i;
    }
    return active & d->cov.enabled;
}

static unsigned under(const sim_pl_dev *d)
{
    unsigned active = 0;

    for (unsigned i = 0; i < 6; i++) {
        active |=
            (unsigned)(d->seen[i] < (((unsigned)d->cuv.active >> i & 1u) != 0 ? d->cuv.hold : d->cuv.trip))
            << i;
    }
    return active & d->cuv.enabled;
}

static unsigned hot(const sim_pl_dev *d)
{
    unsigned active = 0;

    for (unsigned i = 0; i < 2; i++) {
        active |=
            (unsigned)(d->ts[i] > (((unsigned)d->ot.active >> i & 1u) != 0 ? d->ot_hold[i] : d->ot_trip[i]))
            << i;
    }
    return active & d->ot.enabled;
}

bool sim_pl_protect_cells_changed(const sim_pl_dev *d)
{
    return watching(d) && (over(d) != d->cov.active || under(d) != d->cuv.active);
}

/* COV_FAULT, CUV_FAULT and the flags follow the guards; `set` are flags that rise now. */
static void publish(const sim_pl *s, sim_pl_dev *d, unsigned set)
{
    bool sticky = s->options.amb40_sticky_cells;
    bool live = watching(d);
    unsigned fault = d->reg[REG_FAULT] | set;

    if (d->cov.delay_ns == 0 ? live : !sticky) {
        fault = (fault & ~(unsigned)FA_COV) | (d->cov.latched != 0 ? FA_COV : 0u);
    }
    if (d->cuv.delay_ns == 0 ? live : !sticky) {
        fault = (fault & ~(unsigned)FA_CUV) | (d->cuv.latched != 0 ? FA_CUV : 0u);
    }
    d->reg[REG_FAULT] = (uint8_t)fault;
    d->reg[REG_COV_FAULT] = d->cov.latched;
    d->reg[REG_CUV_FAULT] = d->cuv.latched;
    d->reg[REG_ALERT] = (uint8_t)((d->reg[REG_ALERT] & ~(unsigned)AL_OT) | d->ot.latched);
}

void sim_pl_protect_check(sim_pl *s, sim_pl_dev *d)
{
    bool sticky = s->options.amb40_sticky_cells;

    if (!watching(d)) {
        return;
    }
    guard_move(s, &d->cov, over(d), inputs_of(d->hold_fault, FA_COV), sticky);
    guard_move(s, &d->cuv, under(d), inputs_of(d->hold_fault, FA_CUV), sticky);
    guard_move(s, &d->ot, hot(d), d->hold_alert & AL_OT, false);
    publish(s, d, 0);
}

void sim_pl_protect_due(sim_pl *s, sim_pl_dev *d)
{
    unsigned set = 0;

    if ((d->cov.pending | d->cuv.pending | d->ot.pending) == 0) {
        return;
    }
    set |= guard_due(s, &d->cov) ? FA_COV : 0u;
    set |= guard_due(s, &d->cuv) ? FA_CUV : 0u;
    guard_due(s, &d->ot);
    publish(s, d, set);
}

/* Comparators without power: delays and hysteresis are forgotten, flags stay as they are. */
void sim_pl_protect_off(sim_pl_dev *d)
{
    guard_stop(&d->cov, 0x3f);
    guard_stop(&d->cuv, 0x3f);
    guard_stop(&d->ot, 0x3f);
    d->cov.active = d->cuv.active = d->ot.active = 0;
}

/* SLEEP keeps FAULT_STATUS and ALERT_STATUS (PL-SLEEP-02), but COV_FAULT and CUV_FAULT without a latch show
 * comparators that are off. */
void sim_pl_protect_rest(sim_pl_dev *d)
{
    sim_pl_protect_off(d);
    if (d->cov.delay_ns == 0) {
        d->cov.latched = d->reg[REG_COV_FAULT] = 0;
    }
    if (d->cuv.delay_ns == 0) {
        d->cuv.latched = d->reg[REG_CUV_FAULT] = 0;
    }
}

/* ---- configuration
 * -------------------------------------------------------------------------------------------- */

static uint64_t delay(const sim_pl *s, uint64_t ns)
{
    if (ns == 0) {
        return 0;
    }
    return sim_pl_scaled(s, ns) + (s->options.deglitch ? 50 * SIM_PL_US : 0);
}

static uint64_t cell_delay(const sim_pl *s, unsigned code)
{
    return delay(s, (code & 0x1fu) * ((code & 0x80u) != 0 ? 100 * SIM_PL_MS : 100 * SIM_PL_US));
}

static void ot_config(sim_pl_dev *d)
{
    unsigned enabled = 0;

    for (unsigned i = 0; i < 2; i++) {
        unsigned code = (unsigned)d->reg[REG_OT] >> (4 * i) & 0x0fu;

        if (code >= 1 && code <= 11 && ((unsigned)d->reg[REG_IO_CONTROL] >> i & 1u) != 0) {
            enabled |= 1u << i;
            d->ot_trip[i] = ot_set[code] + SIM_PL_EPS;
            d->ot_hold[i] = ot_clear[code] - SIM_PL_EPS;
        }
    }
    d->ot.enabled = (uint8_t)enabled;
}

static unsigned limit(unsigned code, unsigned last)
{
    return code > last ? last : code;
}

/* The registers that rule the comparators may have changed (PL-AMB-46). Levels are quotients of whole
 * millivolts, so that a cell set to the printed threshold compares equal. */
void sim_pl_protect_config(sim_pl *s, sim_pl_dev *d)
{
    uint8_t cells = (uint8_t)(0x3fu >> ((unsigned)d->reg[REG_FUNCTION] >> 2 & 3u));
    unsigned cov_mv = 2000 + 50 * limit(d->reg[REG_COV] & 0x3fu, 0x3c);
    unsigned cuv_mv = 700 + 100 * limit(d->reg[REG_CUV] & 0x1fu, 0x1a);

    d->cov.enabled = (d->reg[REG_COV] & PROT_DISABLE) != 0 ? 0 : cells;
    d->cov.trip = cov_mv / 1000.0 + SIM_PL_EPS;
    d->cov.hold = (cov_mv - 50) / 1000.0 - SIM_PL_EPS;
    d->cov.delay_ns = cell_delay(s, d->reg[REG_COVT]);
    d->cuv.enabled = (d->reg[REG_CUV] & PROT_DISABLE) != 0 ? 0 : cells;
    d->cuv.trip = cuv_mv / 1000.0 - SIM_PL_EPS;
    d->cuv.hold = (cuv_mv + 100) / 1000.0 + SIM_PL_EPS;
    d->cuv.delay_ns = cell_delay(s, d->reg[REG_CUVT]);
    d->ot.delay_ns = delay(s, d->reg[REG_OTT] * 10 * SIM_PL_MS);
    ot_config(d);
    sim_pl_protect_check(s, d);
}

/* ---- flags
 * ------------------------------------------------------------------------------------------------------ */

void sim_pl_alert_set(sim_pl_dev *d, uint8_t bits)
{
    d->reg[REG_ALERT] |= bits & (uint8_t)~d->hold_alert;
}

void sim_pl_fault_set(sim_pl_dev *d, uint8_t bits)
{
    d->reg[REG_FAULT] |= bits & (uint8_t)~d->hold_fault;
}

/* Flags whose cause is present and cannot be cleared (PL-AMB-28, PL-AMB-91, PL-G3-08). */
static unsigned persistent_alerts(const sim_pl_dev *d)
{
    unsigned bits = 0;

    bits |= (d->reg[REG_ADDRESS] & ADDR_AR) == 0 ? AL_AR : 0u;
    bits |= d->tsd ? AL_TSD : 0u;
    bits |= (d->reg[REG_PRESULT_A] | d->reg[REG_PRESULT_B]) != 0 ? AL_PARITY : 0u;
    return bits;
}

void sim_pl_write_alert(sim_pl *s, sim_pl_dev *d, uint8_t value)
{
    unsigned clear = value & ~(unsigned)AL_FORCE & ~persistent_alerts(d);
    unsigned held = s->options.amb33_hold_until_zero ? clear : 0u;
    unsigned released = d->hold_alert & ~held;

    d->reg[REG_ALERT] = (uint8_t)((d->reg[REG_ALERT] & ~clear & ~(unsigned)AL_FORCE) | (value & AL_FORCE));
    d->hold_alert = (uint8_t)held;
    guard_clear(s, &d->ot, clear & AL_OT, held & AL_OT, false);
    guard_release(s, &d->ot, released & AL_OT);
    publish(s, d, 0);
    sim_pl_protect_check(s, d);
}

void sim_pl_write_fault(sim_pl *s, sim_pl_dev *d, uint8_t value)
{
    bool sticky = s->options.amb40_sticky_cells;
    unsigned clear = value & FA_ALL & ~(unsigned)FA_FORCE;
    unsigned held = s->options.amb33_hold_until_zero ? clear : 0u;
    unsigned released = d->hold_fault & ~held;

    d->reg[REG_FAULT] = (uint8_t)((d->reg[REG_FAULT] & ~clear & ~(unsigned)FA_FORCE) | (value & FA_FORCE));
    d->hold_fault = (uint8_t)held;
    guard_clear(s, &d->cov, inputs_of(clear, FA_COV), inputs_of(held, FA_COV), sticky);
    guard_clear(s, &d->cuv, inputs_of(clear, FA_CUV), inputs_of(held, FA_CUV), sticky);
    guard_release(s, &d->cov, inputs_of(released, FA_COV));
    guard_release(s, &d->cuv, inputs_of(released, FA_CUV));
    publish(s, d, 0);
    sim_pl_protect_check(s, d);
}
