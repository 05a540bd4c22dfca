/* SPDX-License-Identifier: Apache-2.0 */
/* The world door: inputs a test sets and outputs it looks at. */
#include "sim_pl536_internal.h"
#include <math.h>
#include <string.h>

static sim_pl_dev *device_at(sim_pl *s, int device)
{
    return device >= 1 && device <= s->devices ? &s->dev[device - 1] : NULL;
}

static const sim_pl_dev *look_at(const sim_pl *s, int device)
{
    return device >= 1 && device <= s->devices ? &s->dev[device - 1] : NULL;
}

/* The cells changed: most of the time no comparator and no supply threshold is crossed. */
static void cells_changed(sim_pl *s, sim_pl_dev *d)
{
    if (d->wires_open != 0) {
        sim_pl_inputs(s, d);
    } else {
        memcpy(d->seen, d->cell, sizeof d->seen);
    }
    if (d->vbat < 0.0 && (d->uvlo || d->power != SIM_PL_POWER_ON || d->uvlo_at != SIM_PL_NEVER ||
                          d->por_at != SIM_PL_NEVER || sim_pl_brick(d) < 5.31)) {
        sim_pl_power_update(s, d);
        sim_pl_chain_settle(s);
        sim_pl_pins_record(s);
    }
    if (sim_pl_protect_cells_changed(d)) {
        sim_pl_protect_check(s, d);
        sim_pl_touch(s, d);
        sim_pl_pins_record(s);
    }
}

int sim_pl_set_cells(sim_pl *s, int device, const double volts[6])
{
    sim_pl_dev *d = device_at(s, device);

    if (d == NULL || !isfinite(volts[0] + volts[1] + volts[2] + volts[3] + volts[4] + volts[5])) {
        return -1;
    }
    memcpy(d->cell, volts, sizeof d->cell);
    cells_changed(s, d);
    return 0;
}

int sim_pl_set_cell(sim_pl *s, int device, int cell, double volts)
{
    sim_pl_dev *d = device_at(s, device);

    if (d == NULL || cell < 1 || cell > 6 || !isfinite(volts)) {
        return -1;
    }
    d->cell[cell - 1] = volts;
    cells_changed(s, d);
    return 0;
}

double sim_pl_cell(const sim_pl *s, int device, int cell)
{
    const sim_pl_dev *d = look_at(s, device);

    return d != NULL && cell >= 1 && cell <= 6 ? d->cell[cell - 1] : 0.0;
}

int sim_pl_set_vbat(sim_pl *s, int device, double volts)
{
    sim_pl_dev *d = device_at(s, device);

    if (d == NULL || !isfinite(volts)) {
        return -1;
    }
    d->vbat = volts < 0.0 ? -1.0 : volts;
    sim_pl_power_update(s, d);
    sim_pl_chain_settle(s);
    sim_pl_pins_record(s);
    return 0;
}

double sim_pl_vbat(const sim_pl *s, int device)
{
    const sim_pl_dev *d = look_at(s, device);

    return d != NULL ? sim_pl_brick(d) : 0.0;
}

int sim_pl_set_ts_ratio(sim_pl *s, int device, int sensor, double ratio)
{
    sim_pl_dev *d = device_at(s, device);

    if (d == NULL || sensor < 1 || sensor > 2 || !isfinite(ratio)) {
        return -1;
    }
    d->ts[sensor - 1] = ratio;
    sim_pl_protect_check(s, d);
    sim_pl_touch(s, d);
    sim_pl_pins_record(s);
    return 0;
}

double sim_pl_ts_ratio(const sim_pl *s, int device, int sensor)
{
    const sim_pl_dev *d = look_at(s, device);

    return d != NULL && sensor >= 1 && sensor <= 2 ? d->ts[sensor - 1] : 0.0;
}

int sim_pl_set_gpai(sim_pl *s, int device, double volts)
{
    sim_pl_dev *d = device_at(s, device);

    if (d == NULL || !isfinite(volts)) {
        return -1;
    }
    d->gpai = volts;
    return 0;
}

double sim_pl_gpai(const sim_pl *s, int device)
{
    const sim_pl_dev *d = look_at(s, device);

    return d != NULL ? d->gpai : 0.0;
}

int sim_pl_set_gpio(sim_pl *s, int device, bool external_level)
{
    sim_pl_dev *d = device_at(s, device);

    if (d == NULL) {
        return -1;
    }
    d->gpio_level = external_level;
    if (sim_pl_is_on(d)) {
        sim_pl_gpio_update(d);
    }
    return 0;
}

/* Without supply the open drain is released. */
bool sim_pl_gpio(const sim_pl *s, int device)
{
    const sim_pl_dev *d = look_at(s, device);

    if (d == NULL) {
        return false;
    }
    return d->gpio_level && (d->power == SIM_PL_POWER_OFF || (d->reg[REG_IO_CONTROL] & IO_GPIO_OUT) != 0);
}

int sim_pl_set_tdie(sim_pl *s, int device, double celsius)
{
    sim_pl_dev *d = device_at(s, device);

    if (d == NULL || !isfinite(celsius)) {
        return -1;
    }
    d->tdie = celsius;
    sim_pl_tsd_update(s, d);
    sim_pl_touch(s, d);
    sim_pl_pins_record(s);
    return 0;
}

double sim_pl_tdie(const sim_pl *s, int device)
{
    const sim_pl_dev *d = look_at(s, device);

    return d != NULL ? d->tdie : 0.0;
}

int sim_pl_set_supply(sim_pl *s, int device, bool on)
{
    sim_pl_dev *d = device_at(s, device);

    if (d == NULL) {
        return -1;
    }
    d->supply = on;
    sim_pl_power_update(s, d);
    sim_pl_chain_settle(s);
    sim_pl_pins_record(s);
    return 0;
}

bool sim_pl_supply(const sim_pl *s, int device)
{
    const sim_pl_dev *d = look_at(s, device);

    return d != NULL && d->supply;
}

int sim_pl_set_wire(sim_pl *s, int device, int wire, bool open)
{
    sim_pl_dev *d = device_at(s, device);

    if (d == NULL || wire < 0 || wire > 6) {
        return -1;
    }
    d->wires_open = (uint8_t)((d->wires_open & ~(1u << wire)) | ((open ? 1u : 0u) << wire));
    sim_pl_inputs(s, d);
    sim_pl_protect_check(s, d);
    sim_pl_touch(s, d);
    sim_pl_pins_record(s);
    return 0;
}

int sim_pl_set_link(sim_pl *s, int device, bool broken)
{
    if (device < 1 || device >= s->devices) {
        return -1;
    }
    s->link_broken[device - 1] = broken;
    sim_pl_chain_changed(s);
    sim_pl_chain_settle(s);
    sim_pl_pins_record(s);
    return 0;
}

uint8_t sim_pl_cb(const sim_pl *s, int device)
{
    const sim_pl_dev *d = look_at(s, device);

    return d != NULL && d->cb_running ? d->reg[REG_CB_CTRL] : 0;
}

bool sim_pl_reg50(const sim_pl *s, int device)
{
    const sim_pl_dev *d = look_at(s, device);

    return d != NULL && sim_pl_reg50_on(d);
}

bool sim_pl_aux(const sim_pl *s, int device)
{
    const sim_pl_dev *d = look_at(s, device);

    return d != NULL && sim_pl_reg50_on(d) && (d->reg[REG_IO_CONTROL] & IO_AUX) != 0;
}

sim_pl_mode sim_pl_get_mode(const sim_pl *s, int device)
{
    const sim_pl_dev *d = look_at(s, device);

    if (d == NULL || d->power == SIM_PL_POWER_OFF) {
        return SIM_PL_OFF;
    }
    if (d->power == SIM_PL_POWER_RESET) {
        return SIM_PL_RESET;
    }
    if (d->tsd) {
        return SIM_PL_TSD;
    }
    if (d->uvlo) {
        return SIM_PL_UVLO;
    }
    if (d->asleep) {
        return SIM_PL_SLEEP;
    }
    return d->locked ? SIM_PL_LOCKED : SIM_PL_ACTIVE;
}

int sim_pl_peek(const sim_pl *s, int device, uint8_t reg)
{
    const sim_pl_dev *d = look_at(s, device);

    if (d == NULL) {
        return -1;
    }
    return reg < SIM_PL_REGS ? d->reg[reg] : 0;
}

uint32_t sim_pl_conversions(const sim_pl *s, int device)
{
    const sim_pl_dev *d = look_at(s, device);

    return d != NULL ? d->conversions : 0;
}
