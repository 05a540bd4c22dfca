/* SPDX-License-Identifier: Apache-2.0 */
/* The interception point: what injected faults do to a packet before and after the devices see it. */
#include "sim_pl536_internal.h"
#include <math.h>
#include <string.h>

static void flip(sim_bus_fault *f, uint8_t *bytes, uint64_t bit)
{
    bytes[bit / 8] ^= (uint8_t)(0x80u >> (bit % 8));
    f->flips++;
}

/* Bits until the next flip are geometrically distributed, so that quiet stretches cost nothing. */
static void draw_skip(sim_bus_fault *f)
{
    double u = ((double)(sim_pl_random(&f->rng) >> 11) + 1.0) / 9007199254740993.0; /* 0 < u < 1 */
    double bits = f->flip_probability < 1.0 ? floor(log(u) / log1p(-f->flip_probability)) : 0.0;

    f->skip = bits < 1e18 ? (uint64_t)bits : (uint64_t)1e18;
    f->skip_for = f->flip_probability;
}

static bool random_flips(sim_bus_fault *f, uint8_t *bytes, uint64_t bits)
{
    uint64_t at = 0;
    bool any = false;

    if (!(f->flip_probability > 0.0)) {
        return false;
    }
    if (f->skip_for < f->flip_probability || f->skip_for > f->flip_probability) {
        draw_skip(f);
    }
    while (f->skip < bits - at) {
        at += f->skip;
        flip(f, bytes, at);
        any = true;
        at++;
        draw_skip(f);
    }
    f->skip -= bits - at;
    return any;
}

/* `armed` is 1 + the bit to flip in this packet; it clears itself. */
static bool armed_flip(sim_bus_fault *f, int *armed, uint8_t *bytes, uint64_t bits)
{
    int bit = *armed - 1;

    *armed = 0;
    if (bit < 0 || (uint64_t)bit >= bits) {
        return false;
    }
    flip(f, bytes, (uint64_t)bit);
    return true;
}

static bool stuck(int level, uint8_t *bytes, size_t n)
{
    if (level == 0) {
        return false;
    }
    memset(bytes, level == 1 ? 0x00 : 0xff, n);
    return true;
}

static bool bit_of(const uint8_t *bytes, size_t bit)
{
    return (bytes[bit / 8] >> (7 - bit % 8) & 1) != 0;
}

static bool shift_late(int late, uint8_t *rx, uint8_t *driven, size_t bits)
{
    if (late <= 0) {
        return false;
    }
    for (size_t i = bits; i-- > 0;) {
        bool value = i >= (size_t)late && bit_of(rx, i - (size_t)late);
        uint8_t mask = (uint8_t)(0x80u >> (i % 8));

        rx[i / 8] = (uint8_t)((rx[i / 8] & ~mask) | (value ? mask : 0));
        if (driven != NULL) {
            driven[i / 8] |= i >= (size_t)late ? driven[(i - (size_t)late) / 8] : 0;
        }
    }
    return true;
}

/* A write that a fault hit leaves the device other than the host believes: not the host's doing, for a while.
 */
static void taint(sim_pl *s, const uint8_t *tx, size_t bits)
{
    unsigned address = tx[0] >> 1;

    if (bits < 8 || (tx[0] & 1) == 0) {
        return;
    }
    for (int i = 0; i < s->devices; i++) {
        if (address == ADDR_BROADCAST || sim_pl_address(&s->dev[i]) == address) {
            s->dev[i].tainted_until = s->now + SIM_PL_S;
        }
    }
}

/* Kinds that keep the packet from every device. Returns true when nothing more happens. */
static bool swallowed(sim_bus_fault *f, uint8_t *rx, uint8_t *driven, size_t clocked)
{
    if (f->dead != 0) {
        memset(rx, f->dead == 1 ? 0x00 : 0xff, clocked);
    } else if (f->drop_packets > 0) {
        f->drop_packets--;
        memset(rx, 0xff, clocked); /* chip select stayed high: the pull-up shows (PL-SPI-07) */
    } else {
        return false;
    }
    if (driven != NULL) {
        memset(driven, 0, clocked);
    }
    return true;
}

static size_t shortened(sim_bus_fault *f, size_t bits)
{
    if (f->short_packets == 0) {
        return bits;
    }
    f->short_packets--;
    return bits >= 8 ? bits - 8 : 0;
}

/* Returns true when the brown-out falls into this packet. */
static bool brownout(sim_bus_fault *f, size_t clocked, sim_pl_route *route)
{
    if (f->brownout_bytes == 0 || f->brownout_device == 0) {
        return false;
    }
    if (clocked < f->brownout_bytes) {
        f->brownout_bytes -= (uint32_t)clocked;
        return false;
    }
    route->cut_device = f->brownout_device;
    route->cut_bytes = f->brownout_bytes;
    f->brownout_bytes = 0;
    return true;
}

static void pass(sim_pl *s, const uint8_t *tx, uint8_t *sent, uint8_t *rx, uint8_t *driven, size_t bits,
                 bool touched)
{
    sim_bus_fault *f = &s->fault;
    size_t clocked = (bits + 7) / 8;
    size_t seen = shortened(f, bits);
    sim_pl_route route = {f->wrong_device, 0, 0};
    bool browns = brownout(f, clocked, &route);
    bool routed = browns || route.answer_from != 0;

    touched = stuck(f->stuck_mosi, sent, clocked) || touched;
    touched = armed_flip(f, &f->flip_mosi_bit, sent, bits) || touched;
    touched = random_flips(f, sent, bits) || touched;
    touched = touched || routed || seen != bits || f->late_bits > 0 || f->stuck_miso != 0;
    s->exempt = touched;
    if (touched) {
        taint(s, tx, bits);
    }
    memset(rx, s->options.amb12_idle_ff ? 0xff : 0x00, clocked);
    if (driven != NULL) {
        memset(driven, 0, clocked);
    }
    sim_pl_packet(s, sent, rx, driven, seen, routed ? &route : NULL);
    shift_late(f->late_bits, rx, driven, bits);
    armed_flip(f, &f->flip_miso_bit, rx, bits);
    random_flips(f, rx, bits);
    stuck(f->stuck_miso, rx, clocked);
    if (browns) {
        sim_pl_set_supply(s, route.cut_device, false);
    }
}

void sim_pl_faulty_packet(sim_pl *s, const uint8_t *tx, uint8_t *rx, uint8_t *driven, size_t bits)
{
    uint8_t sent[SIM_PL_PACKET_MAX];
    size_t clocked = (bits + 7) / 8;

    if (clocked > sizeof sent) {
        s->exempt = true;
        sim_pl_packet(s, tx, rx, driven, bits, NULL); /* longer than any packet that means something */
        return;
    }
    memcpy(sent, tx, clocked);
    if (s->fault.hook != NULL && s->fault.hook(s->fault.hook_ctx, sent, rx, (uint32_t)clocked)) {
        taint(s, tx, bits);
        if (driven != NULL) {
            memset(driven, 1, clocked);
        }
        return;
    }
    if (swallowed(&s->fault, rx, driven, clocked)) {
        taint(s, tx, bits);
        return;
    }
    pass(s, tx, sent, rx, driven, bits, memcmp(sent, tx, clocked) != 0);
}
