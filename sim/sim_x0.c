/* SPDX-License-Identifier: Apache-2.0 */
/* Life, power modes and time of the bq769x0 model (X0-MODE, X0-VAR). */
#include "sim_x0_internal.h"
#include <math.h>
#include <string.h>

static const sim_x0_part parts[] = {
    {"bq7692000", 5, 0x08, false, 2500},  {"bq7692001", 5, 0x08, true, 2500},
    {"bq7692002", 5, 0x08, false, 3300},  {"bq7692003", 5, 0x08, true, 3300},
    {"bq7692006", 5, 0x18, false, 3300},  {"bq7693000", 10, 0x08, false, 2500},
    {"bq7693001", 10, 0x08, true, 2500},  {"bq7693002", 10, 0x08, false, 3300},
    {"bq7693003", 10, 0x08, true, 3300},  {"bq7693006", 10, 0x18, false, 3300},
    {"bq7694000", 15, 0x08, false, 2500}, {"bq7694001", 15, 0x08, true, 2500},
    {"bq7694002", 15, 0x08, false, 3300}, {"bq7694003", 15, 0x08, true, 3300},
    {"bq7694006", 15, 0x18, false, 3300},
};
#define PART_COUNT ((int)(sizeof parts / sizeof parts[0]))

const sim_x0_part *sim_x0_part_at(int n)
{
    return n >= 0 && n < PART_COUNT ? &parts[n] : NULL;
}

const sim_x0_part *sim_x0_find_part(const char *name)
{
    for (int i = 0; name != NULL && i < PART_COUNT; i++) {
        if (strcmp(parts[i].name, name) == 0) {
            return &parts[i];
        }
    }
    return NULL;
}

void x0_misuse(sim_x0 *s, const char *id, const char *text)
{
    if (!s->i2c.damaged) {
        sim_misuse_add(&s->misuse, s->now, 1, id, text);
    }
}

sim_misuse *sim_x0_misuse(sim_x0 *s)
{
    return &s->misuse;
}

/* xorshift64*, 0..1: good enough for noise, repeatable everywhere */
double x0_uniform(sim_x0 *s)
{
    s->rng ^= s->rng >> 12;
    s->rng ^= s->rng << 25;
    s->rng ^= s->rng >> 27;
    return (double)((s->rng * 2685821657736338717ull) >> 11) / 9007199254740992.0;
}

double x0_gauss(sim_x0 *s)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++) {
        sum += x0_uniform(s);
    }
    return sum;
}

/* X0-MODE-07: what every entry to NORMAL loads */
void x0_defaults(sim_x0 *s, uint8_t ctrl1)
{
    memset(s->reg, 0, sizeof s->reg);
    s->reg[X0_SYS_CTRL1] = ctrl1;
    s->reg[X0_OV_TRIP] = 0xac;
    s->reg[X0_UV_TRIP] = 0x97;
    if (s->options.amb88_nibble_reads_8) {
        s->reg[X0_PROTECT3] = 0x08;
    }
    s->i2c.pointer = 0;
    s->ov_since = s->uv_since = s->ocd_since = s->scd_since = X0_NEVER;
    s->t_scan = s->t_cc_end = X0_NEVER;
    s->scans = 0;
    s->t_valid = X0_NEVER;
    s->ship_armed = s->nibble_shift = s->nibble_armed = false;
    s->stat_seen = s->raised = s->short_groups = 0;
    s->due = 0;
}

void x0_enter_ship(sim_x0 *s)
{
    x0_defaults(s, 0x00);
    s->mode = SIM_X0_SHIP;
    s->zero_boot = false;
    s->t_ship = s->now;
    s->t_i2c = s->t_normal = X0_NEVER;
}

/* X0-ADC-14 */
uint64_t x0_first_scan(const sim_x0 *s)
{
    static const uint64_t first_ms[] = {250, 400, 800};
    return first_ms[s->part->cells / 5 - 1] * X0_MS;
}

void x0_enter_normal(sim_x0 *s)
{
    x0_defaults(s, X0_ADC_EN);
    s->mode = SIM_X0_NORMAL;
    s->t_normal = X0_NEVER;
    s->t_scan = s->t_valid = s->now + x0_first_scan(s);
    if (s->options.field_zero_boot) {
        s->zero_boot = true;
        s->options.field_zero_boot = false;
    }
    x0_overcurrent(s);
    x0_alert_check(s, true);
}

int sim_x0_init(sim_x0 *s, const sim_x0_part *part, const sim_x0_options *options)
{
    if (s == NULL || part == NULL) {
        return -1;
    }
    memset(s, 0, sizeof *s);
    s->part = part;
    if (options != NULL) {
        s->options = *options;
    }
    s->rng = 0x9e3779b97f4a7c15ull ^ s->options.seed;
    for (int i = 0; i < part->cells; i++) {
        s->cell[i] = 3.600;
    }
    for (int i = 0; i < SIM_X0_SENSORS; i++) {
        s->ts_ohm[i] = 10000.0;
    }
    s->tdie = 25.0;
    s->gain_uv = 382;
    s->supply = true;
    s->i2c.scl = s->i2c.sda = true;
    x0_enter_ship(s);
    return 0;
}

int sim_x0_set_supply(sim_x0 *s, bool on)
{
    if (on == s->supply) {
        return 0;
    }
    s->supply = on;
    x0_enter_ship(s); /* X0-MODE-02: back in SHIP, never in NORMAL */
    s->mode = on ? SIM_X0_SHIP : SIM_X0_OFF;
    s->i2c.state = 0;
    x0_record_pins(s);
    return 0;
}

/* X0-MODE-05, X0-MODE-06: times count from the rise. A pulse that is just over may have outlasted them; one
 * that rose before SHIP was entered is no pulse (X0-AMB-75). */
static int boot_from(sim_x0 *s, uint64_t rise, uint64_t pulse_ns)
{
    if (s->mode == SIM_X0_SHIP && rise >= s->t_ship && pulse_ns >= 2 * X0_MS) {
        s->mode = SIM_X0_BOOT;
        s->due = 0;
        s->t_normal = rise + 10 * X0_MS > s->now ? rise + 10 * X0_MS : s->now;
        s->t_i2c = s->options.amb69_i2c_at_boot ? s->t_normal : rise + 1 * X0_MS;
    }
    return 0;
}

int sim_x0_boot(sim_x0 *s, uint64_t pulse_ns)
{
    return boot_from(s, s->now, pulse_ns);
}

int sim_x0_boot_ended(sim_x0 *s, uint64_t rise_ns)
{
    return rise_ns <= s->now ? boot_from(s, rise_ns, s->now - rise_ns) : -1;
}

static uint64_t next_time(const sim_x0 *s)
{
    uint64_t t = s->t_normal;
    uint64_t oc = x0_overcurrent_due(s);
    t = s->t_scan < t ? s->t_scan : t;
    t = s->t_cc_end < t ? s->t_cc_end : t;
    return oc < t ? oc : t;
}

uint64_t sim_x0_next_event(const sim_x0 *s)
{
    uint64_t t = next_time(s);
    return t == X0_NEVER ? X0_NEVER : t - s->now;
}

/* Whatever can move the next event sets `due` to 0, so that calls between events cost nothing. */
void sim_x0_advance(sim_x0 *s, uint64_t ns)
{
    uint64_t end = s->now + ns;
    if (s->due > end) {
        s->now = end;
        return;
    }
    for (uint64_t t = next_time(s); t <= end; t = next_time(s)) {
        s->now = t;
        if (s->t_normal == t) {
            x0_enter_normal(s);
        } else if (x0_overcurrent_due(s) == t) {
            x0_overcurrent(s);
        } else if (s->t_cc_end == t) {
            x0_cc_result(s);
        } else {
            x0_publish(s);
        }
        x0_record_pins(s);
    }
    s->due = next_time(s);
    s->now = end;
}

/* ---- world inputs ---- */

int sim_x0_set_cell(sim_x0 *s, int input, double volts)
{
    if (input < 1 || input > s->part->cells || !isfinite(volts)) {
        return -1;
    }
    s->cell[input - 1] = volts;
    return 0;
}

int sim_x0_set_ts(sim_x0 *s, int sensor, double ohms)
{
    if (sensor < 1 || sensor > s->part->cells / 5 || !(ohms >= 0.0)) {
        return -1;
    }
    s->ts_ohm[sensor - 1] = ohms;
    return 0;
}

int sim_x0_set_tdie(sim_x0 *s, double celsius)
{
    if (!isfinite(celsius)) {
        return -1;
    }
    s->tdie = celsius;
    return 0;
}

int sim_x0_set_sense(sim_x0 *s, double volts)
{
    if (!isfinite(volts)) {
        return -1;
    }
    x0_cc_integrate(s);
    s->sense = volts;
    x0_overcurrent(s);
    x0_record_pins(s);
    return 0;
}

int sim_x0_set_chgpin(sim_x0 *s, double volts)
{
    if (!isfinite(volts)) {
        return -1;
    }
    s->chgpin = volts;
    return 0;
}

int sim_x0_set_alert_ext(sim_x0 *s, bool level)
{
    bool rising = level && !s->alert_ext;
    s->alert_ext = level;
    x0_alert_check(s, rising);
    x0_record_pins(s);
    return 0;
}

int sim_x0_set_gain(sim_x0 *s, int gain_uv)
{
    if (gain_uv < 365 || gain_uv > 396) {
        return -1;
    }
    s->gain_uv = gain_uv;
    return 0;
}

int sim_x0_set_offset(sim_x0 *s, int offset_mv)
{
    if (offset_mv < -128 || offset_mv > 127) {
        return -1;
    }
    s->offset_mv = offset_mv;
    return 0;
}

int sim_x0_strike_xready(sim_x0 *s)
{
    if (s->mode != SIM_X0_NORMAL) {
        return -1;
    }
    x0_raise(s, X0_XREADY);
    x0_record_pins(s);
    return 0;
}

void sim_x0_freeze(sim_x0 *s, bool frozen)
{
    s->frozen = frozen;
}
