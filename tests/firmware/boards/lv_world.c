/* SPDX-License-Identifier: Apache-2.0 */
#include "lv_world.h"
#include <stdio.h>
#include <string.h>

lv_world lv;

static void advance(void *ctx, uint64_t now)
{
    (void)ctx;
    if (now > lv.chip.now) {
        sim_x0_advance(&lv.chip, now - lv.chip.now);
    }
    noise_advance(&lv.noise, lv.e, now);
    while (lv.type != NULL && *lv.type != '\0' && now >= lv.type_ns) {
        (void)emu_uart_in(lv.e, 2, (uint8_t)*lv.type++);
        lv.type_ns = now + 2 * MS;
    }
}

static uint64_t next(void *ctx)
{
    uint64_t at = sim_x0_next_event(&lv.chip);
    (void)ctx;
    if (at <= lv.chip.now) { /* waits for something else than time */
        at = EMU_NEVER;
    }
    at = noise_next(&lv.noise) < at ? noise_next(&lv.noise) : at;
    return lv.type != NULL && *lv.type != '\0' && lv.type_ns < at ? lv.type_ns : at;
}

static int pin_in(void *ctx, unsigned port, unsigned pin)
{
    (void)ctx;
    if (noise_on(&lv.noise, port, pin)) {
        return lv.noise.level ? 1 : 0;
    }
    if (port == 0 && pin == 0) {
        return sim_x0_alert(&lv.chip) ? 1 : 0;
    }
    if (port == 0 && pin == 4) {
        return lv.request ? 1 : 0;
    }
    if (port == 1 && (pin == 6 || pin == 7)) { /* pull-ups of the I2C bus */
        return pin == 7 && !sim_x0_sda_free(&lv.chip) ? 0 : 1;
    }
    return -1;
}

static void pin_out(void *ctx, unsigned port, unsigned pin, emu_drive drive)
{
    (void)ctx;
    if (port == 0 && pin == 1) {
        if (drive == EMU_DRIVE_HIGH) {
            lv.boot_from = lv.chip.now;
        } else if (lv.boot_from != 0) {
            (void)sim_x0_boot_ended(&lv.chip, lv.boot_from);
            lv.boot_from = 0;
        }
    }
    if (port == 1 && (pin == 6 || pin == 7)) {
        lv.clock_first = lv.clock_first != 0 ? lv.clock_first : emu_now(lv.e);
        lv.clock_last = emu_now(lv.e);
    }
    if (port == 1 && pin == 6 && drive == EMU_DRIVE_LOW) { /* a clock by hand: recovery */
        sim_x0_recovery_clock(&lv.chip);
    }
    if (port == 2 && pin == 13) {
        lv.led = drive == EMU_DRIVE_HIGH;
    }
}

static emu_i2c_answer answer(bool acknowledged)
{
    return acknowledged ? EMU_I2C_ACK : EMU_I2C_NACK;
}

static emu_i2c_answer i2c_start(void *ctx, unsigned bus, uint8_t address_byte)
{
    (void)ctx;
    (void)bus;
    if (lv.upset != 0) {
        lv.upset--;
        return lv.upset_answer;
    }
    sim_x0_i2c_start(&lv.chip);
    return answer(sim_x0_i2c_write(&lv.chip, address_byte));
}

static emu_i2c_answer i2c_write(void *ctx, unsigned bus, uint8_t byte)
{
    (void)ctx;
    (void)bus;
    return answer(sim_x0_i2c_write(&lv.chip, byte));
}

static uint8_t i2c_read(void *ctx, unsigned bus, bool ack)
{
    (void)ctx;
    (void)bus;
    return sim_x0_i2c_read(&lv.chip, ack);
}

static void i2c_stop(void *ctx, unsigned bus)
{
    (void)ctx;
    (void)bus;
    sim_x0_i2c_stop(&lv.chip);
}

static unsigned i2c_lines(void *ctx, unsigned bus)
{
    (void)ctx;
    (void)bus;
    return sim_x0_sda_free(&lv.chip) ? 0u : EMU_I2C_SDA_LOW;
}

static uint64_t i2c_stretch_ns(void *ctx, unsigned bus)
{
    uint64_t ns = lv.stretch_ns;
    (void)ctx;
    (void)bus;
    lv.stretch_ns = 0;
    return ns;
}

static void heartbeat(const emu_can_frame *frame)
{
    uint64_t now = emu_now(lv.e);
    if (lv.beat_ns != 0 && now - lv.beat_ns > lv.longest_ns) {
        lv.longest_ns = now - lv.beat_ns;
    }
    lv.beat_ns = now;
    if (lv.settled_ns == 0 && (frame->data[0] == 2 || frame->data[0] == 3)) { /* standby, on */
        lv.settled_ns = now;
    }
}

static emu_can_result can_out(void *ctx, unsigned bus, const emu_can_frame *frame)
{
    (void)ctx;
    (void)bus;
    lv.frames++;
    if (lv.result == EMU_CAN_ACKED && frame->id - 0x100u < 16u) {
        lv.last[frame->id - 0x100u] = *frame;
        lv.count[frame->id - 0x100u]++;
        if (frame->id == 0x100u) {
            heartbeat(frame);
        }
    }
    return lv.result;
}

static void uart_out(void *ctx, unsigned uart, uint8_t byte)
{
    (void)ctx;
    (void)uart;
    if (lv.length + 1u < sizeof lv.said) {
        lv.said[lv.length++] = (char)byte;
    }
}

static void make_chip(void)
{
    (void)sim_x0_init(&lv.chip, sim_x0_find_part("bq7694003"), NULL);
    for (int i = 1; i <= 15; i++) {
        (void)sim_x0_set_cell(&lv.chip, i, 3.6);
    }
    for (int i = 1; i <= 3; i++) {
        (void)sim_x0_set_ts(&lv.chip, i, 10000);
    }
    (void)sim_x0_set_supply(&lv.chip, true);
}

bool lv_start(const char *image)
{
    const emu_world world = {.advance = advance,
                             .next = next,
                             .pin_in = pin_in,
                             .pin_out = pin_out,
                             .i2c_start = i2c_start,
                             .i2c_write = i2c_write,
                             .i2c_read = i2c_read,
                             .i2c_stop = i2c_stop,
                             .i2c_lines = i2c_lines,
                             .i2c_stretch_ns = i2c_stretch_ns,
                             .can_out = can_out,
                             .uart_out = uart_out};
    memset(&lv, 0, sizeof lv);
    lv.result = EMU_CAN_ACKED;
    make_chip();
    lv.e = emu_create(&emu_f072, &world);
    if (lv.e == NULL || !emu_cpu_open(lv.e) || !emu_load_file(lv.e, image)) {
        return false;
    }
    emu_reset(lv.e, EMU_CAUSE_POWER);
    return true;
}

void lv_end(void)
{
    emu_destroy(lv.e);
    lv.e = NULL;
}

void lv_run(unsigned ms)
{
    (void)emu_run_until(lv.e, ms * MS);
}

void lv_type(const char *line)
{
    lv.length = 0;
    memset(lv.said, 0, sizeof lv.said);
    lv.type = line;
    lv.type_ns = emu_now(lv.e) + 1 * MS;
    (void)emu_run_until(lv.e, emu_now(lv.e) + 300 * MS);
}

void lv_watch_period(void)
{
    lv.longest_ns = 0;
    lv.beat_ns = 0;
}

bool lv_both_fets(void)
{
    return sim_x0_chg(&lv.chip) && sim_x0_dsg(&lv.chip);
}

/* The GNU linker's map: "    0x<address>    name". */
bool lv_mark(const char *map)
{
    char line[512], name[256];
    unsigned long address;
    FILE *file = fopen(map, "r");
    bool found = false;
    while (file != NULL && !found && fgets(line, sizeof line, file) != NULL) {
        found = sscanf(line, " %lx %255s", &address, name) == 2 && strcmp(name, "board_pass") == 0;
    }
    if (file != NULL) {
        (void)fclose(file);
    }
    if (found) {
        emu_mark(lv.e, (uint32_t)address);
    }
    return found;
}
