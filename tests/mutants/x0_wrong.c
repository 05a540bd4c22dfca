/* SPDX-License-Identifier: Apache-2.0 */
#include "x0_wrong.h"
#include "bqhost/crc8.h"
#include <string.h>

bq_status __real_bq769x0_init(bq769x0 *d, const bq769x0_config *config, const bq_i2c *i2c,
                              const bq_gpio *gpio, const bq_clock *clock);
bq_status __wrap_bq769x0_init(bq769x0 *d, const bq769x0_config *config, const bq_i2c *i2c,
                              const bq_gpio *gpio, const bq_clock *clock);

static struct {
    bq769x0 *driver;
    bq769x0_config config;
    bq_i2c bus;
    bq_i2c_ops ops;
    uint8_t seen[256];
    /* the transaction under way */
    uint8_t address7, reg, out[96], pointer, one[2];
    bq_i2c_segment whole, part[2];
    unsigned n, at;
    bool reading, stepping, damaged;
    /* what was read last */
    uint8_t last_reg;
    unsigned last_n;
    /* writes of the variant itself */
    struct {
        uint8_t reg, value;
    } also[4];
    unsigned also_count;
    bool also_runs;
} w;

bq769x0 *x0_wrong_driver(void)
{
    return w.driver;
}

const bq769x0_config *x0_wrong_config(void)
{
    return &w.config;
}

uint8_t x0_wrong_seen(uint8_t reg)
{
    return w.seen[reg];
}

void x0_wrong_also_write(uint8_t reg, uint8_t value)
{
    w.also[w.also_count].reg = reg;
    w.also[w.also_count++].value = value;
}

static bool with_crc(void)
{
    return bq769x0_get_achieved(w.driver)->crc;
}

/* The bytes of a write: register, then data with or without CRC; their number. */
static uint16_t encode(uint8_t *out, uint8_t reg, const uint8_t *data, unsigned n)
{
    uint8_t head[2] = {(uint8_t)(w.address7 << 1), reg};
    uint8_t crc = bq_crc8(0, head, 2);
    unsigned length = 0;
    out[length++] = reg;
    for (unsigned i = 0; i < n; i++) {
        out[length++] = data[i];
        if (with_crc()) {
            out[length++] = bq_crc8(i == 0 ? crc : 0, &data[i], 1);
        }
    }
    return (uint16_t)length;
}

static uint8_t crc_of_read(unsigned i, uint8_t data)
{
    uint8_t head = (uint8_t)(w.address7 * 2 + 1);
    return bq_crc8(i == 0 ? bq_crc8(0, &head, 1) : 0, &data, 1);
}

static bq_status send_write(const bq_i2c_segment *s)
{
    uint8_t data[48];
    unsigned step = with_crc() ? 2 : 1, n = (unsigned)(s->len - 1) / step;
    for (unsigned i = 0; i < n; i++) {
        data[i] = s->data[1 + i * step];
    }
    w.reading = false;
    w.part[0] = *s;
    if (n != 0 && wrong.say != NULL && wrong.say(s->data[0], n, data)) {
        mutant_acted();
        w.part[0].data = w.out;
        w.part[0].len = encode(w.out, s->data[0], data, n);
    }
    return w.bus.ops->start(w.bus.ctx, w.address7, w.part, 1);
}

static bq_status send_one(void)
{
    w.pointer = (uint8_t)(w.reg + w.at);
    w.part[0] = (bq_i2c_segment){&w.pointer, 1, false, false};
    w.part[1] = (bq_i2c_segment){w.one, with_crc() ? 2 : 1, true, true};
    return w.bus.ops->start(w.bus.ctx, w.address7, w.part, 2);
}

static bq_status send_read(const bq_i2c_segment *s)
{
    bool again;
    w.reading = true;
    w.reg = s[0].data[0];
    w.whole = s[1];
    w.n = with_crc() ? s[1].len / 2u : s[1].len;
    again = w.damaged && w.reg == w.last_reg && w.n == w.last_n;
    w.stepping = wrong.one_by_one && w.n > 1 && w.reg >= BQ769X0_VC1_HI && w.reg < BQ769X0_ADCGAIN1;
    if (w.stepping) {
        mutant_acted();
        w.at = 0;
        return send_one();
    }
    if (wrong.without_pointer != NULL && wrong.without_pointer(again)) {
        mutant_acted();
        return w.bus.ops->start(w.bus.ctx, w.address7, s + 1, 1);
    }
    return w.bus.ops->start(w.bus.ctx, w.address7, s, 2);
}

static bq_status wrong_start(void *ctx, uint8_t address7, const bq_i2c_segment *segments, size_t count)
{
    (void)ctx;
    w.address7 = address7;
    w.also_runs = false;
    w.also_count = 0;
    return count == 1 ? send_write(segments) : send_read(segments);
}

/* The next register of a block that is read one by one; BQ_OK when the block is complete. */
static bq_status next_one(void)
{
    w.whole.data[with_crc() ? 2 * w.at : w.at] = w.one[0];
    if (with_crc()) {
        if (crc_of_read(0, w.one[0]) != w.one[1]) {
            w.whole.data[1] = (uint8_t)(w.whole.data[1] + 1u); /* the driver is to notice */
            return BQ_OK;
        }
        w.whole.data[2 * w.at + 1] = crc_of_read(w.at, w.one[0]);
    }
    if (++w.at == w.n) {
        return BQ_OK;
    }
    bq_status st = send_one();
    return st == BQ_OK ? BQ_PENDING : st;
}

static void heard(void)
{
    uint8_t data[48];
    unsigned step = with_crc() ? 2 : 1, bad = w.n;
    for (unsigned i = w.n; i-- > 0;) {
        data[i] = w.whole.data[i * step];
        if (step == 2 && w.whole.data[2 * i + 1] != crc_of_read(i, data[i])) {
            bad = i;
        }
    }
    w.damaged = bad < w.n;
    w.last_reg = w.reg;
    w.last_n = w.n;
    for (unsigned i = 0; !w.damaged && i < w.n; i++) {
        w.seen[(uint8_t)(w.reg + i)] = data[i];
    }
    if (wrong.hear == NULL || !wrong.hear(w.reg, w.n, data, bad)) {
        return;
    }
    mutant_acted();
    for (unsigned i = 0; i < w.n; i++) {
        w.whole.data[i * step] = data[i];
        if (step == 2) {
            w.whole.data[2 * i + 1] = crc_of_read(i, data[i]);
        }
    }
}

static bq_status also(void)
{
    w.also_runs = true;
    w.also_count--;
    w.part[0] = (bq_i2c_segment){
        w.out, encode(w.out, w.also[w.also_count].reg, &w.also[w.also_count].value, 1), false, true};
    mutant_acted();
    return w.bus.ops->start(w.bus.ctx, w.address7, w.part, 1) == BQ_OK ? BQ_PENDING : BQ_OK;
}

static bq_status wrong_poll(void *ctx)
{
    bq_status st = w.bus.ops->poll(w.bus.ctx);
    (void)ctx;
    if (st == BQ_PENDING) {
        return st;
    }
    if (st == BQ_OK && w.reading && !w.also_runs) {
        if (w.stepping) {
            st = next_one();
        }
        if (st != BQ_OK) {
            return st;
        }
        heard();
    }
    if (w.also_runs) {
        st = BQ_OK; /* the variant does not look how its own writes ended */
    }
    return w.also_count != 0 ? also() : st;
}

static bq_status wrong_recover(void *ctx)
{
    (void)ctx;
    return w.bus.ops->recover(w.bus.ctx);
}

bq_status __wrap_bq769x0_init(bq769x0 *d, const bq769x0_config *config, const bq_i2c *i2c,
                              const bq_gpio *gpio, const bq_clock *clock)
{
    bq_i2c mine = {&w.ops, NULL};
    w.driver = d;
    w.config = *config;
    w.bus = *i2c;
    w.damaged = false;
    w.ops = (bq_i2c_ops){wrong_start, wrong_poll, i2c->ops->recover != NULL ? wrong_recover : NULL};
    if (wrong.config != NULL) {
        bq769x0_config before = w.config;
        wrong.config(&w.config);
        if (memcmp(&before, &w.config, sizeof before) != 0) {
            mutant_acted();
        }
    }
    return __real_bq769x0_init(d, &w.config, &mine, gpio, clock);
}
