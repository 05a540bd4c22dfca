/* SPDX-License-Identifier: Apache-2.0 */
/* Every kind of injected bus fault: what it does, that it ends, and that without one nothing is touched. */
#include "bench.h"

static const uint8_t read_adr_1[5] = {0x02, 0x3b, 0x01, 0, 0}, read_adr_2[5] = {0x04, 0x3b, 0x01, 0, 0};
static const uint8_t adc_7d[4] = {0x03, 0x30, 0x7d, 0x30};
static uint8_t rx[64], driven[64];

static void transfer(const uint8_t *tx, size_t n)
{
    memset(rx, 0x5a, sizeof rx);
    memset(driven, 0x5a, sizeof driven);
    sim_pl_spi(bench_pl(), tx, rx, driven, n);
}

static void expect_rx(const uint8_t *expected, size_t n)
{
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, rx, n);
}

static void clean(int n)
{
    bench_stack(n);
    bench_quiet(n);
}

/* Bit errors in both directions; what each of them leads to is proven in the sections. */
static void test_armed_flips_clear_themselves(void)
{
    clean(1);
    bench_fault()->flip_miso_bit = 1 + 39;
    transfer(read_adr_1, 5);
    expect_rx((const uint8_t[]){0, 0, 0, 0x81, 0xbb}, 5);
    TEST_ASSERT_EQUAL(0, bench_fault()->flip_miso_bit);
    transfer(read_adr_1, 5);
    expect_rx((const uint8_t[]){0, 0, 0, 0x81, 0xba}, 5);
    bench_fault()->flip_mosi_bit = 1 + 31;
    transfer(adc_7d, 4);
    TEST_ASSERT_EQUAL(0, bench_fault()->flip_mosi_bit);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(1, 0x30));
    TEST_ASSERT_EQUAL_HEX8(0x04, bench_peek(1, 0x21));
    transfer(adc_7d, 4);
    TEST_ASSERT_EQUAL_HEX8(0x7d, bench_peek(1, 0x30));
    TEST_ASSERT_EQUAL_UINT64(2, bench_fault()->flips);
    bench_fault()->flip_miso_bit = 1 + 40; /* beyond the packet: gone without effect */
    transfer(read_adr_1, 5);
    expect_rx((const uint8_t[]){0, 0, 0, 0x81, 0xba}, 5);
    TEST_ASSERT_EQUAL(0, bench_fault()->flip_miso_bit);
}

static uint64_t noisy_run(uint64_t seed, double p, uint8_t *log)
{
    clean(1);
    bench_fault()->rng = seed;
    bench_fault()->flip_probability = p;
    for (int i = 0; i < 500; i++) {
        transfer(read_adr_1, 5);
        log[i] = rx[3];
    }
    return bench_fault()->flips;
}

static void test_random_flips_repeat_with_their_seed_and_follow_the_probability(void)
{
    static uint8_t a[500], b[500];
    uint64_t flips = noisy_run(7, 0.01, a);

    TEST_ASSERT_EQUAL_UINT64(flips, noisy_run(7, 0.01, b));
    TEST_ASSERT_EQUAL_MEMORY(a, b, sizeof a);
    TEST_ASSERT_INT_WITHIN(120, 500 * 80 / 100,
                           (int)flips); /* 40 bits in each direction; six standard deviations */
    (void)noisy_run(8, 0.01, b);
    TEST_ASSERT_TRUE(memcmp(a, b, sizeof a) != 0);
    TEST_ASSERT_EQUAL_UINT64(0, noisy_run(7, 0.0, b));
    clean(1);
    bench_fault()->flip_probability = 1.0;
    transfer(
        read_adr_1,
        5); /* fd c4 fe: bit 7 of the first byte is set, nobody answers, and the zeros come back inverted */
    expect_rx((const uint8_t[]){0xff, 0xff, 0xff, 0xff, 0xff}, 5);
}

/* proves: PL-VEC-51, PL-VEC-52 */
static void test_a_dead_bus_reads_one_level_and_reaches_nobody(void)
{
    static const uint8_t level[3] = {0, 0x00, 0xff};

    for (int kind = 1; kind <= 2; kind++) {
        clean(1);
        bench_fault()->dead = kind;
        transfer(read_adr_1, 5);
        for (int i = 0; i < 5; i++) {
            TEST_ASSERT_EQUAL_HEX8(level[kind], rx[i]);
            TEST_ASSERT_EQUAL(0, driven[i]);
        }
        transfer(adc_7d, 4);
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(1, 0x30));
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(1, 0x21));
        bench_fault()->dead = 0;
        TEST_ASSERT_EQUAL_HEX8(0x81, bench_read(1, 0x3b));
        expect_no_misuse();
    }
}

/* proves: PL-VB-04, PL-VB-07 */
static void test_a_break_above_a_device_cuts_everything_off(void)
{
    clean(4);
    bench_write(4, 0x21, 0x10);
    expect("get pin.fault", "ok 1");
    bench_fault()->break_above = 2;
    TEST_ASSERT_EQUAL_HEX8(0x81, bench_read(1, 0x3b));
    TEST_ASSERT_EQUAL_HEX8(0x82, bench_read(2, 0x3b));
    TEST_ASSERT_TRUE(bench_silent(3));
    TEST_ASSERT_TRUE(bench_silent(4));
    bench_write(ALL, 0x31, 0x03);
    TEST_ASSERT_EQUAL_HEX8(0x03, bench_peek(2, 0x31));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(3, 0x31));
    expect("get pin.fault", "ok 0");
    expect("set pin.conv 1", "ok");
    expect("advance 1ms", "ok");
    expect("set pin.conv 0", "ok");
    TEST_ASSERT_EQUAL(1, sim_pl_conversions(bench_pl(), 2));
    TEST_ASSERT_EQUAL(0, sim_pl_conversions(bench_pl(), 3));
    bench_fault()->break_above = 0;
    expect("get pin.fault", "ok 1");
    TEST_ASSERT_EQUAL_HEX8(0x84, bench_read(4, 0x3b));
}

/* proves: PL-SPI-07 */
static void test_dropped_packets_reach_nobody_and_are_counted_down(void)
{
    clean(1);
    bench_fault()->drop_packets = 3;
    transfer(adc_7d, 4);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(1, 0x30));
    transfer(read_adr_1, 5);
    expect_rx((const uint8_t[]){0xff, 0xff, 0xff, 0xff, 0xff}, 5);
    transfer(adc_7d, 4);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(1, 0x30));
    TEST_ASSERT_EQUAL(0, bench_fault()->drop_packets);
    transfer(adc_7d, 4);
    TEST_ASSERT_EQUAL_HEX8(0x7d, bench_peek(1, 0x30));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(1, 0x21));
    expect_no_misuse();
}

/* proves: PL-CRC-05, PL-PKT-10 */
static void test_short_packets_lose_their_last_byte(void)
{
    clean(1);
    bench_fault()->short_packets = 2;
    transfer(adc_7d, 4);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(1, 0x30));
    TEST_ASSERT_EQUAL_HEX8(0x04, bench_peek(1, 0x21)); /* a write without CRC */
    transfer(read_adr_1, 5);
    TEST_ASSERT_EQUAL_HEX8(0x81, rx[3]);
    TEST_ASSERT_EQUAL(0, driven[4]);
    TEST_ASSERT_EQUAL(0, bench_fault()->short_packets);
    transfer(adc_7d, 4);
    TEST_ASSERT_EQUAL_HEX8(0x7d, bench_peek(1, 0x30));
    expect_no_misuse();
}

static void test_a_late_answer_is_shifted(void)
{
    clean(1);
    bench_fault()->late_bits = 1;
    transfer(read_adr_1, 5);
    expect_rx((const uint8_t[]){0, 0, 0, 0x40, 0xdd}, 5); /* 81 ba one clock later */
    bench_fault()->late_bits = 8;
    transfer(read_adr_1, 5);
    expect_rx((const uint8_t[]){0, 0, 0, 0, 0x81}, 5);
    transfer(adc_7d, 4);
    TEST_ASSERT_EQUAL_HEX8(0x7d, bench_peek(1, 0x30)); /* only the answer is late */
    bench_fault()->late_bits = 0;
    transfer(read_adr_1, 5);
    expect_rx((const uint8_t[]){0, 0, 0, 0x81, 0xba}, 5);
}

static void test_stuck_lines(void)
{
    clean(1);
    bench_fault()->stuck_miso = 1;
    transfer(read_adr_1, 5);
    expect_rx((const uint8_t[]){0, 0, 0, 0, 0}, 5);
    bench_fault()->stuck_miso = 2;
    transfer(read_adr_1, 5);
    expect_rx((const uint8_t[]){0xff, 0xff, 0xff, 0xff, 0xff}, 5);
    transfer(adc_7d, 4);
    TEST_ASSERT_EQUAL_HEX8(0x7d, bench_peek(1, 0x30)); /* the other direction works */
    bench_fault()->stuck_miso = 0;
    for (int level = 1; level <= 2; level++) {
        bench_fault()->stuck_mosi = level;
        transfer((const uint8_t[]){0x03, 0x30, 0x05, 0x5f}, 4);
        TEST_ASSERT_EQUAL_HEX8(0x7d, bench_peek(1, 0x30));
        transfer(read_adr_1, 5);
        TEST_ASSERT_EQUAL(0, driven[3]); /* 00: device at 0x00, of which there is none; ff: nobody */
    }
    bench_fault()->stuck_mosi = 0;
    TEST_ASSERT_EQUAL_HEX8(0x81, bench_read(1, 0x3b));
    bench_write(1, 0x3c, 0xa5);
    expect("advance 1ms", "ok");
    bench_fault()->stuck_mosi =
        1; /* now all zeros are a read of length 0 at address 0x00: the CRC of 00 00 00 is 00 */
    transfer(read_adr_1, 5);
    TEST_ASSERT_EQUAL(1, driven[3]);
    TEST_ASSERT_EQUAL_HEX8(0x00, rx[3]);
    TEST_ASSERT_EQUAL(0, driven[4]);
}

static void test_the_wrong_device_answers(void)
{
    uint8_t sum[4] = {0x02, 0x3b, 0x01, 0x83};

    clean(3);
    bench_fault()->wrong_device = 3;
    transfer(read_adr_1, 5);
    TEST_ASSERT_EQUAL_HEX8(0x83, rx[3]);
    TEST_ASSERT_EQUAL_HEX8(bench_crc(sum, 4),
                           rx[4]); /* the CRC over the header is right: only the content tells */
    transfer(adc_7d, 4);
    TEST_ASSERT_EQUAL_HEX8(0x7d, bench_peek(1, 0x30)); /* only answers are wrong */
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(3, 0x30));
    bench_fault()->wrong_device = 0;
    transfer(read_adr_1, 5);
    TEST_ASSERT_EQUAL_HEX8(0x81, rx[3]);
    expect_no_misuse();
}

/* proves: PL-VB-06 */
static void test_a_device_browns_out_in_the_middle_of_a_packet(void)
{
    clean(3);
    bench_fault()->brownout_device = 2;
    bench_fault()->brownout_bytes = 5 + 4; /* one packet passes, the next one breaks off after four bytes */
    transfer(read_adr_2, 5);
    expect_rx((const uint8_t[]){0, 0, 0, 0x82, 0xc7}, 5);
    TEST_ASSERT_TRUE(sim_pl_supply(bench_pl(), 2));
    transfer(read_adr_2, 5);
    TEST_ASSERT_EQUAL_HEX8(0x82, rx[3]);
    TEST_ASSERT_EQUAL(1, driven[3]);
    TEST_ASSERT_EQUAL(0, driven[4]);
    TEST_ASSERT_FALSE(sim_pl_supply(bench_pl(), 2));
    TEST_ASSERT_EQUAL(0, bench_fault()->brownout_bytes);
    expect("advance 1ms", "ok");
    expect("get dev.2.mode", "ok off");
    TEST_ASSERT_TRUE(bench_silent(2));
    TEST_ASSERT_TRUE(bench_silent(3));
    expect("advance 10s", "ok"); /* it stays off */
    expect("get dev.2.mode", "ok off");
    TEST_ASSERT_EQUAL_HEX8(0x81, bench_read(1, 0x3b));
    expect_no_misuse();
}

/* proves: PL-VB-06, PL-SPI-06 */
static void test_a_brown_out_before_the_end_of_a_write_prevents_it(void)
{
    for (uint32_t at = 1; at <= 3; at++) {
        clean(3);
        bench_fault()->brownout_device = 2;
        bench_fault()->brownout_bytes = at;
        bench_write(ALL, 0x31, 0x03);
        TEST_ASSERT_FALSE(sim_pl_supply(bench_pl(), 2));
        TEST_ASSERT_EQUAL_HEX8(0x03, bench_peek(1, 0x31));
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(3, 0x31)); /* its select was cut off with device 2 */
    }
}

typedef struct hook_book {
    int calls;
    bool answer;
    int register_instead; /* -1 = leave the packet as it is */
} hook_book;

static bool hook(void *ctx, uint8_t *tx, uint8_t *out, uint32_t n)
{
    hook_book *book = ctx;

    book->calls++;
    if (book->register_instead >= 0 && n > 1) {
        tx[1] = (uint8_t)book->register_instead;
    }
    if (book->answer) {
        memset(out, 0x42, n);
    }
    return book->answer;
}

static void test_the_hook_answers_or_falls_through(void)
{
    hook_book book = {0, true, -1};

    clean(1);
    bench_fault()->hook = hook;
    bench_fault()->hook_ctx = &book;
    transfer(adc_7d, 4);
    expect_rx((const uint8_t[]){0x42, 0x42, 0x42, 0x42}, 4);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(1, 0x30)); /* the model was not asked */
    book.answer = false;
    transfer(read_adr_1, 5);
    expect_rx((const uint8_t[]){0, 0, 0, 0x81, 0xba}, 5);
    book.register_instead = 0x00;
    transfer(read_adr_1, 5);
    TEST_ASSERT_EQUAL_HEX8(bench_peek(1, 0x00), rx[3]);
    TEST_ASSERT_EQUAL_HEX8(0x3b, read_adr_1[1]); /* the caller's packet is not touched */
    TEST_ASSERT_EQUAL(3, book.calls);
    bench_fault()->hook = NULL;
    transfer(read_adr_1, 5);
    expect_rx((const uint8_t[]){0, 0, 0, 0x81, 0xba}, 5);
    TEST_ASSERT_EQUAL(3, book.calls);
}

static void test_several_faults_together(void)
{
    clean(2);
    bench_fault()->wrong_device = 2;
    bench_fault()->late_bits = 8;
    bench_fault()->flip_miso_bit = 1 + 39;
    transfer(read_adr_1, 5);
    expect_rx((const uint8_t[]){0, 0, 0, 0, 0x83}, 5); /* 82 of device 2, a byte late, its last bit flipped */
    bench_fault()->drop_packets = 1;
    transfer(read_adr_1, 5);
    expect_rx((const uint8_t[]){0xff, 0xff, 0xff, 0xff, 0xff}, 5);
}

static void test_counters_count_what_was_on_the_bus(void)
{
    clean(1);
    bench_fault()->packets = 0;
    bench_fault()->bytes = 0;
    transfer(read_adr_1, 5);
    transfer(adc_7d, 4);
    TEST_ASSERT_EQUAL_UINT64(2, bench_fault()->packets);
    TEST_ASSERT_EQUAL_UINT64(9, bench_fault()->bytes);
    bench_fault()->late_bits = 1;
    transfer(read_adr_1, 5);
    TEST_ASSERT_EQUAL_UINT64(3, bench_fault()->packets);
    TEST_ASSERT_EQUAL_UINT64(14, bench_fault()->bytes);
    TEST_ASSERT_EQUAL_UINT64(0, bench_fault()->flips);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_armed_flips_clear_themselves);
    RUN_TEST(test_random_flips_repeat_with_their_seed_and_follow_the_probability);
    RUN_TEST(test_a_dead_bus_reads_one_level_and_reaches_nobody);
    RUN_TEST(test_a_break_above_a_device_cuts_everything_off);
    RUN_TEST(test_dropped_packets_reach_nobody_and_are_counted_down);
    RUN_TEST(test_short_packets_lose_their_last_byte);
    RUN_TEST(test_a_late_answer_is_shifted);
    RUN_TEST(test_stuck_lines);
    RUN_TEST(test_the_wrong_device_answers);
    RUN_TEST(test_a_device_browns_out_in_the_middle_of_a_packet);
    RUN_TEST(test_a_brown_out_before_the_end_of_a_write_prevents_it);
    RUN_TEST(test_the_hook_answers_or_falls_through);
    RUN_TEST(test_several_faults_together);
    RUN_TEST(test_counters_count_what_was_on_the_bus);
    return UNITY_END();
}
