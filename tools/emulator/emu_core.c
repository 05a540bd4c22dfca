/* SPDX-License-Identifier: Apache-2.0 */
/* Life, time and events of an emulated chip. */
#include "emu_internal.h"
#include <stdlib.h>
#include <string.h>

#define NS_PER_S 1000000000u
#define FAR_NS (10u * (uint64_t)NS_PER_S) /* no multiplication overflows up to here */
#define ENDLESS 100000                    /* events at one moment: a model that does not get on */

/* ---- an idle world ---- */

static void idle_advance(void *ctx, uint64_t now_ns)
{
    (void)ctx;
    (void)now_ns;
}

static uint64_t idle_next(void *ctx)
{
    (void)ctx;
    return EMU_NEVER;
}

static int idle_pin_in(void *ctx, unsigned port, unsigned pin)
{
    (void)ctx;
    (void)port;
    (void)pin;
    return -1;
}

static void idle_pin_out(void *ctx, unsigned port, unsigned pin, emu_drive drive)
{
    (void)ctx;
    (void)port;
    (void)pin;
    (void)drive;
}

static emu_i2c_answer idle_i2c_byte(void *ctx, unsigned bus, uint8_t byte)
{
    (void)ctx;
    (void)bus;
    (void)byte;
    return EMU_I2C_NACK;
}

static uint8_t idle_i2c_read(void *ctx, unsigned bus, bool ack)
{
    (void)ctx;
    (void)bus;
    (void)ack;
    return 0xff;
}

static void idle_i2c_stop(void *ctx, unsigned bus)
{
    (void)ctx;
    (void)bus;
}

static unsigned idle_i2c_lines(void *ctx, unsigned bus)
{
    (void)ctx;
    (void)bus;
    return 0;
}

static uint64_t idle_i2c_stretch(void *ctx, unsigned bus)
{
    (void)ctx;
    (void)bus;
    return 0;
}

static uint16_t idle_spi(void *ctx, unsigned bus, const emu_spi_frame *frame)
{
    (void)ctx;
    (void)bus;
    (void)frame;
    return 0xffff;
}

static emu_can_result idle_can_out(void *ctx, unsigned bus, const emu_can_frame *frame)
{
    (void)ctx;
    (void)bus;
    (void)frame;
    return EMU_CAN_NO_ACK;
}

static emu_can_wire idle_can_wire(void *ctx, unsigned bus)
{
    (void)ctx;
    (void)bus;
    return EMU_CAN_RECESSIVE;
}

static void idle_uart(void *ctx, unsigned uart, uint8_t byte)
{
    (void)ctx;
    (void)uart;
    (void)byte;
}

static double idle_adc(void *ctx, unsigned adc, unsigned channel)
{
    (void)ctx;
    (void)adc;
    (void)channel;
    return 0.0;
}

#define IDLE(member, function)                                                                               \
    do {                                                                                                     \
        if (w->member == NULL) {                                                                             \
            w->member = (function);                                                                          \
        }                                                                                                    \
    } while (0)

static void fill_world(emu_world *w)
{
    IDLE(advance, idle_advance);
    IDLE(next, idle_next);
    IDLE(pin_in, idle_pin_in);
    IDLE(pin_out, idle_pin_out);
    IDLE(i2c_start, idle_i2c_byte);
    IDLE(i2c_write, idle_i2c_byte);
    IDLE(i2c_read, idle_i2c_read);
    IDLE(i2c_stop, idle_i2c_stop);
    IDLE(i2c_lines, idle_i2c_lines);
    IDLE(i2c_stretch_ns, idle_i2c_stretch);
    IDLE(spi_frame, idle_spi);
    IDLE(can_out, idle_can_out);
    IDLE(can_wire, idle_can_wire);
    IDLE(uart_out, idle_uart);
    IDLE(adc_volts, idle_adc);
}

/* ---- life ---- */

emu *emu_create(const emu_chip *chip, const emu_world *world)
{
    emu *e = calloc(1, sizeof *e);

    if (e == NULL) {
        return NULL;
    }
    e->chip = chip;
    if (world != NULL) {
        e->world = *world;
    }
    fill_world(&e->world);
    e->crystal = true;
    e->powered = true;
    e->supply_mv = 3300;
    e->lsi_hz = chip->lsi_hz;
    e->reset_asked = EMU_CAUSES;
    e->world_done = EMU_NEVER;
    e->clock = (emu_clocks){
        .sysclk = chip->hsi_hz, .hclk = chip->hsi_hz, .pclk1 = chip->hsi_hz, .pclk2 = chip->hsi_hz};
    if (!emu_memory_make(e)) {
        emu_destroy(e);
        return NULL;
    }
    for (unsigned i = 0; i < chip->instance_count; i++) {
        if (chip->instances[i].create(e, &chip->instances[i]) == NULL) {
            emu_destroy(e);
            return NULL;
        }
    }
    emu_take_reset(e, EMU_CAUSE_POWER);
    return e;
}

void emu_destroy(emu *e)
{
    if (e == NULL) {
        return;
    }
    emu_cpu_close(e);
    for (unsigned i = 0; i < e->periphs; i++) {
        free(e->periph[i]->state);
        free(e->periph[i]);
    }
    emu_memory_drop(e);
    free(e);
}

emu_periph *emu_periph_new(emu *e, const emu_instance *at, size_t state_size)
{
    emu_periph *p = calloc(1, sizeof *p);

    if (p == NULL || e->periphs == EMU_SLOTS) {
        free(p);
        return NULL;
    }
    p->state = calloc(1, state_size + 1);
    if (p->state == NULL) {
        free(p);
        return NULL;
    }
    p->at = at;
    p->e = e;
    p->slot = (uint8_t)e->periphs;
    e->periph[e->periphs++] = p;
    return p;
}

emu_periph *emu_periph_find(const emu *e, const char *name)
{
    for (unsigned i = 0; i < e->periphs; i++) {
        if (strcmp(e->periph[i]->at->name, name) == 0) {
            return e->periph[i];
        }
    }
    return NULL;
}

/* ---- time ---- */

uint64_t emu_now(const emu *e)
{
    return e->base_ns + (e->cycle - e->base_cycle) * NS_PER_S / e->clock.hclk;
}

void emu_set_now(emu *e, uint64_t ns)
{
    if (ns > emu_now(e)) {
        e->base_ns = ns;
        e->base_cycle = e->cycle;
    }
}

uint64_t emu_cycle_of(const emu *e, uint64_t ns)
{
    uint64_t delta = ns > e->base_ns ? ns - e->base_ns : 0;

    if (delta > FAR_NS) {
        delta = FAR_NS;
    }
    return e->base_cycle + (delta * e->clock.hclk + NS_PER_S - 1) / NS_PER_S;
}

uint64_t emu_cycles_ns(uint32_t hz, uint64_t n)
{
    if (hz == 0) {
        return EMU_NEVER;
    }
    return n / hz * NS_PER_S + (n % hz * NS_PER_S + hz - 1) / hz;
}

void emu_set_clocks(emu *e, const emu_clocks *c)
{
    if (memcmp(c, &e->clock, sizeof *c) == 0) {
        return;
    }
    e->base_ns = emu_now(e);
    e->base_cycle = e->cycle;
    e->clock = *c;
    e->touched = UINT64_MAX;
    for (unsigned i = 0; i < e->periphs; i++) {
        if (e->periph[i]->clock != NULL) {
            e->periph[i]->clock(e->periph[i]);
        }
    }
    emu_kick(e);
}

uint32_t emu_bus_hz(const emu *e, emu_bus bus)
{
    switch (bus) {
    case EMU_APB1:
        return e->clock.pclk1;
    case EMU_APB2:
        return e->clock.pclk2;
    case EMU_AHB:
    case EMU_CORE:
        break;
    }
    return e->clock.hclk;
}

uint32_t emu_kernel_hz(const emu *e, const emu_instance *at)
{
    bool divided = at->bus == EMU_APB1 ? e->clock.apb1_divided : e->clock.apb2_divided;

    switch (at->kernel) {
    case EMU_KERNEL_TIMER:
        return emu_bus_hz(e, at->bus) * (divided ? 2u : 1u);
    case EMU_KERNEL_I2C1:
        return e->clock.i2c1;
    case EMU_KERNEL_USART:
        return e->clock.usart[at->number & 3u];
    case EMU_KERNEL_LSI:
        return e->lsi_hz;
    case EMU_KERNEL_ADC14:
    case EMU_KERNEL_BUS:
        break;
    }
    return emu_bus_hz(e, at->bus);
}

/* ---- events ---- */

const emu_world *emu_outside(emu *e)
{
    uint64_t now = emu_now(e);

    if (now != e->world_now) {
        e->world_now = now;
        e->world.advance(e->world.ctx, now);
        e->exti_dirty = true;
        emu_kick(e);
    }
    return &e->world;
}

static uint64_t world_next(const emu *e)
{
    uint64_t t = e->world.next(e->world.ctx);

    /* one call per moment: a world that still says "now" has had its turn */
    return e->world_done != EMU_NEVER && t <= e->world_done ? EMU_NEVER : t;
}

static uint64_t periph_next(const emu_periph *p)
{
    return p->next != NULL ? p->next(p) : EMU_NEVER;
}

/* Only models that something happened to are asked again. */
static void ask_touched(emu *e)
{
    uint64_t touched = e->touched;

    e->touched = 0;
    for (unsigned i = 0; touched != 0; i++, touched >>= 1) {
        if ((touched & 1u) != 0 && i < e->periphs) {
            e->due[i] = periph_next(e->periph[i]);
        }
    }
}

uint64_t emu_next_event(emu *e)
{
    uint64_t t = world_next(e);

    ask_touched(e);
    for (unsigned i = 0; i < e->periphs; i++) {
        t = e->due[i] < t ? e->due[i] : t;
    }
    return t;
}

static bool run_due(emu *e, uint64_t now)
{
    bool any = false;

    if (world_next(e) <= now) {
        (void)emu_outside(e);
        e->world_done = now;
        e->exti_dirty = true;
        any = true;
    }
    for (unsigned i = 0; i < e->periphs; i++) {
        if (e->touched != 0) {
            ask_touched(e);
        }
        if (e->due[i] <= now) {
            emu_touch(e, e->periph[i]);
            e->periph[i]->run(e->periph[i]);
            emu_touch(e, e->periph[i]);
            any = true;
        }
    }
    return any;
}

void emu_events(emu *e)
{
    uint64_t now = emu_now(e);
    unsigned rounds = 0;

    while (run_due(e, now)) {
        if (++rounds == ENDLESS) {
            emu_misuse_named(e, "EMU", "time", "a model does not get on at %llu ns", (unsigned long long)now);
            return;
        }
    }
    if (e->exti_dirty) {
        e->exti_dirty = false;
        emu_exti_refresh(e);
    }
}

void emu_advance(emu *e, uint64_t ns)
{
    uint64_t until = emu_now(e) + ns;

    for (;;) {
        emu_events(e);
        emu_settle_reset(e);
        uint64_t next = emu_next_event(e);

        if (next > until) {
            break;
        }
        emu_set_now(e, next);
    }
    emu_set_now(e, until);
    (void)emu_outside(e);
    emu_events(e);
}

void emu_stall_until(emu *e, uint64_t ns)
{
    if (ns > e->stall_ns) {
        e->stall_ns = ns;
    }
    emu_kick(e);
}

void emu_stop_on_reset(emu *e, bool stop)
{
    e->stop_on_reset = stop;
}

void emu_stop_here(emu *e)
{
    e->stop_here = true;
    emu_kick(e);
}

/* ---- what comes in ---- */

static emu_periph *numbered(const emu *e, unsigned number, bool can)
{
    for (unsigned i = 0; i < e->periphs; i++) {
        emu_periph *p = e->periph[i];

        if (p->at->number == number && (can ? p->can_in != NULL : p->uart_in != NULL)) {
            return p;
        }
    }
    return NULL;
}

bool emu_uart_in(emu *e, unsigned uart, uint8_t byte)
{
    emu_periph *p = numbered(e, uart, false);

    emu_kick(e);
    e->touched = UINT64_MAX;
    return p != NULL && emu_clocked(e, p->at) && p->uart_in(p, byte);
}

bool emu_can_in(emu *e, unsigned can, const emu_can_frame *frame)
{
    emu_periph *p = numbered(e, can, true);

    emu_kick(e);
    e->touched = UINT64_MAX;
    return p != NULL && emu_clocked(e, p->at) && p->can_in(p, frame);
}
