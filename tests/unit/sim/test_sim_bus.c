/* SPDX-License-Identifier: Apache-2.0 */
/* Injected bus faults, stacks, and waveforms of the bq76PL536 model. */
#include "sim_bench.h"
#include "sim_vcd.h"
#include <string.h>

static void stack_of(int devices)
{
    TEST_ASSERT_EQUAL(0, sim_pl_init(&s, devices, NULL));
    for (int k = 1; k <= devices; k++) {
        put(0, 0x3b, (unsigned)k);
        TEST_ASSERT_EQUAL(0x80 | k, get((unsigned)k, 0x3b));
    }
}

void setUp(void)
{
    stack_of(3);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL(0, sim_pl_misuse(&s)->count);
}

/* proves: PL-ADR-08, PL-ADR-09, PL-VB-06, PL-POR-08 */
static void test_lost_device_hides_those_above(void)
{
    put(2, 0x3c, 0xa5);
    TEST_ASSERT_EQUAL(-1, get(3, 0x3b));
    sim_pl_advance(&s, 500 * SIM_PL_US);
    TEST_ASSERT_EQUAL(-1, get(3, 0x3b));
    TEST_ASSERT_EQUAL(0x00, get(0, 0x3b));
    put(0, 0x3b, 2);
    TEST_ASSERT_EQUAL(0x83, get(3, 0x3b));
}

/* proves: PL-VB-06, PL-CONV-07 */
static void test_conv_returns_with_a_device_and_is_an_edge_above_it(void)
{
    sim_pl_set_conv(&s, true);
    sim_pl_advance(&s, 2 * SIM_PL_MS);
    put(1, 0x3c, 0xa5);
    sim_pl_advance(&s, 500 * SIM_PL_US);
    TEST_ASSERT_EQUAL(1, sim_pl_conversions(&s, 2));
    sim_pl_advance(&s, SIM_PL_MS);
    TEST_ASSERT_EQUAL(1, sim_pl_conversions(&s, 1));
    TEST_ASSERT_EQUAL(2, sim_pl_conversions(&s, 2));
    TEST_ASSERT_EQUAL(2, sim_pl_conversions(&s, 3));
    sim_pl_set_link(&s, 1, true);
    sim_pl_set_link(&s, 1, false);
    sim_pl_set_link(&s, 1, true); /* bounces: not the host's edges */
    sim_pl_set_link(&s, 1, false);
    sim_pl_advance(&s, SIM_PL_MS);
    TEST_ASSERT_EQUAL(3, sim_pl_conversions(&s, 3));
}

/* Discovery meets addresses of an earlier run; only addresses of the present one count as given twice. */
static void test_stale_addresses_are_no_mistake(void)
{
    sim_pl_set_link(&s, 1, true);
    put(0x3f, 0x3c, 0xa5);
    sim_pl_advance(&s, SIM_PL_MS);
    sim_pl_set_link(&s, 1, false);
    put(0, 0x3b, 2); /* the next device still has 2 */
    TEST_ASSERT_EQUAL(0x82, get(2, 0x3b));
    TEST_ASSERT_EQUAL(0, sim_pl_misuse(&s)->count);
    put(0x3f, 0x3c, 0xa5);
    sim_pl_advance(&s, SIM_PL_MS);
    put(0, 0x3b, 1);
    put(0, 0x3b, 1);
    TEST_ASSERT_EQUAL(1, sim_misuse_of(sim_pl_misuse(&s), "PL-ADR-15"));
    TEST_ASSERT_EQUAL(0x81, get(1, 0x3b));
    TEST_ASSERT_EQUAL(1, sim_misuse_of(sim_pl_misuse(&s), "PL-AMB-15"));
    sim_misuse_clear(sim_pl_misuse(&s));
}

/* The successor part: a CRC error that stays off the line, when asked for. */
static void test_variant_keeps_crc_errors_off_the_line(void)
{
    static const sim_pl_options a = {.variant_a = true};
    static const uint8_t spoilt[4] = {0x03, 0x30, 0x05, 0x00};

    for (unsigned quiet = 0; quiet <= 0x80; quiet += 0x80) {
        sim_pl_init(&s, 1, &a);
        put(0, 0x3b, 1);
        put(1, 0x3a, 0x35);
        put(1, 0x42, 0x80);
        put(1, 0x3a, 0x35);
        put(1, 0x41, quiet);
        put(1, 0x21, 0x08);
        TEST_ASSERT_EQUAL(0, sim_pl_fault_pin(&s));
        sim_pl_spi(&s, spoilt, rx, driven, 4);
        TEST_ASSERT_EQUAL_HEX8(0x04, sim_pl_peek(&s, 1, 0x21));
        TEST_ASSERT_EQUAL(quiet == 0, sim_pl_fault_pin(&s));
    }
    sim_misuse_clear(sim_pl_misuse(&s));
}

static void test_flips_are_seen_and_not_judged(void)
{
    struct sim_bus_fault *f = sim_pl_bus_fault(&s);

    f->flip_mosi_bit = 1 + 16;
    put(1, 0x30, 0x45);
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&s, 1, 0x30));
    TEST_ASSERT_EQUAL_HEX8(0x04, sim_pl_peek(&s, 1, 0x21) & 0x04);
    TEST_ASSERT_EQUAL(0, f->flip_mosi_bit);
    f->flip_miso_bit = 1 + 24;
    TEST_ASSERT_EQUAL(-1, get(1, 0x3b));
    TEST_ASSERT_EQUAL(0x81, get(1, 0x3b));
    TEST_ASSERT_EQUAL(2, f->flips);
    f->flip_mosi_bit = 1; /* the very first bit: nobody is meant any more */
    TEST_ASSERT_EQUAL(-1, get(1, 0x3b));
    TEST_ASSERT_EQUAL(0, driven[3]);
    TEST_ASSERT_EQUAL(3, f->flips);
}

/* proves: PL-PKT-11 */
static void test_a_read_may_end_inside_a_byte(void)
{
    static const uint8_t tx[5] = {0x02, 0x3b, 0x01, 0x00, 0x00};

    sim_pl_spi_bits(&s, tx, rx, driven, 36);
    TEST_ASSERT_EQUAL_HEX8(0x81, rx[3]);
    TEST_ASSERT_EQUAL_HEX8(0xb0, rx[4]); /* four bits of the CRC */
    TEST_ASSERT_EQUAL_HEX8(0x81, peek(1, 0x3b));
    expect_one_misuse("PL-PKT-04");
    TEST_ASSERT_EQUAL(0x81, get(1, 0x3b));
}

static void test_lost_key_is_not_judged(void)
{
    sim_pl_bus_fault(&s)->drop_packets = 1;
    put(1, 0x3a, 0x35);
    TEST_ASSERT_EQUAL_HEX8(0xff, rx[0]);
    put(1, 0x42, 0x2c);
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&s, 1, 0x42));
    put(1, 0x3a, 0x35);
    put(1, 0x42, 0x2c);
    TEST_ASSERT_EQUAL_HEX8(0x2c, sim_pl_peek(&s, 1, 0x42));
}

/* What a lost write leaves behind is not the host's doing; after a second, and in another device, it is. */
static void test_what_a_lost_write_leaves_is_not_judged_at_once(void)
{
    for (unsigned k = 1; k <= 2; k++) {
        sim_pl_bus_fault(&s)->drop_packets = k == 1;
        put(k, 0x33, 0x1e);
        put(k, 0x3a, 0x35);
        put(k, 0x40, 0x40);
    }
    put(1, 0x34, 0x01);
    TEST_ASSERT_EQUAL(SIM_PL_LOCKED, sim_pl_get_mode(&s, 1));
    TEST_ASSERT_EQUAL(0, sim_pl_misuse(&s)->count);
    put(2, 0x34, 0x01);
    TEST_ASSERT_EQUAL(1, sim_misuse_of(sim_pl_misuse(&s), "PL-ADC-12"));
    sim_misuse_clear(sim_pl_misuse(&s));
    sim_pl_bus_fault(&s)->drop_packets = 1;
    put(3, 0x33, 0x1e);
    put(3, 0x3a, 0x35);
    put(3, 0x40, 0x40);
    sim_pl_advance(&s, SIM_PL_S);
    put(3, 0x34, 0x01);
    TEST_ASSERT_EQUAL(1, sim_misuse_of(sim_pl_misuse(&s), "PL-ADC-12"));
    sim_misuse_clear(sim_pl_misuse(&s));
}

static void test_dead_stuck_late_and_short(void)
{
    struct sim_bus_fault *f = sim_pl_bus_fault(&s);

    f->dead = 2;
    TEST_ASSERT_EQUAL(-1, get(1, 0x3b));
    TEST_ASSERT_EQUAL_HEX8(0xff, rx[3]);
    f->dead = 0;
    f->stuck_miso = 1;
    TEST_ASSERT_EQUAL(-1, get(1, 0x3b));
    TEST_ASSERT_EQUAL_HEX8(0x00, rx[3]);
    f->stuck_miso = 0;
    f->late_bits = 1;
    TEST_ASSERT_EQUAL(-1, get(1, 0x3b));
    TEST_ASSERT_EQUAL_HEX8(0x40, rx[3]);
    f->late_bits = 0;
    f->short_packets = 1;
    put(1, 0x30, 0x45);
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&s, 1, 0x30));
    f->stuck_mosi = 1;
    TEST_ASSERT_EQUAL(-1, get(1, 0x3b));
    f->stuck_mosi = 0;
    TEST_ASSERT_EQUAL(0x81, get(1, 0x3b));
}

static void test_wrong_device_break_and_brownout(void)
{
    struct sim_bus_fault *f = sim_pl_bus_fault(&s);

    f->wrong_device = 1;
    TEST_ASSERT_EQUAL(0x81, get(2, 0x3b));
    f->wrong_device = 3;
    TEST_ASSERT_EQUAL(0x83, get(1, 0x3b));
    f->wrong_device = 0;
    f->break_above = 1;
    TEST_ASSERT_EQUAL(-1, get(2, 0x3b));
    TEST_ASSERT_EQUAL(0, sim_pl_drdy_pin(&s));
    f->break_above = 0;
    TEST_ASSERT_EQUAL(0x82, get(2, 0x3b));
    f->brownout_device = 2;
    f->brownout_bytes = 9;
    TEST_ASSERT_EQUAL(0x82, get(2, 0x3b));
    TEST_ASSERT_EQUAL(-1, get(2, 0x3b));
    TEST_ASSERT_EQUAL(1, driven[3]);
    TEST_ASSERT_EQUAL(0, driven[4]);
    TEST_ASSERT_EQUAL(SIM_PL_OFF, sim_pl_get_mode(&s, 2));
    TEST_ASSERT_EQUAL(0x81, get(1, 0x3b));
    TEST_ASSERT_EQUAL(-1, get(3, 0x3b));
}

static void test_flip_rate(void)
{
    struct sim_bus_fault *f = sim_pl_bus_fault(&s);

    f->flip_probability = 1e-3;
    f->rng = 7;
    for (int i = 0; i < 20000; i++) {
        (void)get(1, 0x3b);
    }
    TEST_ASSERT_INT_WITHIN(160, 1600, (long)f->flips); /* 20000 packets of 80 bits */
    f->flip_probability = 0.0;
}

static bool hook(void *ctx, uint8_t *tx, uint8_t *answer, uint32_t n)
{
    int *mode = ctx;

    if (*mode == 1) {
        memset(answer, 0x5a, n);
        return true;
    }
    tx[1] = 0x00;
    return false;
}

static void test_hook_answers_or_falls_through(void)
{
    int mode = 1;

    sim_pl_bus_fault(&s)->hook = hook;
    sim_pl_bus_fault(&s)->hook_ctx = &mode;
    (void)get(1, 0x3b);
    TEST_ASSERT_EQUAL_HEX8(0x5a, rx[0]);
    TEST_ASSERT_EQUAL(1, driven[4]);
    mode = 2;
    (void)get(1, 0x3b);
    TEST_ASSERT_EQUAL_HEX8(sim_pl_peek(&s, 1, 0x00), rx[3]);
    sim_pl_bus_fault(&s)->hook = NULL;
}

/* proves: PL-FLT-07, PL-FLT-13, PL-FLT-17, PL-ALT-01 */
static void test_chains(void)
{
    sim_pl_bus_fault(&s)->break_above = 0;
    for (unsigned k = 1; k <= 3; k++) {
        put(k, 0x3a, 0x35);
        put(k, 0x42, 0x80);
    }
    put(0x3f, 0x20, 0x80);
    put(0x3f, 0x20, 0x00);
    put(0x3f, 0x21, 0x08);
    put(0x3f, 0x21, 0x00);
    TEST_ASSERT_EQUAL(0, sim_pl_fault_pin(&s));
    TEST_ASSERT_EQUAL(0, sim_pl_alert_pin(&s));
    put(3, 0x21, 0x10);
    TEST_ASSERT_EQUAL(1, sim_pl_fault_pin(&s));
    TEST_ASSERT_EQUAL_HEX8(0x81, get(1, 0x00));
    sim_pl_set_link(&s, 1, true);
    TEST_ASSERT_EQUAL(0, sim_pl_fault_pin(&s));
    sim_pl_set_link(&s, 1, false);
    put(3, 0x21, 0x00);
    put(3, 0x20, 0x10);
    TEST_ASSERT_EQUAL(1, sim_pl_alert_pin(&s));
}

/* Decodes a recorded waveform again: mode 1, sampled on the falling edge of SCLK while CS is low. */
static size_t decode(FILE *file, uint8_t *sdi, uint8_t *sdo, size_t max)
{
    char line[128], level[128];
    size_t bits = 0;

    memset(level, '0', sizeof level);
    level['!'] = '1';
    memset(sdi, 0, max);
    memset(sdo, 0, max);
    while (fgets(line, sizeof line, file) != NULL) {
        unsigned char signal = (unsigned char)line[1];

        if (strchr("01z", line[0]) == NULL || signal < '!' || signal > '(') {
            continue;
        }
        if (signal == '"' && level['"'] == '1' && line[0] == '0' && level['!'] == '0' && bits < 8 * max) {
            sdi[bits / 8] |= (uint8_t)((level['#'] == '1' ? 0x80 : 0) >> (bits % 8));
            sdo[bits / 8] |= (uint8_t)((level['$'] == '1' ? 0x80 : 0) >> (bits % 8));
            bits++;
        }
        level[signal] = line[0];
    }
    return bits;
}

/* proves: PL-SPI-01, PL-SPI-02, PL-SPI-03 */
static void test_waveform(void)
{
    static const uint8_t sent[] = {0x02, 0x3b, 0x01, 0x00, 0x00}, got[] = {0x00, 0x00, 0x00, 0x81, 0xba};
    uint8_t sdi[8], sdo[8];
    sim_vcd vcd;
    FILE *file;

    TEST_ASSERT_EQUAL(0, sim_vcd_open(&vcd, "unit_sim_bus.vcd"));
    sim_pl_record(&s, &vcd);
    (void)get(1, 0x3b);
    sim_pl_record(&s, NULL);
    TEST_ASSERT_EQUAL(0, sim_vcd_close(&vcd, SIM_PL_MS));
    file = fopen("unit_sim_bus.vcd", "r");
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_EQUAL(40, decode(file, sdi, sdo, sizeof sdi));
    fclose(file);
    remove("unit_sim_bus.vcd");
    TEST_ASSERT_EQUAL_HEX8_ARRAY(sent, sdi, 5);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(got, sdo, 5);
    TEST_ASSERT_EQUAL(-1, sim_vcd_open(&vcd, "no/such/folder/x.vcd"));
}

/* proves: PL-SPI-12, PL-SPI-04 */
static void test_strict_timing(void)
{
    static const uint8_t tx[5] = {0x00, 0x3b, 0x01, 0x00, 0x00};
    sim_pl_options strict = {.strict_timing = true};
    sim_pl_spi_timing good = {250000, 50, 3000, 2000, 2000, 0};
    sim_pl_spi_timing bad = {5000, 30, 2000, 10, 5, 200000};

    sim_pl_init(&s, 1, &strict);
    sim_pl_spi_timed(&s, tx, rx, driven, 5, &good);
    TEST_ASSERT_EQUAL(0, sim_pl_misuse(&s)->count);
    sim_pl_spi_timed(&s, tx, rx, driven, 5, &bad);
    TEST_ASSERT_EQUAL(5, sim_pl_misuse(&s)->count);
    TEST_ASSERT_EQUAL(1, sim_misuse_of(sim_pl_misuse(&s), "PL-SPI-04"));
    sim_pl_set_spi_clock(&s, 250000);
    sim_misuse_clear(sim_pl_misuse(&s));
    sim_pl_spi(&s, tx, rx, driven, 5);
    TEST_ASSERT_EQUAL(1, sim_misuse_of(sim_pl_misuse(&s), "PL-SPI-04"));
    sim_misuse_clear(sim_pl_misuse(&s));
    sim_pl_advance(&s, 3 * SIM_PL_US);
    sim_pl_spi(&s, tx, rx, driven, 5);
    TEST_ASSERT_EQUAL(0, sim_pl_misuse(&s)->count);
    sim_pl_advance(&s, 3 * SIM_PL_US - 1);
    sim_pl_spi(&s, tx, rx, driven, 5);
    TEST_ASSERT_EQUAL(1, sim_misuse_of(sim_pl_misuse(&s), "PL-SPI-04"));
    sim_misuse_clear(sim_pl_misuse(&s));
    sim_pl_set_spi_mode(&s, 3);
    sim_pl_spi_timed(&s, tx, rx, driven, 5, &good);
    TEST_ASSERT_EQUAL(1, sim_misuse_of(sim_pl_misuse(&s), "PL-SPI-01"));
    sim_misuse_clear(sim_pl_misuse(&s));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_lost_device_hides_those_above);
    RUN_TEST(test_conv_returns_with_a_device_and_is_an_edge_above_it);
    RUN_TEST(test_stale_addresses_are_no_mistake);
    RUN_TEST(test_variant_keeps_crc_errors_off_the_line);
    RUN_TEST(test_flips_are_seen_and_not_judged);
    RUN_TEST(test_a_read_may_end_inside_a_byte);
    RUN_TEST(test_lost_key_is_not_judged);
    RUN_TEST(test_what_a_lost_write_leaves_is_not_judged_at_once);
    RUN_TEST(test_dead_stuck_late_and_short);
    RUN_TEST(test_wrong_device_break_and_brownout);
    RUN_TEST(test_flip_rate);
    RUN_TEST(test_hook_answers_or_falls_through);
    RUN_TEST(test_chains);
    RUN_TEST(test_waveform);
    RUN_TEST(test_strict_timing);
    return UNITY_END();
}
