/* SPDX-License-Identifier: Apache-2.0 */
/* The byte-wise bus door: the same answers, effects, faults and judgements as whole packets. */
#include "bench.h"
#include <stdio.h>

static sim_pl whole, parts; /* the same stack behind either door */

#define BYTE_NS (8000000000ull / 250000u)

static void both(int devices, const sim_pl_options *options)
{
    TEST_ASSERT_EQUAL(0, sim_pl_init(&whole, devices, options));
    TEST_ASSERT_EQUAL(0, sim_pl_init(&parts, devices, options));
    sim_pl_set_spi_clock(&whole, 250000);
    sim_pl_set_spi_clock(&parts, 250000);
}

static void by_bytes(sim_pl *s, const uint8_t *tx, uint8_t *rx, uint8_t *driven, size_t n)
{
    sim_pl_spi_select(s);
    for (size_t i = 0; i < n; i++) {
        bool by_device;

        rx[i] = sim_pl_spi_byte(s, tx[i], &by_device);
        driven[i] = by_device;
    }
    sim_pl_spi_release(s);
}

static void same_stacks(int at)
{
    TEST_ASSERT_EQUAL_MESSAGE(sim_pl_misuse(&whole)->count, sim_pl_misuse(&parts)->count, "book");
    for (int d = 1; d <= whole.devices; d++) {
        for (int reg = 0; reg < 256; reg++) {
            if (sim_pl_peek(&whole, d, (uint8_t)reg) != sim_pl_peek(&parts, d, (uint8_t)reg)) {
                char text[60];

                (void)snprintf(text, sizeof text, "line %d: device %d register %02x", at, d, (unsigned)reg);
                TEST_FAIL_MESSAGE(text);
            }
        }
    }
}

/* One packet through both doors; bytes that the host must ignore (PL-SPI-09) are not compared. */
static void packet_at(const uint8_t *tx, size_t n, int at)
{
    uint8_t rx[2][64], driven[2][64];
    size_t from = (tx[0] & 1) != 0 ? n : 3;

    sim_pl_spi(&whole, tx, rx[0], driven[0], n);
    by_bytes(&parts, tx, rx[1], driven[1], n);
    for (size_t i = from; i < n; i++) {
        TEST_ASSERT_EQUAL_HEX8(rx[0][i], rx[1][i]);
        TEST_ASSERT_EQUAL(driven[0][i], driven[1][i]);
    }
    same_stacks(at);
    sim_pl_advance(&whole, 10 * SIM_PL_US);
    sim_pl_advance(&parts, 10 * SIM_PL_US);
}
#define packet(tx, n) packet_at((tx), (n), __LINE__)

static void write_both(int address, int reg, int value)
{
    uint8_t tx[4] = {(uint8_t)(address << 1 | 1), (uint8_t)reg, (uint8_t)value, 0};

    tx[3] = bench_crc(tx, 3);
    packet(tx, 4);
}

static void read_both(int address, int reg, int n)
{
    uint8_t tx[64] = {(uint8_t)(address << 1), (uint8_t)reg, (uint8_t)n};

    packet(tx, (size_t)n + 4);
}

static void address_both(int devices)
{
    for (int d = 1; d <= devices; d++) {
        write_both(0, 0x3b, d);
    }
}

/* proves: PL-SPI-03, PL-SPI-06, PL-SPI-08 */
static void test_both_doors_give_the_same_answers_and_effects(void)
{
    both(3, NULL);
    address_both(3);
    for (int d = 1; d <= 3; d++) {
        write_both(d, 0x30, 0x3d);
        write_both(d, 0x20, 0x80);
        write_both(d, 0x20, 0x00);
        read_both(d, 0x3b, 1);
        read_both(d, 0x20, 6);
    }
    write_both(ALL, 0x34, 1);
    sim_pl_advance(&whole, 5 * SIM_PL_MS);
    sim_pl_advance(&parts, 5 * SIM_PL_MS);
    for (int d = 1; d <= 4; d++) { /* the fourth does not exist */
        read_both(d, 0x00, 19);
    }
    TEST_ASSERT_EQUAL_HEX8(0x83, sim_pl_peek(&parts, 3, 0x3b));
    TEST_ASSERT_EQUAL(0, sim_pl_misuse(&parts)->count);
}

/* proves: PL-PKT-03, PL-PKT-04, PL-CRC-05 */
static void test_damaged_packets_do_the_same(void)
{
    static const uint8_t short_write[3] = {0x03, 0x30, 0x05}, wrong_crc[4] = {0x03, 0x30, 0x05, 0x00};
    static const uint8_t bit7[5] = {0x82, 0x3b, 0x01, 0x00, 0x00};
    uint8_t tx[12] = {0x02, 0x3b, 0x02};

    both(2, NULL);
    address_both(2);
    packet(short_write, 3);
    packet(wrong_crc, 4);
    packet(bit7, 5);
    for (size_t n = 1; n <= 12; n++) {
        packet(tx, n);
    }
    TEST_ASSERT_TRUE(sim_misuse_of(sim_pl_misuse(&parts), "PL-PKT-04") >= 8);
    TEST_ASSERT_EQUAL(sim_misuse_of(sim_pl_misuse(&whole), "PL-PKT-04"),
                      sim_misuse_of(sim_pl_misuse(&parts), "PL-PKT-04"));
}

static void arm(int kind, sim_bus_fault *f)
{
    switch (kind) {
    case 0:
        f->flip_mosi_bit = 1 + 13;
        break;
    case 1:
        f->flip_miso_bit = 1 + 8 * 4 + 2;
        break;
    case 2:
        f->dead = 1;
        break;
    case 3:
        f->dead = 2;
        break;
    case 4:
        f->break_above = 1;
        break;
    case 5:
        f->drop_packets = 1;
        break;
    case 6:
        f->short_packets = 1;
        break;
    case 7:
        f->late_bits = 3;
        break;
    case 8:
        f->stuck_mosi = 1;
        break;
    case 9:
        f->stuck_miso = 2;
        break;
    case 10:
        f->wrong_device = 1;
        break;
    case 11:
        f->brownout_device = 2, f->brownout_bytes = 9;
        break;
    case 12:
        f->flip_probability = 0.05, f->rng = 7;
        break;
    default:
        break;
    }
}

/* proves: PL-CRC-05 */
static void test_every_injected_fault_strikes_both_doors_alike(void)
{
    for (int kind = 0; kind <= 12; kind++) {
        both(2, NULL);
        address_both(2);
        arm(kind, sim_pl_bus_fault(&whole));
        arm(kind, sim_pl_bus_fault(&parts));
        read_both(2, 0x3b, 3);
        write_both(2, 0x30, 0x05);
        read_both(2, 0x00, 4);
        TEST_ASSERT_EQUAL(sim_pl_bus_fault(&whole)->packets, sim_pl_bus_fault(&parts)->packets);
        TEST_ASSERT_EQUAL(sim_pl_bus_fault(&whole)->bytes, sim_pl_bus_fault(&parts)->bytes);
        TEST_ASSERT_EQUAL(sim_pl_bus_fault(&whole)->flips, sim_pl_bus_fault(&parts)->flips);
    }
}

/* proves: PL-SPI-06 */
static void test_a_write_waits_for_chip_select(void)
{
    uint8_t tx[4] = {0x03, 0x30, 0x05, 0};
    bool driven;

    both(1, NULL);
    address_both(1);
    tx[3] = bench_crc(tx, 3);
    sim_pl_spi_select(&parts);
    TEST_ASSERT_TRUE(sim_pl_spi_selected(&parts));
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_spi_byte(&parts, tx[i], &driven));
        TEST_ASSERT_FALSE(driven);
    }
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&parts, 1, 0x30));
    sim_pl_spi_release(&parts);
    TEST_ASSERT_EQUAL_HEX8(0x05, sim_pl_peek(&parts, 1, 0x30));
}

/* proves: PL-SPI-07 */
static void test_clocks_without_chip_select_read_the_pull_up(void)
{
    bool driven = true;

    both(1, NULL);
    TEST_ASSERT_EQUAL_HEX8(0xff, sim_pl_spi_byte(&parts, 0x02, &driven));
    TEST_ASSERT_FALSE(driven);
    sim_pl_spi_release(&parts); /* nothing was selected */
    TEST_ASSERT_EQUAL(0, sim_pl_bus_fault(&parts)->packets);
}

/* Address, a read and its timing: lead, pause before the fourth byte, lag, chip select high before. */
static void timed_read(uint64_t high, uint64_t lead, uint64_t pause, uint64_t lag)
{
    static const uint8_t tx[5] = {0x02, 0x3b, 0x01, 0, 0};

    sim_pl_advance(&parts, high);
    sim_pl_spi_select(&parts);
    sim_pl_advance(&parts, lead);
    for (int i = 0; i < 5; i++) {
        sim_pl_advance(&parts, i == 3 ? pause : 0);
        sim_pl_advance(&parts, BYTE_NS);
        (void)sim_pl_spi_byte(&parts, tx[i], NULL);
    }
    sim_pl_advance(&parts, lag);
    sim_pl_spi_release(&parts);
}

/* proves: PL-SPI-04, PL-SPI-12, PL-AMB-20 */
static void test_strict_timing_judges_what_really_passed(void)
{
    static const sim_pl_options strict = {.strict_timing = true};
    static const struct {
        uint64_t high, lead, pause, lag;
        const char *id;
    } row[] = {
        {3000, 50, 0, 10, NULL},       {2999, 50, 0, 10, "PL-SPI-04"}, {3000, 49, 0, 10, "PL-TIM-03"},
        {3000, 50, 0, 9, "PL-TIM-03"}, {3000, 50, 100000, 10, NULL},   {3000, 50, 100001, 10, "PL-AMB-20"},
    };

    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        both(1, &strict);
        sim_pl_set_spi_clock(&parts, 250000);
        timed_read(10000, 2000, 0, 2000);
        TEST_ASSERT_EQUAL(0, sim_pl_misuse(&parts)->count);
        timed_read(row[i].high, row[i].lead, row[i].pause, row[i].lag);
        TEST_ASSERT_EQUAL(row[i].id != NULL, sim_pl_misuse(&parts)->count);
        TEST_ASSERT_EQUAL(row[i].id != NULL,
                          row[i].id != NULL && sim_misuse_of(sim_pl_misuse(&parts), row[i].id));
    }
}

/* proves: PL-TIM-01, PL-SPI-01 */
static void test_strict_mode_judges_clock_and_mode(void)
{
    static const sim_pl_options strict = {.strict_timing = true};

    both(1, &strict);
    sim_pl_set_spi_mode(&parts, 0);
    timed_read(10000, 2000, 0, 2000);
    TEST_ASSERT_EQUAL(1, sim_misuse_of(sim_pl_misuse(&parts), "PL-SPI-01"));
    both(1, &strict);
    sim_pl_set_spi_clock(&parts, 1000001);
    timed_read(10000, 2000, 0, 2000);
    TEST_ASSERT_EQUAL(1, sim_misuse_of(sim_pl_misuse(&parts), "PL-TIM-01"));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_both_doors_give_the_same_answers_and_effects);
    RUN_TEST(test_damaged_packets_do_the_same);
    RUN_TEST(test_every_injected_fault_strikes_both_doors_alike);
    RUN_TEST(test_a_write_waits_for_chip_select);
    RUN_TEST(test_clocks_without_chip_select_read_the_pull_up);
    RUN_TEST(test_strict_timing_judges_what_really_passed);
    RUN_TEST(test_strict_mode_judges_clock_and_mode);
    return UNITY_END();
}
