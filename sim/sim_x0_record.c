/* SPDX-License-Identifier: Apache-2.0 */
/* Waveform of the bq769x0 model: SCL, SDA, ALERT, CHG, DSG. */
#include "sim_vcd.h"
#include "sim_x0_internal.h"

#define QUARTER 2500u /* of a bit at 100 kHz, ns */

enum { SIG_SCL, SIG_SDA, SIG_ALERT, SIG_CHG, SIG_DSG };

static void show(sim_x0 *s, int signal, bool level)
{
    sim_vcd_set(s->vcd, s->vcd_signal[signal], s->vcd_time, level);
}

static void catch_up(sim_x0 *s)
{
    if (s->now > s->vcd_time) {
        s->vcd_time = s->now;
    }
}

void sim_x0_record(sim_x0 *s, struct sim_vcd *vcd)
{
    static const char *const name[5] = {"SCL", "SDA", "ALERT", "CHG", "DSG"};
    const bool initial[5] = {s->i2c.scl, s->i2c.sda, sim_x0_alert(s), sim_x0_chg(s), sim_x0_dsg(s)};
    s->vcd = vcd;
    if (vcd == NULL) {
        return;
    }
    s->vcd_time = s->now > vcd->now ? s->now : vcd->now;
    for (int i = 0; i < 5; i++) {
        s->vcd_signal[i] = sim_vcd_signal(vcd, name[i], initial[i]);
        show(s, i, initial[i]); /* another part may have left other levels in the same file */
    }
}

void x0_record_pins(sim_x0 *s)
{
    if (s->vcd != NULL) {
        catch_up(s);
        show(s, SIG_ALERT, sim_x0_alert(s));
        show(s, SIG_CHG, sim_x0_chg(s));
        show(s, SIG_DSG, sim_x0_dsg(s));
    }
}

void x0_record_lines(sim_x0 *s, bool scl, bool sda)
{
    if (s->vcd != NULL) {
        x0_record_pins(s);
        show(s, SIG_SCL, scl);
        show(s, SIG_SDA, sda);
    }
}

static void step(sim_x0 *s, int signal, bool level)
{
    s->vcd_time += QUARTER;
    show(s, signal, level);
}

/* The clock is low before and after each bit; SDA changes in the middle of the low half. */
static void one_bit(sim_x0 *s, bool sda)
{
    step(s, SIG_SDA, sda);
    step(s, SIG_SCL, true);
    s->vcd_time += QUARTER;
    step(s, SIG_SCL, false);
}

void x0_record_byte(sim_x0 *s, uint8_t byte, bool ack)
{
    if (s->vcd == NULL) {
        return;
    }
    catch_up(s);
    for (unsigned i = 8; i-- > 0u;) {
        one_bit(s, ((unsigned)byte >> i & 1u) != 0);
    }
    one_bit(s, !ack);
    x0_record_pins(s);
}

void x0_record_start(sim_x0 *s)
{
    if (s->vcd == NULL) {
        return;
    }
    catch_up(s);
    s->vcd_time += 2u * QUARTER; /* bus free */
    step(s, SIG_SDA, true);
    step(s, SIG_SCL, true);
    s->vcd_time += QUARTER;
    step(s, SIG_SDA, false);
    s->vcd_time += QUARTER;
    step(s, SIG_SCL, false);
}

void x0_record_stop(sim_x0 *s)
{
    if (s->vcd == NULL) {
        return;
    }
    catch_up(s);
    step(s, SIG_SDA, false);
    step(s, SIG_SCL, true);
    s->vcd_time += QUARTER;
    step(s, SIG_SDA, true);
}
