/* SPDX-License-Identifier: Apache-2.0 */
/* The mistakes that drivers of this chip are known for, the holes of the CRC, and what real hardware does. */
#include "bench.h"
#include "bqhost/pack.h"

/* A host whose answers the test writes: the hook replies to every read of `device` with these bytes. */
struct forged {
    int device, reg; /* -1 = any */
    uint8_t fill;
    bool fix_crc;
    uint8_t index, value; /* one byte of the data replaced, when index != 0xff */
    uint32_t hits, limit;
};

static bool forge(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    struct forged *f = ctx;
    if ((tx[0] & 1) || (f->device >= 0 && tx[0] != RD(f->device)) || (f->reg >= 0 && tx[1] != f->reg) ||
        (f->limit != 0 && f->hits >= f->limit)) {
        return false;
    }
    f->hits++;
    memset(rx, f->fill, n);
    if (f->fix_crc) {
        uint8_t all[24];
        memcpy(all, tx, 3);
        memcpy(all + 3, rx + 3, n - 4);
        if (f->index != 0xff) {
            rx[3 + f->index] = all[3 + f->index] = f->value;
        }
        rx[n - 1] = bench_crc(all, n - 1);
    }
    return true;
}

static void hook(struct forged *f)
{
    sim_pl_bus_fault(&b.pl)->hook = f != NULL ? forge : NULL;
    sim_pl_bus_fault(&b.pl)->hook_ctx = f;
}

/* proves: PL-CRC-12, PL-CRC-13, PL-SEQ-00-01, PL-VEC-51, PL-VEC-52, PL-VCELL-06 */
static void a_bus_of_one_level_with_a_right_crc_is_no_answer(void)
{
    for (int fill = 0; fill <= 0xff; fill += 0xff) {
        for (int device = 1; device <= 62; device += 9) { /* with the CRC made right, for every header */
            struct forged f = {
                .device = device, .reg = 0x00, .fill = (uint8_t)fill, .fix_crc = true, .index = 0xff};
            bench_ready(62, NULL);
            hook(&f);
            bench_scan();
            hook(NULL);
            bench_sample();
            TEST_ASSERT_TRUE(f.hits > 0);
            TEST_ASSERT_EQUAL_HEX8_MESSAGE(0, CELL(device, 1)->quality & BQ_Q_VALID,
                                           bench_text("%d %02x", device, fill));
            TEST_ASSERT_EQUAL_INT(0, b.temps[2 * device - 1].quality & BQ_Q_VALID);
        }
    }
    for (int device = 0x38; device <= 0x38; device++) { /* 38 00 13 aliases all ff as it is */
        bench_ready(62, NULL);
        struct forged f = {.device = device, .reg = -1, .fill = 0xff, .fix_crc = false, .index = 0xff};
        hook(&f);
        bench_scan();
        hook(NULL);
        bench_sample();
        TEST_ASSERT_EQUAL_HEX8(0, CELL(device, 1)->quality & BQ_Q_VALID);
    }
}

/* One byte of an otherwise plausible burst is impossible. */
static void expect_rejected(int index, int value)
{
    struct forged f = {.device = 1,
                       .reg = 0x00,
                       .fill = 0x24,
                       .fix_crc = true,
                       .index = (uint8_t)index,
                       .value = (uint8_t)value};
    bench_ready(1, NULL);
    hook(&f);
    bench_scan();
    hook(NULL);
    bench_sample();
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(0, CELL(1, 1)->quality & BQ_Q_VALID,
                                   bench_text("byte %d = %02x", index, (unsigned)value));
}

/* proves: PL-SEQ-06-06, PL-SEQ-06-07, PL-VCELL-06, PL-CRC-13, PL-AMB-77 */
static void impossible_content_is_rejected(void)
{
    expect_rejected(0, 0x01); /* AR = 0 at an assigned address */
    expect_rejected(0, 0x91); /* bit 4 */
    expect_rejected(0, 0x80); /* conversion running */
    for (int index = 1; index < 19; index += 2) {
        expect_rejected(index, 0x40 | 0x24);
        expect_rejected(index, 0x80 | 0x24);
    }
}

/* proves: PL-CRC-14, PL-CRC-07, PL-VEC-50, PL-SEQ-06-05 */
static void every_flipped_bit_of_a_burst_is_caught(void)
{
    bench_ready(1, NULL);
    for (int to_host = 0; to_host <= 1; to_host++) {
        for (int bit = to_host ? 24 : 0; bit < 23 * 8; bit++) {
            struct sim_bus_fault *fault = sim_pl_bus_fault(&b.pl);
            uint32_t retries = b.afe.ops->stats(b.afe.ctx)->retries;
            bench_wait_ms(1);
            bench_mark();
            sim_pl_set_cell(&b.pl, 1, 3, 3.2 + bit * 0.001);
            EXPECT_STATUS(BQ_OK, b.afe.ops->scan(b.afe.ctx));
            bq_status status;
            do { /* arm the fault for the burst, not for the start */
                if (b.packets == 1 && fault->flip_mosi_bit == 0 && fault->flip_miso_bit == 0 &&
                    retries != UINT32_MAX) {
                    *(to_host ? &fault->flip_miso_bit : &fault->flip_mosi_bit) = 1 + bit;
                    retries = UINT32_MAX;
                }
                status = b.afe.ops->poll(b.afe.ctx, NULL);
                sim_pl_advance(&b.pl, 10000);
            } while (status == BQ_PENDING);
            bench_sample();
            TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(1, 3)->quality);
            TEST_ASSERT_INT_WITHIN_MESSAGE(1, 3200 + bit, CELL(1, 3)->mv,
                                           bench_text("bit %d of %d", bit, to_host));
            if (to_host || bit < 24) { /* filler bits are ignored by the chip */
                TEST_ASSERT_TRUE_MESSAGE(b.packets >= 3, bench_text("bit %d not noticed", bit));
            }
        }
    }
}

/* Flips one bit of the answer of packet number `packet` of the next scan. */
static void scan_with_a_flip(uint32_t packet, int bit)
{
    bq_status status;
    bench_mark();
    EXPECT_STATUS(BQ_OK, b.afe.ops->scan(b.afe.ctx));
    do {
        sim_pl_bus_fault(&b.pl)->flip_miso_bit = b.packets == packet - 1 ? bit : 0;
        status = b.afe.ops->poll(b.afe.ctx, NULL);
        sim_pl_advance(&b.pl, 10000);
    } while (status == BQ_PENDING);
    sim_pl_bus_fault(&b.pl)->flip_miso_bit = 0;
    bench_sample();
}

/* proves: PL-CRC-11, PL-SEQ-00-01 */
static void every_register_read_is_checked(void)
{
    bench_ready(2, NULL);
    for (int i = 0; i < 40; i++) { /* every other scan looks at the configuration of a device */
        bench_wait_ms(500);
        bench_scan();
        bench_wait_ms(500);
        scan_with_a_flip((uint32_t)(4 + i % 4), 1 + 24 + i % 16);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(0, MODULE(1)->faults | MODULE(2)->faults, bench_text("scan %d", i));
    }
    TEST_ASSERT_TRUE(b.afe.ops->stats(b.afe.ctx)->crc_errors >= 10); /* there were some to damage */
}

/* proves: PL-CRC-14 */
static void pairs_127_bits_apart_pass_the_crc_and_the_second_line_holds_what_it_can(void)
{
    /* 19 data bytes and the CRC: bits 24 to 183 of the packet. Pairs inside the answer are exactly 127 bits
     * apart. */
    int passed = 0;
    for (int first = 24; first + 127 < 184; first++) {
        uint8_t packet[23] = {RD(1), 0x00, 0x13, 0x81}, flipped[23];
        memset(packet + 4, 0x24, 18);
        packet[22] = bench_crc(packet, 22);
        for (int distance = 1; first + distance < 184; distance++) {
            memcpy(flipped, packet, 23);
            flipped[first / 8] = (uint8_t)(flipped[first / 8] ^ 0x80u >> first % 8);
            int second = first + distance;
            flipped[second / 8] = (uint8_t)(flipped[second / 8] ^ 0x80u >> second % 8);
            bool through = bench_crc(flipped, 22) == flipped[22];
            TEST_ASSERT_EQUAL_INT_MESSAGE(distance == 127, through, bench_text("%d and %d", first, second));
            passed += through;
        }
    }
    TEST_ASSERT_EQUAL_INT(33, passed);
}

/* proves: PL-SEQ-13-08, PL-SEQ-06-05 */
static void values_of_a_lost_device_grow_old(void)
{
    bench_ready(3, NULL);
    sim_pl_set_supply(&b.pl, 3, false);
    bench_wait_ms(1);
    for (int i = 0; i < 5; i++) {
        bench_wait_ms(1000);
        bench_scan();
    }
    bench_sample();
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_COMM, CELL(3, 1)->quality);
    TEST_ASSERT_TRUE(MODULE(3)->age_ms >= 5000);
    TEST_ASSERT_TRUE(MODULE(1)->age_ms < 1000);
}

/* proves: PL-SEQ-04-03, PL-ADC-13, PL-ADC-16, PL-TIM-17, PL-SEQ-04-04 */
static void the_lock_up_is_impossible_on_any_way(void)
{
    static const uint8_t adct[4] = {0x00, 0x40, 0x80, 0xc0};
    for (int k = 0; k < 4; k++) {
        for (int pin = 0; pin <= 1; pin++) {
            bench_up(3, NULL);
            for (int d = 1; d <= 3; d++) {
                sim_pl_set_otp(&b.pl, d, 0x40, adct[(k + d) % 4]);
            }
            bench_power_cycle();
            bench_wait_ms(60);
            b.config.use_conv_pin = pin != 0;
            bench_ready_from();
            EXPECT_STATUS(BQ_OK, bench_sleep());
            bench_wait_ms(50);
            EXPECT_STATUS(BQ_OK, bench_wake());
            EXPECT_STATUS(BQ_OK, bench_scan());
            EXPECT_STATUS(BQ_OK, bench_start());
            EXPECT_STATUS(BQ_OK, bench_scan());
            bench_no_misuse();
        }
    }
}

/* proves: PL-VBAT-01, PL-SEQ-06-07 */
static void a_tall_stack_does_not_wrap(void)
{
    uint32_t sum = 0;
    bench_up(62, NULL);
    for (int d = 1; d <= 62; d++) {
        sim_pl_set_cells(&b.pl, d, (const double[6]){4.1, 4.1, 4.1, 4.1, 4.1, 4.1});
    }
    bench_ready_from();
    bench_sample();
    TEST_ASSERT_EQUAL_INT(372, b.sample.cell_count);
    for (int d = 1; d <= 62; d++) {
        sum += MODULE(d)->stack_mv;
    }
    TEST_ASSERT_INT_WITHIN(200, 62 * 24600, sum);
    static bq_pack pack;
    bq_pack_config limits = bq_pack_config_nmc(372, b.sample.temp_count, 62);
    bq_pack_input input = {.monitor = BQ_MONITOR_UP};
    bq_action action;
    EXPECT_STATUS(BQ_OK, bq_pack_init(&pack, &limits));
    bq_pack_step(&pack, &b.sample, &input, 100, &action);
    TEST_ASSERT_INT_WITHIN(200, 62 * 24600, pack.summary.pack_mv);
}

/* proves: PL-SEQ-03-09, PL-G3-10, PL-CRC-11 */
static void a_changed_register_is_found_in_service(void)
{
    static const uint8_t regs[] = {0x30, 0x31, 0x40, 0x42, 0x43, 0x44, 0x45, 0x46, 0x47};
    for (size_t i = 0; i < sizeof regs; i++) {
        bench_ready(2, NULL);
        int before = PEEK(2, regs[i]);
        if (regs[i] >= 0x40) {
            bench_raw_write(2, 0x3a, 0x35);
        }
        bench_raw_write(2, regs[i], regs[i] == 0x30 ? 0x7c : regs[i] == 0x31 ? 0x01 : before ^ 0x04);
        TEST_ASSERT_NOT_EQUAL(before, PEEK(2, regs[i]));
        uint16_t seen = 0;
        for (int k = 0; k < 8; k++) {
            bench_wait_ms(600);
            bench_scan();
            bench_sample();
            seen |= MODULE(2)->faults;
        }
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(before, PEEK(2, regs[i]), bench_text("register %02x", regs[i]));
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(BQ_F_CONFIG, seen & BQ_F_CONFIG,
                                        bench_text("register %02x", regs[i]));
    }
}

/* proves: PL-SEQ-13-02, PL-SEQ-02-06, PL-ADR-11 */
static void a_device_with_a_wiring_fault_spoils_only_itself_and_those_above(void)
{
    for (int bad = 1; bad <= 5; bad++) {
        bench_up(5, NULL);
        b.config.allow_partial = true;
        sim_pl_set_supply(&b.pl, bad, false);
        bench_wait_ms(1);
        bench_init();
        bq_status status = bench_start();
        TEST_ASSERT_EQUAL_INT(bad - 1, b.afe.ops->modules_found(b.afe.ctx));
        TEST_ASSERT_EQUAL_UINT(bad, bq76pl536_diagnose(&b.driver)->broken_hop);
        if (bad > 1) {
            EXPECT_STATUS(BQ_OK, status);
            EXPECT_STATUS(BQ_OK, bench_scan());
            bench_sample();
            for (int d = 1; d <= 5; d++) {
                TEST_ASSERT_EQUAL_INT(d < bad, (CELL(d, 1)->quality & BQ_Q_VALID) != 0);
            }
        }
    }
}

/* proves: PL-CONV-04, PL-SEQ-07-04, PL-SEQ-06-08 */
static void a_floating_conv_pin_does_not_pass_for_measuring(void)
{
    for (int stuck = 0; stuck <= 1; stuck++) {
        bench_up(2, NULL);
        b.no_lines = true; /* nobody drives CONV: high, it blocks firmware starts (PL-CONV-03) */
        b.config.frozen_scans = 4;
        sim_pl_set_conv(&b.pl, stuck != 0);
        bench_init();
        EXPECT_STATUS(BQ_OK, bench_start());
        for (int i = 0; i < 12; i++) {
            sim_pl_set_cell(&b.pl, 1, 1, 3.0 + 0.05 * i);
            sim_pl_set_cell(&b.pl, 2, 1, 3.0 + 0.05 * i);
            bench_scan();
            bench_sample();
            for (int d = 1; d <= 2; d++) { /* zero from the reset, or stopped: never a good reading */
                TEST_ASSERT_EQUAL_INT(!stuck, CELL(d, 1)->quality == BQ_Q_VALID);
            }
            bench_wait_ms(100);
        }
    }
    bench_up(2, NULL);
    b.no_lines = true;
    b.config.frozen_scans = 4;
    bench_ready_from();
    sim_pl_set_conv(&b.pl, true); /* from now on every picture is the old one */
    for (int i = 0; i < 8; i++) {
        bench_scan();
        bench_wait_ms(100);
    }
    bench_sample();
    TEST_ASSERT_EQUAL_HEX8(0, CELL(1, 1)->quality & BQ_Q_VALID);
    TEST_ASSERT_EQUAL_HEX8(0, CELL(2, 6)->quality & BQ_Q_VALID);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_bus_of_one_level_with_a_right_crc_is_no_answer);
    RUN_TEST(impossible_content_is_rejected);
    RUN_TEST(every_flipped_bit_of_a_burst_is_caught);
    RUN_TEST(every_register_read_is_checked);
    RUN_TEST(pairs_127_bits_apart_pass_the_crc_and_the_second_line_holds_what_it_can);
    RUN_TEST(values_of_a_lost_device_grow_old);
    RUN_TEST(the_lock_up_is_impossible_on_any_way);
    RUN_TEST(a_tall_stack_does_not_wrap);
    RUN_TEST(a_changed_register_is_found_in_service);
    RUN_TEST(a_device_with_a_wiring_fault_spoils_only_itself_and_those_above);
    RUN_TEST(a_floating_conv_pin_does_not_pass_for_measuring);
    return UNITY_END();
}
