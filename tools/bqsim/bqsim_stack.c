/* SPDX-License-Identifier: Apache-2.0 */
/* Life and bus of the bq76PL536 stack. */
#include "bqsim_call.h"
#include <string.h>

static const bqsim_text nothing = {NULL, 0};

bqsim_result bqsim_stack_create(bqsim_call *c)
{
    bqsim_session *s = c->s;
    uint32_t devices;

    if (!bqsim_last_count(c, "number of devices", 1, SIM_PL_MAX_DEVICES, &devices)) {
        return BQSIM_ERR;
    }
    if (sim_pl_init(&s->stack, (int)devices, &s->options) != 0) {
        return bqsim_refuse(c, "the model refuses these options", nothing);
    }
    s->has_stack = true;
    s->mosi.count = 0;
    s->miso.count = 0;
    for (uint32_t d = 1; d <= devices; d++) {
        s->vbat_is_sum[d] = true;
        s->gpio_level[d] = true;
    }
    sim_pl_advance(&s->stack, s->now_ns); /* one time for everything, also in the waveform */
    sim_pl_record(&s->stack, s->vcd);
    return bqsim_accept(c, NULL);
}

bqsim_result bqsim_stack_inject(bqsim_call *c, bqsim_flips *flips)
{
    uint32_t bit;

    if (!c->s->has_stack) {
        return bqsim_refuse(c, "no stack", nothing);
    }
    if (!bqsim_last_count(c, "bit", 0, 8 * SIM_PL_PACKET_MAX - 1, &bit)) {
        return BQSIM_ERR;
    }
    if (flips->count == BQSIM_FLIPS) {
        return bqsim_refuse(c, "too many bits armed for one packet", nothing);
    }
    flips->bit[flips->count++] = bit;
    return bqsim_accept(c, NULL);
}

static void flip(uint8_t *bytes, size_t n, uint32_t bit)
{
    if (bit / 8 < n) {
        bytes[bit / 8] ^= (uint8_t)(0x80u >> (bit % 8));
    }
}

/* The model flips the first armed bit itself; any further ones toward the devices go in here. */
static bool flip_more_mosi(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    const bqsim_flips *f = ctx;

    (void)rx;
    for (int i = 1; i < f->count; i++) {
        flip(tx, n, f->bit[i]);
    }
    return false;
}

static void arm(bqsim_session *s)
{
    sim_bus_fault *f = sim_pl_bus_fault(&s->stack);

    f->flip_mosi_bit = s->mosi.count > 0 ? (int)s->mosi.bit[0] + 1 : 0;
    f->flip_miso_bit = s->miso.count > 0 ? (int)s->miso.bit[0] + 1 : 0;
    f->hook = s->mosi.count > 1 ? flip_more_mosi : NULL;
    f->hook_ctx = &s->mosi;
}

/* Armed bits count for one packet only, whether or not it was long enough. */
static void disarm(bqsim_session *s, size_t n)
{
    sim_bus_fault *f = sim_pl_bus_fault(&s->stack);

    for (int i = 1; i < s->miso.count; i++) {
        flip(s->rx, n, s->miso.bit[i]);
    }
    f->flip_mosi_bit = 0;
    f->flip_miso_bit = 0;
    f->hook = NULL;
    s->mosi.count = 0;
    s->miso.count = 0;
}

static void transfer(bqsim_session *s, size_t n)
{
    if (s->mosi.count + s->miso.count == 0) {
        sim_pl_spi(&s->stack, s->tx, s->rx, s->driven,
                   n); /* faults armed through the model's own door stay */
        return;
    }
    arm(s);
    sim_pl_spi(&s->stack, s->tx, s->rx, s->driven, n);
    disarm(s, n);
}

static void print_received(bqsim_call *c, size_t n)
{
    static const char digit[] = "0123456789abcdef";
    char *p = c->reply;

    *p++ = 'o';
    *p++ = 'k';
    for (size_t i = 0; i < n; i++) {
        *p++ = ' ';
        *p++ = c->s->driven[i] ? digit[c->s->rx[i] >> 4] : '-';
        *p++ = c->s->driven[i] ? digit[c->s->rx[i] & 15] : '-';
    }
    *p = '\0';
}

bqsim_result bqsim_stack_spi(bqsim_call *c)
{
    bqsim_text word;
    size_t n = 0;

    if (!c->s->has_stack) {
        return bqsim_refuse(c, "no stack", nothing);
    }
    while (bqsim_word(&c->rest, &word)) {
        if (n == BQSIM_PACKET_MAX || !bqsim_hex8(word, &c->s->tx[n])) {
            return bqsim_refuse(c, "a byte is two hex digits", word);
        }
        n++;
    }
    if (n == 0) {
        return bqsim_refuse(c, "missing bytes", nothing);
    }
    if (c->size < 3 * n + 3) {
        return bqsim_refuse(c, "reply does not fit", nothing);
    }
    transfer(c->s, n);
    print_received(c, n);
    return BQSIM_OK;
}

bqsim_result bqsim_stack_peek(bqsim_call *c, bqsim_text device)
{
    static const char digit[] = "0123456789abcdef";
    bqsim_text word;
    uint32_t d;
    uint8_t reg;
    unsigned value;
    char text[3];

    if (!c->s->has_stack) {
        return bqsim_refuse(c, "no stack", nothing);
    }
    if (!bqsim_count(device, 1, (uint32_t)c->s->stack.devices, &d)) {
        return bqsim_refuse(c, "no such device", device);
    }
    if (!bqsim_argument(c, "register", &word)) {
        return BQSIM_ERR;
    }
    if (!bqsim_hex8(word, &reg)) {
        return bqsim_refuse(c, "a register is two hex digits", word);
    }
    if (!bqsim_end(c)) {
        return BQSIM_ERR;
    }
    value = (unsigned)sim_pl_peek(&c->s->stack, (int)d, reg) & 0xffu;
    text[0] = digit[value >> 4];
    text[1] = digit[value & 15];
    text[2] = '\0';
    return bqsim_accept(c, text);
}
