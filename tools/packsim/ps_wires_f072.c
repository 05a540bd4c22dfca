/* SPDX-License-Identifier: Apache-2.0 */
/* lv-f072: one bq769x0 on I2C1 of an STM32F072. */
#include "ps_wires.h"

enum { PORT_A, PORT_B };

static int level(ps_rig *r, unsigned port, unsigned pin)
{
    if (port == PORT_A && pin == 0) { /* ALERT */
        return sim_x0_alert(&r->x0);
    }
    if (port == PORT_A && pin == 3) { /* console RX: idle */
        return 1;
    }
    if (port == PORT_A && pin == 4) { /* REQUEST */
        return r->request == BQ_REQUEST_ON;
    }
    if (port == PORT_B && pin == 7) { /* SDA with its pull-up */
        return sim_x0_sda_free(&r->x0);
    }
    return port == PORT_B && (pin == 6 || pin == 8) ? 1 : -1; /* SCL pulled up, CAN recessive */
}

/* A pulse on AFE_BOOT counts when it ends; so does a clock of a bus recovery. */
static void drive(ps_rig *r, unsigned port, unsigned pin, bool high)
{
    bool boot = port == PORT_A && pin == 1;
    if (boot && high && !r->hal_x0.level[BQ_LINE_AFE_BOOT]) {
        r->hal_x0.boot_from = r->x0.now;
    } else if (boot && !high && r->hal_x0.level[BQ_LINE_AFE_BOOT]) {
        (void)sim_x0_boot_ended(&r->x0, r->hal_x0.boot_from);
    } else if (port == PORT_B && pin == 6 && high) {
        sim_x0_recovery_clock(&r->x0);
    }
    if (boot) {
        r->hal_x0.level[BQ_LINE_AFE_BOOT] = high;
    }
}

static uint64_t next(const ps_rig *r)
{
    return sim_x0_next_event(&r->x0);
}

/* ---- the bus ---------------------------------------------------------------------------------- */

static emu_i2c_answer answer(bool acknowledged)
{
    return acknowledged ? EMU_I2C_ACK : EMU_I2C_NACK;
}

static emu_i2c_answer i2c_start(void *ctx, unsigned bus, uint8_t address_byte)
{
    ps_rig *r = ctx;
    (void)bus;
    r->hal_x0.bytes++;
    r->stretch = true;
    sim_x0_i2c_start(&r->x0);
    return answer(sim_x0_i2c_write(&r->x0, address_byte));
}

static emu_i2c_answer i2c_write(void *ctx, unsigned bus, uint8_t byte)
{
    ps_rig *r = ctx;
    (void)bus;
    r->hal_x0.bytes++;
    bool acknowledged = sim_x0_i2c_write(&r->x0, byte);
    ps_rig_follow(r);
    return answer(acknowledged);
}

static uint8_t i2c_read(void *ctx, unsigned bus, bool ack)
{
    ps_rig *r = ctx;
    (void)bus;
    r->hal_x0.bytes++;
    return sim_x0_i2c_read(&r->x0, ack);
}

static void i2c_stop(void *ctx, unsigned bus)
{
    ps_rig *r = ctx;
    (void)bus;
    sim_x0_i2c_stop(&r->x0);
}

static unsigned i2c_lines(void *ctx, unsigned bus)
{
    ps_rig *r = ctx;
    (void)bus;
    return sim_x0_sda_free(&r->x0) ? 0u : EMU_I2C_SDA_LOW;
}

/* Once in a transaction, behind the address. */
static uint64_t i2c_stretch_ns(void *ctx, unsigned bus)
{
    ps_rig *r = ctx;
    (void)bus;
    uint64_t ns = r->stretch ? (uint64_t)sim_x0_bus(&r->x0)->stretch_us * 1000u : 0u;
    r->stretch = false;
    return ns;
}

static const emu_world buses = {
    .i2c_start = i2c_start,
    .i2c_write = i2c_write,
    .i2c_read = i2c_read,
    .i2c_stop = i2c_stop,
    .i2c_lines = i2c_lines,
    .i2c_stretch_ns = i2c_stretch_ns,
};

const ps_wires ps_lv_f072 = {
    .board = "lv-f072",
    .chip = &emu_f072,
    .stack = false,
    .settings_at = 0x0801f000u,
    .world = &buses,
    .level = level,
    .drive = drive,
    .next = next,
};
