/* SPDX-License-Identifier: Apache-2.0 */
/* The recorded waveform, read back and decoded independently: SPI mode 1, bit order, chip select, host pins.
 */
#include "bench.h"
#include <stdio.h>
#include <stdlib.h>

#define FILE_NAME "conf_pl536_vcd.tmp.vcd"
#define EVENTS 40000
#define PACKETS 32

enum { CS, SCLK, SDI, SDO, CONV, DRDY, FAULT, ALERT, SIGNALS };
enum { HIGH_IMPEDANCE = -1, UNKNOWN = -2 };

typedef struct event {
    uint64_t time;
    int signal, value;
} event;

typedef struct packet {
    uint64_t begin, end, first_clock, last_clock;
    size_t bits;
    uint8_t mosi[64], miso[64];
} packet;

static event events[EVENTS];
static int event_count;
static packet packets[PACKETS];
static int packet_count;
static sim_vcd vcd;
static bqsim_session session;
static char reply[BQSIM_REPLY_MAX];

static void say(const char *line, const char *expected)
{
    (void)bqsim_exec(&session, line, reply, sizeof reply);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(expected, reply, line);
}

static void begin(void)
{
    TEST_ASSERT_EQUAL(0, sim_vcd_open(&vcd, FILE_NAME));
    bqsim_init(&session, &vcd);
}

static int signal_of(const char *name)
{
    static const char *const names[SIGNALS] = {"CS", "SCLK", "SDI", "SDO", "CONV", "DRDY", "FAULT", "ALERT"};

    for (int i = 0; i < SIGNALS; i++) {
        if (strcmp(names[i], name) == 0) {
            return i;
        }
    }
    return -1;
}

static int value_of(char c)
{
    TEST_ASSERT_TRUE(c == '0' || c == '1' || c == 'z');
    return c == 'z' ? HIGH_IMPEDANCE : c - '0';
}

/* Reads the file into events; every level change is one, the initial values included. */
static void read_events(void)
{
    FILE *f = fopen(FILE_NAME, "r");
    char line[120], name[20], id;
    int by_id[128];
    uint64_t now = 0;
    bool ns = false;

    TEST_ASSERT_NOT_NULL(f);
    event_count = 0;
    memset(by_id, -1, sizeof by_id);
    while (fgets(line, sizeof line, f) != NULL) {
        ns = ns || strstr(line, "1 ns") != NULL || strstr(line, "1ns") != NULL;
        if (sscanf(line, "$var wire 1 %c %19s $end", &id, name) == 2) {
            TEST_ASSERT_TRUE(id > ' ' && id < 127);
            by_id[(int)id] = signal_of(name);
        } else if (line[0] == '#') {
            uint64_t next = strtoull(&line[1], NULL, 10);

            TEST_ASSERT_TRUE_MESSAGE(next >= now, "time runs backwards");
            now = next;
        } else if (line[0] != '$' && line[0] != '\n') {
            TEST_ASSERT_TRUE(event_count < EVENTS);
            TEST_ASSERT_TRUE(by_id[(int)line[1]] >= 0);
            events[event_count++] = (event){now, by_id[(int)line[1]], value_of(line[0])};
        }
    }
    TEST_ASSERT_EQUAL(0, fclose(f));
    TEST_ASSERT_TRUE(ns);
}

/* A listener in mode 1: samples both lines on each falling clock edge while selected, first bit = highest
 * bit. */
static void decode(void)
{
    int level[SIGNALS];
    packet *p = NULL;

    packet_count = 0;
    for (int i = 0; i < SIGNALS; i++) {
        level[i] = UNKNOWN;
    }
    for (int i = 0; i < event_count; i++) {
        const event *e = &events[i];
        int before = level[e->signal];

        level[e->signal] = e->value;
        if (e->signal == CS && before == 1 && e->value == 0) {
            TEST_ASSERT_EQUAL_MESSAGE(0, level[SCLK], "clock idles low");
            TEST_ASSERT_TRUE(packet_count < PACKETS);
            p = &packets[packet_count++];
            memset(p, 0, sizeof *p);
            p->begin = e->time;
        } else if (e->signal == CS && before == 0 && e->value == 1) {
            TEST_ASSERT_EQUAL_MESSAGE(0, level[SCLK], "clock idles low");
            p->end = e->time;
            p = NULL;
        } else if (e->signal == SCLK && before != UNKNOWN) {
            TEST_ASSERT_TRUE_MESSAGE(p != NULL, "clock outside a packet");
            if (e->value == 1) {
                p->first_clock = p->bits == 0 ? e->time : p->first_clock;
                continue;
            }
            p->last_clock = e->time;
            p->mosi[p->bits / 8] =
                (uint8_t)(p->mosi[p->bits / 8] | (level[SDI] == 1 ? 0x80 >> p->bits % 8 : 0));
            p->miso[p->bits / 8] =
                (uint8_t)(p->miso[p->bits / 8] | (level[SDO] == 1 ? 0x80 >> p->bits % 8 : 0));
            p->bits++;
        }
    }
    TEST_ASSERT_NULL(p);
}

/* Data may change with a rising clock edge or with chip select, never with a falling clock edge. */
static void check_data_edges(void)
{
    for (int i = 0; i < event_count; i++) {
        bool rising = false, falling = false, select = false;

        if ((events[i].signal != SDI && events[i].signal != SDO) || events[i].time == 0) {
            continue;
        }
        for (int j = 0; j < event_count && events[j].time <= events[i].time; j++) {
            if (events[j].time == events[i].time) {
                rising = rising || (events[j].signal == SCLK && events[j].value == 1);
                falling = falling || (events[j].signal == SCLK && events[j].value == 0);
                select = select || events[j].signal == CS;
            }
        }
        TEST_ASSERT_TRUE(rising || select);
        TEST_ASSERT_FALSE(falling);
    }
}

static void finish(void)
{
    TEST_ASSERT_EQUAL(0, sim_vcd_close(&vcd, session.now_ns));
    read_events();
    decode();
    TEST_ASSERT_EQUAL(0, remove(FILE_NAME));
}

static void expect_packet(int number, const uint8_t *mosi, const uint8_t *miso, size_t n)
{
    TEST_ASSERT_TRUE(number < packet_count);
    TEST_ASSERT_EQUAL(8 * n, packets[number].bits);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(mosi, packets[number].mosi, n);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(miso, packets[number].miso, n);
}

static void work(void)
{
    begin();
    say("stack 2", "ok");
    say("spi 01 3b 01 02", "ok -- -- -- --");
    say("spi 01 3b 02 0b", "ok -- -- -- --");
    say("advance 1ms", "ok");
    say("spi 02 3b 01 00 00", "ok -- -- -- 81 ba");
    say("spi 04 3b 01 00 00", "ok -- -- -- 82 c7");
    say("advance 1ms", "ok");
    say("spi 7f 30 3d 6a", "ok -- -- -- --");
    finish();
}

/* proves: PL-SPI-01, PL-SPI-02, PL-SPI-03 */
static void test_the_waveform_decodes_to_the_bytes_in_mode_1(void)
{
    static const uint8_t none[5] = {0};

    work();
    TEST_ASSERT_EQUAL(5, packet_count);
    expect_packet(0, (const uint8_t[]){0x01, 0x3b, 0x01, 0x02}, none, 4);
    expect_packet(1, (const uint8_t[]){0x01, 0x3b, 0x02, 0x0b}, none, 4);
    expect_packet(2, (const uint8_t[]){0x02, 0x3b, 0x01, 0x00, 0x00}, (const uint8_t[]){0, 0, 0, 0x81, 0xba},
                  5);
    expect_packet(3, (const uint8_t[]){0x04, 0x3b, 0x01, 0x00, 0x00}, (const uint8_t[]){0, 0, 0, 0x82, 0xc7},
                  5);
    expect_packet(4, (const uint8_t[]){0x7f, 0x30, 0x3d, 0x6a}, none, 4);
    check_data_edges();
}

/* Levels that a signal has once everything of this event's time has happened. */
static int settled(int signal, int at)
{
    int value = UNKNOWN;

    for (int i = 0; i < event_count && events[i].time <= events[at].time; i++) {
        value = events[i].signal == signal ? events[i].value : value;
    }
    return value;
}

/* proves: PL-SPI-03, PL-SPI-07, PL-PIN-01, PL-PIN-02 */
static void test_chip_select_frames_each_packet_and_releases_sdo(void)
{
    work();
    TEST_ASSERT_EQUAL(CS, events[0].signal);
    TEST_ASSERT_EQUAL(1, events[0].value); /* idle = pulled up = not selected */
    for (int i = 0; i < packet_count; i++) {
        TEST_ASSERT_TRUE(packets[i].begin + 50 <= packets[i].first_clock);
        TEST_ASSERT_TRUE(packets[i].last_clock + 10 <= packets[i].end);
        if (i > 0) {
            TEST_ASSERT_TRUE_MESSAGE(packets[i].begin >= packets[i - 1].end + 3000, "3 us between packets");
        }
    }
    for (int i = 0; i < event_count; i++) { /* at every edge: high impedance exactly while not selected */
        TEST_ASSERT_EQUAL(settled(CS, i) == 1, settled(SDO, i) == HIGH_IMPEDANCE);
    }
}

/* proves: PL-SPI-01 */
static void test_the_clock_has_the_chosen_rate(void)
{
    static const uint32_t hz[] = {10000, 250000, 1000000};

    for (size_t i = 0; i < sizeof hz / sizeof hz[0]; i++) {
        begin();
        say("stack 1", "ok");
        sim_pl_set_spi_clock(&session.stack, hz[i]);
        say("spi 00 00 01 00 00", "ok -- -- -- 61 35");
        finish();
        TEST_ASSERT_EQUAL(1, packet_count);
        /* 39 periods and the high half of the last one */
        TEST_ASSERT_EQUAL_UINT64(39 * (1000000000ull / hz[i]) + 500000000ull / hz[i],
                                 packets[0].last_clock - packets[0].first_clock);
    }
}

/* Time of the n-th change of a signal to this value, without the initial one. */
static uint64_t change(int signal, int value, int n)
{
    bool initial = true;

    for (int i = 0; i < event_count; i++) {
        if (events[i].signal == signal) {
            if (!initial && events[i].value == value && n-- == 0) {
                return events[i].time;
            }
            initial = false;
        }
    }
    TEST_FAIL_MESSAGE("no such change");
    return 0;
}

/* proves: PL-PIN-03, PL-PIN-04, PL-CONV-10 */
static void test_host_pins_change_at_their_simulated_time(void)
{
    begin();
    say("stack 1", "ok");
    say("spi 01 3b 01 02", "ok -- -- -- --");
    say("spi 03 3a 35 4d", "ok -- -- -- --");
    say("spi 03 42 80 45", "ok -- -- -- --"); /* no overvoltage function */
    say("spi 03 20 80 9a", "ok -- -- -- --");
    say("spi 03 21 08 3e", "ok -- -- -- --");
    say("advance 10ms", "ok");
    say("set pin.conv 1", "ok");
    say("advance 10ms", "ok");
    say("set pin.conv 0", "ok");
    say("advance 10ms", "ok");
    say("set dev.1.cell.1 0.6", "ok"); /* below 0.7 V without delay */
    say("advance 10ms", "ok");
    say("set dev.1.cell.1 3.6", "ok");
    say("advance 10ms", "ok");
    finish();
    TEST_ASSERT_TRUE(change(ALERT, 0, 0) < 10 * SIM_PL_MS);
    TEST_ASSERT_TRUE(change(FAULT, 0, 0) < 10 * SIM_PL_MS);
    TEST_ASSERT_EQUAL_UINT64(10 * SIM_PL_MS, change(CONV, 1, 0));
    TEST_ASSERT_EQUAL_UINT64(20 * SIM_PL_MS, change(CONV, 0, 0));
    TEST_ASSERT_EQUAL_UINT64(10 * SIM_PL_MS, change(DRDY, 0, 0));
    TEST_ASSERT_EQUAL_UINT64(10 * SIM_PL_MS + 506 * SIM_PL_US,
                             change(DRDY, 1, 0)); /* 500 us and (1 + 1) x 3 us */
    TEST_ASSERT_EQUAL_UINT64(30 * SIM_PL_MS, change(FAULT, 1, 0));
    TEST_ASSERT_EQUAL_UINT64(40 * SIM_PL_MS, change(FAULT, 0, 1));
}

static void test_a_second_stack_goes_on_in_the_same_file(void)
{
    static const uint8_t tx[5] = {0x00, 0x00, 0x01, 0x00, 0x00}, rx[5] = {0, 0, 0, 0x61, 0x35};

    begin();
    say("stack 1", "ok");
    say("spi 00 00 01 00 00", "ok -- -- -- 61 35");
    say("set pin.conv 1", "ok");
    say("advance 5ms", "ok");
    say("stack 3", "ok");
    say("spi 00 00 01 00 00", "ok -- -- -- 61 35");
    say("advance 5ms", "ok");
    say("stack 1", "ok");
    say("spi 00 00 01 00 00", "ok -- -- -- 61 35");
    finish();
    TEST_ASSERT_EQUAL(3, packet_count);
    for (int i = 0; i < 3; i++) {
        expect_packet(i, tx, rx, 5);
    }
    TEST_ASSERT_TRUE(packets[1].begin >= 5 * SIM_PL_MS);
    TEST_ASSERT_TRUE(packets[2].begin >= 10 * SIM_PL_MS);
    TEST_ASSERT_EQUAL_UINT64(5 * SIM_PL_MS, change(CONV, 0, 0));
}

static void test_what_the_host_sees_is_recorded_with_its_faults(void)
{
    begin();
    say("stack 1", "ok");
    say("inject miso 24", "ok");
    say("spi 00 00 01 00 00", "ok -- -- -- e1 35");
    sim_pl_bus_fault(&session.stack)->drop_packets = 1;
    say("spi 00 00 01 00 00", "ok -- -- -- -- --");
    finish();
    expect_packet(0, (const uint8_t[]){0, 0, 1, 0, 0}, (const uint8_t[]){0, 0, 0, 0xe1, 0x35}, 5);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_waveform_decodes_to_the_bytes_in_mode_1);
    RUN_TEST(test_chip_select_frames_each_packet_and_releases_sdo);
    RUN_TEST(test_the_clock_has_the_chosen_rate);
    RUN_TEST(test_host_pins_change_at_their_simulated_time);
    RUN_TEST(test_a_second_stack_goes_on_in_the_same_file);
    RUN_TEST(test_what_the_host_sees_is_recorded_with_its_faults);
    return UNITY_END();
}
