/* SPDX-License-Identifier: Apache-2.0 */
#include "bench.h"
#include "rows.h"
#include <stdio.h>

bench b;
static uint32_t seed = 1;

uint32_t bench_random(uint32_t below)
{
    seed = seed * 1664525u + 1013904223u;
    return (uint32_t)(((uint64_t)(seed >> 8) * below) >> 24);
}

static uint8_t crc8(uint8_t crc, uint8_t byte)
{
    int i;
    crc = (uint8_t)(crc ^ byte);
    for (i = 0; i < 8; i++)
        crc = (uint8_t)((crc & 0x80u) ? (crc << 1) ^ 0x07 : crc << 1);
    return crc;
}

/* ---- back-end -------------------------------------------------------------------------------- */

static void note_write(bench_entry *e, const uint8_t *p, uint16_t len)
{
    bool crc = b.chip.part->crc;
    uint16_t i, n = 0;
    uint8_t sum = crc8(crc8(0, (uint8_t)(e->address7 << 1)), p[0]);
    e->reg = p[0];
    e->crc_good = true;
    for (i = 1; i < len; i++) {
        if (n < LOG_DATA)
            e->data[n] = p[i];
        n++;
        if (!crc)
            continue;
        sum = crc8(n == 1 ? sum : (uint8_t)0, p[i]);
        i++;
        e->crc_good = e->crc_good && i < len && p[i] == sum;
    }
    e->wrote = (uint8_t)n;
}

static void on_wire(const char *token, unsigned byte)
{
    if (b.wire_used + 8 < sizeof b.wire)
        b.wire_used += (size_t)snprintf(b.wire + b.wire_used, sizeof b.wire - b.wire_used, token, byte);
}

static bool send_byte(uint8_t byte)
{
    bool ack = sim_x0_i2c_write(&b.chip, byte);
    on_wire(ack ? "%02x+ " : "%02x- ", byte);
    return ack;
}

static void stop(void)
{
    sim_x0_i2c_stop(&b.chip);
    on_wire("P ", 0);
}

static bool bytes_go(const bq_i2c_segment *s, uint8_t address7, uint16_t limit)
{
    uint16_t i;
    sim_x0_i2c_start(&b.chip);
    on_wire("S ", 0);
    if (!send_byte((uint8_t)(address7 << 1 | (s->read ? 1 : 0))))
        return false;
    for (i = 0; i < s->len && i < limit; i++) {
        if (s->read) {
            s->data[i] = sim_x0_i2c_read(&b.chip, i + 1 < s->len);
            on_wire("%02x ", s->data[i]);
        } else if (!send_byte(s->data[i]))
            return false;
    }
    return limit >= s->len;
}

static bq_status carry_out(uint8_t address7, const bq_i2c_segment *s, size_t count, uint16_t limit)
{
    bq_status result = BQ_OK;
    size_t i;
    if (b.no_power)
        return BQ_E_NACK;
    if (!sim_x0_sda_free(&b.chip))
        return BQ_E_ARBITRATION;
    for (i = 0; i < count && result == BQ_OK; i++) {
        if (!bytes_go(&s[i], address7, limit))
            result = BQ_E_NACK;
        if (result == BQ_OK && (s[i].stop_after || i + 1 == count || b.no_restart))
            stop();
    }
    if (result != BQ_OK)
        stop();
    return result;
}

static spoil what_happens(const bench_entry *e)
{
    uint32_t n = b.spoil_count ? b.spoil_count : 1;
    uint64_t at = b.count;
    if (b.spoil_writes) { /* counts only these */
        bool hit = e->wrote > 0 && e->reg == b.spoil_reg;
        b.spoil_seen += hit;
        at = hit ? b.spoil_seen : 0;
    }
    if (b.spoil_at == 0 || at < b.spoil_at || at >= b.spoil_at + n)
        return SPOIL_NONE;
    return b.spoil_kind;
}

static bq_status spoiled(spoil how, uint8_t address7, const bq_i2c_segment *s, size_t count)
{
    switch (how) {
    case SPOIL_LOST:
        return BQ_E_BUS;
    case SPOIL_NACK:
        return BQ_E_NACK;
    case SPOIL_TIMEOUT:
        return BQ_E_TIMEOUT;
    case SPOIL_UNHEARD:
        (void)carry_out(address7, s, count, 0xffff);
        return BQ_E_BUS;
    case SPOIL_FLIP:
        (void)sim_x0_flip_sda(&b.chip, b.flip_bit);
        return carry_out(address7, s, count, 0xffff);
    case SPOIL_FIRST_HALF:
        (void)carry_out(address7, s, 1, 1);
        return BQ_E_NACK;
    case SPOIL_BROWNOUT:
        (void)sim_x0_set_supply(&b.chip, false);
        (void)sim_x0_set_supply(&b.chip, true);
        return carry_out(address7, s, count, 0xffff);
    default:
        return carry_out(address7, s, count, 0xffff);
    }
}

static bq_status i2c_start(void *ctx, uint8_t address7, const bq_i2c_segment *s, size_t count)
{
    bench_entry *e;
    spoil how;
    size_t i;
    (void)ctx;
    if (b.busy) {
        b.overlaps++;
        return BQ_E_BUSY;
    }
    if (b.hook != NULL)
        b.hook(&b);
    e = &b.log[b.count++ % LOG_MAX];
    memset(e, 0, sizeof *e);
    e->t_ns = b.chip.now;
    e->address7 = address7;
    e->restart = count == 2 && !s[0].stop_after;
    for (i = 0; i < count; i++) {
        e->raw = (uint8_t)(e->raw + s[i].len + 1u);
        if (s[i].read)
            e->read = (uint8_t)(b.chip.part->crc ? s[i].len / 2u : s[i].len);
        else if (s[i].len > 0)
            note_write(e, s[i].data, s[i].len);
    }
    how = what_happens(e);
    if (b.never_free || how == SPOIL_REFUSED)
        return e->status = BQ_E_ARBITRATION;
    if (how == SPOIL_BUSY)
        return e->status = BQ_E_BUSY;
    e->status = b.outcome = spoiled(how, address7, s, count);
    b.busy = true;
    b.ready_ns = e->t_ns + (uint64_t)e->raw * 90000u + (how == SPOIL_LATE ? 8 * MS : 0);
    return BQ_OK;
}

static bq_status i2c_poll(void *ctx)
{
    (void)ctx;
    if (b.stuck_pending > 0)
        return BQ_PENDING;
    if (b.busy && b.chip.now < b.ready_ns)
        return BQ_PENDING;
    b.busy = false;
    return b.outcome;
}

static bq_status i2c_recover(void *ctx)
{
    int i;
    (void)ctx;
    b.recoveries++;
    b.busy = false;
    if (b.never_free)
        return BQ_E_ARBITRATION;
    for (i = 0; i < 9 && !sim_x0_sda_free(&b.chip); i++)
        sim_x0_recovery_clock(&b.chip);
    return sim_x0_sda_free(&b.chip) ? BQ_OK : BQ_E_ARBITRATION;
}

static bq_status line_read(void *ctx, bq_line line, bool *level)
{
    (void)ctx;
    if ((b.missing >> line) & 1u)
        return BQ_E_UNSUPPORTED;
    *level = line == BQ_LINE_ALERT && sim_x0_alert(&b.chip);
    return BQ_OK;
}

static bq_status line_write(void *ctx, bq_line line, bool level)
{
    (void)ctx;
    if ((b.missing >> line) & 1u)
        return BQ_E_UNSUPPORTED;
    if (line != BQ_LINE_AFE_BOOT || level == b.boot_level)
        return BQ_OK;
    b.boot_level = level;
    if (level) {
        b.rises++;
        b.rise_ns = b.chip.now;
    } else {
        b.falls++;
        b.fall_ns = b.chip.now;
        if (!b.no_power)
            (void)sim_x0_boot_ended(&b.chip, b.rise_ns);
    }
    return BQ_OK;
}

static uint32_t clock_us(void *ctx)
{
    (void)ctx;
    return (uint32_t)(b.chip.now / 1000u) + b.clock_offset;
}

/* ---- what the tests use ----------------------------------------------------------------------- */

void bench_part(const char *name, const sim_x0_options *options)
{
    const sim_x0_part *part = sim_x0_find_part(name);
    int i;
    TEST_ASSERT_NOT_NULL(part);
    memset(&b, 0, sizeof b);
    b.clock_offset = 0xfff00000u; /* the counter wraps soon */
    TEST_ASSERT_EQUAL(0, sim_x0_init(&b.chip, part, options));
    for (i = 1; i <= part->cells; i++)
        (void)sim_x0_set_cell(&b.chip, i, 3.6);
    b.cfg.inputs = b.cfg.cells = part->cells;
    b.cfg.sensors = part->cells / 5;
    b.cfg.sensor = bq769x0_sensor_thermistor;
    b.cfg.sensor_ctx = &bq_thermistor_103at;
    b.cfg.shunt_uohm = 5000;
    b.cfg.ov_mv = 4200;
    b.cfg.uv_mv = 2800;
    b.cfg.ov_recover_mv = 4100;
    b.cfg.uv_recover_mv = 3000;
    b.cfg.ov_delay_s = b.cfg.uv_delay_s = 1;
    b.cfg.ocd_ma = 8000;
    b.cfg.scd_ma = 15000;
    b.cfg.ocd_delay_ms = 320;
    b.cfg.scd_delay_us = 100;
    b.sample.cells = b.cells;
    b.sample.temps = b.temps;
    b.sample.modules = &b.module;
    b.sample.cell_capacity = 16;
    b.sample.temp_capacity = 4;
    b.sample.module_capacity = 1;
    b.action.charge_on = b.action.discharge_on = b.action.clear_faults = true;
}

static uint16_t wiring(void)
{
    return b.cfg.wiring ? b.cfg.wiring : rows_wiring(b.cfg.inputs, b.cfg.cells);
}

void bench_cells(double volts)
{
    int i;
    for (i = 1; i <= b.chip.part->cells; i++)
        (void)sim_x0_set_cell(&b.chip, i, (wiring() >> (i - 1)) & 1 ? volts : 0.0);
}

bq_i2c bench_i2c(void)
{
    static const bq_i2c_ops bus = {i2c_start, i2c_poll, i2c_recover};
    bq_i2c i2c = {&bus, NULL};
    return i2c;
}

bq_clock bench_clock(void)
{
    bq_clock clock = {clock_us, NULL};
    return clock;
}

const bq_link_stats *bench_stats(void)
{
    bq_afe afe = bq769x0_afe(&b.d);
    return afe.ops->stats(afe.ctx);
}

bq_status bench_init(void)
{
    static const bq_gpio_ops lines = {line_read, line_write};
    bq_i2c i2c = bench_i2c();
    bq_gpio gpio = {&lines, NULL};
    bq_clock clock = bench_clock();
    bq_status s = bq769x0_init(&b.d, &b.cfg, &i2c, &gpio, &clock);
    if (s == BQ_OK && b.cfg.cells < b.cfg.inputs)
        bench_cells(3.6);
    return s;
}

bq_status bench_run(uint32_t ms)
{
    uint64_t end = b.chip.now + ms * MS;
    bq_status s;
    for (;;) {
        uint32_t wait = 0;
        s = bq769x0_poll(&b.d, &wait);
        if (s != BQ_PENDING)
            return s;
        if (b.chip.now > end)
            break;
        sim_x0_advance(&b.chip, (uint64_t)(wait < 20 ? 20 : wait > 50000 ? 50000 : wait) * 1000u);
    }
    TEST_FAIL_MESSAGE("the job does not end");
    return s;
}

bq_status bench_start(void)
{
    TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_start(&b.d));
    return bench_run(20000);
}

void bench_up(const char *name)
{
    bench_part(name, NULL);
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
}

bq_status bench_picture(void)
{
    return bq769x0_sample(&b.d, &b.sample);
}

bq_status bench_scan(void)
{
    bq_status s = bq769x0_begin_scan(&b.d);
    if (s != BQ_OK)
        return s;
    s = bench_run(60000);
    (void)bench_picture();
    return s;
}

bq_status bench_apply(bool charge, bool discharge, uint32_t balance)
{
    bq_action a;
    bq_status s;
    memset(&a, 0, sizeof a);
    a.charge_on = charge;
    a.discharge_on = discharge;
    a.balance[0] = balance;
    s = bq769x0_begin_apply(&b.d, &a);
    return s == BQ_OK ? bench_run(5000) : s;
}

static void step(uint32_t period)
{
    uint64_t from = b.chip.now;
    (void)bench_scan();
    if (bq769x0_begin_apply(&b.d, &b.action) == BQ_OK)
        (void)bench_run(5000);
    if (b.chip.now < from + period * MS)
        sim_x0_advance(&b.chip, from + period * MS - b.chip.now);
}

void bench_serve(uint32_t ms, uint32_t period)
{
    uint64_t end = b.chip.now + ms * MS;
    while (b.chip.now < end)
        step(period);
}

uint32_t bench_until(bool chg, bool dsg, uint32_t limit)
{
    uint64_t from = b.chip.now;
    for (;;) {
        uint32_t passed = (uint32_t)((b.chip.now - from) / MS);
        if ((sim_x0_chg(&b.chip) == chg && sim_x0_dsg(&b.chip) == dsg) || passed >= limit)
            return passed < limit ? passed : limit;
        step(250);
    }
}

uint32_t bench_until_on(uint32_t limit, uint32_t period)
{
    uint64_t from = b.chip.now;
    while (b.chip.now < from + limit * MS) {
        bench_serve(period, period);
        if (sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip))
            break;
    }
    return (uint32_t)((b.chip.now - from) / MS);
}

void bench_wait(double ms)
{
    sim_x0_advance(&b.chip, (uint64_t)(ms * 1e6));
}

uint64_t bench_now_ms(void)
{
    return b.chip.now / MS;
}

const bench_entry *bench_log(uint64_t n)
{
    TEST_ASSERT_TRUE(n < b.count && b.count - n <= LOG_MAX);
    return &b.log[n % LOG_MAX];
}

unsigned bench_writes(uint64_t from, uint8_t reg, uint8_t *value)
{
    unsigned hits = 0;
    uint64_t n;
    for (n = from; n < b.count; n++) {
        const bench_entry *e = bench_log(n);
        if (reg < e->reg || reg >= e->reg + e->wrote)
            continue;
        hits++;
        if (value != NULL)
            *value = e->data[reg - e->reg];
    }
    return hits;
}

void bench_no_misuse(int line)
{
    if (b.chip.misuse.count > 0) {
        char text[160];
        (void)snprintf(text, sizeof text, "%u misuses, first %s: %s", b.chip.misuse.count,
                       b.chip.misuse.entry[0].id, b.chip.misuse.entry[0].text);
        UnityFailAt(line, text);
    }
    if (b.overlaps > 0)
        UnityFailAt(line, "a transaction was started while another ran");
}
