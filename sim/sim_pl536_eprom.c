/* SPDX-License-Identifier: Apache-2.0 */
/* Group 3: load from EPROM with error correction, parity of the RAM copy, and the one programming run (PL-G3,
 * PL-ECC, PL-OTP). The ECC is kept as the set of bits that no longer hold what was programmed: one is
 * corrected, more are detected. */
#include "sim_pl536_internal.h"
#include <string.h>

#define PROGRAM_TIME (1500 * SIM_PL_US)
#define VPP_LIMIT (50 * SIM_PL_MS)
#define VBAT_MIN 20.0

static unsigned ones(unsigned x)
{
    unsigned n = 0;

    for (; x != 0; x &= x - 1) {
        n++;
    }
    return n;
}

/* ---- parity
 * --------------------------------------------------------------------------------------------------- */

static void show_parity(sim_pl_dev *d)
{
    unsigned wrong = 0;

    for (unsigned i = 0; i < SIM_PL_GROUP3; i++) {
        wrong |= ((ones(d->reg[REG_FUNCTION + i]) ^ (unsigned)(d->parity_bits >> i)) & 1u) << i;
    }
    d->reg[REG_PRESULT_A] = (uint8_t)(wrong & 0xff);
    d->reg[REG_PRESULT_B] = (uint8_t)(wrong >> 8);
}

void sim_pl_parity_store(sim_pl_dev *d, int index)
{
    unsigned bit = 1u << index;
    unsigned odd = ones(d->reg[REG_FUNCTION + index]) & 1u;

    d->parity_bits = (uint16_t)((d->parity_bits & ~bit) | (odd != 0 ? bit : 0u));
    show_parity(d);
}

void sim_pl_parity_check(sim_pl_dev *d)
{
    show_parity(d);
    if ((d->reg[REG_PRESULT_A] | d->reg[REG_PRESULT_B]) != 0) {
        sim_pl_alert_set(d, AL_PARITY);
    }
}

/* ---- load
 * ------------------------------------------------------------------------------------------------------ */

void sim_pl_eprom_load(sim_pl *s, sim_pl_dev *d)
{
    bool corrected = false, lost = false;

    for (int i = 0; i < SIM_PL_GROUP3; i++) {
        const sim_pl_reg *r = sim_pl_reg_at((uint8_t)(REG_FUNCTION + i));
        unsigned damaged = ones(d->otp_damage[i]);
        uint8_t value = damaged > 1 ? d->otp[i] ^ d->otp_damage[i] : d->otp[i];

        corrected = corrected || damaged == 1;
        lost = lost || damaged > 1;
        d->reg[REG_FUNCTION + i] = value & sim_pl_reg_keep(s, r);
        sim_pl_parity_store(d, i);
    }
    d->reg[REG_STATUS] =
        (uint8_t)((d->reg[REG_STATUS] & ~(unsigned)ST_ECC_COR) | (corrected ? ST_ECC_COR : 0u));
    if (lost) {
        sim_pl_alert_set(d, AL_ECC_ERR);
        sim_pl_fault_set(d, s->options.amb49_no_ifault ? 0 : FA_I_FAULT);
    }
    sim_pl_protect_config(s, d);
}

/* ---- programming
 * ------------------------------------------------------------------------------------------------ */

void sim_pl_do_e_en(sim_pl *s, sim_pl_dev *d, uint8_t value)
{
    if (value != 0x91) {
        return;
    }
    if (!d->vpp) {
        sim_pl_judge(s, d, "PL-OTP-04", "programming started without the programming voltage");
    } else if (sim_pl_brick(d) < VBAT_MIN - SIM_PL_EPS) {
        sim_pl_judge(s, d, "PL-OTP-03", "programming started with VBAT below 20 V");
    } else if (d->programmed) {
        sim_pl_judge(s, d, "PL-OTP-12", "second programming run refused");
    } else {
        memcpy(d->image, &d->reg[REG_FUNCTION], sizeof d->image);
        d->prog_end = s->now + PROGRAM_TIME;
    }
}

/* Any read or write of the device closes the window (PL-OTP-05); the run is not completed. */
void sim_pl_eprom_access(sim_pl *s, sim_pl_dev *d)
{
    if (d->prog_end != SIM_PL_NEVER) {
        d->prog_end = SIM_PL_NEVER;
        sim_pl_judge(s, d, "PL-OTP-05", "access during programming");
        sim_pl_touch(s, d);
    }
}

void sim_pl_eprom_due(sim_pl *s, sim_pl_dev *d)
{
    if (d->prog_end <= s->now) {
        d->prog_end = SIM_PL_NEVER;
        d->programmed = true;
        for (int i = 0; i < SIM_PL_GROUP3; i++) {
            d->otp[i] = (uint8_t)((d->otp[i] ^ d->otp_damage[i]) | d->image[i]);
            d->otp_damage[i] = 0;
        }
    }
    if (d->vpp_limit <= s->now) {
        d->vpp_limit = SIM_PL_NEVER;
        sim_misuse_add(&s->misuse, s->now, sim_pl_number(s, d), "PL-AMB-105",
                       "programming voltage applied for more than 50 ms");
    }
}

/* ---- world
 * ------------------------------------------------------------------------------------------------------- */

static sim_pl_dev *device_at(sim_pl *s, int device)
{
    return device >= 1 && device <= s->devices ? &s->dev[device - 1] : NULL;
}

static bool in_group3(uint8_t reg)
{
    return reg >= REG_FUNCTION && reg <= REG_LAST;
}

int sim_pl_set_otp(sim_pl *s, int device, uint8_t reg, uint8_t value)
{
    sim_pl_dev *d = device_at(s, device);

    if (d == NULL || !in_group3(reg)) {
        return -1;
    }
    d->otp[reg - REG_FUNCTION] = value;
    d->otp_damage[reg - REG_FUNCTION] = 0;
    return 0;
}

uint8_t sim_pl_otp(const sim_pl *s, int device, uint8_t reg)
{
    if (device < 1 || device > s->devices || !in_group3(reg)) {
        return 0;
    }
    return s->dev[device - 1].otp[reg - REG_FUNCTION] ^ s->dev[device - 1].otp_damage[reg - REG_FUNCTION];
}

int sim_pl_damage_otp(sim_pl *s, int device, uint8_t reg, uint8_t bits)
{
    sim_pl_dev *d = device_at(s, device);

    if (d == NULL || !in_group3(reg)) {
        return -1;
    }
    d->otp_damage[reg - REG_FUNCTION] ^= bits;
    return 0;
}

int sim_pl_damage_ram(sim_pl *s, int device, uint8_t reg, uint8_t bits)
{
    sim_pl_dev *d = device_at(s, device);

    if (d == NULL || !in_group3(reg)) {
        return -1;
    }
    if (sim_pl_is_on(d)) {
        d->reg[reg] ^= bits;
        sim_pl_parity_check(d);
        sim_pl_protect_config(s, d);
        sim_pl_touch(s, d);
        sim_pl_pins_record(s);
    }
    return 0;
}

int sim_pl_set_vpp(sim_pl *s, int device, bool on)
{
    sim_pl_dev *d = device_at(s, device);

    if (d == NULL) {
        return -1;
    }
    if (on && !d->vpp) {
        d->vpp_limit = s->now + VPP_LIMIT + 1;
    } else if (!on) {
        d->vpp_limit = SIM_PL_NEVER;
    }
    if (!on && d->prog_end != SIM_PL_NEVER) {
        d->prog_end = SIM_PL_NEVER;
        sim_misuse_add(&s->misuse, s->now, device, "PL-OTP-06", "programming voltage removed before 1.5 ms");
    }
    d->vpp = on;
    sim_pl_touch(s, d);
    return 0;
}

bool sim_pl_vpp(const sim_pl *s, int device)
{
    return device >= 1 && device <= s->devices && s->dev[device - 1].vpp;
}
