/* SPDX-License-Identifier: Apache-2.0 */
/* The host pins of the base device (PL-FLT-07, PL-ALT-01, PL-DRDY-02) and their recording. */
#include "sim_pl536_internal.h"
#include "sim_vcd.h"

enum { SIG_CS, SIG_SCLK, SIG_SDI, SIG_SDO, SIG_CONV, SIG_DRDY, SIG_FAULT, SIG_ALERT };

/* In SLEEP and TSD only ALERT[SLEEP] reaches a pin (PL-SLEEP-03, PL-AMB-91). */
static bool own_fault(const sim_pl *s, const sim_pl_dev *d)
{
    unsigned flags = d->reg[REG_FAULT] & FA_ALL;

    if (s->options.variant_a && (d->reg[REG_IO_CONFIG] & IOC_CRCNOFLT) != 0) {
        flags &= ~(unsigned)FA_CRC;
    }
    return flags != 0 && !d->asleep && !d->tsd;
}

static bool own_alert(const sim_pl *s, const sim_pl_dev *d)
{
    if (d->asleep || d->tsd) {
        return (d->reg[REG_ALERT] & AL_SLEEP) != 0;
    }
    return (d->reg[REG_STATUS] & ST_ALERT) != 0 ||
           (s->options.amb01_crc_alert && (d->reg[REG_FAULT] & FA_CRC) != 0);
}

/* True while what comes from above device index i gets through it. */
static bool passes(const sim_pl *s, int i)
{
    return i + 1 < s->devices && !sim_pl_link_down(s, i);
}

bool sim_pl_fault_pin(const sim_pl *s)
{
    for (int i = 0; i < s->devices && sim_pl_is_on(&s->dev[i]); i++) {
        if (own_fault(s, &s->dev[i])) {
            return true;
        }
        if (!passes(s, i)) {
            break;
        }
    }
    return false;
}

bool sim_pl_alert_pin(const sim_pl *s)
{
    for (int i = 0; i < s->devices && sim_pl_is_on(&s->dev[i]); i++) {
        if (own_alert(s, &s->dev[i])) {
            return true;
        }
        if (!passes(s, i)) {
            break;
        }
    }
    return false;
}

/* All devices must be ready, and a link or device that is dead blocks it (PL-AMB-79). */
bool sim_pl_drdy_pin(const sim_pl *s)
{
    int last = s->options.amb79_drdy_base_only ? 1 : s->devices;

    for (int i = 0; i < last; i++) {
        if (!sim_pl_is_on(&s->dev[i]) || !s->dev[i].drdy || (i + 1 < last && sim_pl_link_down(s, i))) {
            return false;
        }
    }
    return true;
}

/* ---- waveform
 * ------------------------------------------------------------------------------------------------ */

void sim_pl_record(sim_pl *s, struct sim_vcd *vcd)
{
    static const char *const name[8] = {"CS", "SCLK", "SDI", "SDO", "CONV", "DRDY", "FAULT", "ALERT"};
    int initial[8] = {1, 0, 0, -1, 0, 0, 0, 0};

    s->vcd = vcd;
    if (vcd == NULL) {
        return;
    }
    initial[SIG_CONV] = s->conv;
    initial[SIG_DRDY] = sim_pl_drdy_pin(s);
    initial[SIG_FAULT] = sim_pl_fault_pin(s);
    initial[SIG_ALERT] = sim_pl_alert_pin(s);
    s->vcd_time = s->vcd_free = s->now > vcd->now ? s->now : vcd->now;
    for (int i = 0; i < 8; i++) {
        s->vcd_signal[i] = sim_vcd_signal(vcd, name[i], initial[i]);
    }
    sim_pl_pins_record(s); /* another stack may have left other levels in the same file */
}

static void show(sim_pl *s, int signal, uint64_t at, int level)
{
    sim_vcd_set(s->vcd, s->vcd_signal[signal], at, level);
}

void sim_pl_pins_record(sim_pl *s)
{
    if (s->vcd == NULL) {
        return;
    }
    if (s->now > s->vcd_time) {
        s->vcd_time = s->now;
    }
    show(s, SIG_CONV, s->vcd_time, s->conv);
    show(s, SIG_DRDY, s->vcd_time, sim_pl_drdy_pin(s));
    show(s, SIG_FAULT, s->vcd_time, sim_pl_fault_pin(s));
    show(s, SIG_ALERT, s->vcd_time, sim_pl_alert_pin(s));
}

static int bit_at(const uint8_t *bytes, size_t bit)
{
    return bytes[bit / 8] >> (7 - bit % 8) & 1;
}

/* Mode 1: both sides change data on the rising edge and sample on the falling one (PL-SPI-01). The packet
 * takes its time in the waveform only; packets that would overlap follow each other with 3 us between them.
 */
void sim_pl_record_packet(sim_pl *s, const uint8_t *tx, const uint8_t *rx, size_t bits)
{
    uint64_t half = 500000000ull / s->spi_hz;
    uint64_t at = s->now > s->vcd_free ? s->now : s->vcd_free;

    show(s, SIG_CS, at, 0);
    show(s, SIG_SDO, at, s->options.amb12_idle_ff);
    for (size_t i = 0; i < bits; i++) {
        at += half;
        show(s, SIG_SCLK, at, 1);
        show(s, SIG_SDI, at, bit_at(tx, i));
        show(s, SIG_SDO, at, bit_at(rx, i));
        at += half;
        show(s, SIG_SCLK, at, 0);
    }
    at += half;
    show(s, SIG_SDI, at, 0);
    show(s, SIG_SDO, at, -1);
    show(s, SIG_CS, at, 1);
    s->vcd_time = at;
    s->vcd_free = at + 3 * SIM_PL_US;
}

void sim_pl_record_select(sim_pl *s, bool low)
{
    if (s->vcd == NULL) {
        return;
    }
    s->vcd_time = s->vcd_time > s->now ? s->vcd_time : s->now;
    show(s, SIG_SDI, s->vcd_time, 0);
    show(s, SIG_SDO, s->vcd_time, low ? (int)s->options.amb12_idle_ff : -1);
    show(s, SIG_CS, s->vcd_time, !low);
}

void sim_pl_record_byte(sim_pl *s, uint8_t tx, uint8_t rx)
{
    uint64_t half = 500000000ull / s->spi_hz, length = 16 * half;
    uint64_t at = s->now > length ? s->now - length : 0;

    for (size_t i = 0; i < 8 && s->vcd != NULL; i++) {
        show(s, SIG_SCLK, at, 1);
        show(s, SIG_SDI, at, bit_at(&tx, i));
        show(s, SIG_SDO, at, bit_at(&rx, i));
        at += half;
        show(s, SIG_SCLK, at, 0);
        at += half;
    }
}
