/* SPDX-License-Identifier: Apache-2.0 */
/* One packet on its way through the stack (PL-SPI, PL-VB, PL-PKT, PL-CRC, PL-BCAST). */
#include "sim_pl536_internal.h"
#include <string.h>

/* Chip select climbs while devices are on, hold a valid address and their links are whole (PL-VB-02,
 * PL-VB-06). */
void sim_pl_reach(sim_pl *s)
{
    memset(s->by_address, 0, sizeof s->by_address);
    s->duplicate = false;
    s->reach = 0;
    s->reach_break = s->fault.break_above;
    s->reach_valid = true;
    if (s->dev[0].test) {
        return; /* the base no longer listens (PL-AMB-108) */
    }
    for (int i = 0; i < s->devices && sim_pl_is_on(&s->dev[i]); i++) {
        unsigned address = sim_pl_address(&s->dev[i]);

        s->reach = i + 1;
        if (address != ADDR_BROADCAST) {
            s->duplicate = s->duplicate || s->by_address[address] != 0;
            s->by_address[address] = s->by_address[address] != 0 ? s->by_address[address] : (uint8_t)(i + 1);
        }
        if (address == 0 || address == ADDR_BROADCAST || sim_pl_link_down(s, i)) {
            break;
        }
    }
}

/* ---- reads
 * ------------------------------------------------------------------------------------------------- */

typedef struct packet {
    const uint8_t *tx;
    uint8_t *rx, *driven;
    size_t bits, bytes; /* bytes: complete ones */
    const sim_pl_route *route;
} packet;

/* The byte at `at` leaves the device as far as the host clocks it. Several devices add up (PL-AMB-15). */
static void drive(const packet *p, const sim_pl_dev *d, const sim_pl *s, size_t at, uint8_t value)
{
    uint8_t shown = value;
    unsigned tail = (unsigned)(p->bits - 8 * at);

    if (p->route != NULL && p->route->cut_device != 0 && at >= p->route->cut_bytes &&
        sim_pl_number(s, d) >= p->route->cut_device) {
        return;
    }
    if (tail < 8) {
        shown = (uint8_t)(value & (0xff00u >> tail));
    }
    if (p->driven != NULL && p->driven[at] != 0) {
        shown |= p->rx[at];
    }
    p->rx[at] = shown;
    if (p->driven != NULL) {
        p->driven[at] = 1;
    }
}

static uint8_t register_at(const sim_pl_dev *d, unsigned address)
{
    return (address & 0xffu) < SIM_PL_REGS ? d->reg[address & 0xffu] : 0;
}

/* The common case: whole bytes, one device, registers in one piece. */
static bool answer_fast(const sim_pl_dev *d, const packet *p, bool with_crc)
{
    size_t length = p->tx[2];
    unsigned first = p->tx[1];

    if (p->route != NULL || first + length > SIM_PL_REGS ||
        p->bits != 8 * (3 + length + (with_crc ? 1u : 0u))) {
        return false;
    }
    memcpy(p->rx + 3, d->reg + first, length);
    if (with_crc) {
        p->rx[3 + length] = sim_pl_crc8(sim_pl_crc8(0, p->tx, 3), d->reg + first, length);
    }
    if (p->driven != NULL) {
        memset(p->driven + 3, 1, length + (with_crc ? 1u : 0u));
    }
    return true;
}

static void answer(const sim_pl *s, const sim_pl_dev *d, const packet *p, bool alone)
{
    bool with_crc = (d->reg[REG_IO_CONFIG] & IOC_CRC_DIS) == 0;
    size_t clocked = (p->bits + 7) / 8;
    size_t length = p->tx[2];
    uint8_t crc;

    if (alone && answer_fast(d, p, with_crc)) {
        return;
    }
    crc = sim_pl_crc8(0, p->tx, 3);
    for (size_t i = 0; i < length && 3 + i < clocked; i++) {
        uint8_t value = register_at(d, p->tx[1] + (unsigned)i);

        crc = sim_pl_crc8(crc, &value, 1);
        drive(p, d, s, 3 + i, value);
    }
    if (with_crc && 3 + length < clocked) {
        drive(p, d, s, 3 + length, crc);
    }
}

static void read_from(sim_pl *s, sim_pl_dev *d, const packet *p, bool alone)
{
    sim_pl_eprom_access(s, d);
    if (p->bytes >= 3) {
        sim_pl_judge_read(s, d, p->tx[1], p->tx[2], p->bits);
        answer(s, d, p, alone);
    }
}

/* Rare: two devices with one address, both of the present discovery (stale ones are what discovery is there
 * to cure). */
static void read_duplicates(sim_pl *s, unsigned address, const packet *p)
{
    uint8_t driven[SIM_PL_PACKET_MAX];
    packet all = *p;
    int found = 0, fresh = 0;

    if (all.driven == NULL && (p->bits + 7) / 8 <= sizeof driven) {
        memset(driven, 0, sizeof driven);
        all.driven = driven;
    }
    for (int i = 0; i < s->reach; i++) {
        if (sim_pl_address(&s->dev[i]) == address) {
            read_from(s, &s->dev[i], &all, false);
            found++;
            fresh += s->dev[i].address_generation == s->generation;
        }
    }
    if (found > 1 && fresh > 1) {
        sim_pl_judge(s, NULL, "PL-AMB-15", "read answered by two devices with the same address");
    }
}

static void carry_read(sim_pl *s, const packet *p)
{
    unsigned address = p->tx[0] >> 1;

    if (p->route != NULL && p->route->answer_from >= 1 && p->route->answer_from <= s->devices) {
        sim_pl_dev *d = &s->dev[p->route->answer_from - 1];

        if (sim_pl_is_on(d)) {
            read_from(s, d, p, false);
        }
    } else if (address == ADDR_BROADCAST) {
        sim_pl_judge(s, NULL, "PL-BCAST-02", "read to the broadcast address");
    } else if (s->duplicate) {
        read_duplicates(s, address, p);
    } else if (s->by_address[address] != 0) {
        read_from(s, &s->dev[s->by_address[address] - 1], p, true);
    }
}

/* ---- writes
 * ------------------------------------------------------------------------------------------------- */

static void crc_error(sim_pl *s, sim_pl_dev *d)
{
    sim_pl_fault_set(d, FA_CRC);
    d->key = d->key && !s->options.amb99_discarded_cancels;
    sim_pl_touch(s, d);
}

/* Chip select rises: the device decides what it got (PL-CRC-05, PL-AMB-07, PL-AMB-08, PL-AMB-16). */
static void write_to(sim_pl *s, sim_pl_dev *d, const packet *p, bool broadcast)
{
    bool with_crc = (d->reg[REG_IO_CONFIG] & IOC_CRC_DIS) == 0;
    size_t wanted = with_crc ? 32 : 24;

    if (p->route != NULL && p->route->cut_device != 0 && sim_pl_number(s, d) >= p->route->cut_device) {
        return;
    }
    sim_pl_eprom_access(s, d);
    if (p->bits != wanted) {
        /* a good packet with CRC may be looking for a device that has its CRC on (PL-SEQ-02-11) */
        bool searching = s->now < s->crc_off_search_until && p->bits == 24; /* the other way round */

        if (!searching && (with_crc || p->bits != 32 || sim_pl_crc8(0, p->tx, 3) != p->tx[3])) {
            sim_pl_judge(s, d, "PL-PKT-03", "write packet of wrong length");
        }
        if (with_crc) {
            crc_error(s, d);
        }
    } else if (with_crc && sim_pl_crc8(0, p->tx, 3) != p->tx[3]) {
        sim_pl_judge(s, d, "PL-CRC-02", "write with wrong CRC");
        crc_error(s, d);
    } else {
        sim_pl_write(s, d, p->tx[1], p->tx[2], broadcast);
    }
}

static bool executes(const sim_pl *s, const sim_pl_dev *d, const packet *p)
{
    unsigned address = p->tx[0] >> 1;

    if (address == ADDR_BROADCAST && s->options.amb18_addressed_only &&
        (d->reg[REG_ADDRESS] & ADDR_AR) == 0) {
        return p->bytes >= 2 && p->tx[1] == REG_RESET;
    }
    return address == ADDR_BROADCAST || sim_pl_address(d) == address;
}

/* PL-AMB-06, the other reading: a bystander that keeps its CRC on checks as well. */
static void bystander(sim_pl *s, sim_pl_dev *d, const packet *p)
{
    bool good = p->bits == 32 && sim_pl_crc8(0, p->tx, 3) == p->tx[3];

    if (s->options.amb06_all_check && !good && (d->reg[REG_IO_CONFIG] & IOC_CRC_DIS) == 0) {
        crc_error(s, d);
    }
}

static void carry_write(sim_pl *s, const packet *p)
{
    unsigned address = p->tx[0] >> 1;
    int reach = s->reach; /* fixed while chip select is low, whatever the write changes */

    if (address == ADDR_BROADCAST || s->duplicate || s->options.amb06_all_check) {
        for (int i = 0; i < reach; i++) {
            if (executes(s, &s->dev[i], p)) {
                write_to(s, &s->dev[i], p, address == ADDR_BROADCAST);
            } else {
                bystander(s, &s->dev[i], p);
            }
        }
    } else if (s->by_address[address] != 0) {
        write_to(s, &s->dev[s->by_address[address] - 1], p, false);
    }
    sim_pl_chain_settle(s);
}

/* ---- entrance
 * ------------------------------------------------------------------------------------------------ */

void sim_pl_packet(sim_pl *s, const uint8_t *tx, uint8_t *rx, uint8_t *driven, size_t bits,
                   const sim_pl_route *route)
{
    size_t clocked = (bits + 7) / 8;
    packet p = {tx, rx, driven, bits, bits / 8, route};

    memset(rx, s->options.amb12_idle_ff ? 0xff : 0x00, clocked);
    if (driven != NULL) {
        memset(driven, 0, clocked);
    }
    if (!s->reach_valid || s->reach_break != s->fault.break_above) {
        sim_pl_reach(s);
    }
    if (p.bytes == 0 || (tx[0] & 0x80) != 0) {
        return; /* nobody is meant (PL-AMB-07, PL-AMB-14) */
    }
    if ((tx[0] & 1) != 0) {
        carry_write(s, &p);
    } else {
        carry_read(s, &p);
    }
}

void sim_pl_carry(sim_pl *s, const uint8_t *tx, uint8_t *rx, uint8_t *driven, size_t bits)
{
    if (s->bytes.selected) {
        s->spi_seen = false; /* the gap before is judged from chip select itself */
    }
    sim_pl_judge_host(s, tx, bits);
    s->fault.packets++;
    s->fault.bytes += (bits + 7) / 8;
    if (sim_bus_fault_idle(&s->fault)) {
        sim_pl_packet(s, tx, rx, driven, bits, NULL);
    } else {
        sim_pl_faulty_packet(s, tx, rx, driven, bits);
    }
    s->exempt = false;
    s->last_packet = s->now;
    s->spi_seen = true;
    if (s->vcd != NULL && !s->bytes.selected) {
        sim_pl_record_packet(s, tx, rx, bits);
        sim_pl_pins_record(s);
    }
}

void sim_pl_spi_bits(sim_pl *s, const uint8_t *tx, uint8_t *rx, uint8_t *driven, size_t bits)
{
    sim_pl_carry(s, tx, rx, driven, bits);
}

void sim_pl_spi(sim_pl *s, const uint8_t *tx, uint8_t *rx, uint8_t *driven, size_t n)
{
    sim_pl_carry(s, tx, rx, driven, 8 * n);
}

void sim_pl_spi_timed(sim_pl *s, const uint8_t *tx, uint8_t *rx, uint8_t *driven, size_t n,
                      const sim_pl_spi_timing *timing)
{
    s->spi_hz = timing->clock_hz != 0 ? timing->clock_hz : s->spi_hz;
    sim_pl_judge_timing(s, timing);
    s->spi_seen = false; /* the gap was given, not passed */
    sim_pl_carry(s, tx, rx, driven, 8 * n);
}

void sim_pl_set_spi_clock(sim_pl *s, uint32_t hz)
{
    if (hz != 0) {
        s->spi_hz = hz;
    }
}

void sim_pl_set_spi_mode(sim_pl *s, int mode)
{
    s->spi_mode = mode;
}
