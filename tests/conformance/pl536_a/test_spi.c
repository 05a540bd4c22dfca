/* SPDX-License-Identifier: Apache-2.0 */
/* Section 3, SPI. Mode, bit order and chip select on the wire are in test_vcd.c. */
#include "bench.h"
#include <stdio.h>

/* proves: PL-SPI-05 */
static void test_chip_select_resynchronises_every_receiver(void)
{
    static const uint8_t write[4] = {0x07, 0x30, 0x7d, 0x9b};

    bench_stack(3);
    bench_quiet(3);
    for (size_t bits = 0; bits < 32; bits++) { /* an unfinished packet of every length, then a whole one */
        uint8_t rx[4];

        bench_write(3, 0x30, 0x00);
        sim_pl_spi_bits(bench_pl(), write, rx, NULL, bits);
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(3, 0x30));
        for (int k = 1; k <= 3; k++) {
            TEST_ASSERT_EQUAL_HEX8(0x80 | k, bench_read(k, 0x3b));
        }
        bench_write(3, 0x30, 0x3d);
        TEST_ASSERT_EQUAL_HEX8(0x3d, bench_peek(3, 0x30));
    }
}

/* proves: PL-SPI-06, PL-CRC-04 */
static void test_a_write_acts_only_when_chip_select_ends_it(void)
{
    static const uint8_t five[5] = {0x03, 0x30, 0x7d, 0x30, 0x00}, reset[4] = {0x03, 0x3c, 0xa5, 0xca},
                         convert[4] = {0x03, 0x34, 0x01, 0x17};
    uint8_t rx[5];

    bench_quiet(1);
    sim_pl_spi(bench_pl(), five, rx, NULL,
               5); /* complete and right after four bytes, but chip select goes on */
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x30));
    sim_pl_spi(bench_pl(), five, rx, NULL, 4);
    TEST_ASSERT_EQUAL_HEX8(0x7d, bench_read(1, 0x30));
    sim_pl_spi_bits(bench_pl(), reset, rx, NULL, 31);
    expect("get dev.1.mode", "ok active");
    sim_pl_spi_bits(bench_pl(), convert, rx, NULL, 31);
    expect("get pin.drdy", "ok 1");
    sim_pl_spi_bits(bench_pl(), convert, rx, NULL, 32);
    expect("get pin.drdy", "ok 0");
    expect("advance 10ms", "ok");
    sim_pl_spi_bits(bench_pl(), reset, rx, NULL, 32);
    expect("get dev.1.mode", "ok reset");
}

/* proves: PL-SPI-08, PL-AMB-12, PL-AMB-13 */
static void test_only_data_and_crc_of_the_own_read_are_driven(void)
{
    uint8_t tx[8] = {0x04, 0x3b, 0x02, 0, 0, 0, 0, 0}, rx[8], driven[8];
    static const uint8_t expected_driven[8] = {0, 0, 0, 1, 1, 1, 0, 0};

    bench_stack(2);
    bench_address(2);
    expect("spi 04 3b 01 00 00", "ok -- -- -- 82 c7");
    expect("spi 06 3b 01 00 00", "ok -- -- -- -- --"); /* nobody has address 3 */
    expect("spi 05 30 05 22", "ok -- -- -- --");
    expect("spi 7f 31 00 cc", "ok -- -- -- --");
    expect("spi 7e 00 01 00 00", "ok -- -- -- -- --");
    expect("spi 04", "ok --");
    expect("spi 04 3b", "ok -- --");
    expect("spi 04 3b 01", "ok -- -- --");
    expect("spi 04 3b 01 00", "ok -- -- -- 82");
    sim_pl_spi(bench_pl(), tx, rx, driven, 8);
    TEST_ASSERT_EQUAL_MEMORY(expected_driven, driven, 8);
    for (int i = 0; i < 8; i++) { /* where a byte value is needed, chip select low reads zero */
        if (!driven[i]) {
            TEST_ASSERT_EQUAL_HEX8(0x00, rx[i]);
        }
    }
}

/* proves: PL-AMB-12 */
static void test_the_other_idle_level(void)
{
    static const sim_pl_options other = {.amb12_idle_ff = true};
    uint8_t tx[6] = {0x02, 0x3b, 0x01, 0, 0, 0}, rx[6], driven[6];
    static const uint8_t expected[6] = {0xff, 0xff, 0xff, 0x81, 0xba, 0xff};

    bench_stack_with(1, &other);
    bench_address(1);
    sim_pl_spi(bench_pl(), tx, rx, driven, 6);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, rx, 6);
    TEST_ASSERT_EQUAL(0, driven[5]);
    expect("spi 02 3b 01 00 00", "ok -- -- -- 81 ba");
}

static void timed(const sim_pl_spi_timing *t)
{
    static const uint8_t tx[5] = {0x02, 0x3b, 0x01, 0, 0};
    uint8_t rx[5], driven[5];

    sim_pl_spi_timed(bench_pl(), tx, rx, driven, 5, t);
    TEST_ASSERT_EQUAL_HEX8(0x81, rx[3]); /* reported, never a different effect */
    TEST_ASSERT_EQUAL_HEX8(0xba, rx[4]);
    TEST_ASSERT_EQUAL(1, driven[3]);
}

#define TIMING(hz, duty, high, lead, lag, pause)                                                             \
    {                                                                                                        \
        .clock_hz = (hz), .duty_percent = (duty), .cs_high_ns = (high), .cs_lead_ns = (lead),                \
        .cs_lag_ns = (lag), .longest_pause_ns = (pause)                                                      \
    }

static const sim_pl_spi_timing nominal = TIMING(250000, 50, 3000, 2000, 2000, 0);

/* proves: PL-SPI-12, PL-AMB-20 */
static void test_strict_timing_reports_each_violation(void)
{
    static const sim_pl_options strict = {.strict_timing = true};
    static const struct {
        sim_pl_spi_timing timing;
        bool legal;
    } table[] = {
        {TIMING(250000, 50, 3000, 2000, 2000, 0), true},
        {TIMING(10000, 50, 3000, 2000, 2000, 0), true},
        {TIMING(9999, 50, 3000, 2000, 2000, 0), false},
        {TIMING(1000000, 50, 3000, 2000, 2000, 0), true},
        {TIMING(1000001, 50, 3000, 2000, 2000, 0), false},
        {TIMING(250000, 40, 3000, 2000, 2000, 0), true},
        {TIMING(250000, 39, 3000, 2000, 2000, 0), false},
        {TIMING(250000, 60, 3000, 2000, 2000, 0), true},
        {TIMING(250000, 61, 3000, 2000, 2000, 0), false},
        {TIMING(250000, 50, 2999, 2000, 2000, 0), false},
        {TIMING(250000, 50, 3000, 50, 2000, 0), true},
        {TIMING(250000, 50, 3000, 49, 2000, 0), false},
        {TIMING(250000, 50, 3000, 2000, 10, 0), true},
        {TIMING(250000, 50, 3000, 2000, 9, 0), false},
        {TIMING(250000, 50, 3000, 2000, 2000, 100000), true},
        {TIMING(250000, 50, 3000, 2000, 2000, 100001), false},
    };

    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        char text[40];

        bench_stack_with(1, &strict);
        bench_address(1);
        sim_pl_advance(bench_pl(), 10 * SIM_PL_US);
        sim_misuse_clear(sim_pl_misuse(bench_pl()));
        timed(&nominal);
        sim_pl_advance(bench_pl(), 10 * SIM_PL_US);
        TEST_ASSERT_EQUAL(0, bench_misuses());
        timed(&table[i].timing);
        (void)snprintf(text, sizeof text, "row %d", (int)i);
        TEST_ASSERT_EQUAL_MESSAGE(table[i].legal ? 0 : 1, bench_misuses(), text);
        if (!table[i].legal) {
            TEST_ASSERT_EQUAL(0, strncmp(sim_pl_misuse(bench_pl())->entry[0].id, "PL-", 3));
        }
    }
}

/* proves: PL-SPI-12 */
static void test_only_the_strict_mode_judges_timing(void)
{
    static const sim_pl_spi_timing bad = TIMING(1, 1, 0, 0, 0, 1000000000);

    bench_address(1);
    timed(&bad);
    expect_no_misuse();
}

/* proves: PL-SPI-01 */
static void test_strict_mode_reports_another_spi_mode(void)
{
    static const sim_pl_options strict = {.strict_timing = true};

    for (int mode = 0; mode <= 3; mode++) {
        bench_stack_with(1, &strict);
        bench_address(1);
        sim_pl_advance(bench_pl(), 10 * SIM_PL_US);
        sim_misuse_clear(sim_pl_misuse(bench_pl()));
        sim_pl_set_spi_mode(bench_pl(), mode);
        timed(&nominal);
        TEST_ASSERT_EQUAL(mode != 1, bench_misuses() != 0);
    }
    expect_misuse("PL-SPI-01", -1);
}

/* proves: PL-AMB-20 */
static void test_pauses_do_not_end_a_packet(void)
{
    static const sim_pl_spi_timing slow = TIMING(10000, 50, 3000, 2000, 2000, 4000000000u);

    bench_address(1);
    timed(&slow);
    timed(&nominal);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_chip_select_resynchronises_every_receiver);
    RUN_TEST(test_a_write_acts_only_when_chip_select_ends_it);
    RUN_TEST(test_only_data_and_crc_of_the_own_read_are_driven);
    RUN_TEST(test_the_other_idle_level);
    RUN_TEST(test_strict_timing_reports_each_violation);
    RUN_TEST(test_only_the_strict_mode_judges_timing);
    RUN_TEST(test_strict_mode_reports_another_spi_mode);
    RUN_TEST(test_pauses_do_not_end_a_packet);
    return UNITY_END();
}
