/* SPDX-License-Identifier: Apache-2.0 */
/* The recorded waveform, read back and decoded by a listener of its own: START, STOP, bytes, acknowledges,
 * pins. */
#include "rig.h"
#include "sim_vcd.h"
#include <stdio.h>
#include <stdlib.h>

#define FILE_NAME "conf_x0_vcd.tmp.vcd"
#define EVENTS 20000

enum { SCL, SDA, ALERT, CHG, DSG, SIGNALS };

static struct {
    uint64_t time;
    int signal, value;
} events[EVENTS];
static int event_count;
static char decoded[4096];
static uint64_t shortest_high, shortest_low;
static sim_vcd vcd;

static int signal_of(const char *name)
{
    static const char *const names[SIGNALS] = {"SCL", "SDA", "ALERT", "CHG", "DSG"};
    for (int i = 0; i < SIGNALS; i++) {
        if (strcmp(names[i], name) == 0) {
            return i;
        }
    }
    TEST_FAIL_MESSAGE("unknown signal");
    return -1;
}

static void read_events(void)
{
    FILE *f = fopen(FILE_NAME, "r");
    char line[120], name[20], id;
    int by_id[128];
    uint64_t now = 0;
    TEST_ASSERT_NOT_NULL(f);
    memset(by_id, -1, sizeof by_id);
    event_count = 0;
    while (fgets(line, sizeof line, f) != NULL) {
        if (sscanf(line, "$var wire 1 %c %19s $end", &id, name) == 2) {
            by_id[(int)id] = signal_of(name);
        } else if (line[0] == '#') {
            uint64_t next = strtoull(&line[1], NULL, 10);
            TEST_ASSERT_TRUE_MESSAGE(next >= now, "time runs backwards");
            now = next;
        } else if (line[0] == '0' || line[0] == '1') {
            TEST_ASSERT_TRUE(event_count < EVENTS && by_id[(int)line[1]] >= 0);
            events[event_count].time = now;
            events[event_count].signal = by_id[(int)line[1]];
            events[event_count++].value = line[0] - '0';
        }
    }
    TEST_ASSERT_EQUAL(0, fclose(f));
    TEST_ASSERT_EQUAL(0, remove(FILE_NAME));
}

static void put(const char *text)
{
    TEST_ASSERT_TRUE(strlen(decoded) + strlen(text) + 1 < sizeof decoded);
    (void)strcat(decoded, text);
}

/* A listener as the I2C rules have it: SDA moving while SCL is high is START or STOP, SDA is taken with the
 * rising clock, nine clocks are a byte and its acknowledge. */
static void decode(void)
{
    int level[SIGNALS] = {-1, -1, -1, -1, -1};
    unsigned bits = 0, byte = 0;
    bool active = false;
    uint64_t last = 0;
    decoded[0] = '\0';
    shortest_high = shortest_low = UINT64_MAX;
    for (int i = 0; i < event_count; i++) {
        int before = level[events[i].signal];
        uint64_t t = events[i].time;
        level[events[i].signal] = events[i].value;
        if (before < 0 || before == events[i].value) {
            continue;
        }
        if (events[i].signal == SDA && level[SCL] == 1) {
            active = events[i].value == 0;
            bits = byte = 0;
            put(active ? "S " : "P\n");
        } else if (events[i].signal == SCL) {
            uint64_t width = t - last;
            last = t;
            if (active && events[i].value == 0 && width < shortest_high) {
                shortest_high = width;
            }
            if (active && events[i].value == 1 && width < shortest_low) {
                shortest_low = width;
            }
            if (!active || events[i].value == 0) {
                continue;
            }
            if (bits < 8) {
                byte = byte << 1 | (unsigned)level[SDA];
                bits++;
            } else {
                char text[8];
                (void)snprintf(text, sizeof text, "%02x%c ", byte, level[SDA] ? '-' : '+');
                put(text);
                bits = byte = 0;
            }
        }
    }
}

static void begin(const char *part)
{
    rig_boot(part);
    TEST_ASSERT_EQUAL(0, sim_vcd_open(&vcd, FILE_NAME));
    sim_x0_record(&chip, &vcd);
}

static void finish(void)
{
    TEST_ASSERT_EQUAL(0, sim_vcd_close(&vcd, chip.now));
    sim_x0_record(&chip, NULL);
    read_events();
    decode();
}

/* proves: X0-NUM-803, X0-NUM-833, X0-NUM-853, X0-NUM-855, X0-I2C-08, X0-I2C-05 */
static void test_the_waveform_decodes_to_the_bytes(void)
{
    uint8_t block[6];
    begin("bq7692003");
    TEST_ASSERT_TRUE(rig_write(0x05, 0x40));
    expect_reg(0x05, 0x40);
    rig_wait(1);
    rig_block_read(0x06, block, 6);
    rig_wait(1);
    TEST_ASSERT_FALSE(rig_answers(0x18));
    sim_x0_i2c_start(&chip);
    (void)sim_x0_i2c_write(&chip, 0x10);
    (void)sim_x0_i2c_write(&chip, 0x0b);
    (void)sim_x0_i2c_write(&chip, 0x19);
    TEST_ASSERT_FALSE(sim_x0_i2c_write(&chip, 0x7b));
    sim_x0_i2c_stop(&chip);
    finish();
    TEST_ASSERT_EQUAL_STRING("S 10+ 05+ 40+ 24+ P\n"
                             "S 10+ 05+ S 11+ 40+ 85- P\n"
                             "S 10+ 06+ S 11+ 00+ 42+ 00+ 00+ 00+ 00+ ac+ 4d+ 97+ ec+ 00+ 00- P\n"
                             "S 30- P\n"
                             "S 10+ 0b+ 19+ 7b- P\n",
                             decoded);
}

/* proves: X0-I2C-01 */
static void test_the_clock_keeps_the_standard_mode(void)
{
    begin("bq7692000");
    for (int i = 0; i < 5; i++) {
        (void)rig_read16(0x0c);
    }
    finish();
    TEST_ASSERT_TRUE(shortest_high >= 4000);
    TEST_ASSERT_TRUE(shortest_low >= 4700);
    TEST_ASSERT_TRUE(shortest_high + shortest_low >= 10000); /* at most 100 kHz */
}

/* Times of the changes of a pin to a value, the initial one left out. */
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

/* proves: X0-FET-17, X0-ALERT-11, X0-ALERT-01 */
static void test_the_pins_change_at_their_time(void)
{
    begin("bq7692003"); /* 260 ms */
    rig_at(900);
    TEST_ASSERT_TRUE(rig_write(0x05, 0x03));
    rig_at(1000);
    (void)sim_x0_set_cell(&chip, 2, 4.3);
    rig_at(3000);
    (void)sim_x0_set_cell(&chip, 2, 3.6);
    rig_at(4000);
    rig_clear();
    rig_at(5000);
    (void)sim_x0_set_sense(&chip, -0.010);
    rig_at(6000);
    finish();
    TEST_ASSERT_TRUE(change(CHG, 1, 0) >= 900 * MS && change(CHG, 1, 0) < 901 * MS);
    TEST_ASSERT_EQUAL_UINT64(change(CHG, 1, 0), change(DSG, 1, 0));
    TEST_ASSERT_EQUAL_UINT64(2010 * MS, change(CHG, 0, 0));
    TEST_ASSERT_EQUAL_UINT64(2010 * MS, change(ALERT, 1, 0));
    TEST_ASSERT_TRUE(change(ALERT, 0, 0) >= 4000 * MS && change(ALERT, 0, 0) < 4002 * MS);
    TEST_ASSERT_EQUAL_UINT64(5008 * MS, change(ALERT, 1, 1));
    TEST_ASSERT_EQUAL_UINT64(5008 * MS, change(DSG, 0, 0));
}

static void line(bool scl, bool sda)
{
    (void)sim_x0_lines(&chip, scl, sda);
    sim_x0_advance(&chip, 2500);
}

static void line_bit(bool sda)
{
    line(false, sda);
    line(true, sda);
    line(false, sda);
}

static void line_byte(unsigned byte)
{
    for (unsigned i = 8; i-- > 0u;) {
        line_bit((byte >> i & 1u) != 0);
    }
    line_bit(true);
}

static void test_line_levels_are_recorded_as_they_are(void)
{
    begin("bq7692000");
    line(true, true);
    line(true, false);
    line(false, false);
    line_byte(0x10);
    line_byte(0x09);
    line(false, true); /* repeated START */
    line(true, true);
    line(true, false);
    line(false, false);
    line_byte(0x11);
    line_byte(0xff); /* the device sends; the host leaves SDA free and does not acknowledge */
    line(false, false);
    line(true, false);
    line(true, true);
    finish();
    TEST_ASSERT_EQUAL_STRING("S 10+ 09+ S 11+ ac- P\n", decoded);
    expect_reg(0x09, 0xac);
}

/* The host's view: what a fault makes of the bytes. */
static void test_a_flipped_bit_shows_as_the_host_sees_it(void)
{
    begin("bq7692000");
    (void)sim_x0_flip_sda(&chip, 26);
    expect_reg(0x09, 0x8c);
    finish();
    TEST_ASSERT_EQUAL_STRING("S 10+ 09+ S 11+ 8c- P\n", decoded);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_waveform_decodes_to_the_bytes);
    RUN_TEST(test_the_clock_keeps_the_standard_mode);
    RUN_TEST(test_the_pins_change_at_their_time);
    RUN_TEST(test_line_levels_are_recorded_as_they_are);
    RUN_TEST(test_a_flipped_bit_shows_as_the_host_sees_it);
    return UNITY_END();
}
