/* SPDX-License-Identifier: Apache-2.0 */
/* hv-f405: a stack of bq76PL536 on SPI1 of an STM32F405, contactor, and a shunt amplifier on the ADC. */
#include "ps_wires.h"

enum { PORT_A, PORT_B, PORT_C };

#define ZERO_CURRENT_V 1.650
#define VOLTS_PER_AMPERE (50.0 * 100e-6) /* gain 50, shunt 100 microohm; charging raises the voltage */

static int level_b(ps_rig *r, unsigned pin)
{
    switch (pin) {
    case 1:
        return sim_pl_drdy_pin(&r->pl);
    case 4:
        return sim_pl_fault_pin(&r->pl);
    case 5:
        return sim_pl_alert_pin(&r->pl);
    case 8: /* CAN, recessive */
        return 1;
    default:
        return -1;
    }
}

static int level(ps_rig *r, unsigned port, unsigned pin)
{
    if (port == PORT_B) {
        return level_b(r, pin);
    }
    if (port == PORT_C && pin == 8) {
        return hal_sim_line(&r->hal, BQ_LINE_CONTACTOR_FB);
    }
    if (port == PORT_C && pin == 9) {
        return r->request == BQ_REQUEST_ON;
    }
    return port == PORT_A && pin == 3 ? 1 : -1; /* console RX: idle */
}

static void drive(ps_rig *r, unsigned port, unsigned pin, bool high)
{
    if (port == PORT_A && pin == 4) { /* chip select */
        if (high) {
            sim_pl_spi_release(&r->pl);
        } else {
            sim_pl_spi_select(&r->pl);
        }
    } else if (port == PORT_B && pin == 0) {
        sim_pl_set_conv(&r->pl, high);
    } else if (port == PORT_C && pin == 6) {
        r->hal.level[BQ_LINE_CONTACTOR] = high;
        ps_rig_follow(r);
    } else if (port == PORT_C && pin == 7) {
        r->hal.level[BQ_LINE_PRECHARGE] = high;
    }
}

static uint64_t next(const ps_rig *r)
{
    return sim_pl_next_event(&r->pl);
}

/* What is no byte in mode 1 reaches the stack as something it does not understand. */
static uint16_t spi_frame(void *ctx, unsigned bus, const emu_spi_frame *frame)
{
    ps_rig *r = ctx;
    (void)bus;
    sim_pl_set_spi_clock(&r->pl, frame->hz);
    sim_pl_set_spi_mode(&r->pl, frame->mode);
    if (frame->bits != 8 || frame->lsb_first || frame->mode != 1) {
        sim_misuse_add(sim_pl_misuse(&r->pl), sim_pl_now(&r->pl), 0, "PL-SPI-01",
                       "SPI frame other than 8 bits, MSB first, mode 1");
        return 0xffff;
    }
    return sim_pl_spi_byte(&r->pl, (uint8_t)frame->value, NULL);
}

static double adc_volts(void *ctx, unsigned adc, unsigned channel)
{
    ps_rig *r = ctx;
    (void)adc;
    return channel == 10 ? ZERO_CURRENT_V + VOLTS_PER_AMPERE * ps_rig_current_at(r, ps_rig_now(r)) : 0.0;
}

static const emu_world buses = {.spi_frame = spi_frame, .adc_volts = adc_volts};

const ps_wires ps_hv_f405 = {
    .board = "hv-f405",
    .chip = &emu_f405,
    .stack = true,
    .settings_at = 0x0800c000u,
    .world = &buses,
    .level = level,
    .drive = drive,
    .next = next,
};
