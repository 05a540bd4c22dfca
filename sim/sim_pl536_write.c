/* SPDX-License-Identifier: Apache-2.0 */
/* What a write that was accepted does (PL-REG, PL-CB, PL-G3, PL-ADR, PL-TEST). */
#include "sim_pl536_internal.h"

/* ---- balancing ------------------------------------------------------------------------------------------
 */

/* Outputs of a device with an open sense wire change what its inputs see. */
static void outputs_changed(sim_pl *s, sim_pl_dev *d)
{
    if (d->wires_open != 0) {
        sim_pl_inputs(s, d);
        sim_pl_protect_check(s, d);
    }
}

void sim_pl_balance_stop(sim_pl *s, sim_pl_dev *d)
{
    d->cb_running = false;
    d->cb_end = SIM_PL_NEVER;
    outputs_changed(s, d);
}

void sim_pl_balance_expire(sim_pl *s, sim_pl_dev *d)
{
    if (s->options.amb84_clear_cbctrl) {
        d->reg[REG_CB_CTRL] = 0;
    }
    sim_pl_balance_stop(s, d);
}

static void balance_start(sim_pl *s, sim_pl_dev *d)
{
    unsigned time = d->reg[REG_CB_TIME];
    uint64_t period = (time & 0x3fu) * ((time & 0x80u) != 0 ? 60 * SIM_PL_S : SIM_PL_S);
    bool stopped = s->options.amb86_sleep_stops_cb && (d->asleep || d->tsd);

    if (period != 0 && !stopped) {
        d->cb_running = true;
        d->cb_end = s->now + sim_pl_scaled(s, period);
    }
}

void sim_pl_do_cb_ctrl(sim_pl *s, sim_pl_dev *d, uint8_t value)
{
    unsigned before = d->reg[REG_CB_CTRL];
    unsigned after = d->uvlo ? 0 : value & 0x3fu;
    bool starts = before == 0 && after != 0;

    d->reg[REG_CB_CTRL] = (uint8_t)after;
    if (s->options.amb83_any_rise && (after & ~before) != 0) {
        starts = true;
    }
    if (after == 0) {
        sim_pl_balance_stop(s, d);
    } else if (starts) {
        balance_start(s, d);
    }
    outputs_changed(s, d);
}

void sim_pl_do_cb_time(sim_pl *s, sim_pl_dev *d, uint8_t value)
{
    d->reg[REG_CB_TIME] = value & 0xbf;
    if ((value & 0x3f) == 0) {
        sim_pl_balance_stop(s, d);
    } else if (s->options.amb85_time_restarts && d->cb_running) {
        balance_start(s, d);
    }
}

/* ---- group 2
 * ------------------------------------------------------------------------------------------------ */

void sim_pl_do_adc_control(sim_pl *s, sim_pl_dev *d, uint8_t value)
{
    bool rises = (value & ~(unsigned)d->reg[REG_ADC_CONTROL] & ADC_ON) != 0;

    d->reg[REG_ADC_CONTROL] = value & 0x7f;
    if (rises) {
        sim_pl_adc_wake(s, d);
    }
}

void sim_pl_gpio_update(sim_pl_dev *d)
{
    unsigned io = d->reg[REG_IO_CONTROL] & ~(unsigned)IO_GPIO_IN;

    if ((io & IO_GPIO_OUT) != 0 && d->gpio_level) {
        io |= IO_GPIO_IN;
    }
    d->reg[REG_IO_CONTROL] = (uint8_t)io;
}

void sim_pl_do_io_control(sim_pl *s, sim_pl_dev *d, uint8_t value)
{
    unsigned io = value & 0xc7u;

    if (d->tsd) {
        io |= IO_SLEEP; /* cannot be left while hot (PL-AMB-91) */
    }
    d->slept_by_host = (value & IO_SLEEP) != 0;
    d->reg[REG_IO_CONTROL] = (uint8_t)io;
    sim_pl_gpio_update(d);
    sim_pl_sleep_request(s, d);
    sim_pl_protect_config(s, d); /* the thermistor switches gate the OT comparators */
}

void sim_pl_do_convert(sim_pl *s, sim_pl_dev *d, uint8_t value)
{
    if ((value & 1u) == 0) {
        return;
    }
    if (d->conv_in) {
        sim_pl_judge_state(s, d, "PL-CONV-03", "firmware conversion start while CONV is high");
        return;
    }
    sim_pl_adc_start(s, d, false);
}

void sim_pl_do_shadow(sim_pl *s, sim_pl_dev *d, uint8_t value)
{
    if (value == 0x35) {
        d->key = true;
    } else if (value == 0x27) {
        sim_pl_eprom_load(s, d);
    }
}

void sim_pl_do_address(sim_pl *s, sim_pl_dev *d, uint8_t value)
{
    unsigned address = value & ADDR_MASK;

    if (s->options.amb26_needs_bit7 && (value & ADDR_AR) == 0) {
        return;
    }
    if (address == 0 || address == ADDR_BROADCAST) {
        d->reg[REG_ADDRESS] = (uint8_t)address;
        sim_pl_alert_set(d, AL_AR);
    } else {
        d->reg[REG_ADDRESS] = (uint8_t)(ADDR_AR | address);
        d->address_generation = s->generation;
        d->lost = false;
        if (s->options.amb28_ar_copy) {
            d->reg[REG_ALERT] &= (uint8_t)~AL_AR;
        }
    }
    s->reach_valid = false;
}

void sim_pl_do_reset(sim_pl *s, sim_pl_dev *d, uint8_t value)
{
    if (value == 0xa5) {
        sim_pl_reset_enter(s, d, true);
    }
}

/* Called after sim_pl_write() voided a sequence that was interrupted: test_step tells that 0xa4 came directly
 * before. */
void sim_pl_do_test(sim_pl *s, sim_pl_dev *d, uint8_t value)
{
    d->reg[REG_TEST_SELECT] = value;
    if (value == 0x00) {
        d->test = false;
    } else if (value == 0x25 && d->test_step) {
        d->test = true;
    }
    d->test_step = value == 0xa4;
    s->reach_valid = false;
}

/* ---- group 3
 * ------------------------------------------------------------------------------------------------ */

static void write_group3(sim_pl *s, sim_pl_dev *d, const sim_pl_reg *r, uint8_t value)
{
    if (r->address >= REG_USER1 && s->options.amb100_user_readonly) {
        return;
    }
    d->reg[r->address] = value & sim_pl_reg_keep(s, r);
    sim_pl_parity_store(d, r->address - REG_FUNCTION);
    sim_pl_protect_config(s, d);
}

/* ---- entrance
 * ----------------------------------------------------------------------------------------------- */

void sim_pl_write(sim_pl *s, sim_pl_dev *d, uint8_t reg, uint8_t value, bool broadcast)
{
    const sim_pl_reg *r = sim_pl_reg_at(reg);
    bool key = d->key;

    sim_pl_judge_write(s, d, reg, value, key, broadcast);
    if (s->options.amb02_crc_last_packet) {
        d->reg[REG_FAULT] &= (uint8_t)~FA_CRC;
    }
    d->key = false; /* one valid write of any kind uses it up (PL-G3-03, PL-AMB-99) */
    if (reg != REG_TEST_SELECT) {
        d->test_step = false;
    }
    if (r->effect != NULL) {
        r->effect(s, d, value);
    } else if (r->group == 3 && key) {
        write_group3(s, d, r, value);
    }
    sim_pl_touch(s, d);
}
