/* SPDX-License-Identifier: Apache-2.0 */
/* Register table and register accesses of the bq769x0 model (X0-REG, X0-BIT), with the judge of each access.
 */
#include "sim_x0_internal.h"
#include <stddef.h>

/* One row per writable register. keep: bits that store; reserved: stored but a non-zero write is misuse
 * (X0-BIT-02). */
typedef struct x0_row {
    uint8_t keep, reserved, min_cells;
    const char *id;
} x0_row;

static const x0_row row[0x0c] = {
    [0x00] = {0x00, 0x40, 5, "X0-REG-00"},  [0x01] = {0x1f, 0xe0, 5, "X0-REG-01"},
    [0x02] = {0x1f, 0xe0, 10, "X0-REG-02"}, [0x03] = {0x1f, 0xe0, 15, "X0-REG-03"},
    [0x04] = {0x1f, 0x64, 5, "X0-REG-04"},  [0x05] = {0xff, 0x1c, 5, "X0-REG-05"},
    [0x06] = {0xbf, 0x60, 5, "X0-REG-06"},  [0x07] = {0x7f, 0x80, 5, "X0-REG-07"},
    [0x08] = {0xff, 0x0f, 5, "X0-REG-08"},  [0x09] = {0xff, 0x00, 5, "X0-REG-09"},
    [0x0a] = {0xff, 0x00, 5, "X0-REG-0A"},  [0x0b] = {0x3f, 0xc0, 5, "X0-REG-0B"},
};

static uint8_t gain_code(const sim_x0 *s)
{
    return (uint8_t)(s->gain_uv - 365);
}

uint8_t sim_x0_peek(const sim_x0 *s, uint8_t reg)
{
    if (s->mode == SIM_X0_OFF || s->mode == SIM_X0_SHIP || s->zero_boot) {
        return 0;
    }
    switch (reg) {
    case X0_SYS_CTRL1: {
        bool load = s->mode == SIM_X0_NORMAL && !sim_x0_chg(s) && s->chgpin > 0.7; /* X0-LOAD-01 */
        uint8_t shown = s->options.amb72_shut_reads_0 ? s->reg[reg] & 0xfcu : s->reg[reg];
        return (uint8_t)(shown | (load ? 0x80u : 0u));
    }
    case X0_GAIN1:
        return (uint8_t)(((unsigned)gain_code(s) >> 1 & 0x0cu) | (s->rsvd50 & 0xf3u));
    case X0_GAIN2:
        return (uint8_t)(((unsigned)gain_code(s) << 5 & 0xe0u) | (s->rsvd59 & 0x1fu));
    case X0_OFFSET:
        return (uint8_t)(int8_t)s->offset_mv;
    default:
        return reg < X0_CC_LO + 1 ? s->reg[reg] : 0;
    }
}

/* Reads before the first scan of NORMAL, and low halves without their high half, are the host's mistakes. */
void x0_judge_read(sim_x0 *s, uint8_t reg, bool high_before)
{
    bool completed =
        reg > X0_VC1_HI && reg < X0_CC_HI && (reg & 1u) != 0; /* a high half alone is no measurement */
    if (completed && s->mode == SIM_X0_NORMAL && s->now < s->t_valid) {
        x0_misuse(s, "X0-ADC-14", "measurement read before the first scan after boot");
    }
    if (reg >= X0_VC1_HI && reg <= X0_CC_LO && (reg & 1u) != 0 && !high_before) {
        x0_misuse(s, "X0-I2C-21", "low half read without its high half in the same transaction");
    }
}

uint8_t x0_read(sim_x0 *s, uint8_t reg)
{
    uint8_t value = sim_x0_peek(s, reg);
    if (reg == X0_SYS_STAT) {
        s->stat_seen = s->i2c.damaged ? 0xff : value; /* what a disturbed host saw is unknown */
    }
    if (reg == X0_PROTECT3 && s->options.field_nibble_offset && s->nibble_armed) {
        s->nibble_shift = true;
    }
    return value;
}

static void write_stat(sim_x0 *s, uint8_t value)
{
    uint8_t now_set = s->raised_at == s->now ? (uint8_t)(s->raised & ~s->stat_seen) : 0; /* X0-BIT-08 */
    uint8_t clear = (uint8_t)(value & 0xbfu & s->reg[X0_SYS_STAT] & ~now_set);
    if ((value & 0xbfu & ~s->stat_seen) != 0) {
        x0_misuse(s, "X0-BIT-09", "status bit cleared that was not read as set");
    }
    s->reg[X0_SYS_STAT] &= (uint8_t)~clear;
    s->stat_seen &= (uint8_t)~value;
    if ((clear & X0_OCD) != 0 && !s->options.amb43_at_once) {
        s->ocd_since = X0_NEVER; /* X0-AMB-43: the whole delay again */
    }
    if ((clear & X0_SCD) != 0 && !s->options.amb43_at_once) {
        s->scd_since = X0_NEVER;
    }
    if (s->options.amb42_full_delay) {
        s->ov_since = (clear & X0_OV) != 0 ? X0_NEVER : s->ov_since;
        s->uv_since = (clear & X0_UV) != 0 ? X0_NEVER : s->uv_since;
    }
    x0_overcurrent(s);
    x0_alert_check(s, false);
}

static void write_ctrl1(sim_x0 *s, uint8_t value)
{
    uint8_t before = s->reg[X0_SYS_CTRL1], pattern = value & 3u;
    bool armed = s->ship_armed;
    s->reg[X0_SYS_CTRL1] = value & 0x1fu;
    s->ship_armed = pattern == 1u &&
                    (s->options.amb71_needs_00 ? (before & 3u) == 0u : (before & 3u) != 1u); /* X0-MODE-11 */
    if (armed && pattern == 2u) {
        x0_enter_ship(s);
        return;
    }
    if (((before ^ value) & X0_ADC_EN) != 0) {
        x0_converter(s, (value & X0_ADC_EN) != 0);
    }
    if ((value & X0_ADC_EN) == 0 && (s->reg[X0_SYS_CTRL2] & 3u) != 0) {
        x0_misuse(s, "X0-AMB-15", "ADC switched off with a FET on");
    }
}

static void write_ctrl2(sim_x0 *s, uint8_t value)
{
    uint8_t before = s->reg[X0_SYS_CTRL2], stat = s->reg[X0_SYS_STAT], held = 0;
    if (!s->options.amb50_write_sticks) { /* X0-FET-10 */
        held |= (stat & (X0_OV | X0_OVRD | X0_XREADY)) != 0 ? X0_CHG_ON : 0;
        held |= (stat & (X0_UV | X0_OCD | X0_SCD | X0_OVRD | X0_XREADY)) != 0 ? X0_DSG_ON : 0;
    }
    s->reg[X0_SYS_CTRL2] = (uint8_t)(value & ~held);
    x0_cc_control(s, before, value);
    x0_overcurrent(s);
}

static void write_protect3(sim_x0 *s, uint8_t value)
{
    if ((s->reg[X0_PROTECT3] & 0x0fu) != 0 && (value & 0x0fu) == 0) {
        s->nibble_armed = true;
    }
    s->reg[X0_PROTECT3] = value;
}

static void judge_write(sim_x0 *s, uint8_t reg, uint8_t value)
{
    if (reg >= 0x0c || row[reg].id == NULL) {
        bool read_only = reg <= X0_CC_LO || reg == X0_GAIN1 || reg == X0_OFFSET || reg == X0_GAIN2;
        x0_misuse(s, read_only ? "X0-AMB-86" : "X0-AMB-84",
                  read_only ? "write to a read-only register" : "write to an address that is not described");
    } else if (s->part->cells < row[reg].min_cells) {
        x0_misuse(s, "X0-AMB-85", "write to a register this size does not have");
    } else {
        uint8_t wanted = reg == X0_PROTECT3 && s->options.amb88_nibble_reads_8 ? 0x08 : 0x00;
        if ((value & row[reg].reserved) != wanted) {
            x0_misuse(s, row[reg].id, "reserved bits not written as they come up");
        }
    }
}

bool x0_write(sim_x0 *s, uint8_t reg, uint8_t value)
{
    if (s->mode == SIM_X0_BOOT) {
        x0_misuse(s, "X0-MODE-09", "write before the boot is complete is lost");
        return true;
    }
    judge_write(s, reg, value);
    if (reg != X0_SYS_CTRL1) {
        s->ship_armed = false;
    }
    if (reg >= 0x0c || s->part->cells < row[reg].min_cells || s->zero_boot) {
        if (!(reg == X0_SYS_CTRL1 && s->zero_boot)) {
            return reg < 0x0c || !s->options.amb86_nack;
        }
    }
    switch (reg) {
    case X0_SYS_STAT:
        write_stat(s, value);
        break;
    case X0_SYS_CTRL1:
        write_ctrl1(s, value);
        break;
    case X0_SYS_CTRL2:
        write_ctrl2(s, value);
        break;
    case X0_PROTECT3:
        write_protect3(s, value);
        break;
    default:
        s->reg[reg] = value & row[reg].keep;
        if (reg >= X0_CELLBAL1 && reg <= X0_CELLBAL3) {
            x0_judge_balance(s, reg - X0_CELLBAL1);
        } else if (reg == X0_PROTECT1 || reg == X0_PROTECT2) {
            x0_overcurrent(s);
        }
        break;
    }
    return true;
}
