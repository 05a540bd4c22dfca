/* SPDX-License-Identifier: Apache-2.0 */
/* The bus door as hardware uses it: chip select, bytes, chip select (PL-SPI-03, PL-SPI-06). A read is carried
 * as a whole packet when its header is complete, a write when chip select rises: one way for both doors. */
#include "sim_pl536_internal.h"
#include <string.h>

#define HEADER 3u

static uint8_t idle_level(const sim_pl *s)
{
    if (s->fault.dead != 0) {
        return s->fault.dead == 1 ? 0x00 : 0xff;
    }
    if (s->fault.stuck_miso != 0) {
        return s->fault.stuck_miso == 1 ? 0x00 : 0xff;
    }
    return s->options.amb12_idle_ff || s->fault.drop_packets > 0 ? 0xff : 0x00;
}

/* Length of the answered read: header, data and, when the device sends one, the CRC. */
static size_t read_length(sim_pl *s)
{
    const sim_pl_bytes *b = &s->bytes;
    uint8_t index;

    sim_pl_reach(s);
    index = s->by_address[(b->tx[0] >> 1) & ADDR_MASK];
    if (index != 0 && (s->dev[index - 1].reg[REG_IO_CONFIG] & IOC_CRC_DIS) != 0) {
        return HEADER + b->tx[2];
    }
    return HEADER + b->tx[2] + 1u;
}

static bool is_read(const sim_pl_bytes *b)
{
    return b->n == HEADER && (b->tx[0] & 0x81u) == 0;
}

static void answer_read(sim_pl *s)
{
    sim_pl_bytes *b = &s->bytes;

    b->faulty = !sim_bus_fault_idle(&s->fault);
    b->expected = read_length(s);
    memset(b->tx + HEADER, 0, b->expected - HEADER);
    sim_pl_carry(s, b->tx, b->rx, b->driven, 8 * b->expected);
    b->answered = true;
}

void sim_pl_spi_select(sim_pl *s)
{
    sim_pl_bytes *b = &s->bytes;

    if (b->selected) {
        return;
    }
    b->selected = true;
    b->answered = b->faulty = false;
    b->n = b->expected = 0;
    b->selected_at = s->now;
    b->lead = b->longest_pause = 0;
    sim_pl_record_select(s, true);
}

static void note_times(sim_pl *s)
{
    sim_pl_bytes *b = &s->bytes;
    uint64_t length = 8000000000ull / s->spi_hz;
    uint64_t from = b->n == 0 ? b->selected_at : b->byte_end;
    uint64_t begin = s->now > length ? s->now - length : 0;
    uint64_t pause = begin > from ? begin - from : 0;

    if (b->n == 0) {
        b->lead = pause;
    } else if (pause > b->longest_pause) {
        b->longest_pause = pause;
    }
    b->byte_end = s->now;
}

uint8_t sim_pl_spi_byte(sim_pl *s, uint8_t tx, bool *driven)
{
    sim_pl_bytes *b = &s->bytes;
    size_t at = b->n;
    bool answers = b->selected && b->answered && at < b->expected;
    uint8_t rx = !b->selected ? 0xff : answers ? b->rx[at] : idle_level(s);

    if (driven != NULL) {
        *driven = answers && b->driven[at] != 0;
    }
    if (!b->selected) {
        return rx;
    }
    note_times(s);
    sim_pl_record_byte(s, tx, rx);
    if (at + 1 < SIM_PL_PACKET_MAX) {
        b->tx[at] = tx;
        b->n = at + 1;
    }
    if (is_read(b) && !b->answered) {
        answer_read(s);
    }
    return rx;
}

static uint32_t clipped(uint64_t ns)
{
    return ns < UINT32_MAX ? (uint32_t)ns : UINT32_MAX;
}

static void judge_times(sim_pl *s)
{
    const sim_pl_bytes *b = &s->bytes;
    sim_pl_spi_timing timing = {.clock_hz = s->spi_hz, .duty_percent = 50};

    timing.cs_high_ns = b->released_before ? clipped(b->selected_at - b->released_at) : UINT32_MAX;
    timing.cs_lead_ns = clipped(b->lead);
    timing.cs_lag_ns = clipped(s->now - b->byte_end);
    timing.longest_pause_ns = clipped(b->longest_pause);
    if (b->n > 0) {
        sim_pl_judge_timing(s, &timing);
    }
}

/* The packet was carried at the length it ought to have. */
static void judge_length(sim_pl *s)
{
    const sim_pl_bytes *b = &s->bytes;
    bool seeks_crc_off = s->now < s->crc_off_search_until && b->n == HEADER + b->tx[2];

    s->fault.bytes += b->n - b->expected;
    if (b->n != b->expected && b->n != HEADER + 1u + b->tx[2] && !seeks_crc_off && !b->faulty) {
        sim_pl_judge(s, NULL, "PL-PKT-04", "read packet of wrong length");
    }
}

void sim_pl_spi_release(sim_pl *s)
{
    sim_pl_bytes *b = &s->bytes;

    if (!b->selected) {
        return;
    }
    judge_times(s);
    if (b->answered) {
        judge_length(s);
    } else {
        sim_pl_carry(s, b->tx, b->rx, b->driven, 8 * b->n);
    }
    b->selected = false;
    b->released_before = true;
    b->released_at = s->now;
    sim_pl_record_select(s, false);
    sim_pl_pins_record(s);
}

bool sim_pl_spi_selected(const sim_pl *s)
{
    return s->bytes.selected;
}
