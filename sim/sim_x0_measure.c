/* SPDX-License-Identifier: Apache-2.0 */
/* What the bq769x0 measures by itself: scans, temperatures, OV and UV (X0-ADC, X0-SCH, X0-OV, X0-UV), coulomb
 * counter (X0-CC). */
#include "sim_x0_internal.h"
#include <math.h>
#include <string.h>

#define UV_MINQUAL 0x0518u

static unsigned code_of(double volts, double lsb_uv, double top)
{
    double code = floor(volts * 1e6 / lsb_uv + 0.5);
    return code < 0.0 ? 0u : code > top ? (unsigned)top : (unsigned)code;
}

static void store(sim_x0 *s, int hi, unsigned code)
{
    s->reg[hi] = (uint8_t)(code >> 8);
    s->reg[hi + 1] = (uint8_t)code;
}

static unsigned cell_code(sim_x0 *s, int input)
{
    double volts = s->cell[input];
    if (s->options.amb66_upper_zero && input >= 5 && (s->reg[X0_SYS_STAT] & X0_XREADY) != 0) {
        volts = 0.0;
    }
    if (s->options.noise_uv_rms > 0.0) {
        bool short_window = ((unsigned)s->short_groups >> (input / 5) & 1u) != 0; /* X0-SCH-03 */
        volts += x0_gauss(s) * s->options.noise_uv_rms * 1e-6 * (short_window ? 2.0 : 1.0);
    }
    return code_of(volts - s->offset_mv * 1e-3, s->gain_uv, 16383.0); /* X0-ADC-07 */
}

static void publish_temperatures(sim_x0 *s)
{
    for (int i = 0; i < s->part->cells / 5; i++) {
        double r = s->ts_ohm[i];
        double volts = (s->reg[X0_SYS_CTRL1] & X0_TEMP_SEL) == 0
                           ? 1.200 - 0.0042 * (s->tdie - 25.0) /* X0-DIE-03 */
                       : isinf(r) ? 3.3
                                  : 3.3 * r / (r + 10000.0); /* X0-TS-06 */
        store(s, X0_TS1_HI + 2 * i, code_of(volts, 382.0, 16383.0));
    }
}

static uint64_t delay_s(const sim_x0 *s, int shift, const uint8_t table[4])
{
    return (uint64_t)table[(s->reg[X0_PROTECT3] >> shift) & 3u] * 1000u * X0_MS;
}

/* One timer per kind: it starts at the first bad publication (X0-OV-08, X0-AMB-41). */
static void judge_limit(sim_x0 *s, bool bad, uint64_t delay, uint64_t *since, uint8_t bit)
{
    if (!bad) {
        *since = X0_NEVER;
        return;
    }
    if (*since == X0_NEVER) {
        *since = s->now;
    }
    if ((s->reg[X0_SYS_CTRL2] & X0_DELAY_DIS) != 0 || s->now - *since >= delay) {
        x0_raise(s, bit);
    }
}

/* A scan that begins now converts a balancing group in short windows (X0-SCH-03, X0-AMB-101). */
static void choose_windows(sim_x0 *s)
{
    s->short_groups = 0;
    for (unsigned g = 0; g < 3u; g++) {
        s->short_groups |= (uint8_t)(s->reg[X0_CELLBAL1 + (int)g] != 0 ? 1u << g : 0u);
    }
}

void x0_publish(sim_x0 *s)
{
    static const uint8_t ov_s[4] = {1, 2, 4, 8}, uv_s[4] = {1, 4, 8, 16};
    unsigned ov_code = 0x2000u + ((unsigned)s->reg[X0_OV_TRIP] << 4) + 8u;
    unsigned uv_code = 0x1000u + ((unsigned)s->reg[X0_UV_TRIP] << 4);
    unsigned sum = 0;
    bool over = false, under = false;
    s->t_scan = s->now + X0_SCAN;
    s->due = 0;
    if (s->frozen || s->zero_boot) {
        return;
    }
    for (int i = 0; i < s->part->cells; i++) {
        unsigned code = cell_code(s, i);
        store(s, X0_VC1_HI + 2 * i, code);
        sum += code;
        over = over || code > ov_code;
        under = under || (code < uv_code && code >= UV_MINQUAL);
    }
    store(s, X0_BAT_HI, (sum + (s->options.amb10_bat_rounds ? 2u : 0u)) / 4u); /* X0-BAT-03 */
    if (s->scans % 8u == 0) {                                                  /* X0-SCH-07 */
        publish_temperatures(s);
    }
    s->scans++;
    judge_limit(s, over, delay_s(s, 4, ov_s), &s->ov_since, X0_OV);
    judge_limit(s, under, delay_s(s, 6, uv_s), &s->uv_since, X0_UV);
    choose_windows(s);
}

/* ADC_EN changed (X0-AMB-16) */
void x0_converter(sim_x0 *s, bool on)
{
    s->ov_since = s->uv_since = X0_NEVER;
    s->scans = 0;
    s->t_scan = on ? s->now + (s->options.amb16_like_boot ? x0_first_scan(s) : X0_SCAN) : X0_NEVER;
    s->due = 0;
    if (on && s->options.amb16_like_boot) {
        memset(&s->reg[X0_VC1_HI], 0, X0_CC_HI - X0_VC1_HI);
        s->t_valid = s->t_scan;
    }
    if (s->now < s->t_valid) { /* nothing was published since the boot */
        s->t_valid = s->t_scan;
    }
    choose_windows(s);
}

/* ---- coulomb counter ---- */

void x0_cc_integrate(sim_x0 *s)
{
    if (s->t_cc_end != X0_NEVER) {
        s->cc_sum += s->sense * (double)(s->now - s->t_cc_mark);
        s->t_cc_mark = s->now;
    }
}

static void cc_begin(sim_x0 *s)
{
    s->cc_sum = 0.0;
    s->t_cc_mark = s->now;
    s->t_cc_end = s->now + X0_SCAN;
    s->due = 0;
}

void x0_cc_result(sim_x0 *s)
{
    double code;
    x0_cc_integrate(s);
    code = s->cc_sum / (double)X0_SCAN * 1e6;
    if (s->options.cc_noise_uv_rms > 0.0) {
        code += x0_gauss(s) * s->options.cc_noise_uv_rms;
    }
    code = floor(code / 8.44 + 0.5) + (s->nibble_shift ? 592.0 : 0.0); /* the field note's 1 A on 5 mohm */
    code = code < -32768.0 ? -32768.0 : code > 32767.0 ? 32767.0 : code;
    if (!s->frozen && !s->zero_boot) {
        store(s, X0_CC_HI, (unsigned)(uint16_t)(int16_t)code);
    }
    if (s->reg[X0_CC_CFG] != 0x19) {
        x0_misuse(s, "X0-CC-10", "coulomb counter used with CC_CFG other than 0x19");
    }
    s->lost_cc += (s->reg[X0_SYS_STAT] & X0_CC_READY) != 0;
    if ((s->reg[X0_SYS_CTRL2] & X0_CC_EN) != 0) {
        cc_begin(s);
    } else {
        s->t_cc_end = X0_NEVER;
        s->due = 0;
        s->reg[X0_SYS_CTRL2] &= (uint8_t)~X0_CC_ONESHOT;
    }
    x0_raise(s, X0_CC_READY);
}

/* SYS_CTRL2 was written: `before` and `wanted` are its old and new contents (X0-CC-04..07, X0-AMB-25,
 * X0-AMB-26). */
void x0_cc_control(sim_x0 *s, uint8_t before, uint8_t wanted)
{
    bool was_on = (before & X0_CC_EN) != 0, on = (wanted & X0_CC_EN) != 0;
    bool was_shot = (before & X0_CC_ONESHOT) != 0, shot = (wanted & X0_CC_ONESHOT) != 0;
    if (on) {
        s->reg[X0_SYS_CTRL2] &= (uint8_t)~X0_CC_ONESHOT;
        if (!was_on) {
            cc_begin(s);
        }
        return;
    }
    if ((was_on && !s->options.amb26_finishes) || (was_shot && !shot)) {
        s->t_cc_end = X0_NEVER;
        s->due = 0;
    }
    if (shot && !was_shot) {
        bool ready = (s->reg[X0_SYS_STAT] & X0_CC_READY) != 0 && !s->options.amb25_ready_ignored;
        if (was_on || ready) {
            s->reg[X0_SYS_CTRL2] &= (uint8_t)~X0_CC_ONESHOT;
        } else {
            cc_begin(s);
        }
    }
}
