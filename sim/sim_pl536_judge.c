/* SPDX-License-Identifier: Apache-2.0 */
/* The judge: what a host does that the datasheet forbids. Packets touched by an injected fault are not
 * judged, nor is what they leave behind in a device until the host had time to notice. */
#include "sim_pl536_internal.h"

void sim_pl_judge(sim_pl *s, const sim_pl_dev *d, const char *id, const char *text)
{
    if (!s->exempt) {
        sim_misuse_add(&s->misuse, s->now, d != NULL ? sim_pl_number(s, d) : 0, id, text);
    }
}

void sim_pl_judge_state(sim_pl *s, const sim_pl_dev *d, const char *id, const char *text)
{
    if (s->now >= d->tainted_until && !d->lost) {
        sim_pl_judge(s, d, id, text);
    }
}

/* ---- packets as the host meant them -------------------------------------------------------------------- */

/* Addresses given before a RESET of the whole stack are stale, wherever that RESET got to. */
static void note_reset(sim_pl *s, const uint8_t *tx, size_t bits)
{
    if (bits >= 24 && tx[0] >> 1 == ADDR_BROADCAST && tx[1] == REG_RESET && tx[2] == 0xa5) {
        s->generation++;
    }
}

/* A reset of all without CRC begins the search for devices whose CRC is off (PL-SEQ-02-11): for a while
 * packets without CRC are no mistake. */
static void note_search(sim_pl *s, const uint8_t *tx, size_t bits)
{
    if (bits == 24 && tx[0] == 0x7f && tx[1] == REG_RESET && tx[2] == 0xa5) {
        s->crc_off_search_until = s->now + 10 * SIM_PL_MS;
    }
}

static void judge_strict(sim_pl *s)
{
    if (s->spi_mode != 1) {
        sim_misuse_add(&s->misuse, s->now, 0, "PL-SPI-01", "SPI mode other than 1");
    }
    if (s->spi_hz < 10000 || s->spi_hz > 1000000) {
        sim_misuse_add(&s->misuse, s->now, 0, "PL-TIM-01", "SPI clock outside 10 kHz..1 MHz");
    }
    if (s->spi_seen && s->now - s->last_packet < 3 * SIM_PL_US) {
        sim_misuse_add(&s->misuse, s->now, 0, "PL-SPI-04", "chip select high for less than 3 us");
    }
}

void sim_pl_judge_host(sim_pl *s, const uint8_t *tx, size_t bits)
{
    s->exempt = false;
    if (s->options.strict_timing) {
        judge_strict(s);
    }
    if (bits < 8) {
        return;
    }
    if ((tx[0] & 0x80) != 0 && sim_bus_fault_idle(&s->fault)) {
        sim_pl_judge(s, NULL, "PL-PKT-01", "bit 7 of the first byte set");
    }
    if ((tx[0] & 1) != 0 && bits >= 16) {
        note_reset(s, tx, bits);
        note_search(s, tx, bits);
    }
}

void sim_pl_judge_timing(sim_pl *s, const sim_pl_spi_timing *t)
{
    if (!s->options.strict_timing) {
        return;
    }
    if (t->duty_percent < 40 || t->duty_percent > 60) {
        sim_misuse_add(&s->misuse, s->now, 0, "PL-TIM-02", "clock duty outside 40..60 %");
    }
    if (t->cs_lead_ns < 50 || t->cs_lag_ns < 10) {
        sim_misuse_add(&s->misuse, s->now, 0, "PL-TIM-03", "chip select too close to the clock");
    }
    if (t->cs_high_ns < 3000) {
        sim_misuse_add(&s->misuse, s->now, 0, "PL-SPI-04", "chip select high for less than 3 us");
    }
    if (t->longest_pause_ns > 100000) {
        sim_misuse_add(&s->misuse, s->now, 0, "PL-AMB-20", "pause of more than 100 us inside a packet");
    }
}

/* ---- reads
 * ------------------------------------------------------------------------------------------------------- */

void sim_pl_judge_read(sim_pl *s, const sim_pl_dev *d, uint8_t first, uint8_t length, size_t bits)
{
    size_t shortest = 8u * (3u + length + ((d->reg[REG_IO_CONFIG] & IOC_CRC_DIS) == 0 ? 1u : 0u));
    /* the search for devices whose CRC is off reads without (PL-SEQ-02-11) */
    bool seeks_crc_off = s->now < s->crc_off_search_until && bits == 8u * (3u + length);

    if (length == 0) {
        sim_pl_judge(s, d, "PL-PKT-12", "read of length 0");
    }
    if (first + (unsigned)length > REG_LAST + 1u) {
        sim_pl_judge(s, d, "PL-PKT-14", "read past 0x4b");
    }
    if (bits != shortest && bits != 8u * (4u + length) && !seeks_crc_off) {
        sim_pl_judge(s, d, "PL-PKT-04", "read packet of wrong length");
    }
    if (d->conv_end != SIM_PL_NEVER && first <= REG_TEMP2 + 1 && first + (unsigned)length > REG_GPAI) {
        sim_pl_judge_state(s, d, "PL-CONV-12", "results read before the conversion is finished");
    }
}

/* ---- writes
 * ------------------------------------------------------------------------------------------------------- */

static void judge_access(sim_pl *s, const sim_pl_dev *d, const sim_pl_reg *r, uint8_t value)
{
    if (r->access == SIM_PL_RESERVED) {
        sim_pl_judge(s, d, "PL-REG-01", "reserved register written");
    } else if (r->access == SIM_PL_R) {
        sim_pl_judge(s, d, "PL-REG-03", "read-only register written");
    } else if ((value & ~(unsigned)sim_pl_reg_legal(s, r)) != 0) {
        bool pin = r->address == REG_IO_CONTROL && (value & 0x38) == IO_GPIO_IN;

        sim_pl_judge(s, d, pin ? "PL-GPIO-06" : "PL-REG-02",
                     pin ? "read-only bit GPIO_IN written as 1" : "reserved bit written as 1");
    }
}

static void judge_address(sim_pl *s, const sim_pl_dev *d, uint8_t value, bool broadcast)
{
    unsigned address = value & ADDR_MASK;

    if (broadcast) {
        sim_pl_judge(s, d, "PL-ADR-15", "ADDRESS_CONTROL written by broadcast");
    }
    if (address == 0 || address == ADDR_BROADCAST) {
        sim_pl_judge(s, d, "PL-ADR-15", "address 0x00 or 0x3f assigned");
        return;
    }
    for (int i = 0; i < s->devices && !broadcast; i++) {
        const sim_pl_dev *other = &s->dev[i];

        if (other != d && sim_pl_is_on(other) && sim_pl_address(other) == address &&
            other->address_generation == s->generation) {
            sim_pl_judge(s, d, "PL-ADR-15", "address already given to another device");
        }
    }
}

static void judge_command(sim_pl *s, const sim_pl_dev *d, uint8_t reg, uint8_t value)
{
    if (reg == REG_SHDW_CTRL && value != 0x35 && value != 0x27 && value != 0x00) {
        sim_pl_judge(s, d, "PL-REG-31", "undefined value written to SHDW_CTRL");
    } else if (reg == REG_RESET && value != 0xa5) {
        sim_pl_judge(s, d, "PL-POR-07", "undefined value written to RESET");
    } else if (reg == REG_E_EN && value != 0x91 && value != 0x00) {
        sim_pl_judge(s, d, "PL-OTP-05", "reserved value written to E_EN");
    } else if (reg == REG_TEST_SELECT && value != 0x00) {
        bool fatal = d == &s->dev[0] && value == 0x25 && d->test_step;

        sim_pl_judge(s, d, fatal ? "PL-TEST-04" : "PL-TEST-03",
                     fatal ? "TEST mode entered on the base device: no SPI until power-on reset"
                           : "TEST_SELECT written");
    }
}

static void judge_group2(sim_pl *s, const sim_pl_dev *d, uint8_t reg, uint8_t value)
{
    if ((reg == REG_ALERT || reg == REG_FAULT) && (value & AL_FORCE) != 0 &&
        (value & ~(unsigned)AL_FORCE) != 0) {
        sim_pl_judge(s, d, "PL-FLT-14", "FORCE set by a clearing mask");
    } else if (reg == REG_ADC_CONTROL && d->conv_end != SIM_PL_NEVER) {
        sim_pl_judge_state(s, d, "PL-CONV-14", "ADC_CONTROL written during a conversion");
    } else if (reg == REG_CB_TIME && d->cb_running && value != d->reg[REG_CB_TIME]) {
        sim_pl_judge_state(s, d, "PL-AMB-85", "CB_TIME changed while balancing");
    } else if (reg == REG_IO_CONTROL && (value & ~(unsigned)d->reg[REG_IO_CONTROL] & IO_SLEEP) != 0 &&
               d->cb_running) {
        sim_pl_judge_state(s, d, "PL-AMB-86", "SLEEP entered while balancing");
    }
}

static unsigned cov_mv(unsigned value)
{
    return 2000 + 50 * (value & 0x3fu);
}

static unsigned cuv_mv(unsigned value)
{
    return 700 + 100 * (value & 0x1fu);
}

static void judge_distance(sim_pl *s, const sim_pl_dev *d, uint8_t reg, uint8_t value)
{
    unsigned cov = reg == REG_COV ? value : d->reg[REG_COV];
    unsigned cuv = reg == REG_CUV ? value : d->reg[REG_CUV];

    if (((cov | cuv) & PROT_DISABLE) == 0 && cov_mv(cov) < cuv_mv(cuv) + 300) {
        sim_pl_judge_state(s, d, "PL-COV-12", "COV threshold less than 300 mV above CUV threshold");
    }
}

static bool illegal_ot(unsigned value)
{
    return (value & 0x0fu) > 11 || (value >> 4) > 11;
}

static void judge_group3(sim_pl *s, const sim_pl_dev *d, uint8_t reg, uint8_t value)
{
    if ((reg == REG_COV && (value & 0x3f) > 0x3c) || (reg == REG_CUV && (value & 0x1f) > 0x1a) ||
        (reg == REG_OT && illegal_ot(value))) {
        sim_pl_judge(s, d, "PL-AMB-45", "illegal threshold code");
    }
    if ((reg == REG_COVT || reg == REG_CUVT) && (value & 0x9f) == 0x80) {
        sim_pl_judge(s, d, "PL-AMB-44", "delay of 0 ms");
    }
    if (reg == REG_COV || reg == REG_CUV) {
        judge_distance(s, d, reg, value);
    }
}

void sim_pl_judge_write(sim_pl *s, const sim_pl_dev *d, uint8_t reg, uint8_t value, bool key, bool broadcast)
{
    const sim_pl_reg *r = sim_pl_reg_at(reg);

    judge_access(s, d, r, value);
    if (r->group == 3 && !key) {
        sim_pl_judge_state(s, d, "PL-G3-02", "group-3 register written without the key");
    } else if (r->group == 3) {
        judge_group3(s, d, reg, value);
    } else if (reg == REG_ADDRESS) {
        judge_address(s, d, value, broadcast);
    } else {
        if (reg == REG_ADC_CONVERT && (value & 1u) != 0 && !broadcast && (d->uvlo || d->tsd)) {
            /* a broadcast may be meant for the others */
            sim_pl_judge_state(s, d, "PL-AMB-70", "conversion started in UVLO or TSD");
        }
        judge_group2(s, d, reg, value);
        judge_command(s, d, reg, value);
    }
}
