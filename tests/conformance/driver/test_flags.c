/* SPDX-License-Identifier: Apache-2.0 */
/* Where flags come from and what the driver makes of each, writes that a device discards, and what the driver
 * never does. */
#include "bench.h"

/* ---- every source of FAULT and ALERT --------------------------------------------------------------------
 */

static void cov(void)
{
    sim_pl_set_cell(&b.pl, 2, 3, 4.3);
}

static void cuv(void)
{
    sim_pl_set_cell(&b.pl, 2, 3, 2.6);
}

static void reset(void)
{
    bench_raw_write(2, 0x3c, 0xa5);
}

static void force_fault(void)
{
    bench_raw_write(2, 0x21, 0x10);
}

static void force_alert(void)
{
    bench_raw_write(2, 0x20, 0x10);
}

/* Two bits of an EPROM register, found when the shadow is loaded. */
static void eprom(void)
{
    sim_pl_damage_otp(&b.pl, 2, 0x45, 0x03);
    bench_raw_write(2, 0x3a, 0x27);
}

static void ram(void)
{
    sim_pl_damage_ram(&b.pl, 2, 0x42, 0x04);
}

static void heat(void)
{
    sim_pl_set_tdie(&b.pl, 2, 150);
}

static void asleep(void)
{
    bench_raw_write(2, 0x31, 0x04);
}

static void hot_1(void)
{
    sim_pl_set_ts_ratio(&b.pl, 2, 1, 0.32);
}

static void hot_2(void)
{
    sim_pl_set_ts_ratio(&b.pl, 2, 2, 0.32);
}

static void wrong_crc(void)
{
    uint8_t tx[4] = {W(2), 0x32, 0x00, 0x00}, rx[4];
    tx[3] = (uint8_t)(bench_crc(tx, 3) ^ 0x40u);
    sim_pl_spi(&b.pl, tx, rx, NULL, 4);
}

/* proves: PL-FLT-09, PL-ALT-02 */
static void every_source_has_its_report(void)
{
    static const struct {
        void (*strike)(void);
        uint8_t reg, bit; /* what the device shows */
        uint16_t report;
    } source[] = {
        {cov, 0x21, 0x01, BQ_F_CELL_OV},     {cuv, 0x21, 0x02, BQ_F_CELL_UV},
        {reset, 0x21, 0x08, BQ_F_RESET},     {force_fault, 0x21, 0x10, BQ_F_CONFIG},
        {eprom, 0x21, 0x20, BQ_F_DEFECTIVE}, {hot_1, 0x20, 0x01, BQ_F_OVERTEMP},
        {hot_2, 0x20, 0x02, BQ_F_OVERTEMP},  {asleep, 0x20, 0x04, BQ_F_CONFIG},
        {heat, 0x20, 0x08, BQ_F_DIE_TEMP},   {force_alert, 0x20, 0x10, BQ_F_CONFIG},
        {eprom, 0x20, 0x20, BQ_F_DEFECTIVE}, {ram, 0x20, 0x40, BQ_F_CONFIG},
        {reset, 0x20, 0x80, BQ_F_RESET},
    };
    for (size_t i = 0; i < sizeof source / sizeof source[0]; i++) {
        uint16_t seen = 0, others = 0;
        bench_ready(3, NULL);
        source[i].strike();
        bench_wait_ms(1500);
        TEST_ASSERT_EQUAL_HEX8(source[i].bit, PEEK(2, source[i].reg) & source[i].bit);
        for (int n = 0; n < 3; n++) {
            (void)bench_scan();
            bench_sample();
            seen |= MODULE(2)->faults;
            others |= MODULE(1)->faults | (source[i].strike == reset ? 0u : MODULE(3)->faults);
            bench_wait_ms(50);
        }
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(source[i].report, seen & source[i].report,
                                        bench_text("source %d", (int)i));
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(0, others, bench_text("source %d", (int)i));
    }
}

/* The link's own flag is no fault of the pack: counted, cleared, measured again. */
/* proves: PL-FLT-09 */
static void the_crc_flag_is_counted(void)
{
    bench_ready(3, NULL);
    wrong_crc();
    TEST_ASSERT_EQUAL_HEX8(0x04, PEEK(2, 0x21));
    EXPECT_STATUS(BQ_OK, bench_scan());
    TEST_ASSERT_EQUAL_UINT32(1, b.afe.ops->stats(b.afe.ctx)->write_errors);
    TEST_ASSERT_EQUAL_HEX16(0, (bench_sample(), MODULE(2)->faults));
    TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(2, 0x21));
}

/* proves: PL-NUM-41 */
static void the_content_after_reset_is_no_fault(void)
{
    for (int disabled = 0; disabled <= 1; disabled++) {
        bench_up(2, NULL);
        for (int d = 1; d <= 2 && disabled; d++) {
            sim_pl_set_otp(&b.pl, d, 0x42, 0x80);
            sim_pl_set_otp(&b.pl, d, 0x44, 0x80);
        }
        bench_power_cycle();
        bench_wait_ms(60);
        TEST_ASSERT_EQUAL_HEX8(0x61, PEEK(2, 0x00));
        TEST_ASSERT_EQUAL_HEX8(0x80, PEEK(2, 0x20));
        TEST_ASSERT_EQUAL_HEX8(disabled ? 0x08 : 0x09, PEEK(2, 0x21));
        TEST_ASSERT_EQUAL_HEX8(disabled ? 0x00 : 0x3f, PEEK(2, 0x22));
        bench_ready_from();
        bench_sample();
        for (int d = 1; d <= 2; d++) {
            TEST_ASSERT_EQUAL_HEX16(0, MODULE(d)->faults);
            TEST_ASSERT_EQUAL_HEX16(0, MODULE(d)->cell_ov);
            TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(d, 6)->quality);
        }
    }
}

/* ---- answers that a test alters --------------------------------------------------------------------------
 */

static struct {
    int reg, index;
    uint8_t keep, set; /* the byte becomes (byte & keep) | set */
    uint32_t hits;
} altered;

/* Device 1 answers a read that begins at altered.reg; the CRC is made right. */
static bool alter(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    uint8_t all[24];
    (void)ctx;
    if (tx[0] != RD(1) || tx[1] != altered.reg || (int)n < 4 + altered.index + 1) {
        return false;
    }
    memcpy(all, tx, 3);
    for (uint32_t i = 3; i + 1 < n; i++) {
        all[i] = (uint8_t)PEEK(1, (uint8_t)(altered.reg + (int)i - 3));
    }
    all[3 + altered.index] = (uint8_t)((all[3 + altered.index] & altered.keep) | altered.set);
    all[n - 1] = bench_crc(all, n - 1);
    memset(rx, 0, 3);
    memcpy(rx + 3, all + 3, n - 3);
    altered.hits++;
    return true;
}

static void answer(int reg, int index, uint8_t keep, uint8_t set)
{
    altered.reg = reg;
    altered.index = index;
    altered.keep = keep;
    altered.set = set;
    altered.hits = 0;
    sim_pl_bus_fault(&b.pl)->hook = alter;
}

/* DEVICE_STATUS[AR] = 0 at an assigned address is no answer; ALERT_STATUS[AR] = 1 is a reset; an address that
 * comes back without its bit is not assigned. */
/* proves: PL-AMB-27 */
static void the_three_address_bits_are_read_apart(void)
{
    bench_ready(2, NULL);
    answer(0x00, 0, 0x7f, 0x00);
    (void)bench_scan();
    sim_pl_bus_fault(&b.pl)->hook = NULL;
    TEST_ASSERT_TRUE(altered.hits > 0);
    TEST_ASSERT_EQUAL_HEX8(0, (bench_sample(), CELL(1, 1)->quality) & BQ_Q_VALID);

    bench_ready(2, NULL);
    hot_1();
    sim_pl_set_ts_ratio(&b.pl, 1, 1, 0.32); /* makes it look at the flags */
    bench_wait_ms(1500);
    answer(0x20, 0, 0xff, 0x80);
    (void)bench_scan();
    sim_pl_bus_fault(&b.pl)->hook = NULL;
    TEST_ASSERT_TRUE(altered.hits > 0);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_RESET, (bench_sample(), MODULE(1)->faults) & BQ_F_RESET);

    bench_up(2, NULL);
    bench_init();
    answer(0x3b, 0, 0x7f, 0x00);
    TEST_ASSERT_NOT_EQUAL(BQ_OK, bench_start());
    sim_pl_bus_fault(&b.pl)->hook = NULL;
    TEST_ASSERT_TRUE(altered.hits > 0);
    TEST_ASSERT_EQUAL_UINT(0, b.afe.ops->modules_found(b.afe.ctx));
}

/* proves: PL-AMB-39 */
static void the_cell_bits_only_name_cells(void)
{
    for (int under = 0; under <= 1; under++) { /* the flag without a cell */
        bench_ready(2, NULL);
        sim_pl_set_cell(&b.pl, 1, 4, under ? 2.6 : 4.3);
        bench_wait_ms(1500);
        answer(0x20, 2 + under, 0x00, 0x00);
        EXPECT_STATUS(BQ_OK, bench_scan());
        bench_sample();
        TEST_ASSERT_TRUE(altered.hits > 0);
        TEST_ASSERT_EQUAL_HEX16(under ? BQ_F_CELL_UV : BQ_F_CELL_OV, MODULE(1)->faults);
        TEST_ASSERT_EQUAL_HEX16(0, MODULE(1)->cell_ov | MODULE(1)->cell_uv);
        sim_pl_bus_fault(&b.pl)->hook = NULL;
    }
    for (int under = 0; under <= 1; under++) { /* cells without the flag */
        bench_ready(2, NULL);
        sim_pl_set_ts_ratio(&b.pl, 1, 1, 0.32);
        bench_wait_ms(1500);
        answer(0x20, 2 + under, 0xff, 0x3f);
        EXPECT_STATUS(BQ_OK, bench_scan());
        bench_sample();
        TEST_ASSERT_TRUE(altered.hits > 0);
        TEST_ASSERT_EQUAL_HEX16(BQ_F_OVERTEMP, MODULE(1)->faults);
        TEST_ASSERT_EQUAL_HEX16(0, MODULE(1)->cell_ov | MODULE(1)->cell_uv);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(1, 4)->quality);
        sim_pl_bus_fault(&b.pl)->hook = NULL;
    }
}

/* ---- writes that a device discards -----------------------------------------------------------------------
 */

static struct {
    uint8_t bytes[5];
    uint32_t n, hits;
} instead;

/* The first write of ADC_CONTROL to device 1 reaches it as `instead`. */
static bool replace(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    static const uint8_t packet[4] = {0x03, 0x30, 0x7d, 0x30};
    uint8_t answer_bytes[5];
    (void)ctx;
    if (instead.hits != 0 || n != 4 || memcmp(tx, packet, 4) != 0) {
        return false;
    }
    instead.hits++;
    sim_pl_spi(&b.pl, instead.bytes, answer_bytes, NULL, instead.n);
    memset(rx, 0, n);
    TEST_ASSERT_EQUAL_HEX8(0x04, PEEK(1, 0x21) & 0x04); /* discarded and flagged */
    TEST_ASSERT_NOT_EQUAL(0x7d, PEEK(1, 0x30));
    return true;
}

static void arrives_as(uint32_t n, const uint8_t *bytes)
{
    memcpy(instead.bytes, bytes, n);
    instead.n = n;
    instead.hits = 0;
    bench_up(2, NULL);
    bench_init();
    sim_pl_bus_fault(&b.pl)->hook = replace;
    EXPECT_STATUS(BQ_OK, bench_start());
    TEST_ASSERT_EQUAL_UINT32(1, instead.hits);
    TEST_ASSERT_EQUAL_HEX8(0x7d, PEEK(1, 0x30));
    TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(1, 0x21));
    TEST_ASSERT_TRUE(b.afe.ops->stats(b.afe.ctx)->write_errors > 0);
    EXPECT_STATUS(BQ_OK, bench_scan());
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, (bench_sample(), CELL(1, 1)->quality));
}

/* proves: PL-VEC-46, PL-VEC-47, PL-VEC-48, PL-VEC-49 */
static void a_discarded_write_is_sent_again(void)
{
    arrives_as(4, (const uint8_t[]){0x03, 0x30, 0x7d, 0x31});
    arrives_as(4, (const uint8_t[]){0x03, 0x30, 0x7c, 0x30});
    arrives_as(3, (const uint8_t[]){0x03, 0x30, 0x7d});
    arrives_as(2, (const uint8_t[]){0x03, 0x30});
    arrives_as(1, (const uint8_t[]){0x03});
    arrives_as(5, (const uint8_t[]){0x03, 0x30, 0x7d, 0x30, 0x00});
}

/* ---- what goes to everyone, and what is never done -------------------------------------------------------
 */

/* proves: PL-BCAST-01 */
static void one_broadcast_starts_every_device(void)
{
    uint32_t before[5];
    bench_ready(5, NULL);
    for (int d = 1; d <= 5; d++) {
        before[d - 1] = sim_pl_conversions(&b.pl, d);
    }
    bench_mark();
    EXPECT_STATUS(BQ_OK, bench_scan());
    TEST_ASSERT_EQUAL_INT(1, bench_count(BROADCAST, 0x34));
    for (int d = 1; d <= 5; d++) {
        TEST_ASSERT_EQUAL_INT(0, bench_count(W(d), 0x34));
        TEST_ASSERT_EQUAL_UINT32(before[d - 1] + 1, sim_pl_conversions(&b.pl, d));
    }
}

/* 32 devices of 6 cells are the 192 of the datasheet, 62 all that addresses can tell apart. */
/* proves: PL-GEN-05 */
static void stacks_up_to_the_last_address(void)
{
    static const int size[2] = {32, 62};
    for (int i = 0; i < 2; i++) {
        bench_up(size[i], NULL);
        for (int d = 1; d <= size[i]; d++) {
            sim_pl_set_cell(&b.pl, d, 6, 3.0 + 0.01 * d);
        }
        bench_ready_from();
        bench_sample();
        TEST_ASSERT_EQUAL_INT(6 * size[i], b.sample.cell_count);
        for (int d = 1; d <= size[i]; d++) {
            TEST_ASSERT_EQUAL_HEX8(0x80 | d, PEEK(d, 0x3b));
            TEST_ASSERT_INT_WITHIN(1, 3000 + 10 * d, CELL(d, 6)->mv);
        }
    }
}

/* Whatever the cells look like, an output is on only after an action that named its cell. */
/* proves: PL-GEN-04 */
static void nothing_balances_unasked(void)
{
    bench_up(3, NULL);
    for (int d = 1; d <= 3; d++) {
        sim_pl_set_cells(&b.pl, d, (const double[6]){3.0, 4.19, 3.1, 4.1, 2.9, 3.6});
    }
    bench_ready_from();
    for (int i = 0; i < 50; i++) {
        const bq_action nobody = {.charge_on = true, .discharge_on = true, .clear_faults = true};
        EXPECT_STATUS(BQ_OK, bench_apply(&nobody));
        sim_pl_set_cell(&b.pl, 2, 1, i == 20 ? 4.5 : 3.0);
        bench_wait_ms(700);
        EXPECT_STATUS(BQ_OK, bench_scan());
        for (int d = 1; d <= 3; d++) {
            TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_cb(&b.pl, d));
        }
    }
    TEST_ASSERT_TRUE(b.packets < BENCH_LOG);
    for (uint32_t i = 0; i < b.packets; i++) {
        TEST_ASSERT_FALSE(IS_WRITE(&b.log[i]) && b.log[i].tx[1] == 0x32 && b.log[i].tx[2] != 0);
    }
}

/* Bring-up, scans, balancing, self-test, SLEEP and a reset in service: no read touches RESET, TEST_SELECT or
 * E_EN. */
/* proves: PL-AMB-107 */
static void registers_without_content_are_not_read(void)
{
    bench_ready(3, NULL);
    EXPECT_STATUS(BQ_OK, bench_balance(2, 0x15));
    EXPECT_STATUS(BQ_OK, bench_self_test());
    reset();
    for (int i = 0; i < 12; i++) {
        bench_wait_ms(600);
        (void)bench_scan();
    }
    EXPECT_STATUS(BQ_OK, bench_sleep());
    EXPECT_STATUS(BQ_OK, bench_wake());
    TEST_ASSERT_TRUE(b.packets < BENCH_LOG);
    for (uint32_t i = 0; i < b.packets; i++) {
        const bench_packet *p = &b.log[i];
        if (IS_READ(p)) {
            TEST_ASSERT_TRUE(p->tx[1] > 0x3f || p->tx[1] + p->tx[2] <= 0x3c);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(every_source_has_its_report);
    RUN_TEST(the_crc_flag_is_counted);
    RUN_TEST(the_content_after_reset_is_no_fault);
    RUN_TEST(the_three_address_bits_are_read_apart);
    RUN_TEST(the_cell_bits_only_name_cells);
    RUN_TEST(a_discarded_write_is_sent_again);
    RUN_TEST(one_broadcast_starts_every_device);
    RUN_TEST(stacks_up_to_the_last_address);
    RUN_TEST(nothing_balances_unasked);
    RUN_TEST(registers_without_content_are_not_read);
    return UNITY_END();
}
