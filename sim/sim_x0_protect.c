/* SPDX-License-Identifier: Apache-2.0 */
/* Overcurrent comparators, FET reactions, ALERT and balancing outputs (X0-OCD, X0-SCD, X0-FET, X0-ALERT,
 * X0-CB). */
#include "sim_x0_internal.h"
#include <string.h>

static const uint8_t ocd_mv[2][16] = {
    {8, 11, 14, 17, 19, 22, 25, 28, 31, 33, 36, 39, 42, 44, 47, 50},
    {17, 22, 28, 33, 39, 44, 50, 56, 61, 67, 72, 78, 83, 89, 94, 100},
};
static const uint8_t scd_mv[2][8] = {{22, 33, 44, 56, 67, 78, 89, 100},
                                     {44, 67, 89, 111, 133, 155, 178, 200}};
static const uint16_t ocd_ms[8] = {8, 20, 40, 80, 160, 320, 640, 1280};
static const uint16_t scd_us[4] = {70, 100, 200, 400};

static void clear_balancing(sim_x0 *s)
{
    for (int r = X0_CELLBAL1; r <= X0_CELLBAL3; r++) {
        s->reg[r] = 0;
    }
}

void x0_raise(sim_x0 *s, uint8_t bits)
{
    uint8_t *ctrl2 = &s->reg[X0_SYS_CTRL2];
    bits &= (uint8_t)~s->reg[X0_SYS_STAT]; /* reactions belong to the moment a bit becomes 1 */
    s->reg[X0_SYS_STAT] |= bits;
    s->raised = (uint8_t)(s->raised_at == s->now ? s->raised | bits : bits);
    s->raised_at = s->now;
    s->due = 0;
    if ((bits & X0_OV) != 0) {
        *ctrl2 &= (uint8_t)~X0_CHG_ON;
    }
    if ((bits & (X0_UV | X0_OCD | X0_SCD)) != 0) {
        *ctrl2 &= (uint8_t)~X0_DSG_ON;
    }
    if ((bits & (X0_OVRD | X0_XREADY)) != 0) {
        *ctrl2 &= (uint8_t) ~(X0_CHG_ON | X0_DSG_ON);
    }
    if ((bits & X0_XREADY) != 0 || (s->options.amb63_faults_clear_cb && (bits & ~X0_CC_READY) != 0)) {
        clear_balancing(s);
    }
    if ((bits & X0_XREADY) != 0 && s->options.amb65_config_lost) {
        memset(&s->reg[X0_PROTECT1], 0, 6);
        s->reg[X0_OV_TRIP] = 0xac;
        s->reg[X0_UV_TRIP] = 0x97;
    }
}

static uint64_t ocd_delay(const sim_x0 *s)
{
    return (s->reg[X0_SYS_CTRL2] & X0_DELAY_DIS) != 0 ? 0 : ocd_ms[(s->reg[X0_PROTECT2] >> 4) & 7u] * X0_MS;
}

static uint64_t scd_delay(const sim_x0 *s)
{
    return (s->reg[X0_SYS_CTRL2] & X0_DELAY_DIS) != 0 ? 0 : scd_us[(s->reg[X0_PROTECT1] >> 3) & 3u] * X0_US;
}

static uint64_t due(const sim_x0 *s, uint64_t since, uint64_t delay, uint8_t bit)
{
    if (since == X0_NEVER || (s->reg[X0_SYS_STAT] & bit) != 0) {
        return X0_NEVER;
    }
    return since + delay > s->now ? since + delay : s->now;
}

uint64_t x0_overcurrent_due(const sim_x0 *s)
{
    uint64_t o = due(s, s->ocd_since, ocd_delay(s), X0_OCD);
    uint64_t c = due(s, s->scd_since, scd_delay(s), X0_SCD);
    return o < c ? o : c;
}

static void follow(sim_x0 *s, double mv, double trip_mv, uint64_t *since, uint64_t delay, uint8_t bit)
{
    if (s->mode != SIM_X0_NORMAL || !(mv > trip_mv + 1e-9)) { /* strictly above (X0-AMB-47) */
        *since = X0_NEVER;
        return;
    }
    if (*since == X0_NEVER) {
        *since = s->now;
    }
    if (due(s, *since, delay, bit) <= s->now) {
        x0_raise(s, bit);
    }
}

/* Evaluates both comparators now; called whenever something they depend on changes and when a delay ends. */
void x0_overcurrent(sim_x0 *s)
{
    unsigned range = s->reg[X0_PROTECT1] >> 7;
    double mv = -s->sense * 1e3;
    s->due = 0;
    follow(s, mv, ocd_mv[range][s->reg[X0_PROTECT2] & 15u], &s->ocd_since, ocd_delay(s), X0_OCD);
    follow(s, mv, scd_mv[range][s->reg[X0_PROTECT1] & 7u], &s->scd_since, scd_delay(s), X0_SCD);
}

static bool alert_driven(const sim_x0 *s)
{
    return s->mode == SIM_X0_NORMAL && (s->reg[X0_SYS_STAT] & 0xbfu) != 0;
}

/* X0-ALERT-04: an outside high level is noticed only while the device drives low. */
void x0_alert_check(sim_x0 *s, bool rising)
{
    bool noticed = rising || !s->options.amb53_edge;
    if (s->mode == SIM_X0_NORMAL && s->alert_ext && noticed && !alert_driven(s)) {
        x0_raise(s, X0_OVRD);
    }
}

bool sim_x0_alert(const sim_x0 *s)
{
    return alert_driven(s) || s->alert_ext || (s->options.field_alert_high && s->mode == SIM_X0_NORMAL);
}

bool sim_x0_chg(const sim_x0 *s)
{
    return (s->reg[X0_SYS_CTRL2] & X0_CHG_ON) != 0;
}

bool sim_x0_dsg(const sim_x0 *s)
{
    return (s->reg[X0_SYS_CTRL2] & X0_DSG_ON) != 0;
}

uint16_t sim_x0_cb(const sim_x0 *s)
{
    return (uint16_t)(s->reg[1] | (unsigned)s->reg[2] << 5 | (unsigned)s->reg[3] << 10);
}

uint16_t sim_x0_cb_conducting(const sim_x0 *s)
{
    uint64_t left = s->t_scan == X0_NEVER ? X0_SCAN - s->now % X0_SCAN : s->t_scan - s->now;
    left = (left + X0_SCAN - 1u) % X0_SCAN + 1u; /* to the end of this 250 ms */
    return left <= 75u * X0_MS ? 0 : sim_x0_cb(s);
}

/* X0-CB-04, X0-CB-06, X0-AMB-62: neighbours among the inputs that carry a cell, inside each group of five. */
void x0_judge_balance(sim_x0 *s, int group)
{
    unsigned cb = sim_x0_cb(s);
    bool below_on = false;
    for (int i = 5 * group; i < 5 * group + 5; i++) {
        bool on = ((cb >> i) & 1u) != 0, shorted = s->cell[i] < 0.05;
        if (on && shorted) {
            x0_misuse(s, "X0-CB-06", "balancing switch of a shorted input");
        }
        if (on && below_on) {
            x0_misuse(s, "X0-CB-04", "adjacent cells balanced together");
        }
        below_on = shorted ? below_on : on;
    }
}
