/* SPDX-License-Identifier: Apache-2.0 */
/* Every option of the bq76PL536 model, seen from the bus in both positions; the misuse book; waveform files
 * that fail. */
#include "sim_bench.h"
#include "sim_vcd.h"
#include <stdio.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static void spoilt(unsigned address, unsigned reg)
{
    uint8_t tx[4] = {(uint8_t)(address << 1 | 1), (uint8_t)reg, 0, 0x5a};

    sim_pl_spi(&s, tx, rx, driven, 4);
}

/* Two addressed devices without flags, COV and CUV off. */
static void ready(const sim_pl_options *options)
{
    TEST_ASSERT_EQUAL(0, sim_pl_init(&s, 2, options));
    put(0, 0x3b, 0x81);
    put(0, 0x3b, 0x82);
    key_put(0x3f, 0x42, 0x80);
    key_put(0x3f, 0x44, 0x80);
    put(0x3f, 0x20, 0x80);
    put(0x3f, 0x20, 0x00);
    put(0x3f, 0x21, 0x08);
    put(0x3f, 0x21, 0x00);
    TEST_ASSERT_EQUAL_HEX8(0x81, peek(1, 0) | 0x01);
}

/* Each option once: returns what the host sees; it must differ between off and on as the table says. */
static int crc_alert(void)
{
    spoilt(1, 0x30);
    return sim_pl_alert_pin(&s);
}

static int crc_after_good_write(void)
{
    spoilt(1, 0x30);
    put(1, 0x30, 0x05);
    return peek(1, 0x21);
}

static int crc_of_bystander(void)
{
    spoilt(1, 0x30);
    return peek(2, 0x21);
}

static int idle_level(void)
{
    put(1, 0x30, 0x05);
    return rx[0];
}

static int broadcast_to_unaddressed(void)
{
    put(2, 0x3c, 0xa5);
    sim_pl_advance(&s, SIM_PL_MS);
    put(0x3f, 0x30, 0x05);
    return peek(2, 0x30);
}

static int bare_address(void)
{
    put(2, 0x3c, 0xa5);
    sim_pl_advance(&s, SIM_PL_MS);
    put(0, 0x3b, 0x02);
    return peek(2, 0x3b);
}

static int ar_after_address(void)
{
    put(2, 0x3c, 0xa5);
    sim_pl_advance(&s, SIM_PL_MS);
    put(0, 0x3b, 0x82);
    return peek(2, 0x20);
}

static int latch_between_one_and_zero(void)
{
    put(1, 0x21, 0x04);
    spoilt(1, 0x30);
    return peek(1, 0x21);
}

static int cells_after_clear(void)
{
    key_put(1, 0x42, 0x2c);
    key_put(1, 0x43, 0x01);
    sim_pl_set_cell(&s, 1, 2, 4.3);
    sim_pl_advance(&s, SIM_PL_MS);
    put(1, 0x21, 0x01);
    return peek(1, 0x22) << 8 | peek(1, 0x21);
}

static int corrected(void)
{
    sim_pl_damage_otp(&s, 1, 0x48, 0x01);
    put(1, 0x3a, 0x27);
    key_put(1, 0x42, 0x80);
    key_put(1, 0x44, 0x80);
    put(1, 0x21, 0x03);
    return peek(1, 0x00) | sim_pl_alert_pin(&s) << 8;
}

static int uncorrectable(void)
{
    sim_pl_damage_otp(&s, 1, 0x48, 0x03);
    put(1, 0x3a, 0x27);
    return peek(1, 0x21) & 0x20;
}

static int alert_after_sleep(void)
{
    put(1, 0x31, 0x04);
    put(1, 0x20, 0x04);
    put(1, 0x31, 0x00);
    return peek(1, 0x20);
}

static int por_after_command(void)
{
    put(2, 0x3c, 0xa5);
    sim_pl_advance(&s, SIM_PL_MS);
    return peek(2, 0x21) & 0x08;
}

static int cycle_us(void)
{
    put(1, 0x30, 0x45);
    sim_pl_advance(&s, SIM_PL_MS);
    put(1, 0x34, 0x01);
    return (int)(sim_pl_next_event(&s) / SIM_PL_US);
}

static int conv_bit(void)
{
    (void)cycle_us();
    return peek(1, 0x34);
}

static int first_drdy(void)
{
    return peek(1, 0x00) & 0x01;
}

static int drdy_of_stack(void)
{
    put(1, 0x30, 0x45);
    put(2, 0x30, 0x45);
    sim_pl_advance(&s, SIM_PL_MS);
    put(2, 0x34, 0x01);
    return sim_pl_drdy_pin(&s);
}

static int balancing_s(void)
{
    put(1, 0x33, 30);
    put(1, 0x32, 0x01);
    sim_pl_advance(&s, 10 * SIM_PL_S);
    put(1, 0x32, 0x03);
    return (int)(sim_pl_next_event(&s) / SIM_PL_S);
}

static int balancing_rewritten_s(void)
{
    (void)balancing_s();
    put(1, 0x33, 40);
    return (int)(sim_pl_next_event(&s) / SIM_PL_S);
}

static int cb_ctrl_after_expiry(void)
{
    (void)balancing_s();
    sim_pl_advance(&s, 60 * SIM_PL_S);
    return peek(1, 0x32);
}

static int cb_in_sleep(void)
{
    (void)balancing_s();
    put(1, 0x31, 0x04);
    put(1, 0x32, 0x00);
    put(1, 0x32, 0x03);
    return sim_pl_cb(&s, 1);
}

static int reset_us(void)
{
    put(2, 0x3c, 0xa5);
    return (int)(sim_pl_next_event(&s) / SIM_PL_US);
}

static int key_after_discarded_write(void)
{
    put(1, 0x3a, 0x35);
    spoilt(1, 0x30);
    put(1, 0x47, 0x0a);
    return peek(1, 0x47);
}

static int user(void)
{
    key_put(1, 0x48, 0x5a);
    return peek(1, 0x48);
}

static int function_config(void)
{
    put(1, 0x30, 0x40);
    key_put(1, 0x40, 0x5c);
    key_put(1, 0x41, 0x80);
    return peek(1, 0x40) << 8 | peek(1, 0x41);
}

static int delay_us(void)
{
    key_put(1, 0x43, 0x05);
    sim_pl_set_cell(&s, 1, 2, 4.3);
    key_put(1, 0x42, 0x2c);
    return (int)(sim_pl_next_event(&s) / SIM_PL_US);
}

static int gpai_code(void)
{
    key_put(1, 0x40, 0x20);
    sim_pl_set_gpai(&s, 1, 1.0);
    put(1, 0x30, 0x08);
    put(1, 0x34, 0x01);
    sim_pl_advance(&s, SIM_PL_MS);
    return peek(1, 0x01) << 8 | peek(1, 0x02);
}

static int wire_codes(void)
{
    sim_pl_set_wire(&s, 1, 3, true);
    put(1, 0x30, 0x05);
    put(1, 0x34, 0x01);
    sim_pl_advance(&s, SIM_PL_MS);
    return (peek(1, 0x07) << 8 | peek(1, 0x08)) << 16 | peek(1, 0x09) << 8 | peek(1, 0x0a);
}

#define OPTION(member, value)                                                                                \
    {                                                                                                        \
        .member = value                                                                                      \
    }

static void test_each_option_changes_what_it_names(void)
{
    static const struct {
        const char *name;
        sim_pl_options on;
        int (*look)(void);
        int plain, other;
    } table[] = {
        {"amb01", OPTION(amb01_crc_alert, true), crc_alert, 0, 1},
        {"amb02", OPTION(amb02_crc_last_packet, true), crc_after_good_write, 0x04, 0x00},
        {"amb06", OPTION(amb06_all_check, true), crc_of_bystander, 0x00, 0x04},
        {"amb12", OPTION(amb12_idle_ff, true), idle_level, 0x00, 0xff},
        {"amb18", OPTION(amb18_addressed_only, true), broadcast_to_unaddressed, 0x05, 0x00},
        {"amb26", OPTION(amb26_needs_bit7, true), bare_address, 0x82, 0x00},
        {"amb28", OPTION(amb28_ar_copy, true), ar_after_address, 0x80, 0x00},
        {"amb33", OPTION(amb33_hold_until_zero, true), latch_between_one_and_zero, 0x04, 0x00},
        {"amb40", OPTION(amb40_sticky_cells, true), cells_after_clear, 0x0000, 0x0200},
        {"amb48", OPTION(amb48_ecc_alert, true), corrected, 0x089, 0x1a9},
        {"amb49", OPTION(amb49_no_ifault, true), uncorrectable, 0x20, 0x00},
        {"amb51", OPTION(amb51_sleep_on_exit, true), alert_after_sleep, 0x00, 0x04},
        {"amb54", OPTION(amb54_reset_no_por, true), por_after_command, 0x08, 0x00},
        {"amb62", OPTION(amb62_six_us, true), cycle_us, 21, 42},
        {"amb68", OPTION(amb68_conv_reads_one, true), conv_bit, 0, 1},
        {"amb78", OPTION(amb78_drdy_zero, true), first_drdy, 1, 0},
        {"amb79", OPTION(amb79_drdy_base_only, true), drdy_of_stack, 0, 1},
        {"amb83", OPTION(amb83_any_rise, true), balancing_s, 20, 30},
        {"amb84", OPTION(amb84_clear_cbctrl, true), cb_ctrl_after_expiry, 0x03, 0x00},
        {"amb85", OPTION(amb85_time_restarts, true), balancing_rewritten_s, 20, 40},
        {"amb86", OPTION(amb86_sleep_stops_cb, true), cb_in_sleep, 0x03, 0x00},
        {"amb93", OPTION(amb93_reset_us, 900), reset_us, 500, 900},
        {"amb99", OPTION(amb99_discarded_cancels, true), key_after_discarded_write, 0x0a, 0x00},
        {"amb100", OPTION(amb100_user_readonly, true), user, 0x5a, 0x00},
        {"variant_a", OPTION(variant_a, true), function_config, 0x5c00, 0x1c80},
        {"variant_a speed", OPTION(variant_a, true), cycle_us, 21, 42},
        {"delay_percent", OPTION(delay_percent, 10.0), delay_us, 500, 550},
        {"deglitch", OPTION(deglitch, true), delay_us, 500, 550},
        {"reg50_v", OPTION(reg50_v, 4.0), gpai_code, 0x1999, 0x2000}, /* 1 V of 2 V: 8191.5, upward */
        {"wire_drift", OPTION(wire_drift, 0.25), wire_codes, 0x126e374b, 0x1ba52e14},
        {"wire_field_pattern", OPTION(wire_field_pattern, true), wire_codes, 0x126e374b, 0x00002c3c},
    };

    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        ready(NULL);
        TEST_ASSERT_EQUAL_MESSAGE(table[i].plain, table[i].look(), table[i].name);
        ready(&table[i].on);
        TEST_ASSERT_EQUAL_MESSAGE(table[i].other, table[i].look(), table[i].name);
    }
}

static void test_noise_is_seeded_and_has_the_size_asked_for(void)
{
    sim_pl_options noisy = {.seed = 3, .noise_uv_rms = 2000.0, .cell_offset_uv_max = 0.0};
    double sum = 0.0, squares = 0.0;
    int first[2][3];

    for (int run = 0; run < 2; run++) {
        ready(&noisy);
        put(1, 0x30, 0x05);
        for (int i = 0; i < 2000; i++) {
            double mv;

            put(1, 0x34, 0x01);
            sim_pl_advance(&s, SIM_PL_MS);
            mv = ((peek(1, 0x03) << 8) + peek(1, 0x04)) * 6250.0 / 16383.0 - 3600.0;
            sum += mv;
            squares += mv * mv;
            if (i < 3) {
                first[run][i] = peek(1, 0x03) << 8 | peek(1, 0x04);
            }
        }
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.15, 0.0, sum / 4000);
    TEST_ASSERT_DOUBLE_WITHIN(0.4, 4.0, squares / 4000);
    TEST_ASSERT_EQUAL_MEMORY(first[0], first[1], sizeof first[0]);
}

static void test_offsets_are_fixed_and_within_their_bound(void)
{
    sim_pl_options offset = {.seed = 9, .cell_offset_uv_max = 5000.0};
    int lowest = 99999, highest = 0;

    ready(&offset);
    put(1, 0x30, 0x05);
    for (int run = 0; run < 2; run++) {
        put(1, 0x34, 0x01);
        sim_pl_advance(&s, SIM_PL_MS);
        for (unsigned cell = 0; cell < 6; cell++) {
            int code = peek(1, 3 + 2 * cell) << 8 | peek(1, 4 + 2 * cell);

            lowest = code < lowest ? code : lowest;
            highest = code > highest ? code : highest;
            TEST_ASSERT_INT_WITHIN(14, 9437, code); /* 5 mV */
        }
    }
    TEST_ASSERT_GREATER_THAN(lowest + 5, highest);
    TEST_ASSERT_LESS_THAN(9437, lowest);
    TEST_ASSERT_GREATER_THAN(9437, highest);
}

static void test_bad_arguments_are_refused(void)
{
    static const sim_pl_options bad[] = {
        {.delay_percent = -13.0}, {.delay_percent = 11.0}, {.noise_uv_rms = -1.0}, {.wire_drift = 1.5}};

    TEST_ASSERT_EQUAL(-1, sim_pl_init(&s, 0, NULL));
    TEST_ASSERT_EQUAL(-1, sim_pl_init(&s, 63, NULL));
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_EQUAL(-1, sim_pl_init(&s, 1, &bad[i]));
    }
    ready(NULL);
    TEST_ASSERT_EQUAL(-1, sim_pl_set_cell(&s, 3, 1, 3.0));
    TEST_ASSERT_EQUAL(-1, sim_pl_set_cell(&s, 1, 7, 3.0));
    TEST_ASSERT_EQUAL(-1, sim_pl_set_cells(&s, 0, (double[6]){1, 2, 3, 4, 5, 6}));
    TEST_ASSERT_EQUAL(-1, sim_pl_set_link(&s, 2, true));
    TEST_ASSERT_EQUAL(-1, sim_pl_set_wire(&s, 1, 7, true));
    TEST_ASSERT_EQUAL(-1, sim_pl_set_otp(&s, 1, 0x4c, 1));
    TEST_ASSERT_EQUAL(-1, sim_pl_set_ts_ratio(&s, 1, 3, 0.1));
    TEST_ASSERT_EQUAL(-1, sim_pl_peek(&s, 3, 0));
    sim_pl_set_cell(&s, 1, 2, 3.5);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 3.6, sim_pl_cell(&s, 1, 1));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 3.5, sim_pl_cell(&s, 1, 2));
}

static void test_misuse_book_counts_beyond_what_it_keeps(void)
{
    static sim_misuse book;
    char text[200];

    memset(text, 'x', sizeof text);
    text[sizeof text - 1] = '\0';
    sim_misuse_clear(&book);
    for (int i = 0; i < SIM_MISUSE_KEPT + 6; i++) {
        sim_misuse_add(&book, (uint64_t)i, 1, i % 2 == 0 ? "PL-A-01" : "PL-B-01", text);
    }
    TEST_ASSERT_EQUAL(SIM_MISUSE_KEPT + 6, book.count);
    TEST_ASSERT_EQUAL(SIM_MISUSE_KEPT / 2, sim_misuse_of(&book, "PL-B-01"));
    TEST_ASSERT_EQUAL(0, sim_misuse_of(&book, "PL-B"));
    TEST_ASSERT_EQUAL(sizeof book.entry[0].text - 1, strlen(book.entry[0].text));
    TEST_ASSERT_EQUAL(SIM_MISUSE_KEPT - 1, book.entry[SIM_MISUSE_KEPT - 1].time_ns);
}

static void test_waveform_file_reports_what_could_not_be_written(void)
{
    sim_vcd v;
    int signal;

    TEST_ASSERT_EQUAL(0, sim_vcd_open(&v, "/dev/full"));
    signal = sim_vcd_signal(&v, "A", 0);
    for (int i = 0; i < 10000; i++) {
        sim_vcd_set(&v, signal, (uint64_t)i, i % 2);
    }
    TEST_ASSERT_EQUAL(-1, sim_vcd_close(&v, 10000));
    TEST_ASSERT_EQUAL(-1, sim_vcd_close(&v, 10000));
}

static void test_waveform_keeps_time_and_fills_up(void)
{
    static const char want[] = "#0\n$dumpvars\n0!\n$end\n#5\n1!\n0!\n#9\n";
    char text[512] = "", name[8];
    sim_vcd v;
    FILE *file;

    TEST_ASSERT_EQUAL(0, sim_vcd_open(&v, "unit_sim_options.vcd"));
    TEST_ASSERT_EQUAL(0, sim_vcd_signal(&v, "A", 0));
    sim_vcd_set(&v, 0, 5, 1);
    sim_vcd_set(&v, 0, 3, 0); /* backwards */
    sim_vcd_set(&v, 1, 7, 0); /* no such signal */
    TEST_ASSERT_EQUAL(-1, sim_vcd_signal(&v, "B", 0));
    TEST_ASSERT_EQUAL(0, sim_vcd_close(&v, 9));
    file = fopen("unit_sim_options.vcd", "r");
    TEST_ASSERT_NOT_NULL(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    remove("unit_sim_options.vcd");
    TEST_ASSERT_NOT_NULL(strstr(text, want));
    TEST_ASSERT_EQUAL(0, sim_vcd_open(&v, "unit_sim_options.vcd"));
    for (int i = 0; i < SIM_VCD_SIGNALS; i++) {
        (void)snprintf(name, sizeof name, "S%d", i);
        TEST_ASSERT_EQUAL(i, sim_vcd_signal(&v, name, 0));
    }
    TEST_ASSERT_EQUAL(-1, sim_vcd_signal(&v, "more", 0));
    TEST_ASSERT_EQUAL(0, sim_vcd_close(&v, 0));
    remove("unit_sim_options.vcd");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_option_changes_what_it_names);
    RUN_TEST(test_noise_is_seeded_and_has_the_size_asked_for);
    RUN_TEST(test_offsets_are_fixed_and_within_their_bound);
    RUN_TEST(test_bad_arguments_are_refused);
    RUN_TEST(test_misuse_book_counts_beyond_what_it_keeps);
    RUN_TEST(test_waveform_file_reports_what_could_not_be_written);
    RUN_TEST(test_waveform_keeps_time_and_fills_up);
    return UNITY_END();
}
