/* SPDX-License-Identifier: Apache-2.0 */
#include "rig.h"
#include "unity.h"
#include <stdio.h>
#include <string.h>

rig r;

enum { PORT_A, PORT_B, PORT_C };
#define FOR_EVER 1000000000u

static bool strikes(rig_trouble what)
{
    if (r.trouble != what || r.now_ns < r.trouble_ns) {
        return false;
    }
    r.trouble = RIG_FINE;
    return true;
}

static bool sda_held(void)
{
    if (strikes(RIG_STUCK)) {
        r.held = 5;
    }
    if (strikes(RIG_DEAD)) {
        r.held = FOR_EVER;
    }
    return r.held > 0;
}

/* ---- time and pins ----------------------------------------------------------------------------------- */

static void advance(void *ctx, uint64_t now_ns)
{
    uint64_t ns = now_ns - r.now_ns;
    (void)ctx;
    if (r.devices > 0) {
        sim_pl_advance(&r.stack, ns);
    }
    if (r.has_afe) {
        sim_x0_advance(&r.afe, ns);
    }
    r.now_ns = now_ns;
}

static uint64_t next(void *ctx)
{
    uint64_t ns = r.devices > 0 ? sim_pl_next_event(&r.stack) : sim_x0_next_event(&r.afe);
    (void)ctx;
    return ns == UINT64_MAX ? EMU_NEVER : r.now_ns + ns;
}

static int stack_pin(unsigned pin)
{
    switch (pin) {
    case 1:
        return sim_pl_drdy_pin(&r.stack);
    case 4:
        return sim_pl_fault_pin(&r.stack);
    case 5:
        return sim_pl_alert_pin(&r.stack);
    default:
        return -1;
    }
}

static int afe_pin(unsigned pin)
{
    switch (pin) {
    case 5:
        return sim_x0_alert(&r.afe);
    case 6:
        return 1; /* pull-ups */
    case 7:
        return sda_held() ? 0 : 1;
    default:
        return -1;
    }
}

static int pin_in(void *ctx, unsigned port, unsigned pin)
{
    (void)ctx;
    if (port == PORT_C) {
        return pin == 9 ? r.request : pin == 8 ? r.contactor : -1;
    }
    if (port != PORT_B) {
        return -1;
    }
    return r.devices > 0 ? stack_pin(pin) : afe_pin(pin);
}

static void boot_pin(bool high)
{
    if (high) {
        r.boot_ns = r.now_ns;
    } else if (r.boot_ns != 0) {
        (void)sim_x0_boot(&r.afe, r.now_ns - r.boot_ns);
        r.boot_ns = 0;
    }
}

static void scl_by_hand(bool low)
{
    if (low) {
        r.clocks++;
        r.held -= r.held > 0 && r.held < FOR_EVER ? 1u : 0u;
    }
}

static void pin_out(void *ctx, unsigned port, unsigned pin, emu_drive drive)
{
    bool high = drive == EMU_DRIVE_HIGH, low = drive == EMU_DRIVE_LOW;
    (void)ctx;
    if (port == PORT_C && pin == 6) {
        r.contactor = high;
    } else if (r.devices > 0 && port == PORT_A && pin == 4) {
        (low ? sim_pl_spi_select : sim_pl_spi_release)(&r.stack);
    } else if (r.devices > 0 && port == PORT_B && pin == 0) {
        sim_pl_set_conv(&r.stack, high);
    } else if (r.has_afe && port == PORT_B && pin == 0) {
        boot_pin(high);
    } else if (r.has_afe && port == PORT_B && pin == 6) {
        scl_by_hand(low);
    }
}

/* ---- buses ------------------------------------------------------------------------------------------- */

static uint16_t spi_frame(void *ctx, unsigned bus, const emu_spi_frame *f)
{
    (void)ctx;
    (void)bus;
    sim_pl_set_spi_clock(&r.stack, f->hz);
    sim_pl_set_spi_mode(&r.stack, f->mode);
    return sim_pl_spi_byte(&r.stack, (uint8_t)f->value, NULL);
}

static emu_i2c_answer answer(bool ack)
{
    return ack ? EMU_I2C_ACK : EMU_I2C_NACK;
}

static emu_i2c_answer i2c_start(void *ctx, unsigned bus, uint8_t byte)
{
    (void)ctx;
    (void)bus;
    sim_x0_i2c_start(&r.afe);
    return answer(sim_x0_i2c_write(&r.afe, byte));
}

static emu_i2c_answer i2c_write(void *ctx, unsigned bus, uint8_t byte)
{
    (void)ctx;
    (void)bus;
    if (strikes(RIG_NACK)) {
        return EMU_I2C_NACK;
    }
    if (strikes(RIG_LOST)) {
        sim_x0_i2c_stop(&r.afe);
        return EMU_I2C_LOST;
    }
    return strikes(RIG_BUS_ERROR) ? EMU_I2C_ERROR : answer(sim_x0_i2c_write(&r.afe, byte));
}

static uint8_t i2c_read(void *ctx, unsigned bus, bool ack)
{
    (void)ctx;
    (void)bus;
    return sim_x0_i2c_read(&r.afe, ack);
}

static void i2c_stop(void *ctx, unsigned bus)
{
    (void)ctx;
    (void)bus;
    sim_x0_i2c_stop(&r.afe);
}

static unsigned i2c_lines(void *ctx, unsigned bus)
{
    (void)ctx;
    (void)bus;
    return r.has_afe && sda_held() ? EMU_I2C_SDA_LOW : 0;
}

static uint64_t i2c_stretch_ns(void *ctx, unsigned bus)
{
    (void)ctx;
    (void)bus;
    return strikes(RIG_STRETCH) ? 5000000u : strikes(RIG_TOO_LONG) ? 30000000u : 0u;
}

static emu_can_result can_out(void *ctx, unsigned bus, const emu_can_frame *f)
{
    (void)ctx;
    (void)bus;
    if (f->id == 0x100) {
        memcpy(r.heartbeat, f->data, 8);
        r.heartbeats++;
    } else if (f->id == 0x109) {
        memcpy(r.boot, f->data, 8);
    }
    return EMU_CAN_ACKED;
}

static double adc_volts(void *ctx, unsigned adc, unsigned channel)
{
    (void)ctx;
    (void)adc;
    return channel == 10 ? 1.650 : 0.0;
}

/* ---- life -------------------------------------------------------------------------------------------- */

static const emu_world world = {.advance = advance,
                                .next = next,
                                .pin_in = pin_in,
                                .pin_out = pin_out,
                                .spi_frame = spi_frame,
                                .i2c_start = i2c_start,
                                .i2c_write = i2c_write,
                                .i2c_read = i2c_read,
                                .i2c_stop = i2c_stop,
                                .i2c_lines = i2c_lines,
                                .i2c_stretch_ns = i2c_stretch_ns,
                                .can_out = can_out,
                                .adc_volts = adc_volts};

#define IMAGE(name) IMAGES "/" name "/" name ".bin"

static bool readable(const char *path)
{
    FILE *f = fopen(path, "rb");
    if (f != NULL) {
        fclose(f);
    }
    return f != NULL;
}

const char *rig_missing(void)
{
    emu *e = emu_create(&emu_f405, &world);
    bool cpu = e != NULL && emu_cpu_open(e);
    emu_destroy(e);
    if (!cpu) {
        return "the emulator was built without a processor (libunicorn-dev)";
    }
    return readable(IMAGE("hv-f405")) && readable(IMAGE("f405-afe")) ? NULL : "no image: no cross compiler";
}

static void power(const char *image)
{
    r.e = emu_create(&emu_f405, &world);
    TEST_ASSERT_NOT_NULL(r.e);
    TEST_ASSERT_TRUE_MESSAGE(emu_cpu_open(r.e), "no processor");
    TEST_ASSERT_TRUE_MESSAGE(emu_load_file(r.e, image), image);
    emu_reset(r.e, EMU_CAUSE_POWER);
}

void rig_stack(int devices)
{
    const sim_pl_options strict = {.strict_timing = true};
    r.devices = devices;
    TEST_ASSERT_EQUAL(0, sim_pl_init(&r.stack, devices, &strict));
    for (int d = 1; d <= devices; d++) {
        for (int n = 1; n <= 6; n++) {
            (void)sim_pl_set_cell(&r.stack, d, n, 3.6);
        }
        (void)sim_pl_set_ts_ratio(&r.stack, d, 1, 0.12); /* about 20 degrees C */
        (void)sim_pl_set_ts_ratio(&r.stack, d, 2, 0.12);
    }
    power(IMAGE("hv-f405"));
}

void rig_afe(void)
{
    r.has_afe = true;
    TEST_ASSERT_EQUAL(0, sim_x0_init(&r.afe, sim_x0_find_part("bq7694003"), NULL));
    for (int n = 1; n <= 15; n++) {
        (void)sim_x0_set_cell(&r.afe, n, 3.7);
    }
    for (int n = 1; n <= 3; n++) {
        (void)sim_x0_set_ts(&r.afe, n, 10000.0);
    }
    power(IMAGE("f405-afe"));
}

/* Real cells are never the same for seconds; a monitor that says so counts as stopped. */
static void ripple(void)
{
    static bool up;
    up = !up;
    for (int d = 1; d <= r.devices; d++) {
        (void)sim_pl_set_cell(&r.stack, d, 1, up ? 3.602 : 3.6);
    }
}

void rig_run(double seconds)
{
    for (double left = seconds; left > 0.0; left -= 0.5) {
        ripple();
        (void)emu_run_until(r.e, emu_now(r.e) + (uint64_t)((left < 0.5 ? left : 0.5) * 1e9));
    }
}

static void book_is_empty(const sim_misuse *book)
{
    TEST_ASSERT_EQUAL_STRING("", book->count > 0 ? book->entry[0].text : "");
    TEST_ASSERT_EQUAL(0, book->count);
}

void rig_clean(void)
{
    const emu_meter *m = emu_get_meter(r.e);
    book_is_empty(emu_get_misuse(r.e));
    book_is_empty(r.devices > 0 ? sim_pl_misuse(&r.stack) : sim_x0_misuse(&r.afe));
    TEST_ASSERT_EQUAL(0, m->faults);
    TEST_ASSERT_EQUAL(0, m->resets[EMU_CAUSE_SOFTWARE] + m->resets[EMU_CAUSE_IWDG]);
}

void rig_end(void)
{
    if (r.e != NULL) {
        emu_destroy(r.e);
    }
    memset(&r, 0, sizeof r);
}
