/* SPDX-License-Identifier: Apache-2.0 */
#include "hv_world.h"
#include "unity.h"
#include <string.h>

enum { PORT_A, PORT_B, PORT_C };
enum { STANDBY = 2, ON = 3 };

hv_world hv;

/* ---- time and pins ----------------------------------------------------------------------------------- */

static bool typing(void)
{
    return hv.type != NULL && *hv.type != '\0';
}

static void advance(void *ctx, uint64_t now_ns)
{
    (void)ctx;
    sim_pl_advance(&hv.stack, now_ns - hv.now_ns);
    hv.now_ns = now_ns;
    noise_advance(&hv.noise, hv.e, now_ns);
    if (typing() && now_ns >= hv.type_ns) {
        (void)emu_uart_in(hv.e, 2, (uint8_t)*hv.type++);
        hv.type_ns = now_ns + 1 * MS;
    }
}

static uint64_t next(void *ctx)
{
    uint64_t in = sim_pl_next_event(&hv.stack);
    uint64_t at = in == UINT64_MAX ? EMU_NEVER : hv.now_ns + in, noisy = noise_next(&hv.noise);
    (void)ctx;
    at = noisy < at ? noisy : at;
    return typing() && hv.type_ns < at ? hv.type_ns : at;
}

static int feedback(void)
{
    return hv.feedback == HV_FOLLOWS ? hv.contactor : hv.feedback == HV_WELDED;
}

static int stack_pin(unsigned pin)
{
    switch (pin) {
    case 1:
        return sim_pl_drdy_pin(&hv.stack);
    case 4:
        return sim_pl_fault_pin(&hv.stack);
    case 5:
        return sim_pl_alert_pin(&hv.stack);
    default:
        return -1;
    }
}

static int pin_in(void *ctx, unsigned port, unsigned pin)
{
    (void)ctx;
    if (noise_on(&hv.noise, port, pin)) {
        return hv.noise.level;
    }
    if (port == PORT_C) {
        return pin == 9 ? hv.request : pin == 8 ? feedback() : -1;
    }
    return port == PORT_B ? stack_pin(pin) : -1;
}

static void contactor(bool high)
{
    if (high && !hv.contactor) {
        hv.closed++;
        hv.closed_ns = hv.now_ns;
        hv.unsafe += hv.forbidden;
        hv.precharged_ns = hv.precharge ? hv.now_ns - hv.path_ns : 0;
    } else if (!high && hv.contactor) {
        hv.opened_ns = hv.now_ns;
    }
    hv.contactor = high;
}

static void precharge(bool high)
{
    if (high && !hv.precharge) {
        hv.unsafe += hv.forbidden;
        hv.path_ns = hv.now_ns;
    }
    hv.precharge = high;
}

static void pin_out(void *ctx, unsigned port, unsigned pin, emu_drive drive)
{
    bool high = drive == EMU_DRIVE_HIGH;
    (void)ctx;
    if (port == PORT_C && pin == 6) {
        contactor(high);
    } else if (port == PORT_C && pin == 7) {
        precharge(high);
    } else if (port == PORT_C && pin == 13) {
        hv.led = high;
    } else if (port == PORT_A && pin == 4) {
        (drive == EMU_DRIVE_LOW ? sim_pl_spi_select : sim_pl_spi_release)(&hv.stack);
        hv.packet = 0;
    } else if (port == PORT_B && pin == 0) {
        sim_pl_set_conv(&hv.stack, high);
    }
}

/* ---- buses ------------------------------------------------------------------------------------------- */

static uint16_t spi_frame(void *ctx, unsigned bus, const emu_spi_frame *f)
{
    uint8_t answer;
    (void)ctx;
    (void)bus;
    sim_pl_set_spi_clock(&hv.stack, f->hz);
    sim_pl_set_spi_mode(&hv.stack, f->mode);
    answer = sim_pl_spi_byte(&hv.stack, (uint8_t)f->value, NULL);
    hv.misframed += f->bits != 8 || f->lsb_first;
    hv.packet++;
    if (hv.stop_in_packet && hv.packet == 2) {
        emu_stop_here(hv.e);
    }
    return hv.miso < 0 ? answer : (uint16_t)hv.miso;
}

static void heartbeat(const emu_can_frame *f)
{
    uint64_t now = hv.now_ns;
    if (hv.beat_ns != 0 && now - hv.beat_ns > hv.longest_ns) {
        hv.longest_ns = now - hv.beat_ns;
    }
    hv.beat_ns = now;
    if (hv.settled_ns == 0 && (f->data[0] == STANDBY || f->data[0] == ON)) {
        hv.settled_ns = now;
    }
    if (hv.on_ns == 0 && f->data[0] == ON) {
        hv.on_ns = now;
    }
}

static emu_can_result can_out(void *ctx, unsigned bus, const emu_can_frame *f)
{
    (void)ctx;
    (void)bus;
    hv.frames++;
    if (hv.result == EMU_CAN_ACKED && f->id - 0x100u < 16u) {
        hv.last[f->id - 0x100u] = *f;
        hv.count[f->id - 0x100u]++;
        if (f->id == 0x100u) {
            heartbeat(f);
        }
    }
    return hv.result;
}

static emu_can_wire can_wire(void *ctx, unsigned bus)
{
    (void)ctx;
    (void)bus;
    return hv.dead_wire ? EMU_CAN_DOMINANT : EMU_CAN_RECESSIVE;
}

static void uart_out(void *ctx, unsigned uart, uint8_t byte)
{
    (void)ctx;
    (void)uart;
    if (hv.length + 1u < sizeof hv.said) {
        hv.said[hv.length++] = (char)byte;
    }
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
                                .can_out = can_out,
                                .can_wire = can_wire,
                                .uart_out = uart_out,
                                .adc_volts = adc_volts};

static bool make_stack(int devices)
{
    const sim_pl_options real = {.strict_timing = true, .noise_uv_rms = 200.0, .seed = 1};
    if (sim_pl_init(&hv.stack, devices, &real) != 0) {
        return false;
    }
    for (int d = 1; d <= devices; d++) {
        for (int n = 1; n <= 6; n++) {
            (void)sim_pl_set_cell(&hv.stack, d, n, 3.6);
        }
        (void)sim_pl_set_ts_ratio(&hv.stack, d, 1, 0.12); /* about 20 degrees C */
        (void)sim_pl_set_ts_ratio(&hv.stack, d, 2, 0.12);
    }
    return true;
}

bool hv_prepare(const char *image, int devices)
{
    memset(&hv, 0, sizeof hv);
    hv.miso = -1;
    hv.result = EMU_CAN_ACKED;
    hv.e = emu_create(&emu_f405, &world);
    return make_stack(devices) && hv.e != NULL && emu_cpu_open(hv.e) && emu_load_file(hv.e, image);
}

void hv_power(void)
{
    emu_reset(hv.e, EMU_CAUSE_POWER);
}

bool hv_start(const char *image)
{
    if (!hv_prepare(image, HV_DEVICES)) {
        return false;
    }
    hv_power();
    return true;
}

void hv_end(void)
{
    emu_destroy(hv.e);
    hv.e = NULL;
}

void hv_run(unsigned ms)
{
    (void)emu_run_until(hv.e, emu_now(hv.e) + ms * MS);
}

void hv_type(const char *line)
{
    hv.length = 0;
    memset(hv.said, 0, sizeof hv.said);
    hv.type = line;
    hv.type_ns = emu_now(hv.e) + 1 * MS;
    hv_run(200);
}

void hv_up(void)
{
    hv.request = true;
    for (unsigned i = 0; i < 20 && !hv.contactor; i++) {
        hv_run(100);
    }
    TEST_ASSERT_TRUE_MESSAGE(hv.contactor, "the contactor does not close");
    hv_run(100);
    TEST_ASSERT_TRUE(hv.led);
}

int hv_state(void)
{
    return hv.last[0].data[0];
}

static void empty(const sim_misuse *book)
{
    TEST_ASSERT_EQUAL_STRING("", book->count != 0 ? book->entry[0].text : "");
}

void hv_clean(void)
{
    empty(emu_get_misuse(hv.e));
    empty(sim_pl_misuse(&hv.stack));
}

unsigned hv_resets(emu_cause cause)
{
    return emu_get_meter(hv.e)->resets[cause];
}

void hv_watch_period(void)
{
    hv.longest_ns = 0;
    hv.beat_ns = 0;
}
