/* SPDX-License-Identifier: Apache-2.0 */
/* The firmware as the image of a board in the emulator. It is told what to do through its settings and pins,
 * and what it does is seen on its pins, its buses and on CAN, as with a board on a real bench. */
#include "bqhost/settings.h"
#include "ps_mirror.h"
#include "ps_wires.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TURN (5 * PS_MS)          /* the longest time between two looks at the scenario */
#define CLOCK_COUNTER 0x40000024u /* TIM2_CNT: the firmware's microseconds */
#define RECORD_MAX (4u * BQ_SETTINGS_MAX_WORDS)
#define CONSOLE_UART 2
#define FRAMES 128
#define OCV_POINTS 64 /* that a record holds */

typedef struct ps_emulation {
    emu *e;
    const ps_wires *wires;
    ps_mirror mirror;
    uint32_t resets; /* by itself, that restarted() has told */
    int frames;      /* on the bus since the last listen() */
    emu_can_frame frame[FRAMES];
    uint64_t frame_t[FRAMES];
} ps_emulation;

/* ---- the world of the microcontroller --------------------------------------------------------- */

static void advance(void *ctx, uint64_t now_ns)
{
    ps_rig *r = ctx;
    if (now_ns > ps_rig_now(r)) {
        ps_rig_advance(r, now_ns - ps_rig_now(r));
    }
}

static uint64_t next(void *ctx)
{
    const ps_rig *r = ctx;
    uint64_t ns = r->emulation->wires->next(r);
    return ns == UINT64_MAX ? EMU_NEVER : ps_rig_now(r) + ns;
}

static int pin_in(void *ctx, unsigned port, unsigned pin)
{
    ps_rig *r = ctx;
    return r->emulation->wires->level(r, port, pin);
}

/* What is not driven is pulled to where the boards want it in a reset: chip select and SCL high, all else
 * low. */
static bool rests_high(unsigned port, unsigned pin)
{
    return (port == 0 && pin == 4) || (port == 1 && pin == 6);
}

static void pin_out(void *ctx, unsigned port, unsigned pin, emu_drive drive)
{
    ps_rig *r = ctx;
    bool high = drive == EMU_DRIVE_NONE ? rests_high(port, pin) : drive == EMU_DRIVE_HIGH;
    r->emulation->wires->drive(r, port, pin, high);
    if (r->moved) {
        emu_stop_here(r->emulation->e);
    }
}

static void log_frame(ps_rig *r, const emu_can_frame *frame)
{
    bq_can_frame f = {.id = frame->id, .extended = frame->extended, .len = frame->length};
    memcpy(f.data, frame->data, sizeof f.data);
    if (r->can.ops != NULL) {
        (void)r->can.ops->send(r->can.ctx, &f);
    }
}

/* Heard when the processor has let go. */
static emu_can_result can_out(void *ctx, unsigned bus, const emu_can_frame *frame)
{
    ps_rig *r = ctx;
    ps_emulation *m = r->emulation;
    (void)bus;
    log_frame(r, frame);
    if (frame->extended || frame->remote || frame->length != 8 || m->frames == FRAMES) {
        m->mirror.unknown++;
        return EMU_CAN_ACKED;
    }
    m->frame[m->frames] = *frame;
    m->frame_t[m->frames++] = ps_rig_now(r);
    if (frame->id != BQ_TELEMETRY_ID + BQ_FRAME_VOLTAGES || m->frames == FRAMES ||
        3 * (frame->data[0] + 1) >= r->s->cells) {
        emu_stop_here(m->e);
    }
    return EMU_CAN_ACKED;
}

static void listen(ps_rig *r)
{
    ps_emulation *m = r->emulation;
    uint32_t clock_us = 0;
    if (m->frames > 0) {
        (void)emu_bus_read(m->e, CLOCK_COUNTER, 4, &clock_us);
    }
    for (int i = 0; i < m->frames; i++) {
        uint32_t ago_us = (uint32_t)((ps_rig_now(r) - m->frame_t[i]) / 1000u);
        ps_mirror_hear(&m->mirror, r, m->frame[i].id, m->frame[i].data, clock_us - ago_us);
    }
    m->frames = 0;
}

static void uart_out(void *ctx, unsigned uart, uint8_t byte)
{
    const ps_rig *r = ctx;
    (void)uart;
    if (r->console.ops != NULL) {
        (void)r->console.ops->write(r->console.ctx, &byte, 1);
    }
}

static emu_world world_of(ps_rig *r, const ps_wires *wires)
{
    emu_world w = *wires->world;
    w.ctx = r;
    w.advance = advance;
    w.next = next;
    w.pin_in = pin_in;
    w.pin_out = pin_out;
    w.can_out = can_out;
    w.uart_out = uart_out;
    return w;
}

/* ---- settings --------------------------------------------------------------------------------- */

static size_t encode_stack(const ps_scenario *s, bq_ocv_point *points, uint8_t *record)
{
    bq_app_config app = s->app;
    bq76pl536_config driver = s->driver;
    uint8_t cells_of[BQ76PL536_MAX_DEVICES];
    memcpy(cells_of, s->cells_of, sizeof cells_of);
    const bq_settings_part parts[] = {{&bq_app_config_fields, &app, 1},
                                      {&bq_ocv_point_fields, points, OCV_POINTS},
                                      {&bq76pl536_config_fields, &driver, 1},
                                      {&bq_byte_fields, cells_of, BQ76PL536_MAX_DEVICES}};
    const bq_settings settings = {parts, sizeof parts / sizeof parts[0]};
    return bq_settings_encode(&settings, 1, record, RECORD_MAX);
}

static size_t encode_afe(const ps_scenario *s, bq_ocv_point *points, uint8_t *record)
{
    bq_app_config app = s->app;
    bq769x0_config afe = s->afe;
    const bq_settings_part parts[] = {{&bq_app_config_fields, &app, 1},
                                      {&bq_ocv_point_fields, points, OCV_POINTS},
                                      {&bq769x0_config_fields, &afe, 1}};
    const bq_settings settings = {parts, sizeof parts / sizeof parts[0]};
    return bq_settings_encode(&settings, 1, record, RECORD_MAX);
}

static int configure(ps_rig *r, ps_error *e)
{
    bq_ocv_point points[OCV_POINTS] = {{0}};
    uint8_t record[RECORD_MAX];
    const ps_scenario *s = r->s;
    if (s->app.pack.soc.points > OCV_POINTS) {
        return ps_fail(e, s->pack_at, "the settings of a board hold at most %d points of the curve",
                       OCV_POINTS);
    }
    memcpy(points, s->soc_points, s->app.pack.soc.points * sizeof points[0]);
    size_t length = s->part != NULL ? encode_afe(s, points, record) : encode_stack(s, points, record);
    if (length == 0u || !emu_load(r->emulation->e, r->emulation->wires->settings_at, record, length)) {
        return ps_fail(e, s->pack_at, "the settings do not fit into the memory of the board");
    }
    return 0;
}

/* ---- life ------------------------------------------------------------------------------------- */

static uint8_t modules_found(void *ctx)
{
    return ((const ps_mirror *)ctx)->found;
}

static const bq_link_stats *stats(void *ctx)
{
    return &((const ps_mirror *)ctx)->stats;
}

static const ps_wires *wires_of(const ps_rig *r)
{
    return r->s->part != NULL ? &ps_lv_f072 : &ps_hv_f405;
}

static uint32_t word_at(const uint8_t *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

/* The board that an image names behind its vectors, "BQIM" and three words before the name; NULL: none. */
static const char *board_of(const uint8_t *head, size_t n)
{
    for (size_t at = 0; at + 32u <= n; at += 4u) {
        if (memcmp(head + at, "BQIM", 4) == 0) {
            return (const char *)head + at + 16;
        }
    }
    return NULL;
}

/* What is no firmware, or one for the other board, would do nothing for the whole scenario. */
static int look_at_image(const ps_rig *r, ps_error *e)
{
    const ps_place at = {r->image, 0};
    const ps_wires *mine = r->emulation->wires, *other = mine == &ps_lv_f072 ? &ps_hv_f405 : &ps_lv_f072;
    uint8_t head[1024];
    FILE *f = fopen(r->image, "rb");
    if (f == NULL) {
        return ps_fail(e, at, "%s", strerror(errno));
    }
    size_t n = fread(head, 1, sizeof head, f);
    (void)fclose(f);
    /* the stack begins in RAM, the program in flash, with the bit of Thumb */
    if (n < 8u || word_at(head) % 4u != 0u || word_at(head) - 0x10000000u >= 0x20000000u ||
        word_at(head + 4) >> 20 != 0x080u || word_at(head + 4) % 2u != 1u) {
        return ps_fail(e, at, "no firmware: it does not begin with a stack pointer and a reset vector");
    }
    const char *board = board_of(head, n);
    if (board != NULL && strncmp(board, other->board, 16) == 0) {
        return ps_fail(e, at, "an image of %s; this pack needs the board %s", other->board, mine->board);
    }
    return 0;
}

static int power_up(ps_rig *r, ps_error *e)
{
    ps_emulation *m = r->emulation;
    const ps_place at = {r->image, 0};
    if (look_at_image(r, e) != 0) {
        return -1;
    }
    const emu_world world = world_of(r, m->wires);
    m->e = emu_create(m->wires->chip, &world);
    if (m->e == NULL) {
        return ps_fail(e, at, "out of memory");
    }
    if (!emu_cpu_open(m->e)) {
        return ps_fail(e, at, "--image needs the emulator, built without");
    }
    if (!emu_load_file(m->e, r->image)) {
        return ps_fail(e, at, "does not fit into the flash of %s", m->wires->board);
    }
    if (configure(r, e) != 0) {
        return -1;
    }
    if (r->loop != 0u) {
        emu_mark(m->e, r->loop);
    }
    if (r->costs != NULL && !emu_count_code(m->e)) {
        return ps_fail(e, at, "out of memory");
    }
    emu_reset(m->e, EMU_CAUSE_POWER);
    return 0;
}

static int begin(ps_rig *r, ps_error *e)
{
    static const bq_afe_ops ops = {.modules_found = modules_found, .stats = stats};
    const ps_wires *wires = wires_of(r);
    if (r->board != NULL && strcmp(r->board, wires->board) != 0) {
        return ps_fail(e, (ps_place){r->board, 0}, "this pack needs the board %s", wires->board);
    }
    r->emulation = calloc(1, sizeof *r->emulation);
    if (r->emulation == NULL) {
        return ps_fail(e, (ps_place){r->image, 0}, "out of memory");
    }
    r->emulation->wires = wires;
    ps_mirror_begin(&r->emulation->mirror, r);
    r->afe = (bq_afe){&ops, &r->emulation->mirror};
    return power_up(r, e);
}

static void tell_costs(const ps_rig *r)
{
    const emu *e = r->emulation->e;
    const emu_meter *m = emu_get_meter(e);
    uint32_t at = 0x08000000u;
    (void)fprintf(r->costs, "simulated_ns %llu\ninstructions %llu\ncycles_awake %llu\ncycles_asleep %llu\n",
                  (unsigned long long)emu_now(e), (unsigned long long)m->instructions,
                  (unsigned long long)m->cycles, (unsigned long long)m->cycles_asleep);
    (void)fprintf(r->costs, "longest_pass %llu\nlongest_latency %llu\nlongest_isr %llu\nlowest_sp %lx\n",
                  (unsigned long long)m->longest_pass, (unsigned long long)m->longest_latency,
                  (unsigned long long)m->longest_isr, (unsigned long)m->lowest_sp);
    (void)fprintf(r->costs, "scans %lu\n", (unsigned long)r->fw.firmware.app.sample.sequence);
    for (; at < 0x08020000u; at += 2u) {
        if (emu_code_count(e, at) != 0) {
            (void)fprintf(r->costs, "at %lx %llu\n", (unsigned long)at,
                          (unsigned long long)emu_code_count(e, at));
        }
    }
}

static void end(ps_rig *r)
{
    if (r->emulation == NULL) {
        return;
    }
    if (r->emulation->e != NULL && r->costs != NULL) {
        tell_costs(r);
    }
    if (r->emulation->e != NULL) {
        emu_destroy(r->emulation->e);
    }
    free(r->emulation);
    r->emulation = NULL;
}

/* What is typed comes one byte in a turn: slower than the line, so none is lost. */
static uint64_t pass(ps_rig *r)
{
    uint8_t byte;
    if (r->console.ops != NULL && r->console.ops->read(r->console.ctx, &byte, 1) == 1u) {
        (void)emu_uart_in(r->emulation->e, CONSOLE_UART, byte);
    }
    return TURN;
}

static void elapse(ps_rig *r, uint64_t ns)
{
    uint64_t from = ps_rig_now(r);
    (void)emu_run_until(r->emulation->e, from + ns);
    advance(r, emu_now(r->emulation->e));
    listen(r);
}

static void request(ps_rig *r)
{
    (void)r; /* the pin shows it */
}

static uint32_t resets_by_itself(const ps_rig *r)
{
    const emu_meter *m = emu_get_meter(r->emulation->e);
    return m->resets[EMU_CAUSE_SOFTWARE] + m->resets[EMU_CAUSE_IWDG] + m->resets[EMU_CAUSE_WWDG] +
           m->resets[EMU_CAUSE_LOW_POWER];
}

static void new_life(ps_rig *r)
{
    r->lost.bus_errors += r->emulation->mirror.stats.bus_errors;
    r->emulation->frames = 0;
    ps_mirror_begin(&r->emulation->mirror, r);
}

static void reset(ps_rig *r)
{
    emu_reset(r->emulation->e, EMU_CAUSE_PIN);
    new_life(r);
}

static bool restarted(ps_rig *r)
{
    uint32_t resets = resets_by_itself(r);
    if (resets == r->emulation->resets) {
        return false;
    }
    r->emulation->resets = resets;
    new_life(r);
    return true;
}

static sim_misuse *misuse(ps_rig *r)
{
    return emu_get_misuse(r->emulation->e);
}

const ps_player ps_image = {
    .begin = begin,
    .end = end,
    .pass = pass,
    .elapse = elapse,
    .request = request,
    .reset = reset,
    .restarted = restarted,
    .misuse = misuse,
};
